/* SPDX-License-Identifier: GPL-3.0-or-later */
/* include_process: the same with what the compiler knows of itself */
#include "lightcheck.h"

#include "/proc/self/environ"

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(include_process) = {LC_ABI, "include_process", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
