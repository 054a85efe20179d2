/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Three pictures of a test: yours, the reference, and the difference, red where yours is brighter.
 */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "io/png.h"
#include "verify/grade/grading.h"

/* What is expected in a channel of a pixel. */
static double expected_at(const lc_seen *seen, size_t pixel, int channel)
{
    if (seen->expected)
        return seen->expected->rgb[3 * pixel + (size_t)channel];
    if (seen->other)
        return seen->other->pixels[pixel].c[channel].mean;
    return seen->film->pixels[pixel].c[channel].mean - seen->difference->pixels[pixel].c[channel].mean;
}

/* Stops that bring the mean to a quarter. */
static double exposure_of(double (*rgb)[3], size_t pixels)
{
    double sum = 0;
    for (size_t i = 0; i < pixels; ++i)
        sum += rgb[i][0] + rgb[i][1] + rgb[i][2];
    return sum > 0 ? log2(0.25 * 3 * (double)pixels / sum) : 0;
}

static lc_status write_three(char paths[3][1400], const lc_seen *seen, double (*mine)[3], double (*reference)[3],
                             double *difference, lc_error *err)
{
    int width = seen->film->width, height = seen->film->height;
    size_t pixels = (size_t)width * (size_t)height;
    double most = 0;
    for (size_t i = 0; i < pixels; ++i) {
        int is_left_out = seen->expected && seen->expected->skip[i];
        for (int c = 0; c < 3; ++c) {
            mine[i][c] = seen->film->pixels[i].c[c].mean;
            reference[i][c] = is_left_out ? mine[i][c] : expected_at(seen, i, c);
            difference[i] += (mine[i][c] - reference[i][c]) / 3;
        }
        most = fmax(most, fabs(difference[i]));
    }
    double exposure = exposure_of(reference, pixels);
    lc_status status = lc_png_write(paths[0], width, height, (const double(*)[3])mine, exposure, err);
    if (status == LC_OK)
        status = lc_png_write(paths[1], width, height, (const double(*)[3])reference, exposure, err);
    if (status == LC_OK)
        status = lc_png_write_signed(paths[2], width, height, difference, most > 0 ? most : 1, err);
    return status;
}

lc_status lc_grade_pictures(lc_grading *g, const lc_seen *seen, lc_test_result *out, lc_error *err)
{
    static const char *const ends[] = {"yours", "reference", "difference"};
    char paths[3][1400];
    if (!seen->film || (!seen->expected && !seen->other && !seen->difference) ||
        (seen->other && seen->other->count != seen->film->count))
        return LC_OK;
    if (mkdir(g->options->report, 0777) != 0 && errno != EEXIST)
        return lc_fail(err, LC_FAULT, "%s: cannot make the folder: %s", g->options->report, strerror(errno));
    for (int i = 0; i < 3; ++i)
        if (snprintf(paths[i], sizeof paths[i], "%s/%s_%s.png", g->options->report, out->name, ends[i]) >= (int)sizeof paths[i])
            return lc_fail(err, LC_BAD_INPUT, "the path of the report's folder is too long");
    size_t pixels = (size_t)seen->film->width * (size_t)seen->film->height;
    double(*mine)[3] = calloc(pixels, sizeof *mine), (*reference)[3] = calloc(pixels, sizeof *reference);
    double *difference = calloc(pixels, sizeof *difference);
    lc_status status = mine && reference && difference
                           ? write_three(paths, seen, mine, reference, difference, err)
                           : lc_fail(err, LC_FAULT, "out of memory for the pictures");
    free(mine);
    free(reference);
    free(difference);
    for (int i = 0; i < 3 && status == LC_OK; ++i)
        snprintf(out->pictures[i], sizeof out->pictures[i], "%s_%s.png", out->name, ends[i]);
    return status;
}
