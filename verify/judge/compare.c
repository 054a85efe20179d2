/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Two images from files: one row, one look.
 */
#include <stdio.h>
#include <stdlib.h>

#include "verify/judge/judge_c.h"

static lc_status compare(lc_row *row, const lc_film *a, const lc_film *b, int is_from_files, double margin, double false_fail,
                         double false_pass, lc_error *err)
{
    lc_budget budget = {false_fail, false_pass, 1, 3, 1};
    lc_pyramid_plan plan;
    lc_estimate *field = malloc(sizeof *field * (size_t)a->width * (size_t)a->height);
    if (!field)
        return lc_fail(err, LC_FAULT, "out of memory for the differences");
    lc_pyramid_plan_init(&plan, lc_budget_row_fail(&budget), lc_budget_row_pass(&budget));
    lc_look result;
    lc_comparison comparison = {a, b, NULL, NULL, NULL, margin, 0, is_from_files};
    lc_status status = lc_judge_look(&result, &comparison, field, &plan, err);
    free(field);
    if (status != LC_OK)
        return status;
    snprintf(row->check, sizeof row->check, "compare");
    snprintf(row->scene, sizeof row->scene, "%s", a->scene[0] ? a->scene : "(unknown)");
    snprintf(row->estimator, sizeof row->estimator, "%s", a->estimator[0] ? a->estimator : "(unknown)");
    snprintf(row->source, sizeof row->source, "the second image");
    if (result.scale == 0) {
        row->verdict = LC_ROW_UNDECIDED;
        row->ratio = row->low = row->high = NAN;
        snprintf(row->reason, sizeof row->reason,
                 "both images are exactly black: equal, but without variance nothing is shown");
        return LC_OK;
    }
    row->margin = margin;
    row->samples = a->count;
    row->paths = a->count * (uint64_t)a->width * (uint64_t)a->height;
    lc_row_conclude(row, &result, plan.alpha_pass);
    return LC_OK;
}

lc_status lc_compare_films(lc_row *row, const lc_film *a, const lc_film *b, double margin, double false_fail,
                           double false_pass, lc_error *err)
{
    return compare(row, a, b, 0, margin, false_fail, false_pass, err);
}

lc_status lc_compare_files(lc_row *row, const lc_film *a, const lc_film *b, double margin, double false_fail,
                           double false_pass, lc_error *err)
{
    return compare(row, a, b, 1, margin, false_fail, false_pass, err);
}
