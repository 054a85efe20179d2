/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Differences of means: exact enumeration of what the tests do, at the levels at which they are used. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "verify/stats/stats.h"
#include "verify/tests/tests.h"

static void check_close(double got, double expected, double relative)
{
    ck_assert_msg(fabs(got - expected) <= relative * fabs(expected), "%.17g, expected %.17g", got, expected);
}

/* A pixel of `count` samples, its moments by definition. */
static lc_pixel pixel_of(const double *samples, int count)
{
    lc_pixel p;
    memset(&p, 0, sizeof p);
    p.n = (uint64_t)count;
    for (int i = 0; i < count; ++i)
        p.c[0].mean += samples[i] / count;
    for (int i = 0; i < count; ++i) {
        double d = samples[i] - p.c[0].mean;
        p.c[0].m2 += d * d;
        p.c[0].m3 += d * d * d;
    }
    return p;
}

/* n samples of which k are 1, the others 0. */
static lc_pixel bernoulli(double n, double k)
{
    lc_pixel p;
    memset(&p, 0, sizeof p);
    double q = k / n;
    p.n = (uint64_t)n;
    p.c[0].mean = q;
    p.c[0].m2 = n * q * (1 - q);
    p.c[0].m3 = n * q * (1 - q) * (1 - 2 * q);
    return p;
}

static double log_binomial(double n, double k, double p)
{
    return lgamma(n + 1) - lgamma(k + 1) - lgamma(n - k + 1) + k * log(p) + (n - k) * log1p(-p);
}

/* ---- sums ------------------------------------------------------------------------------------------------------ */

/* Over all 3^5 samples of a three-point distribution, v and the third cumulant are right on average. */
START_TEST(moments_are_unbiased)
{
    static const double value[] = {0, 1, 5}, weight[] = {0.5, 0.375, 0.125};
    enum { N = 5 };
    double mean = 0, mu2 = 0, mu3 = 0, v = 0, third = 0, bound = 0;
    for (int i = 0; i < 3; ++i)
        mean += weight[i] * value[i];
    for (int i = 0; i < 3; ++i) {
        mu2 += weight[i] * pow(value[i] - mean, 2);
        mu3 += weight[i] * pow(value[i] - mean, 3);
    }
    for (int code = 0; code < 243; ++code) {
        double samples[N], p = 1;
        for (int i = 0, c = code; i < N; ++i, c /= 3) {
            samples[i] = value[c % 3];
            p *= weight[c % 3];
        }
        lc_pixel pixel = pixel_of(samples, N);
        lc_estimate e = lc_estimate_one(&pixel, 1, 0, 0, 0), from_file = lc_estimate_one(&pixel, 0, 0, 0, 0);
        v += p * e.arm[0].variance;
        third += p * e.arm[0].third;
        bound = fmax(bound, fabs(e.arm[0].third) - from_file.arm[0].doubt);
    }
    check_close(v, mu2 / N, 1e-13);
    check_close(third, mu3 / (N * N), 1e-13);
    ck_assert(bound <= 1e-15); /* what is unknown is bounded */
}
END_TEST

START_TEST(tiles_are_sums_of_pixels)
{
    static const double x[] = {1, 2, 6}, y[] = {0, 0, 1, 3}, z[] = {2, 4};
    lc_pixel a = pixel_of(x, 3), b = pixel_of(y, 4), c = pixel_of(z, 2);
    lc_estimate sum = lc_estimate_zero(), e = lc_estimate_two(&a, 1, &b, 1, 0, 0.25),
                f = lc_estimate_two(&b, 1, &c, 1, 0, 0.75);
    lc_estimate_add(&sum, &e);
    lc_estimate_add(&sum, &f);
    lc_student s = lc_estimate_student(&sum);
    /* Variances of the means: x 14 / 6, y 6 / 12, z 2 / 2. */
    double va = 14.0 / 6, vb = 0.5, vc = 1;
    check_close(s.difference, (3 - 1 + 1 - 3) / 2.0, 1e-15);
    check_close(s.expected, 2, 1e-15);
    check_close(s.tolerance, 0.5, 1e-15);
    check_close(s.error, sqrt(va + 2 * vb + vc) / 2, 1e-14);
    check_close(s.df, pow(va + 2 * vb + vc, 2) / (va * va / 2 + 2 * vb * vb / 3 + vc * vc), 1e-14);
    /* Third cumulants of the means: x (-8 - 1 + 27) / 6 = 3, y (-1 - 1 + 8) / 24 = 1 / 4; z is unknown, at most 2^1.5
     * / 2. */
    double cubed = pow(va + 2 * vb + vc, 1.5), doubt = sqrt(2);
    check_close(s.skew[LC_LOW], (3.25 + doubt) / cubed, 1e-13);
    check_close(s.skew[LC_HIGH], (0.25 + doubt) / cubed, 1e-13); /* arm b spoils the other side; nothing cancels */
    ck_assert(s.testable && sum.pixels == 2 && sum.arm[0].least == 3 && sum.arm[1].least == 2);
}
END_TEST

/* Scaling the samples by a power of two changes no p value in any bit, units follow. */
START_TEST(tests_are_equivariant)
{
    static const double x[] = {1, 2, 6, 3, 3, 2}, y[] = {0, 0, 1, 3, 2};
    double u[6], w[5];
    for (int i = 0; i < 6; ++i)
        u[i] = 1024 * x[i];
    for (int i = 0; i < 5; ++i)
        w[i] = 1024 * y[i];
    lc_pixel a = pixel_of(x, 6), b = pixel_of(y, 5), c = pixel_of(u, 6), d = pixel_of(w, 5);
    lc_estimate e = lc_estimate_two(&a, 1, &b, 1, 0, 0.5), f = lc_estimate_two(&c, 1, &d, 1, 0, 512);
    lc_student s = lc_estimate_student(&e), t = lc_estimate_student(&f);
    ck_assert(lc_student_log_p(&s, LC_HIGH, 0.5, 0.1) == lc_student_log_p(&t, LC_HIGH, 512, 0.1));
    ck_assert(!isnan(lc_student_log_p(&s, LC_HIGH, 0.5, 0.1)));
    ck_assert(1024 * lc_student_interval(&s, 0.2).lower == lc_student_interval(&t, 0.2).lower);
    /* Arms exchanged: sides exchanged. */
    lc_estimate back = lc_estimate_two(&b, 1, &a, 1, 0, 0.5);
    lc_student r = lc_estimate_student(&back);
    ck_assert(lc_student_log_p(&r, LC_LOW, -0.5, 0.1) == lc_student_log_p(&s, LC_HIGH, 0.5, 0.1));
}
END_TEST

/* ---- what cannot be tested ------------------------------------------------------------------------------------------
 */

START_TEST(unknown_or_no_variance_is_not_tested)
{
    static const double one[] = {7}, equal[] = {0.1, 0.1, 0.1}, x[] = {1, 2, 6, 4, 2, 1, 1, 5};
    lc_pixel single = pixel_of(one, 1), still = pixel_of(equal, 3), moving = pixel_of(x, 8);
    lc_pixel rounded = still;
    rounded.c[0].m2 = 1e-34;
    lc_estimate cases[] = {lc_estimate_one(&single, 1, 0, 0, 0),          lc_estimate_one(&still, 1, 0, 0, 0),
                           lc_estimate_one(&rounded, 1, 0, 0, 0),         lc_estimate_two(&moving, 1, &still, 1, 0, 0),
                           lc_estimate_two(&moving, 1, &single, 1, 0, 0), lc_estimate_zero()};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        lc_student s = lc_estimate_student(&cases[i]);
        ck_assert(!s.testable);
        ck_assert(isnan(lc_student_log_p(&s, LC_HIGH, 0, 0.4)) && isnan(lc_student_log_p(&s, LC_LOW, 0, 0.4)));
        ck_assert(isinf(lc_student_interval(&s, 0.9).lower) && isinf(lc_student_interval(&s, 0.9).upper));
        ck_assert(lc_student_decide(&s, 0.9, 0.4, 1e9) == LC_GO_ON);
    }
    ck_assert(cases[2].arm[0].still == 1 && cases[0].arm[0].least == 1);
    /* Beside a pixel that moves, the one that does not adds its difference and nothing else. */
    lc_estimate sum = cases[1], e = lc_estimate_one(&moving, 1, 0, 0, 0);
    lc_estimate_add(&sum, &e);
    lc_student s = lc_estimate_student(&sum), alone = lc_estimate_student(&e);
    ck_assert(s.testable && s.df == alone.df && s.error == alone.error / 2 && sum.arm[0].still == 1);
}
END_TEST

START_TEST(not_a_number_never_decides)
{
    static const double x[] = {1, 2, 6, 4, 2, 1, 1, 5};
    for (int i = 0; i < 3; ++i) {
        lc_pixel p = pixel_of(x, 8);
        double *field[] = {&p.c[0].mean, &p.c[0].m2, &p.c[0].m3};
        *field[i] = NAN;
        lc_estimate e = lc_estimate_one(&p, 1, 0, 1, 0);
        lc_student s = lc_estimate_student(&e);
        ck_assert(lc_student_decide(&s, 0.5, 0.4, 1e9) == LC_GO_ON);
    }
    ck_assert(lc_decide_exact(NAN, 1) == LC_FAIL && lc_decide_exact(2, 1) == LC_FAIL &&
              lc_decide_exact(-1, 1) == LC_PASS);
}
END_TEST

START_TEST(films_are_checked)
{
    lc_film a, b;
    lc_pixel pa = bernoulli(100, 20), pb = bernoulli(100, 30);
    lc_estimate e;
    lc_error err;
    memset(&a, 0, sizeof a);
    a.width = a.height = 1;
    a.has_third = 1;
    a.count = 100;
    a.arm = 1;
    a.pixels = &pa;
    b = a;
    b.pixels = &pb;
    ck_assert(lc_field_two(&e, &a, &b, 0, 0, &err) == LC_BAD_INPUT); /* the same stream */
    ck_assert(strstr(err.text, "independent") != NULL);
    b.arm = 2;
    ck_assert(lc_field_two(&e, &a, &b, 0, 0, &err) == LC_OK);
    check_close(e.difference, -0.1, 1e-13);
    lc_range merged = {0, 1, 50, 100}; /* half of them a's */
    b.more = &merged;
    b.more_count = 1;
    ck_assert(lc_field_two(&e, &a, &b, 0, 0, &err) == LC_BAD_INPUT);
    merged.first = 100;
    ck_assert(lc_field_two(&e, &a, &b, 0, 0, &err) == LC_OK);
    ck_assert(lc_field_two(&e, &a, &b, 0, NAN, &err) == LC_BAD_INPUT);
    ck_assert(lc_field_two(&e, &a, &b, 3, 0, &err) == LC_FAULT);
    static const double expected[] = {0.5, 9, 9};
    ck_assert(lc_field_one(&e, &a, expected, 0, 0, &err) == LC_OK);
    check_close(e.difference, -0.3, 1e-13);
    b.width = 2;
    ck_assert(lc_field_two(&e, &a, &b, 0, 0, &err) == LC_BAD_INPUT);
    a.bad = 3;
    a.bad_x = 5;
    ck_assert(lc_field_one(&e, &a, expected, 0, 0, &err) == LC_WRONG);
    ck_assert(strstr(err.text, "pixel (5, 0)") != NULL);
}
END_TEST

/* ---- error rates, exactly -------------------------------------------------------------------------------------------
 */

/* Probability of a verdict for n Bernoulli samples whose true mean is p, tested against `expected`. FAIL wins, so that
 * a false PASS shows only where FAIL is out of reach. */
static double rate_of(lc_verdict verdict, double n, double p, double expected, double alpha, double margin)
{
    double sum = 0, deviation = sqrt(n * p * (1 - p));
    double first = fmax(0, floor(n * p - 15 * deviation)), last = fmin(n, ceil(n * p + 15 * deviation));
    for (double k = first; k <= last; ++k) {
        lc_pixel pixel = bernoulli(n, k);
        lc_estimate e = lc_estimate_one(&pixel, 1, 0, expected, 0);
        lc_student s = lc_estimate_student(&e);
        if (lc_student_decide(&s, verdict == LC_FAIL ? alpha : 1e-300, alpha, margin) == verdict)
            sum += exp(log_binomial(n, k, p));
    }
    return sum;
}

/* Samples at which a Bernoulli distribution is just trusted at one-sided z, times `factor`. */
static double just_trusted(double p, double alpha, double factor)
{
    double z = lc_normal_quantile(alpha), g = (1 - 2 * p) / sqrt(p * (1 - p)), n = g * z * z * z / LC_SKEW_LIMIT;
    return floor(factor * fmax(n * n, 600));
}

/* The rate of false FAILs stays at or under its level wherever the guard stands; without it, it would not. */
START_TEST(false_fail_is_bounded)
{
    static const double alphas[] = {1e-2, 1e-6, 1e-11}, rates[] = {0.01, 0.2, 0.5, 0.97},
                        factors[] = {0.3, 0.9, 1, 1.2, 2, 8};
    double largest = 0;
    for (int a = 0; a < 3; ++a)
        for (int r = 0; r < 4; ++r)
            for (int f = 0; f < 6; ++f) {
                double n = just_trusted(rates[r], alphas[a] / 2, factors[f]);
                double rate = rate_of(LC_FAIL, n, rates[r], rates[r], alphas[a], INFINITY) / alphas[a];
                ck_assert_msg(rate <= 1, "alpha %g, p %g, n %g: %g of it", alphas[a], rates[r], n, rate);
                largest = fmax(largest, rate);
            }
    ck_assert_msg(largest > 0.7, "the test wastes its budget: %g of it", largest);
}
END_TEST

/* The true difference is exactly the margin: PASS is wrong, at most at its level, at either end. */
START_TEST(false_pass_is_bounded)
{
    static const double alphas[] = {1e-2, 1e-6, 1e-11}, factors[] = {1, 1.5, 4};
    double largest = 0;
    for (int a = 0; a < 3; ++a)
        for (int f = 0; f < 3; ++f)
            for (int sign = -1; sign <= 1; sign += 2) {
                double p = 0.1, n = just_trusted(p, alphas[a], factors[f]), margin = 20 * sqrt(p * (1 - p) / n);
                double rate = rate_of(LC_PASS, n, p, p - sign * margin, alphas[a], margin) / alphas[a];
                ck_assert_msg(rate <= 1, "alpha %g, n %g, end %d: %g of it", alphas[a], n, sign, rate);
                largest = fmax(largest, rate);
            }
    ck_assert_msg(largest > 0.7, "%g of it", largest);
}
END_TEST

/* The uncorrected tails, as the header says: too fat on the low side of a positive skew, by exp(G w / 3). */
START_TEST(skewness_spoils_the_side_that_is_guarded)
{
    const double p = 0.01, alpha = 1e-6, n = just_trusted(p, alpha, 1.5), z = lc_normal_quantile(alpha);
    double tail[2] = {0, 0}, skew = 0;
    for (double k = 1; k < 3 * n * p; ++k) {
        lc_pixel pixel = bernoulli(n, k);
        lc_estimate e = lc_estimate_one(&pixel, 1, 0, p, 0);
        lc_student s = lc_estimate_student(&e);
        ck_assert(s.skew[LC_HIGH] == 0 && s.skew[LC_LOW] > 0);
        double t = s.difference / s.error, weight = exp(log_binomial(n, k, p));
        tail[LC_LOW] += t <= -z ? weight : 0;
        tail[LC_HIGH] += t >= z ? weight : 0;
        skew += weight * s.skew[LC_LOW];
    }
    double factor = exp(skew * lc_skew_weight(alpha) / 3);
    check_close(tail[LC_LOW] / alpha, factor, 0.05);
    check_close(tail[LC_HIGH] / alpha, 1 / factor, 0.05);
    ck_assert(factor > 1.5);
}
END_TEST

/* Two Bernoulli arms of unlike rates and sizes, and two alike, whose skewnesses would cancel. */
START_TEST(two_arms_are_bounded)
{
    static const double n[][2] = {{60000, 60000}, {9000, 40000}, {500, 500}, {3000, 3000}};
    const double p = 0.1, alpha = 1e-6;
    for (int i = 0; i < 4; ++i) {
        double rate = 0, width[2], middle[2];
        for (int arm = 0; arm < 2; ++arm) {
            middle[arm] = n[i][arm] * p;
            width[arm] = 9 * sqrt(n[i][arm] * p * (1 - p));
        }
        for (double a = floor(fmax(0, middle[0] - width[0])); a < middle[0] + width[0]; ++a) {
            double weight = log_binomial(n[i][0], a, p);
            lc_pixel pa = bernoulli(n[i][0], a);
            for (double b = floor(fmax(0, middle[1] - width[1])); b < middle[1] + width[1]; ++b) {
                double far = fabs(a / n[i][0] - b / n[i][1]) / sqrt(p * (1 - p) * (1 / n[i][0] + 1 / n[i][1]));
                if (far < 4 || weight < -45)
                    continue; /* cannot FAIL at 1e-6, or cannot matter */
                lc_pixel pb = bernoulli(n[i][1], b);
                lc_estimate e = lc_estimate_two(&pa, 1, &pb, 1, 0, 0);
                lc_student s = lc_estimate_student(&e);
                if (lc_student_decide(&s, alpha, alpha, INFINITY) == LC_FAIL)
                    rate += exp(weight + log_binomial(n[i][1], b, p));
            }
        }
        ck_assert_msg(rate <= alpha, "n %g, %g: rate %g", n[i][0], n[i][1], rate);
        ck_assert_msg(i > 0 || rate > 0.3 * alpha, "n %g, %g: rate %g is a waste", n[i][0], n[i][1], rate);
    }
}
END_TEST

START_TEST(decision_agrees_with_interval)
{
    int seen[3] = {0, 0, 0};
    for (double k = 300; k <= 500; k += 5) {
        lc_pixel pixel = bernoulli(1000, k);
        lc_estimate e = lc_estimate_one(&pixel, 1, 0, 0.42, 0.01);
        lc_student s = lc_estimate_student(&e);
        lc_interval fail = lc_student_interval(&s, 0.05), pass = lc_student_interval(&s, 0.1);
        lc_verdict verdict = lc_student_decide(&s, 0.05, 0.05, 0.06);
        lc_verdict expected = fail.lower > 0.01 || fail.upper < -0.01   ? LC_FAIL
                              : pass.lower > -0.06 && pass.upper < 0.06 ? LC_PASS
                                                                        : LC_GO_ON;
        ck_assert(verdict == expected);
        ++seen[verdict];
    }
    ck_assert(seen[LC_FAIL] > 0 && seen[LC_PASS] > 0 && seen[LC_GO_ON] > 0);
}
END_TEST

START_TEST(verdicts_combine)
{
    ck_assert(lc_verdict_both(LC_PASS, LC_PASS) == LC_PASS && lc_verdict_both(LC_PASS, LC_GO_ON) == LC_GO_ON);
    ck_assert(lc_verdict_both(LC_FAIL, LC_PASS) == LC_FAIL && lc_verdict_both(LC_GO_ON, LC_FAIL) == LC_FAIL);
}
END_TEST

Suite *lc_suite_stats_estimate(void)
{
    Suite *suite = suite_create("stats_estimate");
    TCase *sums = tcase_create("sums"), *rates = tcase_create("rates");
    tcase_add_test(sums, moments_are_unbiased);
    tcase_add_test(sums, tiles_are_sums_of_pixels);
    tcase_add_test(sums, tests_are_equivariant);
    tcase_add_test(sums, unknown_or_no_variance_is_not_tested);
    tcase_add_test(sums, not_a_number_never_decides);
    tcase_add_test(sums, films_are_checked);
    tcase_add_test(rates, false_fail_is_bounded);
    tcase_add_test(rates, false_pass_is_bounded);
    tcase_add_test(rates, skewness_spoils_the_side_that_is_guarded);
    tcase_add_test(rates, two_arms_are_bounded);
    tcase_add_test(rates, decision_agrees_with_interval);
    tcase_add_test(rates, verdicts_combine);
    tcase_set_timeout(rates, 60);
    suite_add_tcase(suite, sums);
    suite_add_tcase(suite, rates);
    return suite;
}
