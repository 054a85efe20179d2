/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Distributions, bounds and classical tests: printed tables, closed forms, exact enumeration. */
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

/* ---- tails -------------------------------------------------------------------------------------------------- */

/* NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.1 to 1.3.6.7.4: critical values, as printed. */
START_TEST(tails_agree_with_printed_tables)
{
    ck_assert(fabs(lc_t_quantile(0.025, 1) - 12.706) < 5e-4);
    ck_assert(fabs(lc_t_quantile(0.025, 10) - 2.228) < 5e-4);
    ck_assert(fabs(lc_t_quantile(0.001, 30) - 3.385) < 5e-4);
    ck_assert(fabs(lc_t_quantile(0.005, 100) - 2.626) < 5e-4);
    ck_assert(fabs(lc_normal_quantile(0.025) - 1.960) < 5e-4);
    ck_assert(fabs(exp(lc_chi_square_log_sf(18.307, 10)) - 0.05) < 1e-5);
    ck_assert(fabs(exp(lc_chi_square_log_sf(20.515, 5)) - 0.001) < 1e-6);
    ck_assert(fabs(lc_f_quantile(0.05, 5, 10) - 3.326) < 5e-4);
    ck_assert(fabs(lc_f_quantile(0.01, 10, 10) - 4.849) < 5e-4);
}
END_TEST

START_TEST(tails_agree_with_closed_forms)
{
    static const double points[] = {1e-3, 0.7, 3, 80, 1e5, 1e200};
    for (size_t i = 0; i < sizeof points / sizeof points[0]; ++i) {
        double t = points[i];
        check_close(lc_t_log_sf(t, 1), log(atan(1 / t) / LC_PI), 1e-13); /* Cauchy */
        double r = sqrt(2 + t * t);                                      /* 2 degrees: (1 - t / r) / 2 */
        check_close(lc_t_log_sf(t, 2), isinf(r) ? -log(2) - 2 * log(t) : -log(r) - log(r + t), 1e-12);
    }
    check_close(lc_chi_square_log_sf(3000, 2), -1500, 1e-13); /* exponential */
    check_close(lc_chi_square_log_sf(1, 2), -0.5, 1e-13);
    check_close(lc_f_log_sf(50, 2, 40), -20 * log1p(2.5), 1e-13);
    check_close(lc_beta_log_cdf(1e-9, 1 - 1e-9, 1, 7), log(-expm1(7 * log1p(-1e-9))), 1e-13);
    check_close(lc_beta_log_cdf(0.75, 0.25, 3, 1), 3 * log(0.75), 1e-13);
    check_close(exp(lc_t_log_sf(-2, 5)) + exp(lc_t_log_sf(2, 5)), 1, 1e-14);
    check_close(lc_normal_log_sf(0), log(0.5), 1e-15);
}
END_TEST

/* Goldens: mpmath 1.3, 40 digits, betainc and gammainc; quantiles by its root finder. */
START_TEST(tails_hold_far_out)
{
    check_close(exp(lc_t_log_sf(8, 31)), 2.4701318509516898e-9, 1e-12);
    check_close(exp(lc_t_log_sf(12, 63)), 3.1739837718395363e-18, 1e-12);
    check_close(exp(lc_t_log_sf(7, 4000)), 1.4942073289803549e-12, 1e-9);
    check_close(exp(lc_t_log_sf(37, 1000)), 8.6503944049565307e-190, 1e-10);
    check_close(lc_t_log_sf(40, 1e6), -803.968324750342, 1e-9); /* p = 7e-350 is no double */
    check_close(lc_t_log_sf(6.6, 1e9), -24.607775855200707, 1e-8);
    check_close(lc_t_quantile(1e-11, 63), 8.1437937797070976, 1e-12);
    check_close(lc_t_quantile(1e-14, 1000), 7.7659460304903817, 1e-12);
    check_close(lc_t_quantile(1e-14, 3), 47952.757179667604, 1e-11);
    check_close(lc_t_quantile(1e-6, 10), 9.7519954909405802, 1e-12);
    check_close(lc_chi_square_log_sf(1e4, 10), -4969.1084809047044, 1e-13);
}
END_TEST

START_TEST(quantiles_invert_tails)
{
    static const double levels[] = {0.9, 0.4999, 0.25, 1e-3, 1e-6, 1e-11, 1e-14, 1e-100, 1e-300};
    static const double dfs[] = {1, 2.5, 15, 63, 1000, 1e6, 1e9, INFINITY};
    for (size_t i = 0; i < sizeof levels / sizeof levels[0]; ++i)
        for (size_t j = 0; j < sizeof dfs / sizeof dfs[0]; ++j)
            check_close(lc_t_log_sf(lc_t_quantile(levels[i], dfs[j]), dfs[j]), log(levels[i]), 1e-9);
    check_close(lc_f_log_sf(lc_f_quantile(1e-9, 1e5, 1e6), 1e5, 1e6), log(1e-9), 1e-6); /* where GSL's aborts */
}
END_TEST

START_TEST(tails_refuse_nonsense)
{
    ck_assert(isnan(lc_t_log_sf(NAN, 5)) && isnan(lc_t_log_sf(1, 0)) && isnan(lc_t_log_sf(1, NAN)));
    ck_assert(isnan(lc_t_quantile(0, 5)) && isnan(lc_t_quantile(1, 5)) && isnan(lc_t_quantile(NAN, 5)));
    ck_assert(isnan(lc_normal_quantile(0)) && isnan(lc_normal_log_sf(NAN)) && isnan(lc_f_log_sf(-1, 2, 3)));
    ck_assert(isnan(lc_chi_square_log_sf(-1, 3)) && isnan(lc_sidak_level(2, 3)) &&
              isnan(lc_bonferroni_combine(NAN, 3)));
}
END_TEST

START_TEST(sidak_keeps_its_digits)
{
    check_close(lc_sidak_level(1e-20, 100), 1e-22, 1e-14);
    check_close(lc_sidak_level(0.75, 2), 0.5, 1e-15);
    check_close(lc_sidak_combine(1e-22, 100), 1e-20, 1e-14);
    check_close(lc_sidak_combine(lc_sidak_level(0.01, 4096), 4096), 0.01, 1e-13);
    ck_assert(lc_bonferroni_combine(0.01, 4096) == 1);
}
END_TEST

/* ---- bounds ------------------------------------------------------------------------------------------------- */

static double binomial(int n, int k, double p)
{
    return exp(lgamma(n + 1) - lgamma(k + 1) - lgamma(n - k + 1) + k * log(p) + (n - k) * log1p(-p));
}

/* The ends are where the seen count and everything beyond it have the probability alpha / 2. */
START_TEST(clopper_pearson_is_exact)
{
    const int n = 60, k = 7;
    const double alpha = 1e-3;
    lc_interval i = lc_clopper_pearson(k, n, alpha);
    double above = 0, below = 0;
    for (int j = 0; j <= n; ++j) {
        above += j >= k ? binomial(n, j, i.lower) : 0;
        below += j <= k ? binomial(n, j, i.upper) : 0;
    }
    check_close(above, alpha / 2, 1e-9);
    check_close(below, alpha / 2, 1e-9);
    i = lc_clopper_pearson(0, 1e7, 1e-6);
    ck_assert(i.lower == 0);
    check_close(i.upper, -expm1(log(5e-7) / 1e7), 1e-9);
    i = lc_clopper_pearson(20, 20, 0.05);
    ck_assert(i.upper == 1);
    check_close(i.lower, pow(0.025, 0.05), 1e-9);
    ck_assert(isnan(lc_clopper_pearson(3, 2, 0.05).lower));
}
END_TEST

/* Coverage for Bernoulli samples, every outcome enumerated. The bound is loose; but a quarter of it is not enough. */
START_TEST(bernstein_covers)
{
    const int n = 200;
    const double alpha = 0.01;
    double worst = 0, worst_quarter = 0;
    for (double p = 0.005; p < 1; p += 0.015) {
        double missed = 0, missed_quarter = 0;
        for (int k = 0; k <= n; ++k) {
            double mean = (double)k / n, bound = lc_bernstein_bound(mean * (1 - mean) * n / (n - 1), n, 1, alpha);
            missed += fabs(mean - p) > bound ? binomial(n, k, p) : 0;
            missed_quarter += fabs(mean - p) > bound / 4 ? binomial(n, k, p) : 0;
        }
        worst = fmax(worst, missed);
        worst_quarter = fmax(worst_quarter, missed_quarter);
    }
    ck_assert(worst <= alpha && worst_quarter > alpha);
    /* Units: samples ten times as large. */
    check_close(lc_bernstein_bound(25, 1000, 10, alpha), 10 * lc_bernstein_bound(0.25, 1000, 1, alpha), 1e-14);
    ck_assert(isnan(lc_bernstein_bound(1, 1, 1, alpha)));
}
END_TEST

/* Of samples that are 1, or more rarely -10, all outcomes: what those add that are no larger than the largest met. A twenty-fifth of the
 * bound is not enough. */
START_TEST(what_was_met_is_bounded)
{
    const int n = 3000;
    const double alpha = 0.01;
    double worst = 0, worst_part = 0;
    for (double small = 0.1; small < 30; small *= 2)
        for (double large = 0.1; large < 30; large *= 2) {
            double missed = 0, missed_part = 0;
            for (int i = 0; i <= 80; ++i)
                for (int k = 0; k <= 80; ++k) {
                    if (i + k == 0)
                        continue; /* nothing was met, and nothing is said */
                    double chance = binomial(n, i, small / n) * binomial(n, k, large / n);
                    double bound = lc_met_bound((i + 100.0 * k) / n, n, k ? 10 : 1, alpha);
                    double off = fabs((i - 10.0 * k) - (small - (k ? 10 * large : 0))) / n;
                    missed += off > bound ? chance : 0;
                    missed_part += off > bound / 25 ? chance : 0;
                }
            worst = fmax(worst, missed);
            worst_part = fmax(worst_part, missed_part);
        }
    ck_assert_msg(worst <= alpha && worst_part > alpha, "%g %g", worst, worst_part);
    check_close(lc_met_bound(25, 1000, 50, alpha), 10 * lc_met_bound(0.25, 1000, 5, alpha), 1e-14);
    /* By hand: l = ln 600, sqrt(2 * 0.25 * 1000 / 999 * l / 1000) + 14 * 5 * l / (3 * 999) + (3 + e) * 5 * l / 1000. */
    check_close(lc_met_bound(0.25, 1000, 5, alpha), 0.3888916065285438, 1e-12);
    ck_assert(isnan(lc_met_bound(1, 1, 1, alpha)) && isnan(lc_met_bound(1, 9, 0, alpha)));
}
END_TEST

/* Samples x^-(1 / 1.5) of a uniform x: of the mean 3 and no variance, so that means are off by far more than most of their own standard
 * errors; here a hundredth of the bound is not enough. */
START_TEST(what_was_met_tells_of_the_tail)
{
    const int trials = 3000, n = 2000;
    int missed = 0, missed_part = 0;
    for (int i = 0; i < trials; ++i) {
        lc_sampler s;
        lc_sampler_start(&s, 1, (uint32_t)i, 0, 0);
        double sum = 0, squares = 0, most = 0;
        for (int k = 0; k < n; ++k) {
            double x = pow(1 - lc_next(&s), -1 / 1.5);
            sum += x;
            squares += x * x;
            most = fmax(most, x);
        }
        double off = fabs(sum / n - 3), bound = lc_met_bound(squares / n, n, most, 0.01);
        missed += off > bound;
        missed_part += off > bound / 100;
    }
    ck_assert_msg(lc_clopper_pearson(missed, trials, 1e-3).lower <= 0.01 && missed_part > 0.1 * trials, "%d %d", missed, missed_part);
}
END_TEST

START_TEST(missed_contributions_are_excluded_at_alpha)
{
    const double n = 4096, margin = 0.01, alpha = 1e-6;
    double value = lc_missed_value(margin, n, alpha), q = margin / value;
    check_close(value, margin * n / 13.815510557964274, 1e-14);
    ck_assert(exp(n * log1p(-q)) <= alpha); /* never hit */
    ck_assert(exp(n * log1p(-0.99 * q)) > alpha);
}
END_TEST

/* ---- chi-square ------------------------------------------------------------------------------------------------ */

START_TEST(chi_square_of_a_die)
{
    /* 60 throws; (25 + 4 + 1 + 4 + 0 + 100) / 10 = 13.4, 5 degrees. For odd df: erfc and two terms. */
    static const double seen[] = {5, 8, 9, 8, 10, 20}, fair[] = {10, 10, 10, 10, 10, 10};
    lc_chi_square r;
    ck_assert(lc_chi_square_test(&r, seen, fair, 6, 5, 0, NULL) == LC_OK);
    check_close(r.statistic, 13.4, 1e-14);
    double h = 6.7, p = erfc(sqrt(h)) + 2 * sqrt(h / LC_PI) * exp(-h) * (1 + h / 1.5);
    check_close(exp(r.log_p), p, 1e-12);
    ck_assert(r.df == 5 && r.cells == 6);
}
END_TEST

START_TEST(chi_square_pools_by_expectation)
{
    /* In order of expectation: 0 1 2 2 | 6 | 20, the first four make exactly 5. */
    static const double seen[] = {18, 1, 3, 2, 7, 0}, expected[] = {20, 2, 1, 2, 6, 0};
    lc_chi_square r;
    ck_assert(lc_chi_square_test(&r, seen, expected, 6, 5, 0, NULL) == LC_OK);
    ck_assert(r.cells == 3 && r.df == 2);
    check_close(r.statistic, 1.0 / 5 + 1.0 / 6 + 4.0 / 20, 1e-14);
    /* Too little for a cell of its own joins the last one: 1 + 2 + 2 + 2 | 20 + nothing; least 6: {1 2 2 2} {20}. */
    static const double less[] = {20, 2, 1, 2, 2};
    ck_assert(lc_chi_square_test(&r, seen, less, 5, 6, 0, NULL) == LC_OK && r.cells == 2);
    lc_error err;
    static const double nothing[] = {0, 0, 0, 0, 0};
    ck_assert(lc_chi_square_test(&r, seen, nothing, 5, 5, 0, &err) == LC_BAD_INPUT);
    static const double broken[] = {20, NAN, 1, 2, 2};
    ck_assert(lc_chi_square_test(&r, broken, less, 5, 5, 0, &err) == LC_BAD_INPUT);
    ck_assert(strstr(err.text, "bin 1") != NULL);
}
END_TEST

START_TEST(chi_square_reports_the_impossible)
{
    static const double seen[] = {30, 29, 3}, expected[] = {31, 31, 0};
    lc_chi_square r;
    ck_assert(lc_chi_square_test(&r, seen, expected, 3, 5, 0, NULL) == LC_OK);
    ck_assert(r.impossible == 3);
}
END_TEST

/* ---- variances -------------------------------------------------------------------------------------------------- */

enum { PIXELS = 16, BATCHES = 8, SAMPLES = BATCHES * LC_BLOCK };

/* The moments of all samples and of their batch means, by definition, in the red channel. */
static void set_pixel(lc_pixel *pixel, const double *samples)
{
    memset(pixel, 0, sizeof *pixel);
    lc_moments *m = &pixel->c[0];
    double batch[BATCHES];
    for (int b = 0; b < BATCHES; ++b) {
        batch[b] = 0;
        for (int i = 0; i < LC_BLOCK; ++i)
            batch[b] += samples[b * LC_BLOCK + i] / LC_BLOCK;
        m->mean += batch[b] / BATCHES;
    }
    for (int i = 0; i < SAMPLES; ++i)
        m->m2 += (samples[i] - m->mean) * (samples[i] - m->mean);
    for (int b = 0; b < BATCHES; ++b)
        m->batch_m2 += (batch[b] - m->mean) * (batch[b] - m->mean);
    pixel->n = SAMPLES;
    pixel->batches = BATCHES;
}

typedef enum stream { FRESH, REPEATED_BATCHES, REPEATED_SAMPLES } stream;

/* A film whose pixels see a light with probability p: kurtosis of about 1 / p. */
static void set_film(lc_film *film, lc_pixel *pixels, double p, double value, stream kind, uint64_t *state)
{
    memset(film, 0, sizeof *film);
    film->width = PIXELS;
    film->height = 1;
    film->pixels = pixels;
    for (int x = 0; x < PIXELS; ++x) {
        double samples[SAMPLES];
        for (int i = 0; i < SAMPLES; ++i) {
            samples[i] = next(state) < p ? value : 0;
            if (kind == REPEATED_BATCHES && i >= LC_BLOCK)
                samples[i] = samples[i - LC_BLOCK];
            if (kind == REPEATED_SAMPLES && i % LC_BLOCK)
                samples[i] = samples[i - 1];
        }
        set_pixel(&pixels[x], samples);
    }
}

START_TEST(batches_show_repeated_numbers)
{
    uint64_t state = 1;
    lc_film film;
    lc_pixel pixels[PIXELS];
    set_film(&film, pixels, 0.4, 2, REPEATED_BATCHES, &state);
    lc_batches r = lc_batches_of_film(&film, 0);
    ck_assert(r.ratio < 1e-20 && r.log_p < log(1e-100));
    set_film(&film, pixels, 0.4, 2, REPEATED_SAMPLES, &state);
    r = lc_batches_of_film(&film, 0);
    ck_assert(r.ratio > 1e6 && r.log_p < log(1e-100)); /* nothing varies within */
    set_film(&film, pixels, 0.4, 2, FRESH, &state);
    r = lc_batches_of_film(&film, 0);
    ck_assert(r.ratio > 0.5 && r.ratio < 2 && r.log_p > log(1e-3));
    ck_assert(r.pixels == PIXELS && fabs(r.df[0] - PIXELS * (BATCHES - 1)) < 5);
    ck_assert(isnan(lc_batches_of_film(&film, 1).log_p)); /* black: no variance */
    ck_assert_double_eq(lc_batches_of_size(&film, 0, LC_BLOCK).log_p, r.log_p);
    ck_assert(isnan(lc_batches_of_size(&film, 0, LC_BLOCK / 2).log_p)); /* its batches are others */
}
END_TEST

/* Heavy tails (kurtosis 20 and 200) do not make a sound generator look unsound. */
START_TEST(batches_are_calibrated)
{
    static const double rates[] = {0.5, 0.05, 0.005};
    uint64_t state = 2;
    for (int r = 0; r < 3; ++r) {
        int seen = 0;
        const int trials = 600;
        for (int t = 0; t < trials; ++t) {
            lc_film film;
            lc_pixel pixels[PIXELS];
            set_film(&film, pixels, rates[r], 1, FRESH, &state);
            seen += lc_batches_of_film(&film, 0).log_p <= log(0.02);
        }
        lc_interval i = lc_clopper_pearson(seen, trials, 1e-3);
        ck_assert_msg(i.lower <= 0.02, "rate %g: %d of %d at 0.02", rates[r], seen, trials);
        ck_assert_msg(r > 0 || i.upper >= 0.02, "the test sees nothing: %d of %d", seen, trials);
    }
}
END_TEST

START_TEST(variances_are_compared)
{
    uint64_t state = 3;
    lc_film film;
    lc_pixel pixels[PIXELS];
    set_film(&film, pixels, 0.3, 1, FRESH, &state);
    lc_spread a = lc_spread_of_film(&film, 0, 0);
    set_film(&film, pixels, 0.3, 1, FRESH, &state);
    lc_spread b = lc_spread_of_film(&film, 0, 0);
    set_film(&film, pixels, 0.3, 2, FRESH, &state);
    lc_spread four = lc_spread_of_film(&film, 0, 0);
    lc_ratio same = lc_variance_ratio(&a, &b, 0.001), other = lc_variance_ratio(&four, &a, 0.001);
    check_close(a.variance, 0.21, 0.3);
    ck_assert(same.bounds.lower < 1 && same.bounds.upper > 1 && same.log_p > log(0.001));
    ck_assert(other.bounds.lower > 1 && other.bounds.lower < 4 && other.bounds.upper > 4 && other.log_p < log(1e-6));
    lc_ratio turned = lc_variance_ratio(&a, &four, 0.001);
    check_close(turned.bounds.lower, 1 / other.bounds.upper, 1e-9);
    check_close(turned.log_p, other.log_p, 1e-9);
    /* Table: F(5, 10) at 0.05 is 3.326. */
    lc_spread five = {3.326, 5, 1}, ten = {1, 10, 1};
    ck_assert(fabs(lc_variance_ratio(&five, &ten, 0.1).bounds.lower - 1) < 5e-4);
    check_close(lc_spread_of_film(&film, 0, 2 * LC_BLOCK).df, four.df / 2, 1e-12);
    lc_spread none = {0, 3, 1};
    ck_assert(isnan(lc_variance_ratio(&none, &ten, 0.1).ratio));
}
END_TEST

/* ---- convergence --------------------------------------------------------------------------------------------------
 */

START_TEST(slope_of_a_power_law)
{
    static const double x[] = {16, 64, 256, 1024}, noise[] = {0.1, -0.1, -0.1, 0.1}, sigma[] = {0.1, 0.1, 0.1, 0.1};
    double y[4];
    for (int i = 0; i < 4; ++i)
        y[i] = 3 / sqrt(x[i]);
    lc_slope fit;
    ck_assert(lc_slope_fit(&fit, x, y, sigma, 4, 0.01, NULL) == LC_OK);
    check_close(fit.slope, -0.5, 1e-13);
    check_close(exp(fit.intercept), 3, 1e-13);
    /* x at -3, -1, 1, 3 times ln 2: the sum of squares is 20 (ln 2)^2; the noise has no slope, and a chi-square of 4 of
     * 2 degrees. */
    check_close(fit.error, 0.1 / (sqrt(20) * log(2)), 1e-13);
    check_close(fit.bounds.upper - fit.slope, fit.error * lc_normal_quantile(0.005), 1e-12);
    for (int i = 0; i < 4; ++i)
        y[i] *= exp(noise[i]);
    ck_assert(lc_slope_fit(&fit, x, y, sigma, 4, 0.01, NULL) == LC_OK);
    check_close(fit.slope, -0.5, 1e-13);
    check_close(fit.misfit_log_p, -2, 1e-12);
    ck_assert(lc_slope_fit(&fit, x, y, NULL, 4, 0.01, NULL) == LC_OK); /* residual variance 0.04 / 2 */
    check_close(fit.error, sqrt(0.02 / 20) / log(2), 1e-12);
    check_close(fit.slope - fit.bounds.lower, fit.error * lc_t_quantile(0.005, 2), 1e-12);
}
END_TEST

START_TEST(slope_weights_by_precision)
{
    static const double x[] = {1, 10, 100}, y[] = {1, 0.1, 1}, sigma[] = {0.01, 0.01, 1e6};
    lc_slope fit;
    ck_assert(lc_slope_fit(&fit, x, y, sigma, 3, 0.01, NULL) == LC_OK);
    check_close(fit.slope, -1, 1e-6);
    ck_assert(lc_slope_fit(&fit, x, y, NULL, 2, 0.01, NULL) == LC_BAD_INPUT);
    static const double zero[] = {1, 0, 1}, equal[] = {5, 5, 5};
    ck_assert(lc_slope_fit(&fit, x, zero, NULL, 3, 0.01, NULL) == LC_BAD_INPUT);
    ck_assert(lc_slope_fit(&fit, equal, y, NULL, 3, 0.01, NULL) == LC_BAD_INPUT);
}
END_TEST

Suite *lc_suite_stats(void)
{
    Suite *suite = suite_create("stats");
    TCase *tails = tcase_create("tails"), *bounds = tcase_create("bounds"), *tests = tcase_create("tests");
    tcase_add_test(tails, tails_agree_with_printed_tables);
    tcase_add_test(tails, tails_agree_with_closed_forms);
    tcase_add_test(tails, tails_hold_far_out);
    tcase_add_test(tails, quantiles_invert_tails);
    tcase_add_test(tails, tails_refuse_nonsense);
    tcase_add_test(tails, sidak_keeps_its_digits);
    tcase_add_test(bounds, clopper_pearson_is_exact);
    tcase_add_test(bounds, bernstein_covers);
    tcase_add_test(bounds, what_was_met_is_bounded);
    tcase_add_test(bounds, what_was_met_tells_of_the_tail);
    tcase_add_test(bounds, missed_contributions_are_excluded_at_alpha);
    tcase_add_test(tests, chi_square_of_a_die);
    tcase_add_test(tests, chi_square_pools_by_expectation);
    tcase_add_test(tests, chi_square_reports_the_impossible);
    tcase_add_test(tests, batches_show_repeated_numbers);
    tcase_add_test(tests, batches_are_calibrated);
    tcase_add_test(tests, variances_are_compared);
    tcase_add_test(tests, slope_of_a_power_law);
    tcase_add_test(tests, slope_weights_by_precision);
    tcase_set_timeout(tests, 60);
    suite_add_tcase(suite, tails);
    suite_add_tcase(suite, bounds);
    suite_add_tcase(suite, tests);
    return suite;
}
