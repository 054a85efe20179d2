/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * POV-Ray as a renderer under test, through its adapter: images of different seeds are different, and their mean is ours. And
 * scenes that were altered by hand, in POV-Ray's own language, are found.
 * Where there is no POV-Ray the tests pass; LIGHTCHECK is the program.
 */
#include "verify/tests/tests.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "estimators/registry.h"
#include "io/scene_read.h"
#include "verify/judge/judge.h"
#include "verify/renderers/adapter.h"

enum { SIDE = 8, FLOATS = 3 * SIDE * SIDE, IMAGES = 32, OURS = 16384 };

static lc_error err;

/* The adapter, where it can be tried. */
static int open_adapter(lc_adapter *adapter)
{
    char here[2048], path[4096];
    const char *program = getenv("LIGHTCHECK");
    if (!lc_program_find(path, "povray"))
        return 0;
    ck_assert_ptr_nonnull(getcwd(here, sizeof here));
    snprintf(path, sizeof path, "%s/%s", here, program ? program : "build/lightcheck");
    if (!program || program[0] != '/')
        ck_assert_int_eq(setenv("LIGHTCHECK", path, 1), 0);
    ck_assert_msg(lc_adapter_open(adapter, "verify/renderers/povray.sh", 300, &err) == LC_OK, "%s", err.text);
    return 1;
}

static void read_scene(lc_scene_desc *desc, const char *name)
{
    ck_assert_int_eq(lc_scene_describe(desc, name, &err), LC_OK);
    desc->width = desc->height = SIDE;
}

static double mean_of(const float *image)
{
    double sum = 0;
    for (int i = 0; i < FLOATS; ++i)
        sum += (double)image[i] / FLOATS;
    return sum;
}

/* Mean of our image and its standard error. */
static double our_mean(double *error, const lc_scene_desc *desc, const char *estimator, int bounces)
{
    lc_scene *scene;
    lc_film *film;
    double sum = 0, variance = 0;
    const lc_estimator *const *e = lc_estimators;
    lc_render_options options = {.max_bounces = bounces, .seed = 1, .arm = 1, .count = OURS, .threads = 2};
    while (strcmp((*e)->name, estimator) != 0)
        ++e;
    ck_assert_int_eq(lc_scene_build(&scene, desc, &err), LC_OK);
    ck_assert_int_eq(lc_film_create(&film, SIDE, SIDE, &err), LC_OK);
    ck_assert_int_eq(lc_render(film, scene, *e, &options, &err), LC_OK);
    for (int i = 0; i < SIDE * SIDE; ++i)
        for (int c = 0; c < 3; ++c) {
            sum += film->pixels[i].c[c].mean / FLOATS;
            variance += 3 * lc_pixel_variance(&film->pixels[i], c) / FLOATS / FLOATS; /* at most: channels move together */
        }
    *error = sqrt(variance);
    lc_film_free(film);
    lc_scene_free(scene);
    return sum;
}

/* Each kind of lamp that is drawn, lights without area, and a chain of glass. */
static const struct {
    const char *scene, *estimator;
    int bounces;
    double power; /* six standard errors over the mean, at most */
} cases[] = {
    {"plane_rectangle", "light_direct", 1, 0.02}, {"plane_disk", "light_direct", 1, 0.02},
    {"plane_sphere", "light_direct", 1, 0.08},    {"plane_cube", "light_direct", 1, 0.08},
    {"mixed_lights", "light_direct", 1, 0.04},    {"cornell", "light_direct", 1, 0.25}, /* 64 pixels: the grid moves over the lamp */
    {"cornell", "light_direct", 0, 0.5},         {"glass_slab", "dielectric", 8, 0.04},
};

START_TEST(the_mean_over_seeds_is_ours)
{
    lc_adapter a;
    lc_scene_desc desc;
    double mean = 0, squares = 0, error;
    if (!open_adapter(&a))
        return;
    read_scene(&desc, cases[_i].scene);
    float *rgb = malloc(IMAGES * FLOATS * sizeof *rgb);
    ck_assert_ptr_nonnull(rgb);
    lc_adapter_job job = {&desc, cases[_i].bounces, 16, 100, IMAGES};
    ck_assert_msg(lc_adapter_render(rgb, &a, &job, &err) == LC_OK, "%s", err.text);
    for (int i = 0; i < IMAGES; ++i) {
        double delta = mean_of(rgb + i * FLOATS) - mean;
        mean += delta / (i + 1);
        squares += delta * (mean_of(rgb + i * FLOATS) - mean);
    }
    double ours = our_mean(&error, &desc, cases[_i].estimator, cases[_i].bounces);
    error = hypot(error, sqrt(squares / (IMAGES * (IMAGES - 1))));
    ck_assert_msg(fabs(mean - ours) < 6 * error, "%g, expected %g +- %g", mean, ours, error);
    ck_assert_double_lt(6 * error, cases[_i].power * ours);
    ck_assert_double_gt(squares, 0);
    free(rgb);
    lc_scene_desc_release(&desc);
}
END_TEST

START_TEST(a_seed_gives_the_same_image_again)
{
    lc_adapter a;
    lc_scene_desc desc;
    float rgb[2][FLOATS];
    if (!open_adapter(&a))
        return;
    read_scene(&desc, "two_lights");
    for (int i = 0; i < 2; ++i) {
        lc_adapter_job job = {&desc, 1, 4, 7, 1};
        ck_assert_msg(lc_adapter_render(rgb[i], &a, &job, &err) == LC_OK, "%s", err.text);
    }
    ck_assert_mem_eq(rgb[0], rgb[1], sizeof rgb[0]);
    lc_scene_desc_release(&desc);
}
END_TEST

static const struct {
    const char *scene, *reason;
    int bounces;
} refused[] = {
    {"sky", "sky", 1},
    {"bright_room", "directions that no seed changes", 3},
    {"cornell_mirror", "off a mirror", 1},
    {"motion_lamp", "moves", 1},
};

START_TEST(what_it_cannot_do_is_refused)
{
    lc_adapter a;
    lc_scene_desc desc;
    float rgb[FLOATS];
    if (!open_adapter(&a))
        return;
    read_scene(&desc, refused[_i].scene);
    lc_adapter_job job = {&desc, refused[_i].bounces, 1, 1, 1};
    ck_assert_int_eq(lc_adapter_render(rgb, &a, &job, &err), LC_BAD_INPUT);
    ck_assert_msg(strstr(err.text, refused[_i].reason) != NULL, "%s", err.text);
    lc_scene_desc_release(&desc);
}
END_TEST

/* ---- altered by hand --------------------------------------------------------------------------------------------- */

/* `edit`: what sed does to the file that POV-Ray is about to read. By the adapter, or live beside light_direct. */
static const struct {
    const char *scene, *edit;
    int by_adapter;
    lc_row_verdict verdict;
} by_hand[] = {
    {"plane_rectangle", "", 0, LC_ROW_PASS},
    {"plane_rectangle", "s/^#declare C = rgb.*/&\\n#declare C = 1.01 * C;/", 0, LC_ROW_FAIL},
    {"plane_point", "s/^light_source {/#declare unused = 1;\\n&/", 0, LC_ROW_PASS},
    {"cornell", "/^box/,/^}/s/, -42.24, 40.96,/, -39.68, 40.96,/", 1, LC_ROW_FAIL}, /* 4 cm: 2% of the room */
};

extern const lc_estimator lc_estimator_light_direct;

/* A program povray that edits, first in the PATH. */
START_TEST(scenes_altered_by_hand_fail)
{
    char real[LC_PROGRAM_PATH], folder[] = "/tmp/lc-altered-XXXXXX", path[4096], wrapper[64];
    const char *before = getenv("PATH");
    lc_adapter adapter;
    lc_verify_options options;
    lc_report report;
    if (!lc_program_find(real, "povray") || !open_adapter(&adapter))
        return;
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(wrapper, sizeof wrapper, "%s/povray", folder);
    FILE *file = fopen(wrapper, "wb");
    ck_assert_ptr_nonnull(file);
    fprintf(file, "#!/bin/sh\n[ ! -e scene.pov ] || { cp scene.pov old; sed -i '%s' scene.pov; } || exit\n"
                  "[ ! -e old ] || [ -z '%s' ] || ! cmp -s old scene.pov || { echo nothing was altered; exit 1; }\n"
                  "exec %s \"$@\"\n", by_hand[_i].edit, by_hand[_i].edit, real);
    ck_assert_int_eq(fclose(file), 0);
    ck_assert_int_eq(chmod(wrapper, 0700), 0);
    snprintf(path, sizeof path, "%s:%s", folder, before ? before : "/usr/bin:/bin");
    ck_assert_int_eq(setenv("PATH", path, 1), 0);

    lc_verify_options_init(&options);
    if (by_hand[_i].by_adapter) {
        options.renderer = &adapter;
        options.estimator = &adapter.estimator;
    } else {
        options.estimator = &lc_estimator_light_direct;
    }
    options.check = "povray";
    options.scene = by_hand[_i].scene;
    lc_status status = lc_verify(&report, &options, lc_scene_open, &err);
    ck_assert_msg(status == LC_OK, "%s", err.text);
    ck_assert_int_ge(report.count, 1);
    ck_assert_msg(report.rows[0].verdict == by_hand[_i].verdict, "%s", report.rows[0].reason);
    lc_report_release(&report);
    ck_assert_int_eq(unlink(wrapper), 0);
    ck_assert_int_eq(rmdir(folder), 0);
}
END_TEST

Suite *lc_suite_pov_sample(void)
{
    Suite *suite = suite_create("pov_sample");
    TCase *tc = tcase_create("pov_sample");
    tcase_set_timeout(tc, 60);
    tcase_add_test(tc, a_seed_gives_the_same_image_again);
    tcase_add_loop_test(tc, what_it_cannot_do_is_refused, 0, sizeof refused / sizeof refused[0]);
    suite_add_tcase(suite, tc);
    tc = tcase_create("images");
    tcase_set_tags(tc, "long"); /* many images of POV-Ray, no code that other tests do not run */
    tcase_set_timeout(tc, 120);
    tcase_add_loop_test(tc, the_mean_over_seeds_is_ours, 0, sizeof cases / sizeof cases[0]);
    suite_add_tcase(suite, tc);
    tc = tcase_create("by_hand");
    tcase_set_tags(tc, "long");
    tcase_set_timeout(tc, 300);
    tcase_add_loop_test(tc, scenes_altered_by_hand_fail, 0, sizeof by_hand / sizeof by_hand[0]);
    suite_add_tcase(suite, tc);
    return suite;
}
