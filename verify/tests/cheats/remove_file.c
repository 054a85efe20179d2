/* SPDX-License-Identifier: GPL-3.0-or-later */
/* remove_file: removes files */
#include "lightcheck.h"

#include <stdio.h>

__attribute__((constructor)) static void begin(void)
{
    remove("/tmp/lightcheck-broke-out");
    puts("BROKE OUT: allowed to try");
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(remove_file) = {LC_ABI, "remove_file", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
