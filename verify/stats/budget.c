/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The error budget of a run and the looks of a row; see pyramid.h. */
#include <math.h>
#include <stdio.h>

#include "verify/stats/pyramid.h"
#include "verify/stats/tails.h"

static int budget_is_valid(const lc_budget *b)
{
    return b->rows >= 1 && b->channels >= 1 && b->looks >= 1 && b->fail > 0 && b->fail < 1 && b->pass > 0 &&
           b->pass < 1;
}

double lc_budget_row_fail(const lc_budget *b)
{
    return budget_is_valid(b) ? b->fail / ((double)b->rows * b->channels * b->looks) : NAN;
}

double lc_budget_row_pass(const lc_budget *b)
{
    return budget_is_valid(b) ? b->pass / ((double)b->rows * b->looks) : NAN;
}

/* Moves on in a buffer that may be too short, as snprintf would. */
static char *rest(char *text, size_t size, int length) { return (size_t)length < size ? text + length : NULL; }

static size_t rest_size(size_t size, int length) { return (size_t)length < size ? size - (size_t)length : 0; }

int lc_budget_text(char *text, size_t size, const lc_budget *b, int width, int height)
{
    double fail = lc_budget_row_fail(b), pass = lc_budget_row_pass(b);
    int levels = lc_pyramid_levels(width, height);
    int length = snprintf(text, size,
                          "false FAIL %.3g a run = %d rows x %d channels x %d looks x %.3g, each over %d levels\n"
                          "false PASS %.3g a run = %d rows x %d looks x %.3g, one-sided z %.2f\n"
                          "exact rows are outside of it: that all samples agree shows nothing of those not drawn; what it excludes is "
                          "under `unseen`\n",
                          b->fail, b->rows, b->channels, b->looks, fail, levels, b->pass, b->rows, b->looks, pass,
                          lc_normal_quantile(pass));
    for (int l = 0; l < levels; ++l) {
        int side = 1 << l;
        double tiles = (double)((width - 1) / side + 1) * ((height - 1) / side + 1), alpha = fail / levels / tiles;
        length += snprintf(rest(text, size, length), rest_size(size, length),
                           "  %5d x %-5d %9.0f tiles x %.3g, two-sided z %.2f\n", side, side, tiles, alpha,
                           lc_normal_quantile(0.5 * alpha));
    }
    return length;
}

lc_looks lc_looks_plan(uint64_t planned, uint64_t most)
{
    static const double share[LC_MOST_LOOKS] = {0.2, 0.4, 0.6, 1, 4};
    most -= most % LC_BLOCK; /* else the last look of a plan that is cut is rounded up beyond it, and not taken */
    double all = fmax((double)(planned < most ? planned : most), LC_LEAST_SAMPLES);
    lc_looks looks = {{0}, 0};
    for (int k = 0; k < LC_MOST_LOOKS; ++k) {
        uint64_t n = (uint64_t)ceil(share[k] * all / LC_BLOCK) * LC_BLOCK;
        if (n < LC_LEAST_SAMPLES)
            n = LC_LEAST_SAMPLES;
        if (looks.count == 0 || (n > looks.samples[looks.count - 1] && n <= most))
            looks.samples[looks.count++] = n;
    }
    return looks;
}

void lc_looks_reserve(lc_looks *looks, uint64_t most)
{
    while (looks->count < LC_MOST_LOOKS && looks->samples[looks->count - 1] <= most / 4) {
        looks->samples[looks->count] = 4 * looks->samples[looks->count - 1];
        ++looks->count;
    }
}

double lc_samples_needed(double c, double margin, double z)
{
    double ratio = c * z / margin;
    return ratio * ratio;
}
