/* SPDX-License-Identifier: GPL-3.0-or-later */
/* direct.c: the exact direct light of a scene's description at one point.
 *
 * Every emitting face becomes a body with one colour (a checkerboard rectangle: one a cell); what may hide it is
 * gathered; then the cheapest exact form applies: a closed one where nothing hides, clipping among flat shapes, else
 * the scan. */
#include "verify/analytic/analytic.h"

#include <stdlib.h>

#include "verify/analytic/body.h"

enum { FACES = 6, MAX_CELLS = 65536 };

struct direct {
    const lc_scene_desc *desc;
    lc_receiver receiver;
    lc_body *bodies;        /* all that stands above the horizon */
    const lc_body **hiders; /* those that may hide the lamp at hand */
    int count;
    lc_rgb sum;
    lc_error *err;
};

/* ---- shapes as bodies --------------------------------------------------------------------------------------- */

/* Image of a local axis, or with k = 3 of the origin. Not lc_affine_*: a closed form shares no code with what it
 * judges. */
static lc_vec3 column(const lc_affine *a, int k) { return lc_vec(a->m[0][k], a->m[1][k], a->m[2][k]); }

/* 1 when the map mirrors: then the image of a right-handed pair of axes turns the other way round. */
static int mirrors(const lc_affine *a) { return lc_dot(lc_cross(column(a, 0), column(a, 1)), column(a, 2)) < 0; }

/* The rectangle centre + s a + t b over [s0, s1] x [t0, t1], emitting along a x b or, `turned`, against it. */
static lc_body quad(const struct direct *direct, int shape, lc_vec3 centre, lc_vec3 a, lc_vec3 b, const double s[2],
                    const double t[2], int turned)
{
    lc_vec3 corner[4];
    for (int i = 0; i < 4; ++i) {
        int right = (i == 1 || i == 2), top = i >= 2;
        corner[turned ? 3 - i : i] = lc_add(centre, lc_add(lc_scale(s[right], a), lc_scale(t[top], b)));
    }
    return lc_body_polygon(&direct->receiver, corner, 4, shape);
}

/* A cube's faces turned outwards, or inwards with flip_normals. */
static void cube_faces(const struct direct *direct, int index, lc_body faces[FACES])
{
    static const double whole[2] = {-1, 1};
    const lc_shape_desc *shape = &direct->desc->shapes[index];
    const lc_affine *map = &shape->to_world;
    for (int i = 0; i < FACES; ++i) {
        int k = i / 2, negative = i % 2;
        lc_vec3 centre = lc_add(column(map, 3), lc_scale(negative ? -1 : 1, column(map, k)));
        int turned = negative ^ mirrors(map) ^ (shape->flip_normals != 0);
        lc_vec3 a = column(map, (k + 1) % 3), b = column(map, (k + 2) % 3);
        faces[i] = quad(direct, index, centre, a, b, whole, whole, turned);
    }
}

static lc_body disk_body(const struct direct *direct, int index)
{
    const lc_shape_desc *shape = &direct->desc->shapes[index];
    const lc_affine *map = &shape->to_world;
    lc_vec3 a = column(map, 0), b = column(map, 1);
    int turned = mirrors(map) ^ (shape->flip_normals != 0);
    return lc_body_ellipse(&direct->receiver, column(map, 3), turned ? b : a, turned ? a : b, index);
}

static lc_status ball_body(lc_body *out, const struct direct *direct, int index)
{
    const lc_shape_desc *shape = &direct->desc->shapes[index];
    lc_vec3 axis[3];
    double length[3];
    for (int k = 0; k < 3; ++k) {
        axis[k] = column(&shape->to_world, k);
        length[k] = lc_length(axis[k]);
    }
    for (int k = 0; k < 3; ++k) {
        int next = (k + 1) % 3;
        if (!(fabs(length[k] - length[next]) <= LC_TOUCH * length[k] &&
              fabs(lc_dot(axis[k], axis[next])) <= LC_TOUCH * length[k] * length[next]))
            return lc_fail(direct->err, LC_BAD_INPUT, "%s:%d: sphere under a map that is no similarity, expected one",
                           direct->desc->name, shape->line);
    }
    *out = lc_body_ball(&direct->receiver, column(&shape->to_world, 3), length[0], index);
    return LC_OK;
}

static void add_body(struct direct *direct, const lc_body *body)
{
    if (lc_body_is_above(body))
        direct->bodies[direct->count++] = *body;
}

/* All that can hide something. Of a cube seen from outside, the faces turned to the receiver hide what the others
 * do. */
static lc_status gather_bodies(struct direct *direct)
{
    static const double whole[2] = {-1, 1};
    for (int i = 0; i < direct->desc->shape_count; ++i) {
        const lc_shape_desc *shape = &direct->desc->shapes[i];
        const lc_affine *map = &shape->to_world;
        lc_body body[FACES];
        lc_status status;
        int outside = 0;
        switch (shape->kind) {
        case LC_RECTANGLE:
            body[0] = quad(direct, i, column(map, 3), column(map, 0), column(map, 1), whole, whole, 0);
            add_body(direct, &body[0]);
            break;
        case LC_DISK:
            body[0] = disk_body(direct, i);
            add_body(direct, &body[0]);
            break;
        case LC_CUBE:
            cube_faces(direct, i, body);
            for (int k = 0; k < FACES; ++k)
                outside |= (shape->flip_normals ? -1 : 1) * lc_body_height(&body[k]) > 0;
            for (int k = 0; k < FACES; ++k)
                if (!outside || (shape->flip_normals ? -1 : 1) * lc_body_height(&body[k]) > 0)
                    add_body(direct, &body[k]);
            break;
        case LC_SPHERE:
            if ((status = ball_body(&body[0], direct, i)) != LC_OK)
                return status;
            add_body(direct, &body[0]);
            break;
        }
    }
    return LC_OK;
}

/* ---- lamps ------------------------------------------------------------------------------------------------------ */

static int is_black(lc_rgb c) { return !(c.r != 0 || c.g != 0 || c.b != 0); }

static lc_status factor_alone(double *factor, const struct direct *direct, const lc_body *lamp)
{
    const lc_vec3 origin = {0, 0, 0}, up = {0, 0, 1};
    *factor = 1;
    if (lamp->kind == LC_BODY_POLYGON)
        *factor = lc_polygon_factor_above(lamp->v, lamp->count, up);
    else if (lamp->kind == LC_BODY_ELLIPSE)
        return lc_scan_factor(factor, lamp, NULL, 0, direct->err);
    else if (lamp->kind == LC_BODY_BALL && lc_body_side(lamp) > 0)
        *factor = lc_sphere_factor(lamp->v[0], lamp->radius, origin, up);
    else if (lamp->kind == LC_BODY_BALL && lc_body_side(lamp) == 0)
        *factor = (1 + lamp->v[0].z / lc_length(lamp->v[0])) / 2;
    return LC_OK;
}

/* Adds what is visible of a lamp that the receiver sees from its emitting side. */
static lc_status add_lamp(struct direct *direct, const lc_body *lamp, lc_rgb radiance)
{
    int count = 0, flat = lamp->kind == LC_BODY_POLYGON;
    for (int i = 0; i < direct->count; ++i) {
        if (!lc_body_may_hide(&direct->bodies[i], lamp))
            continue;
        direct->hiders[count++] = &direct->bodies[i];
        flat = flat && direct->bodies[i].kind == LC_BODY_POLYGON;
    }
    double factor = 0;
    lc_status status;
    if (!count)
        status = factor_alone(&factor, direct, lamp);
    else if (flat)
        status = lc_clip_factor(&factor, lamp, direct->hiders, count, direct->err);
    else
        status = lc_scan_factor(&factor, lamp, direct->hiders, count, direct->err);
    direct->sum = lc_rgb_add(direct->sum, lc_rgb_scale(LC_PI * factor, radiance));
    return status;
}

static lc_status add_flat(struct direct *direct, const lc_body *lamp, lc_rgb radiance)
{
    if (!(lc_body_height(lamp) > 0) || is_black(radiance))
        return LC_OK;
    return add_lamp(direct, lamp, radiance);
}

static lc_status refuse_texture(const struct direct *direct, const lc_shape_desc *shape, const char *what)
{
    return lc_fail(direct->err, LC_BAD_INPUT,
                   "%s:%d: no closed form for a checkerboard lamp on a %s, expected constant radiance",
                   direct->desc->name, shape->line, what);
}

static lc_status add_rectangle(struct direct *direct, int index)
{
    const lc_shape_desc *shape = &direct->desc->shapes[index];
    const lc_affine *map = &shape->to_world;
    const lc_texture *texture = &shape->radiance;
    const double *scale = texture->scale, *offset = texture->offset;
    int turned = mirrors(map) ^ (shape->flip_normals != 0);
    double columns = 1, rows = 1;
    if (texture->is_checkerboard) {
        columns = lc_checker_cells(scale[0], offset[0]);
        rows = lc_checker_cells(scale[1], offset[1]);
    }
    if (!(columns * rows <= MAX_CELLS))
        return lc_fail(direct->err, LC_BAD_INPUT, "%s:%d: checkerboard lamp of %g cells, expected at most %d",
                       direct->desc->name, shape->line, columns * rows, MAX_CELLS);
    for (double j = 0; j < rows; ++j)
        for (double i = 0; i < columns; ++i) {
            double s[2] = {0, 1}, t[2] = {0, 1};
            int second = 0;
            if (texture->is_checkerboard) {
                second = lc_checker_cell(scale[0], offset[0], i, &s[0], &s[1]);
                second ^= lc_checker_cell(scale[1], offset[1], j, &t[0], &t[1]);
            }
            for (int k = 0; k < 2; ++k)
                s[k] = 2 * s[k] - 1, t[k] = 2 * t[k] - 1; /* u = (x + 1) / 2 */
            lc_body lamp = quad(direct, index, column(map, 3), column(map, 0), column(map, 1), s, t, turned);
            lc_status status = add_flat(direct, &lamp, texture->color[second]);
            if (status)
                return status;
        }
    return LC_OK;
}

static lc_status add_cube(struct direct *direct, int index)
{
    const lc_shape_desc *shape = &direct->desc->shapes[index];
    lc_body faces[FACES];
    cube_faces(direct, index, faces);
    if (shape->flip_normals) /* from outside, the walls hide the light within */
        for (int i = 0; i < FACES; ++i)
            if (lc_body_height(&faces[i]) < 0)
                return LC_OK;
    for (int i = 0; i < FACES; ++i) {
        if (shape->radiance.is_checkerboard && lc_body_height(&faces[i]) > 0 && lc_body_is_above(&faces[i]))
            return refuse_texture(direct, shape, "cube");
        lc_status status = add_flat(direct, &faces[i], shape->radiance.color[0]);
        if (status)
            return status;
    }
    return LC_OK;
}

static lc_status add_disk(struct direct *direct, int index)
{
    const lc_shape_desc *shape = &direct->desc->shapes[index];
    lc_body lamp = disk_body(direct, index);
    if (shape->radiance.is_checkerboard && lc_body_height(&lamp) > 0 && lc_body_is_above(&lamp))
        return refuse_texture(direct, shape, "disk");
    return add_flat(direct, &lamp, shape->radiance.color[0]);
}

static lc_status add_sphere(struct direct *direct, int index)
{
    const lc_shape_desc *shape = &direct->desc->shapes[index];
    lc_body lamp;
    lc_status status = ball_body(&lamp, direct, index);
    if (status)
        return status;
    int side = lc_body_side(&lamp);
    if ((shape->flip_normals ? side > 0 : side <= 0) || !lc_body_is_above(&lamp))
        return LC_OK;
    if (!shape->radiance.is_checkerboard)
        return is_black(shape->radiance.color[0]) ? LC_OK : add_lamp(direct, &lamp, shape->radiance.color[0]);
    /* on the inner wall, facing the centre, every part of the sphere counts alike */
    int inner = side == 0 && lamp.v[0].z > lamp.radius * (1 - LC_TOUCH);
    for (int i = 0; i < direct->count; ++i)
        inner = inner && !lc_body_may_hide(&direct->bodies[i], &lamp);
    if (!inner)
        return refuse_texture(direct, shape, "sphere, unless seen from its own empty inner wall");
    return add_lamp(direct, &lamp, lc_texture_sphere_mean(&shape->radiance));
}

static lc_status add_shapes(struct direct *direct)
{
    for (int i = 0; i < direct->desc->shape_count; ++i) {
        lc_status status = LC_OK;
        if (!direct->desc->shapes[i].emits)
            continue;
        switch (direct->desc->shapes[i].kind) {
        case LC_RECTANGLE:
            status = add_rectangle(direct, i);
            break;
        case LC_DISK:
            status = add_disk(direct, i);
            break;
        case LC_CUBE:
            status = add_cube(direct, i);
            break;
        case LC_SPHERE:
            status = add_sphere(direct, i);
            break;
        }
        if (status)
            return status;
    }
    return LC_OK;
}

static int is_hidden(const struct direct *direct, lc_vec3 target)
{
    for (int i = 0; i < direct->count; ++i)
        if (lc_body_hides_point(&direct->bodies[i], target))
            return 1;
    return 0;
}

/* Points and directional lights, which have no area. */
static void add_deltas(struct direct *direct)
{
    const lc_scene_desc *desc = direct->desc;
    const lc_receiver *receiver = &direct->receiver;
    for (int i = 0; i < desc->point_count; ++i) {
        double e = lc_point_irradiance(1, desc->points[i].position, receiver->p, receiver->n);
        if (e > 0 && !is_hidden(direct, lc_receiver_point(receiver, desc->points[i].position)))
            direct->sum = lc_rgb_add(direct->sum, lc_rgb_scale(e, desc->points[i].intensity));
    }
    for (int i = 0; i < desc->directional_count; ++i) {
        double e = lc_directional_irradiance(1, desc->directionals[i].direction, receiver->n);
        double far = 1;
        for (int k = 0; k < direct->count; ++k)
            far = fmax(far, 2 * (lc_length(direct->bodies[k].middle) + direct->bodies[k].reach));
        lc_vec3 back = lc_receiver_vector(receiver, lc_neg(desc->directionals[i].direction));
        if (e > 0 && !is_hidden(direct, lc_scale(far, back)))
            direct->sum = lc_rgb_add(direct->sum, lc_rgb_scale(e, desc->directionals[i].irradiance));
    }
}

/* ---- the two questions ---------------------------------------------------------------------------------------- */

static lc_status direct_sum(lc_rgb *out, const lc_scene_desc *desc, lc_vec3 p, lc_vec3 n, int with_hiders,
                            lc_error *err)
{
    for (int i = 0; i < desc->shape_count; ++i)
        if (lc_length(desc->shapes[i].motion) > 0)
            return lc_fail(err, LC_BAD_INPUT, "%s:%d: the shape moves, expected all at rest", desc->name,
                           desc->shapes[i].line);
    struct direct direct = {desc, lc_receiver_at(p, n), NULL, NULL, 0, {0, 0, 0}, err};
    lc_status status = LC_OK;
    lc_body sky = lc_body_sky();
    size_t room = (size_t)desc->shape_count * FACES + 1;
    if (with_hiders) {
        direct.bodies = malloc(room * sizeof *direct.bodies);
        direct.hiders = malloc(room * sizeof *direct.hiders);
        if (!direct.bodies || !direct.hiders)
            status = lc_fail(err, LC_FAULT, "direct light: out of memory");
        else
            status = gather_bodies(&direct);
        if (status)
            goto cleanup;
    }
    status = add_shapes(&direct);
    if (status)
        goto cleanup;
    add_deltas(&direct);
    if (desc->has_sky && !is_black(desc->sky))
        status = add_lamp(&direct, &sky, desc->sky);
    *out = direct.sum;
cleanup:
    free(direct.hiders);
    free(direct.bodies);
    return status;
}

lc_status lc_direct_irradiance(lc_rgb *out, const lc_scene_desc *desc, lc_vec3 p, lc_vec3 n, lc_error *err)
{
    return direct_sum(out, desc, p, n, 1, err);
}

lc_status lc_direct_unoccluded(lc_rgb *out, const lc_scene_desc *desc, lc_vec3 p, lc_vec3 n, lc_error *err)
{
    return direct_sum(out, desc, p, n, 0, err);
}
