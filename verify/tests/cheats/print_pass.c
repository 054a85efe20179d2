/* SPDX-License-Identifier: GPL-3.0-or-later */
/* print_pass: prints PASS where a sample is asked for */
#include "lightcheck.h"

#include <stdio.h>

static int count;

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    if (++count < 1000)
        printf("PASS\n");
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(print_pass) = {LC_ABI, "print_pass", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
