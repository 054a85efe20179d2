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

/* cos and sin of 2 pi v, v in [0, 1], within 3e-15: Taylor's series of a quarter of the angle, at most pi/4, which is then doubled
 * twice. Without a branch: the library's chooses by the size of the angle, and here that is random. Its bits also depend on its
 * version and on the CPU. */
static inline void circle(double v, double *cosine, double *sine)
{
    double x = (v - 0.5) * (0.5 * LC_PI), y = x * x, z = y * y; /* a quarter of 2 pi v - pi */
    double c = 1 + z * (1.0 / 24 + z * (1.0 / 40320 + z * (1.0 / 479001600 + z * (1.0 / 20922789888000)))) -
               y * (1.0 / 2 + z * (1.0 / 720 + z * (1.0 / 3628800 + z * (1.0 / 87178291200))));
    double s = 1 + z * (1.0 / 120 + z * (1.0 / 362880 + z * (1.0 / 6227020800))) -
               y * (1.0 / 6 + z * (1.0 / 5040 + z * (1.0 / 39916800 + z * (1.0 / 1307674368000))));
    s *= x;
    double c2 = 1 - 2 * s * s, s2 = 2 * s * c;
    *cosine = 2 * s2 * s2 - 1; /* of the angle less pi: both change sign */
    *sine = -2 * s2 * c2;
}

/* `turn` in [0, 1] of the full circle. */
static inline lc_vec3 around(lc_vec3 n, double cos_theta, double sin_theta, double turn)
{
    lc_vec3 s, t;
    double x, y;
    lc_tangents(n, &s, &t);
    circle(turn, &x, &y);
    x *= sin_theta;
    y *= sin_theta;
    return lc_vec(x * s.x + y * t.x + cos_theta * n.x, x * s.y + y * t.y + cos_theta * n.y,
                  x * s.z + y * t.z + cos_theta * n.z);
}

/* Archimedes: the height on the unit sphere is uniform. */
lc_vec3 lc_uniform_hemisphere(lc_vec3 n, double u, double v)
{
    double cos_theta = 1.0 - u;
    return around(n, cos_theta, sqrt(u * (2.0 - u)), v);
}

/* Malley: a uniform point of the disk, lifted. cos^2 = 1 - u is never 0, since u < 1. */
lc_vec3 lc_cosine_hemisphere(lc_vec3 n, double u, double v)
{
    return around(n, sqrt(1.0 - u), sqrt(u), v);
}

/* Uniform over the unit sphere. */
lc_vec3 lc_uniform_sphere(double u, double v)
{
    double z = 1.0 - 2.0 * u, r = 2.0 * sqrt(u * (1.0 - u)), x, y;
    circle(v, &x, &y);
    return lc_vec(r * x, r * y, z);
}
