/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Direct light: a point of all emitting area, geometry term as a function. */
#include "lightcheck.h"

static double geometry(lc_vec3 p, lc_vec3 np, lc_vec3 q, lc_vec3 nq)
{
    lc_vec3 d = lc_sub(q, p);
    double d2 = lc_dot(d, d), length = sqrt(d2);
    double cos_p = lc_dot(np, d) / length, cos_q = -lc_dot(nq, d) / length;
    if (cos_p < 0)
        cos_p = 0;
    if (cos_q < 0)
        cos_q = 0;
    return cos_p * cos_q / d2;
}

static lc_rgb radiance(const lc_scene *sc, const lc_ray *ray, const lc_hit *h, const lc_options *o, lc_sampler *s)
{
    lc_rgb out = lc_black();
    lc_light_sample y;
    (void)ray;
    if (o->min_bounces == 0)
        out = lc_emission(sc, h);
    if (o->max_bounces >= 1 && o->min_bounces <= 1 && h->valid && lc_light_sample_union(sc, h, s, &y)) {
        double density = y.pdf_area;
        lc_vec3 n = h->n;
        if (lc_dot(n, h->wo) < 0)
            n = lc_neg(n);
        double seen = lc_visible(sc, h, &y) ? 1 : 0;
        double f = seen * geometry(h->p, n, y.p, y.n) / density / LC_PI;
        lc_rgb color = lc_material_at(sc, h).diffuse;
        out = lc_rgb_add(out, lc_color(f * color.r * y.radiance.r, f * color.g * y.radiance.g, f * color.b * y.radiance.b));
    }
    return out;
}

LC_ESTIMATOR(mine) = {LC_ABI, "mine", "three points", "lecture", LC_DIFFUSE, LC_AREA, 1, radiance};
