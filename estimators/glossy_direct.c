/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * glossy_direct: direct light off rough mirrors, by sampling the surface instead of the lights.
 *
 * Integral:   L_1(p, wo) = int_hemisphere f(wi, wo) L_0(p, wi) cos_surface dwi, f the glossy lobe alone
 * Estimator:  f L_0 cos_surface / pdf, wi by reflecting wo in a facet that the viewer sees (lc_bsdf_sample): small for light that comes
 *             from where the highlight is, and of little variance for a sky. Where the choice falls on another lobe, 0.
 * Source:     Walter, Marschner, Li, Torrance, Microfacet models for refraction through rough surfaces, EGSR 2007; Heitz, Sampling the
 *             GGX distribution of visible normals, JCGT 7(4) 2018; "Path Tracing" (Bikker, INFOMAGR 2021-22), glossy reflection
 * Language:   E | LGE. Omits diffuse surfaces, mirrors, glass, and lights without area, which no direction ever hits.
 */
#include "lightcheck.h"

static lc_rgb direct(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler)
{
    lc_scatter way;
    if (!lc_bsdf_sample(scene, hit, sampler, &way) || way.is_delta)
        return lc_black();
    double cos_surface = lc_dot(lc_facing(hit->n, hit->wo), way.wi);
    if (!(cos_surface > 0)) /* a facet that leads below the horizon */
        return lc_black();
    lc_rgb diffuse = lc_rgb_scale(LC_INV_PI, lc_material_at(scene, hit).diffuse);
    lc_rgb f = lc_rgb_add(way.value, lc_rgb_scale(-1.0, diffuse));

    lc_hit next;
    lc_trace(scene, hit, way.wi, &next); /* a miss sees the sky */
    return lc_rgb_scale(cos_surface / way.pdf, lc_rgb_mul(f, lc_emission(scene, &next)));
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

LC_ESTIMATOR(glossy_direct) = {
    LC_ABI,
    "glossy_direct",
    "direct light off rough mirrors, by the facets that the viewer sees",
    "Walter, Marschner, Li, Torrance 2007; Heitz 2018; Path Tracing (Bikker 2021-22), glossy reflection",
    LC_GLOSSY,
    LC_AREA | LC_SKY,
    1,
    radiance,
};
