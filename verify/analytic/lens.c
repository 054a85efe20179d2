/* SPDX-License-Identifier: GPL-3.0-or-later */
/* lens.c: how much of a disk a polygon covers. */
#include "verify/analytic/effects.h"

typedef struct vec2 {
    double x, y;
} vec2;

static double cross(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }
static double dot(vec2 a, vec2 b) { return a.x * b.x + a.y * b.y; }
static vec2 between(vec2 a, vec2 b, double t)
{
    vec2 p = {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
    return p;
}

/* Area of the unit disk between the rays to a and b: a sector. */
static double sector(vec2 a, vec2 b) { return 0.5 * atan2(cross(a, b), dot(a, b)); }

/* Area of the triangle (0, a, b) within the unit disk, with the sign of its orientation: a triangle where the edge runs inside, sectors where
 * it runs outside. */
static double triangle(vec2 a, vec2 b)
{
    vec2 along = {b.x - a.x, b.y - a.y};
    double l2 = dot(along, along);
    if (!(l2 > 0))
        return 0;
    double middle = -dot(a, along) / l2, reach = middle * middle - (dot(a, a) - 1) / l2;
    if (!(reach > 0))
        return sector(a, b);
    double in = fmin(fmax(middle - sqrt(reach), 0), 1), out = fmin(fmax(middle + sqrt(reach), 0), 1);
    if (!(out > in))
        return sector(a, b);
    vec2 p = between(a, b, in), q = between(a, b, out);
    return (in > 0 ? sector(a, p) : 0) + 0.5 * cross(p, q) + (out < 1 ? sector(q, b) : 0);
}

double lc_disk_polygon_share(const double (*corners)[2], int count, double x, double y, double radius)
{
    double area = 0;
    for (int i = 0; i < count; ++i) {
        const double *c = corners[i], *d = corners[(i + 1) % count];
        vec2 a = {(c[0] - x) / radius, (c[1] - y) / radius}, b = {(d[0] - x) / radius, (d[1] - y) / radius};
        area += triangle(a, b);
    }
    return fmin(fabs(area) / LC_PI, 1);
}
