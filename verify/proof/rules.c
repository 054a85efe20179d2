/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Decision rules of other programs, and ours; see rules.h. */
#include "verify/proof/rules.h"

#include <math.h>
#include <stdlib.h>

#include "verify/proof/law_tail.h"

const char *const lc_rule_notes =
    "- **Nori** (src/ttest.cpp): one t test of the mean luminance of the image against a literal. Published at\n"
    "  alpha = 0.01 with Sidak's correction over the literals of a file; here one literal at the common rate.\n"
    "- **Mitsuba 3** (src/render/tests/test_renders.py): z of each pixel from a reference and the reference's\n"
    "  variance (not below 1e-4); accepted when p > alpha, Sidak over the pixels, in 99.75% of them. `published`:\n"
    "  alpha = 0.01, so that 11 pixels beyond 4.7 sigma fail an image, a false-failure rate of about 1e-30. `quorum`:\n"
    "  the 99.75% kept and alpha raised until 11 pixels beyond it have the common rate, the strongest form of their\n"
    "  rule against a uniform bias. `strict`: the common rate by Sidak alone, every pixel must pass: the strongest\n"
    "  against one pixel. The reference is perfect: exact mean and variance. On skewed laws the thresholds of both\n"
    "  are those of the law of a pixel's mean, by importance sampling.\n"
    "- **pbrt-v4** (src/pbrt/cpu/integrators_test.cpp): the mean of the image within 0.025 of 1. `published`: that\n"
    "  band, whatever its rate. `band`: the band that has the common rate at each number of samples, from the exact\n"
    "  variance.\n"
    "- **Jung, Hanika, Dachsbacher** (JCGT 9(2), 2020): Welch's t test a tile, p values shown as a map and a\n"
    "  histogram; the paper leaves the verdict to the eye. `tiles`, `pixels`: the smallest p value, with Sidak's\n"
    "  correction; on skewed laws the thresholds are those of the law of a tile's t, by importance sampling: Student's\n"
    "  would fail some ten to a thousand times as many right images at 1e-6. `KS`: the Kolmogorov-Smirnov test of the p\n"
    "  values against the uniform law, its threshold from Birnbaum and Tingey's exact one-sided law (Ann. Math.\n"
    "  Statist. 22, 1951), doubled. Against exact values Welch's test is Student's.\n"
    "- **lightcheck**: FAIL by the pyramid, one row, one channel, one look.\n";

/* ---- thresholds ------------------------------------------------------------------------------------------- */

enum { QUORUM = 11 }; /* pixels: more than 0.25% of 4096 */
static const int tile_sides[] = {32, 8, 1};

/* Birnbaum and Tingey: P(D+ >= d) of n points. */
static double ks_one_sided(double d, int n)
{
    double sum = 0;
    for (int j = 0; j <= (int)floor(n * (1 - d)); ++j) {
        double x = d + (double)j / n, y = 1 - x;
        if (y > 0)
            sum += exp(lgamma(n + 1.0) - lgamma(j + 1.0) - lgamma(n - j + 1.0) + (n - j) * log(y) + (j - 1) * log(x));
    }
    return d * sum;
}

static double ks_limit(double alpha, int n)
{
    double low = 0, high = 1;
    for (int i = 0; i < 50; ++i) {
        double d = 0.5 * (low + high);
        if (2 * ks_one_sided(d, n) > alpha)
            low = d;
        else
            high = d;
    }
    return high;
}

void lc_limits_init(lc_limits *limits, double alpha, const lc_law *law, double samples)
{
    const int n = LC_RULE_PIXELS;
    limits->alpha = alpha;
    limits->mean_z = lc_normal_quantile(0.5 * alpha);
    limits->published_z = lc_normal_quantile(0.5 * lc_sidak_level(0.01, n));
    /* P(at least k of n) = I_q(k, n - k + 1). */
    double q = 1 / (1 + exp(-lc_beta_quantile_logit(alpha, QUORUM, n - QUORUM + 1)));
    for (int side = 0; side < 2; ++side) {
        limits->quorum_z[side] = lc_law_mean_quantile(law, samples, 0.5 * q, side ? 1 : -1);
        limits->strict_z[side] = lc_law_mean_quantile(law, samples, 0.5 * lc_sidak_level(alpha, n), side ? 1 : -1);
    }
    for (int i = 0; i < 3; ++i) {
        int tiles = n / (tile_sides[i] * tile_sides[i]);
        double level = 0.5 * lc_sidak_level(alpha, tiles);
        limits->sidak_log_p[i] = log(level);
        for (int side = 0; side < 2; ++side)
            limits->sidak_t[i][side] = lc_law_student_quantile(law, samples * n / tiles, level, side ? 1 : -1);
        limits->ks[i] = ks_limit(alpha, tiles);
    }
}

/* ---- the mean of the image: Nori, pbrt -------------------------------------------------------------------- */

static lc_student tile_student(const lc_evidence *e, int x0, int y0, int side)
{
    lc_estimate sum = lc_estimate_zero();
    for (int y = y0; y < y0 + side; ++y)
        for (int x = x0; x < x0 + side; ++x)
            lc_estimate_add(&sum, &e->field[y * LC_RULE_SIDE + x]);
    return lc_estimate_student(&sum);
}

static int nori_fails(const lc_evidence *e)
{
    lc_student s = tile_student(e, 0, 0, LC_RULE_SIDE);
    return lc_t_log_sf(fabs(s.difference) / s.error, s.df) <= log(0.5 * e->limits->alpha);
}

static double mean_difference(const lc_evidence *e)
{
    double sum = 0;
    for (int i = 0; i < LC_RULE_PIXELS; ++i)
        sum += e->field[i].difference;
    return fabs(sum) / LC_RULE_PIXELS;
}

static int pbrt_published_fails(const lc_evidence *e) { return mean_difference(e) > 0.025; }

static int pbrt_band_fails(const lc_evidence *e)
{
    return mean_difference(e) > e->limits->mean_z * e->deviation / sqrt(e->samples * LC_RULE_PIXELS);
}

/* ---- pixels: Mitsuba 3 -------------------------------------------------------------------------------------- */

static int mitsuba_fails(const lc_evidence *e, double dark, double bright, int quorum)
{
    double scale = sqrt(e->samples / fmax(e->deviation * e->deviation, 1e-4));
    int beyond = 0;
    for (int i = 0; i < LC_RULE_PIXELS; ++i) {
        double z = e->field[i].difference * scale;
        beyond += z >= bright || -z >= dark;
    }
    return beyond >= quorum;
}

static int mitsuba_published_fails(const lc_evidence *e)
{
    return mitsuba_fails(e, e->limits->published_z, e->limits->published_z, QUORUM);
}

static int mitsuba_quorum_fails(const lc_evidence *e)
{
    return mitsuba_fails(e, e->limits->quorum_z[0], e->limits->quorum_z[1], QUORUM);
}

static int mitsuba_strict_fails(const lc_evidence *e)
{
    return mitsuba_fails(e, e->limits->strict_z[0], e->limits->strict_z[1], 1);
}

/* ---- tiles: Jung, Hanika, Dachsbacher ----------------------------------------------------------------------- */

static int jung_tiles_fail(const lc_evidence *e, int which)
{
    int side = tile_sides[which];
    const double *skewed = e->limits->sidak_t[which];
    double limit = e->limits->sidak_log_p[which], z = lc_normal_quantile(exp(limit));
    for (int y = 0; y < LC_RULE_SIDE; y += side)
        for (int x = 0; x < LC_RULE_SIDE; x += side) {
            lc_student s = tile_student(e, x, y, side);
            double t = fabs(s.difference) / s.error, known = skewed[s.difference > 0];
            if (isnan(known) ? t >= z && lc_t_log_sf(t, s.df) <= limit /* t has the heavier tail */ : t > known)
                return 1;
        }
    return 0;
}

/* Two-sided p of t; with many degrees through Wallace's normal deviate (Ann. Math. Statist. 30, 1959), whose error of
 * less than 1e-5 no test of uniformity sees. */
static double p_value(const lc_student *s)
{
    if (!s->testable)
        return 1; /* all samples equal */
    double t = fabs(s->difference) / s->error, df = s->df;
    if (df < 50)
        return 2 * exp(lc_t_log_sf(t, df));
    return erfc((8 * df + 1) / (8 * df + 3) * sqrt(0.5 * df * log1p(t * t / df)));
}

static int compare_doubles(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

static int jung_ks_fails(const lc_evidence *e, int which)
{
    double p[LC_RULE_PIXELS], d = 0;
    int side = tile_sides[which], n = 0;
    for (int y = 0; y < LC_RULE_SIDE; y += side)
        for (int x = 0; x < LC_RULE_SIDE; x += side) {
            lc_student s = tile_student(e, x, y, side);
            p[n++] = p_value(&s);
        }
    qsort(p, (size_t)n, sizeof *p, compare_doubles);
    for (int i = 0; i < n; ++i)
        d = fmax(d, fmax((i + 1.0) / n - p[i], p[i] - (double)i / n));
    return d >= e->limits->ks[which];
}

static int jung_32_fails(const lc_evidence *e) { return jung_tiles_fail(e, 0); }
static int jung_8_fails(const lc_evidence *e) { return jung_tiles_fail(e, 1); }
static int jung_1_fails(const lc_evidence *e) { return jung_tiles_fail(e, 2); }
static int ks_32_fails(const lc_evidence *e) { return jung_ks_fails(e, 0); }
static int ks_8_fails(const lc_evidence *e) { return jung_ks_fails(e, 1); }
static int ks_1_fails(const lc_evidence *e) { return jung_ks_fails(e, 2); }

/* ---- ours --------------------------------------------------------------------------------------------------- */

static int lightcheck_fails(const lc_evidence *e)
{
    lc_pyramid_plan plan;
    lc_pyramid out;
    lc_pyramid_plan_init(&plan, e->limits->alpha, e->limits->alpha);
    return lc_pyramid_judge(&out, e->field, LC_RULE_SIDE, LC_RULE_SIDE, &plan, NULL) == LC_OK && out.verdict == LC_FAIL;
}

const lc_rule lc_rules[] = {
    {"Nori, mean of the image", 1, 1, nori_fails},
    {"pbrt-v4, published band", 0, 0, pbrt_published_fails},
    {"pbrt-v4, band", 0, 1, pbrt_band_fails},
    {"Mitsuba 3, published", 0, 0, mitsuba_published_fails},
    {"Mitsuba 3, quorum", 0, 1, mitsuba_quorum_fails},
    {"Mitsuba 3, strict", 0, 1, mitsuba_strict_fails},
    {"Jung et al., tiles 32x32", 1, 1, jung_32_fails},
    {"Jung et al., tiles 8x8", 1, 1, jung_8_fails},
    {"Jung et al., pixels", 1, 1, jung_1_fails},
    {"Jung et al., KS of tiles 32x32", 1, 1, ks_32_fails},
    {"Jung et al., KS of tiles 8x8", 1, 1, ks_8_fails},
    {"Jung et al., KS of pixels", 1, 1, ks_1_fails},
    {"lightcheck", 1, 1, lightcheck_fails},
    {NULL, 0, 0, NULL},
};
