/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * path: the path tracing algorithm, by uniform directions over the hemisphere.
 *
 * Integral:   L = sum over k of L_k,  L_k+1(p, wo) = int_hemisphere f(wi, wo) L_k(p', -wi) cos_surface dwi
 * Estimator:  T_k L_e(x_k),  T_k = product over the first k surfaces of f cos_surface / pdf_solid, pdf_solid = 1 / (2 pi);
 *             the walk ends after max_bounces surfaces, or where it leaves the scene and sees the sky. The lecture's path ends at a
 *             light; here surfaces may emit AND reflect, so it goes on.
 * Source:     Kajiya 1986; "Path Tracing" (Bikker, INFOMAGR 2021-22), the path tracing algorithm
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
        lc_vec3 wi = lc_uniform_hemisphere(n, u, v);
        double cos_surface = lc_dot(n, wi), pdf_solid = 0.5 * LC_INV_PI;
        throughput = lc_rgb_mul(throughput, lc_rgb_scale(cos_surface / pdf_solid, lc_bsdf_eval(scene, &hit, wi)));
        if (lc_rgb_max(throughput) == 0)
            return sum;
        lc_trace(scene, &hit, wi, &hit);
    }
}

LC_ESTIMATOR(path) = {
    LC_ABI,
    "path",
    "path tracing by uniform directions over the hemisphere",
    "Kajiya 1986; Path Tracing (Bikker 2021-22), the path tracing algorithm",
    LC_DIFFUSE | LC_GLOSSY,
    LC_AREA | LC_SKY,
    LC_UNBOUNDED,
    radiance,
};
