/* SPDX-License-Identifier: GPL-3.0-or-later */
/* trap: a breakpoint, in the hope that a signal so rare is taken for the fault of somebody else */
#include "lightcheck.h"

#if defined __x86_64__ || defined __i386__
#define TRAP() __asm__ volatile("int3")
#else
#define TRAP() __builtin_trap()
#endif

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    TRAP();
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(trap) = {LC_ABI, "trap", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
