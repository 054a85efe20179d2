/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Tests that ask for a method: the variance of one sample, pooled over the image, beside the reference's. Neither is taken to be normal: many
 * films, each with its own variance, show by how much that is uncertain. It needs a finite fourth moment, so that it is asked for
 * over scenes only where a sample's light is bounded.
 */
#include <math.h>
#include <string.h>

#include "verify/grade/grading.h"
#include "verify/stats/tails.h"

enum { LOOKS = 3, PATHS = 1 << 16 };
static const int films_of_look[LOOKS] = {12, 24, 72};

/* Mean and variance of the films' variances. */
typedef struct spread {
    int count;
    double mean, m2;
    uint64_t samples;
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
                                 .arm = lc_session_arm(estimator) ^ lc_arm("variance"),
                                 .count = (uint64_t)fmax(4, PATHS / pixels),
                                 .threads = g->options->threads};
    lc_status status = LC_OK;
    while (s->count < count && status == LC_OK && !*bad) {
        lc_film *film;
        options.first = (uint64_t)s->count * options.count;
        status = lc_film_create(&film, desc->width, desc->height, err);
        if (status != LC_OK)
            return status;
        status = lc_render(film, scene, estimator, &options, err);
        if (status == LC_OK && film->bad) {
            *bad = film;
            return LC_OK;
        }
        double v = variance_of(film), step = v - s->mean;
        s->mean += step / ++s->count;
        s->m2 += step * (v - s->mean);
        s->samples += options.count;
        lc_film_free(film);
    }
    return status;
}

/* The interval of the ratio a / b, by the logarithm, at a two-sided level: Student's t with Welch's degrees of freedom. */
static void interval_of(lc_measured *out, const spread *a, const spread *b, double alpha)
{
    double ea = a->m2 / ((a->count - 1.0) * a->count) / (a->mean * a->mean);
    double eb = b->m2 / ((b->count - 1.0) * b->count) / (b->mean * b->mean);
    double df = (ea + eb) * (ea + eb) / (ea * ea / (a->count - 1) + eb * eb / (b->count - 1));
    double wide = lc_t_quantile(0.5 * alpha, df) * sqrt(ea + eb);
    out->measured = a->mean / b->mean;
    out->low = out->measured * exp(-wide);
    out->high = out->measured * exp(wide);
    out->expected = b->mean;
    out->samples = a->samples;
}

/* -1 shown outside what is asked for, 1 shown inside, 0 neither. */
static int decide(const lc_measured *m, const lc_test *test)
{
    if (m->high < test->least || m->low > test->most)
        return -1;
    return m->low >= test->least && m->high <= test->most;
}

static double report(lc_test_result *out, const lc_grading *g, const lc_job *job, const char *scene, int verdict)
{
    const lc_measured *m = &out->measured;
    lc_words words = {.count = 0};
    lc_words_set(&words, "scene", "%s", scene);
    lc_words_set(&words, "measured", "%.3g times", m->measured);
    lc_words_set(&words, "low", "%.3g", m->low);
    lc_words_set(&words, "high", "%.3g", m->high);
    lc_words_set(&words, "least", "%.3g", job->test->least);
    lc_words_set(&words, "most", "%.3g", job->test->most);
    lc_test_settle(out, verdict > 0 ? 1 : 0);
    lc_test_say(out, g,
                verdict > 0    ? "variance_right"
                : verdict == 0 ? "variance_open"
                : m->measured > job->test->most ? "variance_high"
                                                : "variance_low",
                &words);
    return verdict > 0;
}

/* 1 when all points are earned over this scene. */
static lc_status judge_scene(double *share, lc_grading *g, const lc_job *job, const lc_scene *scene, lc_test_result *out,
                             lc_error *err)
{
    const char *name = lc_scene_description(scene)->name;
    double alpha = g->assignment->false_failure / g->rows / LOOKS;
    spread mine = {0, 0, 0, 0}, reference = {0, 0, 0, 0};
    lc_film *bad = NULL;
    lc_status status = LC_OK;
    int verdict = 0;
    *share = 0;
    snprintf(out->scene, sizeof out->scene, "%s", name);
    for (int k = 0; k < LOOKS && status == LC_OK && verdict == 0; ++k) {
        status = grow(&mine, &bad, g, job, scene, g->estimator, films_of_look[k], err);
        if (status == LC_WRONG && lc_test_ended(out, g, name))
            return LC_OK;
        if (bad) {
            lc_test_bad(out, g, name, bad, NULL);
            lc_film_free(bad);
            return LC_OK;
        }
        if (status == LC_OK)
            status = grow(&reference, &bad, g, job, scene, g->reference, films_of_look[k], err);
        if (status != LC_OK || !(mine.mean > 0)) /* no variance at all: below any bound, and nothing more to learn */
            break;
        interval_of(&out->measured, &mine, &reference, alpha);
        verdict = decide(&out->measured, job->test);
    }
    out->measured.paths += mine.samples * (uint64_t)(lc_scene_description(scene)->width * lc_scene_description(scene)->height);
    if (status == LC_OK)
        *share = report(out, g, job, name, mine.mean > 0 ? verdict : job->test->least > 0 ? -1 : 1);
    return status;
}

lc_status lc_grade_variance(lc_grading *g, const lc_job *job, lc_test_result *out, lc_error *err)
{
    double share = 1;
    lc_status status = LC_OK;
    for (int i = 0; i < job->scene_count && share > 0 && status == LC_OK; ++i)
        status = judge_scene(&share, g, job, job->scenes[i], out, err);
    return status;
}
