/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Paths that find a lamp in two ways, and weigh them. */
#include "lightcheck.h"

static double balance(double mine, double other) { return mine / (mine + other); }

static double lamp_density(const lc_scene *s, double per_area, double d, double cosine)
{
    if (cosine <= 0)
        return 0;
    return per_area * d * d / cosine / lc_light_count(s);
}

static lc_rgb by_lamp(const lc_scene *s, const lc_hit *x, lc_sampler *rnd)
{
    lc_light_sample y;
    int lamps = lc_light_count(s);
    if (lamps < 1)
        return lc_black();
    lc_light_sample_one(s, (int)(lc_next(rnd) * lamps), x, rnd, &y);
    double cos_x = lc_dot(lc_facing(x->n, x->wo), y.wi);
    if (cos_x <= 0 || !lc_visible(s, x, &y))
        return lc_black();
    lc_rgb f = lc_rgb_scale(1 / LC_PI, lc_material_at(s, x).diffuse);
    double by_brdf = cos_x / LC_PI;
    if (y.is_delta)
        return lc_rgb_scale(lamps * cos_x, lc_rgb_mul(f, y.irradiance));
    double cos_y = -lc_dot(y.n, y.wi);
    if (cos_y <= 0)
        return lc_black();
    double density = lamp_density(s, y.pdf_area, y.distance, cos_y);
    double w = balance(density, by_brdf);
    return lc_rgb_scale(w * cos_x / density, lc_rgb_mul(f, y.radiance));
}

static lc_rgb radiance(const lc_scene *s, const lc_ray *ray, const lc_hit *first, const lc_options *o, lc_sampler *rnd)
{
    lc_rgb sum = lc_black(), beta = lc_color(1, 1, 1);
    lc_hit x = *first;
    double last = 0;
    (void)ray;
    for (int k = 0; k <= o->max_bounces; ++k) {
        double w = 1;
        if (k > 0 && x.valid) {
            double density = lamp_density(s, lc_light_pdf_area(s, &x), x.distance, lc_dot(x.n, x.wo));
            w = balance(last, density);
        }
        if (k >= o->min_bounces)
            sum = lc_rgb_add(sum, lc_rgb_scale(w, lc_rgb_mul(beta, lc_emission(s, &x))));
        if (!x.valid || k == o->max_bounces)
            break;
        if (k + 1 >= o->min_bounces)
            sum = lc_rgb_add(sum, lc_rgb_mul(beta, by_lamp(s, &x, rnd)));
        lc_vec3 n = lc_facing(x.n, x.wo);
        double u = lc_next(rnd), v = lc_next(rnd);
        lc_vec3 to = lc_cosine_hemisphere(n, u, v);
        last = lc_dot(n, to) / LC_PI;
        beta = lc_rgb_mul(beta, lc_material_at(s, &x).diffuse);
        if (lc_rgb_max(beta) <= 0)
            break;
        lc_trace(s, &x, to, &x);
    }
    return sum;
}

LC_ESTIMATOR(mine) = {LC_ABI,
                      "mine",
                      "two ways",
                      "lecture",
                      LC_DIFFUSE,
                      LC_AREA | LC_POINT | LC_DIRECTIONAL | LC_SKY,
                      LC_UNBOUNDED,
                      radiance};
