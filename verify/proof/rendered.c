/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rendered nulls; see rendered.h. */
#include "verify/proof/rendered.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "estimators/registry.h"
#include "io/scene_read.h"
#include "verify/judge/judge_c.h"
#include "verify/proof/synthetic.h"

enum { SIDE = 8, PIXELS = SIDE * SIDE, LEVELS = 4, LOOKS = 2, RATES = 4 };

/* False FAILs of a row, at two levels. */
static const double alphas[] = {1e-2, 1e-3};
/* Those of a tile, at a level of its own. */
static const double rates[RATES] = {1e-1, 1e-2, 1e-3, 1e-4};

/* Two films of one integral, or one film and its closed form. */
typedef struct null_case {
    const char *scene, *estimator, *other; /* other NULL: the closed form of the analytic check */
    int max_bounces, trials;
} null_case;

static const null_case cases[] = {
    {"plane_rectangle", "light_direct", NULL, 1, 2000},
    {"plane_rectangle", "hemisphere_direct", NULL, 1, 2000},
    {"plane_sphere", "light_direct", NULL, 1, 2000},
    {"two_lights", "three_point", NULL, 1, 2000},
    {"sky", "hemisphere_direct", NULL, 1, 2000},
    {"cornell", "light_direct", NULL, 1, 2000},
    {"plane_rectangle", "light_direct", "light_direct", 1, 2000},
    {"plane_rectangle", "hemisphere_direct", "light_direct", 1, 2000},
    {"five_lights", "three_point", "light_direct", 1, 2000},
    {"cornell", "light_direct", "light_direct", 1, 2000},
    {"cornell", "hemisphere_direct", "hemisphere_direct", 1, 1000},
    {"bright_room", "path", "path", 3, 1000},
    {"glass_blend", "dielectric", "dielectric", 1, 1000},
};

/* Of one trial. Tiles are counted with one bit of detail: did Student's t, did the judge's test say FAIL? */
typedef struct outcome {
    unsigned char failed[2]; /* at each alpha, at either look */
    int tested[LOOKS][LEVELS], student[LOOKS][LEVELS][RATES], judged[LOOKS][LEVELS][RATES];
} outcome;

typedef struct experiment {
    const null_case *what;
    const lc_scene *scene;
    const lc_estimator *arm[2]; /* arm[1] NULL: `expected` */
    const lc_expected *expected;
    uint64_t seed, number;
    lc_looks looks; /* the least that a row can have: LOOKS of them */
    outcome *outcomes;
    lc_status *status;
} experiment;

static const lc_estimator *find_estimator(const char *name)
{
    for (const lc_estimator *const *e = lc_estimators; name && *e; ++e)
        if (strcmp((*e)->name, name) == 0)
            return *e;
    return NULL;
}

static lc_status load_scene(lc_scene **out, const char *name, lc_error *err)
{
    lc_scene_desc desc;
    lc_status status = lc_scene_describe(&desc, name, err);
    if (status != LC_OK)
        return status;
    desc.width = desc.height = SIDE;
    status = lc_scene_build(out, &desc, err);
    lc_scene_desc_release(&desc);
    return status;
}

/* ---- one trial ---------------------------------------------------------------------------------------------- */

/* Every arm of every trial of every case has a seed of its own: scenes that shared one would fail together. */
static lc_status grow(lc_film *film, const experiment *e, int arm, int trial, uint64_t samples)
{
    lc_render_options options = {.min_bounces = 1,
                                 .max_bounces = e->what->max_bounces,
                                 .seed = (e->seed << 40) + (e->number << 24) + 2 * (uint64_t)trial + (uint64_t)arm,
                                 .arm = lc_arm(e->arm[arm]->name),
                                 .first = film->count,
                                 .count = samples - film->count,
                                 .threads = 1};
    return lc_render(film, e->scene, e->arm[arm], &options, NULL);
}

static lc_estimate tile_of(const lc_estimate *field, int level, int x, int y)
{
    lc_estimate sum = lc_estimate_zero();
    for (int j = y; j < y + (1 << level); ++j)
        for (int i = x; i < x + (1 << level); ++i)
            lc_estimate_add(&sum, &field[j * SIDE + i]);
    return sum;
}

static void count_tiles(outcome *out, int look, const lc_estimate *field)
{
    for (int l = 0; l < LEVELS; ++l)
        for (int y = 0; y < SIDE; y += 1 << l)
            for (int x = 0; x < SIDE; x += 1 << l) {
                lc_estimate sum = tile_of(field, l, x, y);
                lc_student s = lc_estimate_student(&sum);
                if (!s.testable)
                    continue;
                int side = s.difference < 0 ? LC_LOW : LC_HIGH;
                double bound = side == LC_LOW ? -s.tolerance : s.tolerance;
                double log_p = lc_t_log_sf(fabs(s.difference - bound) / s.error, s.df);
                ++out->tested[look][l];
                for (int r = 0; r < RATES; ++r) {
                    double log_half = log(0.5 * rates[r]);
                    out->student[look][l][r] += log_p <= log_half;
                    out->judged[look][l][r] += lc_student_log_p(&s, side, bound, 0.5 * rates[r]) <= log_half;
                }
            }
}

static lc_status judge_look(outcome *out, const experiment *e, int look, lc_film *const film[2])
{
    lc_estimate field[PIXELS];
    lc_status status;
    if (e->expected) {
        double mean = 0;
        for (int i = 0; i < PIXELS; ++i)
            mean += e->expected->rgb[3 * i] / PIXELS;
        status = lc_field_one(field, film[0], e->expected->rgb, 0, 1e-5 * mean, NULL);
        for (int i = 0; i < PIXELS; ++i)
            if (e->expected->skip[i])
                field[i] = lc_estimate_zero();
    } else {
        status = lc_field_two(field, film[0], film[1], 0, 0, NULL);
    }
    if (status != LC_OK)
        return status;
    count_tiles(out, look, field);
    for (int a = 0; a < 2 && status == LC_OK; ++a) {
        lc_budget budget = {alphas[a], alphas[a], 1, 1, LOOKS};
        lc_pyramid_plan plan;
        lc_pyramid pyramid;
        lc_pyramid_plan_init(&plan, lc_budget_row_fail(&budget), lc_budget_row_pass(&budget));
        status = lc_pyramid_judge(&pyramid, field, SIDE, SIDE, &plan, NULL);
        out->failed[a] |= pyramid.verdict == LC_FAIL;
    }
    return status;
}

static void null_trial(void *user, int trial)
{
    experiment *e = user;
    lc_film *film[2] = {NULL, NULL};
    lc_status status = LC_OK;
    for (int arm = 0; arm < 2 && status == LC_OK; ++arm)
        status = lc_film_create(&film[arm], SIDE, SIDE, NULL);
    for (int look = 0; look < LOOKS && status == LC_OK; ++look) {
        uint64_t samples = e->looks.samples[look];
        status = grow(film[0], e, 0, trial, samples);
        if (status == LC_OK && e->arm[1])
            status = grow(film[1], e, 1, trial, samples);
        if (status == LC_OK)
            status = judge_look(&e->outcomes[trial], e, look, film);
    }
    lc_film_free(film[0]);
    lc_film_free(film[1]);
    e->status[trial] = status;
}

/* ---- a case ------------------------------------------------------------------------------------------------- */

/* The claim of the analytic check about the first arm; what it expects is the session's. */
static lc_status find_expected(experiment *e, lc_session *session, lc_error *err)
{
    lc_claims claims = {.count = 0};
    lc_status status = LC_OK;
    for (const lc_check *const *c = lc_checks; *c && status == LC_OK; ++c)
        if (strcmp((*c)->name, "analytic") == 0)
            status = (*c)->plan(*c, &claims, e->scene, e->arm[0], err);
    if (status == LC_OK)
        status = claims.count == 1 ? lc_session_values(&e->expected, session, &claims.items[0], err)
                                   : lc_fail(err, LC_FAULT, "%s has no closed form", e->what->scene);
    lc_claims_release(&claims);
    return status;
}

static lc_status run_case(experiment *e, lc_session *session, lc_error *err)
{
    lc_scene *scene = NULL;
    lc_status status = load_scene(&scene, e->what->scene, err);
    e->scene = scene;
    e->arm[0] = find_estimator(e->what->estimator);
    e->arm[1] = find_estimator(e->what->other);
    e->expected = NULL;
    if (status == LC_OK && !e->arm[1])
        status = find_expected(e, session, err);
    if (status == LC_OK) {
        lc_trials_run(null_trial, e, e->what->trials);
        for (int i = 0; i < e->what->trials && status == LC_OK; ++i)
            if (e->status[i] != LC_OK)
                status = lc_fail(err, e->status[i], "%s: null %d failed", e->what->scene, i);
    }
    lc_session_clear(session);
    lc_scene_free(scene);
    return status;
}

/* 1 when the level lies below the interval of the rate, at 95% for `cells` rates together. */
static int exceeds(long wrong, long trials, double level, int cells)
{
    return lc_clopper_pearson((double)wrong, (double)trials, 0.05 / cells).lower > level;
}

static int print_case(FILE *table, const experiment *e)
{
    const null_case *what = e->what;
    int broken = 0;
    fprintf(table, "| %s | %s | %s | %d | %d |", what->scene, what->estimator,
            what->other ? what->other : "closed form", what->max_bounces, what->trials);
    for (int a = 0; a < 2; ++a) {
        int wrong = 0;
        for (int i = 0; i < what->trials; ++i)
            wrong += e->outcomes[i].failed[a];
        lc_interval rate = lc_clopper_pearson(wrong, what->trials, 0.05);
        int is_broken = exceeds(wrong, what->trials, alphas[a], 1);
        fprintf(table, " %d: %.4f [%.4f, %.4f]%s |", wrong, (double)wrong / what->trials, rate.lower, rate.upper,
                is_broken ? " **exceeded**" : "");
        broken += is_broken;
    }
    fprintf(table, "\n");
    fflush(table);
    return broken;
}

typedef struct totals {
    long tested[LOOKS][LEVELS], student[LOOKS][LEVELS][RATES], judged[LOOKS][LEVELS][RATES];
} totals;

static void add_totals(totals *sum, const experiment *e)
{
    for (int i = 0; i < e->what->trials; ++i)
        for (int k = 0; k < LOOKS; ++k)
            for (int l = 0; l < LEVELS; ++l) {
                sum->tested[k][l] += e->outcomes[i].tested[k][l];
                for (int r = 0; r < RATES; ++r) {
                    sum->student[k][l][r] += e->outcomes[i].student[k][l][r];
                    sum->judged[k][l][r] += e->outcomes[i].judged[k][l][r];
                }
            }
}

static int print_totals(FILE *table, const char *kind, const totals *sum, const lc_looks *looks)
{
    int broken = 0;
    for (int l = 0; l < LEVELS; ++l)
        for (int k = 0; k < LOOKS; ++k) {
            fprintf(table, "| %s | %dx%d | %llu | %ld |", kind, 1 << l, 1 << l,
                    (unsigned long long)looks->samples[k], sum->tested[k][l]);
            for (int r = 0; r < RATES; ++r) {
                double expected = rates[r] * (double)sum->tested[k][l];
                int is_broken = exceeds(sum->judged[k][l][r], sum->tested[k][l], rates[r], 2 * LOOKS * LEVELS * RATES);
                fprintf(table, " %.2f, %.2f%s |", (double)sum->judged[k][l][r] / expected,
                        (double)sum->student[k][l][r] / expected, is_broken ? " **exceeded**" : "");
                broken += is_broken;
            }
            fprintf(table, "\n");
        }
    return broken;
}

/* ---- the section -------------------------------------------------------------------------------------------- */

static void print_head(FILE *table, const lc_looks *looks)
{
    fprintf(table,
            "\n## Rendered nulls\n\n%dx%d pixels, one channel, looks at %llu and %llu samples, the budget split over looks, "
            "levels and tiles. Each film has\na seed of its own. Embree's last bits differ between kinds of CPU, and "
            "these counts may with them.\n\n"
            "| scene | estimator | against | bounces | comparisons | false FAILs at %g: rate, 95%% interval | at %g "
            "|\n|---|---|---|---|---|---|---|\n",
            (int)SIDE, (int)SIDE, (unsigned long long)looks->samples[0], (unsigned long long)looks->samples[1], alphas[0], alphas[1]);
}

static int print_tiles(FILE *table, const totals *one, const totals *two, const lc_looks *looks)
{
    fprintf(table,
            "\nThe same tile by tile: how often a tile alone, tested at a level of its own, is called wrong, over that "
            "level: by the\njudge, and by Student's t without the correction for skewness. Above 1 by chance now and "
            "then (`exceeded`: at 95%% for\nall %d rates together), for the latter also where samples are skewed. "
            "Pixels that do not vary are not tested.\n\n"
            "| against | tile | samples | tests |",
            2 * LOOKS * LEVELS * RATES);
    for (int r = 0; r < RATES; ++r)
        fprintf(table, " %g |", rates[r]);
    fprintf(table, "\n|---|---|---|---|---|---|---|---|\n");
    return print_totals(table, "closed form", one, looks) + print_totals(table, "another film", two, looks);
}

lc_status lc_rendered_report(FILE *table, int *broken, uint64_t seed, lc_error *err)
{
    const int count = (int)(sizeof cases / sizeof cases[0]);
    const lc_looks looks = lc_looks_plan(LC_LEAST_SAMPLES, UINT32_MAX);
    static totals sums[2]; /* against closed forms, another film */
    lc_verify_options options;
    lc_verify_options_init(&options);
    lc_session session = {.options = &options};
    lc_status status = LC_OK;
    memset(sums, 0, sizeof sums);
    print_head(table, &looks);
    for (int i = 0; i < count && status == LC_OK; ++i) {
        size_t trials = (size_t)cases[i].trials;
        experiment e = {.what = &cases[i], .seed = seed, .number = (uint64_t)i + 1};
        e.looks = looks;
        e.outcomes = calloc(trials, sizeof *e.outcomes);
        e.status = calloc(trials, sizeof *e.status);
        status = e.outcomes && e.status ? run_case(&e, &session, err) : lc_fail(err, LC_FAULT, "out of memory");
        if (status == LC_OK) {
            *broken += print_case(table, &e);
            add_totals(&sums[cases[i].other != NULL], &e);
        }
        free(e.outcomes);
        free(e.status);
    }
    if (status == LC_OK)
        *broken += print_tiles(table, &sums[0], &sums[1], &looks);
    return status;
}
