/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a FAIL looks like: the files are there, whole, and the colour has the right sign in the right place. */
#include "verify/tests/tests.h"

#include <dirent.h>
#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "io/exr.h"
#include "verify/judge/judge.h"
#include "verify/mutants/registry.h"
#include "verify/tests/load_help.h"

enum { SIDE = 32, ZOOM = 8 };

static char folder[64];

static void make_folder(void)
{
    strcpy(folder, "/tmp/lightcheck-test-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
}

static int count_files(int remove)
{
    int count = 0;
    DIR *dir = opendir(folder);
    ck_assert_ptr_nonnull(dir);
    for (struct dirent *e = readdir(dir); e; e = readdir(dir)) {
        char path[512];
        if (e->d_name[0] == '.')
            continue;
        snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        ++count;
        if (remove)
            unlink(path);
    }
    closedir(dir);
    return count;
}

static void remove_folder(void)
{
    count_files(1);
    rmdir(folder);
}

static const char *picture_of(const lc_row *row, const char *ending)
{
    static char path[LC_MOST_PATH + 32];
    snprintf(path, sizeof path, "%s%s", row->pictures, ending);
    return path;
}

static lc_film *read_film(const lc_row *row, const char *ending)
{
    lc_film *film;
    lc_error err;
    ck_assert_msg(lc_exr_read(&film, picture_of(row, ending), &err) == LC_OK, "%s", err.text);
    return film;
}

/* Red, green and blue in the middle of a pixel of the image. */
static const unsigned char *color_at(const lc_row *row, const char *ending, int width, int zoom, int x, int y)
{
    static unsigned char pixels[3 * 512 * 512];
    png_image image;
    memset(&image, 0, sizeof image);
    image.version = PNG_IMAGE_VERSION;
    ck_assert_msg(png_image_begin_read_from_file(&image, picture_of(row, ending)), "%s", image.message);
    ck_assert_uint_eq(image.width, (unsigned)(width * zoom));
    ck_assert_uint_le(PNG_IMAGE_SIZE(image), sizeof pixels);
    image.format = PNG_FORMAT_RGB;
    ck_assert_msg(png_image_finish_read(&image, NULL, pixels, 0, NULL), "%s", image.message);
    return pixels + 3 * ((size_t)(y * zoom + zoom / 2) * (size_t)(width * zoom) + (size_t)(x * zoom + zoom / 2));
}

static int is_red(const unsigned char *c) { return c[0] > c[2] + 100; }
static int is_blue(const unsigned char *c) { return c[2] > c[0] + 100; }
static int is_white(const unsigned char *c) { return c[0] > 240 && c[1] > 240 && c[2] > 240; }

/* Pixels of mean 1 and 1000 samples of standard deviation 0.1, whose noise is then 0.003. */
static lc_film *calm_film(void)
{
    lc_film *film;
    ck_assert_int_eq(lc_film_create(&film, SIDE, SIDE, NULL), LC_OK);
    for (size_t i = 0; i < SIDE * SIDE; ++i) {
        film->pixels[i].n = 1000;
        for (int c = 0; c < 3; ++c) {
            film->pixels[i].c[c].mean = 1;
            film->pixels[i].c[c].m2 = 0.01 * 999;
        }
    }
    return film;
}

static lc_pixel *pixel_at(lc_film *film, int x, int y) { return &film->pixels[y * SIDE + x]; }

/* Too bright in one place, too dark in another, each in one channel; a third difference lies where nothing is judged. */
START_TEST(colour_has_sign_and_place)
{
    lc_film *is = calm_film();
    double *expected = malloc(sizeof *expected * 3 * SIDE * SIDE);
    unsigned char *skip = calloc(SIDE * SIDE, 1);
    ck_assert(expected && skip);
    for (size_t i = 0; i < 3 * SIDE * SIDE; ++i)
        expected[i] = 1;
    pixel_at(is, 20, 3)->c[1].mean = 1.5;
    pixel_at(is, 5, 30)->c[1].mean = 0.5;
    pixel_at(is, 9, 9)->c[1].mean = 7;
    pixel_at(is, 2, 2)->c[0].mean = 7; /* another channel's */
    skip[9 * SIDE + 9] = 1;
    lc_row row = {.check = "analytic", .scene = "a/b c", .estimator = "x", .channel = 1, .min_bounces = 1, .max_bounces = 5};
    lc_exhibit exhibit = {is, NULL, expected, NULL, skip};
    lc_error err;
    ck_assert_msg(lc_report_pictures(&row, folder, 7, &exhibit, &err) == LC_OK, "%s", err.text);
    ck_assert_str_eq(row.pictures + strlen(folder), "/007_analytic_a_b_c_x_1-5");
    ck_assert_int_eq(count_files(0), 6);

    ck_assert(is_red(color_at(&row, ".difference.png", SIDE, ZOOM, 20, 3)));
    ck_assert(is_blue(color_at(&row, ".difference.png", SIDE, ZOOM, 5, 30)));
    ck_assert(is_white(color_at(&row, ".difference.png", SIDE, ZOOM, 9, 9)));
    ck_assert(is_white(color_at(&row, ".difference.png", SIDE, ZOOM, 2, 2)));
    ck_assert(is_white(color_at(&row, ".difference.png", SIDE, ZOOM, 3, 20)));
    const unsigned char *c = color_at(&row, ".is.png", SIDE, ZOOM, 20, 3);
    ck_assert(c[1] > c[0] + 10); /* greener; the same exposure for both: */
    c = color_at(&row, ".is.png", SIDE, ZOOM, 0, 0);
    int grey = c[0];
    ck_assert(grey > 50 && grey < 200 && color_at(&row, ".expected.png", SIDE, ZOOM, 20, 3)[1] == grey);

    lc_film *difference = read_film(&row, ".difference.exr"), *should = read_film(&row, ".expected.exr");
    ck_assert(fabs(pixel_at(difference, 20, 3)->c[1].mean - 0.5) < 1e-6);
    ck_assert(fabs(pixel_at(difference, 5, 30)->c[1].mean + 0.5) < 1e-6);
    ck_assert(pixel_at(difference, 9, 9)->c[1].mean == 0 && pixel_at(should, 9, 9)->c[1].mean == 1);
    ck_assert(fabs(lc_pixel_variance(pixel_at(difference, 0, 0), 0) / 1e-5 - 1) < 1e-6);
    ck_assert(!difference->has_third && !should->has_third); /* 0 would say that nothing is skewed */
    lc_film_free(difference);
    lc_film_free(should);
    lc_film_free(is);
    free(expected);
    free(skip);
}
END_TEST

/* Two films: both variances; and differences sample by sample, from which what is expected follows. */
START_TEST(films_and_pairs)
{
    lc_film *is = calm_film(), *other = calm_film();
    lc_row row = {.check = "equality"};
    lc_error err;
    pixel_at(is, 1, 2)->c[0].mean = 3;
    ck_assert_int_eq(lc_report_pictures(&row, folder, 1, &(lc_exhibit){is, other, NULL, NULL, NULL}, &err), LC_OK);
    lc_film *difference = read_film(&row, ".difference.exr");
    ck_assert(fabs(pixel_at(difference, 1, 2)->c[0].mean - 2) < 1e-6);
    ck_assert(fabs(lc_pixel_variance(pixel_at(difference, 0, 0), 0) / 2e-5 - 1) < 1e-6);
    lc_film_free(difference);
    for (size_t i = 0; i < SIDE * SIDE; ++i)
        other->pixels[i].c[0].mean = -0.25;
    ck_assert_int_eq(lc_report_pictures(&row, folder, 2, &(lc_exhibit){is, NULL, NULL, other, NULL}, &err), LC_OK);
    ck_assert(is_blue(color_at(&row, ".difference.png", SIDE, ZOOM, 8, 8)));
    lc_film *should = read_film(&row, ".expected.exr");
    ck_assert(fabs(pixel_at(should, 1, 2)->c[0].mean - 3.25) < 1e-6);
    lc_film_free(should);
    lc_film_free(is);
    lc_film_free(other);
}
END_TEST

START_TEST(no_folder_no_pictures)
{
    lc_film *is = calm_film();
    lc_row row = {.check = "equality"};
    lc_error err;
    char missing[128];
    snprintf(missing, sizeof missing, "%s/none", folder);
    ck_assert_int_eq(lc_report_pictures(&row, missing, 1, &(lc_exhibit){is, is, NULL, NULL, NULL}, &err), LC_FAULT);
    ck_assert_msg(strstr(err.text, missing) != NULL, "%s", err.text);
    ck_assert_str_eq(row.pictures, "");
    lc_film_free(is);
}
END_TEST

/* ---- through the judge ---------------------------------------------------------------------------------------------- */

static lc_status load_small(lc_scene **out, const char *name, lc_error *err) { return load_sized(out, name, 16, err); }

static int shown;

static void on_fail(void *user, lc_row *row, int number, const lc_exhibit *exhibit)
{
    const lc_exhibit *like = user;
    lc_error err;
    ck_assert_int_eq(row->verdict, LC_ROW_FAIL);
    ck_assert_int_ge(number, ++shown); /* of the table's rows, some of which pass */
    ck_assert(exhibit->is && !exhibit->other == !like->other && !exhibit->expected == !like->expected &&
              !exhibit->difference == !like->difference);
    ck_assert_msg(lc_report_pictures(row, folder, number, exhibit, &err) == LC_OK, "%s", err.text);
}

/* Rows of each kind that has an image; what is wrong by a factor is wrong in one colour. */
START_TEST(each_kind_of_row_has_pictures)
{
    static const lc_film film;
    static const double value;
    static const struct {
        const char *mutant, *check, *scene;
        lc_exhibit like;
        int (*is_color)(const unsigned char *);
    } kinds[] = {
        {"light_no_pi", "analytic", "plane_rectangle", {&film, NULL, &value, NULL, NULL}, is_red},
        {"light_no_pi", "analytic", "plane_directional", {&film, NULL, &value, NULL, NULL}, is_red}, /* exact */
        {"light_first_only", "equality", "cornell", {&film, &film, NULL, NULL, NULL}, NULL},
        {"light_no_pi", "equality", "five_lights", {&film, &film, NULL, NULL, NULL}, NULL},
        {"light_clamped", "metamorphic", "five_lights", {&film, NULL, NULL, &film, NULL}, NULL},
    };
    int with_pictures = 0;
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; ++i) {
        lc_verify_options options;
        lc_report report;
        lc_error err = {""};
        lc_verify_options_init(&options);
        const lc_mutant *mutant = lc_mutant_find(kinds[i].mutant);
        ck_assert_ptr_nonnull(mutant);
        options.estimator = mutant->estimator;
        options.check = kinds[i].check;
        options.scene = kinds[i].scene;
        options.on_fail = on_fail;
        options.user = (void *)&kinds[i].like;
        shown = 0;
        ck_assert_msg(lc_verify(&report, &options, load_small, &err) == LC_OK, "%s", err.text);
        for (int r = 0; r < report.count; ++r) {
            const lc_row *row = &report.rows[r];
            ck_assert_int_eq(row->pictures[0] != 0, row->verdict == LC_ROW_FAIL);
            if (row->pictures[0] && kinds[i].is_color)
                ck_assert_msg(kinds[i].is_color(color_at(row, ".difference.png", 16, 16, 7, 9)), "%s", row->pictures);
        }
        with_pictures += shown > 0;
        lc_report_release(&report);
    }
    ck_assert_int_ge(with_pictures, 4);
}
END_TEST

Suite *lc_suite_pictures(void)
{
    Suite *suite = suite_create("pictures");
    TCase *tc = tcase_create("core");
    tcase_add_checked_fixture(tc, make_folder, remove_folder);
    tcase_add_test(tc, colour_has_sign_and_place);
    tcase_add_test(tc, films_and_pairs);
    tcase_add_test(tc, no_folder_no_pictures);
    suite_add_tcase(suite, tc);
    tc = tcase_create("judged");
    tcase_add_checked_fixture(tc, make_folder, remove_folder);
    tcase_set_timeout(tc, 60);
    tcase_add_test(tc, each_kind_of_row_has_pictures);
    suite_add_tcase(suite, tc);
    return suite;
}
