/* SPDX-License-Identifier: GPL-3.0-or-later */
/* forge_samples: a constructor writes samples of its own to the pipe, and ends */
#include "lightcheck.h"

#include <stdlib.h>
#include <unistd.h>

__attribute__((constructor)) static void begin(void)
{
    static const double ones[3 * 4096] = {1};
    for (int i = 0; i < 1000; ++i)
        if (write(4, ones, sizeof ones) < 0)
            break;
    _exit(0);
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(forge_samples) = {LC_ABI, "forge_samples", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
