/* SPDX-License-Identifier: GPL-3.0-or-later */
/* descriptors: tries all descriptors for one that somebody left open */
#include "lightcheck.h"

#include <stdio.h>
#include <unistd.h>

__attribute__((constructor)) static void begin(void)
{
    char byte;
    if (read(0, &byte, 1) > 0)
        puts("BROKE OUT: descriptor 0");
    for (int i = 5; i < 1024; ++i)
        if (lseek(i, 0, SEEK_CUR) >= 0 || read(i, &byte, 1) >= 0)
            printf("BROKE OUT: descriptor %d\n", i);
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(descriptors) = {LC_ABI, "descriptors", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
