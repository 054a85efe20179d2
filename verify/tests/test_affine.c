/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Affine maps, textures and the arrays of a description. */
#include "verify/tests/tests.h"

#include "core/host.h"

static void same_vec(lc_vec3 a, lc_vec3 b)
{
    ck_assert_double_eq_tol(a.x, b.x, 1e-14);
    ck_assert_double_eq_tol(a.y, b.y, 1e-14);
    ck_assert_double_eq_tol(a.z, b.z, 1e-14);
}

static lc_affine some(void)
{
    lc_affine a = {{{2, 1, 0, 5}, {0, 3, 1, -7}, {1, 0, 4, 11}}};
    return a;
}

/* By hand: 2(12 - 0) - 1(0 - 1) + 0 = 25. */
START_TEST(determinant_of_a_known_matrix)
{
    lc_affine a = some();
    ck_assert_double_eq_tol(lc_affine_determinant(&a), 25, 1e-14);
}
END_TEST

START_TEST(points_move_and_vectors_do_not)
{
    lc_affine a = some();
    same_vec(lc_affine_point(&a, lc_vec(1, 2, 3)), lc_vec(9, 2, 24));
    same_vec(lc_affine_vector(&a, lc_vec(1, 2, 3)), lc_vec(4, 9, 13));
}
END_TEST

START_TEST(product_applies_the_right_one_first)
{
    lc_affine a = some(), b = lc_affine_identity();
    b.m[0][0] = 2, b.m[1][3] = 1;
    lc_affine ab = lc_affine_multiply(&a, &b);
    lc_vec3 p = lc_vec(.5, -2, 3);
    same_vec(lc_affine_point(&ab, p), lc_affine_point(&a, lc_affine_point(&b, p)));
}
END_TEST

START_TEST(inverse_undoes)
{
    for (int e = -6; e <= 6; e += 6) { /* scenes of any size */
        lc_affine a = some(), inverse;
        for (int i = 0; i < 12; ++i)
            a.m[i / 4][i % 4] *= pow(10, e);
        ck_assert_int_eq(lc_affine_invert(&inverse, &a), 1);
        lc_affine one = lc_affine_multiply(&inverse, &a);
        same_vec(lc_affine_point(&one, lc_vec(1, 2, 3)), lc_vec(1, 2, 3));
    }
}
END_TEST

START_TEST(singular_has_no_inverse)
{
    lc_affine a = some(), inverse;
    for (int j = 0; j < 3; ++j)
        a.m[2][j] = a.m[0][j] + a.m[1][j];
    ck_assert_int_eq(lc_affine_invert(&inverse, &a), 0);
    a.m[0][0] = NAN;
    ck_assert_int_eq(lc_affine_invert(&inverse, &a), 0);
}
END_TEST

/* Values from Mitsuba 3.9.1's checkerboard (color0 .1, color1 .9) with to_uv = scale 2, then translate x .3. */
START_TEST(checkerboard_is_mitsubas)
{
    static const double uv[5][2] = {{.1, .1}, {.4, .1}, {.6, .1}, {.9, .9}, {.1, .6}};
    static const int plain[5] = {0, 0, 1, 0, 1}, moved[5] = {0, 0, 0, 1, 0}, negative[5] = {0, 1, 1, 0, 1};
    lc_texture t = {1, {{.1, .1, .1}, {.9, .9, .9}}, {1, 1}, {0, 0}};
    for (int i = 0; i < 5; ++i)
        ck_assert_double_eq(lc_texture_at(&t, uv[i][0], uv[i][1]).r, t.color[plain[i]].r);
    t.offset[0] = t.offset[1] = -.3;
    for (int i = 0; i < 5; ++i)
        ck_assert_double_eq(lc_texture_at(&t, uv[i][0], uv[i][1]).r, t.color[negative[i]].r);
    t.scale[0] = t.scale[1] = 2, t.offset[0] = .3, t.offset[1] = 0;
    for (int i = 0; i < 5; ++i)
        ck_assert_double_eq(lc_texture_at(&t, uv[i][0], uv[i][1]).r, t.color[moved[i]].r);
    t.is_checkerboard = 0;
    ck_assert_double_eq(lc_texture_at(&t, .6, .1).r, .1);
}
END_TEST

START_TEST(default_camera_is_mitsubas)
{
    lc_scene_desc d;
    lc_scene_desc_init(&d);
    /* Mitsuba 3.9.1 prints x_fov = 38.1848 for a 4:3 image: the diagonal's tangent times 4/5. */
    ck_assert_int_eq(d.camera.fov_axis, LC_FOV_DIAGONAL);
    double x = 2 * atan(.8 * tan(d.camera.fov * LC_PI / 360)) * 180 / LC_PI;
    ck_assert_double_eq_tol(x, 38.1848, 1e-4);
    lc_scene_desc_release(&d);
}
END_TEST

START_TEST(arrays_grow_and_copies_are_their_own)
{
    lc_scene_desc d, e;
    lc_error err;
    lc_scene_desc_init(&d);
    for (int n = 1; n <= 9; ++n) {
        lc_scene_desc_add_point(&d)->line = n;
        ck_assert_int_eq(lc_scene_desc_copy(&e, &d, &err), LC_OK);
        lc_scene_desc_add_point(&e)->line = -n; /* a copy can grow, too */
        ck_assert_int_eq(e.point_count, n + 1);
        e.points[0].line = 99;
        for (int i = 0; i < n; ++i)
            ck_assert_int_eq(d.points[i].line, i + 1);
        ck_assert_double_eq(d.points[n - 1].intensity.r, 0); /* a new one is zeroed */
        lc_scene_desc_release(&e);
    }
    lc_scene_desc_add_material(&d), lc_scene_desc_add_shape(&d), lc_scene_desc_add_directional(&d);
    lc_scene_desc_release(&d);
    ck_assert_ptr_null(d.points);
    ck_assert_int_eq(d.point_count, 0);
}
END_TEST

Suite *lc_suite_affine(void)
{
    Suite *suite = suite_create("affine");
    TCase *tc = tcase_create("affine");
    tcase_add_test(tc, determinant_of_a_known_matrix);
    tcase_add_test(tc, points_move_and_vectors_do_not);
    tcase_add_test(tc, product_applies_the_right_one_first);
    tcase_add_test(tc, inverse_undoes);
    tcase_add_test(tc, singular_has_no_inverse);
    tcase_add_test(tc, checkerboard_is_mitsubas);
    tcase_add_test(tc, default_camera_is_mitsubas);
    tcase_add_test(tc, arrays_grow_and_copies_are_their_own);
    suite_add_tcase(suite, tc);
    return suite;
}
