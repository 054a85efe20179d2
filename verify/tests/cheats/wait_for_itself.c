/* SPDX-License-Identifier: GPL-3.0-or-later */
/* wait_for_itself: opens the other end of its own pipe and waits there for what never comes, which costs no time of a processor */
#include "lightcheck.h"

#include <fcntl.h>
#include <unistd.h>

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    char byte;
    int end = open("/proc/self/fd/1", O_RDONLY | O_CLOEXEC);
    if (end >= 0)
        read(end, &byte, 1);
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(wait_for_itself) = {LC_ABI, "wait_for_itself", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
