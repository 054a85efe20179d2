/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * calibrate: how often does the judge decide wrongly? Writes results/calibration.md; exit status 1 when a rate is above
 * its level, 4 when the file cannot be written. Through the judge's own functions: films, fields, looks, budget,
 * pyramid, verdicts.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "verify/judge/judge.h"
#include "verify/proof/exact.h"
#include "verify/proof/rendered.h"
#include "verify/proof/synthetic.h"
#include "verify/stats/stats.h"

enum { SIDE = 8, PIXELS = SIDE * SIDE, TRIALS = 10000 };

/* Samples a pixel that a row plans for. */
enum { PLANNED = 5 * LC_LEAST_SAMPLES };

static const double ALPHA = 0.01;

/* ---- synthetic films, through all looks -------------------------------------------------------------------- */

typedef struct case_of {
    lc_law law;
    const lc_law *dark; /* of the right half, which is then 1/100 as bright; NULL: one law for all */
    int arms;
    int uneven;   /* brightness from 1/16 to 16 over the image */
    int at_bound; /* the true difference is the margin, PASS is wrong; else it is 0 and FAIL is wrong */
    uint64_t seed, experiment;
    unsigned char verdict[TRIALS], look[TRIALS];
    unsigned char skewed[TRIALS]; /* FAIL of the whole image was out of reach at the last look */
} case_of;

static int is_dark(const case_of *c, int i) { return c->dark && i % SIDE >= SIDE / 2; }
static const lc_law *law_of(const case_of *c, int i) { return is_dark(c, i) ? c->dark : &c->law; }
static double brightness(const case_of *c, int i) { return is_dark(c, i) ? 0.01 : c->uneven ? ldexp(1, i % 9 - 4) : 1; }

/* Standard deviation of the image's mean at the first look, of one arm. */
static double first_error(const case_of *c, uint64_t samples)
{
    double sum = 0;
    for (int i = 0; i < PIXELS; ++i)
        sum += pow(brightness(c, i), 2);
    return c->law.deviation * sqrt(sum / (double)samples) / PIXELS;
}

static void add_samples(lc_film *film, const case_of *c, uint64_t count, double shift, lc_stream *stream)
{
    for (int i = 0; i < PIXELS; ++i) {
        lc_pixel part;
        memset(&part, 0, sizeof part);
        lc_law_draw(&part, law_of(c, i), count, brightness(c, i), shift, stream);
        lc_pixel_merge(&film->pixels[i], &part);
    }
    film->count += count;
}

/* One row of one channel, as the judge decides it. */
static void row_trial(void *user, int trial)
{
    case_of *c = user;
    lc_pixel pixels[2][PIXELS];
    lc_film film[2];
    lc_estimate field[PIXELS];
    double expected[3 * PIXELS];
    lc_stream stream;
    memset(pixels, 0, sizeof pixels);
    memset(film, 0, sizeof film);
    for (int arm = 0; arm < 2; ++arm) {
        film[arm].width = film[arm].height = SIDE;
        film[arm].pixels = pixels[arm];
        film[arm].has_third = 1;
        film[arm].arm = (uint32_t)arm;
    }
    for (int i = 0; i < PIXELS; ++i)
        expected[3 * i] = law_of(c, i)->mean * brightness(c, i);
    lc_stream_start(&stream, c->seed, c->experiment, (uint64_t)trial);

    lc_looks looks = lc_looks_plan(PLANNED, UINT32_MAX);
    lc_budget budget = {ALPHA, ALPHA, 1, 1, looks.count};
    lc_pyramid_plan plan;
    lc_pyramid_plan_init(&plan, lc_budget_row_fail(&budget), lc_budget_row_pass(&budget));
    int top = lc_pyramid_levels(SIDE, SIDE) - 1;
    double shift = 0, tolerance = 0;
    if (c->at_bound) { /* FAIL would be right, and hide a false PASS: a declared error puts it out of reach */
        plan.margin[top] = 6 * sqrt(c->arms) * first_error(c, looks.samples[0]);
        shift = trial % 2 ? plan.margin[top] : -plan.margin[top];
        tolerance = 2 * plan.margin[top];
    }
    lc_verdict verdict = LC_GO_ON;
    lc_pyramid out;
    int look = 0;
    for (; look < looks.count && verdict == LC_GO_ON; ++look) {
        uint64_t more = looks.samples[look] - film[0].count;
        add_samples(&film[0], c, more, shift, &stream);
        if (c->arms == 2)
            add_samples(&film[1], c, more, 0, &stream);
        lc_status status = c->arms == 2 ? lc_field_two(field, &film[0], &film[1], 0, tolerance, NULL)
                                        : lc_field_one(field, &film[0], expected, 0, tolerance, NULL);
        if (!status)
            status = lc_pyramid_judge(&out, field, SIDE, SIDE, &plan, NULL);
        verdict = status ? LC_FAIL : lc_verdict_both(LC_PASS, out.verdict); /* a refusal would count as wrong */
    }
    c->verdict[trial] = (unsigned char)verdict;
    c->look[trial] = (unsigned char)look;
    c->skewed[trial] = out.level[top].skewed > 0;
}

/* 1 when the level lies below the interval of the rate: it is exceeded. */
static int print_rate(FILE *table, int wrong, int trials, double level)
{
    lc_interval rate = lc_clopper_pearson(wrong, trials, 0.05);
    fprintf(table, " %d | %d | %.4f [%.4f, %.4f] | %s |", trials, wrong, (double)wrong / trials, rate.lower, rate.upper,
            rate.lower <= level ? "holds" : "**exceeded**");
    return rate.lower > level;
}

/* With `bright`, the laws are those of the dark half beside it. */
static int report_rows(FILE *table, uint64_t seed, const lc_law *laws, int count, const lc_law *bright, int at_bound,
                       uint64_t experiment)
{
    case_of *c = malloc(sizeof *c);
    int broken = 0;
    if (!c)
        return 1;
    fprintf(table,
            "| law | c | skewness | arms | image |%s comparisons | wrong | rate, 95%% interval | %.2g |\n"
            "|---|---|---|---|---|%s---|---|---|---|\n",
            at_bound ? "" : " out of reach at the end |", ALPHA, at_bound ? "" : "---|");
    for (int l = 0; l < count; ++l)
        for (int arms = 1; arms <= 2; ++arms) {
            c->law = bright ? *bright : laws[l];
            c->dark = bright ? &laws[l] : NULL;
            c->arms = arms;
            c->uneven = l % 2 == 1 && !bright;
            c->at_bound = at_bound;
            c->seed = seed;
            c->experiment = experiment + 10 * (uint64_t)l + (uint64_t)arms;
            lc_trials_run(row_trial, c, TRIALS);
            int wrong = 0, skewed = 0;
            for (int i = 0; i < TRIALS; ++i) {
                wrong += c->verdict[i] == (at_bound ? LC_PASS : LC_FAIL);
                skewed += c->skewed[i];
            }
            fprintf(table, "| %s | %.3g | %.1f | %d | %s |", laws[l].name, laws[l].deviation / laws[l].mean, laws[l].skewness, arms,
                    bright      ? "half dark"
                    : c->uneven ? "uneven"
                                : "even");
            if (!at_bound)
                fprintf(table, " %.0f%% |", 100.0 * skewed / TRIALS);
            broken += print_rate(table, wrong, TRIALS, ALPHA);
            fprintf(table, "\n");
        }
    free(c);
    return broken;
}

/* ---- the judge of two images -------------------------------------------------------------------------------- */

/* Two films, the first (1 +- margin) times as bright as the second in one channel and equal in two calm ones. */
typedef struct compare_case {
    lc_law law;
    double margin;
    uint64_t samples, seed, experiment;
    unsigned char passed[TRIALS];
} compare_case;

static void fill_film(lc_film *film, lc_pixel *pixels, const compare_case *c, double scale, lc_stream *stream)
{
    memset(film, 0, sizeof *film);
    film->width = film->height = SIDE;
    film->pixels = pixels;
    film->has_third = 1;
    film->count = c->samples;
    lc_law calm = lc_law_gaussian(1, 1e-3);
    for (int i = 0; i < PIXELS; ++i) {
        lc_pixel *p = &pixels[i];
        memset(p, 0, sizeof *p);
        for (int channel = 1; channel < 3; ++channel) {
            lc_law_draw(p, &calm, c->samples, 1, 0, stream);
            p->c[channel] = p->c[0];
        }
        lc_law_draw(p, &c->law, c->samples, scale, 0, stream);
    }
}

static void compare_trial(void *user, int trial)
{
    compare_case *c = user;
    lc_pixel pixels[2][PIXELS];
    lc_film a, b;
    lc_row row;
    lc_stream stream;
    lc_stream_start(&stream, c->seed, c->experiment, (uint64_t)trial);
    fill_film(&a, pixels[0], c, trial % 2 ? 1 + c->margin : 1 - c->margin, &stream);
    fill_film(&b, pixels[1], c, 1, &stream);
    b.arm = 1;
    memset(&row, 0, sizeof row);
    c->passed[trial] =
        lc_compare_films(&row, &a, &b, c->margin, 1e-15, 2 * ALPHA, NULL) != LC_OK || row.verdict == LC_ROW_PASS;
}

/* Half of the trials are at either end, and each end is held against its own rate. */
static int report_compare(FILE *table, uint64_t seed)
{
    static const double margins[] = {0.005, 0.05, 0.2};
    compare_case *c = malloc(sizeof *c);
    int broken = 0;
    if (!c)
        return 1;
    fprintf(table,
            "\n## False PASS of `lightcheck compare`, margins relative to the second, noisy image\n\nAt a level of "
            "%.2g for each end.\n\n| margin | brighter by it: comparisons | wrong | rate | %.2g | darker by it: "
            "comparisons | wrong | rate | %.2g |\n|---|---|---|---|---|---|---|---|---|\n",
            2 * ALPHA, 2 * ALPHA, 2 * ALPHA);
    for (int m = 0; m < 3; ++m) {
        c->law = lc_law_gaussian(1, 2);
        c->margin = margins[m];
        c->seed = seed;
        c->experiment = 300 + (uint64_t)m;
        c->samples = (uint64_t)(2 * pow(5 * c->law.deviation / c->margin, 2) / PIXELS) + LC_LEAST_SAMPLES;
        lc_trials_run(compare_trial, c, TRIALS);
        int wrong[2] = {0, 0};
        for (int i = 0; i < TRIALS; ++i)
            wrong[i % 2] += c->passed[i];
        fprintf(table, "| %g%% |", 100 * c->margin);
        broken += print_rate(table, wrong[1], TRIALS / 2, 2 * ALPHA);
        broken += print_rate(table, wrong[0], TRIALS / 2, 2 * ALPHA);
        fprintf(table, "\n");
    }
    free(c);
    return broken;
}

/* ---- the table ------------------------------------------------------------------------------------------------ */

static lc_status report(FILE *table, int *broken, uint64_t seed, lc_error *err)
{
    const lc_law laws[] = {lc_law_gaussian(1, 2),  lc_law_coin(0.5, 2),   lc_law_coin(0.05, 20),   lc_law_exponential(),
                           lc_law_lognormal(0.75), lc_law_lognormal(1.2), lc_law_coin(0.0096, 100)};
    const lc_law dark[] = {lc_law_firefly(0.01, 10), lc_law_firefly(1e-3, 100), lc_law_firefly(1e-3, 1000)};
    const lc_law beyond[] = {lc_law_firefly(1e-3, 1000), lc_law_firefly(1e-4, 10000)};
    const int count = (int)(sizeof laws / sizeof laws[0]);
    lc_looks looks = lc_looks_plan(PLANNED, UINT32_MAX);
    fprintf(
        table,
        "\nFalse verdicts of the judge, at levels that can be counted (%.2g) and, below, at those at which it works. "
        "%dx%d\npixels, looks at %llu to %llu samples (1/5, 2/5, 3/5, 1 and 4 times a plan, as in the judge), the budget of %.2g split "
        "over looks, levels and\ntiles: plan, split and verdict by the judge's own functions.\nA rate `holds` when its interval (Clopper and Pearson) contains the level or lies "
        "under it.\n"
        "Uneven images have pixels 1/16 to 16 times as bright.\n",
        ALPHA, SIDE, SIDE, (unsigned long long)looks.samples[0], (unsigned long long)looks.samples[looks.count - 1], ALPHA);
    fprintf(table, "\n## False FAIL: nothing is wrong\n\n`Out of reach at the end`: rows whose whole image was still "
                   "guarded against its tails at the last look.\n\n");
    *broken += report_rows(table, seed, laws, count, NULL, 0, 0);
    fprintf(table, "\n## False FAIL: rare bright samples in the dark\n\nThe left half is a coin of p = 0.5; the right one has these "
                   "laws, 1/100 as bright: in the sums of the whole image\nthey do not count.\n\n");
    *broken += report_rows(table, seed, dark, 3, &laws[1], 0, 400);
    fprintf(table,
            "\n## False PASS: the difference is exactly the margin\n\nHalf of the rows at either end; the margin is "
            "6 standard errors of the first look.\n\n");
    *broken += report_rows(table, seed, laws, count, NULL, 1, 100);
    *broken += report_compare(table, seed);
    *broken += lc_exact_report(table, seed);
    lc_status status = lc_rendered_report(table, broken, seed, err);
    fprintf(
        table,
        "\n## False FAIL beyond what is claimed\n\nA bright sample in 1/p, worth 1/p: half of the light or more comes "
        "from it. Where the whole film has not met one,\nnothing in it tells: against exact values such a row FAILs "
        "falsely at the first look, with the probability that all\nof its samples miss, (1 - p)^(%d x %d). Two "
        "films miss alike, and are safe. These rows do not enter the verdict below.\n\n",
        (int)PIXELS, (int)LC_LEAST_SAMPLES);
    report_rows(table, seed, beyond, 2, NULL, 0, 200);
    fprintf(table, "\n%s\n", *broken ? "**Some rate exceeds its level.**" : "Every rate holds its level.");
    return status;
}

int main(int argc, char **argv)
{
    lc_error err = {"cannot write the table"};
    uint64_t seed = argc > 2 ? strtoull(argv[2], NULL, 10) : 1;
    const char *path = argc > 1 ? argv[1] : "results/calibration.md";
    int broken = 0;
    FILE *table = lc_table_open(path, "Calibration of the judge", "make calibrate", seed);
    lc_status status = table ? report(table, &broken, seed, &err) : LC_FAULT;
    if (table && lc_table_close(table) != 0 && !status)
        status = LC_FAULT;
    if (status)
        fprintf(stderr, "calibrate: %s: %s\n", path, err.text);
    if (status)
        return (int)status;
    return broken ? LC_WRONG : LC_OK;
}
