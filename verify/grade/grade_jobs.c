/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * What is claimed of a file: always what would be claimed of the reference, whatever the file says of itself.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "verify/grade/assignment_files.h"
#include "verify/grade/grading.h"

uint64_t lc_grading_seed(const lc_grade_options *options, lc_visibility visibility)
{
    return lc_seed_of(options->seed, options->is_secret, visibility);
}

char *lc_grading_file(char *out, const lc_grading *g)
{
    char path[1024];
    const char *slash = g->options->is_secret ? strrchr(g->path, '/') : NULL;
    snprintf(path, sizeof path, "%s", slash && slash[1] ? slash + 1 : g->path);
    return lc_shell_word(out, path);
}

static const lc_check *check_of(const char *name)
{
    for (const lc_check *const *c = lc_checks; *c; ++c)
        if (strcmp((*c)->name, name) == 0)
            return *c;
    return NULL;
}

/* Drops the claims that the test does not ask about, and puts the file in the reference's place. */
static void choose(lc_job *job, int first, const lc_grading *g)
{
    lc_claims *claims = &job->claims;
    const lc_test *test = job->test;
    int kept = first;
    for (int i = first; i < claims->count; ++i) {
        lc_claim *c = &claims->items[i];
        int is_asked = !c->decide && (test->max_bounces < 0 || (c->min_bounces == test->min_bounces &&
                                                                c->max_bounces == test->max_bounces)) &&
                       (!test->relation[0] || (c->relation && strcmp(c->relation, test->relation) == 0));
        if (!is_asked)
            continue;
        c->estimator = g->estimator;
        if (!c->relation)
            c->slack = fmin(c->slack, 1); /* the assignment's margin is wide enough for all */
        claims->items[kept++] = *c;
    }
    claims->count = kept;
}

static lc_status claim_mean(lc_job *job, const lc_scene *scene, const lc_grading *g, lc_error *err)
{
    const lc_test *test = job->test;
    lc_claim *claim = lc_claims_add(&job->claims, check_of("equality"), scene, g->estimator);
    if (!claim)
        return lc_fail(err, LC_FAULT, "out of memory for the claims");
    claim->min_bounces = test->min_bounces < 0 ? 0 : test->min_bounces;
    claim->max_bounces = test->max_bounces < 0 ? g->assignment->bounces : test->max_bounces;
    claim->other = g->reference;
    claim->source = "the reference of the assignment";
    return LC_OK;
}

/* "FILE:LINE: test NAME: " and the message: where the scene stands in the assignment. */
static lc_status fail_there(const lc_grading *g, const lc_test *test, int scene, const char *message, lc_error *err)
{
    return lc_fail(err, LC_BAD_INPUT, "%s:%d: test %s: %s", g->assignment->path, test->scene_lines[scene], test->name, message);
}

static lc_status plan_scene(lc_job *job, int which, const lc_grading *g, lc_error *err)
{
    const lc_test *test = job->test;
    const char *name = test->scenes[which];
    char path[LC_PATH_SIZE], text[400] = "";
    lc_scene *scene;
    lc_error why = {""};
    int before = job->claims.count;
    lc_status status = lc_suite_scene(&scene, lc_assignment_scene(path, g->assignment, name), job->seed, g->options->load, &why);
    if (status != LC_OK)
        return status == LC_BAD_INPUT ? fail_there(g, test, which, why.text, err) : lc_fail(err, status, "%s", why.text);
    job->scenes[job->scene_count++] = scene;
    if (test->kind == LC_KIND_MEAN)
        return claim_mean(job, scene, g, err);
    if (test->kind != LC_KIND_CHECK)
        return LC_OK;
    const lc_check *check = check_of(test->check);
    status = check->plan(check, &job->claims, scene, g->reference, err);
    choose(job, before, g);
    if (job->claims.count == before)
        snprintf(text, sizeof text, "the check %s says nothing about %s over %s%s", test->check, g->reference->name, name,
                 test->relation[0] || test->max_bounces >= 0 ? " with this relation and these bounces" : "");
    for (int i = before; i < job->claims.count && status == LC_OK; ++i)
        if (job->claims.items[i].max_bounces > g->assignment->bounces)
            snprintf(text, sizeof text, "over %s the check %s asks for %d bounces, the assignment for %d only", name, test->check,
                     job->claims.items[i].max_bounces, g->assignment->bounces);
    return status == LC_OK && text[0] ? fail_there(g, test, which, text, err) : status;
}

lc_status lc_grading_plan(lc_grading *g, lc_error *err)
{
    lc_status status = LC_OK;
    for (int i = 0; i < g->assignment->test_count && status == LC_OK; ++i) {
        lc_job *job = &g->jobs[i];
        job->test = &g->assignment->tests[i];
        job->seed = lc_test_seed(lc_grading_seed(g->options, job->test->visibility), job->test->name);
        for (int s = 0; s < job->test->scene_count && status == LC_OK; ++s)
            status = plan_scene(job, s, g, err);
        g->rows += lc_is_of_method(job->test->kind) ? job->scene_count : job->claims.count;
    }
    return status;
}

void lc_grading_release(lc_grading *g)
{
    for (int i = 0; i < LC_MOST_TESTS; ++i) {
        lc_claims_release(&g->jobs[i].claims);
        for (int s = 0; s < g->jobs[i].scene_count; ++s)
            lc_scene_free(g->jobs[i].scenes[s]);
    }
    lc_sentences_close(g->sentences);
    lc_jail_close(g->jail);
}

void lc_grading_options(lc_verify_options *out, const lc_grading *g, const lc_job *job)
{
    lc_verify_options_init(out);
    out->margin = g->assignment->margin;
    out->false_fail = out->false_pass = g->assignment->false_failure;
    out->seed = job->seed;
    out->threads = g->options->threads;
    out->estimator = g->estimator;
}
