/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>

#include "cli/commands.h"
#include "io/exr.h"

static lc_status merge(const lc_strings *paths, const char *out, lc_error *err)
{
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
    lc_strings rest;
    lc_error err = {""};
    int status = LC_BAD_INPUT;
    lc_args_result read = lc_args_read(self, options, argc, argv, &rest);
    if (read == LC_ARGS_HELP)
        status = LC_OK;
    else if (read == LC_ARGS_OK && (rest.count < 2 || !out))
        status = lc_complain(self, LC_BAD_INPUT, "expected two or more images and -o OUT.exr");
    else if (read == LC_ARGS_OK) {
        status = (int)merge(&rest, out, &err);
        if (status != LC_OK)
            lc_complain(self, (lc_status)status, "%s", err.text);
    }
    lc_strings_release(&rest);
    return status;
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
