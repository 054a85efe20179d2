/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pyramid: does it find what is planted, name it, and stay silent otherwise? And the budget. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "verify/stats/stats.h"
#include "verify/tests/tests.h"

static void check_close(double got, double expected, double relative)
{
    ck_assert_msg(fabs(got - expected) <= relative * fabs(expected), "%.17g, expected %.17g", got, expected);
}

/* splitmix64 (Steele, Lea, Flood 2014), a fixed seed a test. */
static double next(uint64_t *state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static double normal(uint64_t *state)
{
    double radius = sqrt(-2 * log(1 - next(state)));
    return radius * cos(2 * LC_PI * next(state));
}

/* A symmetric pixel of n samples with this mean and standard deviation of a sample, as measured exactly. */
static lc_pixel symmetric(double n, double mean, double deviation)
{
    lc_pixel p;
    memset(&p, 0, sizeof p);
    p.n = (uint64_t)n;
    p.c[0].mean = mean;
    p.c[0].m2 = deviation * deviation * (n - 1);
    return p;
}

enum { MOST = 64 * 64 };
static lc_estimate field[MOST];

/* Pixels of 1024 samples of mean 1 and deviation 1 with their proper noise, against 1. */
static void set_noise(int width, int height, uint64_t *state)
{
    for (int i = 0; i < width * height; ++i) {
        lc_pixel p = symmetric(1024, 1 + normal(state) / 32, 1);
        field[i] = lc_estimate_one(&p, 1, 0, 1, 0);
    }
}

static lc_pyramid judge(int width, int height, const lc_pyramid_plan *plan)
{
    lc_pyramid out;
    lc_error err;
    ck_assert_msg(lc_pyramid_judge(&out, field, width, height, plan, &err) == LC_OK, "%s", err.text);
    return out;
}

/* ---- shape and budget ---------------------------------------------------------------------------------------------
 */

START_TEST(levels_cover_any_size)
{
    static const int sizes[][3] = {{1, 1, 1},  {2, 1, 2},      {3, 1, 3}, {1, 5, 4},    {64, 64, 7},
                                   {65, 3, 8}, {16384, 1, 15}, {0, 4, 0}, {4, 16385, 0}};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i)
        ck_assert_int_eq(lc_pyramid_levels(sizes[i][0], sizes[i][1]), sizes[i][2]);
    uint64_t state = 1;
    set_noise(37, 21, &state);
    lc_pyramid_plan plan;
    lc_pyramid_plan_init(&plan, 1e-6, 1e-6);
    lc_pyramid r = judge(37, 21, &plan);
    static const uint32_t tiles[] = {777, 19 * 11, 10 * 6, 5 * 3, 3 * 2, 2, 1};
    double spent = 0;
    ck_assert_int_eq(r.levels, 7);
    for (int l = 0; l < 7; ++l) {
        ck_assert_uint_eq(r.level[l].tiles, tiles[l]);
        ck_assert_uint_eq(r.level[l].tested, tiles[l]);
        spent += r.level[l].tiles * r.level[l].alpha;
    }
    check_close(spent, 1e-6, 1e-12);
    ck_assert(r.whole.width == 37 && r.whole.height == 21 && r.whole.level == 6 && !isnan(r.whole.log_p));
    ck_assert(r.verdict == LC_GO_ON);
}
END_TEST

START_TEST(budget_is_spent_once)
{
    lc_budget b = {1e-6, 2e-6, 300, 3, 6};
    check_close(lc_budget_row_fail(&b) * 300 * 3 * 6, 1e-6, 1e-12);
    check_close(lc_budget_row_pass(&b) * 300 * 6, 2e-6, 1e-12);
    char text[2048], small[40];
    int length = lc_budget_text(text, sizeof text, &b, 64, 64);
    ck_assert_int_eq(length, (int)strlen(text));
    ck_assert(strstr(text, "4096 tiles") && strstr(text, "300 rows x 6 looks") && strstr(text, "exact rows are outside of it"));
    ck_assert_int_eq(lc_budget_text(small, sizeof small, &b, 64, 64), length);
    ck_assert_uint_eq(strlen(small), sizeof small - 1);
    b.looks = 0;
    ck_assert(isnan(lc_budget_row_fail(&b)) && isnan(lc_budget_row_pass(&b)));
}
END_TEST

START_TEST(looks_are_shares_of_the_plan)
{
    static const uint64_t by_hand[] = {2048, 4096, 6144, 10240, 40832}; /* in whole blocks of 64 */
    lc_looks looks = lc_looks_plan(10200, 1 << 20);
    ck_assert_int_eq(looks.count, 5);
    for (int k = 0; k < 5; ++k)
        ck_assert_uint_eq(looks.samples[k], by_hand[k]);
    looks = lc_looks_plan(10200, 20000); /* no reserve beyond the cap */
    ck_assert(looks.count == 4 && looks.samples[3] == 10240);
    looks = lc_looks_plan(1 << 20, 10240); /* the cap is the plan */
    ck_assert(looks.count == 4 && looks.samples[0] == 2048 && looks.samples[3] == 10240);
    looks = lc_looks_plan(1 << 20, 10250); /* of which only whole blocks can be taken */
    ck_assert(looks.count == 4 && looks.samples[3] == 10240);
    looks = lc_looks_plan(1000, 1 << 20); /* the first share lies below the floor, which is looked at once */
    ck_assert(looks.count == 5 && looks.samples[0] == LC_LEAST_SAMPLES && looks.samples[1] == 448);
    looks = lc_looks_plan(100, 1 << 20);
    ck_assert(looks.count == 2 && looks.samples[0] == LC_LEAST_SAMPLES && looks.samples[1] == 1024);
    looks = lc_looks_plan(100, 10); /* somebody has to look once */
    ck_assert(looks.count == 1 && looks.samples[0] == LC_LEAST_SAMPLES);
    lc_looks_reserve(&looks, 1 << 20); /* no look is left over for less than four times the last */
    ck_assert(looks.count == LC_MOST_LOOKS && looks.samples[1] == 4 * LC_LEAST_SAMPLES && looks.samples[4] == 65536);
    looks = lc_looks_plan(100, 1 << 20);
    lc_looks_reserve(&looks, 16383);
    ck_assert(looks.count == 3 && looks.samples[2] == 4096);
    check_close(lc_samples_needed(2, 0.01, 11), 2200.0 * 2200.0, 1e-14);
}
END_TEST

/* ---- finding
 * ----------------------------------------------------------------------------------------------------------- */

/* A bias in one tile of each size is found there, with the size it has. */
START_TEST(planted_bias_is_named)
{
    const int width = 50, height = 37;
    uint64_t state = 7;
    for (int level = 0; level < 7; ++level)
        for (int sign = -1; sign <= 1; sign += 2) {
            int size = 1 << level, x0 = level < 5 ? size : 0, y0 = x0;
            double bias = sign * 14 / 32.0 / size; /* 14 sigma where the tile is whole */
            set_noise(width, height, &state);
            for (int y = y0; y < y0 + size && y < height; ++y)
                for (int x = x0; x < x0 + size && x < width; ++x)
                    field[y * width + x].difference += bias;
            lc_pyramid_plan plan;
            lc_pyramid_plan_init(&plan, 1e-6, 1e-6);
            lc_pyramid r = judge(width, height, &plan);
            ck_assert_int_eq(r.verdict, LC_FAIL);
            ck_assert_msg(r.worst.level == level && r.worst.x == x0 && r.worst.y == y0,
                          "level %d: named %d at (%d, %d)", level, r.worst.level, r.worst.x, r.worst.y);
            ck_assert_int_eq(r.worst.width, x0 + size < width ? size : width - x0);
            check_close(r.worst.student.difference, bias, 0.4);
            check_close(r.worst.student.expected, 1, 1e-12);
            ck_assert(r.worst.log_p <= log(1e-6));
        }
}
END_TEST

/* The shortcuts change nothing: the worst tile of a rugged field is that of a search without any. */
START_TEST(worst_tile_is_the_worst)
{
    enum { W = 21, H = 13 };
    uint64_t state = 11;
    for (int trial = 0; trial < 200; ++trial) {
        double best = INFINITY;
        for (int i = 0; i < W * H; ++i) {
            double n = 256 * (1 + floor(8 * next(&state))), deviation = exp(2 * normal(&state));
            lc_pixel p = symmetric(n, 1 + (1 + 0.05 * trial) * deviation * normal(&state) / sqrt(n), deviation);
            p.c[0].m3 = n * pow(deviation, 3) * 0.001 * normal(&state);
            field[i] = lc_estimate_one(&p, 1, 0, 1, 1e-4);
        }
        lc_pyramid_plan plan;
        lc_pyramid_plan_init(&plan, 1e-3, 1e-3);
        plan.guard = LC_GUARD_OWN;
        lc_pyramid r = judge(W, H, &plan);
        for (int l = 0; l < r.levels; ++l)
            for (int y0 = 0; y0 < H; y0 += 1 << l)
                for (int x0 = 0; x0 < W; x0 += 1 << l) {
                    lc_estimate sum = lc_estimate_zero();
                    for (int y = y0; y < y0 + (1 << l) && y < H; ++y)
                        for (int x = x0; x < x0 + (1 << l) && x < W; ++x)
                            lc_estimate_add(&sum, &field[y * W + x]);
                    lc_student s = lc_estimate_student(&sum);
                    int side = s.difference < 0 ? LC_LOW : LC_HIGH;
                    double bound = side == LC_LOW ? -s.tolerance : s.tolerance;
                    double log_p = lc_student_log_p(&s, side, bound, 0.5 * r.level[l].alpha) +
                                   log(2.0 * r.level[l].tiles * r.levels);
                    if (log_p < best)
                        best = log_p;
                }
        ck_assert_msg(fabs(fmin(best, 0) - r.worst.log_p) < 1e-9 * (1 + fabs(best)), "%g, expected %g", r.worst.log_p,
                      best);
        ck_assert(r.verdict == (best <= log(1e-3) ? LC_FAIL : LC_GO_ON));
    }
}
END_TEST

START_TEST(scaled_data_give_the_same)
{
    uint64_t state = 13;
    lc_pyramid_plan plan;
    lc_pyramid_plan_init(&plan, 1e-6, 1e-6);
    set_noise(30, 20, &state);
    lc_pyramid a = judge(30, 20, &plan);
    state = 13;
    for (int i = 0; i < 600; ++i) {
        lc_pixel p = symmetric(1024, 256 * (1 + normal(&state) / 32), 256);
        field[i] = lc_estimate_one(&p, 1, 0, 256, 0);
    }
    lc_pyramid b = judge(30, 20, &plan);
    ck_assert(a.worst.log_p == b.worst.log_p && a.worst.x == b.worst.x && a.worst.level == b.worst.level);
    ck_assert(256 * a.worst.student.difference == b.worst.student.difference);
}
END_TEST

/* ---- silence
 * ------------------------------------------------------------------------------------------------------------ */

typedef double draw(uint64_t *state);
static double exponential(uint64_t *state) { return -log(1 - next(state)); }
static double lognormal(uint64_t *state) { return exp(0.7 * normal(state) - 0.245); }
static double coin(uint64_t *state) { return next(state) < 0.05 ? 20 : 0; }
static double flat(uint64_t *state) { return 2 * next(state); }

/* All of mean 1; skewness 0, 2, 2.9, 4.1. At alpha = 0.05 for false FAILs of a 4 x 4 image, against the truth or
 * another film. */
START_TEST(false_fail_rate_is_held)
{
    static draw *const draws[] = {flat, exponential, lognormal, coin};
    uint64_t state = 17;
    for (int d = 0; d < 4; ++d)
        for (int arms = 1; arms <= 2; ++arms) {
            const int trials = 500, n = 256;
            int failed = 0, tested = 0;
            for (int t = 0; t < trials; ++t) {
                for (int i = 0; i < 16; ++i) {
                    lc_pixel p[2];
                    for (int arm = 0; arm < arms; ++arm) {
                        double samples[256], mean = 0;
                        for (int k = 0; k < n; ++k)
                            mean += (samples[k] = draws[d](&state)) / n;
                        p[arm] = symmetric(n, mean, 0);
                        for (int k = 0; k < n; ++k) {
                            p[arm].c[0].m2 += pow(samples[k] - mean, 2);
                            p[arm].c[0].m3 += (samples[k] - mean) * (samples[k] - mean) * (samples[k] - mean);
                        }
                    }
                    field[i] =
                        arms == 1 ? lc_estimate_one(&p[0], 1, 0, 1, 0) : lc_estimate_two(&p[0], 1, &p[1], 1, 0, 0);
                }
                lc_pyramid_plan plan;
                lc_pyramid_plan_init(&plan, 0.05, 0.05);
                lc_pyramid r = judge(4, 4, &plan);
                failed += r.verdict == LC_FAIL;
                tested += r.level[2].tested > 0;
            }
            lc_interval rate = lc_clopper_pearson(failed, trials, 1e-3);
            ck_assert_msg(rate.lower <= 0.05, "distribution %d, %d arms: %d of %d", d, arms, failed, trials);
            ck_assert_msg(tested > trials / 2, "distribution %d, %d arms: %d tested", d, arms, tested);
        }
}
END_TEST

/* n samples of mean `scale`, a bright one in 1/rate worth `worth`, the others with a deviation of `calm`; against the truth. */
static lc_estimate rare(double n, double scale, double calm, double rate, double worth, uint64_t *state)
{
    double hits = 0; /* Poisson, by products of uniform numbers (Knuth) */
    for (double product = next(state); product > exp(-n * rate); product *= next(state))
        ++hits;
    lc_pixel p = symmetric(n, scale * (1 + calm * normal(state) / sqrt(n) + (hits / n - rate) * worth), scale * calm);
    p.c[0].m2 += hits * pow(scale * worth, 2) * (1 - hits / n);
    p.c[0].m3 += hits * pow(scale * worth, 3);
    p.c[0].max = scale * (hits > 0 ? worth : 1 + 3 * calm);
    return lc_estimate_one(&p, 1, 0, scale, 0);
}

/* The right half is 100 times as dark and much calmer, but for one sample in 1000. The variance of the bright half hides that from the
 * image's moments, however they are weighed: the larger tiles around a tile know. */
START_TEST(guard_knows_of_rare_samples_in_the_dark)
{
    uint64_t state = 23;
    for (int trial = 0; trial < 20; ++trial) {
        lc_pyramid_plan plan;
        for (int i = 0; i < 64 * 64; ++i)
            field[i] = i % 64 < 32 ? rare(256, 1, 0.6, 1e-12, 1, &state) : rare(256, 0.01, 0.005, 1e-3, 1, &state);
        lc_pyramid_plan_init(&plan, 1e-6, 1e-6);
        lc_pyramid out = judge(64, 64, &plan);
        ck_assert_msg(out.verdict != LC_FAIL, "trial %d: %dx%d pixels at %d,%d", trial, out.worst.width, out.worst.height,
                      out.worst.x, out.worst.y);
    }
}
END_TEST

/* The same where each dark tile lies among bright ones, and meets no bright sample at all in every twentieth trial: only the other dark
 * tiles know, and what contains several of them contains as many bright ones. */
START_TEST(guard_knows_of_rare_samples_elsewhere_in_the_dark)
{
    uint64_t state = 29;
    for (int trial = 0; trial < 20; ++trial) {
        lc_pyramid_plan plan;
        for (int i = 0; i < 32 * 32; ++i)
            field[i] = (i % 32 / 8 + i / 256) % 2 ? rare(256, 1, 0.6, 1e-12, 1, &state) : rare(256, 0.01, 0.54, 1.8e-4, 555, &state);
        lc_pyramid_plan_init(&plan, 1e-6, 1e-6);
        lc_pyramid out = judge(32, 32, &plan);
        ck_assert_msg(out.verdict != LC_FAIL, "trial %d: %dx%d pixels at %d,%d", trial, out.worst.width, out.worst.height,
                      out.worst.x, out.worst.y);
    }
}
END_TEST

/* A tile that is 5% too dark is found beside tiles of skewed samples: so many of them that it cannot have missed them by chance. */
START_TEST(skewed_neighbours_hide_nothing)
{
    lc_pyramid_plan plan;
    uint64_t state = 31;
    const double n = 1024;
    for (int i = 0; i < 32 * 32; ++i) {
        int x = i % 32 / 8, y = i / 256, is_wrong = x == 1 && y == 1, is_skewed = x < 2 && y < 2 && !is_wrong;
        lc_pixel p = symmetric(n, (is_wrong ? 0.95 : 1) + normal(&state) / sqrt(n), 1);
        p.c[0].m3 = is_skewed ? 6 * n : 0;
        p.c[0].max = 5;
        field[i] = lc_estimate_one(&p, 1, 0, 1, 0);
    }
    lc_pyramid_plan_init(&plan, 1e-6, 1e-6);
    lc_pyramid out = judge(32, 32, &plan);
    ck_assert_int_eq(out.verdict, LC_FAIL);
    ck_assert_msg(out.worst.level == 3 && out.worst.x == 8 && out.worst.y == 8, "level %d, %d,%d", out.worst.level, out.worst.x, out.worst.y);
}
END_TEST

/* Each pixel is calm but for a bright sample in 100 000, worth 1000: most pixels never meet one, and their own moments
 * know nothing of it. Each tile's own skewness lets them fail against the truth; the pooled one does not. */
START_TEST(pooled_guard_knows_of_rare_samples)
{
    uint64_t state = 19;
    int failed[2] = {0, 0};
    for (int trial = 0; trial < 20; ++trial) {
        const double n = 4096, rate = 1e-5, worth = 1000;
        for (int i = 0; i < 256; ++i)
            field[i] = rare(n, 1, 0.1, rate, worth, &state);
        for (int guard = 0; guard < 2; ++guard) {
            lc_pyramid_plan plan;
            lc_pyramid_plan_init(&plan, 1e-6, 1e-6);
            plan.guard = guard ? LC_GUARD_OWN : LC_GUARD_POOLED;
            failed[guard] += judge(16, 16, &plan).verdict == LC_FAIL;
        }
    }
    ck_assert_int_eq(failed[0], 0);
    ck_assert_int_eq(failed[1], 20);
}
END_TEST

/* A pixel that does not vary never fails alone, however far off; with neighbours that vary it counts. */
START_TEST(still_pixels_do_not_test_alone)
{
    uint64_t state = 23;
    lc_pyramid_plan plan;
    lc_pyramid_plan_init(&plan, 1e-6, 1e-6);
    set_noise(8, 8, &state);
    lc_pixel still = symmetric(1024, 1.05, 0);
    field[9] = lc_estimate_one(&still, 1, 0, 1, 0);
    lc_pyramid r = judge(8, 8, &plan);
    ck_assert(r.verdict == LC_GO_ON && r.level[0].still == 1 && r.level[0].tested == 63 && r.level[1].still == 0);
    still = symmetric(1024, 2, 0);
    field[9] = lc_estimate_one(&still, 1, 0, 1, 0);
    r = judge(8, 8, &plan);
    ck_assert(r.verdict == LC_FAIL && r.worst.level == 1 && r.worst.x == 0 && r.worst.y == 0);
    /* Nothing varies: nothing is known, and nothing is equal either. */
    for (int i = 0; i < 64; ++i)
        field[i] = lc_estimate_one(&still, 1, 0, i % 2 ? 2 : 1, 0);
    plan.margin[3] = 10;
    r = judge(8, 8, &plan);
    ck_assert(r.verdict == LC_GO_ON && r.worst.level == -1 && isnan(r.worst.log_p) && r.level[3].still == 1);
    ck_assert(r.blocking.level == 3);
}
END_TEST

START_TEST(few_samples_do_not_test)
{
    lc_pyramid_plan plan;
    lc_pyramid_plan_init(&plan, 1e-6, 1e-6);
    for (int n = 1; n <= 256; n += 51) {
        for (int i = 0; i < 16; ++i) {
            lc_pixel p = symmetric(n, 9, n > 1 ? 1 : 0);
            field[i] = lc_estimate_one(&p, 1, 0, 1, 0);
        }
        lc_pyramid r = judge(4, 4, &plan);
        ck_assert(r.verdict == (n == 256 ? LC_FAIL : LC_GO_ON));
        ck_assert_uint_eq(r.level[2].few, n == 256 ? 0 : 1);
    }
    for (int l = 0; l < LC_LEVELS; ++l)
        plan.least[l] = 0; /* a single sample still has no variance */
    lc_pixel p = symmetric(1, 9, 0);
    field[5] = lc_estimate_one(&p, 1, 0, 1, 0);
    lc_pyramid r = judge(4, 4, &plan);
    ck_assert(r.level[0].few == 1 && r.level[1].few == 1 && r.level[2].few == 1 && r.level[0].tested == 15);
}
END_TEST

/* ---- passing
 * ------------------------------------------------------------------------------------------------------------- */

START_TEST(pass_needs_every_declared_level)
{
    uint64_t state = 29;
    lc_pyramid_plan plan;
    lc_pyramid_plan_init(&plan, 1e-6, 1e-6);
    set_noise(32, 32, &state);
    ck_assert(judge(32, 32, &plan).verdict == LC_GO_ON); /* nothing declared, nothing shown */
    plan.margin[5] = 0.01;                               /* one sigma is 1 / 1024 */
    lc_pyramid r = judge(32, 32, &plan);
    ck_assert(r.verdict == LC_PASS && r.level[5].within && r.blocking.level == -1);
    plan.margin[5] = 0.002;
    r = judge(32, 32, &plan);
    ck_assert(r.verdict == LC_GO_ON && r.blocking.level == 5);
    plan.margin[5] = 0.01;
    plan.margin[0] = 0.4; /* one sigma is 1 / 32 */
    r = judge(32, 32, &plan);
    ck_assert(r.verdict == LC_PASS && r.level[0].within && r.level[5].within && !r.level[1].within);
    field[32 * 7 + 20].difference = 0.26; /* 8.3 sigma: too near to the margin to be within, and different from 0 */
    r = judge(32, 32, &plan);
    ck_assert(r.verdict == LC_FAIL && r.worst.level == 0);
    for (int i = 0; i < 32 * 32; ++i)
        field[i].tolerance = 0.2; /* declared inaccurate: no longer shown different, but not equal either */
    r = judge(32, 32, &plan);
    ck_assert(r.verdict == LC_GO_ON && r.blocking.level == 0 && r.blocking.x == 20 && r.blocking.y == 7 &&
              r.level[5].within);
}
END_TEST

/* ---- refusing
 * -------------------------------------------------------------------------------------------------------------- */

START_TEST(broken_numbers_are_refused)
{
    uint64_t state = 31;
    lc_pyramid_plan plan;
    lc_pyramid out;
    lc_error err;
    lc_pyramid_plan_init(&plan, 1e-6, 1e-6);
    for (int i = 0; i < 4; ++i) {
        set_noise(5, 4, &state);
        lc_estimate *e = &field[13];
        double *broken[] = {&e->difference, &e->arm[0].variance, &e->arm[1].third, &e->expected};
        *broken[i] = i == 3 ? INFINITY : NAN;
        ck_assert(lc_pyramid_judge(&out, field, 5, 4, &plan, &err) == LC_BAD_INPUT);
        ck_assert(strstr(err.text, "pixel (3, 2)") != NULL && out.verdict == LC_GO_ON);
    }
    set_noise(5, 4, &state);
    field[0].arm[0].variance = -1;
    ck_assert(lc_pyramid_judge(&out, field, 5, 4, &plan, &err) == LC_BAD_INPUT);
    ck_assert(lc_pyramid_judge(&out, field, 0, 4, &plan, &err) == LC_BAD_INPUT);
    plan.margin[1] = NAN;
    ck_assert(lc_pyramid_judge(&out, field + 1, 3, 3, &plan, &err) == LC_BAD_INPUT);
    lc_pyramid_plan_init(&plan, 0, 1e-6);
    ck_assert(lc_pyramid_judge(&out, field + 1, 3, 3, &plan, &err) == LC_BAD_INPUT);
}
END_TEST

Suite *lc_suite_stats_pyramid(void)
{
    Suite *suite = suite_create("stats_pyramid");
    TCase *cases = tcase_create("pyramid");
    tcase_add_test(cases, levels_cover_any_size);
    tcase_add_test(cases, budget_is_spent_once);
    tcase_add_test(cases, looks_are_shares_of_the_plan);
    tcase_add_test(cases, planted_bias_is_named);
    tcase_add_test(cases, worst_tile_is_the_worst);
    tcase_add_test(cases, scaled_data_give_the_same);
    tcase_add_test(cases, false_fail_rate_is_held);
    tcase_add_test(cases, pooled_guard_knows_of_rare_samples);
    tcase_add_test(cases, guard_knows_of_rare_samples_in_the_dark);
    tcase_add_test(cases, skewed_neighbours_hide_nothing);
    tcase_add_test(cases, guard_knows_of_rare_samples_elsewhere_in_the_dark);
    tcase_add_test(cases, still_pixels_do_not_test_alone);
    tcase_add_test(cases, few_samples_do_not_test);
    tcase_add_test(cases, pass_needs_every_declared_level);
    tcase_add_test(cases, broken_numbers_are_refused);
    tcase_set_timeout(cases, 60);
    suite_add_tcase(suite, cases);
    return suite;
}
