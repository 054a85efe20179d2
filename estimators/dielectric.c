/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * dielectric: mirror, which also goes through glass.
 *
 * Integral:   as mirror, with glass: L(wo) = F L(reflected) + (1 - F) L(refracted) / ior^2, F the exact Fresnel reflectance for unpolarised light, ior
 *             the index beyond over the index on the side of wo. Radiance over index squared is what refraction keeps: light that enters
 *             a denser medium is squeezed into a smaller cone.
 * Estimator:  lobes chosen in proportion to their reflectance, as in mirror; then reflection with probability F, so that its weight is F / F = 1,
 *             else refraction with weight (1 - F) / (1 - F) / ior^2. Beyond the critical angle F = 1.
 * Source:     "Path Tracing" (Bikker, INFOMAGR 2021-22), dielectrics; Veach, Robust Monte Carlo Methods for Light Transport Simulation,
 *             PhD thesis, Stanford 1997, section 5.2 (the factor 1 / ior^2)
 * Language:   L (D|R|T){0,B} E. Omits lights without area.
 */
#include "lightcheck.h"

static lc_rgb refract_or_reflect(const lc_hit *hit, double ior, double weight, lc_sampler *sampler, lc_vec3 *wi)
{
    double cos_i = fabs(lc_dot(hit->n, hit->wo));
    if (lc_next(sampler) < lc_fresnel(cos_i, ior) || !lc_refract(hit->wo, hit->n, ior, wi))
        *wi = lc_reflect(hit->wo, hit->n);
    else
        weight /= ior * ior;
    return lc_color(weight, weight, weight);
}

/* Chooses where the path goes on; returns what its throughput is multiplied by, black when it ends. */
static lc_rgb scatter(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_vec3 *wi)
{
    lc_material material = lc_material_at(scene, hit);
    double mirror = lc_rgb_max(material.mirror), finite = lc_rgb_max(material.diffuse) + lc_rgb_max(material.glossy);
    double total = mirror + finite + material.glass;
    if (total == 0)
        return lc_black();
    double choice = lc_next(sampler) * total;
    if (choice < material.glass)
        return refract_or_reflect(hit, material.ior, total, sampler, wi);
    if (choice < material.glass + mirror) {
        *wi = lc_reflect(hit->wo, hit->n);
        return lc_rgb_scale(total / mirror, material.mirror);
    }
    lc_vec3 n = lc_facing(hit->n, hit->wo);
    double u = lc_next(sampler), v = lc_next(sampler);
    *wi = lc_uniform_hemisphere(n, u, v);
    double cos_surface = lc_dot(n, *wi), pdf_solid = 0.5 * LC_INV_PI;
    return lc_rgb_scale(cos_surface / pdf_solid * total / finite, lc_bsdf_eval(scene, hit, *wi));
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

LC_ESTIMATOR(dielectric) = {
    LC_ABI,
    "dielectric",
    "mirror, which also goes through glass",
    "Path Tracing (Bikker 2021-22), dielectrics; Veach 1997, section 5.2",
    LC_DIFFUSE | LC_GLOSSY | LC_MIRROR | LC_GLASS,
    LC_AREA | LC_SKY,
    LC_UNBOUNDED,
    radiance,
};
