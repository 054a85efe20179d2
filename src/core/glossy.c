/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The rough mirror: facets that reflect everything, with GGX slopes and Smith's masking, as Mitsuba 3's `roughconductor`
 * has it (Trowbridge and Reitz 1975; Walter, Marschner, Li and Torrance, EGSR 2007, eq. 20, 33, 34).
 *
 *     f = D(h) G1(wo) G1(wi) / (4 cos_o cos_i),  h = (wo + wi) / |wo + wi|,  G1(w) = 2 cos / (cos + root(w))
 *     root(w) = sqrt(cos^2 + alpha^2 sin^2),  D = alpha^2 / (pi (alpha^2 cos_h^2 + sin_h^2)^2)
 *
 * in which the cosines cancel: f = D / ((cos_o + root_o) (cos_i + root_i)), finite at grazing angles, and symmetric to
 * the bit. Facets see each other here, but light between two of them is lost: the albedo is below 1.
 */
#include "core/scene_c.h"

static double root(double cosine, double alpha)
{
    return sqrt(cosine * cosine + alpha * alpha * fmax(0.0, (1 - cosine) * (1 + cosine)));
}

/* Density of facets with normal h, of any length but 0. The sine is a cross product: 1 - cos^2 is rounding when alpha is
 * small. */
static double facets(lc_vec3 n, lc_vec3 h, double alpha)
{
    lc_vec3 across = lc_cross(n, h);
    double cosine = lc_dot(n, h), a2 = alpha * alpha, h2 = lc_dot(h, h);
    double t = (a2 * cosine * cosine + lc_dot(across, across)) / h2;
    return a2 * LC_INV_PI / (t * t);
}

double lc_glossy_value(lc_vec3 n, lc_vec3 wo, lc_vec3 wi, double alpha)
{
    double cos_o = lc_dot(n, wo), cos_i = lc_dot(n, wi);
    if (!(cos_o > 0 && cos_i > 0))
        return 0;
    return facets(n, lc_add(wo, wi), alpha) / ((cos_o + root(cos_o, alpha)) * (cos_i + root(cos_i, alpha)));
}

/* A visible facet has density D G1(wo) (wo . h) / cos_o, and 4 (wo . h) is the Jacobian of reflecting in it. */
double lc_glossy_pdf(lc_vec3 n, lc_vec3 wo, lc_vec3 wi, double alpha)
{
    double cos_o = lc_dot(n, wo);
    lc_vec3 h = lc_add(wo, wi);
    if (!(cos_o > 0 && lc_dot(n, h) > 0))
        return 0;
    return facets(n, h, alpha) / (2 * (cos_o + root(cos_o, alpha)));
}

/* Visible normals (Heitz, JCGT 7(4) 2018) by spherical caps (Dupuy and Benyoub, CGF 42(8) 2023): stretched by alpha,
 * the facets are a hemisphere; what wo lights of it, reflected, is a uniform cap down to where -wo is. */
lc_vec3 lc_glossy_sample(lc_vec3 n, lc_vec3 wo, double alpha, double u, double v)
{
    lc_vec3 s, t;
    lc_tangents(n, &s, &t);
    lc_vec3 o = lc_normalize(lc_vec(alpha * lc_dot(s, wo), alpha * lc_dot(t, wo), lc_dot(n, wo)));
    double z = (1 - u) * (1 + o.z) - o.z, r = sqrt(fmax(0.0, (1 - z) * (1 + z))), phi = 2 * LC_PI * v;
    lc_vec3 h = lc_add(o, lc_vec(r * cos(phi), r * sin(phi), z));
    h = lc_normalize(lc_vec(alpha * h.x, alpha * h.y, h.z));
    return lc_reflect(wo, lc_add(lc_add(lc_scale(h.x, s), lc_scale(h.y, t)), lc_scale(h.z, n)));
}
