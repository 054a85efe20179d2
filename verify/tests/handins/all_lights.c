/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A hand-in, right and independent: one sample of each light, all in one function. */
#include "lightcheck.h"

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    lc_rgb sum = lc_black();
    (void)ray;
    if (options->min_bounces <= 0)
        sum = lc_rgb_add(sum, lc_emission(scene, hit));
    if (!hit->valid || options->max_bounces < 1 || options->min_bounces > 1)
        return sum;
    for (int i = 0; i < lc_light_count(scene); i++) {
        lc_light_sample l;
        lc_light_sample_one(scene, i, hit, sampler, &l);
        if (!lc_visible(scene, hit, &l))
            continue;
        double weight = fabs(lc_dot(hit->n, l.wi));
        lc_rgb f = lc_bsdf_eval(scene, hit, l.wi);
        if (l.is_delta) {
            sum = lc_rgb_add(sum, lc_rgb_scale(weight, lc_rgb_mul(f, l.irradiance)));
        } else {
            weight *= fmax(0, lc_dot(l.n, lc_neg(l.wi))) / pow(l.distance, 2);
            sum = lc_rgb_add(sum, lc_rgb_scale(weight / l.pdf_area, lc_rgb_mul(f, l.radiance)));
        }
    }
    return sum;
}

LC_ESTIMATOR(all_lights) = {
    LC_ABI,
    "all_lights",
    "direct light, a sample of each light",
    "slides of the lecture, page 40",
    LC_DIFFUSE | LC_GLOSSY,
    LC_AREA | LC_POINT | LC_DIRECTIONAL,
    1,
    radiance,
};
