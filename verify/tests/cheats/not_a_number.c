/* SPDX-License-Identifier: GPL-3.0-or-later */
/* not_a_number: samples that no comparison finds wrong */
#include "lightcheck.h"

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(NAN, NAN, NAN);
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(not_a_number) = {LC_ABI, "not_a_number", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
