/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * path_analog: a particle's walk: a surface absorbs it with probability 1 - albedo, and else leaves it as it was.
 *
 * Integral:   as path
 * Estimator:  L_e(x_k) for each surface that the particle reaches. It survives with probability q = albedo, goes on in proportion to the
 *             cosine, and weighs f cos_surface / (pdf_solid q) = 1. The three channels share one particle: q is the largest of the
 *             albedo, and the others carry albedo / q <= 1.
 * Source:     "Path Tracing" (Bikker, INFOMAGR 2021-22), particle transport: "a path loses 1 - albedo"; Arvo, Kirk, Particle transport and
 *             image synthesis, SIGGRAPH 1990
 * Language:   L D{0,B} E. Omits mirrors, glass, and lights without area, which no direction ever hits.
 */
#include "lightcheck.h"

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *first, const lc_options *options,
                       lc_sampler *sampler)
{
    lc_rgb sum = lc_black(), weight = lc_color(1, 1, 1);
    lc_hit hit = *first;
    (void)ray;
    for (int k = 0;; ++k) {
        if (k >= options->min_bounces)
            sum = lc_rgb_add(sum, lc_rgb_mul(weight, lc_emission(scene, &hit)));
        if (k == options->max_bounces || !hit.valid)
            return sum;

        double q = lc_rgb_max(lc_material_at(scene, &hit).diffuse);
        if (lc_next(sampler) >= q) /* always, where q = 0 */
            return sum;
        lc_vec3 n = lc_facing(hit.n, hit.wo);
        double u = lc_next(sampler), v = lc_next(sampler);
        lc_vec3 wi = lc_cosine_hemisphere(n, u, v);
        double cos_surface = lc_dot(n, wi), pdf_solid = cos_surface * LC_INV_PI;
        weight = lc_rgb_mul(weight, lc_rgb_scale(cos_surface / (pdf_solid * q), lc_bsdf_eval(scene, &hit, wi)));
        lc_trace(scene, &hit, wi, &hit);
    }
}

LC_ESTIMATOR(path_analog) = {
    LC_ABI,
    "path_analog",
    "a walk that survives each surface with probability = albedo",
    "Path Tracing (Bikker 2021-22), particle transport; Arvo and Kirk 1990",
    LC_DIFFUSE,
    LC_AREA | LC_SKY,
    LC_UNBOUNDED,
    radiance,
};
