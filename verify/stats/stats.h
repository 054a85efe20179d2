/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * stats.h: the statistics of the judge: pure functions, no I/O, no globals; any thread. This header gives all of them:
 * tails.h (distributions), estimate.h (one difference), pyramid.h (an image, the budget, the looks), tiles.h (images whose
 * pixels move together), and the tests below.
 *
 * The judge's loop for one row, against an expected image (lc_field_two() for another film):
 *
 *     lc_budget budget = {1e-6, 1e-6, rows, 3, looks.count};
 *     lc_pyramid_plan plan;
 *     lc_pyramid_plan_init(&plan, lc_budget_row_fail(&budget), lc_budget_row_pass(&budget));
 *     for (int k = 0; k < looks.count && verdict == LC_GO_ON; ++k) {
 *         options.first = film->count, options.count = looks.samples[k] - film->count;
 *         status = lc_render(film, scene, estimator, &options, err);
 *         verdict = LC_PASS;
 *         for (int c = 0; c < 3 && !status; ++c) {
 *             plan.margin[lc_pyramid_levels(w, h) - 1] = margin * mean_of_reflected_light[c];
 *             if (!(status = lc_field_one(field, film, expected, c, tolerance, err)))
 *                 status = lc_pyramid_judge(&result[c], field, w, h, &plan, err);
 *             verdict = lc_verdict_both(verdict, result[c].verdict);
 *         }
 *         if (status)
 *             goto cleanup;
 *     } // still LC_GO_ON: UNDECIDED
 */
#ifndef LC_STATS_H
#define LC_STATS_H

#include <stddef.h>

#include "core/host.h"
#include "verify/stats/estimate.h"
#include "verify/stats/pyramid.h"
#include "verify/stats/tails.h"
#include "verify/stats/tiles.h"

/* ---- bounds ------------------------------------------------------------------------------------------------ */

/* Empirical Bernstein bound: |sample mean - mean| <= the value returned, except with probability alpha (both sides
 * together), for n >= 2 independent samples in an interval of length `range` > 0, of unbiased sample variance
 * `variance`; whatever their distributions: sqrt(2 v ln(4 / alpha) / n) + 7 range ln(4 / alpha) / (3 (n - 1)). Maurer
 * and Pontil, COLT 2009, Theorem 4, once a side. */
double lc_bernstein_bound(double variance, double n, double range, double alpha);

/* The same where no range is known but that the n samples, of mean square `square`, were none larger than `largest` > 0, of laws whose tails
 * fall as x^-1.5 or faster, so that they need have no variance. With l = ln(6 / alpha), let M be the size that l samples are expected to
 * reach: `largest` >= M but for exp(-l). Larger ones add at most 3 M l / n to the mean; at most e l of them were seen but for
 * exp(-l) (Chernoff), of the mean seen e largest l / n; the others have the range 2 M, and the bound above takes the 4 exp(-l)
 * that are left. Of what is rarer, and larger than such a tail has it, lc_missed_value() tells. */
double lc_met_bound(double square, double n, double largest, double alpha);

/* Size of the contribution that n samples exclude though they never met it: margin n / ln(1 / alpha). A contribution
 * that a sample meets with probability q and that is then worth h adds q h to the mean; n samples all miss it with
 * probability (1 - q)^n <= exp(-q n), which is at most alpha from q = ln(1 / alpha) / n on (13.8 / n at 1e-6). So if it
 * adds `margin` or more [radiance] and has not been seen, its samples are worth more than h = margin / q. n: samples
 * over the whole tile that the margin is about. */
double lc_missed_value(double margin, double n, double alpha);

/* Clopper and Pearson's interval (Biometrika 26, 1934) at 1 - alpha for a probability of which `successes` of n >= 1
 * were seen; ends at the beta quantiles of (k, n - k + 1) and (k + 1, n - k). NaN when out of range. */
lc_interval lc_clopper_pearson(double successes, double n, double alpha);

/* ---- chi-square goodness of fit ---------------------------------------------------------------------------- */

typedef struct lc_chi_square {
    double statistic, df;
    double log_p;      /* ln P(X >= statistic), asymptotic: trust it as far as the expected counts are large */
    size_t cells;      /* after pooling */
    double impossible; /* observed in bins that expect exactly 0; pooled like all; what it means is up to the caller */
} lc_chi_square;

/* Pearson's test of observed against expected counts (both of the same total). Bins are taken in the order of their
 * expectation, smallest first (then by index), and joined until a cell expects at least `least` (5 by custom); what is
 * left over joins the last cell. df = cells - 1 - fitted. LC_BAD_INPUT on negative or non-finite counts, or fewer than
 * 2 + fitted cells. */
lc_status lc_chi_square_test(lc_chi_square *out, const double *observed, const double *expected, size_t bins,
                             double least, int fitted, lc_error *err);

/* ---- variances --------------------------------------------------------------------------------------------- */

/* A variance pooled over pixels, with effective degrees of freedom. */
typedef struct lc_spread {
    double variance; /* mean over pixels of the variance of one sample */
    double df;       /* (sum v)^2 / sum(v^2 / df of v), Satterthwaite */
    long pixels;
} lc_spread;

/* From the batch means of LC_BLOCK samples, which are nearer to normal than samples: LC_BLOCK batch_m2 / (batches - 1)
 * a pixel; excess_kurtosis >= 0 is a sample's (0: none), a batch mean has 1 / LC_BLOCK of it, and df becomes df / (1 +
 * kurtosis / 2) (Box, Biometrika 40, 1953). Pixels with fewer than 2 batches are left out. No pixel: variance and df
 * are NaN. */
lc_spread lc_spread_of_film(const lc_film *film, int channel, double excess_kurtosis);

typedef struct lc_ratio {
    double ratio;       /* a / b */
    lc_interval bounds; /* at 1 - alpha */
    double log_p;       /* ln of the two-sided p value for "equal"; at most 0 */
} lc_ratio;

/* Fisher's F test of two independent variances. NaN when a variance or df is not above 0. */
lc_ratio lc_variance_ratio(const lc_spread *a, const lc_spread *b, double alpha);

typedef struct lc_batches {
    double ratio; /* between over within: 1 under independence, 0 when batches repeat, INFINITY when samples do */
    double df[2]; /* between, within */
    double log_p; /* ln of the two-sided p value */
    long pixels;  /* that took part */
} lc_batches;

/* Between-batch against within-batch variance, summed over pixels, one way: shows samples that depend on each other
 * within a stream (shared, re-seeded generators). Of a pixel with b whole batches and no sample beside them, B =
 * LC_BLOCK batch_m2 / (b - 1) and W = (m2 - LC_BLOCK batch_m2) / (n - b) both estimate v. Squares of single samples
 * have the same weight 1 / n in both, so B - W consists of products of different samples only and has the variance v^2
 * (2 / (b - 1) + 2 / (n - b)) for ANY distribution that has one: no kurtosis enters. F = sum B / sum W with df = (sum
 * v)^2 / sum(v^2 / (b - 1)), and with n - b for W. Pixels with b < 2 or without variance are left out; none left: NaN.
 */
lc_batches lc_batches_of_film(const lc_film *film, int channel);
/* The same of batches of `size` samples: of a sum of films, each of which is one. */
lc_batches lc_batches_of_size(const lc_film *film, int channel, uint64_t size);

/* 1 when samples are shown to depend on each other, at level alpha: p <= alpha^2, since the law is F's to its second
 * moment only, and at least 100 degrees of freedom between, so that no few pixels rule. Generators that are shared or
 * re-seeded have p of 1e-100 and below. 0 for NaN: what cannot be tested. */
int lc_batches_depend(const lc_batches *batches, double alpha);

/* ---- convergence ------------------------------------------------------------------------------------------- */

typedef struct lc_slope {
    double slope, intercept; /* of ln y over ln x */
    double error;            /* standard error of the slope */
    lc_interval bounds;      /* at 1 - alpha */
    double misfit_log_p; /* ln P that the scatter about the line is as large by chance; NaN when sigma is not given */
} lc_slope;

/* Weighted least squares of ln y[i] on ln x[i], i < count, x, y > 0; `sigma` > 0 is the standard deviation of ln y[i]
 * (that of y over y): normal interval; NULL: equal, unknown ones: from the residuals, t with count - 2 degrees.
 * LC_BAD_INPUT with fewer than 2 (3) points or equal x. An unbiased estimator's error against N has slope -1/2. */
lc_status lc_slope_fit(lc_slope *out, const double *x, const double *y, const double *sigma, size_t count, double alpha,
                       lc_error *err);

#endif
