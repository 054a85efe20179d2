/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>

#include "cli/commands.h"
#include "io/exr.h"

static lc_status merge(void *user, const lc_strings *paths, lc_error *err)
{
    const char *out = *(const char **)user;
    if (!out)
        return lc_fail(err, LC_BAD_INPUT, "expected two or more images and -o OUT.exr");
    lc_film *sum = NULL;
    lc_status status = lc_exr_read(&sum, paths->items[0], err);
    for (int i = 1; status == LC_OK && i < paths->count; ++i) {
        lc_film *film = NULL;
        status = lc_exr_read(&film, paths->items[i], err);
        if (status == LC_OK) {
            lc_error why = {""};
            status = lc_film_merge(sum, film, &why);
            if (status != LC_OK)
                lc_fail(err, status, "%s: %s", paths->items[i], why.text);
        }
        lc_film_free(film);
    }
    if (status == LC_OK)
        status = lc_exr_write(out, sum, err);
    if (status == LC_OK)
        printf("%s: %d images merged\n", out, paths->count);
    lc_film_free(sum);
    return status;
}

static int run(const lc_command *self, int argc, char **argv)
{
    const char *out = NULL;
    const lc_option options[] = {
        {'o', "out", LC_OPT_STRING, &out, "OUT.exr", "where the result goes", 0, 0, NULL},
        {0, NULL, LC_OPT_FLAG, NULL, NULL, NULL, 0, 0, NULL},
    };
    return lc_command_run(self, options, argc, argv, 2, 1 << 20, "expected two or more images and -o OUT.exr", merge,
                          &out);
}

const lc_command lc_command_merge = {
    "merge",
    "A.exr B.exr ... -o OUT.exr",
    "puts shards together, or renders of different seeds",
    "Shards of one render are pasted, bit for bit what one run gives. Renders of different seeds are averaged, "
    "weighted by\n"
    "their samples. Images that share samples are refused.\n",
    run,
};
