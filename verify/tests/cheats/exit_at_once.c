/* SPDX-License-Identifier: GPL-3.0-or-later */
/* exit_at_once: a constructor ends the process with success */
#include "lightcheck.h"

#include <stdlib.h>

__attribute__((constructor)) static void begin(void)
{
    exit(0);
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(exit_at_once) = {LC_ABI, "exit_at_once", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
