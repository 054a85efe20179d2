/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * path_rr: path_cosine with Russian roulette: a path that carries little ends early, and the survivors stand for the dead.
 *
 * Integral:   as path; the sum over k may be without end, and the estimator still comes to one.
 * Estimator:  after the first two surfaces a path survives with q = min(1, largest channel of T), T its throughput, and goes on with
 *             T / q: the mean is q (T / q) + (1 - q) 0 = T. Any 0 < q <= 1 is right where T > 0. max_bounces holds as for any path.
 * Source:     Arvo, Kirk, Particle transport and image synthesis, SIGGRAPH 1990; "Path Tracing" (Bikker, INFOMAGR 2021-22), margins:
 *             SurvivalProbability
 * Language:   L D{0,B} E. Omits mirrors, glass, and lights without area, which no direction ever hits.
 */
#include "lightcheck.h"

enum { SAFE_BOUNCES = 2 };

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

        lc_vec3 n = lc_facing(hit.n, hit.wo);
        double u = lc_next(sampler), v = lc_next(sampler);
        lc_vec3 wi = lc_cosine_hemisphere(n, u, v);
        double cos_surface = lc_dot(n, wi), pdf_solid = cos_surface * LC_INV_PI;
        throughput = lc_rgb_mul(throughput, lc_rgb_scale(cos_surface / pdf_solid, lc_bsdf_eval(scene, &hit, wi)));
        double q = k < SAFE_BOUNCES && lc_rgb_max(throughput) > 0 ? 1 : fmin(1, lc_rgb_max(throughput));
        if (lc_next(sampler) >= q) /* always, where nothing is left */
            return sum;
        throughput = lc_rgb_scale(1 / q, throughput);
        lc_trace(scene, &hit, wi, &hit);
    }
}

LC_ESTIMATOR(path_rr) = {
    LC_ABI,
    "path_rr",
    "path tracing with Russian roulette",
    "Arvo and Kirk 1990; Path Tracing (Bikker 2021-22), margins: SurvivalProbability",
    LC_DIFFUSE,
    LC_AREA | LC_SKY,
    LC_UNBOUNDED,
    radiance,
};
