/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Films: moments against textbook sums in long double and against closed forms, merging against the whole. */
#include "verify/tests/tests.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/host.h"

/* Any cheap numbers will do, as long as each test has its own. */
static double noise(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / 9007199254740992.0;
}

static void ck_near(double got, double expected, double tolerance)
{
    ck_assert_msg(fabs(got - expected) <= tolerance * (1e-300 + fabs(expected)), "got %.17g, expected %.17g", got,
                  expected);
}

struct sums {
    long double mean, m2, m3;
    double max;
};

/* The definitions, in two passes. */
static struct sums textbook(const double (*x)[3], int n, int channel)
{
    struct sums s = {0, 0, 0, x[0][channel]};
    for (int i = 0; i < n; ++i) {
        s.mean += x[i][channel];
        s.max = fmax(s.max, x[i][channel]);
    }
    s.mean /= n;
    for (int i = 0; i < n; ++i) {
        long double d = x[i][channel] - s.mean;
        s.m2 += d * d;
        s.m3 += d * d * d;
    }
    return s;
}

static void add_all(lc_pixel *pixel, const double (*x)[3], int n, int block)
{
    for (int i = 0; i < n; i += block)
        lc_pixel_add(pixel, x + i, n - i < block ? n - i : block);
}

START_TEST(one_two_three_by_hand)
{
    const double x[4][3] = {{1, 0, 5}, {2, 0, 5}, {3, 0, 5}, {10, 8, 5}};
    lc_pixel pixel;
    memset(&pixel, 0, sizeof pixel);
    lc_pixel_add(&pixel, x, 4);
    ck_assert_uint_eq(pixel.n, 4);
    ck_assert_uint_eq(pixel.batches, 0);
    /* mean 4, deviations -3 -2 -1 6: squares 50, cubes 180 */
    ck_assert_double_eq(pixel.c[0].mean, 4);
    ck_assert_double_eq(pixel.c[0].m2, 50);
    ck_assert_double_eq(pixel.c[0].m3, 180);
    ck_assert_double_eq(pixel.c[0].max, 10);
    ck_near(lc_pixel_variance(&pixel, 0), 50.0 / 12, 1e-15);
    /* mean 2, deviations -2 -2 -2 6: squares 48, cubes 192 */
    ck_assert_double_eq(pixel.c[1].m2, 48);
    ck_assert_double_eq(pixel.c[1].m3, 192);
    ck_assert_double_eq(pixel.c[2].m2, 0);
}
END_TEST

/* Every length of a block, since its tail is handled apart, and several blocks of it. */
START_TEST(blocks_of_any_length)
{
    enum { N = 200 };
    double x[N][3];
    uint64_t state = 1;
    for (int i = 0; i < N; ++i)
        for (int c = 0; c < 3; ++c)
            x[i][c] = exp(6 * noise(&state)) * (c + 1);
    lc_pixel pixel;
    memset(&pixel, 0, sizeof pixel);
    add_all(&pixel, (const double(*)[3])x, N, _i);
    ck_assert_uint_eq(pixel.n, N);
    ck_assert_uint_eq(pixel.batches, _i == LC_BLOCK ? 3 : 0);
    for (int c = 0; c < 3; ++c) {
        struct sums s = textbook((const double(*)[3])x, N, c);
        ck_near(pixel.c[c].mean, (double)s.mean, 1e-14);
        ck_near(pixel.c[c].m2, (double)s.m2, 1e-13);
        ck_near(pixel.c[c].m3, (double)s.m3, 1e-12);
        ck_assert_double_eq(pixel.c[c].max, s.max);
    }
}
END_TEST

START_TEST(the_largest_may_be_below_zero)
{
    const double x[2][3] = {{-3, -2, 0}, {-4, -1, -1}}; /* an estimator's samples are not, differences are */
    lc_pixel pixel;
    memset(&pixel, 0, sizeof pixel);
    lc_pixel_add(&pixel, x, 2);
    ck_assert_double_eq(pixel.c[0].max, -3);
    ck_assert_double_eq(pixel.c[1].max, -1);
    ck_assert_double_eq(pixel.c[2].max, 0);
}
END_TEST

START_TEST(small_spread_on_a_large_mean)
{
    enum { N = 640 };
    static double x[N][3];
    uint64_t state = 2;
    for (int i = 0; i < N; ++i)
        x[i][0] = x[i][1] = x[i][2] = 1e6 + noise(&state);
    lc_pixel pixel;
    memset(&pixel, 0, sizeof pixel);
    add_all(&pixel, (const double(*)[3])x, N, LC_BLOCK);
    struct sums s = textbook((const double(*)[3])x, N, 0);
    ck_near(pixel.c[0].m2, (double)s.m2, 1e-9); /* E[x^2] - E[x]^2 would leave a digit or two */
    ck_assert_double_lt(fabs(pixel.c[0].m3 - (double)s.m3), 1e-6);
}
END_TEST

START_TEST(a_constant_has_no_variance)
{
    double x[LC_BLOCK][3];
    lc_pixel pixel;
    memset(&pixel, 0, sizeof pixel);
    for (int i = 0; i < LC_BLOCK; ++i)
        x[i][0] = 0.1, x[i][1] = 1.0 / 3, x[i][2] = 1e-7;
    for (int i = 1; i <= LC_BLOCK; ++i)
        lc_pixel_add(&pixel, (const double(*)[3])x, i);
    for (int c = 0; c < 3; ++c) {
        ck_assert_double_eq(pixel.c[c].mean, x[0][c]);
        ck_assert_double_eq(pixel.c[c].m2, 0);
        ck_assert_double_eq(pixel.c[c].m3, 0);
    }
}
END_TEST

START_TEST(batches_hold_the_means_of_blocks)
{
    enum { BATCHES = 5 };
    static double x[BATCHES * LC_BLOCK + 7][3];
    const double means[BATCHES] = {1, 4, 2, 8, 5}; /* mean 4, squares 9 0 4 16 1 */
    uint64_t state = 3;
    for (int b = 0; b < BATCHES; ++b)
        for (int i = 0; i < LC_BLOCK; i += 2) {
            double d = noise(&state);
            for (int c = 0; c < 3; ++c) {
                x[b * LC_BLOCK + i][c] = means[b] + d;
                x[b * LC_BLOCK + i + 1][c] = means[b] - d;
            }
        }
    lc_pixel pixel;
    memset(&pixel, 0, sizeof pixel);
    add_all(&pixel, (const double(*)[3])x, BATCHES * LC_BLOCK + 7, LC_BLOCK); /* the last seven are no batch */
    ck_assert_uint_eq(pixel.batches, BATCHES);
    for (int c = 0; c < 3; ++c) {
        ck_near(pixel.c[c].batch_mean, 4, 1e-14);
        ck_near(pixel.c[c].batch_m2, 30, 1e-14);
    }
}
END_TEST

START_TEST(merging_equals_the_whole)
{
    enum { N = 3 * LC_BLOCK + 40 };
    static double x[N][3];
    uint64_t state = 4;
    for (int i = 0; i < N; ++i)
        for (int c = 0; c < 3; ++c)
            x[i][c] = -log(1 - noise(&state));
    lc_pixel whole, a, b, none;
    memset(&whole, 0, sizeof whole);
    memset(&none, 0, sizeof none);
    a = b = whole;
    add_all(&whole, (const double(*)[3])x, N, LC_BLOCK);
    add_all(&a, (const double(*)[3])x, 2 * LC_BLOCK, LC_BLOCK);
    add_all(&b, (const double(*)[3])x + 2 * LC_BLOCK, N - 2 * LC_BLOCK, LC_BLOCK);
    lc_pixel_merge(&none, &a); /* into nothing: a copy */
    ck_assert_mem_eq(&none, &a, sizeof a);
    memset(&none, 0, sizeof none);
    lc_pixel_merge(&a, &b);
    lc_pixel_merge(&a, &none); /* nothing: no change */
    ck_assert_uint_eq(a.n, N);
    ck_assert_uint_eq(a.batches, 3);
    for (int c = 0; c < 3; ++c) {
        ck_near(a.c[c].mean, whole.c[c].mean, 1e-14);
        ck_near(a.c[c].m2, whole.c[c].m2, 1e-13);
        ck_near(a.c[c].m3, whole.c[c].m3, 1e-12);
        ck_near(a.c[c].batch_mean, whole.c[c].batch_mean, 1e-14);
        ck_near(a.c[c].batch_m2, whole.c[c].batch_m2, 1e-11);
        ck_assert_double_eq(a.c[c].max, whole.c[c].max);
    }
}
END_TEST

START_TEST(variance_needs_two_samples)
{
    lc_pixel pixel;
    memset(&pixel, 0, sizeof pixel);
    ck_assert_double_eq(lc_pixel_variance(&pixel, 0), 0);
    const double x[1][3] = {{1, 2, 3}};
    lc_pixel_add(&pixel, x, 1);
    ck_assert_double_eq(lc_pixel_variance(&pixel, 2), 0);
}
END_TEST

/* ---- films -------------------------------------------------------------------------------------- */

static lc_film *make_film(int width, int height, uint64_t seed, uint64_t first, uint64_t count)
{
    lc_film *film;
    ck_assert_int_eq(lc_film_create(&film, width, height, NULL), LC_OK);
    strcpy(film->scene, "room");
    strcpy(film->estimator, "path");
    film->seed = seed;
    film->arm = 7;
    film->first = first;
    film->count = count;
    film->max_bounces = 5;
    return film;
}

/* Fills what belongs to the film's shard with samples that depend on seed, pixel and index only. */
static void fill(lc_film *film)
{
    int tiles = (film->width + LC_TILE - 1) / LC_TILE;
    for (int i = 0; i < film->width * film->height; ++i) {
        int tile = i / film->width / LC_TILE * tiles + i % film->width / LC_TILE;
        if (tile % film->shards != film->shard)
            continue;
        for (uint64_t k = 0; k < film->count; ++k) {
            uint64_t state = film->seed * 1000003 + (uint64_t)i * 1009 + film->first + k;
            noise(&state);
            double x[1][3] = {{noise(&state), noise(&state), noise(&state)}};
            lc_pixel_add(&film->pixels[i], (const double(*)[3])x, 1);
        }
    }
}

static lc_film *make_shard(int shard, int shards)
{
    lc_film *film = make_film(20, 18, 1, 0, 3);
    film->shard = shard;
    film->shards = shards;
    fill(film);
    return film;
}

START_TEST(create_checks_the_size)
{
    const int bad[][2] = {{0, 1}, {1, 0}, {-1, 5}, {LC_MAX_SIZE + 1, 1}, {1, LC_MAX_SIZE + 1}};
    lc_film *film;
    lc_error err;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        ck_assert_int_eq(lc_film_create(&film, bad[i][0], bad[i][1], &err), LC_BAD_INPUT);
        ck_assert_ptr_null(film);
    }
    ck_assert_int_eq(lc_film_create(&film, LC_MAX_SIZE, 1, &err), LC_OK);
    ck_assert_int_eq(film->shards, 1);
    ck_assert_int_eq(film->has_third, 1);
    lc_film_free(film);
    lc_film_free(NULL);
}
END_TEST

/* In any order, and also more shards than the nine tiles, so that some are empty. */
START_TEST(shards_paste_bit_exactly)
{
    static const int orders[][4] = {{0, 1, 2, 3}, {3, 1, 0, 2}, {2, 3, 1, 0}};
    lc_film *whole = make_shard(0, 1);
    int shards = _i < 3 ? 4 : 12;
    lc_film *sum = make_shard(_i < 3 ? orders[_i][0] : 0, shards);
    for (int i = 1; i < shards; ++i) {
        lc_film *shard = make_shard(_i < 3 ? orders[_i][i] : i, shards);
        ck_assert_int_eq(sum->shards, shards);
        ck_assert_int_eq(lc_film_merge(sum, shard, NULL), LC_OK);
        lc_film_free(shard);
    }
    ck_assert_int_eq(sum->shard, 0);
    ck_assert_int_eq(sum->shards, 1);
    ck_assert_uint_eq(sum->count, 3);
    ck_assert_mem_eq(sum->pixels, whole->pixels, 20 * 18 * sizeof *whole->pixels);
    for (size_t i = 0; i < LC_MAX_SHARDS / 64; ++i)
        ck_assert_uint_eq(sum->pasted[i], 0);
    lc_film_free(sum);
    lc_film_free(whole);
}
END_TEST

START_TEST(parts_of_shards_merge_with_each_other)
{
    lc_film *film[4];
    lc_error err;
    for (int i = 0; i < 4; ++i)
        film[i] = make_shard(i, 4);
    ck_assert_int_eq(lc_film_merge(film[3], film[1], &err), LC_OK); /* 1 3 */
    ck_assert_int_eq(film[3]->shard, 1);
    ck_assert_int_eq(lc_film_merge(film[0], film[2], &err), LC_OK); /* 0 2 */
    ck_assert_int_eq(lc_film_merge(film[3], film[1], &err), LC_BAD_INPUT);
    ck_assert_str_eq(err.text, "cannot merge: shard 1 of 4 is in both");
    ck_assert_int_eq(lc_film_merge(film[0], film[3], &err), LC_OK);
    ck_assert_int_eq(film[0]->shards, 1);
    for (int i = 0; i < 4; ++i)
        lc_film_free(film[i]);
}
END_TEST

START_TEST(streams_are_weighted_by_n)
{
    lc_film *a = make_film(2, 1, 1, 0, 1), *b = make_film(2, 1, 2, 0, 3);
    const double one[1][3] = {{8, 8, 8}}, three[3][3] = {{0, 1, 2}, {0, 1, 2}, {0, 1, 2}};
    lc_pixel_add(&a->pixels[0], one, 1);
    lc_pixel_add(&b->pixels[0], three, 3);
    lc_pixel_add(&b->pixels[1], three, 3); /* where a has nothing */
    ck_assert_int_eq(lc_film_merge(a, b, NULL), LC_OK);
    ck_assert_double_eq(a->pixels[0].c[0].mean, 2);
    ck_assert_double_eq(a->pixels[0].c[1].mean, 2.75);
    ck_assert_double_eq(a->pixels[0].c[2].mean, 3.5);
    ck_assert_double_eq(a->pixels[0].c[0].m2, 48);
    ck_assert_uint_eq(a->pixels[0].n, 4);
    ck_assert_uint_eq(a->pixels[1].n, 3);
    ck_assert_uint_eq(a->seed, 1);
    ck_assert_int_eq(a->more_count, 1);
    ck_assert_uint_eq(a->more[0].seed, 2);
    ck_assert_uint_eq(a->more[0].count, 3);
    lc_film_free(a);
    lc_film_free(b);
}
END_TEST

START_TEST(ranges_join_and_never_overlap)
{
    lc_error err;
    lc_film *a = make_film(1, 1, 5, 64, 64), *b = make_film(1, 1, 5, 0, 64), *c = make_film(1, 1, 5, 200, 10);
    lc_film *d = make_film(1, 1, 5, 128, 72), *gap = make_film(1, 1, 5, 120, 10), *arm = make_film(1, 1, 5, 0, 64);
    arm->arm = 8;
    ck_assert_int_eq(lc_film_merge(a, a, &err), LC_BAD_INPUT); /* itself */
    ck_assert_int_eq(lc_film_merge(a, b, &err), LC_OK);        /* [0, 128) */
    ck_assert_uint_eq(a->first, 0);
    ck_assert_uint_eq(a->count, 128);
    ck_assert_int_eq(a->more_count, 0);
    ck_assert_int_eq(lc_film_merge(a, c, &err), LC_OK); /* and [200, 210) */
    ck_assert_int_eq(a->more_count, 1);
    ck_assert_int_eq(lc_film_merge(a, gap, &err), LC_BAD_INPUT);
    ck_assert_ptr_nonnull(strstr(err.text, "both have sample 120 of seed 5"));
    ck_assert_int_eq(lc_film_merge(gap, a, &err), LC_BAD_INPUT);
    ck_assert_int_eq(lc_film_merge(a, c, &err), LC_BAD_INPUT); /* c again, found among `more` */
    ck_assert_int_eq(lc_film_merge(a, d, &err), LC_OK);        /* fills the gap: [0, 210) */
    ck_assert_uint_eq(a->count, 210);
    ck_assert_int_eq(a->more_count, 0);
    ck_assert_int_eq(lc_film_merge(a, arm, &err), LC_OK); /* another stream may have the same samples */
    ck_assert_int_eq(lc_film_merge(a, arm, &err), LC_BAD_INPUT);
    /* the last sample alone is shared; and ranges that touch, but of two streams, stay apart */
    lc_film *last = make_film(1, 1, 5, 209, 1), *next = make_film(1, 1, 6, 0, 10), *touch = make_film(1, 1, 7, 10, 5);
    ck_assert_int_eq(lc_film_merge(a, last, &err), LC_BAD_INPUT);
    ck_assert_int_eq(lc_film_merge(next, touch, &err), LC_OK);
    ck_assert_uint_eq(next->count, 10);
    ck_assert_int_eq(next->more_count, 1);
    lc_film *all[] = {a, b, c, d, gap, arm, last, next, touch};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; ++i)
        lc_film_free(all[i]);
}
END_TEST

static void ck_refuses(lc_film *a, lc_film *b, const char *word)
{
    lc_error err = {""};
    lc_pixel before = a->pixels[0];
    ck_assert_int_eq(lc_film_merge(a, b, &err), LC_BAD_INPUT);
    ck_assert_msg(strstr(err.text, word) != NULL, "'%s' does not say '%s'", err.text, word);
    ck_assert_mem_eq(&a->pixels[0], &before, sizeof before);
    lc_film_free(b);
}

START_TEST(merge_refuses_what_differs)
{
    lc_film *a = make_film(4, 4, 1, 0, 2), *b;
    fill(a);
    ck_refuses(a, make_film(4, 5, 2, 0, 2), "4x4 and 4x5");
    b = make_film(4, 4, 2, 0, 2), strcpy(b->scene, "hall");
    ck_refuses(a, b, "scenes, 'room' and 'hall'");
    b = make_film(4, 4, 2, 0, 2), strcpy(b->estimator, "light");
    ck_refuses(a, b, "estimators, 'path' and 'light'");
    b = make_film(4, 4, 2, 0, 2), b->max_bounces = 6;
    ck_refuses(a, b, "bounces 0 to 5 and 0 to 6");
    b = make_film(4, 4, 2, 0, 2), b->min_bounces = 1;
    ck_refuses(a, b, "bounces 0 to 5 and 1 to 5");
    ck_refuses(a, make_film(4, 4, 2, 0, 0), "unknown");
    b = make_film(4, 4, 2, 0, 2), b->shards = 3;
    ck_refuses(a, b, "a shard of 1 with one of 3");
    a->shards = 3, a->shard = 1;
    b = make_film(4, 4, 2, 0, 2), b->shards = 3;
    ck_refuses(a, b, "seeds or samples");
    a->shard = 3;
    b = make_film(4, 4, 1, 0, 2), b->shards = 3;
    ck_refuses(a, b, "0 <= shard < shards");
    lc_film_free(a);
}
END_TEST

START_TEST(bad_samples_add_up)
{
    lc_film *a = make_film(4, 4, 1, 0, 2), *b = make_film(4, 4, 2, 0, 2), *c = make_film(4, 4, 3, 0, 2);
    a->bad = 2, a->bad_x = 1, a->bad_y = 2, a->bad_value[1] = 1;
    b->bad = 3, b->bad_x = 3, b->bad_y = 1, b->bad_value[1] = -2;
    ck_assert_int_eq(lc_film_merge(a, b, NULL), LC_OK);
    ck_assert_int_eq(lc_film_merge(a, c, NULL), LC_OK);
    ck_assert_uint_eq(a->bad, 5);
    ck_assert_int_eq(a->bad_x, 3);
    ck_assert_int_eq(a->bad_y, 1);
    ck_assert_double_eq(a->bad_value[1], -2);
    lc_film_free(a);
    lc_film_free(b);
    lc_film_free(c);
}
END_TEST

START_TEST(third_moments_survive_only_in_pairs)
{
    lc_film *a = make_film(4, 4, 1, 0, 70), *b = make_film(4, 4, 2, 0, 70), *c = make_film(4, 4, 3, 0, 70);
    fill(a), fill(b), fill(c);
    ck_assert_int_eq(lc_film_merge(a, b, NULL), LC_OK);
    ck_assert_int_eq(a->has_third, 1);
    ck_assert_double_ne(a->pixels[3].c[1].m3, 0);
    c->has_third = 0;
    ck_assert_int_eq(lc_film_merge(a, c, NULL), LC_OK);
    ck_assert_int_eq(a->has_third, 0);
    ck_assert_double_eq(a->pixels[3].c[1].m3, 0);
    ck_assert_double_eq(a->pixels[3].c[1].max, 0);
    ck_assert_uint_eq(a->pixels[3].n, 210);
    ck_assert_double_gt(a->pixels[3].c[1].m2, 0);
    lc_film_free(a);
    lc_film_free(b);
    lc_film_free(c);
}
END_TEST

Suite *lc_suite_film(void)
{
    Suite *suite = suite_create("film");
    TCase *tc = tcase_create("pixel");
    tcase_add_test(tc, one_two_three_by_hand);
    tcase_add_loop_test(tc, blocks_of_any_length, 1, LC_BLOCK + 1);
    tcase_add_test(tc, the_largest_may_be_below_zero);
    tcase_add_test(tc, small_spread_on_a_large_mean);
    tcase_add_test(tc, a_constant_has_no_variance);
    tcase_add_test(tc, batches_hold_the_means_of_blocks);
    tcase_add_test(tc, merging_equals_the_whole);
    tcase_add_test(tc, variance_needs_two_samples);
    suite_add_tcase(suite, tc);
    tc = tcase_create("merge");
    tcase_add_test(tc, create_checks_the_size);
    tcase_add_loop_test(tc, shards_paste_bit_exactly, 0, 4);
    tcase_add_test(tc, parts_of_shards_merge_with_each_other);
    tcase_add_test(tc, streams_are_weighted_by_n);
    tcase_add_test(tc, ranges_join_and_never_overlap);
    tcase_add_test(tc, merge_refuses_what_differs);
    tcase_add_test(tc, bad_samples_add_up);
    tcase_add_test(tc, third_moments_survive_only_in_pairs);
    suite_add_tcase(suite, tc);
    return suite;
}
