/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Closed forms and quadrature of glossy surfaces, lenses and moving shapes; the host against them, where one value says it. */
#include "verify/analytic/effects.h"
#include "verify/tests/tests.h"

#include "verify/tests/scene_help.h"

static lc_error err;

/* ---- cubature ---------------------------------------------------------------------------------------------------- */

static void polynomial(double *value, double x, double y, void *user)
{
    (void)user;
    value[0] = pow(x, 7) * pow(y, 7);
    value[1] = 1;
}

static void kink(double *value, double x, double y, void *user)
{
    (void)user;
    value[0] = fabs(x - y / 3);
}

static void peak(double *value, double x, double y, void *user)
{
    const double *width = user;
    double r2 = (x * x + y * y) / (*width * *width);
    value[0] = 1 / ((1 + r2) * (1 + r2));
}

static void noise(double *value, double x, double y, void *user)
{
    (void)user;
    value[0] = sin(1e6 * x * x) * sin(1e6 * y * y);
}

START_TEST(cubature_finds_what_is_known)
{
    double out[2];
    ck_assert_int_eq(lc_cubature(out, 2, polynomial, NULL, 0, 1, 0, 2, 1e-12, &err), LC_OK);
    ck_assert_double_eq_tol(out[0], 4, 1e-12); /* 1/8 * 2^8/8 */
    ck_assert_double_eq_tol(out[1], 2, 1e-12);
    ck_assert_int_eq(lc_cubature(out, 1, kink, NULL, 0, 1, 0, 1, 1e-9, &err), LC_OK);
    ck_assert_double_eq_tol(out[0], 1.0 / 27 + 1.0 / 3, 1e-9); /* int (y/3)^2 dy - int y/3 dy + 1/2 */
    double width = 1e-3; /* a quarter of the plane, but for the tail: pi w^2 / 4 */
    ck_assert_int_eq(lc_cubature(out, 1, peak, &width, 0, 100, 0, 100, 1e-14, &err), LC_OK);
    ck_assert_double_eq_tol(out[0], LC_PI * 1e-6 / 4, 1e-12);
    ck_assert_int_eq(lc_cubature(out, 1, noise, NULL, 0, 1, 0, 1, 1e-12, &err), LC_FAULT);
}
END_TEST

/* ---- rough mirrors ------------------------------------------------------------------------------------------------ */

/* alpha = 1: D = 1 / pi. Upright, f cos = 1 / (2 pi (1 + cos)) cos, whose integral is 1 - ln 2. */
START_TEST(albedo_has_its_closed_form)
{
    double albedo;
    ck_assert_int_eq(lc_ggx_albedo(&albedo, 1, 1, &err), LC_OK);
    ck_assert_double_eq_tol(albedo, 1 - log(2), 1e-9);
    /* Nearly smooth: what is lost vanishes with alpha^2. */
    ck_assert_int_eq(lc_ggx_albedo(&albedo, 1, 0.01, &err), LC_OK);
    ck_assert(albedo > 0.999 && albedo < 1);
}
END_TEST

static void lobe(double *value, double angle, double azimuth, void *user)
{
    const double *is = user; /* cosine, alpha */
    lc_vec3 wo = lc_vec(sqrt(1 - is[0] * is[0]), 0, is[0]);
    lc_vec3 wi = lc_vec(sin(angle) * cos(azimuth), sin(angle) * sin(azimuth), cos(angle));
    value[0] = sin(angle) * cos(angle) * lc_ggx_value(lc_vec(0, 0, 1), wo, wi, is[1]);
}

/* Over facets, and over directions. */
START_TEST(albedo_is_the_integral_of_the_value)
{
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 5; ++k) {
            static const double alphas[] = {0.1, 0.3, 0.6, 1}, cosines[] = {1, 0.9, 0.5, 0.2, 0.05};
            double part[2], albedo, is[2] = {cosines[k], alphas[i]}, mirror = acos(is[0]); /* the peak on a corner */
            ck_assert_int_eq(lc_cubature(&part[0], 1, lobe, is, 0, mirror, 0, LC_PI, 1e-8, &err), LC_OK);
            ck_assert_int_eq(lc_cubature(&part[1], 1, lobe, is, mirror, LC_PI / 2, 0, LC_PI, 1e-8, &err), LC_OK);
            ck_assert_int_eq(lc_ggx_albedo(&albedo, is[0], is[1], &err), LC_OK);
            ck_assert_double_eq_tol(2 * (part[0] + part[1]), albedo, 1e-7);
            ck_assert(albedo < 1);
        }
}
END_TEST

START_TEST(series_follow_the_albedo)
{
    lc_ggx_series series;
    double alpha = 0.15, albedo;
    ck_assert_int_eq(lc_ggx_series_fit(&series, alpha / 4, 1, alpha, &err), LC_OK);
    for (double cosine = alpha / 4; cosine <= 1; cosine += 0.0173) {
        ck_assert_int_eq(lc_ggx_albedo(&albedo, cosine, alpha, &err), LC_OK);
        ck_assert_double_eq_tol(lc_ggx_series_at(&series, cosine), albedo, 1e-7);
    }
}
END_TEST

/* The host's value against the paper's, from both sides of a two-sided surface and in any pose. */
START_TEST(host_has_the_value_of_the_paper)
{
    uint64_t state = 5;
    int above = 0;
    for (int i = 0; i < 200; ++i) {
        lc_scene_desc desc;
        lc_scene_desc_init(&desc);
        lc_material_desc *m = lc_scene_desc_add_material(&desc);
        m->int_ior = m->ext_ior = 1;
        double alpha = next_within(&state, 0.01, 1);
        for (int side = 0; side < 2; ++side) {
            m->side[side].diffuse = lc_texture_constant(lc_color(0.1, 0.2, 0.3));
            m->side[side].glossy = lc_color(0.6, 0.4, 0.2);
            m->side[side].alpha = alpha;
        }
        lc_vec3 n = next_direction(&state), wo = next_direction(&state);
        add_shape(&desc, LC_RECTANGLE, pose_rotate(n, 0.3));
        lc_scene *scene = build_scene(&desc);
        lc_hit hit = see(scene, wo, lc_neg(wo));
        ck_assert_int_eq(hit.valid, 1);
        ck_assert_uint_eq(lc_scene_lobes(scene), LC_DIFFUSE | LC_GLOSSY);
        lc_vec3 facing = lc_facing(n, wo);
        for (int k = 0; k < 100; ++k) {
            lc_vec3 wi = next_direction(&state);
            double should = 0.4 * lc_ggx_value(facing, hit.wo, wi, alpha);
            should += lc_dot(facing, wi) > 0 ? 0.2 / LC_PI : 0;
            ck_assert_double_eq_tol(lc_bsdf_eval(scene, &hit, wi).g, should, 1e-9 * fmax(should, 1e-9));
            above += should > 0;
        }
        lc_scene_free(scene);
    }
    ck_assert_int_gt(above, 5000);
}
END_TEST

START_TEST(roughness_outside_its_range_is_refused)
{
    static const double alphas[] = {0, -0.1, 1.01, NAN};
    for (int i = 0; i < 4; ++i) {
        lc_scene_desc desc;
        lc_scene *scene = NULL;
        lc_scene_desc_init(&desc);
        int material = add_diffuse(&desc, 0.5);
        desc.materials[material].side[1].glossy = lc_color(0, 0.1, 0);
        desc.materials[material].side[1].alpha = alphas[i];
        add_shape(&desc, LC_SPHERE, lc_affine_identity());
        ck_assert_int_eq(lc_scene_build(&scene, &desc, &err), LC_BAD_INPUT);
        ck_assert_ptr_nonnull(strstr(err.text, "roughness"));
        lc_scene_desc_release(&desc);
    }
}
END_TEST

Suite *lc_suite_effects(void)
{
    Suite *suite = suite_create("effects");
    TCase *tc = tcase_create("effects");
    tcase_set_timeout(tc, 30);
    tcase_add_test(tc, cubature_finds_what_is_known);
    tcase_add_test(tc, albedo_has_its_closed_form);
    tcase_add_test(tc, albedo_is_the_integral_of_the_value);
    tcase_add_test(tc, series_follow_the_albedo);
    tcase_add_test(tc, host_has_the_value_of_the_paper);
    tcase_add_test(tc, roughness_outside_its_range_is_refused);
    suite_add_tcase(suite, tc);
    return suite;
}
