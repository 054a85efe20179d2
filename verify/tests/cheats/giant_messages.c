/* SPDX-License-Identifier: GPL-3.0-or-later */
/* giant_messages: a compiler that never stops complaining */
#include "lightcheck.h"

#define COMPLAIN(x) enum { complaint_##x = unknown_##x, again_##x = unknown_##x };
#define TEN(x) COMPLAIN(x##0) COMPLAIN(x##1) COMPLAIN(x##2) COMPLAIN(x##3) COMPLAIN(x##4) COMPLAIN(x##5) COMPLAIN(x##6)
#define HUNDRED(x) TEN(x##0) TEN(x##1) TEN(x##2) TEN(x##3) TEN(x##4) TEN(x##5) TEN(x##6) TEN(x##7) TEN(x##8) TEN(x##9)
HUNDRED(a) HUNDRED(b) HUNDRED(c) HUNDRED(d) HUNDRED(e) HUNDRED(f) HUNDRED(g) HUNDRED(h)

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_color(1, 1, 1);
}

LC_ESTIMATOR(giant_messages) = {LC_ABI, "giant_messages", "a cheat", "none", LC_DIFFUSE, LC_AREA, 1, radiance};
