/* SPDX-License-Identifier: GPL-3.0-or-later */
/* shell: becomes a shell */
#include "lightcheck.h"

#include <stdio.h>
#include <unistd.h>

__attribute__((constructor)) static void begin(void)
{
    execl("/bin/sh", "sh", "-c", "echo BROKE OUT", (char *)0);
    puts("BROKE OUT: allowed to try");
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(shell) = {LC_ABI, "shell", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
