/* SPDX-License-Identifier: GPL-3.0-or-later */
/* own_memory_file: opens its own memory as a file */
#include "lightcheck.h"

#include <fcntl.h>
#include <stdio.h>

__attribute__((constructor)) static void begin(void)
{
    if (open("/proc/self/mem", O_RDWR) >= 0 || fopen("/proc/self/maps", "r"))
        puts("BROKE OUT: memory");
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(own_memory_file) = {LC_ABI, "own_memory_file", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
