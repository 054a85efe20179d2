/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Direct light in two ways, weighed. */
#include "lightcheck.h"

static lc_rgb radiance(const lc_scene *s, const lc_ray *ray, const lc_hit *x, const lc_options *o, lc_sampler *rnd)
{
    lc_rgb sum = lc_black();
    (void)ray;
    if (o->min_bounces <= 0)
        sum = lc_emission(s, x);
    if (!x->valid || o->max_bounces < 1 || o->min_bounces > 1)
        return sum;
    lc_vec3 n = lc_facing(x->n, x->wo);
    lc_rgb f = lc_rgb_scale(LC_INV_PI, lc_material_at(s, x).diffuse);
    int lamps = lc_light_count(s);
    if (lamps > 0) {
        lc_light_sample y;
        lc_light_sample_one(s, (int)(lc_next(rnd) * lamps), x, rnd, &y);
        double here = lc_dot(n, y.wi), there = -lc_dot(y.n, y.wi);
        if (y.is_delta && here > 0 && lc_visible(s, x, &y))
            sum = lc_rgb_add(sum, lc_rgb_scale(lamps * here, lc_rgb_mul(f, y.irradiance)));
        if (!y.is_delta && here > 0 && there > 0 && lc_visible(s, x, &y)) {
            double a = y.pdf_area * y.distance * y.distance / (there * lamps), b = here * LC_INV_PI;
            double share = a / (a + b);
            sum = lc_rgb_add(sum, lc_rgb_scale(share * here / a, lc_rgb_mul(f, y.radiance)));
        }
    }
    double u = lc_next(rnd), v = lc_next(rnd);
    lc_vec3 w = lc_cosine_hemisphere(n, u, v);
    double b = lc_dot(n, w) * LC_INV_PI, share = 1;
    lc_hit y;
    if (lc_trace(s, x, w, &y)) {
        double there = lc_dot(y.n, y.wo);
        double a = there > 0 ? lc_light_pdf_area(s, &y) * y.distance * y.distance / (there * lamps) : 0;
        share = a > 0 ? b / (a + b) : 1;
    }
    return lc_rgb_add(sum, lc_rgb_scale(LC_PI * share, lc_rgb_mul(f, lc_emission(s, &y))));
}

LC_ESTIMATOR(mine) = {LC_ABI,
                      "mine",
                      "two ways, one bounce",
                      "lecture",
                      LC_DIFFUSE,
                      LC_AREA | LC_POINT | LC_DIRECTIONAL | LC_SKY,
                      1,
                      radiance};
