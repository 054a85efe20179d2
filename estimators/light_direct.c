/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * light_direct: direct light by sampling the lights, one chosen uniformly; solid-angle form.
 *
 * Integral:   L_1(p, wo) = sum over lights i of int_{light i's directions} f(wi, wo) L_e V cos_surface dwi
 * Estimator:  N f L_e V cos_surface / pdf_solid, light i with probability 1/N, q uniform over its area,
 *             pdf_solid = pdf_area d^2 / cos_light, where cos_light > 0: the back of a light is dark.
 *             Point and directional lights: N f E cos_surface V, E the irradiance across wi (I / d^2, or E0).
 * Source:     "Path Tracing" (Bikker, INFOMAGR 2021-22), direct light, method 2; Shirley, Wang, Zimmerman,
 *             Monte Carlo techniques for direct lighting calculations, TOG 15(1) 1996, eq. 6
 * Language:   E | LDE. Omits everything indirect, and the sky.
 */
#include "lightcheck.h"

static lc_rgb direct(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler)
{
    int count = lc_light_count(scene);
    if (count == 0)
        return lc_black();
    lc_light_sample light;
    lc_light_sample_one(scene, (int)(lc_next(sampler) * count), hit, sampler, &light);

    double cos_surface = lc_dot(lc_facing(hit->n, hit->wo), light.wi);
    if (!(cos_surface > 0))
        return lc_black();
    lc_rgb incoming = light.irradiance;
    if (!light.is_delta) {
        double cos_light = -lc_dot(light.n, light.wi);
        if (!(cos_light > 0))
            return lc_black();
        double pdf_solid = light.pdf_area * light.distance * light.distance / cos_light;
        incoming = lc_rgb_scale(1.0 / pdf_solid, light.radiance);
    }
    if (!lc_visible(scene, hit, &light))
        return lc_black();
    return lc_rgb_scale(count * cos_surface, lc_rgb_mul(lc_bsdf_eval(scene, hit, light.wi), incoming));
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

LC_ESTIMATOR(light_direct) = {
    LC_ABI,
    "light_direct",
    "direct light by sampling lights, one chosen uniformly (solid-angle form)",
    "Path Tracing (Bikker 2021-22), direct light, method 2; Shirley, Wang, Zimmerman 1996, eq. 6",
    LC_DIFFUSE | LC_GLOSSY,
    LC_AREA | LC_POINT | LC_DIRECTIONAL,
    1,
    radiance,
};
