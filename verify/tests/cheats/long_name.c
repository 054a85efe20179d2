/* SPDX-License-Identifier: GPL-3.0-or-later */
/* long_name: a name that fills a screen, and clears it */
#include "lightcheck.h"

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(long_name) = {LC_ABI, "\033[2J0123456789012345678901234567890123456789012345678901234567890123456789", "a cheat", "none",
                           LC_DIFFUSE, LC_AREA, 1, radiance};
