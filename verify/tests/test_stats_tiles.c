/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Images whose pixels move together, of a known law: how often the right one FAILs, that it PASSes, and that a wrong one FAILs. */
#include "verify/tests/tests.h"

#include <math.h>
#include <string.h>

#include "verify/stats/stats.h"

enum { SIDE = 8, PIXELS = SIDE * SIDE, BLOCK = 4 }; /* the block that moves as one is 4x4 pixels, at 4,0 */

typedef enum law_kind { SYMMETRIC, SKEWED } law_kind; /* sums of two uniforms; exponential */
typedef enum bond_kind { ALONE, BLOCK_AS_ONE, IMAGE_AS_ONE } bond_kind;

typedef struct film {
    lc_pixel pixels[PIXELS], *tiles[LC_LEVELS];
} film;

/* Mean 1, standard deviation 1 / sqrt(6) or 1. */
static double draw(lc_sampler *s, law_kind law)
{
    double u = lc_next(s);
    return law == SKEWED ? -log(1 - u) : u + lc_next(s);
}

static int is_bound(bond_kind bond, int i)
{
    return bond == IMAGE_AS_ONE || (bond == BLOCK_AS_ONE && i % SIDE >= SIDE - BLOCK && i / SIDE < BLOCK);
}

/* One block of images; all pixels of a bond have the same value. */
static void add_block(film *f, uint32_t trial, uint32_t number, law_kind law, bond_kind bond)
{
    static float images[LC_BLOCK * PIXELS * 3];
    lc_sampler s;
    lc_sampler_start(&s, 1, trial, number, 0);
    for (int k = 0; k < LC_BLOCK; ++k) {
        double common = draw(&s, law);
        for (int i = 0; i < PIXELS; ++i) {
            double value = is_bound(bond, i) ? common : draw(&s, law);
            for (int c = 0; c < 3; ++c)
                images[3 * (k * PIXELS + i) + c] = (float)value;
        }
    }
    for (int i = 0; i < PIXELS; ++i) {
        double samples[LC_BLOCK][3];
        for (int k = 0; k < LC_BLOCK; ++k)
            for (int c = 0; c < 3; ++c)
                samples[k][c] = (double)images[3 * (k * PIXELS + i) + c];
        lc_pixel_add(&f->pixels[i], (const double(*)[3])samples, LC_BLOCK);
    }
    lc_tiles_add(f->tiles, SIDE, SIDE, images, LC_BLOCK);
}

static void make_film(film *f, uint32_t trial, int images, law_kind law, bond_kind bond)
{
    memset(f, 0, sizeof *f);
    ck_assert(lc_tiles_create(f->tiles, SIDE, SIDE, NULL) == LC_OK);
    for (int k = 0; k < images / LC_BLOCK; ++k)
        add_block(f, trial, (uint32_t)k, law, bond);
}

/* Against `expected` everywhere; with the tiles or without. */
static lc_pyramid judge(const film *f, double expected, double alpha, double margin, int with)
{
    lc_estimate field[PIXELS];
    lc_pyramid_plan plan;
    lc_pyramid out;
    lc_pyramid_plan_init(&plan, alpha, alpha);
    plan.margin[lc_pyramid_levels(SIDE, SIDE) - 1] = margin;
    for (int i = 0; i < PIXELS; ++i)
        field[i] = lc_estimate_one(&f->pixels[i], 1, 0, expected, 0);
    lc_status status = with ? lc_pyramid_judge_tiles(&out, field, SIDE, SIDE, f->tiles, 0, &plan, NULL)
                            : lc_pyramid_judge(&out, field, SIDE, SIDE, &plan, NULL);
    ck_assert_int_eq(status, LC_OK);
    return out;
}

static const struct {
    law_kind law;
    bond_kind bond;
} worlds[] = {{SYMMETRIC, ALONE}, {SYMMETRIC, BLOCK_AS_ONE}, {SYMMETRIC, IMAGE_AS_ONE}, {SKEWED, BLOCK_AS_ONE}, {SKEWED, IMAGE_AS_ONE}};

/* A level of the budget that can be counted. */
START_TEST(the_right_fails_at_its_level)
{
    const int count = 2000;
    const double level = 0.01;
    int failed[2] = {0, 0};
    for (int trial = 0; trial < count; ++trial) {
        film f;
        make_film(&f, (uint32_t)trial, LC_LEAST_SAMPLES, worlds[_i].law, worlds[_i].bond);
        for (int with = 0; with < 2; ++with)
            failed[with] += judge(&f, 1, level, INFINITY, with).verdict == LC_FAIL;
        lc_tiles_free(f.tiles);
    }
    lc_interval rate = lc_clopper_pearson(failed[1], count, 1e-3);
    ck_assert_msg(rate.lower <= level, "%d of %d, at a level of %g", failed[1], count, level);
    if (worlds[_i].bond != ALONE) /* why this is needed */
        ck_assert_msg(failed[0] > count / 10, "%d of %d", failed[0], count);
}
END_TEST

/* At the levels of a run; images that move as one need more than the first look. */
START_TEST(right_passes_and_one_percent_fails)
{
    for (uint32_t trial = 0; trial < 5; ++trial) {
        film f;
        make_film(&f, trial, 1 << 18, SYMMETRIC, worlds[_i].bond);
        ck_assert_int_eq(judge(&f, 1, 1e-10, 0.0075, 1).verdict, LC_PASS);
        ck_assert_int_eq(judge(&f, 1 / 1.01, 1e-10, 0.0075, 1).verdict, LC_FAIL);
        ck_assert_int_eq(judge(&f, 1.01, 1e-10, 0.0075, 1).verdict, LC_FAIL);
        lc_tiles_free(f.tiles);
    }
}
END_TEST

/* It knows no more than one of its pixels: error, degrees of freedom, skewness. */
START_TEST(an_image_that_moves_as_one_is_one_pixel)
{
    film f;
    make_film(&f, 1, LC_LEAST_SAMPLES, SKEWED, IMAGE_AS_ONE);
    lc_student whole = judge(&f, 1, 1e-3, INFINITY, 1).whole.student;
    lc_estimate e = lc_estimate_one(&f.pixels[0], 1, 0, 1, 0);
    lc_student one = lc_estimate_student(&e);
    ck_assert_double_eq_tol(whole.error, one.error, 1e-6 * one.error);
    ck_assert_double_eq_tol(whole.df, LC_LEAST_SAMPLES - 1, 1e-6);
    ck_assert_double_eq_tol(whole.skew[LC_LOW], one.skew[LC_LOW], 1e-6 * one.skew[LC_LOW]);
    ck_assert_double_ge(one.skew[LC_LOW], 1.0 / 16);
    lc_tiles_free(f.tiles);
}
END_TEST

/* Independent pixels: what is not known beforehand costs the degrees of freedom, and a few tests their trust. */
START_TEST(independence_costs_little)
{
    const int count = 200;
    int lost = 0, kept = 0;
    double wider = 0;
    for (int trial = 0; trial < count; ++trial) {
        film f;
        make_film(&f, (uint32_t)trial, LC_LEAST_SAMPLES, SYMMETRIC, ALONE);
        lc_interval i[2];
        for (int with = 0; with < 2; ++with) {
            lc_pyramid p = judge(&f, 1, 1e-10, INFINITY, with);
            i[with] = lc_student_interval(&p.whole.student, 1e-10);
        }
        int is_lost = !(i[1].upper - i[1].lower < INFINITY);
        lost += is_lost;
        if (!is_lost)
            wider += (i[1].upper - i[1].lower) / (i[0].upper - i[0].lower), ++kept;
        lc_tiles_free(f.tiles);
    }
    ck_assert_msg(lost <= count / 20, "%d of %d", lost, count);
    ck_assert_msg(wider < 1.1 * kept, "%g", wider / kept);
}
END_TEST

/* A tile is what the plain pyramid says it is, place and p value, where images add nothing to its pixels. */
START_TEST(levels_make_one_pyramid)
{
    film f;
    make_film(&f, 1, LC_LEAST_SAMPLES, SYMMETRIC, ALONE);
    for (int l = 1; l < lc_pyramid_levels(SIDE, SIDE); ++l) /* one whose sums hardly vary */
        for (int i = 0; i < PIXELS >> (2 * l); ++i)
            f.tiles[l][i].c[0].m2 *= 1e-6, f.tiles[l][i].c[0].m3 = 0, f.tiles[l][i].n = 1 << 30;
    for (int i = 0; i < PIXELS; ++i) /* the block, and a little everywhere */
        f.pixels[i].c[0].mean += is_bound(BLOCK_AS_ONE, i) ? 0.05 : 0.002;
    lc_pyramid plain = judge(&f, 1, 1e-3, 0.1, 0), tiles = judge(&f, 1, 1e-3, 0.1, 1);
    ck_assert_int_eq(plain.verdict, LC_FAIL);
    ck_assert_int_eq(tiles.verdict, plain.verdict);
    ck_assert_int_eq(tiles.worst.level, 2);
    ck_assert(tiles.worst.x == 4 && tiles.worst.y == 0 && tiles.worst.width == 4 && tiles.worst.height == 4);
    ck_assert_double_eq_tol(tiles.worst.log_p, plain.worst.log_p, 1e-6 * fabs(plain.worst.log_p));
    ck_assert_double_eq_tol(tiles.whole.student.error, plain.whole.student.error, 1e-9);
    ck_assert_double_eq_tol(tiles.whole.log_p, plain.whole.log_p, 1e-6 * fabs(plain.whole.log_p));
    for (int l = 0; l < plain.levels; ++l) {
        ck_assert_uint_eq(tiles.level[l].tiles, plain.level[l].tiles);
        ck_assert_double_eq_tol(tiles.level[l].alpha, plain.level[l].alpha, 1e-12 * plain.level[l].alpha);
        ck_assert_uint_eq(tiles.level[l].tested, plain.level[l].tested);
    }
    ck_assert_int_eq(judge(&f, 1.0146, 1e-3, 0.1, 1).level[3].within, 1);
    lc_tiles_free(f.tiles);
}
END_TEST

Suite *lc_suite_stats_tiles(void)
{
    Suite *suite = suite_create("stats_tiles");
    TCase *cases = tcase_create("tiles");
    tcase_add_test(cases, an_image_that_moves_as_one_is_one_pixel);
    tcase_add_test(cases, independence_costs_little);
    tcase_add_test(cases, levels_make_one_pyramid);
    tcase_set_timeout(cases, 60);
    suite_add_tcase(suite, cases);
    TCase *rates = tcase_create("rates");
    tcase_set_tags(rates, "long"); /* many samples, no code that other tests do not run */
    tcase_set_timeout(rates, 60);
    tcase_add_loop_test(rates, the_right_fails_at_its_level, 0, sizeof worlds / sizeof worlds[0]);
    tcase_add_loop_test(rates, right_passes_and_one_percent_fails, 0, IMAGE_AS_ONE + 1);
    suite_add_tcase(suite, rates);
    return suite;
}
