/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * hemisphere_direct: direct light by uniform directions over the hemisphere.
 *
 * Integral:   L_1(p, wo) = int_hemisphere f(wi, wo) L_0(p, wi) cos_surface dwi
 * Estimator:  2 pi f L_0 cos_surface, wi uniform over the hemisphere on the viewer's side (pdf_solid = 1 / (2 pi))
 * Source:     Kajiya 1986, in hemispherical form; "Path Tracing" (Bikker, INFOMAGR 2021-22), direct light, method 1
 * Language:   E | LDE. Omits everything indirect, and lights without area, which no direction ever hits.
 */
#include "lightcheck.h"

static lc_rgb direct(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler)
{
    lc_vec3 n = lc_facing(hit->n, hit->wo);
    double u = lc_next(sampler), v = lc_next(sampler);
    lc_vec3 wi = lc_uniform_hemisphere(n, u, v);
    double cos_surface = lc_dot(n, wi), pdf_solid = 0.5 * LC_INV_PI;

    lc_hit next;
    lc_trace(scene, hit, wi, &next); /* a miss sees the sky */
    lc_rgb f = lc_bsdf_eval(scene, hit, wi);
    return lc_rgb_scale(cos_surface / pdf_solid, lc_rgb_mul(f, lc_emission(scene, &next)));
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    (void)ray;
    lc_rgb sum = lc_black();
    if (options->min_bounces <= 0)
        sum = lc_emission(scene, hit);
    if (options->min_bounces <= 1 && options->max_bounces >= 1 && hit->valid)
        sum = lc_rgb_add(sum, direct(scene, hit, sampler));
    return sum;
}

LC_ESTIMATOR(hemisphere_direct) = {
    LC_ABI,
    "hemisphere_direct",
    "direct light by uniform directions over the hemisphere",
    "Path Tracing (Bikker 2021-22), direct light, method 1; Kajiya 1986, eq. 1 in hemispherical form",
    LC_DIFFUSE | LC_GLOSSY,
    LC_AREA | LC_SKY,
    1,
    radiance,
};
