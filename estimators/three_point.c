/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * three_point: direct light in the three-point (area) form, points uniform over the union of all emitting area.
 *
 * Integral:   L_1(x'' <- x' <- x) = int_{all emitting area A} f(x, x', x'') L_e(x -> x') G(x, x') dA(x)
 *             G = V cos_surface cos_light / |x - x'|^2 [1/m^2], 0 where either cosine is negative
 * Estimator:  f L_e G / pdf_area, x uniform over A, so that pdf_area = 1 / |A|
 * Source:     Kajiya, The rendering equation, SIGGRAPH 1986, eq. 1; "Path Tracing" (Bikker, INFOMAGR 2021-22), three-point form
 * Language:   E | LDE. Omits everything indirect, and emitters without area: point and directional lights, the sky.
 */
#include "lightcheck.h"

/* The geometry term without visibility [1/m^2]. */
static double geometry(const lc_hit *hit, const lc_light_sample *light)
{
    double cos_surface = lc_dot(lc_facing(hit->n, hit->wo), light->wi);
    double cos_light = -lc_dot(light->n, light->wi);
    if (!(cos_surface > 0 && cos_light > 0))
        return 0.0;
    return cos_surface * cos_light / (light->distance * light->distance);
}

static lc_rgb direct(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler)
{
    lc_light_sample light;
    if (!lc_light_sample_union(scene, hit, sampler, &light))
        return lc_black();
    double g = geometry(hit, &light);
    if (g == 0 || !lc_visible(scene, hit, &light))
        return lc_black();
    return lc_rgb_scale(g / light.pdf_area, lc_rgb_mul(lc_bsdf_eval(scene, hit, light.wi), light.radiance));
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

LC_ESTIMATOR(three_point) = {
    LC_ABI,
    "three_point",
    "direct light in the three-point (area) form, uniform over all emitting area",
    "Kajiya 1986, eq. 1; Path Tracing (Bikker 2021-22), three-point form",
    LC_DIFFUSE | LC_GLOSSY,
    LC_AREA,
    1,
    radiance,
};
