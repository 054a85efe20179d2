/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "verify/grade/compile.h"
#include "verify/grade/grade.h"
#include "verify/grade/plugin.h"

typedef struct grade_arguments {
    const char *assignment, *seed, *only, *report, *student;
    int threads, no_jail, teacher, attempt;
} grade_arguments;

static lc_status load_scene(lc_scene **out, const char *name, lc_error *err)
{
    return lc_cli_load_scene(out, name, NULL, err);
}

static lc_status show_test(void *user, const lc_grade_result *result, lc_error *err)
{
    (void)user;
    (void)err;
    if (lc_cli_has_terminal())
        fprintf(stderr, "\r\033[K[%d/%d] %s%s", result->done, result->test_count,
                result->done < result->test_count ? result->tests[result->done].title : "",
                result->done == result->test_count ? "\r\033[K" : "");
    return LC_OK;
}

static lc_status grade(void *user, const lc_strings *rest, lc_error *err)
{
    const grade_arguments *a = user;
    const char *file = rest->items[0];
    lc_grade_options options;
    if (!a->assignment)
        return lc_fail(err, LC_BAD_INPUT, "-a NAME|FILE.json says which assignment; `lightcheck list assignments` names them");
    lc_grade_options_init(&options);
    options.threads = a->threads;
    options.is_open = a->no_jail;
    options.is_teacher = a->teacher;
    options.only = a->only;
    options.report = a->report;
    options.student = a->student;
    options.attempt = a->attempt;
    options.load = load_scene;
    options.on_test = show_test;
    lc_assignment *assignment = malloc(sizeof *assignment);
    lc_grade_result *result = malloc(sizeof *result);
    lc_status status = assignment && result ? LC_OK : lc_fail(err, LC_FAULT, "out of memory for a grading");
    if (status == LC_OK)
        status = lc_assignment_read(assignment, a->assignment, err);
    if (status == LC_OK)
        status = lc_cli_read_seed(&options.seed, a->seed, err);
    if (status == LC_OK && !lc_is_plugin(file)) /* one of ours, which needs no jail: to try an assignment out */
        status = lc_cli_find_estimator(&options.estimator, file, err);
    if (status == LC_OK)
        status = lc_grade_file(result, assignment, file, &options, err);
    if (status == LC_OK) {
        lc_grade_text(stdout, result, a->teacher);
        status = lc_grade_status(result);
    }
    free(result);
    free(assignment);
    return status;
}

static int run(const lc_command *self, int argc, char **argv)
{
    grade_arguments a = {.seed = "1", .attempt = 1};
    const lc_option options[] = {
        {'a', "assignment", LC_OPT_STRING, &a.assignment, "NAME|FILE.json", "see `lightcheck list assignments`", 0, 0, NULL},
        {0, "seed", LC_OPT_STRING, &a.seed, "N|random", "default 1; draws the scenes; the same file and seed: the same points", 0, 0, NULL},
        {0, "only", LC_OPT_STRING, &a.only, "TEST", "only this test, without those that it requires", 0, 0, NULL},
        {0, "report", LC_OPT_STRING, &a.report, "DIR", "writes three pictures a test there", 0, 0, NULL},
        {0, "attempt", LC_OPT_INT, &a.attempt, "N", "hints come after some attempts; default 1", 1, 1000000, NULL},
        {0, "student", LC_OPT_STRING, &a.student, "ID", "whose file it is", 0, 0, NULL},
        {0, "teacher", LC_OPT_FLAG, &a.teacher, NULL, "shows what is withheld from students", 0, 0, NULL},
        {0, "no-jail", LC_OPT_FLAG, &a.no_jail, NULL, "runs FILE.c in this process: for your own code only", 0, 0, NULL},
        {0, "threads", LC_OPT_INT, &a.threads, "N", "default: one a core; changes only the time", 1, 256, NULL},
        {0, NULL, LC_OPT_FLAG, NULL, NULL, NULL, 0, 0, NULL},
    };
    return lc_command_run(self, options, argc, argv, 1, 1, "expected one file", grade, &a);
}

const lc_command lc_command_grade = {
    "grade",
    "FILE.c -a NAME|FILE.json [--seed N|random] [options]",
    "grades a student's file, locked up",
    "Exit status: 0 all tests passed, 1 one did not, 2 bad usage or the file is ungradable (it does not compile, which is no\n"
    "0), 4 our own fault: grade again.\n",
    run,
};
