/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bad_descriptor: a descriptor that leads nowhere */
#include "lightcheck.h"

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(bad_descriptor) = {LC_ABI, (const char *)8, "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
