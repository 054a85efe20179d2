/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Closed forms and quadrature of glossy surfaces, lenses and moving shapes; the host against them, where one value says it. */
#include "io/scene_read.h"
#include "verify/analytic/effects.h"
#include "verify/tests/tests.h"

#include <stdio.h>

#include "estimators/registry.h"
#include "verify/judge/judge.h"
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

/* ---- lenses ------------------------------------------------------------------------------------------------------- */

START_TEST(disk_share_has_its_closed_forms)
{
    static const double half[4][2] = {{0, -9}, {9, -9}, {9, 9}, {0, 9}}; /* x > 0 */
    for (double h = -0.95; h < 1; h += 0.1) /* a segment */
        ck_assert_double_eq_tol(lc_disk_polygon_share(half, 4, -2 * h, 1, 2),
                                (acos(h) - h * sqrt(1 - h * h)) / LC_PI, 1e-14);
    ck_assert_double_eq_tol(lc_disk_polygon_share(half, 4, 4, 0, 1), 1, 1e-14);
    ck_assert_double_eq_tol(lc_disk_polygon_share(half, 4, -4, 0, 1), 0, 1e-14);
    ck_assert_double_eq_tol(lc_disk_polygon_share(half, 4, 0, 9, 3), 0.25, 1e-14); /* on a corner */
    static const double square[4][2] = {{-1, -1}, {-1, 1}, {1, 1}, {1, -1}}; /* clockwise */
    ck_assert_double_eq_tol(lc_disk_polygon_share(square, 4, 0, 0, 2), 1 / LC_PI, 1e-14);
    /* Four segments cut off: 1 - 4 (acos h - h sqrt(1 - h^2)) / pi, h = 1 / 1.2. */
    double h = 1 / 1.2;
    ck_assert_double_eq_tol(lc_disk_polygon_share(square, 4, 0, 0, 1.2),
                            1 - 4 * (acos(h) - h * sqrt(1 - h * h)) / LC_PI, 1e-14);
}
END_TEST

/* Against counting. */
START_TEST(disk_share_of_any_triangle)
{
    enum { SIDE = 400 };
    uint64_t state = 11;
    for (int i = 0; i < 40; ++i) {
        double corner[3][2], radius = next_within(&state, 0.3, 2), x = next_within(&state, -1, 1);
        int inside = 0, all = 0;
        for (int k = 0; k < 6; ++k)
            corner[k / 2][k % 2] = next_within(&state, -2, 2);
        for (int k = 0; k < SIDE * SIDE; ++k) {
            double u = 2 * (k % SIDE + 0.5) / SIDE - 1, v = 2 * (k / SIDE + 0.5) / SIDE - 1;
            int left = 0;
            if (u * u + v * v > 1)
                continue;
            for (int e = 0; e < 3; ++e) {
                const double *a = corner[e], *b = corner[(e + 1) % 3];
                left += (b[0] - a[0]) * (radius * v - a[1]) - (b[1] - a[1]) * (x + radius * u - a[0]) > 0;
            }
            inside += left == 0 || left == 3;
            ++all;
        }
        ck_assert_double_eq_tol(lc_disk_polygon_share((const double(*)[2])corner, 3, x, 0, radius),
                                inside / (double)all, 0.01);
    }
}
END_TEST

/* Mutants of the host's lens: a camera that draws its own point of the lens, through the same point of the plane that is sharp. */
enum { RIGHT_LENS, RADIUS_IS_U, SQUARE_LENS, WIDE_LENS, SHARP_EVERYWHERE };

static lc_rgb through(int lens, const lc_scene *scene, const lc_ray *ray, const lc_hit *first,
                      const lc_options *options, lc_sampler *sampler)
{
    const lc_camera_desc *camera = &lc_scene_description(scene)->camera;
    lc_vec3 eye = lc_affine_point(&camera->to_world, lc_vec(0, 0, 0));
    lc_vec3 axis = lc_affine_vector(&camera->to_world, lc_vec(0, 0, 1));
    double depth = camera->focus_distance / lc_dot(ray->d, axis), u = lc_next(sampler), v = lc_next(sampler);
    double r = camera->aperture_radius * (lens == RADIUS_IS_U ? u : sqrt(u)) * (lens == WIDE_LENS ? 1.1 : 1);
    double x = r * cos(2 * LC_PI * v), y = r * sin(2 * LC_PI * v);
    if (lens == SQUARE_LENS)
        x = camera->aperture_radius * (2 * u - 1), y = camera->aperture_radius * (2 * v - 1);
    lc_vec3 sharp = lc_add(ray->o, lc_scale(depth, ray->d));
    if (lens == SHARP_EVERYWHERE)
        x = y = 0;
    lc_ray mine = {lc_add(eye, lc_affine_vector(&camera->to_world, lc_vec(x, y, 0))), {0, 0, 0}, 0};
    lc_hit hit;
    mine.d = lc_normalize(lc_sub(sharp, mine.o));
    lc_camera_see(scene, &mine, &hit);
    (void)first;
    for (const lc_estimator *const *e = lc_estimators; *e; ++e)
        if (strcmp((*e)->name, "light_direct") == 0)
            return (*e)->radiance(scene, &mine, &hit, options, sampler);
    return lc_black();
}

#define LENS(id, lens) \
    static lc_rgb radiance_##id(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, \
                                const lc_options *options, lc_sampler *sampler) \
    { \
        return through(lens, scene, ray, hit, options, sampler); \
    } \
    static const lc_estimator id = {LC_ABI,     #id, "", "", LC_DIFFUSE, LC_AREA | LC_POINT | LC_DIRECTIONAL, 1, \
                                    radiance_##id};
LENS(right_lens, RIGHT_LENS)
LENS(radius_is_u, RADIUS_IS_U)
LENS(square_lens, SQUARE_LENS)
LENS(wide_lens, WIDE_LENS)
LENS(sharp_everywhere, SHARP_EVERYWHERE)

static lc_status verdict_of(const lc_estimator *estimator, const char *scene, char reason[1024])
{
    lc_verify_options options;
    lc_report report;
    lc_verify_options_init(&options);
    options.estimator = estimator;
    options.check = "effects";
    options.scene = scene;
    ck_assert_msg(lc_verify(&report, &options, lc_scene_open, &err) == LC_OK, "%s", err.text);
    ck_assert_int_eq(report.count, 1);
    lc_status status = lc_report_status(&report);
    snprintf(reason, 1024, "%s", report.rows[0].reason);
    lc_report_release(&report);
    return status;
}

START_TEST(wrong_lenses_are_caught)
{
    static const lc_estimator *const wrong[] = {&radius_is_u, &square_lens, &wide_lens, &sharp_everywhere};
    char reason[1024];
    ck_assert_msg(verdict_of(&right_lens, "lens_edge", reason) == LC_OK, "%s", reason);
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; ++i)
        ck_assert_msg(verdict_of(wrong[i], "lens_edge", reason) == LC_WRONG, "%s survives: %s", wrong[i]->name, reason);
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

/* The host's directions, weighed by its density, give the albedo of the cubature: six standard errors. */
START_TEST(host_samples_by_its_density)
{
    enum { N = 4096 };
    static const double alphas[] = {0.1, 0.3, 0.6, 1}, cosines[] = {1, 0.5, 0.2};
    for (int i = 0; i < 12; ++i) {
        lc_scene_desc desc;
        double alpha = alphas[i / 3], cosine = cosines[i % 3], albedo, sum = 0, squares = 0;
        lc_scene_desc_init(&desc);
        int material = add_diffuse(&desc, 0);
        desc.materials[material].side[0].glossy = lc_color(1, 1, 1);
        desc.materials[material].side[0].alpha = alpha;
        add_shape(&desc, LC_RECTANGLE, lc_affine_identity());
        lc_scene *scene = build_scene(&desc);
        lc_vec3 wo = lc_vec(sqrt(1 - cosine * cosine), 0, cosine);
        lc_hit hit = see(scene, wo, lc_neg(wo));
        for (uint32_t k = 0; k < N; ++k) {
            lc_sampler sampler;
            lc_scatter s;
            lc_sampler_start(&sampler, 7, 1, 0, k);
            if (!lc_bsdf_sample(scene, &hit, &sampler, &s))
                continue;
            double weight = s.value.g * fmax(0, s.wi.z) / s.pdf;
            sum += weight / N;
            squares += weight * weight / N;
        }
        ck_assert_int_eq(lc_ggx_albedo(&albedo, cosine, alpha, &err), LC_OK);
        double sigma = sqrt(fmax(0, squares - sum * sum) / N);
        ck_assert_msg(fabs(sum - albedo) < 6 * sigma + 1e-6, "alpha %g, cosine %g: %g +- %g, expected %g", alpha, cosine,
                      sum, sigma, albedo);
        lc_scene_free(scene);
    }
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
    tcase_add_test(tc, disk_share_has_its_closed_forms);
    tcase_add_test(tc, disk_share_of_any_triangle);
    tcase_add_test(tc, wrong_lenses_are_caught);
    tcase_add_test(tc, albedo_has_its_closed_form);
    tcase_add_test(tc, albedo_is_the_integral_of_the_value);
    tcase_add_test(tc, series_follow_the_albedo);
    tcase_add_test(tc, host_has_the_value_of_the_paper);
    tcase_add_test(tc, host_samples_by_its_density);
    tcase_add_test(tc, roughness_outside_its_range_is_refused);
    suite_add_tcase(suite, tc);
    return suite;
}
