/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/grade/class.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/hash_file.h"
#include "io/outfile.h"
#include "verify/grade/class_c.h"
#include "verify/grade/formats.h"
#include "verify/grade/pool.h"
#include "verify/renderers/adapter.h"

/* What a process of its own does. */
typedef struct task {
    lc_class *class;
    lc_class_row *row;
} task;

static lc_status no_memory(lc_error *err) { return lc_fail(err, LC_FAULT, "out of memory for a class"); }

lc_status lc_class_path(char path[LC_CLASS_PATH], const lc_class *c, const char *kind, const char *label, const char *suffix,
                        lc_error *err)
{
    int n = label ? snprintf(path, LC_CLASS_PATH, "%s/%s/%s%s", c->options->folder, kind, label, suffix)
                  : snprintf(path, LC_CLASS_PATH, "%s/%s", c->options->folder, kind);
    return n > 0 && n < LC_CLASS_PATH ? LC_OK : lc_fail(err, LC_BAD_INPUT, "%s: the path is too long", c->options->folder);
}

/* ---- one hand-in ------------------------------------------------------------------------------------------------------ */

static lc_status save(const lc_class *c, const lc_class_row *row, const lc_grade_result *result, lc_error *err)
{
    char path[LC_CLASS_PATH];
    lc_status status = lc_class_path(path, c, "results", row->label, ".json", err);
    return status == LC_OK ? lc_result_save(path, lc_format_find("json"), result, 1, err) : status;
}

static lc_status save_feedback(const lc_class *c, const lc_class_row *row, const lc_grade_result *result, lc_error *err)
{
    char path[LC_CLASS_PATH];
    lc_outfile *file;
    lc_status status = lc_class_path(path, c, "feedback", row->label, ".txt", err);
    if (status == LC_OK)
        status = lc_outfile_open(&file, path, err);
    if (status != LC_OK)
        return status;
    lc_grade_text(lc_outfile_stream(file), result, 0);
    return lc_outfile_commit(file, err);
}

static lc_status on_test(void *user, const lc_grade_result *result, lc_error *err)
{
    const task *t = user;
    return save(t->class, t->row, result, err);
}

/* A result of something that was not graded: our fault, or not gradable. */
static lc_status save_other(const lc_class *c, const lc_class_row *row, int is_fault, const char *why, lc_error *err)
{
    lc_grade_options options = c->options->grade;
    lc_grade_result *r = calloc(1, sizeof *r);
    if (!r)
        return no_memory(err);
    options.seed = c->seed;
    options.student = row->student ? row->student->id : NULL;
    lc_grade_refused(r, c->options->assignment, row->handin->path ? row->handin->path : row->handin->name, &options, is_fault, why);
    lc_status status = save(c, row, r, err);
    if (status == LC_OK)
        status = save_feedback(c, row, r, err);
    free(r);
    return status;
}

/* In a process of its own. Any result is fine; only where none can be written the exit status says so. */
static int grade_one(void *user)
{
    task *t = user;
    const lc_class *c = t->class;
    lc_error err = {""};
    lc_grade_options options = c->options->grade;
    lc_grade_result *result = calloc(1, sizeof *result);
    lc_adapter *adapter = calloc(1, sizeof *adapter);
    if (!result || !adapter)
        return LC_FAULT; /* the process ends */
    if (t->row->handin->is_adapter || t->row->handin->is_images) {
        if (lc_adapter_open(adapter, t->row->handin->path, c->options->seconds, &err) != LC_OK)
            return (int)save_other(c, t->row, 0, err.text, &err);
        options.adapter = adapter;
    }
    options.seed = c->seed;
    options.on_test = on_test;
    options.user = t;
    options.student = t->row->student ? t->row->student->id : NULL;
    options.submitted = t->row->submitted;
    options.report_below = t->row->label;
    lc_status status = lc_grade_file(result, c->options->assignment, t->row->handin->path, &options, &err);
    if (status == LC_OK) {
        status = save(c, t->row, result, &err);
        if (status == LC_OK)
            status = save_feedback(c, t->row, result, &err);
    } else {
        status = save_other(c, t->row, 1, err.text, &err);
    }
    free(adapter);
    free(result);
    return (int)status;
}

/* ---- all of them ------------------------------------------------------------------------------------------------------ */

static lc_status report(lc_class *c, lc_class_row *row, lc_error *err)
{
    char line[512];
    lc_status status = lc_class_read_row(row, c, err);
    lc_class_line(line, sizeof line, row);
    ++c->done;
    if (status == LC_OK && c->options->on_handin)
        c->options->on_handin(c->options->user, line, c->done, c->pending);
    return status;
}

static void drop_empty_log(const lc_pool_job *job)
{
    struct stat info;
    if (stat(job->log, &info) == 0 && info.st_size == 0)
        unlink(job->log);
}

static lc_status on_end(lc_pool_job *job, lc_error *err)
{
    char why[256];
    task *t = job->user;
    lc_status status = LC_OK;
    drop_empty_log(job);
    if (job->exit_status != 0) {
        if (job->is_late)
            snprintf(why, sizeof why, "grading was ended after %.0f s of the clock", job->took);
        else if (job->signal)
            snprintf(why, sizeof why, "the grader was ended by signal %d", job->signal);
        else
            snprintf(why, sizeof why, "the grader could not start, or could not write its result");
        status = save_other(t->class, t->row, 1, why, err);
    }
    if (status == LC_OK)
        status = report(t->class, t->row, err);
    return status;
}

static int is_to_do(const lc_class *c, int i)
{
    const lc_class_options *o = c->options;
    return c->rows[i].handin && !c->rows[i].is_graded && i % o->shards == o->shard;
}

static lc_status run(lc_class *c, lc_error *err)
{
    lc_status status = LC_OK;
    int count = 0;
    lc_pool_job *jobs = calloc((size_t)c->count, sizeof *jobs);
    task *tasks = calloc((size_t)c->count, sizeof *tasks);
    char(*logs)[LC_CLASS_PATH] = calloc((size_t)c->count, sizeof *logs);
    if (!jobs || !tasks || !logs)
        status = no_memory(err);
    for (int i = 0; i < c->count; ++i)
        c->pending += is_to_do(c, i);
    for (int i = 0; i < c->count && status == LC_OK; ++i) {
        lc_class_row *row = &c->rows[i];
        if (!is_to_do(c, i))
            continue;
        if (!row->handin->path) {
            status = save_other(c, row, 0, row->handin->why, err);
            if (status == LC_OK)
                status = report(c, row, err);
            continue;
        }
        status = lc_class_path(logs[count], c, "logs", row->label, ".txt", err);
        tasks[count] = (task){c, row};
        jobs[count] = (lc_pool_job){.run = grade_one, .log = logs[count], .seconds = c->options->seconds, .user = &tasks[count]};
        ++count;
    }
    if (status == LC_OK)
        status = lc_pool_run(jobs, count, c->options->at_once, on_end, err);
    free(jobs);
    free(tasks);
    free(logs);
    return status;
}

/* ---- before and after -------------------------------------------------------------------------------------------------- */

static lc_status make_folders(const lc_class *c, lc_error *err)
{
    static const char *const names[] = {"", "results", "feedback", "logs"};
    char path[LC_CLASS_PATH];
    for (int i = 0; i < 4; ++i) {
        lc_status status = lc_class_path(path, c, names[i], NULL, NULL, err);
        if (status != LC_OK)
            return status;
        if (mkdir(path, 0777) != 0 && errno != EEXIST)
            return lc_fail(err, LC_FAULT, "%s: cannot make the folder: %s", path, strerror(errno));
    }
    return LC_OK;
}

/* Apart: it builds scenes, and the process that forks the graders must have no threads. */
static lc_status plan(void *user, lc_error *err)
{
    const lc_class *c = user;
    return lc_grade_plan(c->options->assignment, &c->options->grade, err);
}

static lc_status begin(lc_class *c, lc_error *err)
{
    int found = 0;
    lc_status status = lc_pool_apart(plan, c, err);
    if (status == LC_OK)
        status = lc_class_make_rows(c, err);
    c->assignment_digest = lc_hash_file(LC_HASH, c->options->assignment->path);
    if (status == LC_OK)
        status = make_folders(c, err);
    if (status == LC_OK)
        status = lc_class_read_index(&found, c, err);
    if (status == LC_OK && found && !c->options->resume && c->options->shards == 1)
        return lc_fail(err, LC_BAD_INPUT, "%s holds the results of a class: --resume goes on with it, -o names another folder",
                       c->options->folder);
    if (status == LC_OK)
        status = lc_class_write_index(c, err);
    for (int i = 0; i < c->count && status == LC_OK && found; ++i)
        if (c->rows[i].handin)
            status = lc_class_read_row(&c->rows[i], c, err);
    return status;
}

static void count_rows(lc_class_counts *n, const lc_class *c)
{
    *n = (lc_class_counts){0, 0, 0, 0, 0};
    for (int i = 0; i < c->count; ++i) {
        const lc_class_row *row = &c->rows[i];
        n->left += row->handin && !row->is_graded && !row->is_fault;
        n->faults += row->is_fault;
        n->ungradable += row->is_graded && row->is_ungradable;
        n->nobodys += c->options->roster && !row->student;
        n->missing += !row->handin;
    }
}

lc_status lc_class_grade(const lc_class_options *options, lc_class_counts *counts, lc_error *err)
{
    lc_class c = {.options = options, .seed = options->grade.seed};
    lc_class_counts n;
    lc_status status = begin(&c, err);
    if (status == LC_OK)
        status = run(&c, err);
    count_rows(&n, &c);
    if (status == LC_OK && n.left == 0) {
        status = lc_class_compare(&c, err);
        if (status == LC_OK)
            status = lc_class_write_tables(&c, err);
    }
    if (counts)
        *counts = n;
    free(c.rows);
    return status;
}
