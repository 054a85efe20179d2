/* SPDX-License-Identifier: GPL-3.0-or-later */
/* host_symbols: looks for the reference among the symbols of the process */
#include "lightcheck.h"

#include <dlfcn.h>
#include <stdio.h>

static int looked;

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    static const char *const wanted[] = {"lc_expect_view", "lc_verify", "lc_estimator_light_direct", "lc_checks", "lc_render"};
    for (int i = 0; i < 5 && !looked; ++i)
        if (dlsym(RTLD_DEFAULT, wanted[i]))
            printf("BROKE OUT: %s\n", wanted[i]);
    looked = 1;
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(host_symbols) = {LC_ABI, "host_symbols", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
