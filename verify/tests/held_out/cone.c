/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Direct light: directions over the solid angle of a lamp. */
#include "lightcheck.h"

static lc_rgb radiance(const lc_scene *world, const lc_ray *ray, const lc_hit *hit, const lc_options *opt,
                       lc_sampler *rng)
{
    lc_rgb answer = opt->min_bounces < 1 ? lc_emission(world, hit) : lc_black();
    int lamps = lc_light_count(world);
    (void)ray;
    if (!hit->valid || lamps == 0 || opt->min_bounces > 1 || opt->max_bounces < 1)
        return answer;
    lc_light_sample lamp;
    int which = (int)(lamps * lc_next(rng));
    lc_light_sample_solid(world, which, hit, rng, &lamp);
    double density = lamp.pdf_solid;
    double cosine = lc_dot(lc_facing(hit->n, hit->wo), lamp.wi);
    if (cosine <= 0 || !lc_visible(world, hit, &lamp))
        return answer;
    lc_rgb e = lamp.irradiance;
    if (!lamp.is_delta) {
        double there = -lc_dot(lamp.n, lamp.wi);
        if (density <= 0 || there <= 0)
            return answer;
        e = lc_rgb_scale(1 / density, lamp.radiance);
    }
    lc_rgb f = lc_bsdf_eval(world, hit, lamp.wi);
    return lc_rgb_add(answer, lc_rgb_scale(lamps * cosine, lc_rgb_mul(f, e)));
}

LC_ESTIMATOR(mine) = {LC_ABI,     "mine", "cones", "lecture", LC_DIFFUSE, LC_AREA | LC_POINT | LC_DIRECTIONAL, 1,
                      radiance};
