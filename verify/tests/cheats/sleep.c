/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sleep: waits, which costs no time of a processor */
#include "lightcheck.h"

#include <unistd.h>

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    sleep(1000);
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(sleep) = {LC_ABI, "sleep", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
