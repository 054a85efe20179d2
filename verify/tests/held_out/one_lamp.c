/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Direct light: one lamp is drawn, one point on it. */
#include "lightcheck.h"

static lc_rgb times(lc_rgb c, double s) { return lc_color(c.r * s, c.g * s, c.b * s); }

static lc_rgb radiance(const lc_scene *world, const lc_ray *ray, const lc_hit *hit, const lc_options *opt,
                       lc_sampler *rng)
{
    lc_rgb answer = lc_black(), arriving;
    (void)ray;
    if (opt->min_bounces < 1)
        answer = lc_emission(world, hit);
    int lamps = lc_light_count(world);
    if (!hit->valid || opt->max_bounces < 1 || opt->min_bounces > 1 || lamps < 1)
        return answer;
    int which = (int)(lc_next(rng) * lamps);
    lc_light_sample lamp;
    lc_light_sample_one(world, which, hit, rng, &lamp);
    lc_vec3 up = lc_dot(hit->n, hit->wo) > 0 ? hit->n : lc_neg(hit->n);
    double cos_here = lc_dot(up, lamp.wi);
    if (cos_here <= 0)
        return answer;
    if (lamp.is_delta)
        arriving = times(lamp.irradiance, cos_here);
    else {
        double cos_there = -lc_dot(lamp.n, lamp.wi);
        if (cos_there <= 0)
            return answer;
        double area = 1 / lamp.pdf_area;
        double square = lamp.distance * lamp.distance;
        arriving = times(lamp.radiance, cos_here * cos_there * area / square);
    }
    if (!lc_visible(world, hit, &lamp))
        return answer;
    arriving = times(arriving, lamps);
    lc_rgb albedo = lc_material_at(world, hit).diffuse;
    lc_rgb leaving = times(lc_rgb_mul(albedo, arriving), 1 / LC_PI);
    return lc_rgb_add(answer, leaving);
}

LC_ESTIMATOR(mine) = {LC_ABI,     "mine", "direct light", "lecture", LC_DIFFUSE, LC_AREA | LC_POINT | LC_DIRECTIONAL, 1,
                      radiance};
