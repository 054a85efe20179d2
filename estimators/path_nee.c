/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * path_nee: path_cosine with next-event estimation: at each surface a light is sampled.
 *
 * Integral:   L = sum over k of L_k, each but L_0 split by what the last segment sees: a light or the sky.
 * Estimator:  T_k D(x_k) for the lights, D the estimator of light_direct, which makes it a part of L_k+1; T_k L_sky where the path leaves
 *             the scene. T_k is the product of f cos_surface / pdf_solid over the first k surfaces. What a ray of the path itself finds
 *             glowing was sampled one surface before, so it does not count again; only what the camera sees does.
 * Source:     Coveyou, Cain, Yost, Adjoint and importance in Monte Carlo application, Nucl. Sci. Eng. 27, 1967 (the name); Shirley, Wang,
 *             Zimmerman 1996; "Path Tracing" (Bikker, INFOMAGR 2021-22), margins: SampleLight
 * Language:   L D{0,B} E, with all emitters. Omits mirrors and glass. Where a light touches what it lights, variance is infinite.
 */
#include "lightcheck.h"

/* Light that comes straight from a light, chosen uniformly, and is scattered towards wo. */
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
    lc_rgb reflected = lc_rgb_scale(count * cos_surface, f);
    if (light.is_delta)
        return lc_rgb_mul(reflected, light.irradiance);
    double pdf_solid = light.pdf_area * light.distance * light.distance / cos_light;
    return lc_rgb_mul(reflected, lc_rgb_scale(1 / pdf_solid, light.radiance));
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *first, const lc_options *options,
                       lc_sampler *sampler)
{
    lc_rgb sum = lc_black(), throughput = lc_color(1, 1, 1);
    lc_hit hit = *first;
    (void)ray;
    for (int k = 0;; ++k) {
        if (k >= options->min_bounces && (k == 0 || !hit.valid)) /* the camera's own view, and the sky, which is no light */
            sum = lc_rgb_add(sum, lc_rgb_mul(throughput, lc_emission(scene, &hit)));
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
    }
}

LC_ESTIMATOR(path_nee) = {
    LC_ABI,
    "path_nee",
    "path tracing with next-event estimation: a light is sampled at each surface",
    "Shirley, Wang, Zimmerman 1996, eq. 6; Path Tracing (Bikker 2021-22), margins: SampleLight",
    LC_DIFFUSE,
    LC_AREA | LC_POINT | LC_DIRECTIONAL | LC_SKY,
    LC_UNBOUNDED,
    radiance,
};
