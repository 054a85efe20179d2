/* SPDX-License-Identifier: GPL-3.0-or-later */
/* memory: takes all memory */
#include "lightcheck.h"

#include <stdlib.h>
#include <string.h>

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    for (;;) {
        char *more = malloc(1 << 20);
        memset(more, 1, 1 << 20);
    }
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(memory) = {LC_ABI, "memory", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
