/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Private to accel.c: where a ray meets a sphere or a disk, in double. A ray that leaves one knows it, and the root at its origin is divided
 * out.
 */
#ifndef LC_ROUND_C_H
#define LC_ROUND_C_H

#include "core/scene_c.h"

static inline double meet_sphere(const lc_round *sphere, lc_vec3 o, lc_vec3 d, double t_max, int is_from, int is_to)
{
    lc_vec3 oc = lc_sub(o, sphere->o);
    double b = lc_dot(oc, d);
    double root[2]; /* in increasing order */
    if (is_from) {  /* one root is 0 and does not count */
        root[0] = -1.0;
        root[1] = -2.0 * b;
    } else {
        double r = sphere->radius;
        lc_vec3 l = lc_sub(oc, lc_scale(b, d)); /* from the center to the ray's nearest point */
        double discriminant = r * r - lc_dot(l, l);
        if (discriminant < 0)
            return -1.0;
        double far = -b - copysign(sqrt(discriminant), b);
        double near = far != 0 ? (lc_dot(oc, oc) - r * r) / far : 0.0;
        root[0] = fmin(near, far);
        root[1] = fmax(near, far);
    }
    if (is_to) { /* one root is t_max and does not count */
        int end = fabs(root[0] - t_max) < fabs(root[1] - t_max) ? 0 : 1;
        root[end] = -1.0;
    }
    for (int i = 0; i < 2; ++i)
        if (root[i] > 0 && root[i] < t_max)
            return root[i];
    return -1.0;
}

static inline double meet_disk(const lc_round *disk, lc_vec3 o, lc_vec3 d, double t_max, int is_end)
{
    if (is_end)
        return -1.0;
    double cos_theta = lc_dot(disk->n, d);
    if (cos_theta == 0)
        return -1.0;
    double t = lc_dot(disk->n, lc_sub(disk->o, o)) / cos_theta;
    if (!(t > 0 && t < t_max))
        return -1.0;
    lc_vec3 r = lc_sub(lc_add(o, lc_scale(t, d)), disk->o);
    double u = lc_dot(disk->du, r), v = lc_dot(disk->dv, r);
    return u * u + v * v <= 1.0 ? t : -1.0;
}

/* Nearest t in (0, t_max) where the ray meets the round part, or -1. is_from, is_to: it starts, or ends at t_max, on the part. */
static inline double meet_round(const lc_round *round, lc_vec3 o, lc_vec3 d, double t_max, int is_from, int is_to)
{
    if (round->is_sphere)
        return meet_sphere(round, o, d, t_max, is_from, is_to);
    return meet_disk(round, o, d, t_max, is_from || is_to);
}

#endif
