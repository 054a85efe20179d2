/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A hand-in in any language: an adapter (verify/renderers/adapter.h) in place of a file. It is graded by what its images show, and runs
 * with all rights of the caller.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "verify/grade/grading.h"

static void say(lc_grading *g, lc_test_result *t, double share, const char *id)
{
    const lc_words none = {.count = 0};
    lc_test_settle(t, share);
    lc_test_say(t, g, id, &none);
}

/* A test that images cannot answer counts for nothing. */
static void leave_out(lc_grading *g, lc_test_result *t)
{
    g->result->most_points -= t->most_points;
    t->most_points = 0;
    say(g, t, 1, "images_left_out");
}

static void describe(lc_grading *g, lc_test_result *t)
{
    const lc_assignment *a = g->assignment;
    int is_less = (a->lobes & ~g->estimator->lobes) || (a->emitters & ~g->estimator->emitters) || g->estimator->max_bounces < a->bounces;
    say(g, t, is_less ? 0 : 1, is_less ? "images_claim_less" : "images_claimed");
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
        if (claim->term_count || claim->decide || claim->paired) /* about single samples */
            continue;
        lc_status judged = lc_judge_claim(&row, session, claim, &why);
        if (judged != LC_OK) {
            lc_test_end(t, g, lc_scene_description(claim->scene)->name, LC_JAIL_RTE, why.text);
            least = 0;
        } else if (lc_grade_share(&margin_shown, &row) < least) {
            t->measured.paths += row.paths;
            least = lc_test_row(t, g, claim, &row, NULL);
        }
    }
    if (status == LC_OK && least > 1)
        leave_out(g, t);
    lc_session_close(session);
    return status;
}

lc_status lc_grade_images(lc_grading *g, const lc_job *job, lc_test_result *out, lc_error *err)
{
    const lc_test *test = job->test;
    switch (test->kind) {
    case LC_KIND_DESCRIPTOR:
        describe(g, out);
        return LC_OK;
    case LC_KIND_FINITE:
        return try_it(g, out, job, test->max_bounces < 0 ? g->assignment->bounces : test->max_bounces, err);
    case LC_KIND_VARIANCE:
        leave_out(g, out);
        return LC_OK;
    default:
        return judge(g, g->options->adapter, job, out, err);
    }
}
