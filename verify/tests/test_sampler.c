/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The random numbers: published vectors, the layout of the counter, streams that never meet. */
#include "verify/tests/tests.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/host.h"
#include "estimators/registry.h"
#include "verify/mutants/registry.h"
#include "verify/stats/stats.h"

static lc_sampler start(uint64_t seed, uint32_t arm, uint32_t pixel, uint32_t sample)
{
    lc_sampler s;
    lc_sampler_start(&s, seed, arm, pixel, sample);
    return s;
}

/* The 32 bits behind a number, and nothing else. */
static uint32_t bits(double u)
{
    uint32_t word = (uint32_t)(u * 0x1p32);
    ck_assert_double_eq(u, word * 0x1p-32);
    return word;
}

static void ck_block(lc_sampler *s, const uint32_t expected[4])
{
    for (int i = 0; i < 4; ++i)
        ck_assert_uint_eq(bits(lc_next(s)), expected[i]);
}

/* Random123, tests/kat_vectors, philox4x32 with 10 rounds. The third vector (all ones) is out of reach: a block index has 30 bits. */
START_TEST(known_answers_of_random123)
{
    static const uint32_t zero[4] = {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8};
    static const uint32_t pi[4] = {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1};
    lc_sampler s = start(0, 0, 0, 0);
    ck_block(&s, zero);
    /* counter (block, pixel, sample, arm) = 243f6a88 85a308d3 13198a2e 03707344, key = seed, low word first */
    s = start(0x299f31d0a4093822u, 0x03707344, 0x85a308d3, 0x13198a2e);
    lc_sampler_seek(&s, 0x243f6a88u << 2);
    ck_block(&s, pi);
}
END_TEST

/* Its one chance in 2^32 is not waited for: the block is set by hand. */
START_TEST(the_largest_number_is_below_one)
{
    lc_sampler s = start(0, 0, 0, 0);
    lc_sampler_seek(&s, 0);
    s.block[0] = UINT32_MAX;
    double u = lc_next(&s);
    ck_assert(u == 1 - 0x1p-32);
}
END_TEST

START_TEST(seek_gives_what_walking_gives)
{
    double walked[64];
    lc_sampler s = start(7, 1, 2, 3);
    for (int i = 0; i < 64; ++i)
        walked[i] = lc_next(&s);
    for (int i = 63; i >= 0; i -= 3) {
        lc_sampler_seek(&s, (uint32_t)i);
        ck_assert(lc_next(&s) == walked[i]);
        ck_assert_uint_eq(s.dimension, (uint32_t)i + 1);
    }
    /* A seek within the loaded block, and back to its start. */
    lc_sampler_seek(&s, 5);
    ck_assert(lc_next(&s) == walked[5]);
    lc_sampler_seek(&s, 4);
    ck_assert(lc_next(&s) == walked[4]);
}
END_TEST

START_TEST(numbers_are_in_zero_one_and_uniform)
{
    enum { N = 400000, BINS = 64 };
    double seen[BINS] = {0}, expected[BINS], least = 1, most = 0;
    lc_chi_square chi;
    lc_error err;
    for (int i = 0; i < BINS; ++i)
        expected[i] = (double)N / BINS;
    for (uint32_t k = 0; k < N / 20; ++k) {
        lc_sampler s = start(1, lc_arm("light_direct"), k % 100, k / 100);
        for (int i = 0; i < 20; ++i) {
            double u = lc_next(&s);
            ck_assert(u >= 0 && u < 1);
            least = u < least ? u : least;
            most = u > most ? u : most;
            ++seen[(int)(u * BINS)];
        }
    }
    ck_assert_int_eq(lc_chi_square_test(&chi, seen, expected, BINS, 5, 0, &err), LC_OK);
    ck_assert_msg(chi.log_p > -14, "p = exp(%g)", chi.log_p);
    ck_assert(least < 1e-4 && most > 1 - 1e-4);
}
END_TEST

static int compare_words(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

/* The first two numbers of a stream as one word of 64 bits: 40 000 of them all differ, or two streams are one. By
 * chance two meet with probability 4e-11. */
START_TEST(streams_never_meet)
{
    enum { N = 10000 };
    static uint64_t words[4 * N];
    size_t count = 0;
    for (uint32_t i = 0; i < N; ++i) {
        lc_sampler s[4] = {start(1, 5, i + 1, 9), start(1, 5, 0, i + 100000), start(1, i + 10, 0, 9),
                           start(i + 2ull + ((uint64_t)i << 32), 5, 0, 9)};
        for (int k = 0; k < 4; ++k) {
            uint64_t high = bits(lc_next(&s[k]));
            words[count++] = high << 32 | bits(lc_next(&s[k]));
        }
    }
    qsort(words, count, sizeof words[0], compare_words);
    for (size_t i = 1; i < count; ++i)
        ck_assert(words[i] != words[i - 1]);
}
END_TEST

/* Both halves of the seed count. */
START_TEST(whole_seed_is_key)
{
    lc_sampler a = start(1, 0, 0, 0), b = start(1ull << 32, 0, 0, 0), c = start(1ull << 32 | 1, 0, 0, 0);
    double x = lc_next(&a), y = lc_next(&b), z = lc_next(&c);
    ck_assert(x != y && y != z && x != z);
}
END_TEST

static const char *name_of(int i)
{
    int estimators = 0;
    while (lc_estimators[estimators])
        ++estimators;
    if (i < estimators)
        return lc_estimators[i]->name;
    const lc_mutant *mutant = lc_mutant_at(i - estimators);
    return mutant ? mutant->estimator->name : NULL;
}

/* Also under the names that the judge gives to those outside the registry, and to its pilots (the complement). */
START_TEST(arms_are_distinct)
{
    static uint64_t arms[4096];
    size_t count = 0;
    const char *name;
    for (int i = 0; (name = name_of(i)) != NULL; ++i) {
        char outside[160];
        snprintf(outside, sizeof outside, "under test: %s", name);
        uint32_t hash[2] = {lc_arm(name), lc_arm(outside)};
        for (int k = 0; k < 2; ++k) {
            arms[count++] = hash[k];
            arms[count++] = (uint32_t)~hash[k];
        }
        ck_assert_uint_lt(count, 4000);
    }
    ck_assert_uint_ge(count, 4 * 14);
    qsort(arms, count, sizeof arms[0], compare_words);
    for (size_t i = 1; i < count; ++i)
        ck_assert(arms[i] != arms[i - 1]);
}
END_TEST

/* FNV-1a, 32 bits: the test vectors of its authors' page. */
START_TEST(arm_is_fnv1a)
{
    ck_assert_uint_eq(lc_arm(""), 0x811c9dc5);
    ck_assert_uint_eq(lc_arm("a"), 0xe40c292c);
    ck_assert_uint_eq(lc_arm("foobar"), 0xbf9cf968);
}
END_TEST

Suite *lc_suite_sampler(void)
{
    Suite *suite = suite_create("sampler");
    TCase *tc = tcase_create("core");
    tcase_set_timeout(tc, 30);
    tcase_add_test(tc, known_answers_of_random123);
    tcase_add_test(tc, the_largest_number_is_below_one);
    tcase_add_test(tc, seek_gives_what_walking_gives);
    tcase_add_test(tc, numbers_are_in_zero_one_and_uniform);
    tcase_add_test(tc, streams_never_meet);
    tcase_add_test(tc, whole_seed_is_key);
    tcase_add_test(tc, arms_are_distinct);
    tcase_add_test(tc, arm_is_fnv1a);
    suite_add_tcase(suite, tc);
    return suite;
}
