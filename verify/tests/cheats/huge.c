/* SPDX-License-Identifier: GPL-3.0-or-later */
/* huge: samples that are numbers, but whose squares are not */
#include "lightcheck.h"

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1e300, 1e150, 1);
}

LC_ESTIMATOR(huge) = {LC_ABI, "huge", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
