/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * direct_mis: direct light by two samples, one of a light and one of the BRDF, weighted by the balance heuristic.
 *
 * Integral:   L_1(p, wo) = int_hemisphere f(wi, wo) L_0(p, wi) cos_surface dwi
 * Estimator:  sum over both techniques t of f L_0 cos_surface / (pdf_light + pdf_bsdf): the weight pdf_t / (pdf_light + pdf_bsdf) has cancelled
 *             against the 1 / pdf_t of the sample. pdf_light = pdf_area d^2 / (N cos_light), pdf_bsdf = cos_surface / pi. Light sampling
 *             suits small lights, the BRDF large and near ones, where 1 / d^2 explodes; their sum is never far from the better one.
 * Source:     Veach, Guibas, Optimally combining sampling techniques for Monte Carlo rendering, SIGGRAPH 1995, eq. 5
 * Language:   E | LDE, with all emitters. Omits everything indirect.
 */
#include "lightcheck.h"

/* Density of a direction by light sampling [1/sr]; 0 for what it does not find. */
static double light_pdf(const lc_scene *scene, double pdf_area, double distance, double cos_light)
{
    return pdf_area > 0 && cos_light > 0 ? pdf_area * distance * distance / (lc_light_count(scene) * cos_light) : 0;
}

static lc_rgb by_light(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler)
{
    lc_light_sample light;
    int count = lc_light_count(scene);
    if (count == 0)
        return lc_black();
    lc_light_sample_one(scene, (int)(lc_next(sampler) * count), hit, sampler, &light);
    double cos_surface = lc_dot(lc_facing(hit->n, hit->wo), light.wi), cos_light = -lc_dot(light.n, light.wi);
    if (!(cos_surface > 0 && cos_light > 0) || !lc_visible(scene, hit, &light))
        return lc_black();
    lc_rgb f = lc_bsdf_eval(scene, hit, light.wi);
    if (light.is_delta) /* the BRDF never finds it */
        return lc_rgb_scale(count * cos_surface, lc_rgb_mul(f, light.irradiance));
    double pdf_light = light_pdf(scene, light.pdf_area, light.distance, cos_light), pdf_bsdf = cos_surface * LC_INV_PI;
    return lc_rgb_scale(cos_surface / (pdf_light + pdf_bsdf), lc_rgb_mul(f, light.radiance));
}

static lc_rgb by_bsdf(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler)
{
    lc_vec3 n = lc_facing(hit->n, hit->wo);
    double u = lc_next(sampler), v = lc_next(sampler);
    lc_vec3 wi = lc_cosine_hemisphere(n, u, v);
    lc_hit next;
    lc_trace(scene, hit, wi, &next); /* a miss sees the sky, which light sampling does not find */
    double cos_surface = lc_dot(n, wi), pdf_bsdf = cos_surface * LC_INV_PI;
    double pdf_light = light_pdf(scene, lc_light_pdf_area(scene, &next), next.distance, lc_dot(next.n, next.wo));
    lc_rgb f = lc_bsdf_eval(scene, hit, wi);
    return lc_rgb_scale(cos_surface / (pdf_light + pdf_bsdf), lc_rgb_mul(f, lc_emission(scene, &next)));
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    (void)ray;
    lc_rgb sum = lc_black();
    if (options->min_bounces <= 0)
        sum = lc_emission(scene, hit);
    if (options->min_bounces <= 1 && options->max_bounces >= 1 && hit->valid)
        sum = lc_rgb_add(sum, lc_rgb_add(by_light(scene, hit, sampler), by_bsdf(scene, hit, sampler)));
    return sum;
}

LC_ESTIMATOR(direct_mis) = {
    LC_ABI,
    "direct_mis",
    "direct light by multiple importance sampling of a light and the BRDF",
    "Veach and Guibas 1995, eq. 5",
    LC_DIFFUSE,
    LC_AREA | LC_POINT | LC_DIRECTIONAL | LC_SKY,
    1,
    radiance,
};
