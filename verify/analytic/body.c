/* SPDX-License-Identifier: GPL-3.0-or-later */
/* body.c: shapes in the frame of one receiver. */
#include "verify/analytic/body.h"

/* ---- making them -------------------------------------------------------------------------------------------- */

lc_receiver lc_receiver_at(lc_vec3 p, lc_vec3 n)
{
    lc_receiver r;
    r.p = p, r.n = n;
    r.x = lc_normalize(lc_cross(fabs(n.x) < 0.6 ? lc_vec(1, 0, 0) : lc_vec(0, 1, 0), n));
    r.y = lc_cross(n, r.x);
    return r;
}

lc_vec3 lc_receiver_vector(const lc_receiver *receiver, lc_vec3 v)
{
    return lc_vec(lc_dot(v, receiver->x), lc_dot(v, receiver->y), lc_dot(v, receiver->n));
}

lc_vec3 lc_receiver_point(const lc_receiver *receiver, lc_vec3 p)
{
    return lc_receiver_vector(receiver, lc_sub(p, receiver->p));
}

static lc_body body_of(lc_body_kind kind, int shape)
{
    lc_body body = {LC_BODY_SKY, 0, 0, {{0, 0, 0}}, 0, {0, 0, 0}, 0, {0, 0, 0}, INFINITY};
    body.kind = kind;
    body.shape = shape;
    return body;
}

lc_body lc_body_sky(void) { return body_of(LC_BODY_SKY, -1); }

lc_body lc_body_polygon(const lc_receiver *receiver, const lc_vec3 *corners, int count, int shape)
{
    lc_body body = body_of(LC_BODY_POLYGON, shape);
    lc_vec3 local[LC_BODY_CORNERS / 2], middle = lc_vec(0, 0, 0);
    for (int i = 0; i < count; ++i) {
        local[i] = lc_receiver_point(receiver, corners[i]);
        middle = lc_add(middle, lc_scale(1.0 / count, local[i]));
    }
    body.middle = middle, body.reach = 0;
    for (int i = 0; i < count; ++i)
        body.reach = fmax(body.reach, lc_length(lc_sub(local[i], middle)));
    lc_vec3 area = lc_polygon_area(local, count);
    double size = lc_length(area);
    if (!(size > 0))
        return body; /* no corners: nothing there */
    body.normal = lc_scale(1 / size, area);
    body.offset = lc_dot(body.normal, local[0]);
    body.count = lc_polygon_clip(body.v, local, count, lc_vec(0, 0, 1), 0);
    return body;
}

lc_body lc_body_ellipse(const lc_receiver *receiver, lc_vec3 centre, lc_vec3 axis1, lc_vec3 axis2, int shape)
{
    lc_body body = body_of(LC_BODY_ELLIPSE, shape);
    body.v[0] = body.middle = lc_receiver_point(receiver, centre);
    body.v[1] = lc_receiver_vector(receiver, axis1);
    body.v[2] = lc_receiver_vector(receiver, axis2);
    body.reach = hypot(lc_length(axis1), lc_length(axis2));
    body.normal = lc_normalize(lc_cross(body.v[1], body.v[2]));
    body.offset = lc_dot(body.normal, body.v[0]);
    return body;
}

lc_body lc_body_ball(const lc_receiver *receiver, lc_vec3 centre, double radius, int shape)
{
    lc_body body = body_of(LC_BODY_BALL, shape);
    body.v[0] = body.middle = lc_receiver_point(receiver, centre);
    body.radius = body.reach = radius;
    return body;
}

/* ---- where they are ------------------------------------------------------------------------------------------ */

double lc_body_height(const lc_body *body)
{
    return fabs(body->offset) <= LC_TOUCH * (lc_length(body->middle) + body->reach) ? 0 : -body->offset;
}

int lc_body_side(const lc_body *ball)
{
    double d = lc_length(ball->v[0]);
    return d < ball->radius * (1 - LC_TOUCH) ? -1 : d <= ball->radius * (1 + LC_TOUCH) ? 0 : 1;
}

int lc_body_is_above(const lc_body *body)
{
    double top = -INFINITY;
    if (body->kind == LC_BODY_SKY)
        return 0;
    if (body->kind == LC_BODY_BALL) {
        top = body->v[0].z + body->radius;
    } else if (!(fabs(lc_body_height(body)) > 0)) {
        return 0; /* seen from its edge, or has no area (NaN) */
    } else if (body->kind == LC_BODY_ELLIPSE) {
        top = body->v[0].z + hypot(body->v[1].z, body->v[2].z);
    } else {
        for (int i = 0; i < body->count; ++i)
            top = fmax(top, body->v[i].z);
    }
    return top > LC_TOUCH * (lc_length(body->middle) + body->reach);
}

int lc_body_may_hide(const lc_body *body, const lc_body *lamp)
{
    if (body->shape == lamp->shape)
        return 0;
    double d0 = lc_length(body->middle), d1 = lc_length(lamp->middle);
    if (d0 <= body->reach * (1 + LC_TOUCH) || lamp->kind == LC_BODY_SKY)
        return 1;
    if (d0 - body->reach >= d1 + lamp->reach)
        return 0;
    if (d1 <= lamp->reach * (1 + LC_TOUCH))
        return 1;
    double between = atan2(lc_length(lc_cross(body->middle, lamp->middle)), lc_dot(body->middle, lamp->middle));
    return between < asin(body->reach / d0) + asin(lamp->reach / d1) + LC_TOUCH;
}

double lc_body_depth(const lc_body *body, lc_vec3 d)
{
    if (body->kind == LC_BODY_SKY)
        return INFINITY;
    if (body->kind != LC_BODY_BALL)
        return body->offset / lc_dot(body->normal, d);
    double along = lc_dot(body->v[0], d), distance = lc_length(body->v[0]);
    int side = lc_body_side(body);
    if (side == 0)
        return 2 * along;
    double half = sqrt(fmax(0, (body->radius - distance) * (body->radius + distance) + along * along));
    return side > 0 ? along - half : along + half;
}

static int flat_contains(const lc_body *body, lc_vec3 x)
{
    if (body->kind == LC_BODY_POLYGON) {
        double sign = body->offset > 0 ? 1 : -1;
        for (int i = 0; i < body->count; ++i)
            if (sign * lc_dot(lc_cross(body->v[i], body->v[(i + 1) % body->count]), x) < 0)
                return 0;
        return body->count >= 3;
    }
    lc_vec3 r = lc_sub(x, body->v[0]), a = body->v[1], b = body->v[2];
    double aa = lc_dot(a, a), ab = lc_dot(a, b), bb = lc_dot(b, b), ra = lc_dot(r, a), rb = lc_dot(r, b);
    double det = aa * bb - ab * ab, s = (ra * bb - rb * ab) / det, t = (rb * aa - ra * ab) / det;
    return s * s + t * t <= 1;
}

int lc_body_hides_point(const lc_body *body, lc_vec3 target)
{
    double distance = lc_length(target);
    lc_vec3 d = lc_scale(1 / distance, target);
    if (isinf(distance))
        return 0;
    if (body->kind == LC_BODY_BALL) {
        double across = lc_length(lc_cross(body->v[0], d)), along = lc_dot(body->v[0], d);
        if (lc_body_side(body) > 0 && (across >= body->radius || along <= 0))
            return 0;
    }
    double depth = lc_body_depth(body, d);
    if (!(depth > 0 && depth < distance * (1 - LC_TOUCH)))
        return 0;
    return body->kind == LC_BODY_BALL || flat_contains(body, lc_scale(depth, d));
}

/* ---- as seen along an azimuth ------------------------------------------------------------------------------------ */

/* A segment in the half-plane (s outwards, z up), clipped to s >= 0 and z >= 0. */
static int segment_interval(double s0, double z0, double s1, double z1, double q[2])
{
    if (z0 < 0 && z1 < 0)
        return 0;
    if (z0 < 0)
        s0 += (s1 - s0) * z0 / (z0 - z1), z0 = 0;
    else if (z1 < 0)
        s1 += (s0 - s1) * z1 / (z1 - z0), z1 = 0;
    if (s0 < 0 && s1 < 0)
        return 0;
    if (s0 < 0)
        z0 += (z1 - z0) * s0 / (s0 - s1), s0 = 0;
    else if (s1 < 0)
        z1 += (z0 - z1) * s1 / (s1 - s0), s1 = 0;
    double r0 = s0 * s0 + z0 * z0, r1 = s1 * s1 + z1 * z1;
    if (!(r0 > 0 && r1 > 0))
        return 0;
    double q0 = s0 * s0 / r0, q1 = s1 * s1 / r1;
    q[0] = fmin(q0, q1), q[1] = fmax(q0, q1);
    return q[0] < q[1];
}

static int polygon_interval(const lc_body *body, double c, double s, double q[2])
{
    double out[2] = {0, 0}, up[2] = {0, 0};
    int found = 0;
    for (int i = 0; i < body->count && found < 2; ++i) {
        lc_vec3 a = body->v[i], b = body->v[(i + 1) % body->count];
        double ha = c * a.y - s * a.x, hb = c * b.y - s * b.x;
        if ((ha < 0) == (hb < 0))
            continue;
        double t = ha / (ha - hb);
        lc_vec3 x = lc_add(a, lc_scale(t, lc_sub(b, a)));
        out[found] = c * x.x + s * x.y;
        up[found++] = x.z;
    }
    return found == 2 && segment_interval(out[0], up[0], out[1], up[1], q);
}

static int ellipse_interval(const lc_body *body, double c, double s, double q[2])
{
    double h[3], o[3];
    for (int i = 0; i < 3; ++i) {
        h[i] = c * body->v[i].y - s * body->v[i].x;
        o[i] = c * body->v[i].x + s * body->v[i].y;
    }
    double scale = hypot(h[1], h[2]), distance = -h[0] / scale;
    if (!(fabs(distance) < 1))
        return 0;
    double half = sqrt((1 - distance) * (1 + distance)), e1 = h[1] / scale, e2 = h[2] / scale;
    double x0 = distance * e1 - half * e2, y0 = distance * e2 + half * e1;
    double x1 = distance * e1 + half * e2, y1 = distance * e2 - half * e1;
    const lc_vec3 *v = body->v;
    return segment_interval(o[0] + x0 * o[1] + y0 * o[2], v[0].z + x0 * v[1].z + y0 * v[2].z,
                            o[0] + x1 * o[1] + y1 * o[2], v[0].z + x1 * v[1].z + y1 * v[2].z, q);
}

static int ball_interval(const lc_body *body, double c, double s, double q[2])
{
    int side = lc_body_side(body);
    q[0] = 0, q[1] = 1;
    if (side < 0)
        return 1;
    double distance = lc_length(body->v[0]);
    double out = c * body->v[0].x + s * body->v[0].y, along = hypot(out, body->v[0].z);
    /* tangent of the half angle in this plane: half / cone, the cone's tangents being sqrt(d^2 - R^2) long */
    double cone2 = side > 0 ? (distance - body->radius) * (distance + body->radius) : 0;
    double across = c * body->v[0].y - s * body->v[0].x;
    double half2 = side > 0 ? (body->radius - across) * (body->radius + across) : along * along;
    if (!(half2 > 0 && along > 0))
        return 0;
    double half = atan2(sqrt(half2), sqrt(cone2)), middle = atan2(out, body->v[0].z);
    double from = fmax(0, middle - half), to = fmin(LC_PI / 2, middle + half);
    if (!(from < to))
        return 0;
    q[0] = sin(from) * sin(from);
    q[1] = to < LC_PI / 2 ? sin(to) * sin(to) : 1;
    return q[0] < q[1];
}

int lc_body_interval(const lc_body *body, double cos_phi, double sin_phi, double q[2])
{
    switch (body->kind) {
    case LC_BODY_POLYGON:
        return polygon_interval(body, cos_phi, sin_phi, q);
    case LC_BODY_ELLIPSE:
        return ellipse_interval(body, cos_phi, sin_phi, q);
    case LC_BODY_BALL:
        return ball_interval(body, cos_phi, sin_phi, q);
    case LC_BODY_SKY:
        break;
    }
    q[0] = 0, q[1] = 1;
    return 1;
}

/* ---- azimuths where the ends are not smooth -------------------------------------------------------------------- */

/* Vertical planes through the receiver that touch the ellipse, and where it goes below the horizon. */
static int ellipse_azimuths(const lc_body *body, double *phi)
{
    int count = 0;
    const lc_vec3 *v = body->v;
    /* with x towards the centre at distance r: (r sin)^2 = (e1 . w)^2 + (e2 . w)^2, a quadratic in the tangent */
    double r = hypot(v[0].x, v[0].y), to = atan2(v[0].y, v[0].x), c = cos(to), s = sin(to);
    double x1 = c * v[1].x + s * v[1].y, y1 = c * v[1].y - s * v[1].x;
    double x2 = c * v[2].x + s * v[2].y, y2 = c * v[2].y - s * v[2].x;
    double a = r * r - x1 * x1 - x2 * x2, b = x1 * y1 + x2 * y2, m = -y1 * y1 - y2 * y2;
    double disc = b * b - a * m;
    if (disc >= 0) {
        double root = -(b + (b < 0 ? -sqrt(disc) : sqrt(disc)));
        double t0 = to + atan2(root, a), t1 = to + atan2(m, root);
        phi[count++] = t0, phi[count++] = t0 + LC_PI;
        phi[count++] = t1, phi[count++] = t1 + LC_PI;
    }
    double z = hypot(v[1].z, v[2].z);
    if (fabs(v[0].z) < z) {
        double middle = atan2(v[2].z, v[1].z), half = acos(-v[0].z / z);
        for (int i = -1; i <= 1; i += 2) {
            double psi = middle + i * half;
            lc_vec3 x = lc_add(v[0], lc_add(lc_scale(cos(psi), v[1]), lc_scale(sin(psi), v[2])));
            phi[count++] = atan2(x.y, x.x);
        }
    }
    return count;
}

static int ball_azimuths(const lc_body *body, double *phi)
{
    int count = 0, side = lc_body_side(body);
    double out = hypot(body->v[0].x, body->v[0].y), to = atan2(body->v[0].y, body->v[0].x);
    double distance = lc_length(body->v[0]);
    if (side < 0)
        return 0;
    if (side > 0 && out > body->radius) {
        double half = asin(body->radius / out);
        phi[count++] = to - half, phi[count++] = to + half;
    }
    double horizon2 = (distance - body->radius) * (distance + body->radius);
    if (side == 0 || horizon2 < out * out) {
        double half = side == 0 ? LC_PI / 2 : acos(sqrt(horizon2) / out);
        phi[count++] = to - half, phi[count++] = to + half;
    }
    return count;
}

int lc_body_azimuths(const lc_body *body, double *phi)
{
    if (body->kind == LC_BODY_ELLIPSE)
        return ellipse_azimuths(body, phi);
    if (body->kind == LC_BODY_BALL)
        return ball_azimuths(body, phi);
    for (int i = 0; i < body->count; ++i)
        phi[i] = atan2(body->v[i].y, body->v[i].x);
    return body->count;
}
