/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What next events and weights are made of: densities of light sampling; and what every path keeps, bounce by bounce. */
#include "verify/tests/tests.h"

#include <math.h>
#include <stdio.h>

#include "estimators/registry.h"
#include "io/scene_read.h"
#include "verify/analytic/analytic.h"
#include "verify/tests/scene_help.h"

static lc_scene *load(const char *name)
{
    lc_scene_desc desc;
    lc_error err = {""};
    ck_assert_msg(lc_scene_describe(&desc, name, &err) == LC_OK, "%s", err.text);
    return build_scene(&desc);
}

/* From wherever a light sample is seen, a ray to it finds the same density. */
START_TEST(a_hit_has_the_density_of_its_sample)
{
    lc_scene *scene = load("five_lights");
    lc_sampler sampler;
    lc_sampler_start(&sampler, 1, 2, 3, 4);
    int seen = 0;
    for (int i = 0; i < 2000; ++i) {
        double x = 16 * lc_next(&sampler), y = 16 * lc_next(&sampler);
        lc_ray ray = lc_camera_ray(&lc_scene_description(scene)->camera, 16, 16, x, y);
        lc_hit hit, next;
        lc_light_sample light;
        lc_camera_see(scene, &ray, &hit);
        if (!hit.valid || lc_light_pdf_area(scene, &hit) > 0)
            continue;
        lc_light_sample_one(scene, i % lc_light_count(scene), &hit, &sampler, &light);
        if (-lc_dot(light.n, light.wi) < 1e-3 || !lc_visible(scene, &hit, &light))
            continue;
        ck_assert(lc_trace(scene, &hit, light.wi, &next));
        if (next.part != light.part)
            continue; /* by a hair past an edge */
        ck_assert_double_eq_tol(lc_light_pdf_area(scene, &next), light.pdf_area, 1e-12 * light.pdf_area);
        ++seen;
    }
    ck_assert_int_gt(seen, 300);
    lc_hit miss = {0};
    ck_assert(lc_light_pdf_area(scene, &miss) == 0);
    lc_scene_free(scene);
}
END_TEST

/* The triangle's solid angle of Van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30(2), 1983. */
static double triangle_solid_angle(lc_vec3 a, lc_vec3 b, lc_vec3 c)
{
    double la = lc_length(a), lb = lc_length(b), lc = lc_length(c);
    double y = fabs(lc_dot(a, lc_cross(b, c)));
    double x = la * lb * lc + lc_dot(a, b) * lc + lc_dot(a, c) * lb + lc_dot(b, c) * la;
    return 2 * atan2(y, x);
}

/* The mean of d^2 / (cos_light pdf_solid) is the area that is seen. Returns 1 / pdf_solid, which must not vary. */
static double ck_area(const lc_scene *scene, lc_vec3 p, double expected)
{
    lc_hit hit = {.valid = 1, .p = p, .n = {0, 0, 1}, .wo = {0, 0, 1}, .shape = -1, .part = -1};
    lc_sampler sampler;
    lc_sampler_start(&sampler, 1, 2, 3, 4);
    double sum = 0, squares = 0, solid = 0;
    enum { N = 40000 };
    for (int i = 0; i < N; ++i) {
        lc_light_sample light;
        lc_light_sample_solid(scene, 0, &hit, &sampler, &light);
        ck_assert_double_eq_tol(lc_length(light.wi), 1, 1e-12);
        lc_vec3 q = lc_add(p, lc_scale(light.distance, light.wi));
        ck_assert_double_lt(lc_length(lc_sub(q, light.p)), 1e-7 * light.distance);
        double area = light.distance * light.distance / (fabs(lc_dot(light.n, light.wi)) * light.pdf_solid);
        sum += area / N;
        squares += area * area / N;
        ck_assert(i == 0 || fabs(solid * light.pdf_solid - 1) < 1e-12);
        solid = 1 / light.pdf_solid;
    }
    double sigma = sqrt(fmax(0, squares - sum * sum) / N); /* of a well-behaved mean: no pole, the lamps are far enough */
    ck_assert_msg(fabs(sum - expected) < 6 * sigma + 1e-9 * expected, "area %g +- %g, expected %g", sum, sigma, expected);
    return solid;
}

START_TEST(rectangles_have_their_solid_angle)
{
    uint64_t state = 7;
    for (int i = 0; i < 20; ++i) {
        lc_scene_desc desc;
        lc_scene_desc_init(&desc);
        lc_shape_desc *lamp = add_lamp(&desc, LC_RECTANGLE, pose_rotate(next_direction(&state), i), lc_color(1, 1, 1));
        double a = next_within(&state, 0.2, 1), b = next_within(&state, 0.2, 1);
        lc_affine size = pose_scale(a, b, 1);
        lamp->to_world = lc_affine_multiply(&lamp->to_world, &size);
        lc_vec3 p = lc_scale(next_within(&state, 1.6, 3), next_direction(&state)), corner[4];
        for (int k = 0; k < 4; ++k)
            corner[k] = lc_sub(lc_affine_point(&lamp->to_world, lc_vec(k % 2 ? 1 : -1, k / 2 ? 1 : -1, 0)), p);
        double solid = triangle_solid_angle(corner[0], corner[1], corner[2]) +
                       triangle_solid_angle(corner[3], corner[1], corner[2]);
        if (solid < 0.05) { /* seen from its edge */
            lc_scene_desc_release(&desc);
            continue;
        }
        lc_scene *scene = build_scene(&desc);
        ck_assert_double_eq_tol(ck_area(scene, p, 4 * a * b), solid, 1e-9 * solid);
        lc_scene_free(scene);
    }
}
END_TEST

START_TEST(spheres_have_their_solid_angle)
{
    static const double distances[] = {0, 0.5, 0.9, 1.5, 3, 50};
    for (int i = 0; i < 6; ++i) {
        lc_scene_desc desc;
        lc_scene_desc_init(&desc);
        add_lamp(&desc, LC_SPHERE, pose_translate(0.1, -0.2, 0.3), lc_color(1, 1, 1));
        lc_scene *scene = build_scene(&desc);
        double d = distances[i], cos_most = d > 1 ? sqrt(1 - 1 / (d * d)) : -1;
        double area = d > 1 ? 2 * LC_PI * (1 - 1 / d) : 4 * LC_PI; /* Archimedes: a cap, or all of it */
        lc_vec3 p = lc_add(lc_vec(0.1, -0.2, 0.3), lc_scale(d / 3, lc_vec(1, 2, -2)));
        double expected = 2 * LC_PI * (1 - cos_most), solid = ck_area(scene, p, area);
        ck_assert_double_eq_tol(solid, expected, 1e-9 * expected);
        lc_scene_free(scene);
    }
}
END_TEST

static lc_rgb sample_of(const lc_scene *scene, const lc_estimator *e, int low, int high, int i)
{
    lc_options bounces = {low, high};
    lc_sampler sampler;
    lc_hit hit;
    lc_sampler_start(&sampler, 5, 6, (uint32_t)i, 0);
    double x = 16 * lc_next(&sampler), y = 16 * lc_next(&sampler);
    lc_ray ray = lc_camera_ray(&lc_scene_description(scene)->camera, 16, 16, x, y);
    lc_camera_see(scene, &ray, &hit);
    lc_sampler_seek(&sampler, LC_DIMENSION_ESTIMATOR);
    return e->radiance(scene, &ray, &hit, &bounces, &sampler);
}

/* One stream taken apart bounce by bounce: where light is sampled, and where a path ends, is the same in all parts. */
START_TEST(many_bounces_add_up)
{
    static const char *const scenes[] = {"cornell", "mixed_lights", "cornell_glass", "sky", "bright_mirrors"};
    for (int s = 0; s < 5; ++s) {
        lc_scene *scene = load(scenes[s]);
        for (const lc_estimator *const *p = lc_estimators; *p; ++p) {
            if ((*p)->max_bounces < 6)
                continue;
            for (int i = 0; i < 500; ++i) {
                lc_rgb sum = lc_black(), whole = sample_of(scene, *p, 0, 6, i), tail = sample_of(scene, *p, 3, 6, i);
                for (int k = 0; k <= 6; ++k) {
                    sum = lc_rgb_add(sum, sample_of(scene, *p, k, k, i));
                    if (k == 2)
                        tail = lc_rgb_add(tail, sum);
                }
                ck_assert_msg(fabs(sum.g - whole.g) <= 1e-12 * whole.g, "%s on %s", (*p)->name, scenes[s]);
                ck_assert_msg(fabs(tail.g - whole.g) <= 1e-12 * whole.g, "%s on %s", (*p)->name, scenes[s]);
            }
        }
        lc_scene_free(scene);
    }
}
END_TEST

/* ---- Schlick's approximation -------------------------------------------------------------------------------------- */

/* Schlick, An inexpensive BRDF model for physically-based rendering, Computer Graphics Forum 13(3) 1994, eq. 15. */
static double schlick(double cos_i, double ior)
{
    double r0 = (ior - 1) / (ior + 1) * ((ior - 1) / (ior + 1));
    return r0 + (1 - r0) * pow(1 - cos_i, 5);
}

/* Of light from everywhere: the mean over cos^2, uniform in [0, 1]. */
static double mean_over_angles(double reflectance(double cos_i, double ior), double ior)
{
    double sum = 0;
    for (int i = 0; i < 20000; ++i)
        sum += reflectance(sqrt((i + 0.5) / 20000), ior) / 20000;
    return sum;
}

/* The table of docs/checks.md is what is measured here. */
START_TEST(schlicks_error_is_documented)
{
    char line[256];
    int rows = 0;
    FILE *f = fopen("docs/checks.md", "r");
    ck_assert_ptr_nonnull(f);
    while (fgets(line, sizeof line, f)) {
        double ior, angle = -1, exact, approximate, percent;
        if (sscanf(line, "| %lf | all | %lf | %lf | %lf%% |", &ior, &exact, &approximate, &percent) != 4 &&
            sscanf(line, "| %lf | %lf | %lf | %lf | %lf%% |", &ior, &angle, &exact, &approximate, &percent) != 5)
            continue;
        double c = cos(angle * LC_PI / 180);
        double is = angle < 0 ? mean_over_angles(lc_fresnel_dielectric, ior) : lc_fresnel_dielectric(c, ior);
        double says = angle < 0 ? mean_over_angles(schlick, ior) : schlick(c, ior);
        ck_assert_double_eq_tol(is, exact, 6e-6);
        ck_assert_double_eq_tol(says, approximate, 6e-6);
        ck_assert_double_eq_tol(100 * (says / is - 1), percent, 6e-3);
        ++rows;
    }
    fclose(f);
    ck_assert_int_eq(rows, 18);
}
END_TEST

Suite *lc_suite_nee(void)
{
    Suite *suite = suite_create("nee");
    TCase *tc = tcase_create("core");
    tcase_set_timeout(tc, 120);
    tcase_add_test(tc, a_hit_has_the_density_of_its_sample);
    tcase_add_test(tc, rectangles_have_their_solid_angle);
    tcase_add_test(tc, spheres_have_their_solid_angle);
    tcase_add_test(tc, many_bounces_add_up);
    tcase_add_test(tc, schlicks_error_is_documented);
    suite_add_tcase(suite, tc);
    return suite;
}
