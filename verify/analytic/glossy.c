/* SPDX-License-Identifier: GPL-3.0-or-later */
/* glossy.c: rough mirrors, written in tangents as the paper has them, where the tracer has sines and cosines. */
#include "verify/analytic/effects.h"

static double tangent2(double cosine) { return (1 - cosine) * (1 + cosine) / (cosine * cosine); }

static double unmasked(double cosine, double alpha) { return 2 / (1 + sqrt(1 + alpha * alpha * tangent2(cosine))); }

double lc_ggx_value(lc_vec3 n, lc_vec3 wo, lc_vec3 wi, double alpha)
{
    double cos_o = lc_dot(n, wo), cos_i = lc_dot(n, wi);
    if (!(cos_o > 0 && cos_i > 0))
        return 0;
    double cos_h = lc_dot(n, lc_normalize(lc_add(wo, wi)));
    double slope = alpha * cos_h * cos_h * (1 + tangent2(cos_h) / (alpha * alpha));
    return unmasked(cos_o, alpha) * unmasked(cos_i, alpha) / (LC_PI * slope * slope * 4 * cos_o * cos_i);
}

/* ---- albedo ----------------------------------------------------------------------------------------------------- */

/* Seen in the plane y = 0; a facet at polar angle t and azimuth phi. */
struct facet {
    double cos_o, sin_o, alpha;
    double cos_m, sin_m;
    lc_status status;
    lc_error *err;
};

static double facet_light(double phi, void *user)
{
    const struct facet *f = user;
    double along = f->sin_o * f->sin_m * cos(phi) + f->cos_o * f->cos_m; /* wo . m */
    double cos_i = fmin(2 * along * f->cos_m - f->cos_o, 1);
    return cos_i > 0 ? unmasked(cos_i, f->alpha) * along / f->cos_m : 0;
}

/* psi: tan t = alpha tan psi, so that facets have density sin 2 psi. */
static double ring_light(double psi, void *user)
{
    struct facet *f = user;
    double tangent = f->alpha * tan(psi), sum = 0, end = LC_PI;
    f->cos_m = 1 / sqrt(1 + tangent * tangent);
    f->sin_m = tangent * f->cos_m;
    /* cos_i = 0 where cos phi is this */
    double level = f->cos_o * (1 / (2 * f->cos_m) - f->cos_m), side = f->sin_o * f->sin_m;
    if (level >= side)
        return 0;
    if (level > -side)
        end = acos(level / side);
    lc_status status = lc_quadrature(&sum, facet_light, f, 0, end, 1e-12, 1e-10, f->err);
    if (status != LC_OK)
        f->status = status;
    return sum * sin(2 * psi) / LC_PI;
}

/* psi of a facet at polar angle t < pi / 2. */
static double psi_of(double t, double alpha) { return atan(tan(t) / alpha); }

lc_status lc_ggx_albedo(double *albedo, double cosine, double alpha, lc_error *err)
{
    struct facet f = {cosine, sqrt((1 - cosine) * (1 + cosine)), alpha, 1, 0, LC_OK, err};
    double t = acos(fmin(cosine, 1));
    /* Whole circles up to the first angle, none beyond the last. */
    double cut[3] = {0, psi_of((LC_PI / 2 - t) / 2, alpha), psi_of((LC_PI / 2 + t) / 2, alpha)};
    *albedo = 0;
    for (int i = 0; i < 2; ++i) {
        double part = 0;
        lc_status status = lc_quadrature(&part, ring_light, &f, cut[i], cut[i + 1], 1e-10 * cosine, 1e-9, err);
        if (status == LC_OK)
            status = f.status;
        if (status != LC_OK)
            return status;
        *albedo += unmasked(cosine, alpha) * part / cosine;
    }
    return LC_OK;
}

/* ---- series ----------------------------------------------------------------------------------------------------- */

lc_status lc_ggx_series_fit(lc_ggx_series *out, double low, double high, double alpha, lc_error *err)
{
    double value[LC_GGX_TERMS];
    out->low = low;
    out->high = high;
    for (int k = 0; k < LC_GGX_TERMS; ++k) {
        double x = cos(LC_PI * (k + 0.5) / LC_GGX_TERMS);
        lc_status status = lc_ggx_albedo(&value[k], 0.5 * (low + high) + 0.5 * (high - low) * x, alpha, err);
        if (status != LC_OK)
            return status;
    }
    for (int j = 0; j < LC_GGX_TERMS; ++j) {
        out->term[j] = 0;
        for (int k = 0; k < LC_GGX_TERMS; ++k)
            out->term[j] += 2.0 / LC_GGX_TERMS * value[k] * cos(LC_PI * j * (k + 0.5) / LC_GGX_TERMS);
    }
    return LC_OK;
}

/* Clenshaw's recurrence. */
double lc_ggx_series_at(const lc_ggx_series *series, double cosine)
{
    double x = (2 * cosine - series->low - series->high) / (series->high - series->low), b = 0, c = 0;
    for (int j = LC_GGX_TERMS - 1; j > 0; --j) {
        double next = 2 * x * b - c + series->term[j];
        c = b;
        b = next;
    }
    return x * b - c + series->term[0] / 2;
}

/* ---- lamps ------------------------------------------------------------------------------------------------------ */

struct seen_lamp {
    lc_vec3 centre, a, b, p, n, wo;
    double alpha;
};

static void lamp_light(double *value, double x, double y, void *user)
{
    const struct seen_lamp *lamp = user;
    lc_vec3 q = lc_add(lamp->centre, lc_add(lc_scale(x, lamp->a), lc_scale(y, lamp->b)));
    lc_vec3 to = lc_sub(q, lamp->p);
    double d2 = lc_dot(to, to);
    lc_vec3 wi = lc_scale(1 / sqrt(d2), to);
    double facing = fmax(0, -lc_dot(lc_cross(lamp->a, lamp->b), wi)); /* cos' times the area of the unit square's image */
    value[0] = lc_ggx_value(lamp->n, lamp->wo, wi, lamp->alpha) * fmax(0, lc_dot(lamp->n, wi)) * facing / d2;
}

lc_status lc_ggx_rectangle(double *out, lc_vec3 centre, lc_vec3 a, lc_vec3 b, lc_vec3 p, lc_vec3 n, lc_vec3 wo,
                           double alpha, double absolute, lc_error *err)
{
    struct seen_lamp lamp = {centre, a, b, p, n, wo, alpha};
    return lc_cubature(out, 1, lamp_light, &lamp, -1, 1, -1, 1, absolute, err);
}
