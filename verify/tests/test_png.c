/* SPDX-License-Identifier: GPL-3.0-or-later */
/* PNG: what a viewer would see, read back through libpng's own reader. */
#include "verify/tests/tests.h"

#include <math.h>
#include <png.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "io/png.h"

static char target[64];

static void make_target(void)
{
    strcpy(target, "/tmp/lightcheck-test-XXXXXX");
    int fd = mkstemp(target);
    ck_assert_int_ge(fd, 0);
    close(fd);
}

static void remove_target(void) { unlink(target); }

/* The pixels as stored; to be freed. */
static unsigned char *read_back(int width, int height)
{
    png_image image;
    memset(&image, 0, sizeof image);
    image.version = PNG_IMAGE_VERSION;
    ck_assert_msg(png_image_begin_read_from_file(&image, target), "%s", image.message);
    ck_assert_uint_eq(image.width, (unsigned)width);
    ck_assert_uint_eq(image.height, (unsigned)height);
    ck_assert_uint_eq(image.format, PNG_FORMAT_RGB); /* 8 bits, no alpha, no palette */
    unsigned char *pixels = malloc(PNG_IMAGE_SIZE(image));
    ck_assert_ptr_nonnull(pixels);
    ck_assert_msg(png_image_finish_read(&image, NULL, pixels, 0, NULL), "%s", image.message);
    return pixels;
}

static void ck_pixel(const unsigned char *pixel, int r, int g, int b)
{
    ck_assert_msg(pixel[0] == r && pixel[1] == g && pixel[2] == b, "got %d %d %d, expected %d %d %d", pixel[0],
                  pixel[1], pixel[2], r, g, b);
}

/* Each of the 256 codes must come back from the middle of its own interval, by the inverse function of the standard. */
START_TEST(every_srgb_code)
{
    double rgb[256][3];
    for (int i = 0; i < 256; ++i) {
        double v = i / 255.0;
        double x = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
        rgb[i][0] = rgb[i][1] = x;
        rgb[i][2] = 1 - x;
    }
    ck_assert_int_eq(lc_png_write(target, 16, 16, (const double(*)[3])rgb, 0, NULL), LC_OK);
    unsigned char *pixels = read_back(16, 16);
    for (int i = 0; i < 256; ++i) {
        ck_assert_int_eq(pixels[3 * i], i);
        ck_assert_int_eq(pixels[3 * i + 1], i);
    }
    free(pixels);
}
END_TEST

START_TEST(known_values)
{
    /* 0.5 -> 187.516 -> 188, 0.18 -> 117.65 -> 118, 0.0031308 -> 10.31 -> 10, 0.21586 -> 128 (standard, by hand) */
    const double rgb[6][3] = {{0.5, 0.18, 0.0031308}, {0, 1, 2},  {-1, INFINITY, -INFINITY}, {NAN, 0, 1},
                              {0.21586, 0, 0},        {1, 1, NAN}};
    ck_assert_int_eq(lc_png_write(target, 3, 2, rgb, 0, NULL), LC_OK);
    unsigned char *pixels = read_back(3, 2);
    ck_pixel(pixels, 188, 118, 10);
    ck_pixel(pixels + 3, 0, 255, 255);
    ck_pixel(pixels + 6, 0, 255, 0);
    ck_pixel(pixels + 9, 255, 0, 255);
    ck_pixel(pixels + 12, 128, 0, 0);
    ck_pixel(pixels + 15, 255, 0, 255);
    free(pixels);
}
END_TEST

START_TEST(exposure_is_in_stops)
{
    const double rgb[1][3] = {{0.25, 0.09, 0}};
    ck_assert_int_eq(lc_png_write(target, 1, 1, rgb, 1, NULL), LC_OK);
    unsigned char *pixels = read_back(1, 1);
    ck_pixel(pixels, 188, 118, 0);
    free(pixels);
    ck_assert_int_eq(lc_png_write(target, 1, 1, rgb, 1e9, NULL), LC_OK); /* no NaN from 0 times infinity */
    pixels = read_back(1, 1);
    ck_pixel(pixels, 255, 255, 0);
    free(pixels);
}
END_TEST

START_TEST(a_film_shows_its_means)
{
    lc_film *film;
    ck_assert_int_eq(lc_film_create(&film, 2, 1, NULL), LC_OK);
    film->pixels[1].c[0].mean = 0.5;
    film->pixels[1].c[1].mean = 0.18;
    film->pixels[1].c[2].mean = 1;
    ck_assert_int_eq(lc_png_write_film(target, film, 0, NULL), LC_OK);
    unsigned char *pixels = read_back(2, 1);
    ck_pixel(pixels, 0, 0, 0);
    ck_pixel(pixels + 3, 188, 118, 255);
    free(pixels);
    lc_film_free(film);
}
END_TEST

START_TEST(signed_values)
{
    const double values[8] = {0, 2, -2, 1, -1, INFINITY, -1e9, NAN};
    ck_assert_int_eq(lc_png_write_signed(target, 4, 2, values, 2, NULL), LC_OK);
    unsigned char *pixels = read_back(4, 2);
    ck_pixel(pixels, 255, 255, 255);
    ck_pixel(pixels + 3, 190, 10, 30);
    ck_pixel(pixels + 6, 20, 50, 190);
    ck_pixel(pixels + 9, 223, 133, 143); /* halfway to white */
    ck_pixel(pixels + 12, 138, 153, 223);
    ck_pixel(pixels + 15, 190, 10, 30);
    ck_pixel(pixels + 18, 20, 50, 190);
    ck_pixel(pixels + 21, 255, 0, 255);
    free(pixels);
    lc_error err;
    const double wrong[] = {0, -1, NAN, INFINITY};
    for (int i = 0; i < 4; ++i)
        ck_assert_int_eq(lc_png_write_signed(target, 4, 2, values, wrong[i], &err), LC_BAD_INPUT);
}
END_TEST

START_TEST(chunks_are_sRGB_and_no_other_metadata)
{
    static const char *const expected[] = {"IHDR", "sRGB", "IDAT", "IEND"};
    const double rgb[1][3] = {{0, 0, 0}};
    unsigned char data[512];
    ck_assert_int_eq(lc_png_write(target, 1, 1, rgb, 0, NULL), LC_OK);
    FILE *file = fopen(target, "rb");
    ck_assert_ptr_nonnull(file);
    size_t size = fread(data, 1, sizeof data, file), at = 8;
    fclose(file);
    for (int i = 0; i < 4; ++i) {
        ck_assert_uint_le(at + 12, size);
        ck_assert_mem_eq(data + at + 4, expected[i], 4);
        at += 12 + data[at + 3]; /* all shorter than 256 bytes */
    }
    ck_assert_uint_eq(at, size);
}
END_TEST

START_TEST(failures)
{
    lc_error err;
    const double rgb[1][3] = {{0, 0, 0}};
    ck_assert_int_eq(lc_png_write(target, 0, 1, rgb, 0, &err), LC_BAD_INPUT);
    ck_assert_int_eq(lc_png_write(target, 1, LC_MAX_SIZE + 1, rgb, 0, &err), LC_BAD_INPUT);
    ck_assert_int_eq(lc_png_write("/nonexistent/x.png", 1, 1, rgb, 0, &err), LC_FAULT);
    uid_t us;
    if (!lc_test_drop_root(&us))
        return;
    ck_assert_int_eq(lc_png_write("/dev/full", 1, 1, rgb, 0, &err), LC_FAULT);
    ck_assert_str_eq(err.text, "/dev/full: cannot write: No space left on device");
    lc_test_restore_root(us);
}
END_TEST

/* Large enough for the failure to come from within libpng, through its longjmp. */
START_TEST(failure_in_the_middle)
{
    enum { SIZE = 300 };
    lc_error err;
    double *values = malloc(SIZE * SIZE * sizeof *values);
    ck_assert_ptr_nonnull(values);
    uint32_t state = 1;
    for (int i = 0; i < SIZE * SIZE; ++i)
        values[i] = (double)(state = state * 1664525u + 1013904223u) / 4e9 - 0.5;
    uid_t us;
    int may = lc_test_drop_root(&us);
    lc_status status = may ? lc_png_write_signed("/dev/full", SIZE, SIZE, values, 1, &err) : LC_FAULT;
    lc_test_restore_root(us);
    free(values);
    ck_assert_int_eq(status, LC_FAULT);
    if (may)
        ck_assert_str_eq(err.text, "/dev/full: cannot write: No space left on device");
}
END_TEST

Suite *lc_suite_png(void)
{
    Suite *suite = suite_create("png");
    TCase *tc = tcase_create("png");
    tcase_add_checked_fixture(tc, make_target, remove_target);
    tcase_add_test(tc, every_srgb_code);
    tcase_add_test(tc, known_values);
    tcase_add_test(tc, exposure_is_in_stops);
    tcase_add_test(tc, a_film_shows_its_means);
    tcase_add_test(tc, signed_values);
    tcase_add_test(tc, chunks_are_sRGB_and_no_other_metadata);
    tcase_add_test(tc, failures);
    tcase_add_test(tc, failure_in_the_middle);
    suite_add_tcase(suite, tc);
    return suite;
}
