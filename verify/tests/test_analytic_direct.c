/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Direct light of whole descriptions: every emitter in every pose, and what hides it. */
#include "verify/tests/tests.h"

#include <stdlib.h>
#include <string.h>

#include "io/scene_read.h"
#include "verify/analytic/analytic.h"
#include "verify/analytic/body.h"
#include "verify/checks/checks.h"
#include "verify/grade/assignment.h"
#include "verify/judge/judge.h"
#include "verify/tests/analytic_help.h"

enum { ROOM = 16 };

/* A description whose arrays live here. */
struct scene {
    lc_scene_desc desc;
    lc_shape_desc shapes[ROOM];
    lc_point_desc point;
    lc_directional_desc directional;
};

static struct scene *scene_new(void)
{
    struct scene *s = calloc(1, sizeof *s);
    ck_assert_ptr_nonnull(s);
    s->desc.shapes = s->shapes;
    s->desc.points = &s->point;
    s->desc.directionals = &s->directional;
    strcpy(s->desc.name, "test");
    return s;
}

/* Columns x, y, z and the centre; radiance 0: no lamp. */
static lc_shape_desc *add(struct scene *s, lc_shape_kind kind, lc_vec3 x, lc_vec3 y, lc_vec3 z, lc_vec3 o,
                          double radiance)
{
    const lc_affine map = {{{x.x, y.x, z.x, o.x}, {x.y, y.y, z.y, o.y}, {x.z, y.z, z.z, o.z}}};
    lc_shape_desc *shape = &s->shapes[s->desc.shape_count++];
    ck_assert_int_le(s->desc.shape_count, ROOM);
    shape->kind = kind;
    shape->to_world = map;
    shape->emits = radiance != 0;
    shape->radiance.color[0] = lc_color(radiance, radiance / 2, 0);
    shape->line = s->desc.shape_count;
    return shape;
}

static lc_shape_desc *add_scaled(struct scene *s, lc_shape_kind kind, lc_vec3 scale, lc_vec3 o, double radiance)
{
    return add(s, kind, lc_vec(scale.x, 0, 0), lc_vec(0, scale.y, 0), lc_vec(0, 0, scale.z), o, radiance);
}

/* Red of the direct light; green must be half of it, blue none. */
static double direct(const struct scene *s, lc_vec3 p, lc_vec3 n)
{
    lc_rgb e;
    lc_error err = {""};
    ck_assert_msg(lc_direct_irradiance(&e, &s->desc, p, n, &err) == LC_OK, "%s", err.text);
    ck_assert_double_le(fabs(e.g - e.r / 2), 1e-15 * e.r);
    ck_assert(e.b == 0);
    return e.r;
}

static double unoccluded(const struct scene *s, lc_vec3 p, lc_vec3 n)
{
    lc_rgb e;
    ck_assert_int_eq(lc_direct_unoccluded(&e, &s->desc, p, n, NULL), LC_OK);
    return e.r;
}

static const lc_vec3 up = {0, 0, 1}, foot = {0, 0, 0};

/* ---- lamps in every pose ---------------------------------------------------------------------------------- */

START_TEST(rectangle_emits_on_the_side_of_its_normal)
{
    /* 2 x 1 at height 3, as is: it shines up; the factor of a corner form, four times */
    double f = 4 * lc_rectangle_factor(1, 0.5, 3);
    for (int flip = 0; flip < 2; ++flip)
        for (int mirror = 0; mirror < 4; ++mirror) {
            struct scene *s = scene_new();
            lc_vec3 scale = {mirror & 1 ? -1 : 1, 0.5, mirror & 2 ? -1 : 1};
            add_scaled(s, LC_RECTANGLE, scale, lc_vec(0, 0, 3), 2)->flip_normals = flip;
            /* normals go with the inverse transpose: only a mirrored z turns the normal */
            int down = flip ^ (mirror >> 1);
            ASSERT_CLOSE(1 + direct(s, foot, up), 1 + (down ? 2 * LC_PI * f : 0), 1e-13);
            ASSERT_CLOSE(1 + direct(s, lc_vec(0, 0, 6), lc_vec(0, 0, -1)), 1 + (down ? 0 : 2 * LC_PI * f), 1e-13);
            free(s);
        }
}
END_TEST

START_TEST(rectangle_under_any_affine_map)
{
    unsigned state = 11;
    int seen = 0;
    for (int i = 0; i < 200; ++i) {
        struct scene *s = scene_new();
        lc_vec3 a = direction(&state), b = direction(&state), c = direction(&state), o = lc_scale(2, direction(&state));
        lc_vec3 n = direction(&state);
        add(s, LC_RECTANGLE, a, b, c, o, 1);
        /* the side where local z is: order the corners by hand */
        lc_vec3 normal = lc_cross(a, b);
        int same = lc_dot(normal, c) > 0;
        lc_vec3 corner[4];
        parallelogram_about(corner, o, same ? a : b, same ? b : a);
        double f = lc_polygon_factor(corner, 4, foot, n);
        ck_assert_double_le(fabs(direct(s, foot, n) - LC_PI * f), 1e-13);
        ck_assert(unoccluded(s, foot, n) == direct(s, foot, n));
        seen += f > 0;
        free(s);
    }
    ck_assert_int_gt(seen, 50);
}
END_TEST

START_TEST(cube_is_its_visible_faces)
{
    struct scene *s = scene_new();
    add_scaled(s, LC_CUBE, lc_vec(1, 1, 0.5), lc_vec(0, 0, 3), 2);
    ASSERT_CLOSE(direct(s, foot, up), 2 * LC_PI * 4 * lc_rectangle_factor(1, 1, 2.5), 1e-13);
    /* from aside: bottom and two walls */
    lc_vec3 p = {4, 3, 0};
    const lc_vec3 bottom[4] = {{-1, -1, 2.5}, {-1, 1, 2.5}, {1, 1, 2.5}, {1, -1, 2.5}};
    const lc_vec3 right[4] = {{1, -1, 2.5}, {1, 1, 2.5}, {1, 1, 3.5}, {1, -1, 3.5}};
    const lc_vec3 back[4] = {{1, 1, 2.5}, {-1, 1, 2.5}, {-1, 1, 3.5}, {1, 1, 3.5}};
    double aside = lc_polygon_factor(back, 4, p, up);
    double f = lc_polygon_factor(bottom, 4, p, up) + lc_polygon_factor(right, 4, p, up) + aside;
    ck_assert_double_gt(aside, 0.001);
    ASSERT_CLOSE(direct(s, p, up), 2 * LC_PI * f, 1e-13);
    /* a mirrored cube is the same cube */
    s->shapes[0].to_world.m[0][0] = -1;
    ASSERT_CLOSE(direct(s, p, up), 2 * LC_PI * f, 1e-13);
    /* it emits outwards only; with flipped normals inwards only */
    ck_assert(direct(s, lc_vec(0, 0, 3), up) == 0);
    s->shapes[0].flip_normals = 1;
    ck_assert(direct(s, p, up) == 0);
    ASSERT_CLOSE(direct(s, lc_vec(0.1, 0.2, 3), up), 2 * LC_PI, 1e-13);
    /* from its own wall, facing in, all the hemisphere is lit by the other faces */
    ASSERT_CLOSE(direct(s, lc_vec(0.1, 0.2, 2.5), up), 2 * LC_PI, 1e-13);
    free(s);
}
END_TEST

START_TEST(disk_and_sphere)
{
    struct scene *s = scene_new();
    add_scaled(s, LC_DISK, lc_vec(0.7, 0.7, 1), lc_vec(0.5, 0, 2), 3)->flip_normals = 1;
    ASSERT_CLOSE(direct(s, foot, up), 3 * LC_PI * lc_disk_factor(0.7, 0.5, 2), 1e-9);
    s->shapes[0].flip_normals = 0;
    ck_assert(direct(s, foot, up) == 0);
    s->shapes[0].to_world.m[2][2] = -1;
    ASSERT_CLOSE(direct(s, foot, up), 3 * LC_PI * lc_disk_factor(0.7, 0.5, 2), 1e-9);
    free(s);

    s = scene_new();
    lc_vec3 centre = {1, 0.2, 0.3};
    add_scaled(s, LC_SPHERE, lc_vec(0.5, 0.5, 0.5), centre, 4);
    ASSERT_CLOSE(direct(s, foot, up), 4 * LC_PI * lc_sphere_factor(centre, 0.5, foot, up), 1e-12);
    ck_assert(direct(s, centre, up) == 0);
    s->shapes[0].flip_normals = 1;
    ck_assert(direct(s, foot, up) == 0);
    ASSERT_CLOSE(direct(s, centre, up), 4 * LC_PI, 1e-13);
    ASSERT_CLOSE(direct(s, lc_vec(1, 0.2, -0.2), up), 4 * LC_PI, 1e-13);
    /* the flagship: any pattern, seen from the wall */
    lc_texture board = {1, {{2, 1, 0}, {6, 3, 0}}, {3, 2}, {0.1, 0.3}};
    s->shapes[0].radiance = board;
    double first = lc_inside_sphere_irradiance(lc_texture_sphere_mean(&board).r, 0.4, 1);
    ASSERT_CLOSE(direct(s, lc_vec(1, 0.2, -0.2), up), first, 1e-13);
    lc_rgb e;
    ck_assert_int_eq(lc_direct_irradiance(&e, &s->desc, centre, up, NULL), LC_BAD_INPUT);
    lc_vec3 wall = {1, 0.2, -0.2}, tilted = {0.6, 0, 0.8};
    ck_assert_int_eq(lc_direct_irradiance(&e, &s->desc, wall, tilted, NULL), LC_BAD_INPUT);
    add_scaled(s, LC_SPHERE, lc_vec(0.1, 0.1, 0.1), centre, 0);
    ck_assert_int_eq(lc_direct_irradiance(&e, &s->desc, wall, up, NULL), LC_BAD_INPUT);
    /* one colour, a tilted receiver on the wall, a ball inside */
    s->shapes[0].radiance.is_checkerboard = 0;
    s->shapes[0].radiance.color[0] = lc_color(4, 2, 0);
    double seen = (1 + 0.8) / 2 - lc_sphere_factor(centre, 0.1, wall, tilted);
    ASSERT_CLOSE(direct(s, wall, tilted), 4 * LC_PI * seen, 1e-10);
    free(s);
}
END_TEST

START_TEST(points_directions_and_sky)
{
    struct scene *s = scene_new();
    s->desc.point_count = s->desc.directional_count = 1;
    s->point.position = lc_vec(3, 0, 4);
    s->point.intensity = lc_color(50, 25, 0);
    s->directional.direction = lc_vec(0.6, 0, -0.8);
    s->directional.irradiance = lc_color(2, 1, 0);
    s->desc.has_sky = 1;
    s->desc.sky = lc_color(4, 2, 0);
    double expected = 50 * 0.8 / 25 + 1.6 + 4 * LC_PI;
    ASSERT_CLOSE(direct(s, foot, up), expected, 1e-14);
    /* a floor that p stands on hides nothing; p on a ball sees all of its hemisphere */
    add_scaled(s, LC_RECTANGLE, lc_vec(9, 9, 1), foot, 0);
    add_scaled(s, LC_SPHERE, lc_vec(2, 2, 2), lc_vec(0, 0, -2), 0);
    ASSERT_CLOSE(direct(s, foot, up), expected, 1e-14);
    /* a ball in the way of the point only, then of the directional light only; the sky loses its factor */
    add_scaled(s, LC_SPHERE, lc_vec(0.1, 0.1, 0.1), lc_vec(1.5, 0, 2), 0);
    double f = lc_sphere_factor(lc_vec(1.5, 0, 2), 0.1, foot, up);
    ASSERT_CLOSE(direct(s, foot, up), 1.6 + 4 * LC_PI * (1 - f), 1e-9);
    ASSERT_CLOSE(unoccluded(s, foot, up), expected, 1e-14);
    s->shapes[2].to_world.m[0][3] = -1.5;
    ASSERT_CLOSE(direct(s, foot, up), 50 * 0.8 / 25 + 4 * LC_PI * (1 - f), 1e-9);
    /* behind the point it hides no point */
    s->shapes[2].to_world.m[0][3] = 6, s->shapes[2].to_world.m[2][3] = 8;
    ck_assert_double_gt(direct(s, foot, up), 50 * 0.8 / 25 + 1.6 + 4 * LC_PI * 0.999);
    /* in a box there is no sky; nor when the box is a ball */
    add_scaled(s, LC_CUBE, lc_vec(20, 20, 20), lc_vec(0, 0, 20), 0);
    ASSERT_CLOSE(direct(s, foot, up), 50 * 0.8 / 25, 1e-9);
    s->shapes[3].kind = LC_SPHERE;
    ASSERT_CLOSE(direct(s, foot, up), 50 * 0.8 / 25, 1e-9);
    free(s);
}
END_TEST

START_TEST(checkerboard_rectangle)
{
    struct scene *s = scene_new();
    lc_shape_desc *lamp = add_scaled(s, LC_RECTANGLE, lc_vec(1, 0.8, 1), lc_vec(0.3, 0, 1.5), 3);
    lamp->flip_normals = 1;
    double whole = direct(s, foot, up);
    /* one colour in both: the same lamp, however it is cut */
    lc_texture board = {1, {{3, 1.5, 0}, {3, 1.5, 0}}, {3.3, -2.7}, {0.21, 4.4}};
    lamp->radiance = board;
    ASSERT_CLOSE(direct(s, foot, up), whole, 1e-13);
    /* two colours: midpoints over the lamp, the rule of the texture written a second time, u = (x + 1) / 2 */
    lamp->radiance.color[1] = lc_color(1, 0.5, 0);
    enum { M = 1000 };
    double sum = 0;
    for (int i = 0; i < M; ++i)
        for (int j = 0; j < M; ++j) {
            double u = (i + 0.5) / M, v = (j + 0.5) / M, a = 3.3 * u + 0.21, b = -2.7 * v + 4.4;
            lc_vec3 x = {0.3 + 2 * u - 1, 0.8 * (2 * v - 1), 1.5};
            double d2 = lc_dot(x, x), radiance = (a - floor(a) > 0.5) == (b - floor(b) > 0.5) ? 3 : 1;
            sum += radiance * x.z * x.z / (d2 * d2) * 4 * 0.8 / (M * (double)M);
        }
    ASSERT_CLOSE(direct(s, foot, up), sum, 2e-4);
    free(s);
}
END_TEST

START_TEST(refusals_name_the_place)
{
    struct scene *s = scene_new();
    lc_error err;
    lc_rgb e;
    lc_shape_desc *lamp = add_scaled(s, LC_DISK, lc_vec(1, 1, -1), lc_vec(0, 0, 2), 1);
    lamp->radiance.is_checkerboard = 1;
    ck_assert_int_eq(lc_direct_irradiance(&e, &s->desc, foot, up, &err), LC_BAD_INPUT);
    ck_assert_ptr_nonnull(strstr(err.text, "test:1: "));
    lamp->kind = LC_CUBE;
    ck_assert_int_eq(lc_direct_irradiance(&e, &s->desc, foot, up, &err), LC_BAD_INPUT);
    lamp->kind = LC_RECTANGLE;
    lamp->radiance.scale[0] = lamp->radiance.scale[1] = 1e4;
    ck_assert_int_eq(lc_direct_irradiance(&e, &s->desc, foot, up, &err), LC_BAD_INPUT);
    lamp->kind = LC_SPHERE;
    lamp->radiance.is_checkerboard = 0;
    ck_assert_int_eq(lc_direct_irradiance(&e, &s->desc, foot, up, &err), LC_OK);
    lamp->to_world.m[0][0] = 1.01;
    ck_assert_int_eq(lc_direct_irradiance(&e, &s->desc, foot, up, &err), LC_BAD_INPUT);
    free(s);
}
END_TEST

START_TEST(flat_shapes_hide_points)
{
    /* a light right above the foot, and between them the corner (-1, -1) of a parallelogram, or the rim of an ellipse
     * through the same corner: a little larger it hides, a little smaller it does not */
    const lc_shape_kind kinds[] = {LC_RECTANGLE, LC_DISK, LC_CUBE};
    for (int k = 0; k < 3; ++k)
        for (int flip = 0; flip < 2; ++flip)
            for (int hit = 0; hit < 2; ++hit) {
                struct scene *s = scene_new();
                s->desc.point_count = 1;
                s->point.position = lc_vec(0, 0, 2);
                s->point.intensity = lc_color(8, 4, 0);
                double reach = (hit ? 1.01 : 0.99) * (kinds[k] == LC_DISK ? sqrt(2.0) : 1);
                lc_vec3 a = lc_scale(reach, lc_vec(0.5, 0, 0)), b = lc_scale(reach, lc_vec(0.1, 0.2, 0.05));
                lc_vec3 o = {0.6, 0.2, 1}, z = {0, 0, 0.01};
                lc_shape_desc *shape = add(s, kinds[k], a, b, z, o, 0);
                shape->flip_normals = flip;
                if (flip) /* and turned by hand as well: no side lets light through */
                    shape->to_world.m[2][2] = -0.01;
                ASSERT_CLOSE(1 + direct(s, foot, up), 1 + (hit ? 0 : 2), 1e-14);
                free(s);
            }
}
END_TEST

/* ---- what hides ------------------------------------------------------------------------------------------------ */

START_TEST(plates_hide_exactly)
{
    struct scene *s = scene_new();
    lc_shape_desc *lamp = add_scaled(s, LC_RECTANGLE, lc_vec(1, 1, -1), lc_vec(0, 0, 2), 1);
    double whole = direct(s, foot, up), half = LC_PI * 2 * lc_rectangle_factor(1, 1, 2);
    ASSERT_CLOSE(whole, 2 * half, 1e-13);
    /* a plate at half height over x > 0, whichever way it faces; a mirrored one as well */
    lc_shape_desc *plate = add_scaled(s, LC_RECTANGLE, lc_vec(5, 5, 1), lc_vec(5, 0, 1), 0);
    ASSERT_CLOSE(direct(s, foot, up), half, 1e-12);
    plate->to_world.m[0][0] = -5;
    ASSERT_CLOSE(direct(s, foot, up), half, 1e-12);
    /* over everything; behind the lamp; in the lamp's plane */
    plate->to_world.m[0][3] = 0;
    ck_assert_double_le(direct(s, foot, up), 1e-14);
    plate->to_world.m[2][3] = 2.001;
    ASSERT_CLOSE(direct(s, foot, up), whole, 1e-13);
    plate->to_world.m[2][3] = 2;
    ASSERT_CLOSE(direct(s, foot, up), whole, 1e-13);
    /* a hole-like plate in the middle: its shadow on the lamp is twice as large */
    *plate = *lamp;
    plate->emits = 0;
    plate->to_world.m[0][0] = plate->to_world.m[1][1] = 0.25;
    plate->to_world.m[2][3] = 1;
    ASSERT_CLOSE(direct(s, foot, up), whole - LC_PI * 4 * lc_rectangle_factor(0.25, 0.25, 1), 1e-12);
    /* a plate that cuts through the lamp's plane hides by its lower half */
    struct scene *t = scene_new();
    add_scaled(t, LC_RECTANGLE, lc_vec(1, 1, -1), lc_vec(0, 0, 2), 1);
    add(t, LC_RECTANGLE, lc_vec(0, 5, 0), lc_vec(0, 0, 0.5), lc_vec(1, 0, 0), lc_vec(0.25, 0, 2), 0);
    /* from x = 0: lower edge at (.25, 1.5) throws its shadow to x = 1/3 on the lamp */
    double lit = whole / 2 + LC_PI * 2 * lc_rectangle_factor(0.25, 1, 2);
    double beyond = LC_PI * 2 * (lc_rectangle_factor(1, 1, 2) - lc_rectangle_factor(1.0 / 3, 1, 2));
    ASSERT_CLOSE(direct(t, foot, up), lit + beyond, 1e-10); /* touching counts as beyond: a margin of 1e-11 */
    free(t);
    free(s);
}
END_TEST

START_TEST(balls_hide_exactly)
{
    /* the shadow wholly within the lamp: lamp minus ball */
    lc_vec3 centre = {0.2, 0.1, 1};
    double ball = LC_PI * lc_sphere_factor(centre, 0.2, foot, up);
    const lc_shape_kind kinds[] = {LC_RECTANGLE, LC_DISK, LC_CUBE};
    for (int k = 0; k < 3; ++k) {
        struct scene *s = scene_new();
        add_scaled(s, kinds[k], lc_vec(3, 3, -1), lc_vec(0, 0, 4), 1);
        double whole = direct(s, foot, up);
        add_scaled(s, LC_SPHERE, lc_vec(0.2, 0.2, 0.2), centre, 0);
        ASSERT_CLOSE(direct(s, foot, up), whole - ball, 1e-9);
        ASSERT_CLOSE(unoccluded(s, foot, up), whole, 1e-13);
        /* the same with a disk in the ball's place: its rim is seen as itself */
        s->shapes[1].kind = LC_DISK;
        ASSERT_CLOSE(direct(s, foot, up), whole - LC_PI * lc_disk_factor(0.2, hypot(0.2, 0.1), 1), 1e-9);
        free(s);
    }
    /* a sphere lamp cut in half by a wall through p's axis, and hidden by a larger ball */
    struct scene *s = scene_new();
    add_scaled(s, LC_SPHERE, lc_vec(1, 1, 1), lc_vec(0, 0, 5), 1);
    lc_shape_desc *plate = add_scaled(s, LC_RECTANGLE, lc_vec(4, 4, 1), lc_vec(4, 0, 2), 0);
    ASSERT_CLOSE(direct(s, foot, up), LC_PI / 50, 1e-9);
    plate->kind = LC_SPHERE;
    plate->to_world.m[0][3] = 0;
    for (int i = 0; i < 3; ++i)
        plate->to_world.m[i][i] = 0.5;
    ck_assert_double_le(direct(s, foot, up), 1e-12);
    /* a ball behind the lamp hides nothing, a lamp inside a big ball is lit within */
    plate->to_world.m[2][3] = 7;
    ASSERT_CLOSE(direct(s, foot, up), LC_PI / 25, 1e-9);
    plate->to_world.m[2][3] = 9;
    for (int i = 0; i < 3; ++i)
        plate->to_world.m[i][i] = 10;
    ASSERT_CLOSE(direct(s, foot, up), LC_PI / 25, 1e-9);
    ck_assert_double_le(direct(s, lc_vec(0, 0, -2), up), 1e-12);
    /* from within a ball one sees no lamp outside */
    plate->to_world.m[2][3] = 0;
    for (int i = 0; i < 3; ++i)
        plate->to_world.m[i][i] = 1;
    ck_assert_double_le(direct(s, foot, up), 1e-12);
    free(s);
}
END_TEST

/* Random flat lamps behind random boxes and plates: clipping and scan are two methods with nothing in common. */
START_TEST(clip_and_scan_agree)
{
    unsigned state = 5;
    int partial = 0;
    for (int i = 0; i < 150; ++i) {
        lc_receiver receiver = lc_receiver_at(foot, up);
        lc_vec3 a = direction(&state), b = lc_cross(a, direction(&state)), o = lc_vec(0, 0, 4);
        lc_vec3 q[4];
        parallelogram_about(q, o, a, b);
        lc_body lamp = lc_body_polygon(&receiver, q, 4, 0), hider[3];
        const lc_body *list[3];
        for (int k = 0; k < 3; ++k) {
            lc_vec3 c = lc_add(lc_vec(0, 0, 1.5), lc_scale(0.6, direction(&state)));
            lc_vec3 e = lc_scale(0.5, direction(&state)), f = lc_scale(0.4, direction(&state));
            parallelogram_about(q, c, e, f);
            hider[k] = lc_body_polygon(&receiver, q, 4, k + 1);
            list[k] = &hider[k];
        }
        double clipped, scanned, whole = lc_polygon_factor_above(lamp.v, lamp.count, up);
        if (lamp.offset > 0) /* Lambert's sum is signed: turn the lamp */
            continue;
        ck_assert_int_eq(lc_clip_factor(&clipped, &lamp, list, 3, NULL), LC_OK);
        ck_assert_int_eq(lc_scan_factor(&scanned, &lamp, list, 3, NULL), LC_OK);
        ck_assert_msg(fabs(clipped - scanned) <= 1e-11 * whole, "case %d: clipped %.15g, scanned %.15g of %.15g", i,
                      clipped, scanned, whole);
        partial += clipped > 0.01 * whole && clipped < 0.99 * whole;
    }
    ck_assert_int_gt(partial, 20);
}
END_TEST

/* Two plates that leave a gap of a few thousandths of the lamp: a quadrature that trusts its samples never sees it. */
START_TEST(narrow_gaps_are_found)
{
    unsigned state = 21;
    int open = 0;
    for (int i = 0; i < 300; ++i) {
        lc_vec3 normal = {uniform(&state) - 0.5, uniform(&state) - 0.5, 1};
        lc_receiver receiver = lc_receiver_at(foot, lc_normalize(normal));
        lc_vec3 q[4], turn = direction(&state);
        lc_body body[3];
        parallelogram_about(q, lc_vec(0, 0, 4), lc_vec(0, 1, 0), lc_vec(1, 0, 0));
        body[0] = lc_body_polygon(&receiver, q, 4, 0);
        for (int k = 0; k < 2; ++k) {
            /* edges that run along `edge`, tilted a little, on opposite sides */
            double angle = 2 * LC_PI * turn.x + (i % 2 ? 0.01 : 0.1) * uniform(&state), side = k ? 1 : -1;
            lc_vec3 edge = {cos(angle), sin(angle), 0}, out = {-sin(angle), cos(angle), 0};
            double apart = 1 + (i % 2 ? 0.0005 : 0.02) * uniform(&state);
            lc_vec3 middle = lc_add(lc_scale(side * apart, out), lc_vec(0, 0, 2 + 0.1 * k));
            parallelogram_about(q, middle, lc_scale(3, edge), out);
            body[k + 1] = lc_body_polygon(&receiver, q, 4, k + 1);
        }
        const lc_body *list[2] = {&body[1], &body[2]};
        double clipped, scanned, whole = lc_polygon_factor_above(body[0].v, body[0].count, up);
        ck_assert_int_eq(lc_clip_factor(&clipped, &body[0], list, 2, NULL), LC_OK);
        ck_assert_int_eq(lc_scan_factor(&scanned, &body[0], list, 2, NULL), LC_OK);
        ck_assert_msg(fabs(clipped - scanned) <= 1e-11 * whole, "case %d: clipped %.15g, scanned %.15g of %.15g", i,
                      clipped, scanned, whole);
        open += clipped > 0 && clipped < 0.1 * whole;
    }
    ck_assert_int_gt(open, 100);
}
END_TEST

static lc_body any_body(const lc_receiver *receiver, int kind, lc_vec3 c, lc_vec3 a, lc_vec3 b, double radius,
                        int shape)
{
    lc_vec3 q[4];
    parallelogram_about(q, c, a, b);
    return kind == 0   ? lc_body_polygon(receiver, q, 4, shape)
           : kind == 1 ? lc_body_ellipse(receiver, c, a, b, shape)
                       : lc_body_ball(receiver, c, radius, shape);
}

/* Where all is above the horizon, irradiance is linear in the normal: E(n) = n . V. A scan about another normal cuts
 * the same scene into wholly different pieces, so four of them test every kind of lamp, hider and crossing. */
START_TEST(irradiance_is_linear_in_the_normal)
{
    unsigned state = 9;
    int partial = 0;
    for (int i = 0; i < 300; ++i) {
        lc_vec3 n[4] = {{0.1, 0.2, 1}, {-0.2, 0.05, 1}, {0.1, -0.2, 1}, {0, 0, 1}};
        double f[4], alone = 0;
        lc_vec3 c[4], a[4], b[4];
        for (int k = 0; k < 4; ++k) {
            /* three hiders, then the lamp, apart enough not to meet it */
            c[k] = k < 3 ? lc_add(lc_vec(0, 0, 2), lc_scale(0.4, direction(&state))) : lc_vec(0, 0, 4);
            a[k] = lc_scale(k < 3 ? 0.28 : 0.5, direction(&state));
            b[k] = lc_scale(k < 3 ? 0.28 : 0.5, direction(&state));
        }
        for (int j = 0; j < 4; ++j) {
            n[j] = lc_normalize(n[j]);
            lc_receiver receiver = lc_receiver_at(foot, n[j]);
            lc_body body[4];
            for (int k = 0, kinds = i; k < 4; ++k, kinds /= 3)
                body[k] = any_body(&receiver, kinds % 3, c[k], a[k], b[k], k < 3 ? 0.35 : 0.9, k);
            const lc_body *list[3] = {&body[0], &body[1], &body[2]};
            ck_assert_int_eq(lc_scan_factor(&f[j], &body[3], list, 3, NULL), LC_OK);
            ck_assert_int_eq(lc_scan_factor(&alone, &body[3], NULL, 0, NULL), LC_OK);
        }
        double det = lc_dot(n[0], lc_cross(n[1], n[2]));
        double expected = (lc_dot(n[3], lc_cross(n[1], n[2])) * f[0] + lc_dot(n[0], lc_cross(n[3], n[2])) * f[1] +
                           lc_dot(n[0], lc_cross(n[1], n[3])) * f[2]) /
                          det;
        ck_assert_msg(fabs(f[3] - expected) <= 1e-11 * alone, "case %d: %.15g, expected %.15g of %.15g", i, f[3],
                      expected, alone);
        partial += f[3] > 0.01 * alone && f[3] < 0.99 * alone;
    }
    ck_assert_int_gt(partial, 150);
}
END_TEST

/* 1 when the segment from p to x meets the axis-aligned box or the ball: by slabs, by the quadratic. */
static int box_between(lc_vec3 p, lc_vec3 x, lc_vec3 lo, lc_vec3 hi)
{
    const double o[3] = {p.x, p.y, p.z}, d[3] = {x.x - p.x, x.y - p.y, x.z - p.z};
    const double l[3] = {lo.x, lo.y, lo.z}, h[3] = {hi.x, hi.y, hi.z};
    double from = 1e-9, to = 1 - 1e-9;
    for (int k = 0; k < 3; ++k) {
        double a = (l[k] - o[k]) / d[k], b = (h[k] - o[k]) / d[k];
        from = fmax(from, fmin(a, b));
        to = fmin(to, fmax(a, b));
    }
    return from < to;
}

static int ball_between(lc_vec3 p, lc_vec3 x, lc_vec3 c, double r)
{
    lc_vec3 d = lc_sub(x, p), m = lc_sub(p, c);
    double a = lc_dot(d, d), b = lc_dot(m, d), disc = b * b - a * (lc_dot(m, m) - r * r);
    return disc > 0 && -b - sqrt(disc) > 0 && -b - sqrt(disc) < a;
}

START_TEST(room_matches_brute_force)
{
    /* a closed room of unit half-size about (0, 0, 1), a lamp under its ceiling, a box, a ball, a tilted plate as a
     * lamp */
    struct scene *s = scene_new();
    add_scaled(s, LC_CUBE, lc_vec(1, 1, 1), lc_vec(0, 0, 1), 0)->flip_normals = 1;
    add_scaled(s, LC_RECTANGLE, lc_vec(0.4, 0.3, -1), lc_vec(0, 0, 1.98), 5);
    add_scaled(s, LC_CUBE, lc_vec(0.3, 0.2, 0.4), lc_vec(0.4, 0.1, 0.4), 0);
    add_scaled(s, LC_SPHERE, lc_vec(0.3, 0.3, 0.3), lc_vec(-0.35, 0.2, 0.7), 0);
    const lc_vec3 points[] = {{-0.5, -0.2, 0}, {0.05, 0.1, 0},  {-0.2, 0.5, 0},
                              {-0.8, 0.6, 0},  {0.4, 0.1, 0.8}, {0.9, 0.05, 0}};
    int seen = 0;
    for (size_t i = 0; i < sizeof points / sizeof points[0]; ++i) {
        lc_vec3 p = points[i];
        enum { M = 700 };
        double sum = 0, whole = 0;
        for (int a = 0; a < M; ++a)
            for (int b = 0; b < M; ++b) {
                lc_vec3 x = {0.4 * (2 * (a + 0.5) / M - 1), 0.3 * (2 * (b + 0.5) / M - 1), 1.98}, d = lc_sub(x, p);
                double d2 = lc_dot(d, d), e = 5 * d.z * d.z / (d2 * d2) * 0.48 / (M * (double)M);
                whole += e;
                if (!box_between(p, x, lc_vec(0.1, -0.1, 0), lc_vec(0.7, 0.3, 0.8)) &&
                    !ball_between(p, x, lc_vec(-0.35, 0.2, 0.7), 0.3))
                    sum += e;
            }
        double found = direct(s, p, up);
        ck_assert_msg(fabs(found - sum) < 1.5e-3 * whole, "point %d: %.9g, expected about %.9g", (int)i, found, sum);
        ASSERT_CLOSE(unoccluded(s, p, up), whole, 1e-5);
        seen += sum > 0.02 * whole && sum < 0.98 * whole;
    }
    ck_assert_int_ge(seen, 3);
    free(s);
}
END_TEST

START_TEST(scale_and_place_do_not_matter)
{
    /* the same scene a thousand times smaller and larger, and far from the origin */
    double expected = 0;
    for (int i = 0; i < 4; ++i) {
        const double k[] = {1, 1e-3, 1e3, 1};
        lc_vec3 at = i == 3 ? lc_vec(1000, -2000, 500) : foot;
        struct scene *s = scene_new();
        add_scaled(s, LC_RECTANGLE, lc_vec(9 * k[i], 9 * k[i], k[i]), at, 0);
        add_scaled(s, LC_DISK, lc_vec(k[i], k[i], -k[i]), lc_add(at, lc_vec(0, 0, 2 * k[i])), 1);
        lc_vec3 aside = lc_add(at, lc_vec(0.4 * k[i], 0, 0.5 * k[i]));
        add_scaled(s, LC_CUBE, lc_vec(0.2 * k[i], 0.2 * k[i], 0.5 * k[i]), aside, 0);
        double found = direct(s, at, up);
        if (i == 0)
            expected = found;
        ASSERT_CLOSE(found, expected, 2e-9);
        ck_assert_double_lt(found, 0.9 * unoccluded(s, at, up));
        free(s);
    }
}
END_TEST

/* A pixel that is expected black is black: in those that an edge of a box crosses, its lit top shows a sliver of 1% that no node of the
 * quadrature meets. */
START_TEST(edges_of_boxes_are_left_out)
{
    lc_scene *scene;
    lc_film *film;
    lc_error err = {""};
    const lc_estimator *light_direct = lc_right_estimator("light_direct");
    lc_render_options o = {.min_bounces = 1, .max_bounces = 1, .seed = 1, .count = 1024};
    ck_assert_msg(lc_suite_scene(&scene, "cornell", 1, lc_scene_open, &err) == LC_OK, "%s", err.text);
    const lc_scene_desc *desc = lc_scene_description(scene);
    size_t pixels = (size_t)desc->width * (size_t)desc->height, black = 0;
    lc_expected expected = {desc->width, desc->height, calloc(3 * pixels, sizeof(double)), calloc(pixels, 1)};
    lc_claim claim = {.scene = scene, .tolerance = 1e-9};
    ck_assert_msg(lc_expect_direct(&expected, &claim, scene, 0, &err) == LC_OK, "%s", err.text);
    ck_assert_int_eq(lc_film_create(&film, desc->width, desc->height, &err), LC_OK);
    ck_assert_msg(lc_render(film, scene, light_direct, &o, &err) == LC_OK, "%s", err.text);
    for (size_t i = 0; i < pixels; ++i) {
        if (expected.skip[i] || expected.rgb[3 * i] > 0)
            continue;
        ++black;
        ck_assert_msg(film->pixels[i].c[0].max == 0, "pixel %zu,%zu is lit", i % (size_t)desc->width, i / (size_t)desc->width);
    }
    ck_assert_uint_gt(black, 20);
    free(expected.rgb);
    free(expected.skip);
    lc_film_free(film);
    lc_scene_free(scene);
}
END_TEST

Suite *lc_suite_analytic_direct(void)
{
    Suite *suite = suite_create("analytic_direct");
    TCase *lamps = tcase_create("lamps"), *hiders = tcase_create("hiders"), *edges = tcase_create("edges");
    tcase_add_test(lamps, rectangle_emits_on_the_side_of_its_normal);
    tcase_add_test(lamps, rectangle_under_any_affine_map);
    tcase_add_test(lamps, cube_is_its_visible_faces);
    tcase_add_test(lamps, disk_and_sphere);
    tcase_add_test(lamps, points_directions_and_sky);
    tcase_add_test(lamps, flat_shapes_hide_points);
    tcase_add_test(lamps, checkerboard_rectangle);
    tcase_add_test(lamps, refusals_name_the_place);
    tcase_add_test(hiders, plates_hide_exactly);
    tcase_add_test(hiders, balls_hide_exactly);
    tcase_add_test(hiders, clip_and_scan_agree);
    tcase_add_test(hiders, narrow_gaps_are_found);
    tcase_add_test(hiders, irradiance_is_linear_in_the_normal);
    tcase_add_test(hiders, room_matches_brute_force);
    tcase_add_test(hiders, scale_and_place_do_not_matter);
    tcase_add_test(edges, edges_of_boxes_are_left_out);
    tcase_set_timeout(edges, 60);
    suite_add_tcase(suite, lamps);
    suite_add_tcase(suite, hiders);
    suite_add_tcase(suite, edges);
    return suite;
}
