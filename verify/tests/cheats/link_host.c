/* SPDX-License-Identifier: GPL-3.0-or-later */
/* link_host: is linked against the reference */
#include "lightcheck.h"

#include <stdio.h>

extern const lc_estimator lc_estimator_light_direct;

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    printf("%p\n", (const void *)&lc_estimator_light_direct);
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(link_host) = {LC_ABI, "link_host", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
