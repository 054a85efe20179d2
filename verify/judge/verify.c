/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A run: scenes, claims, rows. Rows are counted before anything is selected, so that a row alone gets the same share of the error budget,
 * and the same verdict, as in the whole run.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "estimators/registry.h"
#include "verify/checks/family.h"
#include "verify/judge/judge_c.h"
#include "verify/renderers/replicates.h"

void lc_verify_options_init(lc_verify_options *options)
{
    memset(options, 0, sizeof *options);
    options->suite = &lc_suites[0];
    options->false_fail = options->false_pass = 1e-6;
    options->seed = 1;
    options->program = "build/lightcheck";
}

lc_status lc_suite_scene(lc_scene **out, const char *name, uint64_t seed, lc_load_scene_fn *load, lc_error *err)
{
    const lc_family *family = lc_family_find(name);
    lc_scene_desc desc;
    if (!family)
        return load(out, name, err);
    lc_status status = lc_family_describe(&desc, family, seed, err);
    if (status != LC_OK)
        return status;
    status = lc_scene_build(out, &desc, err);
    lc_scene_desc_release(&desc);
    return status;
}

lc_status lc_plan_pair(lc_claims *claims, int *not_applicable, const lc_scene *scene, const lc_estimator *estimator,
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
        lc_status status = lc_plan_pair(claims, not_applicable, scene, *e, err);
        if (status != LC_OK)
            return status;
    }
    if (o->estimator && !lc_is_registered(o->estimator))
        return lc_plan_pair(claims, not_applicable, scene, o->estimator, err);
    return LC_OK;
}

/* Before rows are counted. Of another renderer there are images only: no relation between samples, no decision by checks of their
 * own; one bounce against a closed form is kept, since it has no direct estimator beside it that is held to that. */
static void keep_suite(lc_claims *claims, const lc_suite *suite, const lc_adapter *renderer)
{
    int kept = 0;
    for (int i = 0; i < claims->count; ++i) {
        const lc_claim *c = &claims->items[i];
        int is_foreign = renderer && c->estimator == &renderer->estimator;
        if (is_foreign && (c->term_count || c->decide))
            continue;
        if (lc_suite_has(suite, c) || (is_foreign && c->expect && c->max_bounces == 1))
            claims->items[kept++] = claims->items[i];
    }
    claims->count = kept;
}

lc_status lc_plan_host(lc_claims *claims, lc_error *err)
{
    lc_status status = LC_OK;
    for (const lc_check *const *c = lc_checks; *c && status == LC_OK; ++c)
        if ((*c)->plan_host)
            status = (*c)->plan_host(*c, claims, err);
    return status;
}

/* Why POV-Ray has nothing to say about a scene. */
static lc_status collect_excuse(lc_report *report, const lc_verify_options *o, const lc_scene *scene, lc_error *err)
{
    const char *name = lc_scene_description(scene)->name;
    lc_error why = {""};
    if (o->estimator || (o->check && strcmp(o->check, "povray") != 0) || (o->scene && strcmp(o->scene, name) != 0) ||
        !lc_povray_excuse(&why, scene))
        return LC_OK;
    return lc_report_note(report, "povray", name, 0, why.text, err);
}

static int is_selected(const lc_verify_options *o, const lc_claim *claim)
{
    if (!claim->scene) /* whoever asks about one estimator or one scene does not ask about the host */
        return !o->estimator && !o->scene && (!o->check || strcmp(o->check, claim->check->name) == 0);
    return (!o->estimator || o->estimator == claim->estimator) &&
           (!o->check || strcmp(o->check, claim->check->name) == 0) &&
           (!o->scene || strcmp(o->scene, lc_scene_description(claim->scene)->name) == 0);
}

/* The claims that were asked for, in their order; a shard is every so many scenes. How many rows the whole run has is known already. */
static lc_status judge_selected(lc_report *report, const lc_session *session, const lc_claims *claims, lc_error *err)
{
    const lc_verify_options *o = session->options;
    const lc_claim **selected = calloc((size_t)claims->count + 1, sizeof *selected);
    const lc_scene *scene = NULL;
    int count = 0, nth = 0;
    if (!selected)
        return lc_fail(err, LC_FAULT, "out of memory for the rows");
    for (int i = 0; i < claims->count; ++i) {
        nth += claims->items[i].scene != scene;
        scene = claims->items[i].scene;
        if (is_selected(o, &claims->items[i]) && (o->shards == 0 || nth % o->shards == o->shard))
            selected[count++] = &claims->items[i];
    }
    lc_status status = lc_judge_all(report, session, selected, count, err);
    free(selected);
    return status;
}

lc_status lc_verify(lc_report *report, const lc_verify_options *options, lc_load_scene_fn *load, lc_error *err)
{
    lc_scene **scenes = NULL;
    int scene_count = 0, suite_scenes = 0;
    lc_claims claims = {.count = 0};
    lc_session session = {.options = options, .margin = options->margin > 0 ? options->margin : options->suite->margin};
    lc_status status = LC_OK;
    memset(report, 0, sizeof *report);
    report->seed = options->seed;
    report->false_fail = options->false_fail;
    report->false_pass = options->false_pass;
    snprintf(report->suite, sizeof report->suite, "%s", options->suite->name);
    while (lc_suite_scenes[suite_scenes])
        ++suite_scenes;
    scenes = calloc((size_t)suite_scenes, sizeof *scenes);
    status = scenes ? lc_plan_host(&claims, err) : lc_fail(err, LC_FAULT, "out of memory for the scenes");
    for (int i = 0; i < suite_scenes && status == LC_OK; ++i) {
        if (options->renderer && !lc_replicates_show(options->renderer, lc_suite_scenes[i]))
            continue;
        status = lc_suite_scene(&scenes[scene_count], lc_suite_scenes[i], options->seed, load, err);
        if (status == LC_OK)
            status = plan_scene(&claims, &report->not_applicable, options, scenes[scene_count++], err);
        if (status == LC_OK)
            status = collect_excuse(report, options, scenes[scene_count - 1], err);
    }
    if (status == LC_OK) {
        keep_suite(&claims, options->suite, options->renderer);
        session.rows = claims.count;
        lc_budget budget = {options->false_fail, options->false_pass, session.rows, 3, LC_MOST_LOOKS};
        lc_budget_text(report->budget, sizeof report->budget, &budget, 64, 64);
        status = judge_selected(report, &session, &claims, err);
    }
    lc_claims_release(&claims);
    for (int i = 0; i < scene_count; ++i)
        lc_scene_free(scenes[i]);
    free(scenes);
    return status;
}

/* One line for each cell that a statistical claim needs; other claims of the same cell repeat it. */
static lc_status measure_scene(const lc_claims *claims, lc_session *session, void (*line)(void *user, const char *text),
                               void *user, lc_error *err)
{
    for (int i = 0; i < claims->count; ++i) {
        const lc_claim *claim = &claims->items[i];
        int known = claim->exact || claim->decide || claim->term_count ||
                    (session->options->estimator && session->options->estimator != claim->estimator);
        for (int j = 0; j < i; ++j)
            known |= claims->items[j].estimator == claim->estimator &&
                     claims->items[j].max_bounces == claim->max_bounces && !claims->items[j].exact && !claims->items[j].decide &&
                     !claims->items[j].term_count;
        if (known)
            continue;
        const lc_film *film;
        char text[256];
        lc_status status = lc_session_film(&film, session, claim->scene, claim->estimator, claim->min_bounces,
                                           claim->max_bounces, ~lc_session_arm(claim->estimator), 8 * LC_BLOCK, err);
        if (status != LC_OK)
            return status;
        snprintf(text, sizeof text, "    {\"%s\", \"%s\", %d, %.3g},", lc_scene_description(claim->scene)->name,
                 claim->estimator->name, claim->max_bounces, lc_film_noise(film));
        line(user, text);
    }
    return LC_OK;
}

lc_status lc_measure_cells(lc_load_scene_fn *load, const lc_estimator *estimator, const char *only,
                           void (*line)(void *user, const char *text), void *user, lc_error *err)
{
    lc_verify_options options;
    lc_status status = LC_OK;
    lc_verify_options_init(&options);
    options.estimator = estimator;
    for (int i = 0; lc_suite_scenes[i] && status == LC_OK; ++i) {
        if (only && strcmp(only, lc_suite_scenes[i]) != 0)
            continue;
        if (lc_family_find(lc_suite_scenes[i]))
            continue; /* each of its scenes has another noise: a pilot measures it */
        lc_session session = {.options = &options};
        lc_claims claims = {.count = 0};
        lc_scene *scene = NULL;
        int not_applicable = 0;
        status = load(&scene, lc_suite_scenes[i], err);
        if (status == LC_OK)
            status = plan_scene(&claims, &not_applicable, &options, scene, err);
        if (status == LC_OK)
            status = measure_scene(&claims, &session, line, user, err);
        lc_session_clear(&session);
        lc_claims_release(&claims);
        lc_scene_free(scene);
    }
    return status;
}
