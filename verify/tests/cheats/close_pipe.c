/* SPDX-License-Identifier: GPL-3.0-or-later */
/* close_pipe: closes the pipe of samples and goes on */
#include "lightcheck.h"

#include <unistd.h>

static int count;

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    if (++count == 1000)
        close(4);
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(close_pipe) = {LC_ABI, "close_pipe", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
