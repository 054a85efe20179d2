/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Direct light off a rough mirror: directions by the BRDF. */
#include "lightcheck.h"

static lc_rgb radiance(const lc_scene *world, const lc_ray *ray, const lc_hit *hit, const lc_options *opt,
                       lc_sampler *rng)
{
    lc_rgb glow = opt->min_bounces <= 0 ? lc_emission(world, hit) : lc_black();
    lc_scatter out;
    (void)ray;
    if (!hit->valid || opt->min_bounces > 1 || opt->max_bounces < 1)
        return glow;
    if (!lc_bsdf_sample(world, hit, rng, &out) || out.is_delta)
        return glow;
    lc_vec3 n = lc_facing(hit->n, hit->wo);
    double cosine = lc_dot(n, out.wi);
    if (cosine <= 0)
        return glow;
    lc_hit next;
    lc_trace(world, hit, out.wi, &next);
    double weight = cosine / out.pdf;
    lc_rgb in = lc_emission(world, &next);
    return lc_rgb_add(glow, lc_rgb_scale(weight, lc_rgb_mul(out.value, in)));
}

LC_ESTIMATOR(mine) = {LC_ABI, "mine", "gloss", "lecture", LC_GLOSSY, LC_AREA | LC_SKY, 1, radiance};
