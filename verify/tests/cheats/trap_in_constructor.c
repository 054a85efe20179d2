/* SPDX-License-Identifier: GPL-3.0-or-later */
/* trap_in_constructor: the same before it is asked anything */
#include "lightcheck.h"

#if defined __x86_64__ || defined __i386__
#define TRAP() __asm__ volatile("int3")
#else
#define TRAP() __builtin_trap()
#endif

__attribute__((constructor)) static void begin(void)
{
    TRAP();
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(trap_in_constructor) = {LC_ABI, "trap_in_constructor", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
