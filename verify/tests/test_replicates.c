/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Images that were rendered before: right ones pass and wrong ones fail, more of them are asked where 256 do not decide, and what is no
 * image of its own counts for nothing.
 */
#include "verify/tests/tests.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "estimators/registry.h"
#include "io/exr.h"
#include "io/scene_read.h"
#include "verify/judge/judge.h"
#include "verify/renderers/replicates.h"

static lc_error err;
static char folder[64];

static void shell(const char *line)
{
    char command[1024];
    snprintf(command, sizeof command, "cd %s && %s", folder, line);
    ck_assert_int_eq(system(command), 0);
}

static void set_up(void)
{
    strcpy(folder, "/tmp/lightcheck-replicates-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
    shell("mkdir plane_rectangle.1");
}

static void tear_down(void) { shell("rm -rf \"$PWD\""); }

static const lc_estimator *find(const char *name)
{
    const lc_estimator *const *e = lc_estimators;
    while (strcmp((*e)->name, name) != 0)
        ++e;
    return *e;
}

/* Images of plane_rectangle, of a seed each, whose light is `factor` times what it should be. */
static void render(int first, int count, int samples, double factor)
{
    lc_scene *scene;
    ck_assert_int_eq(lc_scene_open(&scene, "plane_rectangle", &err), LC_OK);
    const lc_scene_desc *d = lc_scene_description(scene);
    for (int k = first; k < first + count; ++k) {
        char path[128];
        lc_film *film;
        lc_render_options options = {.max_bounces = 1, .seed = (uint64_t)k, .arm = 1, .count = (uint64_t)samples, .threads = 1};
        ck_assert_int_eq(lc_film_create(&film, d->width, d->height, &err), LC_OK);
        ck_assert_int_eq(lc_render(film, scene, find("light_direct"), &options, &err), LC_OK);
        for (int i = 0; i < d->width * d->height; ++i)
            for (int c = 0; c < 3; ++c)
                film->pixels[i].c[c].mean *= factor;
        snprintf(path, sizeof path, "%s/plane_rectangle.1/%04d.exr", folder, k);
        ck_assert_msg(lc_exr_write(path, film, &err) == LC_OK, "%s", err.text);
        lc_film_free(film);
    }
    lc_scene_free(scene);
}

static void verify(lc_report *report, double margin)
{
    static lc_adapter a;
    lc_verify_options options;
    ck_assert_msg(lc_adapter_open(&a, folder, 60, &err) == LC_OK, "%s", err.text);
    lc_verify_options_init(&options);
    options.renderer = &a;
    options.estimator = &a.estimator;
    options.check = "analytic";
    options.margin = margin;
    ck_assert_msg(lc_verify(report, &options, lc_scene_open, &err) == LC_OK, "%s", err.text);
}

static void expect_row(lc_row_verdict verdict, double margin, uint64_t images)
{
    lc_report report;
    verify(&report, margin);
    ck_assert_int_eq(report.count, 1); /* no other scene has images */
    ck_assert_str_eq(report.rows[0].scene, "plane_rectangle");
    ck_assert_msg(report.rows[0].verdict == verdict, "%s", report.rows[0].reason);
    ck_assert_uint_eq(report.rows[0].samples, images);
    lc_report_release(&report);
}

START_TEST(right_images_pass_and_wrong_ones_fail)
{
    render(1, 320, 4, 1);
    expect_row(LC_ROW_PASS, 0, 256);
    shell("rm */*.exr");
    render(1, 320, 4, 1.01);
    expect_row(LC_ROW_FAIL, 0, 256);
}
END_TEST

/* 64 of them are the pilot's; what is not a whole block of 64 is not judged. */
START_TEST(more_are_asked_where_they_are_there)
{
    render(1, 383, 1, 1);
    expect_row(LC_ROW_UNDECIDED, 1e-4, 256);
    render(384, 1, 1, 1);
    expect_row(LC_ROW_UNDECIDED, 1e-4, 320);
    render(385, 800, 1, 1);
    expect_row(LC_ROW_UNDECIDED, 1e-4, 1024);
}
END_TEST

static void expect_note(const char *words)
{
    lc_report report;
    verify(&report, 0);
    ck_assert_int_eq(report.count, 0);
    ck_assert_int_eq(report.note_count, 1);
    ck_assert_msg(strstr(report.notes[0].reason, words) != NULL, "%s", report.notes[0].reason);
    lc_report_release(&report);
}

START_TEST(what_cannot_be_judged_is_said)
{
    render(1, 319, 1, 1);
    expect_note("319 images in plane_rectangle.1/, at least 320 are needed");
    shell("ln -s 0001.exr plane_rectangle.1/link.exr; cp plane_rectangle.1/0001.exr plane_rectangle.1/.hidden.exr; "
          "cp plane_rectangle.1/0001.exr plane_rectangle.1/1.png");
    expect_note("319 images in plane_rectangle.1/, at least 320 are needed");
    shell("cp plane_rectangle.1/0007.exr plane_rectangle.1/copy.exr");
    expect_note("plane_rectangle.1: 0007.exr and copy.exr are the same image");
    shell("head -c 500 plane_rectangle.1/0007.exr > plane_rectangle.1/copy.exr");
    expect_note("plane_rectangle.1/copy.exr: ");
}
END_TEST

START_TEST(images_are_read_in_the_order_of_their_names)
{
    lc_adapter a;
    lc_scene_desc desc;
    render(1, 3, 1, 1);
    ck_assert_int_eq(lc_scene_describe(&desc, "plane_rectangle", &err), LC_OK);
    size_t floats = 3 * (size_t)desc.width * (size_t)desc.height;
    float *all = malloc(3 * floats * sizeof *all), *one = malloc(floats * sizeof *one);
    ck_assert(all && one);
    ck_assert_int_eq(lc_adapter_open(&a, folder, 60, &err), LC_OK);
    ck_assert_int_eq(lc_replicates_count(&a, &desc, 1), 3);
    lc_adapter_job job = {&desc, 1, 1, 0, 3};
    ck_assert_msg(lc_adapter_render(all, &a, &job, &err) == LC_OK, "%s", err.text);
    for (int k = 2; k >= 0; --k) { /* each is its own, whatever was read before */
        job.seed = (uint32_t)k;
        job.count = 1;
        ck_assert_int_eq(lc_adapter_render(one, &a, &job, &err), LC_OK);
        ck_assert_mem_eq(one, all + (size_t)k * floats, floats * sizeof *one);
    }
    ck_assert_mem_ne(all, all + floats, floats * sizeof *all);
    job.seed = 2;
    job.count = 2;
    ck_assert_int_eq(lc_adapter_render(all, &a, &job, &err), LC_BAD_INPUT);
    job.bounces = 2;
    ck_assert_int_eq(lc_adapter_render(all, &a, &job, &err), LC_BAD_INPUT);
    ck_assert_int_eq(lc_replicates_count(&a, &desc, 2), 0);
    ck_assert(lc_replicates_show(&a, "plane_rectangle") && !lc_replicates_show(&a, "plane") && !lc_replicates_show(&a, "plane_rectangle.1"));
    free(all);
    free(one);
    lc_scene_desc_release(&desc);
}
END_TEST

START_TEST(a_folder_without_images_is_bad_input)
{
    lc_adapter a;
    ck_assert_int_eq(lc_adapter_open(&a, folder, 60, &err), LC_BAD_INPUT);
    ck_assert_msg(strstr(err.text, "expected folders SCENE.BOUNCES") != NULL, "%s", err.text);
}
END_TEST

Suite *lc_suite_replicates(void)
{
    Suite *suite = suite_create("replicates");
    TCase *tc = tcase_create("replicates");
    tcase_add_checked_fixture(tc, set_up, tear_down);
    tcase_set_timeout(tc, 60);
    tcase_add_test(tc, right_images_pass_and_wrong_ones_fail);
    tcase_add_test(tc, more_are_asked_where_they_are_there);
    tcase_add_test(tc, what_cannot_be_judged_is_said);
    tcase_add_test(tc, images_are_read_in_the_order_of_their_names);
    tcase_add_test(tc, a_folder_without_images_is_bad_input);
    suite_add_tcase(suite, tc);
    return suite;
}
