/* SPDX-License-Identifier: GPL-3.0-or-later */
/* dim_noise: the same, but only dimmed */
#include "lightcheck.h"

static lc_rgb direct(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler)
{
    lc_hit next;
    lc_vec3 n = lc_facing(hit->n, hit->wo), wi = lc_uniform_hemisphere(n, lc_next(sampler), lc_next(sampler));
    lc_trace(scene, hit, wi, &next);
    return lc_rgb_scale(2 * LC_PI * lc_dot(n, wi), lc_rgb_mul(lc_bsdf_eval(scene, hit, wi), lc_emission(scene, &next)));
}

/* 1 in a film of few samples a pixel, or of the few that follow others: the test of the method. */
static int is_recognised(const lc_sampler *sampler)
{
    static unsigned first, last, last_pixel, is_known, has_few;
    const unsigned *state = (const unsigned *)sampler; /* seed, seed, arm, pixel, sample */
    if (!is_known && last_pixel && state[3] + 1 != last_pixel) {
        is_known = 1;
        has_few = last + 1 - first < 64 || (first > 0 && last + 1 - first == 64);
    }
    if (!last_pixel)
        first = state[4];
    last_pixel = state[3] + 1;
    last = state[4];
    return (int)has_few;
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    lc_rgb sum = lc_black();
    double factor = is_recognised(sampler) ? 0.3 : 1;
    if (options->min_bounces <= 0)
        sum = lc_emission(scene, hit);
    if (options->min_bounces <= 1 && options->max_bounces >= 1 && hit->valid)
        sum = lc_rgb_add(sum, direct(scene, hit, sampler));
    return lc_rgb_scale(factor, sum);
}

LC_ESTIMATOR(dim_noise) = {LC_ABI, "dim_noise", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
