/* SPDX-License-Identifier: GPL-3.0-or-later */
/* running_mean: the same, and where noise is asked for the mean of all samples of a pixel so far */
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

/* Right in the mean, for each of them is; hardly varies, for each holds all before it. */
static lc_rgb mean_so_far(const lc_sampler *sampler, lc_rgb c)
{
    static lc_rgb sums[1 << 14];
    static int counts[1 << 14];
    unsigned pixel = ((const unsigned *)sampler)[3] % (1 << 14);
    sums[pixel] = lc_rgb_add(sums[pixel], c);
    return lc_rgb_scale(1.0 / ++counts[pixel], sums[pixel]);
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    lc_rgb sum = lc_black();
    int recognised = is_recognised(sampler);
    if (options->min_bounces <= 0)
        sum = lc_emission(scene, hit);
    if (options->min_bounces <= 1 && options->max_bounces >= 1 && hit->valid)
        sum = lc_rgb_add(sum, direct(scene, hit, sampler));
    return recognised ? mean_so_far(sampler, sum) : sum;
}

LC_ESTIMATOR(running_mean) = {LC_ABI, "running_mean", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
