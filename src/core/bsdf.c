/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * What a surface does with light: the laws of mirrors and of glass.
 */
#include "core/scene_c.h"

/* cos^2 of the angle of refraction, by Snell; <= 0 at total reflection. Written so that ior = 1 gives back cos^2 of the incident angle, to
 * the bit: 1 - sin^2 / ior^2 would leave a faint reflection of nothing. One function for all, so that they agree where it becomes total. */
static double cos2_refracted(double cos_i, double ior)
{
    return ((ior - 1) * (ior + 1) + cos_i * cos_i) / (ior * ior);
}

double lc_fresnel(double cos_i, double ior)
{
    double cos2_t = cos2_refracted(cos_i, ior);
    if (!(cos2_t > 0))
        return 1.0;
    double cos_t = sqrt(cos2_t);
    double s = (cos_i - ior * cos_t) / (cos_i + ior * cos_t);
    double p = (ior * cos_i - cos_t) / (ior * cos_i + cos_t);
    return 0.5 * (s * s + p * p);
}

lc_vec3 lc_reflect(lc_vec3 wo, lc_vec3 n) { return lc_sub(lc_scale(2.0 * lc_dot(n, wo), n), wo); }

int lc_refract(lc_vec3 wo, lc_vec3 n, double ior, lc_vec3 *wi)
{
    n = lc_facing(n, wo);
    double cos_i = lc_dot(n, wo), cos2_t = cos2_refracted(cos_i, ior);
    if (!(cos2_t > 0))
        return 0;
    *wi = lc_sub(lc_scale(cos_i / ior - sqrt(cos2_t), n), lc_scale(1.0 / ior, wo));
    return 1;
}
