/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/grade/rehearse.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct rehearsal {
    const lc_assignment *assignment;
    const lc_grade_options *options;
    lc_rehearsal *out;
    void (*on_row)(void *user, const lc_rehearsal_row *row);
    void *user;
    lc_grade_result *result; /* room for one */
} rehearsal;

static lc_status try_one(rehearsal *r, const lc_estimator *estimator, int is_right, lc_error *err)
{
    lc_grade_options options = *r->options;
    lc_rehearsal_row row = {estimator, is_right, 0, "", 0, 0};
    options.estimator = estimator;
    options.is_teacher = 1;
    options.report = NULL;
    options.on_test = NULL;
    options.attempt = 1;
    lc_status status = lc_grade_file(r->result, r->assignment, estimator->name, &options, err);
    if (status != LC_OK)
        return status;
    row.points = r->result->points;
    row.seconds = r->result->seconds;
    for (int i = 0; i < r->result->test_count; ++i) {
        const lc_test_result *t = &r->result->tests[i];
        row.paths += t->measured.paths;
        if (t->status != LC_TEST_PASSED && !row.first[0])
            snprintf(row.first, sizeof row.first, "%s", t->name);
    }
    lc_rehearsal *out = r->out;
    out->solutions += is_right;
    out->mutants += !is_right;
    out->accused += is_right && row.first[0];
    out->survivors += !is_right && !row.first[0];
    out->seconds[!is_right] = fmax(out->seconds[!is_right], row.seconds);
    r->on_row(r->user, &row);
    return LC_OK;
}

static int is_among(char (*names)[64], int count, const char *name)
{
    for (int i = 0; i < count; ++i)
        if (strcmp(names[i], name) == 0)
            return 1;
    return 0;
}

lc_status lc_rehearse(lc_rehearsal *out, const lc_assignment *assignment, const lc_grade_options *options,
                      void (*on_row)(void *user, const lc_rehearsal_row *row), void *user, lc_error *err)
{
    rehearsal r = {assignment, options, out, on_row, user, malloc(sizeof *r.result)};
    lc_assignment *plain = malloc(sizeof *plain);
    const lc_mutant *m;
    lc_status status = r.result && plain ? LC_OK : lc_fail(err, LC_FAULT, "out of memory for a grading");
    memset(out, 0, sizeof *out);
    out->points = lc_assignment_points(assignment);
    out->false_failure = assignment->false_failure;
    if (status == LC_OK) {
        *plain = *assignment;
        plain->hints = LC_HINT_NONE;
        r.assignment = plain;
    }
    for (int i = 0; i < assignment->solution_count && status == LC_OK; ++i)
        status = try_one(&r, lc_right_estimator(assignment->solutions[i]), 1, err);
    for (int i = 0; status == LC_OK && (m = lc_mutant_at(i)) != NULL; ++i)
        if (is_among(plain->mutants, plain->mutant_count, m->of) &&
            !is_among(plain->beyond, plain->beyond_count, m->estimator->name))
            status = try_one(&r, m->estimator, 0, err);
    free(plain);
    free(r.result);
    return status;
}
