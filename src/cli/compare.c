/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "io/exr.h"
#include "verify/judge/judge.h"

/* No mean of samples that are finite and not below 0: it is shown wrong, and no interval of it would say anything. */
static lc_status check_image(const lc_film *film, const char *path, lc_error *err)
{
    for (int i = 0; i < film->width * film->height; ++i)
        for (int c = 0; c < 3; ++c) {
            double mean = film->pixels[i].c[c].mean;
            if (!(mean >= 0 && isfinite(mean)))
                return lc_fail(err, LC_WRONG, "%s: pixel %d,%d has %c = %g, expected a finite value >= 0", path, i % film->width,
                               i / film->width, "RGB"[c], mean);
        }
    return LC_OK;
}

static lc_status read_image(lc_film **out, const char *path, lc_error *err)
{
    lc_status status = lc_exr_read(out, path, err);
    if (status != LC_OK)
        return status;
    const lc_film *film = *out;
    uint64_t known = 0;
    for (size_t i = 0; i < (size_t)film->width * (size_t)film->height; ++i)
        known += film->pixels[i].n > 0;
    if (known == 0) {
        lc_film_free(*out);
        *out = NULL;
        return lc_fail(
            err, LC_BAD_INPUT,
            "%s: no channels `variance.R/G/B` and `samples`: without its own error an image cannot be judged", path);
    }
    status = check_image(film, path, err);
    if (status != LC_OK) {
        lc_film_free(*out);
        *out = NULL;
    }
    return status;
}

static lc_status compare(void *user, const lc_strings *rest, lc_error *err)
{
    const char *path_a = rest->items[0], *path_b = rest->items[1];
    double margin = *(double *)user;
    lc_film *a = NULL, *b = NULL;
    lc_row row;
    memset(&row, 0, sizeof row);
    lc_status status = read_image(&a, path_a, err);
    if (status == LC_OK)
        status = read_image(&b, path_b, err);
    if (status == LC_OK && (a->width != b->width || a->height != b->height))
        status = lc_fail(err, LC_BAD_INPUT, "%s is %d x %d pixels, %s is %d x %d: expected the same size", path_a,
                         a->width, a->height, path_b, b->width, b->height);
    if (status == LC_OK)
        status = lc_compare_files(&row, a, b, margin, 1e-6, 1e-6, err);
    lc_film_free(a);
    lc_film_free(b);
    if (status != LC_OK)
        return status;
    lc_report_text_header(stdout);
    lc_report_text_row(stdout, &row);
    printf("\n");
    if (row.verdict != LC_ROW_PASS)
        printf("%s\n", row.reason);
    return row.verdict == LC_ROW_PASS ? LC_OK : row.verdict == LC_ROW_FAIL ? LC_WRONG : LC_UNDECIDED;
}

static int run(const lc_command *self, int argc, char **argv)
{
    double margin = 0.005;
    const lc_option options[] = {
        {0, "margin", LC_OPT_NUMBER, &margin, "M", "relative to the mean of B; default 0.5%", 0, 10, NULL},
        {0, NULL, LC_OPT_FLAG, NULL, NULL, NULL, 0, 0, NULL},
    };
    return lc_command_run(self, options, argc, argv, 2, 2, "expected two images, A.exr and B.exr", compare, &margin);
}

const lc_command lc_command_compare = {
    "compare",
    "A.exr B.exr [--margin M]",
    "shows whether two renders have the same mean",
    "Both must come with their errors (channels variance.R/G/B and samples, at least 256 a pixel) and from different "
    "streams:\n"
    "other estimators or other seeds. Without skewness.R/G/B, which `render` writes, images of rare bright samples end "
    "undecided.\n"
    "PASS (0): shown equal within the margin; FAIL (1): shown different, at any scale from pixel to "
    "image, at an\n"
    "error probability of 1e-6, or a pixel negative or not finite; UNDECIDED (3): neither.\n",
    run,
};
