/* SPDX-License-Identifier: GPL-3.0-or-later */
/* giant_object: an object larger than the disk */
#include "lightcheck.h"

const char big[1 << 27] = {1};

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(giant_object) = {LC_ABI, "giant_object", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
