/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Two images from files: one row, one look.
 */
#include <stdio.h>
#include <stdlib.h>

#include "verify/judge/judge_c.h"

/* Against `b` or, where that is NULL, against expected values. */
static lc_status compare(lc_row *row, const lc_film *a, const lc_film *b, const lc_expected *expected, int is_from_files, double margin,
                         double false_fail, double false_pass, lc_error *err)
{
    lc_budget budget = {false_fail, false_pass, 1, 3, 1};
    lc_pyramid_plan plan;
    lc_estimate *field = malloc(sizeof *field * (size_t)a->width * (size_t)a->height);
    if (!field)
        return lc_fail(err, LC_FAULT, "out of memory for the differences");
    lc_pyramid_plan_init(&plan, lc_budget_row_fail(&budget), lc_budget_row_pass(&budget));
    lc_look result;
    lc_comparison comparison = {a, b, expected, NULL, NULL, margin, 0, is_from_files};
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
    return compare(row, a, b, NULL, 0, margin, false_fail, false_pass, err);
}

lc_status lc_compare_files(lc_row *row, const lc_film *a, const lc_film *b, double margin, double false_fail,
                           double false_pass, lc_error *err)
{
    return compare(row, a, b, NULL, 1, margin, false_fail, false_pass, err);
}

lc_status lc_compare_values(lc_row *row, const lc_film *a, const double *rgb, double margin, double false_fail,
                            double false_pass, lc_error *err)
{
    lc_expected expected = {a->width, a->height, (double *)rgb, NULL};
    return compare(row, a, NULL, &expected, 0, margin, false_fail, false_pass, err);
}

int lc_film_depends(const lc_film *film, uint64_t size, double alpha)
{
    for (int c = 0; c < 3; ++c) {
        lc_batches batches = lc_batches_of_size(film, c, size);
        if (lc_batches_depend(&batches, alpha / 3))
            return 1;
    }
    return 0;
}
