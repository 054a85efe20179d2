/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How small a bug is found, and at what cost: light_direct on the Cornell box in its own 64x64 pixels, with a bias put
 * in. Two cores trace 8 to 15 million of these paths a second; the tests below allow for 7.5. */
#include <stdlib.h>
#include <string.h>

#include "io/scene_read.h"
#include "estimators/registry.h"
#include "verify/judge/judge.h"
#include "verify/tests/tests.h"

static const double PATHS_IN_TWO_SECONDS = 15e6;

/* ---- estimators that are a little wrong -------------------------------------------------------------------------- */

static const lc_estimator *right;

static lc_rgb scaled(double factor, const lc_scene *scene, const lc_ray *ray, const lc_hit *hit,
                     const lc_options *options, lc_sampler *sampler)
{
    return lc_rgb_scale(factor, right->radiance(scene, ray, hit, options, sampler));
}

static lc_rgb one_percent(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                          lc_sampler *sampler)
{
    return scaled(1.01, scene, ray, hit, options, sampler);
}

static lc_rgb fifth_of_a_percent(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit,
                                 const lc_options *options, lc_sampler *sampler)
{
    return scaled(0.998, scene, ray, hit, options, sampler);
}

enum { TILE_X = 24, TILE_Y = 48 };

/* 10% too much in one tile of 8x8 pixels, 0.1% of the image. */
static lc_rgb one_tile(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    int x = (int)(sampler->pixel % 64), y = (int)(sampler->pixel / 64);
    int is_there = x / 8 == TILE_X / 8 && y / 8 == TILE_Y / 8;
    return scaled(is_there ? 1.1 : 1, scene, ray, hit, options, sampler);
}

/* Puts it to the test and returns the row of that check, the only one. */
static lc_row verdict_of(lc_radiance_fn *radiance, const char *check, const char *suite)
{
    lc_verify_options options;
    lc_report report;
    lc_error err = {""};
    for (const lc_estimator *const *e = lc_estimators; *e; ++e)
        if (strcmp((*e)->name, "light_direct") == 0)
            right = *e;
    lc_estimator estimator = *right;
    estimator.name = "mine";
    estimator.radiance = radiance;
    lc_verify_options_init(&options);
    options.suite = lc_suite_find(suite);
    options.estimator = &estimator;
    options.check = check;
    options.scene = "cornell";
    ck_assert_msg(lc_verify(&report, &options, lc_scene_open, &err) == LC_OK, "%s", err.text);
    ck_assert_int_eq(report.count, 1);
    ck_assert_msg((double)report.paths < 4 * PATHS_IN_TWO_SECONDS, "%g paths", (double)report.paths);
    lc_row row = report.rows[0];
    lc_report_release(&report);
    return row;
}

/* ---- found -------------------------------------------------------------------------------------------------------- */

/* The pilot's 64 samples a pixel, unused, would be 0.3 million more. */
START_TEST(one_percent_is_found_within_two_seconds)
{
    static const char *const checks[] = {"analytic", "equality"};
    for (int i = 0; i < 2; ++i) {
        lc_row row = verdict_of(one_percent, checks[i], "quick");
        double arms = i == 0 ? 1 : 2; /* the hub is rendered as well */
        ck_assert_int_eq(row.verdict, LC_ROW_FAIL);
        ck_assert_msg(arms * (double)row.paths < PATHS_IN_TWO_SECONDS, "%s: %g paths", checks[i],
                      arms * (double)row.paths);
        ck_assert_msg(row.low > 1 && row.ratio > 1.005 && row.ratio < 1.015, "%s: %g", checks[i], row.ratio);
    }
}
END_TEST

START_TEST(a_fifth_of_a_percent_is_found_by_the_full_suite)
{
    lc_row row = verdict_of(fifth_of_a_percent, "analytic", "full");
    ck_assert_int_eq(row.verdict, LC_ROW_FAIL);
    ck_assert_msg(row.high < 1 && row.ratio > 0.997 && row.ratio < 0.999, "%g", row.ratio);
}
END_TEST

START_TEST(one_wrong_tile_is_found_and_named)
{
    lc_row row = verdict_of(one_tile, "analytic", "quick");
    ck_assert_int_eq(row.verdict, LC_ROW_FAIL);
    ck_assert_msg(row.tile_x == TILE_X && row.tile_y == TILE_Y && row.tile_width == 8 && row.tile_height == 8,
                  "%dx%d at %d,%d", row.tile_width, row.tile_height, row.tile_x, row.tile_y);
    ck_assert_double_eq_tol(row.tile_ratio, 1.1, 0.03);
    ck_assert_msg(strstr(row.reason, "8x8 pixels at 24,48") != NULL, "%s", row.reason);
    ck_assert((double)row.paths < PATHS_IN_TWO_SECONDS);
}
END_TEST

/* The same harness, the same cost, nothing wrong: no FAIL. */
START_TEST(without_a_bias_nothing_is_found)
{
    for (const lc_estimator *const *e = lc_estimators; *e; ++e)
        if (strcmp((*e)->name, "light_direct") == 0)
            right = *e;
    ck_assert_int_eq(verdict_of(right->radiance, "analytic", "quick").verdict, LC_ROW_PASS);
}
END_TEST

Suite *lc_suite_sensitivity(void)
{
    Suite *suite = suite_create("sensitivity");
    TCase *tc = tcase_create("core");
    tcase_set_tags(tc, "long"); /* many samples, no code that other tests do not run */
    tcase_set_timeout(tc, 300);
    tcase_add_test(tc, one_percent_is_found_within_two_seconds);
    tcase_add_test(tc, a_fifth_of_a_percent_is_found_by_the_full_suite);
    tcase_add_test(tc, one_wrong_tile_is_found_and_named);
    tcase_add_test(tc, without_a_bias_nothing_is_found);
    suite_add_tcase(suite, tc);
    return suite;
}
