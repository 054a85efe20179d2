/* SPDX-License-Identifier: GPL-3.0-or-later */
/* loop: never comes back */
#include "lightcheck.h"

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    for (volatile int i = 0;;)
        i = 1 - i;
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(loop) = {LC_ABI, "loop", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
