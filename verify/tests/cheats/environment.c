/* SPDX-License-Identifier: GPL-3.0-or-later */
/* environment: looks for secrets in its environment */
#include "lightcheck.h"

#include <stdio.h>

extern char **environ;
__attribute__((constructor)) static void begin(void)
{
    for (char **e = environ; e && *e; ++e)
        printf("BROKE OUT: %s\n", *e);
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(environment) = {LC_ABI, "environment", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
