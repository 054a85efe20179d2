/* SPDX-License-Identifier: GPL-3.0-or-later */
/* incbin_secret: has the assembler put a file into the object */
#include "lightcheck.h"

#include <stdio.h>

__asm__(".data\nsecret: .incbin \"/etc/passwd\"\n.byte 0\n.text\n");
extern const char secret[] __attribute__((visibility("hidden")));

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    printf("BROKE OUT: %s", secret);
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(incbin_secret) = {LC_ABI, "incbin_secret", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
