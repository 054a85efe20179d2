/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * convergence: what the lecture's demo shows of noise. "Diminishing returns": the error falls as N^-1/2, so that the slope
 * of its logarithm over that of N is -1/2; a bias bends the line, samples that repeat flatten it. "Far better": light
 * sampling has less variance than hemisphere sampling in the demo's kind of scene, and not everywhere.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "estimators/registry.h"
#include "verify/checks/checks.h"
#include "verify/report/report.h"
#include "verify/stats/stats.h"

/* The levels of both are divided by this: the logarithm of a mean square of a thousand or more pixels is not quite normal. For a
 * chi-square of 1024 degrees the true tail at z = 7 is 5 times the normal one. */
#define RESERVE 100.0

static lc_status render(lc_film **out, const lc_claim *claim, const lc_estimator *estimator, const lc_share *share,
                        uint32_t arm, int side, uint64_t first, uint64_t count, lc_error *err)
{
    lc_render_options options = {.min_bounces = claim->min_bounces,
                                 .max_bounces = claim->max_bounces,
                                 .seed = share->seed,
                                 .arm = arm,
                                 .first = first,
                                 .count = count,
                                 .threads = share->threads};
    lc_status status = lc_film_create(out, side, side, err);
    if (status != LC_OK)
        return status;
    status = lc_render(*out, claim->scene, estimator, &options, err);
    if (status != LC_OK)
        lc_film_free(*out);
    return status;
}

static void say_bad(lc_row *row, const lc_film *film)
{
    row->verdict = LC_ROW_FAIL;
    snprintf(row->reason, sizeof row->reason, "%s on %s: %llu samples are NaN, infinite, negative or above 1e60", film->estimator,
             film->scene, (unsigned long long)film->bad);
}

/* ---- the slope ---------------------------------------------------------------------------------------------------- */

enum { SIDE = 64, FIRST = 4, POINTS = 4 }; /* N = 4, 16, 64, 256 at 64 x 64 pixels, each from samples of its own */
static const double SLOPE_MARGIN = 0.1;      /* of the slope */

/* Root mean square of the error over the pixels, and the standard deviation of its logarithm as the pixels tell it. */
static void measure_error(double *rms, double *sigma, const lc_film *film, const lc_expected *expected)
{
    size_t count = (size_t)film->width * (size_t)film->height;
    double n = 0, mean = 0, m2 = 0;
    for (size_t i = 0; i < count; ++i) {
        double square = 0;
        for (int c = 0; c < 3 && !expected->skip[i]; ++c) {
            double e = film->pixels[i].c[c].mean - expected->rgb[3 * i + (size_t)c];
            square += e * e / 3;
        }
        if (expected->skip[i])
            continue;
        double d = square - mean;
        mean += d / ++n;
        m2 += d * (square - mean);
    }
    *rms = sqrt(mean);
    *sigma = 0.5 * sqrt(m2 / (n - 1) / n) / mean;
}

/* Fills the points; bad samples end it with a verdict. */
static lc_status measure_points(lc_row *row, double *n, double *rms, double *sigma, const lc_claim *claim,
                                const lc_share *share, const lc_expected *expected, lc_error *err)
{
    uint64_t first = 0, count = FIRST;
    for (int i = 0; i < POINTS; ++i, first += count, count *= 4) {
        lc_film *film;
        lc_status status = render(&film, claim, claim->estimator, share, share->arm, SIDE, first, count, err);
        if (status != LC_OK)
            return status;
        row->samples += count;
        row->paths += count * SIDE * SIDE;
        n[i] = (double)count;
        measure_error(&rms[i], &sigma[i], film, expected);
        if (film->bad)
            say_bad(row, film);
        lc_film_free(film);
    }
    return LC_OK;
}

static lc_status fit(lc_row *row, const double *n, const double *rms, const double *sigma, const lc_share *share,
                     lc_error *err)
{
    lc_slope wide, narrow;
    for (int i = 0; i < POINTS; ++i)
        if (!(rms[i] > 0 && sigma[i] > 0)) {
            row->verdict = LC_ROW_UNDECIDED;
            snprintf(row->reason, sizeof row->reason, "%s on %s: no error at N = %g, and so no slope", row->estimator,
                     row->scene, n[i]);
            return LC_OK;
        }
    lc_status status = lc_slope_fit(&wide, n, rms, sigma, POINTS, share->false_fail / RESERVE, err);
    if (status == LC_OK)
        status = lc_slope_fit(&narrow, n, rms, sigma, POINTS, 2 * share->false_pass / RESERVE, err);
    if (status != LC_OK)
        return status;
    row->expected = rms[POINTS - 1];
    row->ratio = narrow.slope / -0.5;
    row->low = narrow.bounds.upper / -0.5;
    row->high = narrow.bounds.lower / -0.5;
    if (wide.bounds.lower > -0.5 || wide.bounds.upper < -0.5) {
        row->verdict = LC_ROW_FAIL;
        snprintf(row->reason, sizeof row->reason,
                 "%s on %s: the error falls as N^%.3f, [%.3f, %.3f], not as N^-0.5: biased, or its samples repeat",
                 row->estimator, row->scene, wide.slope, wide.bounds.lower, wide.bounds.upper);
    } else if (row->low > 1 - row->margin && row->high < 1 + row->margin)
        row->verdict = LC_ROW_PASS;
    else {
        row->verdict = LC_ROW_UNDECIDED;
        snprintf(row->reason, sizeof row->reason, "%s on %s: the slope is known to [%.3f, %.3f] only", row->estimator,
                 row->scene, narrow.bounds.lower, narrow.bounds.upper);
    }
    return LC_OK;
}

static lc_status decide_slope(lc_row *row, const lc_claim *claim, const lc_share *share, lc_error *err)
{
    size_t pixels = (size_t)SIDE * SIDE;
    double n[POINTS], rms[POINTS], sigma[POINTS];
    lc_expected expected = {SIDE, SIDE, calloc(3 * pixels, sizeof(double)), calloc(pixels, 1)};
    row->margin = SLOPE_MARGIN;
    lc_status status = expected.rgb && expected.skip
                           ? claim->expect(&expected, claim, claim->scene, share->threads, err)
                           : lc_fail(err, LC_FAULT, "out of memory for expected values");
    if (status == LC_OK)
        status = measure_points(row, n, rms, sigma, claim, share, &expected, err);
    if (status == LC_OK && row->verdict != LC_ROW_FAIL)
        status = fit(row, n, rms, sigma, share, err);
    free(expected.rgb);
    free(expected.skip);
    return status;
}

/* ---- light sampling against hemisphere sampling -------------------------------------------------------------------- */

/* GROUPS independent films of RATIO_SIDE^2 pixels: that many independent values of the variance, of which the logarithm is
 * averaged, with Student's t between them. No kurtosis has to be known. */
enum { GROUPS = 24, RATIO_SIDE = 16, RATIO_SAMPLES = 64 };

/* Variance of a sample, the mean over pixels and channels. */
static double variance_of(const lc_film *film)
{
    double sum = 0;
    size_t count = (size_t)film->width * (size_t)film->height;
    for (size_t i = 0; i < count; ++i)
        for (int c = 0; c < 3; ++c)
            sum += film->pixels[i].c[c].m2 / ((double)film->pixels[i].n - 1);
    return sum / (3 * (double)count);
}

/* Mean of ln variance over the groups, and the variance of that mean. */
static lc_status measure_variance(lc_row *row, double *mean, double *error2, const lc_claim *claim,
                                  const lc_estimator *estimator, uint32_t arm, const lc_share *share, lc_error *err)
{
    double m2 = 0;
    *mean = 0;
    for (int g = 0; g < GROUPS; ++g) {
        lc_film *film;
        lc_status status = render(&film, claim, estimator, share, arm, RATIO_SIDE, (uint64_t)g * RATIO_SAMPLES,
                                  RATIO_SAMPLES, err);
        if (status != LC_OK)
            return status;
        double x = log(variance_of(film)), d = x - *mean;
        *mean += d / (g + 1);
        m2 += d * (x - *mean);
        if (film->bad)
            say_bad(row, film);
        lc_film_free(film);
        row->paths += RATIO_SAMPLES * RATIO_SIDE * RATIO_SIDE;
    }
    *error2 = m2 / (GROUPS - 1) / GROUPS;
    return LC_OK;
}

/* The claim's margin is the ratio var(hemisphere) / var(this) that has to be shown: above it where > 1, below where < 1. */
static lc_status decide_ratio(lc_row *row, const lc_claim *claim, const lc_share *share, lc_error *err)
{
    double mean[2], error2[2];
    lc_status status = measure_variance(row, &mean[0], &error2[0], claim, claim->estimator, share->arm, share, err);
    if (status == LC_OK)
        status = measure_variance(row, &mean[1], &error2[1], claim, claim->other, lc_arm(claim->other->name) ^ 1, share,
                                  err);
    if (status != LC_OK || row->verdict == LC_ROW_FAIL)
        return status;
    row->samples = GROUPS * RATIO_SAMPLES;
    double error = sqrt(error2[0] + error2[1]), ratio = mean[1] - mean[0];
    double pass = error * lc_t_quantile(share->false_pass, GROUPS - 1);
    double fail = error * lc_t_quantile(share->false_fail, GROUPS - 1);
    int more = claim->margin > 1;
    row->ratio = exp(ratio);
    row->low = exp(ratio - pass);
    row->high = exp(ratio + pass);
    row->expected = exp(mean[1]);
    int shown = more ? row->low > claim->margin : row->high < claim->margin;
    int refuted = more ? exp(ratio + fail) < claim->margin : exp(ratio - fail) > claim->margin;
    row->verdict = refuted ? LC_ROW_FAIL : shown ? LC_ROW_PASS : LC_ROW_UNDECIDED;
    if (!shown)
        snprintf(row->reason, sizeof row->reason, "%s on %s: hemisphere sampling has %.3g times its variance, [%.3g, %.3g]; "
                                                  "expected %s %.3g",
                 row->estimator, row->scene, row->ratio, row->low, row->high, more ? "more than" : "less than",
                 claim->margin);
    return LC_OK;
}

/* ---- rows --------------------------------------------------------------------------------------------------------------- */

/* Scenes with a closed form. */
static const struct slope_row {
    const char *scene;
    lc_expect_fn *expect;
    int bounces;
    const char *source;
} slope_rows[] = {
    {"two_patches", lc_expect_direct, 1, "error ~ N^-1/2, against Lambert's polygon formula"},
    {"furnace_checker", lc_expect_inside, 4, "error ~ N^-1/2, against the inside of a sphere"},
};

/* The lecture's two methods, by name: another estimator need not beat anything. */
static const struct ratio_row {
    const char *scene, *estimator;
    double ratio; /* var(hemisphere_direct) / var(this): at least, or where < 1 at most */
    const char *source;
} ratio_rows[] = {
    {"cornell", "light_direct", 100, "the demo: hemisphere sampling has more than 100 times the variance"},
    {"cornell", "three_point", 100, "the demo: hemisphere sampling has more than 100 times the variance"},
    {"plane_tilted", "light_direct", 10, "the demo: hemisphere sampling has more than 10 times the variance"},
    {"plane_cube", "light_direct", 0.9, "not everywhere: hemisphere sampling has less, for half of this lamp's points look away"},
};

static lc_status add_ratio(const lc_check *self, lc_claims *claims, const struct ratio_row *row, const lc_scene *scene,
                           const lc_estimator *estimator, lc_error *err)
{
    const lc_estimator *hemisphere = NULL;
    for (const lc_estimator *const *e = lc_estimators; *e; ++e)
        if (strcmp((*e)->name, "hemisphere_direct") == 0)
            hemisphere = *e;
    if (!hemisphere || hemisphere == estimator)
        return LC_OK;
    lc_claim *claim = lc_claims_add(claims, self, scene, estimator);
    if (!claim)
        return lc_fail(err, LC_FAULT, "out of memory for the claims");
    claim->other = hemisphere;
    claim->decide = decide_ratio;
    claim->relation = "variance";
    claim->margin = row->ratio;
    claim->source = row->source;
    return LC_OK;
}

static lc_status plan(const lc_check *self, lc_claims *claims, const lc_scene *scene, const lc_estimator *estimator,
                      lc_error *err)
{
    const char *name = lc_scene_description(scene)->name;
    for (size_t i = 0; i < sizeof ratio_rows / sizeof ratio_rows[0]; ++i) {
        if (strcmp(ratio_rows[i].scene, name) != 0 || strcmp(ratio_rows[i].estimator, estimator->name) != 0)
            continue;
        lc_status status = add_ratio(self, claims, &ratio_rows[i], scene, estimator, err);
        if (status != LC_OK)
            return status;
    }
    for (size_t i = 0; i < sizeof slope_rows / sizeof slope_rows[0]; ++i) {
        const struct slope_row *row = &slope_rows[i];
        if (strcmp(row->scene, name) != 0 || !lc_sees_everything(scene, estimator) ||
            estimator->max_bounces < row->bounces || (row->bounces == 1 && estimator->max_bounces > 1))
            continue;
        lc_claim *claim = lc_claims_add(claims, self, scene, estimator);
        if (!claim)
            return lc_fail(err, LC_FAULT, "out of memory for the claims");
        claim->max_bounces = row->bounces;
        claim->expect = row->expect;
        claim->tolerance = 1e-5;
        claim->decide = decide_slope;
        claim->relation = "slope";
        claim->full_only = row->bounces > 1;
        claim->source = row->source;
    }
    return LC_OK;
}

const lc_check lc_check_convergence = {
    "convergence",
    "the error falls as N^-1/2, and light sampling has less of it than hemisphere sampling",
    "Path Tracing (Bikker 2021-22), the demo; Shirley, Wang, Zimmerman 1996",
    plan,
    NULL,
};
