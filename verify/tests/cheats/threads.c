/* SPDX-License-Identifier: GPL-3.0-or-later */
/* threads: starts a thread */
#include "lightcheck.h"

#include <pthread.h>
#include <stdio.h>

static void *run(void *nothing) { return nothing; }
__attribute__((constructor)) static void begin(void)
{
    pthread_t thread;
    pthread_create(&thread, 0, run, 0);
    puts("BROKE OUT: a thread");
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(threads) = {LC_ABI, "threads", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
