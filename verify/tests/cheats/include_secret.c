/* SPDX-License-Identifier: GPL-3.0-or-later */
/* include_secret: has the compiler read a file, and quote it in its messages */
#include "lightcheck.h"

#include "/etc/passwd"

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(include_secret) = {LC_ABI, "include_secret", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
