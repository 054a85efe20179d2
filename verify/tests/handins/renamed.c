/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A hand-in: estimators/light_direct.c with other names, other comments, and its functions in another order. */
#include "lightcheck.h"

static lc_rgb shade(const lc_scene *world, const lc_hit *where, lc_sampler *dice);

/* My own work! */
static lc_rgb color_of_ray(const lc_scene *world, const lc_ray *eye, const lc_hit *where, const lc_options *settings, lc_sampler *dice)
{
    (void)eye;
    lc_rgb total = lc_black();
    if (settings->min_bounces <= 0)
    {
        total = lc_emission(world, where);
    }
    if (settings->min_bounces <= 1 && settings->max_bounces >= 1 && where->valid)
    {
        total = lc_rgb_add(total, shade(world, where, dice));
    }
    return total;
}

static lc_rgb shade(const lc_scene *world, const lc_hit *where, lc_sampler *dice)
{
    const int lamps = lc_light_count(world); // how many there are
    if (lamps == 0)
    {
        return lc_black();
    }
    lc_light_sample lamp;
    lc_light_sample_one(world, (int)(lc_next(dice) * lamps), where, dice, &lamp);
    const double here = lc_dot(lc_facing(where->n, where->wo), lamp.wi);
    if (!(here > 0))
    {
        return lc_black(); // from behind
    }
    lc_rgb arriving = lamp.irradiance;
    if (!lamp.is_delta)
    {
        const double there = -lc_dot(lamp.n, lamp.wi);
        if (!(there > 0))
        {
            return lc_black();
        }
        const double density = lamp.pdf_area * lamp.distance * lamp.distance / there;
        arriving = lc_rgb_scale(1.0 / density, lamp.radiance);
    }
    if (!lc_visible(world, where, &lamp))
    {
        return lc_black();
    }
    return lc_rgb_scale(lamps * here, lc_rgb_mul(lc_bsdf_eval(world, where, lamp.wi), arriving));
}

LC_ESTIMATOR(renamed) = {
    LC_ABI, "renamed", "direct light", "the lecture", LC_DIFFUSE | LC_GLOSSY, LC_AREA | LC_POINT | LC_DIRECTIONAL, 1, color_of_ray,
};
