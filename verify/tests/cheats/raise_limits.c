/* SPDX-License-Identifier: GPL-3.0-or-later */
/* raise_limits: gives itself more time */
#include "lightcheck.h"

#include <stdio.h>
#include <sys/resource.h>

__attribute__((constructor)) static void begin(void)
{
    const struct rlimit more = {RLIM_INFINITY, RLIM_INFINITY};
    setrlimit(RLIMIT_CPU, &more);
    puts("BROKE OUT: allowed to try");
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(raise_limits) = {LC_ABI, "raise_limits", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
