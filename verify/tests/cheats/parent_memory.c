/* SPDX-License-Identifier: GPL-3.0-or-later */
/* parent_memory: asks for its parent, to read its memory */
#include "lightcheck.h"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

__attribute__((constructor)) static void begin(void)
{
    char path[64];
    snprintf(path, sizeof path, "/proc/%d/mem", (int)getppid());
    if (open(path, O_RDONLY) >= 0)
        puts("BROKE OUT: memory of the parent");
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(parent_memory) = {LC_ABI, "parent_memory", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
