/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A run: scenes, claims, rows. Rows are counted before anything is selected, so that a row alone gets the same share of the error budget,
 * and the same verdict, as in the whole run.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "estimators/registry.h"
#include "verify/judge/judge_c.h"

void lc_verify_options_init(lc_verify_options *options)
{
    memset(options, 0, sizeof *options);
    options->suite = &lc_suites[0];
    options->false_fail = options->false_pass = 1e-6;
    options->seed = 1;
    options->program = "build/lightcheck";
}

static int is_registered(const lc_estimator *estimator)
{
    for (const lc_estimator *const *e = lc_estimators; *e; ++e)
        if (*e == estimator)
            return 1;
    return 0;
}

static lc_status plan_pair(lc_claims *claims, int *not_applicable, const lc_scene *scene, const lc_estimator *estimator,
                           lc_error *err)
{
    int before = claims->count;
    for (const lc_check *const *c = lc_checks; *c; ++c) {
        lc_status status = (*c)->plan ? (*c)->plan(*c, claims, scene, estimator, err) : LC_OK;
        if (status != LC_OK)
            return status;
    }
    *not_applicable += claims->count == before;
    return LC_OK;
}

static lc_status plan_scene(lc_claims *claims, int *not_applicable, const lc_verify_options *o, const lc_scene *scene,
                            lc_error *err)
{
    for (const lc_estimator *const *e = lc_estimators; *e; ++e) {
        lc_status status = plan_pair(claims, not_applicable, scene, *e, err);
        if (status != LC_OK)
            return status;
    }
    if (o->estimator && !is_registered(o->estimator))
        return plan_pair(claims, not_applicable, scene, o->estimator, err);
    return LC_OK;
}

static lc_status plan_host(lc_claims *claims, lc_error *err)
{
    lc_status status = LC_OK;
    for (const lc_check *const *c = lc_checks; *c && status == LC_OK; ++c)
        if ((*c)->plan_host)
            status = (*c)->plan_host(*c, claims, err);
    return status;
}

static int is_selected(const lc_verify_options *o, const lc_claim *claim)
{
    if (claim->decide) /* whoever asks about one estimator or one scene does not ask about the host */
        return !o->estimator && !o->scene && (!o->check || strcmp(o->check, claim->check->name) == 0);
    return (!o->estimator || o->estimator == claim->estimator) &&
           (!o->check || strcmp(o->check, claim->check->name) == 0) &&
           (!o->scene || strcmp(o->scene, lc_scene_description(claim->scene)->name) == 0);
}

static lc_status judge_all(lc_report *report, lc_session *session, const lc_claims *claims, lc_error *err)
{
    const lc_verify_options *o = session->options;
    int selected = 0;
    for (int i = 0; i < claims->count; ++i)
        selected += is_selected(o, &claims->items[i]);
    const lc_scene *scene = NULL;
    for (int i = 0; i < claims->count; ++i) {
        if (!is_selected(o, &claims->items[i]))
            continue;
        if (claims->items[i].scene != scene)
            lc_session_clear(session);
        scene = claims->items[i].scene;
        lc_row *row = lc_report_add(report);
        if (!row)
            return lc_fail(err, LC_FAULT, "out of memory for the report");
        lc_status status = lc_judge_claim(row, session, &claims->items[i], err);
        if (status != LC_OK) {
            --report->count;
            return status;
        }
        if (o->on_row)
            o->on_row(o->user, row, report->count, selected);
    }
    report->paths = session->paths;
    return LC_OK;
}

lc_status lc_verify(lc_report *report, const lc_verify_options *options, lc_load_scene_fn *load, lc_error *err)
{
    lc_scene *scenes[64] = {NULL};
    int scene_count = 0;
    lc_claims claims = {NULL, 0};
    lc_session session = {.options = options, .margin = options->margin > 0 ? options->margin : options->suite->margin};
    lc_status status = LC_OK;
    memset(report, 0, sizeof *report);
    report->seed = options->seed;
    report->false_fail = options->false_fail;
    report->false_pass = options->false_pass;
    snprintf(report->suite, sizeof report->suite, "%s", options->suite->name);
    status = plan_host(&claims, err);
    for (int i = 0; lc_suite_scenes[i] && status == LC_OK; ++i) {
        status = load(&scenes[scene_count], lc_suite_scenes[i], err);
        if (status == LC_OK)
            status = plan_scene(&claims, &report->not_applicable, options, scenes[scene_count++], err);
    }
    if (status == LC_OK) {
        session.rows = claims.count;
        lc_budget budget = {options->false_fail, options->false_pass, session.rows, 3, LC_MOST_LOOKS};
        lc_budget_text(report->budget, sizeof report->budget, &budget, 64, 64);
        status = judge_all(report, &session, &claims, err);
    }
    lc_session_clear(&session);
    lc_claims_release(&claims);
    for (int i = 0; i < scene_count; ++i)
        lc_scene_free(scenes[i]);
    return status;
}
