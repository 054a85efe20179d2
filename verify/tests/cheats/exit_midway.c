/* SPDX-License-Identifier: GPL-3.0-or-later */
/* exit_midway: ends the process with success after some samples */
#include "lightcheck.h"

#include <unistd.h>

static int count;

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    if (++count == 1000)
        _exit(0);
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(exit_midway) = {LC_ABI, "exit_midway", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
