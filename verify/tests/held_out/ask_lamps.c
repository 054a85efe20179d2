/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Paths by recursion that ask a lamp at each surface; what a path then hits by itself is no news. */
#include "lightcheck.h"

static lc_rgb ask(const lc_scene *world, const lc_hit *at, lc_rgb albedo, lc_sampler *rng)
{
    int n = lc_light_count(world);
    lc_light_sample l;
    if (n == 0)
        return lc_black();
    lc_light_sample_one(world, (int)(n * lc_next(rng)), at, rng, &l);
    double here = fmax(0, lc_dot(lc_facing(at->n, at->wo), l.wi));
    double there = fmax(0, -lc_dot(l.n, l.wi));
    if (!lc_visible(world, at, &l))
        return lc_black();
    lc_rgb power;
    if (l.is_delta)
        power = lc_rgb_scale(here, l.irradiance);
    else
        power = lc_rgb_scale(here * there / (l.distance * l.distance * l.pdf_area), l.radiance);
    return lc_rgb_scale(n / LC_PI, lc_rgb_mul(albedo, power));
}

static lc_rgb look(const lc_scene *world, const lc_hit *at, int k, const lc_options *opt, lc_sampler *rng)
{
    lc_rgb sum = lc_black();
    int is_news = k == 0 || !at->valid;
    if (is_news && k >= opt->min_bounces)
        sum = lc_emission(world, at);
    if (!at->valid || k >= opt->max_bounces)
        return sum;
    lc_rgb albedo = lc_material_at(world, at).diffuse;
    if (lc_rgb_max(albedo) <= 0)
        return sum;
    if (k + 1 >= opt->min_bounces)
        sum = lc_rgb_add(sum, ask(world, at, albedo, rng));
    double u = lc_next(rng), v = lc_next(rng);
    lc_vec3 n = lc_facing(at->n, at->wo), w = lc_uniform_hemisphere(n, u, v);
    lc_hit next;
    lc_trace(world, at, w, &next);
    lc_rgb in = look(world, &next, k + 1, opt, rng);
    return lc_rgb_add(sum, lc_rgb_scale(2 * lc_dot(n, w), lc_rgb_mul(albedo, in)));
}

static lc_rgb radiance(const lc_scene *world, const lc_ray *ray, const lc_hit *hit, const lc_options *opt,
                       lc_sampler *rng)
{
    (void)ray;
    return look(world, hit, 0, opt, rng);
}

LC_ESTIMATOR(mine) = {LC_ABI,
                      "mine",
                      "paths that ask lamps",
                      "lecture",
                      LC_DIFFUSE,
                      LC_AREA | LC_POINT | LC_DIRECTIONAL | LC_SKY,
                      LC_UNBOUNDED,
                      radiance};
