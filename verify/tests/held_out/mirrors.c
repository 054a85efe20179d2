/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Paths that follow mirrors: a coin decides. */
#include "lightcheck.h"

static lc_rgb follow(const lc_scene *world, const lc_hit *at, int depth, int reflected, const lc_options *opt,
                     lc_sampler *rng)
{
    lc_rgb glow = depth >= opt->min_bounces ? lc_emission(world, at) : lc_black();
    (void)reflected;
    if (!at->valid || depth >= opt->max_bounces)
        return glow;
    lc_material m = lc_material_at(world, at);
    double shiny = lc_rgb_max(m.mirror), matte = lc_rgb_max(m.diffuse);
    if (shiny + matte <= 0)
        return glow;
    double chance = shiny / (shiny + matte);
    lc_vec3 n = lc_facing(at->n, at->wo), w;
    lc_rgb weight;
    int is_mirror = lc_next(rng) < chance;
    if (is_mirror) {
        w = lc_sub(lc_scale(2 * lc_dot(n, at->wo), n), at->wo);
        weight = lc_rgb_scale(1 / chance, m.mirror);
    } else {
        double a = lc_next(rng), b = lc_next(rng);
        w = lc_cosine_hemisphere(n, a, b);
        weight = lc_rgb_scale(1 / (1 - chance), m.diffuse);
    }
    lc_hit next;
    lc_trace(world, at, w, &next);
    int deeper = depth + 1;
    return lc_rgb_add(glow, lc_rgb_mul(weight, follow(world, &next, deeper, is_mirror, opt, rng)));
}

static lc_rgb radiance(const lc_scene *world, const lc_ray *ray, const lc_hit *hit, const lc_options *opt,
                       lc_sampler *rng)
{
    (void)ray;
    return follow(world, hit, 0, 0, opt, rng);
}

LC_ESTIMATOR(mine) = {LC_ABI,   "mine", "mirrors", "lecture", LC_DIFFUSE | LC_MIRROR, LC_AREA | LC_SKY, LC_UNBOUNDED,
                      radiance};
