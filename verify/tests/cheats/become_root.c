/* SPDX-License-Identifier: GPL-3.0-or-later */
/* become_root: asks to be root again */
#include "lightcheck.h"

#include <stdio.h>
#include <unistd.h>

__attribute__((constructor)) static void begin(void)
{
    if (setuid(0) == 0)
        puts("BROKE OUT: root");
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(become_root) = {LC_ABI, "become_root", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
