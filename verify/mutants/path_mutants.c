/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Bugs of the path tracing algorithm, one switch each: the family of path.
 */
#include "lightcheck.h"

enum {
    NO_COSINE = 1,
    COSINE_TWICE = 2,
    NO_PI = 4,
    COSINE_DIRECTIONS = 8,
    COSINE_DENSITY = 16,
    NORMAL_NOT_TURNED = 32,
    ALBEDO_ONCE = 64,
    U_REACHES_ONE = 128,
    TOO_DEEP = 256,
    TOO_SHORT = 512,
    EMISSION_LAST = 1024,
    ENDS_AT_LIGHT = 2048,
    NO_CAMERA_EMISSION = 4096,
    NO_CAMERA_SKY = 8192
};

/* f cos_surface / pdf_solid, and the direction. `k` reflections came before. */
static lc_rgb scatter(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, unsigned bugs, int k, lc_vec3 *wi)
{
    lc_vec3 n = bugs & NORMAL_NOT_TURNED ? hit->n : lc_facing(hit->n, hit->wo);
    double u = lc_next(sampler), v = lc_next(sampler);
    double cos_surface, pdf_solid = 0.5 * LC_INV_PI;
    if (bugs & U_REACHES_ONE) {
        u = floor(u * 32768) / 32767; /* rand() / RAND_MAX, closed at 1, where cosine and density are both 0 */
        *wi = lc_cosine_hemisphere(n, u, v);
        cos_surface = sqrt(1 - u);
        pdf_solid = cos_surface * LC_INV_PI;
    } else {
        *wi = bugs & COSINE_DIRECTIONS ? lc_cosine_hemisphere(n, u, v) : lc_uniform_hemisphere(n, u, v);
        cos_surface = lc_dot(n, *wi);
    }
    if (bugs & COSINE_DENSITY)
        pdf_solid = cos_surface * LC_INV_PI;
    lc_rgb f = lc_bsdf_eval(scene, hit, *wi);
    if (bugs & ALBEDO_ONCE && k > 0 && lc_rgb_max(f) > 0)
        f = lc_color(LC_INV_PI, LC_INV_PI, LC_INV_PI);
    double cosine = bugs & NO_COSINE ? 1.0 : bugs & COSINE_TWICE ? cos_surface * cos_surface : cos_surface;
    return lc_rgb_scale(cosine / pdf_solid * (bugs & NO_PI ? LC_PI : 1.0), f);
}

/* Whether the light that the hit emits counts. */
static int counts(unsigned bugs, const lc_options *options, const lc_hit *hit, int k)
{
    if (k == 0 && (bugs & NO_CAMERA_EMISSION || (bugs & NO_CAMERA_SKY && !hit->valid)))
        return 0;
    if (bugs & EMISSION_LAST && k != options->max_bounces && hit->valid)
        return 0;
    return k >= options->min_bounces;
}

static lc_rgb walk(unsigned bugs, const lc_scene *scene, const lc_hit *first, const lc_options *options,
                   lc_sampler *sampler)
{
    lc_rgb sum = lc_black(), throughput = lc_color(1, 1, 1);
    lc_hit hit = *first;
    int last = options->max_bounces + (bugs & TOO_DEEP ? 1 : 0) - (bugs & TOO_SHORT ? 1 : 0);
    for (int k = 0;; ++k) {
        lc_rgb emission = lc_emission(scene, &hit);
        if (counts(bugs, options, &hit, k))
            sum = lc_rgb_add(sum, lc_rgb_mul(throughput, emission));
        if (k >= last || !hit.valid || (bugs & ENDS_AT_LIGHT && lc_rgb_max(emission) > 0))
            return sum;
        lc_vec3 wi;
        throughput = lc_rgb_mul(throughput, scatter(scene, &hit, sampler, bugs, k, &wi));
        if (lc_rgb_max(throughput) == 0)
            return sum;
        lc_trace(scene, &hit, wi, &hit);
    }
}

#define PATH_MUTANT(id, bugs, summary) \
    static lc_rgb radiance_##id(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, \
                                const lc_options *options, lc_sampler *sampler) \
    { \
        (void)ray; \
        return walk(bugs, scene, hit, options, sampler); \
    } \
    LC_ESTIMATOR(id) = {LC_ABI, #id, summary, "path, broken", LC_DIFFUSE, LC_AREA | LC_SKY, LC_UNBOUNDED, radiance_##id}

PATH_MUTANT(path_no_cosine, NO_COSINE, "the cosine at the surface is missing");
PATH_MUTANT(path_cosine_twice, COSINE_TWICE, "the cosine at the surface comes twice");
PATH_MUTANT(path_no_pi, NO_PI, "the BRDF is albedo instead of albedo / pi");
PATH_MUTANT(path_cosine_directions, COSINE_DIRECTIONS, "directions by the cosine, density of uniform ones");
PATH_MUTANT(path_cosine_density, COSINE_DENSITY, "uniform directions, density of those by the cosine");
PATH_MUTANT(path_normal_not_turned, NORMAL_NOT_TURNED, "the normal is not turned to the viewer");
PATH_MUTANT(path_albedo_once, ALBEDO_ONCE, "only the first surface's albedo counts");
PATH_MUTANT(path_u_reaches_one, U_REACHES_ONE, "a random number that can be 1 gives 0 / 0, once in 32768 draws");
PATH_MUTANT(path_too_deep, TOO_DEEP, "one bounce more than asked for");
PATH_MUTANT(path_too_short, TOO_SHORT, "one bounce less than asked for");
PATH_MUTANT(path_emission_last, EMISSION_LAST, "emission counts at the end of the path only");
PATH_MUTANT(path_ends_at_light, ENDS_AT_LIGHT, "the path ends at a light, though lights reflect, too");
PATH_MUTANT(path_no_camera_emission, NO_CAMERA_EMISSION, "a light that the camera sees is black");
PATH_MUTANT(path_no_camera_sky, NO_CAMERA_SKY, "a ray from the camera that hits nothing is black, whatever the sky");
