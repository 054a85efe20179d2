/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The camera against Mitsuba's convention, by cases worked out by hand: it looks along +z, +y is up, image right is -x. */
#include "verify/tests/tests.h"

#include "core/scene_c.h"
#include "verify/tests/scene_help.h"

static lc_camera_desc camera_of(double fov, lc_fov_axis axis)
{
    lc_camera_desc c;
    memset(&c, 0, sizeof c);
    c.to_world = lc_affine_identity();
    c.fov = fov;
    c.fov_axis = axis;
    c.far_clip = INFINITY;
    return c;
}

/* The point where the ray meets the plane z = 1. */
static lc_vec3 on_plane(const lc_camera_desc *c, int width, int height, double x, double y)
{
    lc_ray ray = lc_camera_ray(c, width, height, x, y);
    ck_assert_double_eq_tol(lc_length(ray.d), 1, 1e-15);
    return lc_scale(1 / ray.d.z, ray.d);
}

static void ck_vec(lc_vec3 got, double x, double y, double z)
{
    ck_assert_msg(lc_length(lc_sub(got, lc_vec(x, y, z))) < 1e-12, "got (%.15g, %.15g, %.15g), expected (%g, %g, %g)",
                  got.x, got.y, got.z, x, y, z);
}

/* fov 90: tan(45 degrees) = 1. The upper left corner of the image is at +x, +y. */
START_TEST(corners_of_a_square_image)
{
    lc_camera_desc c = camera_of(90, LC_FOV_X);
    ck_vec(on_plane(&c, 8, 8, 0, 0), 1, 1, 1);
    ck_vec(on_plane(&c, 8, 8, 8, 0), -1, 1, 1);
    ck_vec(on_plane(&c, 8, 8, 0, 8), 1, -1, 1);
    ck_vec(on_plane(&c, 8, 8, 4, 4), 0, 0, 1);
    ck_vec(on_plane(&c, 8, 8, 6, 3), -0.5, 0.25, 1);
}
END_TEST

/* Half width and half height on the plane z = 1, where tan(fov / 2) = 1. */
START_TEST(every_axis_and_aspect)
{
    static const struct {
        lc_fov_axis axis;
        int width, height;
        double x, y;
    } cases[] = {
        {LC_FOV_X, 200, 100, 1, 0.5},        {LC_FOV_X, 100, 200, 1, 2},          {LC_FOV_Y, 200, 100, 2, 1},
        {LC_FOV_Y, 100, 200, 0.5, 1},        {LC_FOV_SMALLER, 200, 100, 2, 1},    {LC_FOV_SMALLER, 100, 200, 1, 2},
        {LC_FOV_LARGER, 200, 100, 1, 0.5},   {LC_FOV_LARGER, 100, 200, 0.5, 1},   {LC_FOV_SMALLER, 64, 64, 1, 1},
        {LC_FOV_LARGER, 64, 64, 1, 1},       {LC_FOV_DIAGONAL, 40, 30, 0.8, 0.6}, /* 3-4-5: the half diagonal is 1 */
        {LC_FOV_DIAGONAL, 30, 40, 0.6, 0.8},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        lc_camera_desc c = camera_of(90, cases[i].axis);
        int w = cases[i].width, h = cases[i].height;
        ck_vec(on_plane(&c, w, h, 0, 0), cases[i].x, cases[i].y, 1);
        ck_vec(on_plane(&c, w, h, w, h), -cases[i].x, -cases[i].y, 1);
        ck_vec(on_plane(&c, w, h, w / 2.0, h / 2.0), 0, 0, 1);
    }
}
END_TEST

/* tan(30 degrees) = 1 / sqrt(3). */
START_TEST(another_fov)
{
    lc_camera_desc c = camera_of(60, LC_FOV_X);
    ck_vec(on_plane(&c, 10, 10, 0, 5), 1 / sqrt(3.0), 0, 1);
}
END_TEST

/* Mitsuba's default: 50 mm on 36 x 24 mm: a 3:2 image spans 0.36 to either side and 0.24 up. */
START_TEST(default_lens)
{
    lc_scene_desc desc;
    lc_scene_desc_init(&desc);
    ck_vec(on_plane(&desc.camera, 3, 2, 0, 0), 0.36, 0.24, 1);
    lc_scene_desc_release(&desc);
}
END_TEST

/* At (1, 2, 3) looking along +x with +z up. Right in the image is direction x up = x cross z = -y. */
START_TEST(posed_camera)
{
    lc_camera_desc c = camera_of(90, LC_FOV_X);
    c.to_world = pose_of_columns(lc_vec(0, 1, 0), lc_vec(0, 0, 1), lc_vec(1, 0, 0), lc_vec(1, 2, 3));
    ck_assert_double_eq_tol(lc_affine_determinant(&c.to_world), 1, 1e-15); /* a rotation */
    lc_ray ray = lc_camera_ray(&c, 2, 2, 2, 0);                            /* upper right corner */
    ck_vec(ray.o, 1, 2, 3);
    ck_vec(lc_scale(sqrt(3.0), ray.d), 1, -1, 1);
}
END_TEST

/* Clips are measured along the axis, not along the ray. Two rectangles across the axis at z = 2 and z = 4. */
START_TEST(near_and_far_clip)
{
    static const struct {
        double near, far, z; /* z of what is seen at a corner, 0: nothing */
    } cases[] = {{0, INFINITY, 2}, {1.9, INFINITY, 2}, {2.1, INFINITY, 4}, {4.1, INFINITY, 0},
                 {0, 2.1, 2},      {0, 1.9, 0},        {2.1, 4.1, 4},      {2.1, 3.9, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        lc_scene_desc desc;
        lc_scene_desc_init(&desc);
        desc.camera = camera_of(90, LC_FOV_X);
        desc.camera.near_clip = cases[i].near;
        desc.camera.far_clip = cases[i].far;
        for (int k = 1; k <= 2; ++k) {
            lc_affine pose = pose_scale(100, 100, 1);
            pose.m[2][3] = 2 * k;
            add_shape(&desc, LC_RECTANGLE, pose);
        }
        lc_scene *scene = build_scene(&desc);
        lc_ray ray = lc_camera_ray(&lc_scene_description(scene)->camera, 4, 4, 0.1, 3.8);
        lc_hit hit;
        lc_camera_see(scene, &ray, &hit);
        ck_assert_int_eq(hit.valid, cases[i].z != 0);
        if (hit.valid)
            ck_assert_double_eq_tol(hit.p.z, cases[i].z, 1e-12);
        lc_scene_free(scene);
    }
}
END_TEST

/* A pinhole's rays are spread over their pixel and nothing else: its own two numbers say where. */
START_TEST(pinhole_fills_its_pixel)
{
    lc_camera_desc c = camera_of(90, LC_FOV_X);
    lc_camera_frame frame;
    lc_camera_prepare(&frame, &c, 8, 8);
    for (uint32_t k = 0; k < 100; ++k) {
        lc_sampler sampler, again;
        lc_sampler_start(&sampler, 3, 1, 0, k);
        again = sampler;
        lc_ray ray = lc_camera_sample(&frame, &sampler, 6, 2);
        double x = 6 + lc_next(&again), y = 2 + lc_next(&again);
        ck_assert_uint_eq(sampler.dimension, 2);
        ck_vec(lc_scale(1 / ray.d.z, ray.d), 1 - x / 4, 1 - y / 4, 1);
        ck_vec(ray.o, 0, 0, 0);
    }
}
END_TEST

/* A lens of radius 0.5 focused at 3: rays start on the lens, one metre along the axis times the near clip further, uniform over its disk,
 * and all of one image point meet in the plane z = 3. */
START_TEST(lens_gathers_in_its_plane)
{
    enum { N = 4096 };
    lc_camera_desc c = camera_of(90, LC_FOV_X);
    lc_camera_frame frame;
    int ring[4] = {0, 0, 0, 0}, quadrant[4] = {0, 0, 0, 0};
    c.aperture_radius = 0.5;
    c.focus_distance = 3;
    c.near_clip = 0.25;
    lc_camera_prepare(&frame, &c, 8, 8);
    for (uint32_t k = 0; k < N; ++k) {
        lc_sampler sampler, again;
        lc_sampler_start(&sampler, 3, 1, 0, k);
        again = sampler;
        lc_ray ray = lc_camera_sample(&frame, &sampler, 6, 2);
        ck_assert_uint_eq(sampler.dimension, 4); /* two of the pixel, two of the lens */
        double x = 6 + lc_next(&again), y = 2 + lc_next(&again);
        ck_assert_double_eq_tol(lc_length(ray.d), 1, 1e-15);
        ck_assert_double_eq_tol(ray.o.z, 0.25, 1e-15);
        ck_vec(lc_add(ray.o, lc_scale((3 - ray.o.z) / ray.d.z, ray.d)), 3 * (1 - x / 4), 3 * (1 - y / 4), 3);
        lc_vec3 lens = lc_sub(ray.o, lc_scale(0.25 / ray.d.z, ray.d));
        double r = hypot(lens.x, lens.y) / 0.5;
        ck_assert(r < 1 + 1e-12);
        ++ring[(int)fmin(3, 4 * r * r)];
        ++quadrant[(lens.x > 0) + 2 * (lens.y > 0)];
    }
    for (int i = 0; i < 4; ++i) { /* six sigma of a quarter */
        ck_assert_double_eq_tol(ring[i] / (double)N, 0.25, 6 * sqrt(0.1875 / N));
        ck_assert_double_eq_tol(quadrant[i] / (double)N, 0.25, 6 * sqrt(0.1875 / N));
    }
    ck_vec(on_plane(&c, 8, 8, 4, 4), 0, 0, 1); /* lc_camera_ray() looks through the centre */
}
END_TEST

START_TEST(impossible_lenses_are_refused)
{
    static const double lenses[][2] = {{-1, 1}, {INFINITY, 1}, {NAN, 1}, {1, 0}, {1, -2}, {1, INFINITY}, {1, NAN}};
    for (size_t i = 0; i < sizeof lenses / sizeof lenses[0]; ++i) {
        lc_scene_desc desc;
        lc_scene *scene = NULL;
        lc_error err = {""};
        lc_scene_desc_init(&desc);
        desc.camera.aperture_radius = lenses[i][0];
        desc.camera.focus_distance = lenses[i][1];
        ck_assert_int_eq(lc_scene_build(&scene, &desc, &err), LC_BAD_INPUT);
        ck_assert_ptr_nonnull(strstr(err.text, "lens"));
        lc_scene_desc_release(&desc);
    }
}
END_TEST

Suite *lc_suite_camera(void)
{
    Suite *suite = suite_create("camera");
    TCase *tc = tcase_create("core");
    tcase_add_test(tc, corners_of_a_square_image);
    tcase_add_test(tc, every_axis_and_aspect);
    tcase_add_test(tc, another_fov);
    tcase_add_test(tc, default_lens);
    tcase_add_test(tc, posed_camera);
    tcase_add_test(tc, near_and_far_clip);
    tcase_add_test(tc, pinhole_fills_its_pixel);
    tcase_add_test(tc, lens_gathers_in_its_plane);
    tcase_add_test(tc, impossible_lenses_are_refused);
    suite_add_tcase(suite, tc);
    return suite;
}
