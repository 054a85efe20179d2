/* SPDX-License-Identifier: GPL-3.0-or-later */
/* stack: calls itself without end */
#include "lightcheck.h"

static int deeper(volatile int *n)
{
    volatile int more[64] = {*n};
    return deeper(more) + more[1];
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    volatile int n = 1;
    deeper(&n);
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(stack) = {LC_ABI, "stack", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
