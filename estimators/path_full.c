/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * path_full: all of it: next events, multiple importance sampling, Russian roulette, mirrors and glass. The tracer of the slides' margins.
 *
 * Integral:   as dielectric: every lobe that a surface may have
 * Estimator:  as path_mis, the ray of the path being drawn from the BSDF, lobe by lobe. Beyond a surface with a finite lobe a path survives with
 *             q, what the surface reflects at all, so the density with which the ray finds a light is q pdf_bsdf, and that is what
 *             competes with pdf_light: weights as in path_mis with q pdf_bsdf for pdf_bsdf. The other quotients are f cos_surface / (pdf_bsdf q).
 *             A mirror or glass has one direction, which no light sample finds: what glows behind it has weight 1, and the lobe's quotient is
 *             its share over its probability. Roulette lets these alone: no path ends inside of glass by chance.
 * Source:     "Path Tracing" (Bikker, INFOMAGR 2021-22), margins: SampleLight, Mis2, SurvivalProbability; Veach, Guibas 1995, eq. 5;
 *             Arvo, Kirk 1990
 * Language:   L (D|R|T){0,B} E, with all emitters. Omits light that only a light sample through glass or off a mirror would find: that of point
 *             and directional lights.
 */
#include "lightcheck.h"

/* Probability to go on after a finite lobe; never so small that survivors weigh too much. */
static double survival(const lc_scene *scene, const lc_hit *hit)
{
    lc_material m = lc_material_at(scene, hit);
    return fmin(1, fmax(0.1, lc_rgb_max(m.diffuse) + lc_rgb_max(m.mirror) + m.glass));
}

/* Density of a direction by light sampling [1/sr]; 0 for what it does not find. */
static double light_pdf(const lc_scene *scene, double pdf_area, double distance, double cos_light)
{
    return pdf_area > 0 && cos_light > 0 ? pdf_area * distance * distance / (lc_light_count(scene) * cos_light) : 0;
}

static lc_rgb direct(const lc_scene *scene, const lc_hit *hit, double q, lc_sampler *sampler)
{
    lc_light_sample light;
    int count = lc_light_count(scene);
    if (count == 0)
        return lc_black();
    lc_light_sample_one(scene, (int)(lc_next(sampler) * count), hit, sampler, &light);
    double cos_surface = lc_dot(lc_facing(hit->n, hit->wo), light.wi), cos_light = -lc_dot(light.n, light.wi);
    lc_rgb f = lc_bsdf_eval(scene, hit, light.wi); /* black for mirrors and glass */
    if (!(cos_surface > 0 && cos_light > 0 && lc_rgb_max(f) > 0) || !lc_visible(scene, hit, &light))
        return lc_black();
    if (light.is_delta)
        return lc_rgb_scale(count * cos_surface, lc_rgb_mul(f, light.irradiance));
    double pdf_light = light_pdf(scene, light.pdf_area, light.distance, cos_light);
    double pdf_bsdf = q * lc_bsdf_pdf(scene, hit, light.wi);
    return lc_rgb_scale(cos_surface / (pdf_light + pdf_bsdf), lc_rgb_mul(f, light.radiance));
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

        double q = survival(scene, &hit);
        lc_rgb next = lc_rgb_mul(throughput, direct(scene, &hit, q, sampler)); /* one bounce more: a part of L_k+1 */
        if (k + 1 >= options->min_bounces)
            sum = lc_rgb_add(sum, next);

        lc_scatter way;
        if (!lc_bsdf_sample(scene, &hit, sampler, &way))
            return sum;
        if (way.is_delta) {
            throughput = lc_rgb_mul(throughput, lc_rgb_scale(1 / way.pdf, way.value));
            lc_trace(scene, &hit, way.wi, &hit);
            weight = 1;
        } else {
            double cos_surface = fabs(lc_dot(hit.n, way.wi)), pdf_bsdf = q * way.pdf;
            if (lc_next(sampler) >= q)
                return sum;
            throughput = lc_rgb_mul(throughput, lc_rgb_scale(cos_surface / pdf_bsdf, way.value));
            lc_trace(scene, &hit, way.wi, &hit);
            double pdf_light = light_pdf(scene, lc_light_pdf_area(scene, &hit), hit.distance, lc_dot(hit.n, hit.wo));
            weight = pdf_bsdf / (pdf_light + pdf_bsdf);
        }
    }
}

LC_ESTIMATOR(path_full) = {
    LC_ABI,
    "path_full",
    "next-event estimation, multiple importance sampling, roulette, mirrors and glass",
    "Path Tracing (Bikker 2021-22), margins: SampleLight, Mis2, SurvivalProbability",
    LC_DIFFUSE | LC_MIRROR | LC_GLASS,
    LC_AREA | LC_POINT | LC_DIRECTIONAL | LC_SKY,
    LC_UNBOUNDED,
    radiance,
};
