/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * From the unit square to directions and surfaces, each with its density.
 */
#include "core/scene_c.h"

/* A tangent for a unit normal, continuous but for one direction, never degenerate: Duff et al., Building an orthonormal basis,
 * revisited, JCGT 6(1) 2017, listing 3. */
void lc_tangents(lc_vec3 n, lc_vec3 *s, lc_vec3 *t)
{
    double sign = copysign(1.0, n.z);
    double a = -1.0 / (sign + n.z);
    double b = n.x * n.y * a;
    *s = lc_vec(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x);
    *t = lc_vec(b, sign + n.y * n.y * a, -n.y);
}

static lc_vec3 around(lc_vec3 n, double cos_theta, double sin_theta, double phi)
{
    lc_vec3 s, t;
    lc_tangents(n, &s, &t);
    double x = sin_theta * cos(phi), y = sin_theta * sin(phi);
    return lc_vec(x * s.x + y * t.x + cos_theta * n.x, x * s.y + y * t.y + cos_theta * n.y,
                  x * s.z + y * t.z + cos_theta * n.z);
}

/* Archimedes: the height on the unit sphere is uniform. */
lc_vec3 lc_uniform_hemisphere(lc_vec3 n, double u, double v)
{
    double cos_theta = 1.0 - u;
    return around(n, cos_theta, sqrt(fmax(0.0, u * (2.0 - u))), 2.0 * LC_PI * v);
}

/* Malley: a uniform point of the disk, lifted. cos^2 = 1 - u is never 0, since u < 1. */
lc_vec3 lc_cosine_hemisphere(lc_vec3 n, double u, double v)
{
    return around(n, sqrt(1.0 - u), sqrt(u), 2.0 * LC_PI * v);
}

/* Uniform over the unit sphere. */
lc_vec3 lc_uniform_sphere(double u, double v)
{
    double z = 1.0 - 2.0 * u, r = 2.0 * sqrt(fmax(0.0, u * (1.0 - u))), phi = 2.0 * LC_PI * v;
    return lc_vec(r * cos(phi), r * sin(phi), z);
}
