/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Paths in a loop: directions by the cosine, so that only the albedo is left; survivors of a roulette weigh more. */
#include "lightcheck.h"

static lc_vec3 polar(lc_vec3 n, double u, double v)
{
    double r = sqrt(u), phi = 2 * LC_PI * v, x = r * cos(phi), y = r * sin(phi);
    lc_vec3 s = fabs(n.z) < 0.9 ? lc_vec(n.y, -n.x, 0) : lc_vec(0, n.z, -n.y);
    s = lc_normalize(s);
    lc_vec3 t = lc_cross(n, s);
    return lc_add(lc_add(lc_scale(x, s), lc_scale(y, t)), lc_scale(sqrt(fmax(0, 1 - u)), n));
}

static double brightest(lc_rgb c) { return fmax(c.r, fmax(c.g, c.b)); }

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *first, const lc_options *o,
                       lc_sampler *rnd)
{
    lc_rgb total = lc_black(), carried = lc_color(1, 1, 1);
    lc_hit here = *first;
    int bounces = 0;
    (void)ray;
    while (1) {
        lc_rgb shine = lc_rgb_mul(carried, lc_emission(scene, &here));
        if (bounces >= o->min_bounces)
            total = lc_rgb_add(total, shine);
        if (bounces >= o->max_bounces || !here.valid)
            break;
        lc_rgb rho = lc_material_at(scene, &here).diffuse;
        if (brightest(rho) <= 0)
            break;
        double live = fmin(0.9, fmax(0.1, brightest(rho)));
        if (lc_next(rnd) > live)
            break;
        carried = lc_rgb_scale(1 / live, carried);
        lc_vec3 n = lc_facing(here.n, here.wo);
        double u = lc_next(rnd), v = lc_next(rnd);
        lc_vec3 to = polar(n, u, v);
        carried = lc_rgb_mul(carried, rho);
        lc_trace(scene, &here, to, &here);
        ++bounces;
    }
    return total;
}

LC_ESTIMATOR(mine) = {LC_ABI, "mine", "particles", "lecture", LC_DIFFUSE, LC_AREA | LC_SKY, LC_UNBOUNDED, radiance};
