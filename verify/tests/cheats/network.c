/* SPDX-License-Identifier: GPL-3.0-or-later */
/* network: opens a socket */
#include "lightcheck.h"

#include <stdio.h>
#include <sys/socket.h>

__attribute__((constructor)) static void begin(void)
{
    if (socket(AF_INET, SOCK_STREAM, 0) >= 0)
        puts("BROKE OUT: a socket");
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(network) = {LC_ABI, "network", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
