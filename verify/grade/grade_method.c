/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Tests that ask for a method, by a number that a sample has, pooled over the image, beside the reference's: its variance, its rays, its
 * random numbers, or its variance times its rays. That last is what a given noise costs, however many paths are averaged in one sample: the
 * inverse of the efficiency of Hammersley and Handscomb, Monte Carlo Methods 1964, 5.1. None is taken to be normal: many films, each with
 * its own number, show by how much that is uncertain. Of the variance that needs a finite fourth moment, so that it is asked for over
 * scenes only where a sample's light is bounded.
 *
 * The films of this test can be told from others: by their samples a pixel, if by nothing else. So the samples that have the number
 * must have the right mean, too, and be independent of each other; else a file would give dark ones, or running means, where it
 * recognises the test. What samples cost is counted in films that are made once more, from the same random numbers: in the jail each film
 * has processes of its own, and nothing that a file is given differs.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "verify/grade/grading.h"
#include "verify/stats/estimate.h"
#include "verify/stats/tails.h"

/* 16 films of a scene of 64 x 64 pixels have the 256 samples a pixel that the judge of means asks for. */
enum { LOOKS = 3, PATHS = 1 << 16 };
static const int films_of_look[LOOKS] = {16, 32, 72};

/* Each look decides on that number, a mean and the independence. */
enum { DECISIONS = 3 };

/* The mean must be shown within the assignment's margin, times max(1, c), but within no less than these films can show: this is seven
 * standard errors at the first look, and fifteen at the last. */
static const double LEAST_MARGIN = 0.01;

/* Mean and variance of the films' numbers, and the films added up. */
typedef struct spread {
    int count;
    double mean, m2;
    lc_film *sum; /* each film is a batch of its pixels; NULL: none yet */
} spread;

static double variance_of(const lc_film *film)
{
    size_t pixels = (size_t)film->width * (size_t)film->height;
    double sum = 0;
    for (size_t i = 0; i < pixels; ++i)
        for (int c = 0; c < 3; ++c)
            sum += film->pixels[i].c[c].m2 / ((double)film->pixels[i].n - 1);
    return sum / (double)pixels;
}

/* Rays or random numbers of a sample, of a film of costs. */
static double cost_of(const lc_film *film, lc_test_kind kind)
{
    size_t pixels = (size_t)film->width * (size_t)film->height;
    double sum = 0;
    for (size_t i = 0; i < pixels; ++i)
        sum += film->pixels[i].c[kind == LC_KIND_NUMBERS ? 1 : 0].mean;
    return sum / (double)pixels;
}

static lc_status start_sum(lc_film **out, const lc_film *film, lc_error *err)
{
    lc_status status = lc_film_create(out, film->width, film->height, err);
    if (status != LC_OK)
        return status;
    lc_pixel *pixels = (*out)->pixels;
    **out = *film; /* a rendered film has no further ranges that it owns */
    (*out)->pixels = pixels;
    (*out)->count = 0;
    return LC_OK;
}

static lc_status add_film(spread *s, const lc_film *film, double v, lc_error *err)
{
    double step = v - s->mean;
    if (!s->sum) {
        lc_status status = start_sum(&s->sum, film, err);
        if (status != LC_OK)
            return status;
    }
    for (size_t i = 0; i < (size_t)film->width * (size_t)film->height; ++i) {
        lc_pixel p = film->pixels[i];
        p.batches = 1;
        for (int c = 0; c < 3; ++c) {
            p.c[c].batch_mean = p.c[c].mean;
            p.c[c].batch_m2 = 0;
        }
        lc_pixel_merge(&s->sum->pixels[i], &p);
    }
    s->sum->count += film->count;
    s->mean += step / ++s->count;
    s->m2 += step * (v - s->mean);
    return LC_OK;
}

static lc_status render_film(lc_film **out, const lc_scene *scene, const lc_estimator *estimator, const lc_render_options *options,
                             lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    lc_status status = lc_film_create(out, desc->width, desc->height, err);
    if (status != LC_OK)
        return status;
    status = lc_render(*out, scene, estimator, options, err);
    if (status != LC_OK) {
        lc_film_free(*out);
        *out = NULL;
    }
    return status;
}

/* The number that the film's samples have. */
static lc_status measure(double *out, const lc_film *film, lc_test_kind kind, const lc_scene *scene, const lc_estimator *estimator,
                         lc_render_options options, lc_error *err)
{
    lc_film *costs;
    if (kind == LC_KIND_VARIANCE) {
        *out = variance_of(film);
        return LC_OK;
    }
    options.costs = 1;
    lc_status status = render_film(&costs, scene, estimator, &options, err);
    if (status != LC_OK)
        return status;
    *out = cost_of(costs, kind) * (kind == LC_KIND_WORK ? variance_of(film) : 1);
    lc_film_free(costs);
    return LC_OK;
}

/* Renders the films up to number `count`. A film with bad samples goes to *bad, which the caller frees. */
static lc_status grow(spread *s, lc_film **bad, const lc_grading *g, const lc_job *job, const lc_scene *scene,
                      const lc_estimator *estimator, int count, lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    const lc_test *test = job->test;
    int pixels = desc->width * desc->height;
    lc_render_options options = {.min_bounces = test->min_bounces < 0 ? 0 : test->min_bounces,
                                 .max_bounces = test->max_bounces < 0 ? g->assignment->bounces : test->max_bounces,
                                 .seed = job->seed,
                                 .arm = lc_session_arm(estimator),
                                 .count = (uint64_t)fmax(4, PATHS / pixels),
                                 .threads = g->options->threads};
    lc_status status = LC_OK;
    while (s->count < count && status == LC_OK && !*bad) {
        lc_film *film;
        double value = 0;
        options.first = (uint64_t)s->count * options.count;
        status = render_film(&film, scene, estimator, &options, err);
        if (status != LC_OK)
            return status;
        if (film->bad) {
            *bad = film;
            return LC_OK;
        }
        status = measure(&value, film, test->kind, scene, estimator, options, err);
        if (status == LC_OK)
            status = add_film(s, film, value, err);
        lc_film_free(film);
    }
    return status;
}

/* 1 when no pixel varies beyond rounding. */
static int is_still(const lc_film *film)
{
    for (size_t i = 0; i < (size_t)film->width * (size_t)film->height; ++i)
        for (int c = 0; c < 3; ++c) {
            const lc_moments *m = &film->pixels[i].c[c];
            if (m->m2 > 1e-24 * m->mean * m->mean * (double)film->pixels[i].n)
                return 0;
        }
    return 1;
}

/* Square of the relative error of a mean of these numbers; taken in steps, for the squares of very small variances are 0. */
static double square_error(const spread *s) { return s->m2 / s->mean / s->mean / ((s->count - 1.0) * s->count); }

/* The interval of the ratio a / b, by the logarithm, at a two-sided level: Student's t with Welch's degrees of freedom. */
static void interval_of(lc_measured *out, const spread *a, const spread *b, lc_test_kind kind, double alpha)
{
    out->expected = b->mean;
    out->samples = a->sum->count;
    int varies = kind == LC_KIND_VARIANCE || kind == LC_KIND_WORK; /* rounding is no variance */
    int none = !(a->mean > 0) || (varies && is_still(a->sum)), none_there = !(b->mean > 0) || (varies && is_still(b->sum));
    if (none || none_there) { /* of none at all nothing is uncertain */
        out->measured = out->low = out->high = !none ? INFINITY : none_there ? 1 : 0;
        return;
    }
    double ea = square_error(a), eb = square_error(b), sum = ea + eb;
    double df = sum * sum / (ea * ea / (a->count - 1) + eb * eb / (b->count - 1));
    double wide = sum > 0 ? lc_t_quantile(0.5 * alpha, df) * sqrt(sum) : 0;
    out->measured = a->mean / b->mean;
    out->low = out->measured * exp(-wide);
    out->high = out->measured * exp(wide);
}

/* -1 shown outside what is asked for, 1 shown inside, 0 neither. */
static int decide(const lc_measured *m, const lc_test *test)
{
    if (m->high < test->least || m->low > test->most)
        return -1;
    return m->low >= test->least && m->high <= test->most;
}

/* ---- the same samples, otherwise --------------------------------------------------------------------------------------- */

static void compare_exactly(lc_row *row, const lc_film *a, const lc_film *b)
{
    row->verdict = LC_ROW_PASS;
    for (size_t i = 0; i < (size_t)a->width * (size_t)a->height; ++i)
        for (int c = 0; c < 3; ++c)
            if (lc_decide_exact(a->pixels[i].c[c].mean - b->pixels[i].c[c].mean, 1e-9 * fabs(b->pixels[i].c[c].mean)) != LC_PASS)
                row->verdict = LC_ROW_FAIL;
}

/* A film without variance is a table of numbers, and says nothing of its error: the reference's noise alone decides. */
static lc_status compare_still(lc_row *row, const lc_film *still, const lc_film *reference, double margin, double alpha,
                               lc_error *err)
{
    size_t count = (size_t)still->width * (size_t)still->height;
    double *rgb = malloc(3 * count * sizeof *rgb);
    if (!rgb)
        return lc_fail(err, LC_FAULT, "out of memory for the means of an image");
    for (size_t i = 0; i < 3 * count; ++i)
        rgb[i] = still->pixels[i / 3].c[i % 3].mean;
    lc_status status = lc_compare_values(row, reference, rgb, margin, alpha, alpha, err);
    free(rgb);
    return status;
}

/* PASS: their mean is the reference's, within the margin. */
static lc_status judge_mean(lc_row *row, const lc_grading *g, const lc_film *mine, const lc_film *reference, double alpha,
                            lc_error *err)
{
    double c = fmax(lc_film_noise(mine), lc_film_noise(reference));
    double margin = fmax(LEAST_MARGIN, g->assignment->margin) * fmax(1, c);
    memset(row, 0, sizeof *row);
    row->margin = margin;
    if (!is_still(mine))
        return lc_compare_films(row, mine, reference, margin, alpha, alpha, err);
    if (!is_still(reference))
        return compare_still(row, mine, reference, margin, alpha, err);
    compare_exactly(row, mine, reference);
    return LC_OK;
}

/* ---- what is said of it ------------------------------------------------------------------------------------------------ */

static void set_times(lc_words *words, const char *name, double value, const char *unit)
{
    if (isfinite(value))
        lc_words_set(words, name, "%.3g%s", value, unit);
    else
        lc_words_set(words, name, "infinitely many%s", unit);
}

/* The image's mean beside the reference's, in the channel that was hardest. */
static void set_mean(lc_words *words, const lc_row *row, const lc_film *mine, const lc_film *reference)
{
    size_t count = (size_t)mine->width * (size_t)mine->height;
    double is = 0, should = 0;
    for (size_t i = 0; i < count; ++i) {
        is += mine->pixels[i].c[row->channel].mean;
        should += reference->pixels[i].c[row->channel].mean;
    }
    if (should > 0)
        lc_words_set(words, "mean", "%.4g%%", 100 * is / should);
    else
        lc_words_set(words, "mean", "%s", is > 0 ? "infinitely many percent" : "100%");
    int has_tile = row->tile_width > 0;
    lc_words_set(words, "tile", "%d x %d pixels at %d,%d", has_tile ? row->tile_width : mine->width,
                 has_tile ? row->tile_height : mine->height, has_tile ? row->tile_x : 0, has_tile ? row->tile_y : 0);
    lc_words_set(words, "margin", "%.3g%%", 100 * row->margin);
}

/* What one look found. */
typedef struct look {
    int ratio; /* as of decide() */
    int dependent;
    lc_row mean;
} look;

/* 1: nothing more to learn. */
static int is_decided(const look *l)
{
    return l->dependent || l->mean.verdict == LC_ROW_FAIL || l->ratio < 0 ||
           (l->ratio > 0 && l->mean.verdict == LC_ROW_PASS);
}

typedef enum finding { WRONG, UNSHOWN, HIGH, LOW, OPEN, RIGHT } finding;

static finding finding_of(const look *l, const lc_measured *m, const lc_test *test)
{
    if (l->mean.verdict == LC_ROW_FAIL)
        return WRONG;
    if (l->ratio < 0)
        return m->measured > test->most ? HIGH : LOW;
    if (l->ratio == 0)
        return OPEN;
    return l->mean.verdict == LC_ROW_PASS ? RIGHT : UNSHOWN;
}

static const char *sentence_of(const look *l, const lc_measured *m, const lc_test *test)
{
    static const char *const ids[][RIGHT + 1] = { /* in the order of lc_test_kind */
        {"variance_wrong", "variance_unshown", "variance_high", "variance_low", "variance_open", "variance_right"},
        {"cost_wrong", "cost_unshown", "rays_high", "rays_low", "rays_open", "rays_right"},
        {"cost_wrong", "cost_unshown", "numbers_high", "numbers_low", "numbers_open", "numbers_right"},
        {"cost_wrong", "cost_unshown", "work_high", "work_low", "work_open", "work_right"},
    };
    return l->dependent ? "dependent" : ids[test->kind - LC_KIND_VARIANCE][finding_of(l, m, test)];
}

static double report(lc_test_result *out, const lc_grading *g, const lc_job *job, const char *scene, const look *l,
                     const spread *mine, const spread *reference)
{
    const lc_measured *m = &out->measured;
    lc_words words = {.count = 0};
    const char *id = sentence_of(l, m, job->test);
    double share = !l->dependent && finding_of(l, m, job->test) == RIGHT;
    lc_words_set(&words, "scene", "%s", scene);
    set_times(&words, "measured", m->measured, " times");
    set_times(&words, "low", m->low, "");
    set_times(&words, "high", m->high, "");
    set_times(&words, "least", job->test->least, "");
    set_times(&words, "most", job->test->most, "");
    set_mean(&words, &l->mean, mine->sum, reference->sum);
    lc_test_settle(out, share);
    lc_test_say(out, g, id, &words);
    return share;
}

/* ---- one scene --------------------------------------------------------------------------------------------------------- */

static lc_status judge_look(look *l, lc_measured *m, const lc_grading *g, const lc_job *job, const spread *mine,
                            const spread *reference, lc_error *err)
{
    double alpha = g->assignment->false_failure / g->rows / LOOKS / DECISIONS;
    interval_of(m, mine, reference, job->test->kind, alpha);
    l->ratio = decide(m, job->test);
    /* A running mean varies little; rounding, which is all that a still film has, may well depend. */
    l->dependent = !is_still(mine->sum) && lc_film_depends(mine->sum, mine->sum->count / (uint64_t)mine->count, alpha);
    return judge_mean(&l->mean, g, mine->sum, reference->sum, alpha, err);
}

/* Look by look. *ended: the test is settled already, by a bad sample or by how the file ended. */
static lc_status walk(look *l, int *ended, spread *mine, spread *reference, lc_grading *g, const lc_job *job,
                      const lc_scene *scene, lc_test_result *out, lc_error *err)
{
    const char *name = lc_scene_description(scene)->name;
    lc_film *bad = NULL;
    lc_status status = LC_OK;
    for (int k = 0; k < LOOKS && status == LC_OK && !is_decided(l); ++k) {
        status = grow(mine, &bad, g, job, scene, g->estimator, films_of_look[k], err);
        *ended = bad != NULL || (status == LC_WRONG && lc_test_ended(out, g, name));
        if (bad)
            lc_test_bad(out, g, name, bad, NULL);
        lc_film_free(bad);
        if (*ended)
            return LC_OK;
        if (status == LC_OK)
            status = grow(reference, &bad, g, job, scene, g->reference, films_of_look[k], err);
        if (status == LC_OK && bad)
            status = lc_fail(err, LC_FAULT, "the reference has bad samples over %s", name);
        if (status == LC_OK)
            status = judge_look(l, &out->measured, g, job, mine, reference, err);
    }
    lc_film_free(bad);
    return status;
}

/* 1 when all points are earned over this scene. */
static lc_status judge_scene(double *share, lc_grading *g, const lc_job *job, const lc_scene *scene, lc_test_result *out,
                             lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    spread mine = {0, 0, 0, NULL}, reference = {0, 0, 0, NULL};
    look found = {0, 0, {.verdict = LC_ROW_UNDECIDED}};
    int ended = 0;
    *share = 0;
    snprintf(out->scene, sizeof out->scene, "%s", desc->name);
    lc_status status = walk(&found, &ended, &mine, &reference, g, job, scene, out, err);
    if (mine.sum)
        out->measured.paths += mine.sum->count * (uint64_t)(desc->width * desc->height);
    if (status == LC_OK && !ended)
        *share = report(out, g, job, desc->name, &found, &mine, &reference);
    lc_film_free(mine.sum);
    lc_film_free(reference.sum);
    return status;
}

lc_status lc_grade_method(lc_grading *g, const lc_job *job, lc_test_result *out, lc_error *err)
{
    double share = 1;
    lc_status status = LC_OK;
    for (int i = 0; i < job->scene_count && share > 0 && status == LC_OK; ++i)
        status = judge_scene(&share, g, job, job->scenes[i], out, err);
    return status;
}
