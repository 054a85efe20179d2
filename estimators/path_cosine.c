/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * path_cosine: path tracing by directions in proportion to the cosine.
 *
 * Integral:   as path: L = sum over k of L_k,  L_k+1(p, wo) = int_hemisphere f(wi, wo) L_k(p', -wi) cos_surface dwi
 * Estimator:  as path, with pdf_solid = cos_surface / pi: the cosine cancels, and over Lambert's f = albedo / pi each surface leaves
 *             just its albedo. Directions that bring little are rarely tried.
 * Source:     Kajiya 1986; Shirley, Physically Based Lighting Calculations for Computer Graphics, PhD thesis, Illinois 1991
 *             (importance sampling of the diffuse BRDF)
 * Language:   L D{0,B} E. Omits mirrors, glass, and lights without area, which no direction ever hits.
 */
#include "lightcheck.h"

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *first, const lc_options *options,
                       lc_sampler *sampler)
{
    lc_rgb sum = lc_black(), throughput = lc_color(1, 1, 1);
    lc_hit hit = *first;
    (void)ray;
    for (int k = 0;; ++k) {
        if (k >= options->min_bounces)
            sum = lc_rgb_add(sum, lc_rgb_mul(throughput, lc_emission(scene, &hit)));
        if (k == options->max_bounces || !hit.valid)
            return sum;

        lc_vec3 n = lc_facing(hit.n, hit.wo);
        double u = lc_next(sampler), v = lc_next(sampler);
        lc_vec3 wi = lc_cosine_hemisphere(n, u, v);
        double cos_surface = lc_dot(n, wi), pdf_solid = cos_surface * LC_INV_PI;
        throughput = lc_rgb_mul(throughput, lc_rgb_scale(cos_surface / pdf_solid, lc_bsdf_eval(scene, &hit, wi)));
        if (lc_rgb_max(throughput) == 0)
            return sum;
        lc_trace(scene, &hit, wi, &hit);
    }
}

LC_ESTIMATOR(path_cosine) = {
    LC_ABI,
    "path_cosine",
    "path tracing by directions in proportion to the cosine",
    "Kajiya 1986; Shirley 1991, importance sampling of the diffuse BRDF",
    LC_DIFFUSE,
    LC_AREA | LC_SKY,
    LC_UNBOUNDED,
    radiance,
};
