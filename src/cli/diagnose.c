/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "io/scene_read.h"
#include "verify/report/diagnosis.h"

typedef struct diagnose_arguments {
    const char *hint;
    int seed, threads;
} diagnose_arguments;

static lc_status diagnose(void *user, const lc_strings *rest, lc_error *err)
{
    const diagnose_arguments *a = user;
    lc_diagnose_options options = {(uint64_t)a->seed, a->threads};
    static lc_diagnosis diagnosis;
    const lc_estimator *estimator;
    lc_status status = lc_cli_find_estimator(&estimator, rest->items[0], err);
    if (status == LC_OK)
        status = lc_diagnose(&diagnosis, estimator, &options, lc_scene_open, err);
    if (status != LC_OK)
        return status;
    lc_hint hint = strcmp(a->hint, "none") == 0       ? LC_HINT_NONE
                   : strcmp(a->hint, "category") == 0 ? LC_HINT_CATEGORY
                                                      : LC_HINT_NAME;
    lc_report_diagnosis(stdout, &diagnosis, estimator->name, hint);
    return diagnosis.is_wrong ? LC_WRONG : LC_OK;
}

static int run(const lc_command *self, int argc, char **argv)
{
    diagnose_arguments a = {.hint = "name", .seed = LC_DEFAULT_SEED};
    const lc_option options[] = {
        {0, "hint", LC_OPT_CHOICE, &a.hint, "none|category|name", "how much is told; default name", 0, 0,
         "none|category|name"},
        {0, "seed", LC_OPT_INT, &a.seed, "N", "default 1", 0, 2147483647, NULL},
        {0, "threads", LC_OPT_INT, &a.threads, "N", "default: one a core; changes only the time", 1, 256, NULL},
        {0, NULL, LC_OPT_FLAG, NULL, NULL, NULL, 0, 0, NULL},
    };
    return lc_command_run(self, options, argc, argv, 1, 1, "expected one estimator", diagnose, &a);
}

const lc_command lc_command_diagnose = {
    "diagnose",
    "NAME|FILE.c [--hint none|category|name] [--seed N]",
    "says which known bug an estimator has, or what was measured of it",
    "A bug is named only when the estimator is shown equal to it and different from the truth and from all other known\n"
    "bugs. Exit status: 1 shown wrong, 0 not shown wrong, which is no proof that it is right: `lightcheck verify` is.\n",
    run,
};
