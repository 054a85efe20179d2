/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Direct light by directions: angles, and a frame of my own. */
#include "lightcheck.h"

static void frame(lc_vec3 n, lc_vec3 *s, lc_vec3 *t)
{
    lc_vec3 axis = fabs(n.x) < 0.6 ? lc_vec(1, 0, 0) : lc_vec(0, 1, 0);
    *s = lc_normalize(lc_cross(axis, n));
    *t = lc_cross(n, *s);
}

static lc_vec3 draw(lc_vec3 n, lc_sampler *rng)
{
    lc_vec3 s, t;
    double z = lc_next(rng), phi = 2 * LC_PI * lc_next(rng);
    double r = sqrt(1 - z * z);
    frame(n, &s, &t);
    return lc_add(lc_scale(z, n), lc_add(lc_scale(r * cos(phi), s), lc_scale(r * sin(phi), t)));
}

static lc_rgb radiance(const lc_scene *world, const lc_ray *ray, const lc_hit *hit, const lc_options *opt,
                       lc_sampler *rng)
{
    lc_rgb glow = lc_emission(world, hit), zero = lc_black();
    (void)ray;
    if (opt->min_bounces > 0)
        glow = zero;
    if (opt->max_bounces < 1 || opt->min_bounces > 1 || !hit->valid)
        return glow;
    lc_vec3 up = lc_facing(hit->n, hit->wo);
    lc_vec3 w = draw(up, rng);
    double cosine = lc_dot(up, w);
    double weight = 2 * LC_PI * cosine;
    lc_hit far_away;
    lc_trace(world, hit, w, &far_away);
    lc_rgb light = lc_emission(world, &far_away);
    lc_rgb brdf = lc_rgb_scale(1 / LC_PI, lc_material_at(world, hit).diffuse);
    return lc_rgb_add(glow, lc_rgb_scale(weight, lc_rgb_mul(brdf, light)));
}

LC_ESTIMATOR(mine) = {LC_ABI, "mine", "directions", "lecture", LC_DIFFUSE, LC_AREA | LC_SKY, 1, radiance};
