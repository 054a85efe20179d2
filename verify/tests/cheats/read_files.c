/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_files: reads what others may read */
#include "lightcheck.h"

#include <fcntl.h>
#include <stdio.h>

__attribute__((constructor)) static void begin(void)
{
    static const char *const paths[] = {"/etc/passwd", "/etc/hostname", "/proc/1/environ", "/proc/self/environ",
                                        "/proc/self/cmdline", "/dev/zero", "scenes/cornell.xml", "/bin/sh"};
    for (int i = 0; i < 8; ++i)
        if (open(paths[i], O_RDONLY | O_CLOEXEC) >= 0 || fopen(paths[i], "r"))
            printf("BROKE OUT: %s\n", paths[i]);
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(read_files) = {LC_ABI, "read_files", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
