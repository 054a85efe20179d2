/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exact false-FAIL and false-PASS rates of coins; see exact.h. */
#include "verify/proof/exact.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "verify/proof/synthetic.h"
#include "verify/stats/stats.h"

static lc_pixel coin_pixel(double n, double hits)
{
    lc_pixel p;
    memset(&p, 0, sizeof p);
    double q = hits / n;
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

/* ---- one pixel -------------------------------------------------------------------------------------------- */

/* Rates over their level: the judge's; Student's t without guard and correction; the normal quantile instead of t. */
typedef struct rates {
    double judged, student, normal;
} rates;

static rates fail_rates(double n, double p, double alpha)
{
    rates sum = {0, 0, 0};
    double deviation = sqrt(n * p * (1 - p)), t_limit = lc_t_quantile(0.5 * alpha, n - 1);
    double z_limit = lc_normal_quantile(0.5 * alpha), last = fmin(n, ceil(n * p + 16 * deviation));
    lc_pyramid_plan plan;
    lc_pyramid_plan_init(&plan, alpha, 1e-6);
    for (double k = fmax(0, floor(n * p - 16 * deviation)); k <= last; ++k) {
        lc_pixel pixel = coin_pixel(n, k);
        lc_estimate e = lc_estimate_one(&pixel, 1, 0, p, 0);
        lc_student s = lc_estimate_student(&e);
        double weight = exp(log_binomial(n, k, p)), t = fabs(s.difference) / s.error;
        lc_pyramid out;
        if (lc_pyramid_judge(&out, &e, 1, 1, &plan, NULL) == LC_OK && out.verdict == LC_FAIL)
            sum.judged += weight / alpha;
        sum.student += t >= t_limit ? weight / alpha : 0;
        sum.normal += t >= z_limit ? weight / alpha : 0;
    }
    return sum;
}

/* The true difference is `sign` times the margin. */
static rates pass_rates(double n, double p, double alpha, int sign)
{
    rates sum = {0, 0, 0};
    double deviation = sqrt(n * p * (1 - p)), margin = 20 * sqrt(p * (1 - p) / n);
    double t_limit = lc_t_quantile(alpha, n - 1), z_limit = lc_normal_quantile(alpha);
    lc_pyramid_plan plan;
    lc_pyramid_plan_init(&plan, 1e-300, alpha);
    plan.margin[0] = margin;
    double last = fmin(n, ceil(n * p + 16 * deviation));
    for (double k = fmax(0, floor(n * p - 16 * deviation)); k <= last; ++k) {
        lc_pixel pixel = coin_pixel(n, k);
        lc_estimate e = lc_estimate_one(&pixel, 1, 0, p - sign * margin, 0);
        lc_student s = lc_estimate_student(&e);
        double weight = exp(log_binomial(n, k, p)), t = (margin - fabs(s.difference)) / s.error;
        lc_pyramid out;
        if (lc_pyramid_judge(&out, &e, 1, 1, &plan, NULL) == LC_OK && out.verdict == LC_PASS)
            sum.judged += weight / alpha;
        sum.student += t >= t_limit ? weight / alpha : 0;
        sum.normal += t >= z_limit ? weight / alpha : 0;
    }
    return sum;
}

static int report_pixel(FILE *table)
{
    static const double alphas[] = {1e-6, 1e-8, 1e-11}, chances[] = {0.5, 0.2, 0.03}, factors[] = {0.25, 1, 2, 8};
    int broken = 0;
    fprintf(table, "\n## One pixel of coins, every count enumerated\n\nA sample is 1 with probability p, else 0. Rates "
                   "are in units of their level alpha and must not exceed 1;\n`unguarded` is Student's t without the "
                   "judge's guard and correction for skewness, `normal` takes the normal quantile\nas well. Samples: "
                   "multiples of what the guard asks for (below it, FAIL is out of reach on the skewed side).\n\n"
                   "| false | alpha | p | skewness | samples | judge | unguarded | normal |\n"
                   "|---|---|---|---|---|---|---|---|\n");
    for (int pass = 0; pass < 2; ++pass)
        for (int a = 0; a < 3; ++a)
            for (int c = 0; c < 3; ++c)
                for (int f = 0; f < 4; ++f) {
                    double p = chances[c], g = (1 - 2 * p) / sqrt(p * (1 - p));
                    double need = g * lc_skew_weight(pass ? alphas[a] : alphas[a] / 2) / LC_SKEW_LIMIT;
                    double n = floor(factors[f] * fmax(need * need, 1200));
                    rates r = pass ? pass_rates(n, p, alphas[a], 1) : fail_rates(n, p, alphas[a]);
                    if (pass) {
                        rates other = pass_rates(n, p, alphas[a], -1);
                        r.judged = fmax(r.judged, other.judged);
                        r.student = fmax(r.student, other.student);
                        r.normal = fmax(r.normal, other.normal);
                    }
                    fprintf(table, "| %s | %.0e | %g | %.1f | %.0f | %.2f | %.2f | %.2f |\n", pass ? "PASS" : "FAIL",
                            alphas[a], p, g, n, r.judged, r.student, r.normal);
                    broken += r.judged > 1;
                }
    return broken;
}

/* ---- a pyramid of two pixels ------------------------------------------------------------------------------ */

static double pair_rate(double n, double p, double alpha)
{
    double rate = 0, width = 10 * sqrt(n * p * (1 - p));
    double first = fmax(0, floor(n * p - width)), last = fmin(n, ceil(n * p + width));
    lc_pyramid_plan plan;
    lc_pyramid_plan_init(&plan, alpha, 1e-6);
    for (double a = first; a <= last; ++a) {
        lc_pixel pa = coin_pixel(n, a);
        lc_estimate field[2] = {lc_estimate_one(&pa, 1, 0, p, 0), lc_estimate_zero()};
        double weight_a = log_binomial(n, a, p);
        for (double b = first; b <= last; ++b) {
            double weight = weight_a + log_binomial(n, b, p);
            if (weight < log(alpha) - 30)
                continue; /* all of them together weigh less than 1e-5 alpha */
            lc_pixel pb = coin_pixel(n, b);
            field[1] = lc_estimate_one(&pb, 1, 0, p, 0);
            lc_pyramid out;
            if (lc_pyramid_judge(&out, field, 2, 1, &plan, NULL) == LC_OK && out.verdict == LC_FAIL)
                rate += exp(weight);
        }
    }
    return rate / alpha;
}

static int report_pair(FILE *table)
{
    static const double alphas[] = {1e-6, 1e-11}, chances[] = {0.5, 0.1}, samples[] = {1500, 6000};
    int broken = 0;
    fprintf(table,
            "\n## An image of two pixels, every pair of counts enumerated\n\nBoth levels of the pyramid at once: "
            "a FAIL anywhere.\n\n| alpha | p | samples | false FAIL / alpha |\n|---|---|---|---|\n");
    for (int a = 0; a < 2; ++a)
        for (int c = 0; c < 2; ++c)
            for (int n = 0; n < 2; ++n) {
                double rate = pair_rate(samples[n], chances[c], alphas[a]);
                fprintf(table, "| %.0e | %g | %.0f | %.2f |\n", alphas[a], chances[c], samples[n], rate);
                broken += rate > 1;
            }
    return broken;
}

/* ---- a whole pyramid, by importance sampling -------------------------------------------------------------- */

enum { SIDE = 16, PIXELS = SIDE * SIDE, LEVELS = 5, TILTED = 20000 };

/* A tile is chosen at random and its coins are loaded so that its mean lies near the edge of the rejection region; the
 * weight is the likelihood ratio against the mixture of all tiles and both directions (Veach's balance heuristic). */
typedef struct tilt_case {
    double p, n, alpha;
    uint64_t seed, experiment;
    double loaded[LEVELS][2]; /* p of a loaded tile, low and high */
    double weight[TILTED];
    unsigned char failed[TILTED][3]; /* pooled guard, own guard, none */
} tilt_case;

typedef struct tile_sums {
    int count;
    double hits[LEVELS][PIXELS];
    lc_estimate sum[LEVELS][PIXELS];
} tile_sums;

static void sum_tiles(tile_sums *sums, const double *hits, const lc_estimate *field)
{
    for (int l = 0; l < LEVELS; ++l) {
        int across = SIDE >> l;
        for (int i = 0; i < across * across; ++i) {
            sums->hits[l][i] = 0;
            sums->sum[l][i] = lc_estimate_zero();
        }
        for (int y = 0; y < SIDE; ++y)
            for (int x = 0; x < SIDE; ++x) {
                int i = (y >> l) * across + (x >> l);
                sums->hits[l][i] += hits[y * SIDE + x];
                lc_estimate_add(&sums->sum[l][i], &field[y * SIDE + x]);
            }
    }
}

static double mixture_weight(const tilt_case *c, const tile_sums *sums)
{
    double ratio = 0;
    for (int l = 0; l < LEVELS; ++l) {
        int tiles = (SIDE >> l) * (SIDE >> l);
        for (int side = 0; side < 2; ++side) {
            double gain = log(c->loaded[l][side] / c->p), loss = log((1 - c->loaded[l][side]) / (1 - c->p));
            double total = c->n * PIXELS / tiles;
            for (int i = 0; i < tiles; ++i)
                ratio += exp(sums->hits[l][i] * gain + (total - sums->hits[l][i]) * loss) / (2 * LEVELS * tiles);
        }
    }
    return 1 / ratio;
}

/* The pyramid as it would be with Student's t alone. */
static int fails_unguarded(const tilt_case *c, const tile_sums *sums)
{
    for (int l = 0; l < LEVELS; ++l) {
        int tiles = (SIDE >> l) * (SIDE >> l);
        double alpha = 0.5 * c->alpha / LEVELS / tiles, z = lc_normal_quantile(alpha);
        for (int i = 0; i < tiles; ++i) {
            lc_student s = lc_estimate_student(&sums->sum[l][i]);
            double t = fabs(s.difference) / s.error;
            if (s.testable && t >= z && lc_t_log_sf(t, s.df) <= log(alpha))
                return 1;
        }
    }
    return 0;
}

static void tilt_trial(void *user, int trial)
{
    tilt_case *c = user;
    lc_stream stream;
    lc_stream_start(&stream, c->seed, c->experiment, (uint64_t)trial);
    int l = (int)(gsl_rng_uniform(&stream.rng) * LEVELS), side = gsl_rng_uniform(&stream.rng) < 0.5, across = SIDE >> l;
    int chosen = (int)(gsl_rng_uniform(&stream.rng) * across * across);
    lc_law fair = lc_law_coin(c->p, 1), loaded = lc_law_coin(c->loaded[l][side], 1);
    double hits[PIXELS];
    lc_estimate field[PIXELS];
    for (int y = 0; y < SIDE; ++y)
        for (int x = 0; x < SIDE; ++x) {
            lc_pixel pixel;
            memset(&pixel, 0, sizeof pixel);
            int in = (y >> l) * across + (x >> l) == chosen, i = y * SIDE + x;
            lc_law_draw(&pixel, in ? &loaded : &fair, (uint64_t)c->n, 1, 0, &stream);
            hits[i] = round(pixel.c[0].mean * c->n);
            field[i] = lc_estimate_one(&pixel, 1, 0, c->p, 0);
        }
    tile_sums sums;
    sum_tiles(&sums, hits, field);
    c->weight[trial] = mixture_weight(c, &sums);
    for (int guard = 0; guard < 2; ++guard) {
        lc_pyramid_plan plan;
        lc_pyramid out;
        lc_pyramid_plan_init(&plan, c->alpha, 1e-6);
        plan.guard = guard ? LC_GUARD_OWN : LC_GUARD_POOLED;
        c->failed[trial][guard] =
            lc_pyramid_judge(&out, field, SIDE, SIDE, &plan, NULL) == LC_OK && out.verdict == LC_FAIL;
    }
    c->failed[trial][2] = (unsigned char)fails_unguarded(c, &sums);
}

static int report_tilted(FILE *table, uint64_t seed)
{
    static const double alphas[] = {1e-6, 1e-11}, cases[][2] = {{0.5, 4096}, {0.1, 4096}, {0.02, 4096}, {0.02, 65536}};
    tilt_case *c = malloc(sizeof *c);
    int broken = 0;
    if (!c)
        return 1;
    fprintf(
        table,
        "\n## A pyramid of %dx%d pixels of coins, by importance sampling\n\nA FAIL anywhere on any level, over alpha; "
        "+- is one standard error of %d draws. The judge's guard asks the\ntiles around a tile, too; `own` trusts each "
        "tile's, `unguarded` none. (An error that is not small beside its rate means\nthat the rate is ruled by "
        "events that the loaded coins do not aim at.)\n\n"
        "| alpha | p | skewness | samples | judge | own guard | unguarded |\n|---|---|---|---|---|---|---|\n",
        SIDE, SIDE, (int)TILTED);
    for (int a = 0; a < 2; ++a)
        for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
            c->p = cases[k][0];
            c->n = cases[k][1];
            c->alpha = alphas[a];
            c->seed = seed;
            c->experiment = 1000 + k;
            for (int l = 0; l < LEVELS; ++l) {
                double tiles = (double)(SIDE >> l) * (SIDE >> l);
                double step = lc_normal_quantile(0.5 * c->alpha / LEVELS / tiles) *
                              sqrt(c->p * (1 - c->p) / (c->n * PIXELS / tiles));
                c->loaded[l][0] = fmax(c->p - step, c->p / 4); /* a studentised low tail begins nearer than this */
                c->loaded[l][1] = fmin(c->p + step, 0.9);
            }
            lc_trials_run(tilt_trial, c, TILTED);
            fprintf(table, "| %.0e | %g | %.1f | %.0f |", c->alpha, c->p, lc_law_coin(c->p, 1).skewness, c->n);
            for (int rule = 0; rule < 3; ++rule) {
                double sum = 0, square = 0;
                for (int i = 0; i < TILTED; ++i) {
                    double x = c->failed[i][rule] ? c->weight[i] / c->alpha : 0;
                    sum += x / TILTED;
                    square += x * x / TILTED;
                }
                double error = sqrt((square - sum * sum) / TILTED);
                fprintf(table, " %.2g +- %.1g |", sum, error);
                broken += rule == 0 && sum - 3 * error > 1;
            }
            fprintf(table, "\n");
        }
    free(c);
    return broken;
}

int lc_exact_report(FILE *table, uint64_t seed)
{
    return report_pixel(table) + report_pair(table) + report_tilted(table, seed);
}
