/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * energy, rough mirrors: integrals over directions of what eval() and pdf() say, whose peak may be narrow and lie at the horizon. Each
 * direction wi is told by the facet m that would reflect it to wo, m by tan = alpha tan psi and an azimuth about n: there
 * the lobe is as wide as the table's roughness says from every viewer, and where wi crosses the horizon is known.
 */
#include "verify/analytic/effects.h"
#include "verify/checks/energy_c.h"

/* Error of an integral; of a cell's probability. */
#define LEAST 1e-9
#define LEAST_CELL 1e-6

enum { ABOVE, BELOW }; /* regions of wi: on the viewer's side, on the other one */

typedef struct facets {
    const lc_stage *stage;
    const lc_hit *hit;
    lc_vec3 x, y; /* wo lies in the plane of x and n */
    double cos_o, sin_o;
    int region;        /* over which to integrate, */
    double psi0, psi1; /* and where, */
    double phi0, phi1; /* and, of a cell, between which azimuths */
} facets;

static facets make_facets(const lc_stage *stage, const lc_hit *hit)
{
    facets f = {stage, hit, stage->s, stage->t, fmin(1, lc_dot(stage->n, hit->wo)), 0, ABOVE, 0, 0, 0, 0};
    lc_vec3 across = lc_sub(hit->wo, lc_scale(f.cos_o, stage->n));
    f.sin_o = lc_length(across);
    if (f.sin_o > 1e-12) {
        f.x = lc_scale(1 / f.sin_o, across);
        f.y = lc_cross(stage->n, f.x);
    }
    return f;
}

/* The integrand at a facet: pdf, then f |cos| of the channels, times d(wi) / d(psi, phi). */
static void look(double value[4], const facets *f, double psi, double phi)
{
    double alpha = f->stage->alpha, tangent = alpha * tan(psi);
    double cos_m = 1 / sqrt(1 + tangent * tangent), sin_m = tangent * cos_m;
    double along = f->sin_o * sin_m * cos(phi) + f->cos_o * cos_m; /* wo . m */
    value[0] = value[1] = value[2] = value[3] = 0;
    if (!(along > 0))
        return;
    lc_vec3 m = lc_add(lc_scale(sin_m * cos(phi), f->x), lc_scale(sin_m * sin(phi), f->y));
    lc_vec3 wi = lc_normalize(lc_sub(lc_scale(2 * along, lc_add(m, lc_scale(cos_m, f->stage->n))), f->hit->wo));
    double ring = sin_m * alpha * (cos_m / cos(psi)) * (cos_m / cos(psi)); /* sin t dt / dpsi */
    double weight = 4 * along * ring, cos_i = fabs(lc_dot(f->stage->n, wi));
    lc_rgb value_f = f->stage->bsdf->eval(f->stage->scene, f->hit, wi);
    value[0] = weight * f->stage->bsdf->pdf(f->stage->scene, f->hit, wi);
    for (int c = 0; c < 3; ++c)
        value[1 + c] = weight * cos_i * lc_channel(value_f, c);
}

/* Azimuths at which wi reaches the horizon and a facet is on edge: |phi| below the first is ABOVE, from there to the second BELOW. */
static void limits(const facets *f, double psi, double *horizon, double *edge)
{
    double tangent = f->stage->alpha * tan(psi), cos_m = 1 / sqrt(1 + tangent * tangent);
    double side = f->sin_o * tangent * cos_m, level = f->cos_o * (1 / (2 * cos_m) - cos_m), turned = -f->cos_o * cos_m;
    *horizon = level >= side ? 0 : level <= -side ? LC_PI : acos(level / side);
    *edge = turned <= -side ? LC_PI : acos(turned / side);
}

/* Over the unit square: psi between its limits, so that square roots at both ends are smooth; then both azimuths. */
static void smoothed(double *value, double s, double t, void *user)
{
    const facets *f = user;
    double psi = f->psi0 + (f->psi1 - f->psi0) * s * s * (3 - 2 * s), from = 0, to, more[4];
    double weight = (f->psi1 - f->psi0) * 6 * s * (1 - s);
    limits(f, psi, &to, &from);
    if (f->region == BELOW) {
        double horizon = to;
        to = from;
        from = horizon;
    } else
        from = 0;
    double phi = from + (to - from) * t;
    look(value, f, psi, phi);
    look(more, f, psi, -phi);
    for (int c = 0; c < 4; ++c)
        value[c] = weight * (to - from) * (value[c] + more[c]);
}

/* Directions that no facet leads to, from -n up to the angle at which facets are on edge: nothing should be there. */
static void beyond(double *value, double angle, double phi, void *user)
{
    const facets *f = user;
    lc_vec3 wi = lc_add(lc_scale(sin(angle) * cos(phi), f->x),
                        lc_add(lc_scale(sin(angle) * sin(phi), f->y), lc_scale(-cos(angle), f->stage->n)));
    lc_rgb value_f = f->stage->bsdf->eval(f->stage->scene, f->hit, wi);
    value[0] = sin(angle) * f->stage->bsdf->pdf(f->stage->scene, f->hit, wi);
    for (int c = 0; c < 3; ++c)
        value[1 + c] = sin(angle) * cos(angle) * lc_channel(value_f, c);
}

/* The end of a piece from `from` to `last` at most: its angles to n, or to the surface, are within a factor of 16. */
static double next_angle(double from, double last)
{
    double end = LC_PI / 2, to = last;
    if (from > 0)
        to = fmin(to, 16 * from);
    if (last < end && end - to < (end - from) / 16 && end - last < (end - from) / 32)
        to = end - (end - from) / 16;
    return to;
}

static lc_status add_piece(double out[4], facets *f, lc_error *err)
{
    lc_status status = LC_OK;
    for (f->region = ABOVE; f->region <= BELOW && status == LC_OK; ++f->region) {
        double part[4];
        status = lc_cubature(part, 4, smoothed, f, 0, 1, 0, 1, LEAST, err);
        for (int c = 0; c < 4; ++c)
            out[c] += part[c];
    }
    return status;
}

int lc_glossy_integrals(double out[4], const lc_stage *stage, const lc_hit *hit)
{
    facets f = make_facets(stage, hit);
    lc_error err = {""};
    double t = asin(fmin(1, f.sin_o)), end = LC_PI / 2;
    /* Angles of m where a limit begins or ends; what happens there scales with the angle to n, or to the surface. */
    double angle[5] = {0, (end - t) / 2, fmin((end + t) / 2, end - t), fmax((end + t) / 2, end - t), end};
    lc_status status = lc_cubature(out, 4, beyond, &f, 0, acos(f.cos_o) * (1 - 1e-9), 0, 2 * LC_PI, LEAST, &err);
    for (int i = 0; i < 4; ++i)
        for (double from = angle[i], to; from < angle[i + 1] && status == LC_OK; from = to) {
            to = next_angle(from, angle[i + 1]);
            f.psi0 = atan(tan(from) / stage->alpha);
            f.psi1 = to < end ? atan(tan(to) / stage->alpha) : end;
            status = add_piece(out, &f, &err);
        }
    return status == LC_OK || lc_stage_fail(stage, hit, "the lobe cannot be integrated: %.200s", err.text);
}

/* ---- cells ------------------------------------------------------------------------------------------------------ */

enum { RINGS = 8, SECTORS = 8 };

/* Rings in which facets are equally many, sin^2 psi = k / RINGS. */
int lc_glossy_cell_of(const lc_stage *stage, const lc_hit *hit, lc_vec3 wi)
{
    facets f = make_facets(stage, hit);
    lc_vec3 m = lc_add(hit->wo, wi);
    double cos_m = lc_dot(stage->n, m), x = lc_dot(f.x, m), y = lc_dot(f.y, m);
    if (!(cos_m > 0))
        return LC_GLOSSY_CELLS - 1;
    double tangent2 = (x * x + y * y) / (cos_m * cos_m * stage->alpha * stage->alpha);
    int ring = (int)fmin(RINGS - 1, tangent2 / (1 + tangent2) * RINGS);
    return ring * SECTORS + (int)fmin(SECTORS - 1, (atan2(y, x) + LC_PI) / (2 * LC_PI) * SECTORS);
}

/* Over the unit square: psi, then the azimuths of the cell up to where facets are on edge. */
static void pdf_at(double *value, double s, double t, void *user)
{
    const facets *f = user;
    double psi = f->psi0 + (f->psi1 - f->psi0) * s, horizon, edge, all[4];
    limits(f, psi, &horizon, &edge);
    double width = fmax(0, fmin(f->phi1, edge) - f->phi0);
    look(all, f, psi, f->phi0 + width * t);
    value[0] = width * (f->psi1 - f->psi0) * all[0];
}

int lc_glossy_cells(double probability[LC_GLOSSY_CELLS], const lc_stage *stage, const lc_hit *hit)
{
    facets f = make_facets(stage, hit);
    lc_vec3 y = f.y;
    lc_error err = {""};
    for (int i = 0; i < RINGS * SECTORS; ++i) {
        int sector = i % SECTORS - SECTORS / 2, left = sector < 0;
        f.phi0 = 2 * LC_PI / SECTORS * (left ? -sector - 1 : sector);
        f.phi1 = f.phi0 + 2 * LC_PI / SECTORS;
        f.y = left ? lc_neg(y) : y;
        f.psi0 = asin(sqrt(i / SECTORS / (double)RINGS));
        f.psi1 = asin(sqrt((i / SECTORS + 1) / (double)RINGS));
        if (f.phi0 > LC_PI / 2) /* the facets farthest from n are on edge */
            f.psi1 = fmin(f.psi1, atan(f.cos_o / (-cos(f.phi0) * f.sin_o * stage->alpha)));
        probability[i] = 0;
        if (f.psi1 > f.psi0 && lc_cubature(&probability[i], 1, pdf_at, &f, 0, 1, 0, 1, LEAST_CELL, &err) != LC_OK)
            return lc_stage_fail(stage, hit, "pdf() cannot be integrated: %.200s", err.text);
    }
    probability[LC_GLOSSY_CELLS - 1] = 0; /* was shown to be */
    return 1;
}
