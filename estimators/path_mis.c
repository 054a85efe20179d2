/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * path_mis: path tracing, where each light may be found by sampling it or by the next ray: multiple importance sampling.
 *
 * Integral:   as path
 * Estimator:  at each surface both techniques, each times its share of the densities with which the two would have found that direction,
 *             which is the balance heuristic:
 *                 light sampling:  w_light f L_e V cos_surface / pdf_light,  w_light = pdf_light / (pdf_light + pdf_bsdf)
 *                 the next ray:    w_bsdf f L_e cos_surface / pdf_bsdf,      w_bsdf = pdf_bsdf / (pdf_light + pdf_bsdf)
 *             pdf_light = pdf_area d^2 / (N cos_light), a light being chosen with probability 1 / N; pdf_bsdf = cos_surface / pi. The weights
 *             sum to 1 for each direction that both can find. Where only one can, it has weight 1: a point light, the sky, what the camera sees.
 * Source:     Veach, Guibas, Optimally combining sampling techniques for Monte Carlo rendering, SIGGRAPH 1995, eq. 3 and 5;
 *             "Path Tracing" (Bikker, INFOMAGR 2021-22), margins: Mis2
 * Language:   L D{0,B} E, with all emitters. Omits mirrors and glass.
 */
#include "lightcheck.h"

/* Density of a direction by light sampling [1/sr]; both techniques need it, from either end. */
static double light_pdf(const lc_scene *scene, double pdf_area, double distance, double cos_light)
{
    return pdf_area > 0 && cos_light > 0 ? pdf_area * distance * distance / (lc_light_count(scene) * cos_light) : 0;
}

/* Light sampling: what comes straight from a light, times w_light. */
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
    lc_rgb reflected = lc_rgb_scale(cos_surface, f);
    if (light.is_delta) /* no ray finds it: weight 1 */
        return lc_rgb_scale(count, lc_rgb_mul(reflected, light.irradiance));
    double pdf_light = light_pdf(scene, light.pdf_area, light.distance, cos_light);
    double pdf_bsdf = cos_surface * LC_INV_PI, weight = pdf_light / (pdf_light + pdf_bsdf);
    return lc_rgb_scale(weight / pdf_light, lc_rgb_mul(reflected, light.radiance));
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *first, const lc_options *options,
                       lc_sampler *sampler)
{
    lc_rgb sum = lc_black(), throughput = lc_color(1, 1, 1);
    lc_hit hit = *first;
    double weight = 1; /* w_bsdf of the ray that led here */
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
        double cos_surface = lc_dot(n, wi), pdf_bsdf = cos_surface * LC_INV_PI;
        throughput = lc_rgb_mul(throughput, lc_rgb_scale(cos_surface / pdf_bsdf, lc_bsdf_eval(scene, &hit, wi)));
        if (lc_rgb_max(throughput) == 0)
            return sum;
        lc_trace(scene, &hit, wi, &hit);
        double pdf_light = light_pdf(scene, lc_light_pdf_area(scene, &hit), hit.distance, lc_dot(hit.n, hit.wo));
        weight = pdf_bsdf / (pdf_light + pdf_bsdf);
    }
}

LC_ESTIMATOR(path_mis) = {
    LC_ABI,
    "path_mis",
    "path tracing with multiple importance sampling of lights and BRDF (balance heuristic)",
    "Veach and Guibas 1995, eq. 3 and 5; Path Tracing (Bikker 2021-22), margins: Mis2",
    LC_DIFFUSE,
    LC_AREA | LC_POINT | LC_DIRECTIONAL | LC_SKY,
    LC_UNBOUNDED,
    radiance,
};
