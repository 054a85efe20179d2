/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * mirror: path, which also follows mirrors: pure, tinted, and half-reflective by a random choice.
 *
 * Integral:   as path, with the BSDF f + r(wo) delta(wi - reflected wo) / cos_surface: the mirror's share of the integral is r L(reflected),
 *             without a cosine.
 * Estimator:  a particle must choose. With probability q it takes the mirror: throughput r / q; else a uniform direction: throughput
 *             f cos_surface / (pdf_solid (1 - q)). Any 0 < q < 1 is right; q = max(r) / (max(r) + max(albedo)) wastes little. A rough
 *             mirror has a value f everywhere, and counts with the albedo.
 * Source:     "Path Tracing" (Bikker, INFOMAGR 2021-22), red mirrors and half-reflective materials; Kajiya 1986
 * Language:   L (D|R){0,B} E. Omits glass, and lights without area.
 */
#include "lightcheck.h"

/* Chooses where the path goes on; returns what its throughput is multiplied by, black when it ends. */
static lc_rgb scatter(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_vec3 *wi)
{
    lc_material material = lc_material_at(scene, hit);
    double mirror = lc_rgb_max(material.mirror), finite = lc_rgb_max(material.diffuse) + lc_rgb_max(material.glossy);
    if (mirror + finite == 0)
        return lc_black();
    double q = mirror / (mirror + finite);
    if (lc_next(sampler) < q) {
        *wi = lc_reflect(hit->wo, hit->n);
        return lc_rgb_scale(1 / q, material.mirror);
    }
    lc_vec3 n = lc_facing(hit->n, hit->wo);
    double u = lc_next(sampler), v = lc_next(sampler);
    *wi = lc_uniform_hemisphere(n, u, v);
    double cos_surface = lc_dot(n, *wi), pdf_solid = 0.5 * LC_INV_PI;
    return lc_rgb_scale(cos_surface / (pdf_solid * (1 - q)), lc_bsdf_eval(scene, hit, *wi));
}

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
        lc_vec3 wi;
        throughput = lc_rgb_mul(throughput, scatter(scene, &hit, sampler, &wi));
        if (lc_rgb_max(throughput) == 0)
            return sum;
        lc_trace(scene, &hit, wi, &hit);
    }
}

LC_ESTIMATOR(mirror) = {
    LC_ABI,
    "mirror",
    "path, which also follows mirrors: tinted, and half-reflective by a random choice",
    "Path Tracing (Bikker 2021-22), red mirrors and half-reflective materials; Kajiya 1986",
    LC_DIFFUSE | LC_GLOSSY | LC_MIRROR,
    LC_AREA | LC_SKY,
    LC_UNBOUNDED,
    radiance,
};
