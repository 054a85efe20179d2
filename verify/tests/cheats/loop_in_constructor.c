/* SPDX-License-Identifier: GPL-3.0-or-later */
/* loop_in_constructor: never comes back from being loaded, and will not hear of limits */
#include "lightcheck.h"

#include <signal.h>

static void deaf(int number) { (void)number; }
__attribute__((constructor)) static void begin(void)
{
    signal(SIGXCPU, deaf);
    for (volatile int i = 0;;)
        i = 1 - i;
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(loop_in_constructor) = {LC_ABI, "loop_in_constructor", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
