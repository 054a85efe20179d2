/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "io/scene_read.h"
#include "verify/grade/assignment_files.h"
#include "verify/grade/public.h"
#include "verify/grade/rehearse.h"
#include "verify/grade/sentences.h"

typedef struct assignment_arguments {
    const char *seed;
    int threads, is_public;
} assignment_arguments;

static void print_row(void *user, const lc_rehearsal_row *row)
{
    (void)user;
    const char *verdict = row->is_right ? (row->first[0] ? "ACCUSED" : "right") : row->first[0] ? "caught" : "SURVIVES";
    printf("%-9s %-32s %6.4g points, %5.1fM paths, %5.1f s%s%s\n", verdict, row->estimator->name, row->points,
           1e-6 * (double)row->paths, row->seconds, row->first[0] ? ", first lost: " : "", row->first);
    fflush(stdout);
}

static lc_status check(const assignment_arguments *a, const char *name, lc_error *err)
{
    lc_assignment *assignment = malloc(sizeof *assignment);
    lc_grade_options options;
    lc_rehearsal r;
    lc_grade_options_init(&options);
    options.threads = a->threads;
    options.load = lc_scene_open;
    lc_status status = assignment ? lc_assignment_read(assignment, name, err) : lc_fail(err, LC_FAULT, "out of memory for an assignment");
    if (status == LC_OK)
        status = lc_cli_read_seed(&options.seed, a->seed, err);
    if (status == LC_OK)
        status = lc_grade_plan(assignment, &options, err);
    if (status == LC_OK)
        status = lc_rehearse(&r, assignment, &options, print_row, NULL, err);
    if (status == LC_OK) {
        printf("\n%s: %d tests, %.4g points, seed %llu\n", assignment->name, assignment->test_count, r.points,
               (unsigned long long)options.seed);
        printf("right solutions: %d, accused: %d; mutants: %d, survivors: %d\n", r.solutions, r.accused, r.mutants,
               r.survivors);
        for (int i = 0; i < assignment->beyond_count; ++i)
            printf("%s %s", i ? "," : "not asked about:", assignment->beyond[i]);
        printf("%sa right file loses a point by chance in at most %.2g of all gradings\n", assignment->beyond_count ? "\n" : "",
               r.false_failure);
        printf("longest: %.1f s a right one, %.1f s a wrong one, not counting the jail and the compiler\n", r.seconds[0],
               r.seconds[1]);
        status = r.accused || r.survivors || r.solutions == 0 ? LC_WRONG : LC_OK;
    }
    free(assignment);
    return status;
}

/* It is read whole first: what is wrong in it is not for students to find. */
static lc_status print_public(const char *name, lc_error *err)
{
    lc_assignment *assignment = malloc(sizeof *assignment);
    lc_grade_options options;
    lc_grade_options_init(&options);
    options.load = lc_scene_open;
    lc_status status = assignment ? lc_assignment_read(assignment, name, err) : lc_fail(err, LC_FAULT, "out of memory for an assignment");
    if (status == LC_OK)
        status = lc_grade_plan(assignment, &options, err);
    if (status == LC_OK)
        status = lc_assignment_write_public(stdout, assignment->path, err);
    free(assignment);
    return status;
}

static void print_file(void *user, const char *name, const char *path)
{
    (void)user;
    printf("%s\t%s\n", name, path);
}

static lc_status print_files(const assignment_arguments *a, const char *name, lc_error *err)
{
    lc_assignment *assignment = malloc(sizeof *assignment);
    lc_status status = assignment ? lc_assignment_read(assignment, name, err) : lc_fail(err, LC_FAULT, "out of memory for an assignment");
    if (status == LC_OK)
        lc_assignment_files(assignment, a->is_public, print_file, NULL);
    free(assignment);
    return status;
}

static lc_status run_verb(void *user, const lc_strings *rest, lc_error *err)
{
    if (strcmp(rest->items[0], "sentences") == 0 && rest->count == 1) {
        lc_sentences_print(stdout);
        return LC_OK;
    }
    if (strcmp(rest->items[0], "files") == 0 && rest->count == 2)
        return print_files(user, rest->items[1], err);
    if (strcmp(rest->items[0], "check") == 0 && rest->count == 2)
        return check(user, rest->items[1], err);
    if (strcmp(rest->items[0], "public") == 0 && rest->count == 2)
        return print_public(rest->items[1], err);
    return lc_fail(err, LC_BAD_INPUT, "expected `check NAME|FILE.json`, `public NAME|FILE.json`, `files NAME|FILE.json` or `sentences`");
}

static int run(const lc_command *self, int argc, char **argv)
{
    assignment_arguments a = {.seed = "1"};
    const lc_option options[] = {
        {0, "seed", LC_OPT_STRING, &a.seed, "N|random", "default 1", 0, 0, NULL},
        {0, "threads", LC_OPT_INT, &a.threads, "N", "default: one a core; changes only the time", 1, 256, NULL},
        {0, "public", LC_OPT_FLAG, &a.is_public, NULL, "of `files`: only those that students may see", 0, 0, NULL},
        {0, NULL, LC_OPT_FLAG, NULL, NULL, NULL, 0, 0, NULL},
    };
    return lc_command_run(self, options, argc, argv, 1, 2, "expected `check NAME|FILE.json`, `public NAME|FILE.json`, `files NAME|FILE.json` or `sentences`", run_verb, &a);
}

const lc_command lc_command_assignment = {
    "assignment",
    "check NAME|FILE.json [--seed N|random] | public NAME|FILE.json | files NAME|FILE.json [--public] | sentences",
    "tries an assignment out before it is published",
    "`check` grades the right solutions and the mutants that the assignment names: exit status 0 when the former get all\n"
    "points and each of the latter loses some, else 1. `public` prints it without its hidden tests, for students. `files` prints which files it\n"
    "names besides, and where each lies, a tab between. `sentences` prints what `grade` says, to be translated.\n",
    run,
};
