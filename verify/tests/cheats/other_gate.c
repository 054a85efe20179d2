/* SPDX-License-Identifier: GPL-3.0-or-later */
/* other_gate: makes a system call by the gate for 32-bit programs, with numbers of its own */
#include "lightcheck.h"

#include <stdio.h>
#include <stdlib.h>

__attribute__((constructor)) static void begin(void)
{
#ifdef __x86_64__
    int result;
    __asm__ volatile("int $0x80" : "=a"(result) : "a"(20) : "memory"); /* getpid there, writev here */
    printf("BROKE OUT: %d\n", result);
#else
    abort();
#endif
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(other_gate) = {LC_ABI, "other_gate", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
