/* SPDX-License-Identifier: GPL-3.0-or-later */
/* motion.c: when a line is met by a shape that moves straight and evenly, and what a moving lamp gives on average. */
#include "verify/analytic/effects.h"

#include <stdlib.h>

static const lc_span never = {1, 0};

/* Times of `span` at which from + t slope lies in [-1, 1]. */
static lc_span within_one(lc_span span, double from, double slope)
{
    if (slope == 0)
        return fabs(from) <= 1 ? span : never;
    double a = (-1 - from) / slope, b = (1 - from) / slope;
    span.from = fmax(span.from, fmin(a, b));
    span.to = fmin(span.to, fmax(a, b));
    return span;
}

/* Times of [0, 1] at which a t^2 + 2 b t + c <= 0, a >= 0. */
static lc_span below_zero(double a, double b, double c)
{
    lc_span span = {0, 1};
    double root = b * b - a * c;
    if (a == 0)
        return c <= 0 ? span : never;
    if (root < 0)
        return never;
    span.from = fmax(0, (-b - sqrt(root)) / a);
    span.to = fmin(1, (-b + sqrt(root)) / a);
    return span;
}

/* The line in a flat shape's own coordinates, at time 0 (x, y) and their change until time 1. */
static void cross_plane(double at[2], double change[2], lc_vec3 centre, lc_vec3 a, lc_vec3 b, lc_vec3 motion, lc_vec3 p,
                        lc_vec3 d)
{
    lc_vec3 n = lc_cross(a, b);
    double n2 = lc_dot(n, n), slant = lc_dot(n, d);
    lc_vec3 r = lc_sub(p, centre);
    lc_vec3 q = lc_sub(r, lc_scale(lc_dot(n, r) / slant, d)), move = lc_sub(lc_scale(lc_dot(n, motion) / slant, d), motion);
    lc_vec3 x = lc_scale(1 / n2, lc_cross(b, n)), y = lc_scale(1 / n2, lc_cross(n, a)); /* x . a = 1, x . b = 0 */
    at[0] = lc_dot(x, q);
    at[1] = lc_dot(y, q);
    change[0] = lc_dot(x, move);
    change[1] = lc_dot(y, move);
}

lc_span lc_rectangle_span(lc_vec3 centre, lc_vec3 a, lc_vec3 b, lc_vec3 motion, lc_vec3 p, lc_vec3 d)
{
    double at[2], change[2];
    lc_span span = {0, 1};
    cross_plane(at, change, centre, a, b, motion, p, d);
    return within_one(within_one(span, at[0], change[0]), at[1], change[1]);
}

lc_span lc_disk_span(lc_vec3 centre, lc_vec3 a, lc_vec3 b, lc_vec3 motion, lc_vec3 p, lc_vec3 d)
{
    double at[2], change[2];
    cross_plane(at, change, centre, a, b, motion, p, d);
    return below_zero(change[0] * change[0] + change[1] * change[1], at[0] * change[0] + at[1] * change[1],
                      at[0] * at[0] + at[1] * at[1] - 1);
}

lc_span lc_sphere_span(lc_vec3 centre, double radius, lc_vec3 motion, lc_vec3 p, lc_vec3 d)
{
    lc_vec3 at = lc_cross(d, lc_sub(centre, p)), change = lc_cross(d, motion); /* distances from the line, |d| = 1 */
    return below_zero(lc_dot(change, change), lc_dot(at, change), lc_dot(at, at) - radius * radius);
}

double lc_spans_length(const lc_span *spans, int count)
{
    double length = 0;
    for (int i = 0; i < count; ++i) { /* what span i adds: cut away those before it, which may leave several pieces */
        double at = spans[i].from;
        while (at < spans[i].to) {
            double next = spans[i].to;
            int inside = 0;
            for (int k = 0; k < i; ++k) {
                if (spans[k].from <= at && at < spans[k].to) {
                    at = spans[k].to;
                    inside = 1;
                } else if (spans[k].from > at && spans[k].from < spans[k].to)
                    next = fmin(next, spans[k].from);
            }
            if (inside)
                continue;
            length += next - at;
            at = next;
        }
    }
    return length;
}

/* Gauss and Legendre on [0, 1], eight nodes, exact to degree 15. */
static const double nodes[8] = {0.019855071751231856, 0.10166676129318664, 0.23723379504183550, 0.40828267875217510,
                                0.59171732124782490,  0.76276620495816450, 0.89833323870681336, 0.98014492824876814};
static const double weights[8] = {0.050614268145188130, 0.11119051722668724, 0.15685332293894364, 0.18134189168918100,
                                  0.18134189168918100,  0.15685332293894364, 0.11119051722668724, 0.050614268145188130};

lc_status lc_moving_irradiance(lc_rgb *out, const lc_scene_desc *desc, lc_vec3 p, lc_vec3 n, lc_error *err)
{
    size_t size = (size_t)desc->shape_count * sizeof *desc->shapes;
    lc_scene_desc then = *desc;
    lc_status status = LC_OK;
    *out = lc_black();
    then.shapes = malloc(size + 1);
    if (!then.shapes)
        return lc_fail(err, LC_FAULT, "moving lamps: out of memory");
    for (int k = 0; k < 8 && status == LC_OK; ++k) {
        lc_rgb irradiance;
        for (int i = 0; i < desc->shape_count; ++i) {
            lc_shape_desc *shape = &then.shapes[i];
            *shape = desc->shapes[i];
            shape->to_world.m[0][3] += nodes[k] * shape->motion.x;
            shape->to_world.m[1][3] += nodes[k] * shape->motion.y;
            shape->to_world.m[2][3] += nodes[k] * shape->motion.z;
            shape->motion = lc_vec(0, 0, 0);
        }
        status = lc_direct_irradiance(&irradiance, &then, p, n, err);
        *out = lc_rgb_add(*out, lc_rgb_scale(weights[k], irradiance));
    }
    free(then.shapes);
    return status;
}
