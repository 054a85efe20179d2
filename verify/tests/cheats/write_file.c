/* SPDX-License-Identifier: GPL-3.0-or-later */
/* write_file: leaves a file behind */
#include "lightcheck.h"

#include <fcntl.h>
#include <stdio.h>

__attribute__((constructor)) static void begin(void)
{
    if (open("/tmp/lightcheck-broke-out", O_WRONLY | O_CREAT, 0666) >= 0 || fopen("lightcheck-broke-out", "w"))
        puts("BROKE OUT: wrote a file");
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(write_file) = {LC_ABI, "write_file", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
