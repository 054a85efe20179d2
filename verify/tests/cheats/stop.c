/* SPDX-License-Identifier: GPL-3.0-or-later */
/* stop: stops itself */
#include "lightcheck.h"

#include <signal.h>

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    raise(SIGSTOP);
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(stop) = {LC_ABI, "stop", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
