/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/commands.h"
#include "io/outfile.h"
#include "io/scene_read.h"
#include "verify/grade/jail.h"
#include "verify/grade/plugin.h"
#include "verify/judge/judge.h"
#include "verify/report/diagnosis.h"
#include "verify/report/plain.h"

typedef struct verify_arguments {
    const char *suite, *estimator, *check, *scene, *seed, *format, *report, *renderer, *shard;
    double margin, budget, seconds;
    int threads, measure, jail, no_diagnose;
} verify_arguments;

static void show_row(void *user, const lc_row *row, int done, int count)
{
    (void)user;
    if (lc_cli_has_terminal())
        fprintf(stderr, "\r\033[K[%d/%d] %s %s %s: %s%s", done, count, row->check, row->scene, row->estimator,
                lc_row_verdict_name(row->verdict), done == count ? "\r\033[K" : "");
}

/* Pictures of what fails, as long as they can be written; what stopped them is told when the verdicts are out. */
typedef struct album {
    const char *folder;
    lc_status status;
    lc_error err;
} album;

static void keep_pictures(void *user, lc_row *row, int number, const lc_exhibit *evidence)
{
    album *pictures = user;
    if (pictures->status == LC_OK)
        pictures->status = lc_report_pictures(row, pictures->folder, number, evidence, &pictures->err);
}

static void open_album(album *pictures, lc_verify_options *options, const char *folder)
{
    memset(pictures, 0, sizeof *pictures);
    if (!folder)
        return;
    pictures->folder = folder;
    options->on_fail = keep_pictures;
    options->user = pictures;
    if (mkdir(folder, 0777) != 0 && errno != EEXIST)
        pictures->status =
            lc_fail(&pictures->err, LC_FAULT, "%s: cannot make the folder: %s", folder, strerror(errno));
}

static lc_status check_names(const verify_arguments *a, lc_error *err)
{
    int known = !a->check;
    for (const lc_check *const *c = lc_checks; *c; ++c)
        known |= a->check && strcmp((*c)->name, a->check) == 0;
    if (!known)
        return lc_fail(err, LC_BAD_INPUT, "unknown check '%s'; `lightcheck list checks` names them", a->check);
    known = !a->scene;
    for (const char *const *s = lc_suite_scenes; *s; ++s)
        known |= a->scene && strcmp(*s, a->scene) == 0;
    if (!known)
        return lc_fail(err, LC_BAD_INPUT, "--scene: '%s' is not in the suites", a->scene);
    return LC_OK;
}

/* Writes one format, aside and renamed. */
static lc_status write_format(const char *folder, const char *file, const lc_report *report, const char *format,
                              lc_error *err)
{
    char path[4096];
    lc_outfile *out;
    snprintf(path, sizeof path, "%s/%s", folder, file);
    lc_status status = lc_outfile_open(&out, path, err);
    if (status != LC_OK)
        return status;
    if (strcmp(format, "json") == 0)
        status = lc_report_json(lc_outfile_stream(out), report, err);
    else if (strcmp(format, "junit") == 0)
        lc_report_junit(lc_outfile_stream(out), report);
    else
        lc_report_text(lc_outfile_stream(out), report);
    if (status == LC_OK)
        return lc_outfile_commit(out, err);
    lc_outfile_abort(out);
    return status;
}

static lc_status write_folder(const char *folder, const lc_report *report, lc_error *err)
{
    lc_status status = write_format(folder, "report.txt", report, "text", err);
    if (status == LC_OK)
        status = write_format(folder, "report.json", report, "json", err);
    if (status == LC_OK)
        status = write_format(folder, "report.xml", report, "junit", err);
    return status;
}

static void print_line(void *user, const char *text)
{
    (void)user;
    printf("%s\n", text);
}

/* The estimator under test: a name, a file in the open, or a file in a jail. */
static lc_status open_estimator(lc_verify_options *options, lc_jail **jail, const verify_arguments *a, lc_error *err)
{
    *jail = NULL;
    if (a->jail && (!a->estimator || !lc_is_source(a->estimator)))
        return lc_fail(err, LC_BAD_INPUT, "--jail: -e FILE.c says whom to lock up");
    if (!a->jail)
        return a->estimator ? lc_cli_find_estimator(&options->estimator, a->estimator, err) : LC_OK;
    lc_status status = lc_jail_open(jail, a->estimator, NULL, NULL, err);
    if (status != LC_OK)
        return status;
    lc_plain_lines(stderr, lc_jail_messages(*jail), "");
    options->estimator = lc_jail_estimator(*jail);
    options->is_jailed = 1;
    return LC_OK;
}

/* First to stdout: the verdicts are not lost where the folder cannot be written. */
static lc_status write_report(const lc_report *report, const verify_arguments *a, const album *pictures, lc_error *err)
{
    lc_status status = LC_OK;
    if (strcmp(a->format, "json") == 0)
        status = lc_report_json(stdout, report, err);
    else if (strcmp(a->format, "junit") == 0)
        lc_report_junit(stdout, report);
    else
        lc_report_text(stdout, report);
    if (status == LC_OK && pictures->status != LC_OK)
        status = lc_fail(err, pictures->status, "%s", pictures->err.text);
    return status == LC_OK && a->report ? write_folder(a->report, report, err) : status;
}

/* After a whole suite that shows the one under test wrong: what it behaves like. That costs no more than `lightcheck diagnose`; that it
 * can't be told is no error. */
static lc_status explain(lc_report *report, const lc_verify_options *options, const verify_arguments *a, lc_error *err)
{
    static lc_diagnosis diagnosis;
    lc_diagnose_options how = {options->seed, options->threads};
    lc_error why = {""};
    if (lc_report_status(report) != LC_WRONG || a->no_diagnose || !a->estimator || a->check || a->scene || a->shard)
        return LC_OK;
    if (lc_diagnose(&diagnosis, options->estimator, &how, lc_scene_open, &why) != LC_OK) {
        fprintf(stderr, "lightcheck verify: no diagnosis: %s\n", why.text);
        return LC_OK;
    }
    if (!diagnosis.is_wrong)
        return LC_OK;
    report->behaviour = malloc(sizeof *report->behaviour);
    if (!report->behaviour)
        return lc_fail(err, LC_FAULT, "out of memory for the diagnosis");
    lc_report_behaviour(report->behaviour, &diagnosis, options->estimator->name);
    return LC_OK;
}

static lc_status verify(void *user, const lc_strings *rest, lc_error *err)
{
    const verify_arguments *a = user;
    if (rest->count)
        return lc_fail(err, LC_BAD_INPUT, "unexpected argument '%s'", rest->items[0]);
    lc_verify_options options;
    lc_report report;
    lc_adapter adapter;
    lc_jail *jail = NULL;
    album pictures;
    lc_verify_options_init(&options);
    options.suite = lc_suite_find(a->suite);
    options.margin = a->margin;
    options.false_fail = options.false_pass = a->budget;
    options.threads = a->threads;
    options.given = a->estimator;
    options.check = a->check;
    options.scene = a->scene;
    options.on_row = show_row;
    lc_status status = check_names(a, err);
    if (status == LC_OK)
        status = lc_cli_read_seed(&options.seed, a->seed, err);
    if (status == LC_OK && a->shard)
        status = lc_cli_read_pair(&options.shard, &options.shards, a->shard, '/', "--shard", err);
    if (status == LC_OK && a->shard && options.shard >= options.shards)
        status = lc_fail(err, LC_BAD_INPUT, "--shard %s: expected I/N with 0 <= I < N", a->shard);
    if (status == LC_OK && a->renderer && a->estimator)
        status = lc_fail(err, LC_BAD_INPUT, "--renderer and -e: one or the other is put to the test");
    if (status == LC_OK)
        status = open_estimator(&options, &jail, a, err);
    if (status == LC_OK && a->renderer)
        status = lc_adapter_open(&adapter, a->renderer, a->seconds, err);
    if (status == LC_OK && a->renderer) {
        options.renderer = &adapter;
        options.estimator = &adapter.estimator;
    }
    if (status != LC_OK)
        return status;
    if (a->measure)
        return lc_measure_cells(lc_scene_open, options.estimator, a->scene, print_line, NULL, err);
    open_album(&pictures, &options, a->report);
    status = lc_verify(&report, &options, lc_scene_open, err);
    if (status == LC_OK && report.count == 0 && lc_report_faults(&report) == 0)
        status = report.note_count ? lc_fail(err, LC_BAD_INPUT, "nothing to verify: %s", report.notes[0].reason)
                                   : lc_fail(err, LC_BAD_INPUT, "nothing to verify: no check applies to what was selected");
    if (status == LC_OK)
        status = explain(&report, &options, a, err);
    if (status == LC_OK)
        status = write_report(&report, a, &pictures, err);
    if (status == LC_OK && jail)
        fprintf(stderr, "lightcheck verify: %s ran in a jail: %s\n", a->estimator, lc_jail_level(jail));
    if (status == LC_OK)
        status = lc_report_status(&report);
    lc_report_release(&report);
    lc_jail_close(jail);
    return status;
}

static int run(const lc_command *self, int argc, char **argv)
{
    verify_arguments a = {.suite = "quick", .seed = "1", .format = "text", .budget = 1e-6, .seconds = LC_ADAPTER_SECONDS};
    const lc_option options[] = {
        {0, "suite", LC_OPT_CHOICE, &a.suite, "quick|full|proof",
         "margins 0.5%, 0.25% or (hours) 0.05% times max(1, c); default quick", 0, 0, "quick|full|proof"},
        {'e', "estimator", LC_OPT_STRING, &a.estimator, "NAME|FILE.c",
         "only this estimator, a mutant, or a file of your own", 0, 0, NULL},
        {0, "jail", LC_OPT_FLAG, &a.jail, NULL, "runs FILE.c locked up: for code that you do not trust", 0, 0, NULL},
        {0, "renderer", LC_OPT_STRING, &a.renderer, "ADAPTER|FOLDER",
         "only this program: ADAPTER scene.xml W H SPP SEED BOUNCES OUT.exr; or images: FOLDER/SCENE.BOUNCES/*.exr", 0, 0, NULL},
        {0, "seconds", LC_OPT_NUMBER, &a.seconds, "S", "that one call of ADAPTER may take; default 600", 0.1, 1e6, NULL},
        {'c', "check", LC_OPT_STRING, &a.check, "CHECK", "only this kind (see `lightcheck list checks`)", 0, 0, NULL},
        {0, "scene", LC_OPT_STRING, &a.scene, "SCENE", "only this scene of the suite", 0, 0, NULL},
        {0, "shard", LC_OPT_STRING, &a.shard, "I/N", "only every N-th scene of the suite, from the I-th on (0 <= I < N)", 0,
         0, NULL},
        {0, "margin", LC_OPT_NUMBER, &a.margin, "M", "relative, for estimators with c <= 1; default: the suite's", 0, 1,
         NULL},
        {0, "budget", LC_OPT_NUMBER, &a.budget, "P",
         "probability of any false FAIL, and of any false PASS; default 1e-6", 0, 0.1, NULL},
        {0, "seed", LC_OPT_STRING, &a.seed, "N|random", "default 1; printed, and reproduces the run", 0, 0, NULL},
        {0, "threads", LC_OPT_INT, &a.threads, "N", "default: one a core; changes only the time", 1, 256, NULL},
        {0, "format", LC_OPT_CHOICE, &a.format, "text|json|junit", "default text", 0, 0, "text|json|junit"},
        {0, "measure", LC_OPT_FLAG, &a.measure, NULL, "prints the noise of each cell, as verify/judge/suites.c has it",
         0, 0, NULL},
        {0, "no-diagnose", LC_OPT_FLAG, &a.no_diagnose, NULL, "does not look for the bug of the one that -e names, if it is wrong", 0, 0, NULL},
        {0, "report", LC_OPT_STRING, &a.report, "DIR", "writes all formats there, too, and pictures of what fails", 0, 0, NULL},
        {0, NULL, LC_OPT_FLAG, NULL, NULL, NULL, 0, 0, NULL},
    };
    return lc_command_run(self, options, argc, argv, 0, 1 << 20, NULL, verify, &a);
}

const lc_command lc_command_verify = {
    "verify",
    "[--suite quick|full|proof] [-e NAME|FILE.c] [-c CHECK] [--scene SCENE] [options]",
    "puts estimators to the test",
    "PASS: shown equal to what is expected, within the margin. FAIL: shown different. UNDECIDED: the samples ran out, "
    "which is no\n"
    "pass. Exit status: 0 all PASS, 1 any FAIL, 3 any UNDECIDED. c is a sample's standard deviation over the mean.\n",
    run,
};
