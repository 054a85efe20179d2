/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Chi-square goodness of fit; see stats.h. */
#include <math.h>
#include <stdlib.h>

#include "verify/stats/stats.h"

typedef struct bin {
    double observed, expected;
    size_t index;
} bin;

static int compare_bins(const void *left, const void *right)
{
    const bin *a = left, *b = right;
    if (a->expected != b->expected)
        return a->expected < b->expected ? -1 : 1;
    return a->index < b->index ? -1 : a->index > b->index;
}

/* The statistic of one cell, (observed - expected)^2 / expected. */
static double cell_term(const bin *cell)
{
    double d = cell->observed - cell->expected;
    return d * d / cell->expected;
}

/* A cell is complete only when the next one is: then nothing is left over for a cell of its own. */
static void pool(lc_chi_square *out, const bin *sorted, size_t bins, double least)
{
    bin last = {0, 0, 0}, open = {0, 0, 0};
    for (size_t i = 0; i < bins; ++i) {
        open.observed += sorted[i].observed;
        open.expected += sorted[i].expected;
        if (open.expected < least)
            continue;
        if (out->cells++ > 0)
            out->statistic += cell_term(&last);
        last = open;
        open.observed = open.expected = 0;
    }
    if (out->cells == 0)
        return;
    last.observed += open.observed;
    last.expected += open.expected;
    out->statistic += cell_term(&last);
}

lc_status lc_chi_square_test(lc_chi_square *out, const double *observed, const double *expected, size_t bins,
                             double least, int fitted, lc_error *err)
{
    lc_status status = LC_OK;
    lc_chi_square result = {0, 0, NAN, 0, 0};
    bin *sorted = malloc((bins ? bins : 1) * sizeof *sorted);
    if (!sorted)
        return lc_fail(err, LC_FAULT, "no memory for %zu bins", bins);
    if (!(least > 0)) {
        status = lc_fail(err, LC_BAD_INPUT, "least expected count %g, expected a number above 0", least);
        goto cleanup;
    }
    for (size_t i = 0; i < bins; ++i) {
        if (!(observed[i] >= 0 && observed[i] < INFINITY && expected[i] >= 0 && expected[i] < INFINITY)) {
            status = lc_fail(err, LC_BAD_INPUT, "bin %zu: %g observed, %g expected, expected finite counts >= 0", i,
                             observed[i], expected[i]);
            goto cleanup;
        }
        sorted[i].observed = observed[i];
        sorted[i].expected = expected[i];
        sorted[i].index = i;
        if (expected[i] == 0)
            result.impossible += observed[i];
    }
    qsort(sorted, bins, sizeof *sorted, compare_bins);
    pool(&result, sorted, bins, least);
    result.df = (double)result.cells - 1 - fitted;
    if (result.df < 1) {
        status = lc_fail(err, LC_BAD_INPUT, "%zu cells expect at least %g, expected %d or more", result.cells, least,
                         fitted + 2);
        goto cleanup;
    }
    result.log_p = lc_chi_square_log_sf(result.statistic, result.df);
    *out = result;
cleanup:
    free(sorted);
    return status;
}
