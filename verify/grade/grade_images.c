/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A hand-in in any language: an adapter (verify/renderers/adapter.h) in place of a file, or a folder of images (replicates.h). It is graded
 * by what its images show. An adapter runs with all rights of the caller; of images nothing runs.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "verify/checks/family.h"
#include "verify/grade/grading.h"
#include "verify/renderers/replicates.h"

static void say(lc_grading *g, lc_test_result *t, double share, const char *id)
{
    const lc_words none = {.count = 0};
    lc_test_settle(t, share);
    lc_test_say(t, g, id, &none);
}

/* A test that images cannot answer counts for nothing, and there is nothing to hide about it. */
static void leave_out(lc_grading *g, lc_test_result *t)
{
    g->result->most_points -= t->most_points;
    t->most_points = 0;
    say(g, t, 1, "images_left_out");
    snprintf(t->shown, sizeof t->shown, "%s", t->sentence);
}

static int is_about_samples(const lc_claim *c) { return c->term_count || c->decide || c->paired; }

/* It gave no images that can be judged. */
static void say_why(lc_grading *g, lc_test_result *t, const char *scene, const char *why)
{
    lc_words words = {.count = 0};
    lc_test_end(t, g, scene, LC_JAIL_RTE, why);
    lc_words_set(&words, "why", "%s", why);
    if (g->options->adapter->is_folder) /* nothing has run that could have died */
        lc_test_say(t, g, "images_bad", &words);
}

/* 1 where nobody can have rendered images before: the scene is drawn anew, or nobody is told which it is. */
static int is_for_programs(const lc_test *test)
{
    int is_drawn = 0;
    for (int i = 0; i < test->scene_count; ++i)
        is_drawn |= lc_family_find(test->scenes[i]) != NULL;
    return is_drawn || test->visibility != LC_VISIBLE;
}

int lc_images_cannot_tell(const lc_grading *g, const lc_job *job)
{
    const lc_test *test = job->test;
    int about_images = 0;
    if (g->options->adapter->is_folder && (test->kind == LC_KIND_DESCRIPTOR || is_for_programs(test)))
        return 1;
    for (int i = 0; i < job->claims.count; ++i)
        about_images |= !is_about_samples(&job->claims.items[i]);
    return lc_is_of_method(test->kind) || ((test->kind == LC_KIND_CHECK || test->kind == LC_KIND_MEAN) && !about_images);
}

/* Of a folder: a word that it is too few images, where it is. */
static int are_missing(lc_grading *g, lc_test_result *t, const lc_scene_desc *d, int bounces)
{
    const lc_adapter *adapter = g->options->adapter;
    lc_words words = {.count = 0};
    int count = adapter->is_folder ? lc_replicates_count(adapter, d, bounces) : LC_LEAST_IMAGES;
    if (count >= LC_LEAST_IMAGES)
        return 0;
    snprintf(t->scene, sizeof t->scene, "%s", d->name);
    lc_words_set(&words, "folder", "%s.%d", d->name, bounces);
    lc_words_set(&words, "count", "%d", count);
    lc_words_set(&words, "least", "%d", LC_LEAST_IMAGES);
    lc_test_settle(t, 0);
    lc_test_say(t, g, "images_missing", &words);
    return 1;
}

static void describe(lc_grading *g, lc_test_result *t)
{
    const lc_assignment *a = g->assignment;
    int is_less = (a->lobes & ~g->estimator->lobes) || (a->emitters & ~g->estimator->emitters) || g->estimator->max_bounces < a->bounces;
    say(g, t, is_less ? 0 : 1, is_less ? "images_claim_less" : "images_claimed");
}

/* All images of each scene: they are there already. */
static lc_status look_at_all(lc_grading *g, lc_test_result *t, const lc_job *job, int bounces, lc_error *err)
{
    for (int i = 0; i < job->scene_count; ++i) {
        const lc_scene_desc *d = lc_scene_description(job->scenes[i]);
        lc_error why = {""};
        if (are_missing(g, t, d, bounces))
            return LC_OK;
        float *rgb = malloc(3 * (size_t)d->width * (size_t)d->height * sizeof *rgb);
        if (!rgb)
            return lc_fail(err, LC_FAULT, "out of memory for an image");
        snprintf(t->scene, sizeof t->scene, "%s", d->name);
        int count = lc_replicates_count(g->options->adapter, d, bounces);
        lc_status status = lc_replicates_differ(g->options->adapter, d, bounces, &why);
        for (int k = 0; k < count && status == LC_OK; ++k) {
            lc_adapter_job order = {d, bounces, 1, (uint32_t)k, 1};
            status = lc_adapter_render(rgb, g->options->adapter, &order, &why);
        }
        free(rgb);
        if (status != LC_OK) {
            say_why(g, t, d->name, why.text);
            return LC_OK;
        }
    }
    say(g, t, 1, "images_finite");
    return LC_OK;
}

/* A few samples over each scene; the adapter's reader refuses NaN, infinite and negative ones. */
static lc_status try_it(lc_grading *g, lc_test_result *t, const lc_job *job, int bounces, lc_error *err)
{
    for (int i = 0; i < job->scene_count; ++i) {
        const lc_scene_desc *d = lc_scene_description(job->scenes[i]);
        lc_adapter_job order = {d, bounces, 4, (uint32_t)(job->seed & 0x3fffffff), 1};
        lc_error why;
        float *rgb = malloc(3 * (size_t)d->width * (size_t)d->height * sizeof *rgb);
        if (!rgb)
            return lc_fail(err, LC_FAULT, "out of memory for an image");
        lc_status status = lc_adapter_render(rgb, g->options->adapter, &order, &why);
        free(rgb);
        snprintf(t->scene, sizeof t->scene, "%s", d->name);
        if (status != LC_OK) {
            lc_test_end(t, g, d->name, LC_JAIL_RTE, why.text);
            return LC_OK;
        }
    }
    say(g, t, 1, "images_finite");
    return LC_OK;
}

/* The worst of its claims is the test's result. */
static lc_status judge(lc_grading *g, const lc_adapter *adapter, const lc_job *job, lc_test_result *t, lc_error *err)
{
    lc_verify_options options;
    lc_session *session;
    double least = 2, margin_shown;
    lc_grading_options(&options, g, job);
    options.renderer = adapter;
    lc_status status = lc_session_open(&session, &options, g->rows, err);
    for (int i = 0; status == LC_OK && i < job->claims.count && least > 0; ++i) {
        lc_row row;
        lc_error why;
        memset(&row, 0, sizeof row);
        const lc_claim *claim = &job->claims.items[i];
        if (is_about_samples(claim))
            continue;
        if (are_missing(g, t, lc_scene_description(claim->scene), claim->max_bounces))
            break;
        lc_status judged = lc_judge_claim(&row, session, claim, &why);
        if (judged != LC_OK) {
            say_why(g, t, lc_scene_description(claim->scene)->name, why.text);
            least = 0;
        } else if (lc_grade_share(&margin_shown, &row) < least) {
            t->measured.paths += row.paths;
            least = lc_test_row(t, g, claim, &row, NULL);
        }
    }
    lc_session_close(session);
    return status;
}

lc_status lc_grade_images(lc_grading *g, const lc_job *job, lc_test_result *out, lc_error *err)
{
    const lc_test *test = job->test;
    int is_folder = g->options->adapter->is_folder, bounces = test->max_bounces < 0 ? g->assignment->bounces : test->max_bounces;
    if (lc_images_cannot_tell(g, job)) {
        leave_out(g, out);
        return LC_OK;
    }
    switch (test->kind) {
    case LC_KIND_DESCRIPTOR:
        describe(g, out);
        return LC_OK;
    case LC_KIND_FINITE:
        return is_folder ? look_at_all(g, out, job, bounces, err) : try_it(g, out, job, bounces, err);
    default:
        return judge(g, g->options->adapter, job, out, err);
    }
}
