/* SPDX-License-Identifier: GPL-3.0-or-later */
/* flood: prints without end */
#include "lightcheck.h"

#include <stdio.h>

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    for (;;)
        puts("all work and no play makes a dull estimator");
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(flood) = {LC_ABI, "flood", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
