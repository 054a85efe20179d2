/* SPDX-License-Identifier: GPL-3.0-or-later */
/* list_folders: lists folders, in search of other hand-ins */
#include "lightcheck.h"

#include <dirent.h>
#include <stdio.h>

__attribute__((constructor)) static void begin(void)
{
    static const char *const paths[] = {"/", "/tmp", ".", "/proc/self/fd"};
    for (int i = 0; i < 4; ++i)
        if (opendir(paths[i]))
            printf("BROKE OUT: %s\n", paths[i]);
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(list_folders) = {LC_ABI, "list_folders", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
