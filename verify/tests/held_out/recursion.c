/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Paths by recursion, as on the slides. */
#include "lightcheck.h"

static lc_rgb trace(const lc_scene *world, const lc_hit *at, int depth, const lc_options *opt, lc_sampler *rng)
{
    lc_rgb glow = lc_emission(world, at);
    if (depth < opt->min_bounces)
        glow = lc_black();
    if (!at->valid)
        return glow;
    if (depth >= opt->max_bounces)
        return glow;
    lc_vec3 n = lc_facing(at->n, at->wo);
    double a = lc_next(rng), b = lc_next(rng);
    lc_vec3 w = lc_uniform_hemisphere(n, a, b);
    double cosine = lc_dot(n, w);
    double pdf = 1 / (2 * LC_PI);
    lc_rgb albedo = lc_material_at(world, at).diffuse;
    if (lc_rgb_max(albedo) == 0)
        return glow;
    lc_rgb brdf = lc_rgb_scale(1 / LC_PI, albedo);
    lc_hit next;
    lc_trace(world, at, w, &next);
    lc_rgb in = trace(world, &next, depth + 1, opt, rng);
    return lc_rgb_add(glow, lc_rgb_scale(cosine / pdf, lc_rgb_mul(brdf, in)));
}

static lc_rgb radiance(const lc_scene *world, const lc_ray *ray, const lc_hit *hit, const lc_options *opt,
                       lc_sampler *rng)
{
    (void)ray;
    return trace(world, hit, 0, opt, rng);
}

LC_ESTIMATOR(mine) = {LC_ABI, "mine", "paths", "lecture", LC_DIFFUSE, LC_AREA | LC_SKY, LC_UNBOUNDED, radiance};
