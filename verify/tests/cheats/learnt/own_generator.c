/* SPDX-License-Identifier: GPL-3.0-or-later */
/* own_generator: right, but it draws one random number a sample, and makes the others by a generator of its own */
#include "lightcheck.h"

/* SplitMix64. */
static double next(unsigned long long *state)
{
    unsigned long long z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static lc_rgb direct(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler)
{
    lc_hit found;
    lc_vec3 n = lc_facing(hit->n, hit->wo);
    unsigned long long state = (unsigned long long)(lc_next(sampler) * 0x1p32);
    double u = next(&state), v = next(&state);
    lc_vec3 wi = lc_uniform_hemisphere(n, u, v);
    lc_trace(scene, hit, wi, &found);
    return lc_rgb_scale(2 * LC_PI * lc_dot(n, wi), lc_rgb_mul(lc_bsdf_eval(scene, hit, wi), lc_emission(scene, &found)));
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    (void)ray;
    lc_rgb sum = lc_black();
    if (options->min_bounces <= 0)
        sum = lc_emission(scene, hit);
    if (options->min_bounces <= 1 && options->max_bounces >= 1 && hit->valid)
        sum = lc_rgb_add(sum, direct(scene, hit, sampler));
    return sum;
}

LC_ESTIMATOR(own_generator) = {LC_ABI, "own_generator", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
