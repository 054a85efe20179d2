/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Moving shapes: at each moment the scene is the still one with everything where it is then; closed forms of when a line meets a shape. */
#include "verify/tests/tests.h"

#include "core/scene_c.h"
#include "verify/analytic/effects.h"
#include "verify/tests/scene_help.h"

enum { SHAPES = 12 };

/* Shapes of all kinds, each with a checkerboard where it may have one; `time` >= 0: at rest where they are then. */
static lc_scene *make_flock(uint64_t seed, double time)
{
    uint64_t state = seed;
    lc_scene_desc desc;
    lc_scene_desc_init(&desc);
    int board = add_diffuse(&desc, 0.5), plain = add_diffuse(&desc, 0.5);
    lc_texture checker = {1, {{0.8, 0.7, 0.6}, {0.1, 0.2, 0.3}}, {5, 3}, {0.1, 0.2}};
    desc.materials[board].side[0].diffuse = desc.materials[board].side[1].diffuse = checker;
    for (int i = 0; i < SHAPES; ++i) {
        lc_shape_kind kind = (lc_shape_kind)(i % 4);
        lc_affine pose = next_pose(&state, kind, 0.2, 0.6, 2);
        lc_vec3 motion = lc_scale(next_within(&state, 0, 2), next_direction(&state));
        if (time >= 0) {
            pose.m[0][3] += time * motion.x;
            pose.m[1][3] += time * motion.y;
            pose.m[2][3] += time * motion.z;
        }
        lc_shape_desc *shape = add_lamp(&desc, kind, pose, lc_color(1, 2, 3));
        shape->material = kind == LC_CUBE ? plain : board;
        shape->motion = time >= 0 ? lc_vec(0, 0, 0) : motion;
    }
    return build_scene(&desc);
}

static int same_hit(const lc_hit *a, const lc_hit *b)
{
    return a->valid == b->valid &&
           (!a->valid || (a->shape == b->shape && a->part == b->part && lc_length(lc_sub(a->p, b->p)) < 1e-10 &&
                          lc_length(lc_sub(a->n, b->n)) < 1e-10 && fabs(a->distance - b->distance) < 1e-10));
}

static void ck_same_light(const lc_light_sample *a, const lc_light_sample *b)
{
    ck_assert(lc_length(lc_sub(a->p, b->p)) < 1e-10 && lc_length(lc_sub(a->n, b->n)) < 1e-10);
    ck_assert(lc_length(lc_sub(a->wi, b->wi)) < 1e-10 && fabs(a->distance - b->distance) < 1e-10);
    ck_assert_double_eq_tol(a->pdf_area, b->pdf_area, 1e-10);
    ck_assert_double_eq_tol(a->pdf_solid, b->pdf_solid, 1e-8 * fmax(1, b->pdf_solid));
    ck_assert_double_eq(a->radiance.g, b->radiance.g);
}

/* By solid angle and over the union, too: once the former looked for a lamp where it had been at time 0. */
START_TEST(lights_are_sampled_where_they_are)
{
    uint64_t state = 78;
    int solid = 0;
    lc_scene *moving = make_flock(5, -1);
    for (int k = 0; k < 4; ++k) {
        double time = k / 4.0;
        lc_scene *still = make_flock(5, time);
        for (uint32_t i = 0; i < 50 * SHAPES; ++i) {
            lc_hit hit = {.valid = 1, .n = {0, 0, 1}, .wo = {0, 0, 1}, .shape = -1, .part = -1, .time = time};
            hit.p = lc_scale(next_within(&state, 5, 7), next_direction(&state)); /* outside all of them */
            lc_light_sample a, b;
            lc_sampler sampler_a, sampler_b;
            lc_sampler_start(&sampler_a, 1, 2, 3, i);
            sampler_b = sampler_a;
            lc_light_sample_solid(moving, (int)i % SHAPES, &hit, &sampler_a, &a);
            lc_light_sample_solid(still, (int)i % SHAPES, &hit, &sampler_b, &b);
            ck_same_light(&a, &b);
            solid += a.pdf_area == 0;
            lc_light_sample_union(moving, &hit, &sampler_a, &a);
            lc_light_sample_union(still, &hit, &sampler_b, &b);
            ck_same_light(&a, &b);
        }
        lc_scene_free(still);
    }
    lc_scene_free(moving);
    ck_assert_int_gt(solid, 600); /* spheres and rectangles */
}
END_TEST

/* Along an edge one float decides, and the two scenes have different floats: a few rays in ten thousand. */
START_TEST(each_moment_is_a_still_scene)
{
    enum { RAYS = 2000 };
    uint64_t state = 77;
    int differ = 0, hits = 0, visible = 0;
    lc_scene *moving = make_flock(5, -1);
    ck_assert_int_eq(moving->moves, 1);
    for (int k = 0; k < 8; ++k) {
        double time = k == 0 ? 0 : floor(next_uniform(&state) * 0x1p24) * 0x1p-24;
        lc_scene *still = make_flock(5, time);
        ck_assert_int_eq(still->moves, 0);
        for (int i = 0; i < RAYS; ++i) {
            lc_vec3 o = lc_vec(next_within(&state, -3, 3), next_within(&state, -3, 3), next_within(&state, -3, 3));
            lc_ray ray = {o, next_direction(&state), time};
            lc_hit a, b, next_a, next_b;
            lc_intersect(moving, &ray, &a);
            lc_intersect(still, &ray, &b);
            if (!same_hit(&a, &b)) {
                ++differ;
                continue;
            }
            if (!a.valid)
                continue;
            ++hits;
            ck_assert(a.time == time);
            lc_rgb of_a = lc_material_at(moving, &a).diffuse, of_b = lc_material_at(still, &b).diffuse;
            differ += of_a.r != of_b.r; /* the line between two cells */
            lc_vec3 wi = next_direction(&state);
            lc_trace(moving, &a, wi, &next_a);
            lc_trace(still, &b, wi, &next_b);
            differ += !same_hit(&next_a, &next_b);
            lc_light_sample light_a, light_b;
            lc_sampler sampler_a, sampler_b;
            lc_sampler_start(&sampler_a, 1, 2, 3, (uint32_t)i);
            sampler_b = sampler_a;
            lc_light_sample_one(moving, i % SHAPES, &a, &sampler_a, &light_a);
            lc_light_sample_one(still, i % SHAPES, &b, &sampler_b, &light_b);
            ck_assert(lc_length(lc_sub(light_a.p, light_b.p)) < 1e-12);
            ck_assert_double_eq(light_a.pdf_area, light_b.pdf_area);
            int seen = lc_visible(moving, &a, &light_a);
            visible += seen;
            differ += seen != lc_visible(still, &b, &light_b);
        }
        lc_scene_free(still);
    }
    lc_scene_free(moving);
    ck_assert_msg(hits > 1000 && visible > 200, "%d hits, %d visible", hits, visible);
    ck_assert_msg(differ < 10, "%d rays differ", differ);
}
END_TEST

/* A closed room flies as a whole: no ray leaves it, none hits the wall that it starts from. */
START_TEST(a_flying_room_leaks_nothing)
{
    enum { PATHS = 400, BOUNCES = 50 };
    uint64_t state = 9;
    for (int flip = 0; flip < 2; ++flip) {
        lc_scene_desc desc;
        lc_scene_desc_init(&desc);
        lc_affine pose = next_pose(&state, flip ? LC_SPHERE : LC_CUBE, 0.5, 1.5, 3);
        lc_shape_desc *room = add_shape(&desc, flip ? LC_SPHERE : LC_CUBE, pose);
        room->flip_normals = 1;
        room->motion = lc_vec(7, -3, 5);
        lc_scene *scene = build_scene(&desc);
        for (int i = 0; i < PATHS; ++i) {
            double time = floor(next_uniform(&state) * 0x1p24) * 0x1p-24;
            lc_ray ray = {lc_add(lc_affine_point(&pose, lc_vec(0.1, 0.2, 0)), lc_scale(time, lc_vec(7, -3, 5))),
                          next_direction(&state), time};
            lc_hit hit;
            lc_intersect(scene, &ray, &hit);
            for (int k = 0; k < BOUNCES; ++k) {
                ck_assert_msg(hit.valid, "left at bounce %d, time %.9g", k, time);
                lc_hit before = hit;
                double u = next_uniform(&state), v = next_uniform(&state);
                lc_trace(scene, &before, lc_uniform_hemisphere(before.n, u, v), &hit);
                ck_assert_msg(flip || hit.part != before.part, "hit itself at time %.9g", time);
            }
        }
        lc_scene_free(scene);
    }
}
END_TEST

/* Uniform over [0, 1), from its own dimension; a scene at rest draws none. */
START_TEST(rays_have_a_time_where_something_moves)
{
    enum { N = 4096 };
    lc_camera_frame frame;
    lc_scene_desc desc;
    int count[8] = {0};
    lc_scene_desc_init(&desc);
    lc_camera_prepare(&frame, &desc.camera, 4, 4);
    for (uint32_t k = 0; k < N; ++k) {
        lc_sampler sampler, again;
        lc_sampler_start(&sampler, 3, 1, 0, k);
        again = sampler;
        frame.moves = 0;
        ck_assert_double_eq(lc_camera_sample(&frame, &sampler, 1, 1).time, 0);
        ck_assert_uint_eq(sampler.dimension, 2);
        frame.moves = 1;
        double time = lc_camera_sample(&frame, &again, 1, 1).time;
        ck_assert_uint_eq(again.dimension, LC_DIMENSION_TIME + 1);
        ck_assert(time >= 0 && time < 1 && time == (double)(float)time);
        ++count[(int)(8 * time)];
    }
    for (int i = 0; i < 8; ++i) /* six sigma */
        ck_assert_double_eq_tol(count[i] / (double)N, 0.125, 6 * sqrt(0.125 * 0.875 / N));
    lc_scene_desc_release(&desc);
}
END_TEST

START_TEST(motion_that_is_not_finite_is_refused)
{
    lc_error err = {""};
    lc_scene_desc desc;
    lc_scene *scene = NULL;
    lc_scene_desc_init(&desc);
    add_shape(&desc, LC_DISK, lc_affine_identity())->motion = lc_vec(0, NAN, 0);
    ck_assert_int_eq(lc_scene_build(&scene, &desc, &err), LC_BAD_INPUT);
    ck_assert_ptr_nonnull(strstr(err.text, "motion"));
    lc_scene_desc_release(&desc);
}
END_TEST

/* ---- closed forms ------------------------------------------------------------------------------------------------- */

static void check_span(lc_span span, double from, double to)
{
    ck_assert_double_eq_tol(span.from, from, 1e-14);
    ck_assert_double_eq_tol(span.to, to, 1e-14);
}

/* Along z, past shapes of size 1 that come from x = -3 with speed 8: they are met from x = -1 to x = 1, or as far as a chord goes. */
START_TEST(spans_are_known)
{
    lc_vec3 start = lc_vec(-3, 0, 2), a = lc_vec(1, 0, 0), b = lc_vec(0, 1, 0), motion = lc_vec(8, 0, 0),
            up = lc_vec(0, 0, 1);
    check_span(lc_rectangle_span(start, a, b, motion, lc_vec(0, 0.5, 0), up), 0.25, 0.5);
    check_span(lc_disk_span(start, a, b, motion, lc_vec(0, 0.6, 0), up), 2.2 / 8, 3.8 / 8);
    check_span(lc_sphere_span(start, 1, motion, lc_vec(0, 0.6, 0), up), 2.2 / 8, 3.8 / 8);
    ck_assert(lc_spans_length((lc_span[]){lc_rectangle_span(start, a, b, motion, lc_vec(0, 1.5, 0), up)}, 1) == 0);
    ck_assert(lc_spans_length((lc_span[]){lc_sphere_span(start, 1, motion, lc_vec(0, 1.5, 0), up)}, 1) == 0);
    check_span(lc_rectangle_span(start, a, b, lc_vec(0, 0, 3), lc_vec(-3, 0, 0), up), 0, 1); /* along the line */
    check_span(lc_sphere_span(start, 1, lc_vec(0, 0, 3), lc_vec(-3, 0, 0), up), 0, 1);
    check_span(lc_rectangle_span(start, a, b, motion, lc_vec(-3.5, 0, 0), up), 0, 0.0625); /* it begins on it */
    check_span(lc_disk_span(start, a, b, motion, lc_vec(5, 0, 0), up), 7.0 / 8, 1);        /* and ends on it */
}
END_TEST

START_TEST(spans_agree_with_still_shapes)
{
    enum { MOMENTS = 1000 };
    uint64_t state = 21;
    for (int i = 0; i < 60; ++i) {
        lc_shape_kind kind = i % 3 == 0 ? LC_RECTANGLE : i % 3 == 1 ? LC_DISK : LC_SPHERE;
        lc_affine pose = next_pose(&state, kind, 0.3, 1, 1);
        lc_vec3 motion = lc_scale(2, next_direction(&state)), d = next_direction(&state);
        lc_vec3 a = lc_affine_vector(&pose, lc_vec(1, 0, 0)), b = lc_affine_vector(&pose, lc_vec(0, 1, 0));
        lc_vec3 centre = lc_affine_point(&pose, lc_vec(0, 0, 0));
        lc_vec3 p = lc_add(centre, lc_add(lc_scale(0.5, motion), lc_scale(0.4, next_direction(&state))));
        lc_span span = kind == LC_RECTANGLE ? lc_rectangle_span(centre, a, b, motion, p, d)
                       : kind == LC_DISK    ? lc_disk_span(centre, a, b, motion, p, d)
                                            : lc_sphere_span(centre, lc_length(a), motion, p, d);
        int met = 0;
        for (int k = 0; k < MOMENTS; ++k) { /* the line in the shape's own coordinates */
            lc_affine then = pose, back;
            double t = (k + 0.5) / MOMENTS;
            then.m[0][3] += t * motion.x;
            then.m[1][3] += t * motion.y;
            then.m[2][3] += t * motion.z;
            ck_assert(lc_affine_invert(&back, &then));
            lc_vec3 o = lc_affine_point(&back, p), w = lc_affine_vector(&back, d);
            lc_vec3 q = lc_sub(o, lc_scale(o.z / w.z, w)), near = lc_cross(lc_normalize(w), o);
            met += kind == LC_RECTANGLE ? fabs(q.x) <= 1 && fabs(q.y) <= 1
                   : kind == LC_DISK    ? q.x * q.x + q.y * q.y <= 1
                                        : lc_dot(near, near) <= 1;
        }
        ck_assert_double_eq_tol(lc_spans_length(&span, 1), met / (double)MOMENTS, 2.1 / MOMENTS);
    }
}
END_TEST

START_TEST(unions_count_each_moment_once)
{
    const lc_span spans[] = {{0.1, 0.3}, {0.2, 0.4}, {0.6, 0.7}, {0.9, 0.8}, {0.05, 0.65}, {0.5, 0.55}, {0.98, 1}};
    static const double length[] = {0, 0.2, 0.3, 0.4, 0.4, 0.65, 0.65, 0.67};
    for (int n = 0; n <= 7; ++n)
        ck_assert_double_eq_tol(lc_spans_length(spans, n), length[n], 1e-15);
}
END_TEST

static double irradiance_at(double time, void *user)
{
    lc_scene_desc desc = *(const lc_scene_desc *)user;
    lc_shape_desc lamp = desc.shapes[0];
    lc_rgb irradiance;
    lamp.to_world.m[0][3] += time * lamp.motion.x;
    lamp.to_world.m[1][3] += time * lamp.motion.y;
    lamp.to_world.m[2][3] += time * lamp.motion.z;
    lamp.motion = lc_vec(0, 0, 0);
    desc.shapes = &lamp;
    ck_assert_int_eq(lc_direct_irradiance(&irradiance, &desc, lc_vec(0.3, 0.1, 0), lc_vec(0, 0, 1), NULL), LC_OK);
    return irradiance.g;
}

START_TEST(moving_lamp_is_the_mean_over_time)
{
    lc_scene_desc desc;
    lc_error err = {""};
    lc_rgb mean;
    double should;
    lc_scene_desc_init(&desc);
    lc_affine pose = pose_rotate(lc_normalize(lc_vec(0.3, 0.1, -1)), 0.4);
    pose.m[2][3] = 2.5;
    add_lamp(&desc, LC_RECTANGLE, pose, lc_color(1, 2, 3))->motion = lc_vec(1.5, -0.5, 0.8);
    ck_assert_int_eq(lc_moving_irradiance(&mean, &desc, lc_vec(0.3, 0.1, 0), lc_vec(0, 0, 1), &err), LC_OK);
    ck_assert_int_eq(lc_quadrature(&should, irradiance_at, &desc, 0, 1, 0, 1e-12, &err), LC_OK);
    ck_assert_double_eq_tol(mean.g, should, 1e-8 * should);
    ck_assert_int_eq(lc_direct_irradiance(&mean, &desc, lc_vec(0.3, 0.1, 0), lc_vec(0, 0, 1), &err), LC_BAD_INPUT);
    ck_assert_ptr_nonnull(strstr(err.text, "moves"));
    lc_scene_desc_release(&desc);
}
END_TEST

Suite *lc_suite_motion(void)
{
    Suite *suite = suite_create("motion");
    TCase *tc = tcase_create("motion");
    tcase_set_timeout(tc, 30);
    tcase_add_test(tc, lights_are_sampled_where_they_are);
    tcase_add_test(tc, each_moment_is_a_still_scene);
    tcase_add_test(tc, a_flying_room_leaks_nothing);
    tcase_add_test(tc, rays_have_a_time_where_something_moves);
    tcase_add_test(tc, motion_that_is_not_finite_is_refused);
    tcase_add_test(tc, spans_are_known);
    tcase_add_test(tc, spans_agree_with_still_shapes);
    tcase_add_test(tc, unions_count_each_moment_once);
    tcase_add_test(tc, moving_lamp_is_the_mean_over_time);
    suite_add_tcase(suite, tc);
    return suite;
}
