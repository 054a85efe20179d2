/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/grade_class.h"
#include "io/scene_read.h"
#include "verify/grade/compile.h"
#include "verify/grade/formats.h"
#include "verify/grade/grade.h"
#include "verify/grade/handins.h"
#include "verify/grade/metadata.h"
#include "verify/grade/plugin.h"
#include "verify/grade/seeds.h"
#include "verify/renderers/replicates.h"

typedef struct grade_arguments {
    const char *assignment, *seed, *secret, *only, *report, *student, *format, *out, *metadata;
    int threads, no_jail, teacher, attempt;
    lc_cli_class class;
} grade_arguments;

/* The result so far, where it was asked for. */
static lc_status write_result(const grade_arguments *a, const lc_grade_result *result, lc_error *err)
{
    const lc_format *format = lc_format_find(a->format);
    if (a->out)
        return lc_result_save(a->out, format, result, a->teacher, err);
    return format->write(stdout, result, a->teacher, err);
}

static lc_status show_test(void *user, const lc_grade_result *result, lc_error *err)
{
    const grade_arguments *a = user;
    if (lc_cli_has_terminal())
        fprintf(stderr, "\r\033[K[%d/%d] %s%s", result->done, result->test_count,
                result->done < result->test_count ? result->tests[result->done].title : "",
                result->done == result->test_count ? "\r\033[K" : "");
    return a->out ? write_result(a, result, err) : LC_OK;
}

/* One hand-in of images, and no class of such folders. */
static int is_images(const grade_arguments *a, const char *word)
{
    return a->class.images && lc_cli_is_folder(word) && lc_replicates_are_in(word);
}

static lc_status grade_one(const grade_arguments *a, const lc_assignment *assignment, const char *word, lc_grade_options *options,
                           lc_error *err)
{
    lc_handins handins = {NULL, 0};
    lc_adapter adapter;
    const char *file = word;
    lc_grade_result *result = malloc(sizeof *result);
    lc_status status = result ? LC_OK : lc_fail(err, LC_FAULT, "out of memory for a grading");
    options->on_test = show_test;
    options->user = (void *)a;
    if (status == LC_OK && a->metadata) {
        int64_t submitted = 0;
        char id[32], purpose[64];
        status = lc_metadata_read(&submitted, &options->attempt, id, a->metadata, err);
        options->submitted = (time_t)submitted;
        snprintf(purpose, sizeof purpose, "hand-in %s", id);
        options->seed = lc_seed_for(options->seed, purpose); /* known to nobody before it was handed in, and the same when it is graded again */
    }
    int images = is_images(a, word);
    if (status == LC_OK && !images && lc_cli_is_folder(word)) {
        status = lc_handins_find_one(&handins, word, err);
        file = status == LC_OK ? handins.items[0].path : NULL;
    } else if (status == LC_OK && (images || a->class.adapters)) {
        status = lc_adapter_open(&adapter, word, 600, err);
        options->adapter = &adapter;
    } else if (status == LC_OK && !lc_is_plugin(word)) { /* one of ours, which needs no jail: to try an assignment out */
        status = lc_cli_find_estimator(&options->estimator, word, err);
    }
    if (status == LC_OK && !file)
        lc_grade_refused(result, assignment, handins.items[0].name, options, 0, handins.items[0].why);
    else if (status == LC_OK)
        status = lc_grade_file(result, assignment, file, options, err);
    if (status == LC_OK && a->format)
        status = write_result(a, result, err);
    else if (status == LC_OK)
        lc_grade_text(stdout, result, a->teacher);
    if (status == LC_OK)
        status = lc_grade_status(result);
    lc_handins_release(&handins);
    free(result);
    return status;
}

/* A class's seed is secret, also from the process list. */
static lc_status read_seed(lc_grade_options *options, const grade_arguments *a, int is_class, lc_error *err)
{
    char text[32] = "";
    options->is_secret = is_class || a->secret;
    if (!a->secret)
        return lc_cli_read_seed(&options->seed, a->seed ? a->seed : is_class ? "random" : "1", err);
    if (a->seed)
        return lc_fail(err, LC_BAD_INPUT, "--seed and --secret: one seed is enough");
    FILE *f = fopen(a->secret, "r");
    int is_read = f && fscanf(f, "%31s", text) == 1;
    if (f)
        fclose(f);
    if (!is_read || strspn(text, "0123456789") != strlen(text))
        return lc_fail(err, LC_BAD_INPUT, "--secret %s: expected a file with a whole number", a->secret);
    return lc_cli_read_seed(&options->seed, text, err);
}

static lc_status grade(void *user, const lc_strings *rest, lc_error *err)
{
    grade_arguments *a = user;
    int is_class = !a->metadata && (rest->count > 1 || (lc_cli_is_folder(rest->items[0]) && !is_images(a, rest->items[0])));
    lc_grade_options options;
    a->class.folder = a->out;
    a->class.has_seed = a->seed || a->secret;
    a->class.secret = a->secret;
    a->class.has_attempt = a->attempt > 0;
    if (!a->assignment)
        return lc_fail(err, LC_BAD_INPUT, "-a NAME|FILE.json says which assignment; `lightcheck list assignments` names them");
    if (a->out && !a->format && !is_class)
        return lc_fail(err, LC_BAD_INPUT, "-o: --format says what to write");
    if (a->format && is_class)
        return lc_fail(err, LC_BAD_INPUT, "--format: for one file; of a class all results are written");
    lc_grade_options_init(&options);
    options.threads = a->threads;
    options.is_open = a->no_jail;
    options.is_teacher = a->teacher;
    options.only = a->only;
    options.report = a->report;
    options.student = a->student;
    options.attempt = a->attempt > 0 ? a->attempt : 1;
    options.load = lc_scene_open;
    lc_assignment *assignment = malloc(sizeof *assignment);
    lc_status status = assignment ? lc_assignment_read(assignment, a->assignment, err)
                                  : lc_fail(err, LC_FAULT, "out of memory for a grading");
    if (status == LC_OK)
        status = read_seed(&options, a, is_class || a->metadata, err);
    if (status == LC_OK && !is_class) /* a class tries it in a process of its own */
        status = lc_grade_plan(assignment, &options, err);
    if (status == LC_OK && is_class)
        status = lc_cli_grade_class(&a->class, rest, assignment, &options, err);
    else if (status == LC_OK)
        status = grade_one(a, assignment, rest->items[0], &options, err);
    free(assignment);
    return status;
}

static int run(const lc_command *self, int argc, char **argv)
{
    grade_arguments a = {.class = {.jobs = 1}};
    const lc_option options[] = {
        {'a', "assignment", LC_OPT_STRING, &a.assignment, "NAME|FILE.json", "see `lightcheck list assignments`", 0, 0, NULL},
        {0, "seed", LC_OPT_STRING, &a.seed, "N|random", "draws the scenes; the same file and seed: the same points; default 1, of a class random", 0, 0, NULL},
        {0, "secret", LC_OPT_STRING, &a.secret, "FILE", "with the seed of a class: what students see does not tell the seed of what is withheld", 0, 0, NULL},
        {0, "format", LC_OPT_CHOICE, &a.format, "FORMAT", "json, gradescope, prairielearn, classroom or junit; default: text", 0, 0,
         "json|gradescope|prairielearn|classroom|junit"},
        {'o', "output", LC_OPT_STRING, &a.out, "FILE|DIR", "the file, written after each test; of a class a folder, default grades-NAME", 0, 0, NULL},
        {'j', "jobs", LC_OPT_INT, &a.class.jobs, "N", "of a class: N hand-ins at once; default 1", 1, 1024, NULL},
        {0, "resume", LC_OPT_FLAG, &a.class.resume, NULL, "of a class: goes on in the folder, with its seed; faults of ours are graded again", 0, 0, NULL},
        {0, "roster", LC_OPT_STRING, &a.class.roster, "FILE.csv", "of a class: who is in it; student_id,last_name,first_name,email,file,submitted", 0, 0, NULL},
        {0, "shard", LC_OPT_STRING, &a.class.shard, "I/N", "of a class: every N-th hand-in from the I-th on, 0 <= I < N; with --seed", 0, 0, NULL},
        {0, "solutions", LC_OPT_STRING, &a.class.solutions, "DIR", "of a class: compared with these, too; default estimators/", 0, 0, NULL},
        {0, "images", LC_OPT_FLAG, &a.class.images, NULL, "FOLDER, or a hand-in's folder, with folders SCENE.BOUNCES of images (.exr) is graded by these", 0, 0, NULL},
        {0, "adapters", LC_OPT_FLAG, &a.class.adapters, NULL, "FILE, or an executable `adapter*` in a hand-in's folder, is graded by its images, NOT locked up", 0, 0, NULL},
        {0, "metadata", LC_OPT_STRING, &a.metadata, "FILE.json", "Gradescope's: attempt and moment; a folder is then one hand-in", 0, 0, NULL},
        {0, "only", LC_OPT_STRING, &a.only, "TEST", "only this test, without those that it requires", 0, 0, NULL},
        {0, "report", LC_OPT_STRING, &a.report, "DIR", "writes three pictures a test there; of a class below it, in a folder for each hand-in", 0, 0, NULL},
        {0, "attempt", LC_OPT_INT, &a.attempt, "N", "which attempt it is: hints come after some; default 1, of a class the last, unless it is due later", 1, 1000000, NULL},
        {0, "student", LC_OPT_STRING, &a.student, "ID", "whose file it is", 0, 0, NULL},
        {0, "teacher", LC_OPT_FLAG, &a.teacher, NULL, "shows what is withheld from students", 0, 0, NULL},
        {0, "no-jail", LC_OPT_FLAG, &a.no_jail, NULL, "runs FILE.c in this process: for your own code only", 0, 0, NULL},
        {0, "threads", LC_OPT_INT, &a.threads, "N", "default: one a core; changes only the time", 1, 256, NULL},
        {0, NULL, LC_OPT_FLAG, NULL, NULL, NULL, 0, 0, NULL},
    };
    return lc_command_run(self, options, argc, argv, 1, 1 << 20, "expected a file, or the folder of a class", grade, &a);
}

const lc_command lc_command_grade = {
    "grade",
    "FILE.c|DIR... -a NAME|FILE.json [-j N] [--seed N|random] [options]",
    "grades a student's file, or those of a class, locked up",
    "Exit status: 0 all tests passed, 1 one did not, 2 bad usage or the file is ungradable (it does not compile, which is no\n"
    "0), 4 our own fault: grade again. Of a class: 0 each hand-in has its result, 4 some are faults of ours.\n",
    run,
};
