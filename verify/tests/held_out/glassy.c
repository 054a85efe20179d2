/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Paths that follow mirrors and glass: Snell and Fresnel by hand. */
#include "lightcheck.h"

/* n1 on the viewer's side is 1, n2 = eta beyond. Returns the reflectance; *cos_t < 0 at total reflection. */
static double reflectance(double cos_i, double eta, double *cos_t)
{
    double sin_t2 = (1 - cos_i * cos_i) / (eta * eta);
    *cos_t = -1;
    if (sin_t2 >= 1)
        return 1;
    *cos_t = sqrt(1 - sin_t2);
    double across = (cos_i - eta * *cos_t) / (cos_i + eta * *cos_t);
    double along = (eta * cos_i - *cos_t) / (eta * cos_i + *cos_t);
    return (across * across + along * along) / 2;
}

/* Returns the weight, and the way on. */
static double through(lc_vec3 n, lc_vec3 wo, double eta, lc_sampler *rng, lc_vec3 *w)
{
    double cos_i = lc_dot(n, wo), cos_t;
    double f = reflectance(cos_i, eta, &cos_t);
    lc_vec3 bounced = lc_sub(lc_scale(2 * cos_i, n), wo);
    double dice = lc_next(rng);
    if (cos_t < 0) {
        *w = bounced;
        return 1;
    }
    if (dice < f) {
        *w = bounced;
        return 1;
    }
    *w = lc_sub(lc_scale(-1 / eta, lc_sub(wo, lc_scale(cos_i, n))), lc_scale(cos_t, n));
    return 1 / (eta * eta);
}

static lc_rgb gray(double g) { return lc_color(g, g, g); }

static lc_rgb radiance(const lc_scene *world, const lc_ray *ray, const lc_hit *hit, const lc_options *opt,
                       lc_sampler *rng)
{
    lc_rgb sum = lc_black(), beta = gray(1);
    lc_hit at = *hit;
    (void)ray;
    for (int k = 0;; ++k) {
        if (k >= opt->min_bounces)
            sum = lc_rgb_add(sum, lc_rgb_mul(beta, lc_emission(world, &at)));
        if (k >= opt->max_bounces || !at.valid)
            return sum;
        lc_material m = lc_material_at(world, &at);
        double matte = lc_rgb_max(m.diffuse), shiny = lc_rgb_max(m.mirror), clear = m.glass;
        double all = matte + shiny + clear;
        if (all <= 0)
            return sum;
        lc_vec3 n = lc_facing(at.n, at.wo), w;
        double pick = lc_next(rng) * all;
        if (pick < matte) {
            double a = lc_next(rng), b = lc_next(rng);
            w = lc_cosine_hemisphere(n, a, b);
            beta = lc_rgb_mul(beta, lc_rgb_scale(all / matte, m.diffuse));
        } else if (pick < matte + shiny) {
            w = lc_sub(lc_scale(2 * lc_dot(n, at.wo), n), at.wo);
            beta = lc_rgb_mul(beta, lc_rgb_scale(all / shiny, m.mirror));
        } else {
            double g = through(n, at.wo, m.ior, rng, &w);
            beta = lc_rgb_scale(g * all, beta);
        }
        if (lc_rgb_max(beta) <= 0)
            return sum;
        lc_trace(world, &at, lc_normalize(w), &at);
    }
}

LC_ESTIMATOR(mine) = {LC_ABI,         "mine",           "glass",      "lecture", LC_DIFFUSE | LC_MIRROR | LC_GLASS,
                      LC_AREA | LC_SKY, LC_UNBOUNDED, radiance};
