/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Direct light: a point on every lamp. */
#include "lightcheck.h"

static double lambert(double a) { return a > 0 ? a : 0; }

/* Irradiance from a point of a lamp [W m^-2], without its shadow. */
static lc_rgb irradiance(const lc_light_sample *s, lc_vec3 n)
{
    double here = lambert(lc_dot(n, s->wi));
    if (s->is_delta)
        return lc_rgb_scale(here, s->irradiance);
    double there = lambert(lc_dot(s->n, lc_neg(s->wi)));
    double solid_angle = there / (s->pdf_area * s->distance * s->distance);
    return lc_rgb_scale(solid_angle * here, s->radiance);
}

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *x, const lc_options *o, lc_sampler *rnd)
{
    lc_rgb e = lc_black(), result = o->min_bounces == 0 ? lc_emission(scene, x) : lc_black();
    (void)ray;
    if (x->valid == 0 || o->min_bounces > 1 || o->max_bounces == 0)
        return result;
    lc_vec3 normal = lc_facing(x->n, x->wo);
    for (int l = 0; l < lc_light_count(scene); ++l) {
        lc_light_sample s;
        lc_light_sample_one(scene, l, x, rnd, &s);
        if (lc_visible(scene, x, &s))
            e = lc_rgb_add(e, irradiance(&s, normal));
    }
    lc_rgb rho = lc_material_at(scene, x).diffuse;
    return lc_rgb_add(result, lc_color(rho.r * e.r / LC_PI, rho.g * e.g / LC_PI, rho.b * e.b / LC_PI));
}

LC_ESTIMATOR(mine) = {LC_ABI,     "mine", "direct light", "lecture", LC_DIFFUSE, LC_AREA | LC_POINT | LC_DIRECTIONAL, 1,
                      radiance};
