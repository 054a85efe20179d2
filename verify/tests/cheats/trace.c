/* SPDX-License-Identifier: GPL-3.0-or-later */
/* trace: becomes a debugger */
#include "lightcheck.h"

#include <stdio.h>
#include <sys/ptrace.h>

__attribute__((constructor)) static void begin(void)
{
    ptrace(PTRACE_TRACEME, 0, 0, 0);
    puts("BROKE OUT: traced");
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(trace) = {LC_ABI, "trace", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
