/* SPDX-License-Identifier: GPL-3.0-or-later */
/* kill_all: kills whatever it may */
#include "lightcheck.h"

#include <signal.h>
#include <stdio.h>

__attribute__((constructor)) static void begin(void)
{
    kill(-1, SIGKILL);
    puts("BROKE OUT: allowed to try");
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(kill_all) = {LC_ABI, "kill_all", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
