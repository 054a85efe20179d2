/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * path_mis_power: path_mis by the power heuristic, its densities taken over area instead of directions.
 *
 * Integral:   as path
 * Estimator:  as path_mis, with weights in proportion to pdf^2 (beta = 2), which trust the better technique more. The densities are those of the
 *             point on the light [1/m^2]: pdf_area / N by light sampling, cos_surface / pi cos_light / d^2 by the next ray. Any measure will
 *             do, as long as both are in the same: the Jacobian cancels in the weights.
 * Source:     Veach, Guibas, Optimally combining sampling techniques for Monte Carlo rendering, SIGGRAPH 1995, eq. 3 and section 3.2;
 *             "Path Tracing" (Bikker, INFOMAGR 2021-22), margins: Mis2
 * Language:   L D{0,B} E, with all emitters. Omits mirrors and glass.
 */
#include "lightcheck.h"

/* The weight of a sample of density pdf where another technique has pdf_other, both in the same measure. */
static double power_heuristic(double pdf, double pdf_other)
{
    return pdf * pdf / (pdf * pdf + pdf_other * pdf_other);
}

/* Density over a light's area with which a direction by the cosine finds a point of it [1/m^2]. */
static double bsdf_pdf_area(double cos_surface, double cos_light, double distance)
{
    return cos_surface * LC_INV_PI * cos_light / (distance * distance);
}

/* Light sampling: what comes straight from a light, weighted. */
static lc_rgb direct(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler)
{
    lc_light_sample light;
    int count = lc_light_count(scene);
    if (count == 0)
        return lc_black();
    lc_light_sample_one(scene, (int)(lc_next(sampler) * count), hit, sampler, &light);
    double cos_surface = lc_dot(lc_facing(hit->n, hit->wo), light.wi), cos_light = -lc_dot(light.n, light.wi);
    lc_rgb f = lc_bsdf_eval(scene, hit, light.wi);
    if (!(cos_surface > 0 && cos_light > 0 && lc_rgb_max(f) > 0) || !lc_visible(scene, hit, &light))
        return lc_black();
    if (light.is_delta) /* no ray finds it: weight 1 */
        return lc_rgb_scale(count * cos_surface, lc_rgb_mul(f, light.irradiance));
    double geometry = cos_surface * cos_light / (light.distance * light.distance), pdf_light = light.pdf_area / count;
    double weight = power_heuristic(pdf_light, bsdf_pdf_area(cos_surface, cos_light, light.distance));
    return lc_rgb_scale(weight * geometry / pdf_light, lc_rgb_mul(f, light.radiance));
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *first, const lc_options *options,
                       lc_sampler *sampler)
{
    lc_rgb sum = lc_black(), throughput = lc_color(1, 1, 1);
    lc_hit hit = *first;
    double weight = 1; /* of what the ray that led here finds */
    (void)ray;
    for (int k = 0;; ++k) {
        if (k >= options->min_bounces)
            sum = lc_rgb_add(sum, lc_rgb_mul(throughput, lc_rgb_scale(weight, lc_emission(scene, &hit))));
        if (k == options->max_bounces || !hit.valid)
            return sum;

        lc_rgb next = lc_rgb_mul(throughput, direct(scene, &hit, sampler)); /* one bounce more: a part of L_k+1 */
        if (k + 1 >= options->min_bounces)
            sum = lc_rgb_add(sum, next);

        lc_vec3 n = lc_facing(hit.n, hit.wo);
        double u = lc_next(sampler), v = lc_next(sampler);
        lc_vec3 wi = lc_cosine_hemisphere(n, u, v);
        double cos_surface = lc_dot(n, wi), pdf_solid = cos_surface * LC_INV_PI;
        throughput = lc_rgb_mul(throughput, lc_rgb_scale(cos_surface / pdf_solid, lc_bsdf_eval(scene, &hit, wi)));
        if (lc_rgb_max(throughput) == 0)
            return sum;
        lc_trace(scene, &hit, wi, &hit);
        double pdf_area = lc_light_pdf_area(scene, &hit), cos_light = lc_dot(hit.n, hit.wo);
        weight = 1; /* the sky is no light */
        if (pdf_area > 0 && cos_light > 0)
            weight = power_heuristic(bsdf_pdf_area(cos_surface, cos_light, hit.distance), pdf_area / lc_light_count(scene));
    }
}

LC_ESTIMATOR(path_mis_power) = {
    LC_ABI,
    "path_mis_power",
    "path tracing with multiple importance sampling of lights and BRDF (power heuristic)",
    "Veach and Guibas 1995, eq. 3 and the power heuristic; Path Tracing (Bikker 2021-22), margins: Mis2",
    LC_DIFFUSE,
    LC_AREA | LC_POINT | LC_DIRECTIONAL | LC_SKY,
    LC_UNBOUNDED,
    radiance,
};
