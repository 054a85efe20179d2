/* SPDX-License-Identifier: GPL-3.0-or-later */
/* trap_flag: has the processor stop after each instruction */
#include "lightcheck.h"

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
#if defined __x86_64__
    __asm__ volatile("pushfq; orq $0x100, (%%rsp); popfq; nop; nop" ::: "memory");
#else
    __builtin_trap();
#endif
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(trap_flag) = {LC_ABI, "trap_flag", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
