/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * light_solid_angle: light_direct, where directions are uniform over the solid angle of a light instead of points over its area.
 *
 * Integral:   L_1(p, wo) = sum over lights i of int_{light i's directions} f(wi, wo) L_e V cos_surface dwi
 * Estimator:  N f L_e V cos_surface / pdf_solid, light i with probability 1/N, pdf_solid = 1 / (its solid angle as seen from p), for spheres a
 *             cone, for rectangles a spherical rectangle. No 1 / d^2 and no cos_light are left to vary; half of a sphere's area, which
 *             cannot be seen, is never tried. Other shapes by area: pdf_solid = pdf_area d^2 / cos_light.
 * Source:     Shirley, Wang, Zimmerman, TOG 15(1) 1996, eq. 10 (spheres); Urena, Fajardo, King, An area-preserving parametrization for
 *             spherical rectangles, EGSR 2013
 * Language:   E | LDE. Omits everything indirect, and the sky.
 */
#include "lightcheck.h"

static lc_rgb direct(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler)
{
    lc_light_sample light;
    int count = lc_light_count(scene);
    if (count == 0)
        return lc_black();
    lc_light_sample_solid(scene, (int)(lc_next(sampler) * count), hit, sampler, &light);
    double cos_surface = lc_dot(lc_facing(hit->n, hit->wo), light.wi), cos_light = -lc_dot(light.n, light.wi);
    if (!(cos_surface > 0 && cos_light > 0) || !lc_visible(scene, hit, &light))
        return lc_black();
    lc_rgb incoming = light.is_delta ? light.irradiance : lc_rgb_scale(1 / light.pdf_solid, light.radiance);
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

LC_ESTIMATOR(light_solid_angle) = {
    LC_ABI,
    "light_solid_angle",
    "direct light by directions uniform over the solid angle of a light",
    "Shirley, Wang, Zimmerman 1996, eq. 10; Urena, Fajardo, King 2013",
    LC_DIFFUSE,
    LC_AREA | LC_POINT | LC_DIRECTIONAL,
    1,
    radiance,
};
