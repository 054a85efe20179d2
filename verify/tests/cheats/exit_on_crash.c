/* SPDX-License-Identifier: GPL-3.0-or-later */
/* exit_on_crash: crashes, and turns the signal into a successful end */
#include "lightcheck.h"

#include <signal.h>
#include <unistd.h>

static void caught(int number) { _exit(number == 0); }

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    volatile int *nowhere = 0;
    signal(SIGSEGV, caught);
    *nowhere = 1;
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(exit_on_crash) = {LC_ABI, "exit_on_crash", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
