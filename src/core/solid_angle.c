/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Points on lights, uniform over the solid angle in which a hit sees them: spheres, and rectangles that are not sheared.
 */
#include "core/scene_c.h"

/* Along `wi` to the first (or second) of the two places where it meets the sphere. */
static void place_on_sphere(const lc_round *round, const lc_hit *hit, lc_vec3 wi, int second, lc_light_sample *out)
{
    lc_vec3 to = lc_sub(round->o, hit->p);
    double b = lc_dot(to, wi), root = sqrt(fmax(0.0, round->radius * round->radius - lc_dot(to, to) + b * b));
    lc_vec3 r = lc_normalize(lc_sub(lc_scale(second ? b + root : b - root, wi), to));
    out->wi = wi;
    out->p = lc_add(round->o, lc_scale(round->radius, r));
    out->n = lc_scale(round->sign, r);
    out->distance = lc_length(lc_sub(out->p, hit->p));
}

/* From outside a cone of directions, from within all of them, on its skin half of them: those that go in. */
static void sample_sphere(const lc_round *round, const lc_hit *hit, int is_own, double u, double v,
                          lc_light_sample *out)
{
    lc_vec3 to = lc_sub(round->o, hit->p);
    double d2 = lc_dot(to, to), sin2 = round->radius * round->radius / d2;
    if (is_own) {
        place_on_sphere(round, hit, lc_uniform_hemisphere(lc_normalize(to), u, v), 1, out);
        out->pdf_solid = 0.5 * LC_INV_PI;
    } else if (!(sin2 < 1)) {
        place_on_sphere(round, hit, lc_uniform_sphere(u, v), 1, out);
        out->pdf_solid = 0.25 * LC_INV_PI;
    } else {
        /* 1 - cos of the cone's half angle without cancellation, and of the direction within it */
        double most = sin2 / (1.0 + sqrt(1.0 - sin2)), x = u * most, sin_theta = sqrt(x * (2.0 - x));
        lc_vec3 axis = lc_normalize(to), s, t;
        lc_tangents(axis, &s, &t);
        double phi = 2.0 * LC_PI * v;
        lc_vec3 side = lc_add(lc_scale(sin_theta * cos(phi), s), lc_scale(sin_theta * sin(phi), t));
        place_on_sphere(round, hit, lc_add(side, lc_scale(1.0 - x, axis)), 0, out);
        out->pdf_solid = 0.5 * LC_INV_PI / most;
    }
}

/* A rectangle seen from a point: the names of Urena, Fajardo, King, An area-preserving parametrization for spherical rectangles,
 * EGSR 2013. In the frame (x, y, z) of the point it spans [x0, x1] x [y0, y1] at z0 < 0. */
typedef struct spherical_rectangle {
    lc_vec3 x, y, z;
    double x0, x1, y0, y1, z0;
    double b0, b1, k;
    double solid; /* its solid angle [sr] */
} spherical_rectangle;

static double angle_between(lc_vec3 a, lc_vec3 b) { return acos(fmax(-1.0, fmin(1.0, -lc_dot(a, b)))); }

static void prepare_rectangle(spherical_rectangle *q, const lc_face *face, lc_vec3 p)
{
    double half_x = lc_length(face->eu), half_y = lc_length(face->ev);
    lc_vec3 to = lc_sub(face->o, p);
    q->x = lc_scale(1.0 / half_x, face->eu);
    q->y = lc_scale(1.0 / half_y, face->ev);
    q->z = lc_cross(q->x, q->y);
    if (lc_dot(to, q->z) > 0)
        q->z = lc_neg(q->z);
    q->z0 = lc_dot(to, q->z);
    q->x0 = lc_dot(to, q->x) - half_x;
    q->x1 = q->x0 + 2.0 * half_x;
    q->y0 = lc_dot(to, q->y) - half_y;
    q->y1 = q->y0 + 2.0 * half_y;
    lc_vec3 v00 = lc_vec(q->x0, q->y0, q->z0), v01 = lc_vec(q->x0, q->y1, q->z0);
    lc_vec3 v10 = lc_vec(q->x1, q->y0, q->z0), v11 = lc_vec(q->x1, q->y1, q->z0);
    lc_vec3 n0 = lc_normalize(lc_cross(v00, v10)), n1 = lc_normalize(lc_cross(v10, v11));
    lc_vec3 n2 = lc_normalize(lc_cross(v11, v01)), n3 = lc_normalize(lc_cross(v01, v00));
    q->b0 = n0.z;
    q->b1 = n2.z;
    q->k = 2.0 * LC_PI - angle_between(n2, n3) - angle_between(n3, n0);
    q->solid = angle_between(n0, n1) + angle_between(n1, n2) - q->k;
}

/* Eq. 13 to 16 of the paper. */
static lc_vec3 point_of_rectangle(const spherical_rectangle *q, double u, double v)
{
    double au = u * q->solid + q->k, fu = (cos(au) * q->b0 - q->b1) / sin(au);
    double cu = fmax(-1.0, fmin(1.0, copysign(1.0 / sqrt(fu * fu + q->b0 * q->b0), fu)));
    double xu = fmax(q->x0, fmin(q->x1, -cu * q->z0 / sqrt(fmax(1.0 - cu * cu, 1e-300))));
    double d = sqrt(xu * xu + q->z0 * q->z0);
    double h0 = q->y0 / sqrt(d * d + q->y0 * q->y0), h1 = q->y1 / sqrt(d * d + q->y1 * q->y1);
    double h = h0 + v * (h1 - h0), yv = h * h < 1.0 ? h * d / sqrt(1.0 - h * h) : q->y1;
    yv = fmax(q->y0, fmin(q->y1, yv));
    return lc_add(lc_add(lc_scale(xu, q->x), lc_scale(yv, q->y)), lc_scale(q->z0, q->z));
}

/* Where it is small, the difference of angles that is its solid angle has lost its digits, and area is as good. */
static int sample_rectangle(const lc_face *face, const lc_hit *hit, double u, double v, lc_light_sample *out)
{
    spherical_rectangle q;
    double skew = lc_dot(face->eu, face->ev);
    if (skew * skew > 1e-24 * lc_dot(face->eu, face->eu) * lc_dot(face->ev, face->ev))
        return 0;
    prepare_rectangle(&q, face, hit->p);
    if (!(q.solid > 1e-4 && q.z0 < 0))
        return 0;
    lc_vec3 to = point_of_rectangle(&q, u, v);
    out->p = lc_add(hit->p, to);
    out->distance = lc_length(to);
    out->wi = lc_scale(1.0 / out->distance, to);
    out->n = face->n;
    out->pdf_solid = 1.0 / q.solid;
    return 1;
}

int lc_sample_solid(const lc_scene *scene, int index, const lc_hit *hit, double u, double v, lc_light_sample *out)
{
    const lc_shape *shape = &scene->shapes[index];
    int part = shape->is_round ? scene->face_count + shape->first : shape->first;
    if (shape->is_round && scene->rounds[shape->first].is_sphere)
        sample_sphere(&scene->rounds[shape->first], hit, hit->part == part, u, v, out);
    else if (shape->is_round || shape->count > 1 || !sample_rectangle(&scene->faces[shape->first], hit, u, v, out))
        return 0;
    out->shape = index;
    out->part = part;
    return 1;
}
