/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cross.c: azimuths where the outlines of two bodies cross, as the receiver sees them.
 *
 * Between two hiders a gap may open and close again within a fraction of a degree; no quadrature finds what it never
 * sampled, so the crossings are solved for. An outline is a chain of edges, or the ellipse c + a cos + b sin, whose
 * cone is x = alpha c + beta a + gamma b, beta^2 + gamma^2 = alpha^2: edge meets edge in a linear, edge meets cone in
 * a quadratic, ellipse meets cone in a quartic equation (in the tangent of half the angle). */
#include "verify/analytic/body.h"

#include <gsl/gsl_poly.h>

/* The outline of a disk or ball, and the dual basis of (c, a, b), which reads off alpha, beta, gamma. */
struct outline {
    lc_vec3 c, a, b, dual[3];
};

static int outline_of(struct outline *o, const lc_body *body)
{
    o->c = body->v[0], o->a = body->v[1], o->b = body->v[2];
    if (body->kind == LC_BODY_BALL) {
        double d = lc_length(body->v[0]), sine = body->radius / d, cos2 = (1 - sine) * (1 + sine);
        if (lc_body_side(body) <= 0)
            return 0;
        /* where the tangents from the receiver touch */
        lc_receiver axes = lc_receiver_at(lc_vec(0, 0, 0), lc_scale(1 / d, body->v[0]));
        o->c = lc_scale(cos2, body->v[0]);
        o->a = lc_scale(body->radius * sqrt(cos2), axes.x);
        o->b = lc_scale(body->radius * sqrt(cos2), axes.y);
    }
    double det = lc_dot(o->c, lc_cross(o->a, o->b));
    o->dual[0] = lc_scale(1 / det, lc_cross(o->a, o->b));
    o->dual[1] = lc_scale(1 / det, lc_cross(o->b, o->c));
    o->dual[2] = lc_scale(1 / det, lc_cross(o->c, o->a));
    return isfinite(1 / det);
}

/* beta beta' + gamma gamma' - alpha alpha': 0 for u = v on the cone. */
static double cone(const struct outline *o, lc_vec3 u, lc_vec3 v)
{
    return lc_dot(o->dual[1], u) * lc_dot(o->dual[1], v) + lc_dot(o->dual[2], u) * lc_dot(o->dual[2], v) -
           lc_dot(o->dual[0], u) * lc_dot(o->dual[0], v);
}

static int add_azimuth(double *phi, int count, lc_vec3 x)
{
    if (count < LC_BODY_CROSSINGS)
        phi[count++] = atan2(x.y, x.x);
    return count;
}

static int cross_polygons(const lc_body *first, const lc_body *second, double *phi)
{
    int count = 0;
    for (int i = 0; i < first->count; ++i)
        for (int j = 0; j < second->count; ++j) {
            lc_vec3 a = first->v[i], e = lc_sub(first->v[(i + 1) % first->count], a);
            lc_vec3 b = second->v[j], f = lc_sub(second->v[(j + 1) % second->count], b);
            /* where each edge meets the plane of the other and the receiver */
            lc_vec3 plane_a = lc_cross(a, e), plane_b = lc_cross(b, f);
            double t = -lc_dot(plane_b, a) / lc_dot(plane_b, e), s = -lc_dot(plane_a, b) / lc_dot(plane_a, f);
            if (t >= 0 && t <= 1 && s >= 0 && s <= 1)
                count = add_azimuth(phi, count, lc_add(a, lc_scale(t, e)));
        }
    return count;
}

static int cross_polygon_outline(const lc_body *polygon, const struct outline *o, double *phi)
{
    int count = 0;
    for (int i = 0; i < polygon->count; ++i) {
        lc_vec3 a = polygon->v[i], e = lc_sub(polygon->v[(i + 1) % polygon->count], a);
        double t[2];
        int roots = gsl_poly_solve_quadratic(cone(o, e, e), 2 * cone(o, a, e), cone(o, a, a), &t[0], &t[1]);
        for (int k = 0; k < roots; ++k)
            if (t[k] >= 0 && t[k] <= 1)
                count = add_azimuth(phi, count, lc_add(a, lc_scale(t[k], e)));
    }
    return count;
}

static lc_vec3 outline_at(const struct outline *o, double psi)
{
    return lc_add(o->c, lc_add(lc_scale(cos(psi), o->a), lc_scale(sin(psi), o->b)));
}

static int cross_outlines(const struct outline *first, const struct outline *second, double *phi)
{
    /* a root at u = infinity would spoil the quartic: start opposite to where the two are well apart; of five places
     * four at most can be roots */
    double start = 0, best = 0;
    for (int i = 0; i < 5; ++i) {
        lc_vec3 x = outline_at(first, 2 * LC_PI * i / 5 + 0.3);
        double apart = fabs(cone(second, x, x));
        if (apart > best)
            best = apart, start = 2 * LC_PI * i / 5 + 0.3 + LC_PI;
    }
    gsl_poly_complex_workspace *work = best > 0 ? gsl_poly_complex_workspace_alloc(5) : NULL;
    if (!work)
        return 0; /* the same outline */
    double c = cos(start), s = sin(start);
    lc_vec3 a = lc_add(lc_scale(c, first->a), lc_scale(s, first->b));
    lc_vec3 b = lc_sub(lc_scale(c, first->b), lc_scale(s, first->a));
    double k0 = cone(second, first->c, first->c), k1 = 2 * cone(second, first->c, a);
    double k2 = 2 * cone(second, first->c, b);
    double k3 = cone(second, a, a), k4 = 2 * cone(second, a, b), k5 = cone(second, b, b);
    const double poly[5] = {k0 + k1 + k3, 2 * (k2 + k4), 2 * k0 - 2 * k3 + 4 * k5, 2 * (k2 - k4), k0 - k1 + k3};
    double root[8];
    int count = 0;
    if (!gsl_poly_complex_solve(poly, 5, work, root))
        for (int i = 0; i < 4; ++i) /* nearly real ones: outlines that all but touch */
            if (fabs(root[2 * i + 1]) < 1e-4 * (1 + fabs(root[2 * i])))
                count = add_azimuth(phi, count, outline_at(first, start + 2 * atan(root[2 * i])));
    gsl_poly_complex_workspace_free(work);
    return count;
}

int lc_body_crossings(const lc_body *first, const lc_body *second, double *phi)
{
    struct outline a, b;
    if (first->kind == LC_BODY_SKY || second->kind == LC_BODY_SKY)
        return 0;
    if (first->kind == LC_BODY_POLYGON && second->kind == LC_BODY_POLYGON)
        return cross_polygons(first, second, phi);
    if (first->kind == LC_BODY_POLYGON)
        return outline_of(&b, second) ? cross_polygon_outline(first, &b, phi) : 0;
    if (second->kind == LC_BODY_POLYGON)
        return outline_of(&a, first) ? cross_polygon_outline(second, &a, phi) : 0;
    return outline_of(&a, first) && outline_of(&b, second) ? cross_outlines(&a, &b, phi) : 0;
}
