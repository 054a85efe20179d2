/* SPDX-License-Identifier: GPL-3.0-or-later */
/* many_paths: blind directions where points on lamps are asked for, and as little noise, by many of them in one sample */
#include "lightcheck.h"

enum { MANY = 8 };

static lc_rgb direct(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler)
{
    lc_hit next;
    lc_vec3 n = lc_facing(hit->n, hit->wo);
    double u = lc_next(sampler), v = lc_next(sampler);
    lc_vec3 wi = lc_uniform_hemisphere(n, u, v);
    lc_trace(scene, hit, wi, &next);
    return lc_rgb_scale(2 * LC_PI * lc_dot(n, wi), lc_rgb_mul(lc_bsdf_eval(scene, hit, wi), lc_emission(scene, &next)));
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    (void)ray;
    lc_rgb sum = lc_black();
    if (options->min_bounces <= 0)
        sum = lc_emission(scene, hit);
    if (options->min_bounces <= 1 && options->max_bounces >= 1 && hit->valid)
        for (int i = 0; i < MANY; ++i)
            sum = lc_rgb_add(sum, lc_rgb_scale(1.0 / MANY, direct(scene, hit, sampler)));
    return sum;
}

LC_ESTIMATOR(many_paths) = {LC_ABI, "many_paths", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
