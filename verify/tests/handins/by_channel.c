/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A hand-in, right and independent: somebody who writes small functions and computes channel by channel. */
#include "lightcheck.h"

static double squared(double x) { return x * x; }

/* The light that one lamp sends here, per unit of what the BSDF lets through. */
static double transport(const lc_hit *at, const lc_light_sample *lamp)
{
    double from_lamp = lc_dot(lamp->n, lamp->wi);
    double to_surface = lc_dot(at->n, lamp->wi);
    if (from_lamp >= 0)
        return 0; /* its back */
    return -from_lamp * fabs(to_surface) / (lamp->pdf_area * squared(lamp->distance));
}

static lc_rgb combine(lc_rgb f, lc_rgb emitted, double factor)
{
    lc_rgb result;
    result.r = f.r * emitted.r * factor;
    result.g = f.g * emitted.g * factor;
    result.b = f.b * emitted.b * factor;
    return result;
}

static lc_rgb one_lamp(const lc_scene *s, const lc_hit *at, int which, double chance, lc_sampler *random)
{
    lc_light_sample lamp;
    lc_light_sample_one(s, which, at, random, &lamp);
    lc_rgb f = lc_bsdf_eval(s, at, lamp.wi);
    double factor = lamp.is_delta ? fabs(lc_dot(at->n, lamp.wi)) : transport(at, &lamp);
    if (factor > 0 && lc_visible(s, at, &lamp))
        return combine(f, lamp.is_delta ? lamp.irradiance : lamp.radiance, factor / chance);
    return lc_black();
}

static lc_rgb radiance(const lc_scene *s, const lc_ray *ray, const lc_hit *at, const lc_options *o, lc_sampler *random)
{
    int lamps = lc_light_count(s), wants_emission = o->min_bounces == 0, wants_direct = o->max_bounces > 0 && o->min_bounces < 2;
    lc_rgb a = wants_emission ? lc_emission(s, at) : lc_black(), b = lc_black();
    (void)ray;
    if (wants_direct && lamps > 0 && at->valid) {
        double choice = lamps * lc_next(random);
        b = one_lamp(s, at, (int)choice, 1.0 / lamps, random);
    }
    return lc_rgb_add(a, b);
}

LC_ESTIMATOR(by_channel) = {
    LC_ABI,
    "by_channel",
    "direct light from one lamp",
    "my notes",
    LC_DIFFUSE | LC_GLOSSY,
    LC_AREA | LC_POINT | LC_DIRECTIONAL,
    1,
    radiance,
};
