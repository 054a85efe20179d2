/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A hand-in in any language: an adapter (verify/renderers/adapter.h) in place of a file. It is graded by what its images show, and runs
 * with all rights of the caller.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "verify/grade/grading.h"

static void say(lc_test_result *t, double share, lc_jail_code code, const char *sentence)
{
    lc_test_settle(t, share);
    if (share < 1)
        t->code = code;
    snprintf(t->sentence, sizeof t->sentence, "%s", sentence);
    snprintf(t->shown, sizeof t->shown, "%s", lc_test_is_open(t) ? sentence : t->status == LC_TEST_PASSED ? "right" : "wrong");
}

/* A test that images cannot answer counts for nothing. */
static void leave_out(const lc_grading *g, lc_test_result *t)
{
    g->result->most_points -= t->most_points;
    t->most_points = 0;
    say(t, 1, LC_JAIL_AC, "left out: images of a renderer cannot tell");
}

static void describe(lc_grading *g, lc_test_result *t)
{
    const lc_assignment *a = g->assignment;
    int is_less = (a->lobes & ~g->estimator->lobes) || (a->emitters & ~g->estimator->emitters) || g->estimator->max_bounces < a->bounces;
    say(t, is_less ? 0 : 1, LC_JAIL_WA,
        is_less ? "its --describe does not name all materials, lights or bounces that are asked for" : "it runs, and claims what is asked for");
}

/* A few samples over each scene; the adapter's reader refuses NaN, infinite and negative ones. */
static lc_status try_it(lc_test_result *t, const lc_adapter *adapter, const lc_job *job, int bounces, lc_error *err)
{
    for (int i = 0; i < job->scene_count; ++i) {
        const lc_scene_desc *d = lc_scene_description(job->scenes[i]);
        lc_adapter_job order = {d, bounces, 4, (uint32_t)(job->seed & 0x3fffffff), 1};
        lc_error why;
        float *rgb = malloc(3 * (size_t)d->width * (size_t)d->height * sizeof *rgb);
        if (!rgb)
            return lc_fail(err, LC_FAULT, "out of memory for an image");
        lc_status status = lc_adapter_render(rgb, adapter, &order, &why);
        free(rgb);
        snprintf(t->scene, sizeof t->scene, "%s", d->name);
        if (status != LC_OK) {
            say(t, 0, LC_JAIL_RTE, why.text);
            return LC_OK;
        }
    }
    say(t, 1, LC_JAIL_AC, "it renders; no pixel is NaN, infinite or negative");
    return LC_OK;
}

static void fill(lc_test_result *t, const lc_row *row)
{
    char text[sizeof t->sentence];
    double margin_shown, share = lc_grade_share(&margin_shown, row);
    uint64_t paths = t->measured.paths + row->paths;
    snprintf(t->scene, sizeof t->scene, "%s", row->scene);
    t->measured = (lc_measured){row->expected, row->ratio, row->low, row->high, row->margin, margin_shown, row->channel, row->samples, paths,
                                {row->tile_x, row->tile_y, row->tile_width, row->tile_height, row->tile_ratio}, -1, -1, 0, 0, {0, 0, 0}};
    if (row->verdict == LC_ROW_FAIL && row->reason[0])
        snprintf(text, sizeof text, "%.600s", row->reason);
    else if (row->exact)
        snprintf(text, sizeof text, "%s: every pixel has the light that is expected", row->scene);
    else
        snprintf(text, sizeof text, "%s: measured %.4g%% of the light that is expected, between %.4g%% and %.4g%%; all points ask for 100%% +- %.3g%%",
                 row->scene, 100 * row->ratio, 100 * row->low, 100 * row->high, 100 * row->margin);
    say(t, share, LC_JAIL_WA, text);
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
            say(t, 0, LC_JAIL_RTE, why.text);
            least = 0;
        } else if (lc_grade_share(&margin_shown, &row) < least) {
            least = lc_grade_share(&margin_shown, &row);
            fill(t, &row);
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
        return try_it(out, g->options->adapter, job, test->max_bounces < 0 ? g->assignment->bounces : test->max_bounces, err);
    case LC_KIND_VARIANCE:
        leave_out(g, out);
        return LC_OK;
    default:
        return judge(g, g->options->adapter, job, out, err);
    }
}
