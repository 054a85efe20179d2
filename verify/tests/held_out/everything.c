/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All lobes, two ways to find a lamp, and a roulette. */
#include "lightcheck.h"

typedef struct state {
    lc_hit at;
    lc_rgb beta;
    double density; /* of the last direction, survival included */
    int sharp;      /* it came off a mirror or through glass, or from the camera */
} state;

static double survive(const lc_scene *s, const lc_hit *h)
{
    double a = lc_rgb_max(lc_material_at(s, h).diffuse);
    return a < 0.1 ? 0.1 : a > 0.9 ? 0.9 : a;
}

static double density_of_lamp(const lc_scene *s, double pa, double d, double c)
{
    return c > 0 && pa > 0 ? pa * d * d / (c * lc_light_count(s)) : 0;
}

static lc_rgb from_lamp(const lc_scene *s, const lc_hit *h, lc_sampler *r)
{
    lc_light_sample y;
    int m = lc_light_count(s);
    if (!m)
        return lc_black();
    lc_light_sample_one(s, (int)(m * lc_next(r)), h, r, &y);
    lc_rgb f = lc_bsdf_eval(s, h, y.wi);
    double c = fabs(lc_dot(h->n, y.wi));
    if (lc_rgb_max(f) <= 0 || !lc_visible(s, h, &y))
        return lc_black();
    if (y.is_delta)
        return lc_rgb_scale(m * c, lc_rgb_mul(f, y.irradiance));
    double p = density_of_lamp(s, y.pdf_area, y.distance, -lc_dot(y.n, y.wi));
    double q = survive(s, h);
    double other = q * lc_bsdf_pdf(s, h, y.wi);
    return p > 0 ? lc_rgb_scale(c / (p + other), lc_rgb_mul(f, y.radiance)) : lc_black();
}

static lc_rgb emitted(const lc_scene *s, const state *st)
{
    lc_rgb e = lc_rgb_mul(st->beta, lc_emission(s, &st->at));
    if (st->sharp)
        return e;
    if (!st->at.valid)
        return e;
    double p = density_of_lamp(s, lc_light_pdf_area(s, &st->at), st->at.distance, lc_dot(st->at.n, st->at.wo));
    double share = st->density / (st->density + p);
    return lc_rgb_scale(share, e);
}

static int step(const lc_scene *s, state *st, lc_sampler *r)
{
    lc_scatter way;
    if (!lc_bsdf_sample(s, &st->at, r, &way))
        return 0;
    double q = way.is_delta ? 1 : survive(s, &st->at);
    if (lc_next(r) >= q)
        return 0;
    double c = way.is_delta ? 1 : fabs(lc_dot(st->at.n, way.wi));
    st->density = q * way.pdf;
    double divisor = q * way.pdf;
    st->beta = lc_rgb_scale(c / divisor, lc_rgb_mul(st->beta, way.value));
    st->sharp = way.is_delta;
    lc_trace(s, &st->at, way.wi, &st->at);
    return 1;
}

static lc_rgb radiance(const lc_scene *s, const lc_ray *ray, const lc_hit *hit, const lc_options *o, lc_sampler *r)
{
    state st = {*hit, {1, 1, 1}, 0, 1};
    lc_rgb sum = lc_black();
    (void)ray;
    for (int k = 0; k <= o->max_bounces; ++k) {
        if (k >= o->min_bounces)
            sum = lc_rgb_add(sum, emitted(s, &st));
        if (!st.at.valid || k == o->max_bounces)
            break;
        if (k + 1 >= o->min_bounces)
            sum = lc_rgb_add(sum, lc_rgb_mul(st.beta, from_lamp(s, &st.at, r)));
        if (!step(s, &st, r))
            break;
    }
    return sum;
}

LC_ESTIMATOR(mine) = {LC_ABI,
                      "mine",
                      "everything",
                      "lecture",
                      LC_DIFFUSE | LC_MIRROR | LC_GLASS,
                      LC_AREA | LC_POINT | LC_DIRECTIONAL | LC_SKY,
                      LC_UNBOUNDED,
                      radiance};
