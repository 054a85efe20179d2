/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * What stands in a class's folder, read and written.
 */
#include <dirent.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "io/outfile.h"
#include "verify/grade/class_c.h"
#include "verify/grade/csv.h"
#include "verify/grade/formats.h"
#include "verify/grade/seeds.h"
#include "verify/grade/similarity.h"
#include "verify/grade/texts.h"
#include "verify/report/safe.h"

static lc_status no_memory(lc_error *err) { return lc_fail(err, LC_FAULT, "out of memory for a class"); }

static const char *text_of(const json_t *o, const char *key)
{
    const char *text = json_string_value(json_object_get(o, key));
    return text ? text : "";
}

static void number_text(char text[32], uint64_t number) { snprintf(text, 32, "%llu", (unsigned long long)number); }

/* ---- one result ------------------------------------------------------------------------------------------------------- */

lc_status lc_class_read_row(lc_class_row *row, const lc_class *c, lc_error *err)
{
    char path[LC_CLASS_PATH], seed[32];
    row->is_graded = row->is_fault = 0;
    lc_status status = lc_class_path(path, c, "results", row->label, ".json", err);
    if (status != LC_OK)
        return status;
    json_t *o = json_load_file(path, 0, NULL);
    number_text(seed, lc_seed_of(c->seed, c->options->grade.is_secret, LC_VISIBLE));
    if (strcmp(text_of(o, "format"), "lightcheck-result") != 0 ||
        json_integer_value(json_object_get(o, "version")) != LC_RESULT_VERSION || strcmp(text_of(o, "seed"), seed) != 0 ||
        !(json_is_true(json_object_get(o, "complete")) || json_is_true(json_object_get(o, "fault")))) {
        json_decref(o);
        return LC_OK;
    }
    row->is_fault = json_is_true(json_object_get(o, "fault"));
    row->is_ungradable = json_is_true(json_object_get(o, "ungradable"));
    row->is_graded = !row->is_fault;
    snprintf(row->code, sizeof row->code, "%s", text_of(o, "code"));
    row->points = json_number_value(json_object_get(o, "points"));
    row->most_points = json_number_value(json_object_get(o, "max_points"));
    row->penalty = json_number_value(json_object_get(o, "late_penalty"));
    row->score = json_number_value(json_object_get(o, "score"));
    row->seconds = json_number_value(json_object_get(o, "seconds"));
    json_decref(o);
    return LC_OK;
}

/* ---- class.json -------------------------------------------------------------------------------------------------------- */

/* The test that was asked for alone; "": all. */
static const char *only_of(const lc_class *c) { return c->options->grade.only ? c->options->grade.only : ""; }

static const char *tests_of(const char *only) { return only[0] ? only : "all tests"; }

lc_status lc_class_write_index(const lc_class *c, lc_error *err)
{
    char path[LC_CLASS_PATH], seed[32], digest[32];
    lc_outfile *file;
    json_t *handins = json_object();
    number_text(seed, c->seed);
    for (int i = 0; i < c->count; ++i) {
        number_text(digest, c->rows[i].digest);
        if (c->rows[i].handin && json_object_set_new(handins, c->rows[i].label, json_string(digest)) != 0)
            json_decref(handins), handins = NULL;
    }
    number_text(digest, c->assignment_digest);
    json_t *o = json_pack("{s:s, s:i, s:s, s:s, s:s, s:s, s:s, s:o}", "format", "lightcheck-class", "version", 1, "program",
                          "lightcheck " LC_VERSION, "assignment", c->options->assignment->name, "assignment_digest", digest, "only",
                          only_of(c), "seed", seed, "handins", handins);
    if (!o)
        return no_memory(err);
    lc_status status = lc_class_path(path, c, "class.json", NULL, NULL, err);
    if (status == LC_OK)
        status = lc_outfile_open(&file, path, err);
    if (status == LC_OK) {
        json_dumpf(o, lc_outfile_stream(file), JSON_INDENT(2));
        fputc('\n', lc_outfile_stream(file));
        status = lc_outfile_commit(file, err);
    }
    json_decref(o);
    return status;
}

/* A result of what the file was before is none. */
static lc_status forget_changed(const lc_class *c, const json_t *handins, lc_error *err)
{
    char path[LC_CLASS_PATH], digest[32];
    for (int i = 0; i < c->count; ++i) {
        number_text(digest, c->rows[i].digest);
        if (!c->rows[i].handin || strcmp(text_of(handins, c->rows[i].label), digest) == 0)
            continue;
        lc_status status = lc_class_path(path, c, "results", c->rows[i].label, ".json", err);
        if (status != LC_OK)
            return status;
        unlink(path);
    }
    return LC_OK;
}

lc_status lc_class_read_index(int *found, lc_class *c, lc_error *err)
{
    char path[LC_CLASS_PATH], digest[32];
    lc_status status = lc_class_path(path, c, "class.json", NULL, NULL, err);
    *found = 0;
    if (status != LC_OK || access(path, F_OK) != 0)
        return status;
    json_t *o = json_load_file(path, 0, NULL);
    number_text(digest, c->assignment_digest);
    *found = 1;
    if (strcmp(text_of(o, "format"), "lightcheck-class") != 0)
        status = lc_fail(err, LC_BAD_INPUT, "%s is not what this program writes: name another folder", path);
    else if (strcmp(text_of(o, "assignment_digest"), digest) != 0 || strcmp(text_of(o, "program"), "lightcheck " LC_VERSION) != 0)
        status = lc_fail(err, LC_BAD_INPUT, "%s: results of another assignment, or by another version: name another folder", path);
    else if (strcmp(text_of(o, "only"), only_of(c)) != 0)
        status = lc_fail(err, LC_BAD_INPUT, "%s: results of %s, not of %s: name another folder", path, tests_of(text_of(o, "only")),
                         tests_of(only_of(c)));
    else if (!c->options->resume && c->options->shards > 1 && strtoull(text_of(o, "seed"), NULL, 10) != c->seed)
        status = lc_fail(err, LC_BAD_INPUT, "%s: shards of another seed, %s", path, text_of(o, "seed"));
    else if (c->options->resume || c->options->shards > 1) {
        c->seed = strtoull(text_of(o, "seed"), NULL, 10);
        status = forget_changed(c, json_object_get(o, "handins"), err);
    }
    json_decref(o);
    return status;
}

void lc_class_read_seed(uint64_t *seed, const char *folder)
{
    char path[LC_CLASS_PATH];
    int n = snprintf(path, sizeof path, "%s/class.json", folder);
    json_t *o = n < LC_CLASS_PATH ? json_load_file(path, 0, NULL) : NULL;
    if (text_of(o, "seed")[0])
        *seed = strtoull(text_of(o, "seed"), NULL, 10);
    json_decref(o);
}

/* ---- similarity ---------------------------------------------------------------------------------------------------------- */

typedef struct known_print {
    char name[64];
    lc_prints prints;
} known_print;

typedef struct prints_list {
    known_print *items;
    int count;
} prints_list;

static lc_status read_solutions(prints_list *out, const char *folder, const lc_prints *template, lc_error *err)
{
    lc_status status = LC_OK;
    DIR *dir = folder ? opendir(folder) : NULL;
    for (struct dirent *e = dir ? readdir(dir) : NULL; e && status == LC_OK; e = readdir(dir)) {
        char path[LC_CLASS_PATH];
        size_t length = strlen(e->d_name);
        if (length < 3 || length > 63 || strcmp(e->d_name + length - 2, ".c") != 0 || strcmp(e->d_name, "registry.c") == 0)
            continue;
        known_print *items = realloc(out->items, ((size_t)out->count + 1) * sizeof *items);
        if (!items) {
            status = no_memory(err);
            break;
        }
        out->items = items;
        known_print *k = &items[out->count];
        snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        snprintf(k->name, sizeof k->name, "%.*s", (int)length - 2, e->d_name);
        status = lc_prints_read(&k->prints, path, template, err);
        out->count += status == LC_OK;
    }
    if (dir)
        closedir(dir);
    return status;
}

static void compare_row(lc_class_row *row, const lc_class *c, int index, const lc_prints *prints, const prints_list *solutions)
{
    for (int i = 0; i < solutions->count; ++i) {
        double share = lc_prints_overlap(&prints[index], &solutions->items[i].prints);
        if (share > row->solution_share || !row->solution[0]) {
            row->solution_share = share;
            strcpy(row->solution, solutions->items[i].name);
        }
    }
    for (int i = 0; i < c->count; ++i) {
        double share = i != index && c->rows[i].handin ? lc_prints_overlap(&prints[index], &prints[i]) : -1;
        if (share > row->classmate_share || (share == 0 && !row->classmate[0])) {
            row->classmate_share = share;
            strcpy(row->classmate, c->rows[i].label);
        }
    }
}

lc_status lc_class_compare(lc_class *c, lc_error *err)
{
    prints_list solutions = {NULL, 0};
    lc_prints template = {NULL, 0}, *prints = calloc((size_t)c->count + 1, sizeof *prints);
    lc_status status = prints ? lc_prints_make_known(&template, (const char *)lc_text_template_c, err) : no_memory(err);
    if (status == LC_OK)
        status = read_solutions(&solutions, c->options->solutions, &template, err);
    for (int i = 0; i < c->count && status == LC_OK; ++i)
        if (c->rows[i].handin && c->rows[i].handin->path && !c->rows[i].handin->is_images)
            status = lc_prints_read(&prints[i], c->rows[i].handin->path, &template, err);
    for (int i = 0; i < c->count && status == LC_OK; ++i)
        if (c->rows[i].handin && !c->rows[i].handin->is_images)
            compare_row(&c->rows[i], c, i, prints, &solutions);
    for (int i = 0; prints && i < c->count; ++i)
        lc_prints_release(&prints[i]);
    for (int i = 0; i < solutions.count; ++i)
        lc_prints_release(&solutions.items[i].prints);
    lc_prints_release(&template);
    free(solutions.items);
    free(prints);
    return status;
}

/* ---- tables --------------------------------------------------------------------------------------------------------------- */

void lc_class_line(char *text, size_t size, const lc_class_row *row)
{
    char score[32] = "-";
    if (row->is_graded && !row->is_ungradable)
        snprintf(score, sizeof score, "%.4g", row->score);
    else if (!row->handin)
        snprintf(score, sizeof score, "0");
    snprintf(text, size, "%-24s %-4s %7s of %-6.4g", row->label, row->handin ? row->code : "none", score, row->most_points);
}

/* nbgrader's columns and its rules: missing work is 0, the score max(0, raw - penalty). What nobody has graded has no score. */
static void write_gradebook(FILE *out, const lc_class *c)
{
    const lc_assignment *a = c->options->assignment;
    char due[32] = "", when[32];
    if (a->due)
        strftime(due, sizeof due, "%Y-%m-%d %H:%M:%S", gmtime(&a->due));
    fputs("assignment,duedate,timestamp,student_id,last_name,first_name,email,raw_score,late_submission_penalty,score,max_score\n", out);
    for (int i = 0; i < c->count; ++i) {
        const lc_class_row *row = &c->rows[i];
        if (c->options->roster && !row->student)
            continue; /* nobody's: in class.csv only */
        const char *const texts[] = {row->id, row->student ? row->student->last_name : "",
                                     row->student ? row->student->first_name : "", row->student ? row->student->email : ""};
        when[0] = 0;
        if (row->handin)
            strftime(when, sizeof when, "%Y-%m-%d %H:%M:%S", gmtime(&row->submitted));
        lc_csv_field(out, a->name);
        fprintf(out, ",%s,%s", due, when);
        for (int k = 0; k < 4; ++k) {
            fputc(',', out);
            lc_csv_field(out, texts[k]);
        }
        if (!row->handin)
            fprintf(out, ",0,0,0,%.10g\n", row->most_points);
        else if (!row->is_graded || row->is_ungradable)
            fprintf(out, ",,,,%.10g\n", row->most_points);
        else
            fprintf(out, ",%.10g,%.10g,%.10g,%.10g\n", row->points, row->penalty, row->score, row->most_points);
    }
}

static void write_class_csv(FILE *out, const lc_class *c)
{
    fputs("handin,student,code,graded,score,max_score,seconds,solution,solution_share,classmate,classmate_share\n", out);
    for (int i = 0; i < c->count; ++i) {
        const lc_class_row *row = &c->rows[i];
        char score[32] = "";
        if (row->is_graded && !row->is_ungradable)
            snprintf(score, sizeof score, "%.10g", row->score);
        lc_csv_field(out, row->label);
        fputc(',', out);
        lc_csv_field(out, row->student ? row->student->pseudonym : "");
        fprintf(out, ",%s,%s,%s,%.10g,%.3f,", row->handin ? row->code : "", !row->handin ? "missing" : row->is_ungradable ? "ungradable" : row->is_fault ? "fault" : "yes",
                row->handin ? score : "0", row->most_points, row->seconds);
        lc_csv_field(out, row->solution);
        fprintf(out, ",%.3f,", row->solution_share);
        lc_csv_field(out, row->classmate);
        fprintf(out, ",%.3f\n", row->classmate_share);
    }
}

static void write_class_text(FILE *out, const lc_class *c)
{
    int graded = 0, missing = 0, ungradable = 0, faults = 0;
    double sum = 0;
    fprintf(out, "%-24s %-4s %7s    %-6s  %-28s %s\n", "hand-in", "code", "score", "", "most similar solution", "most similar hand-in");
    for (int i = 0; i < c->count; ++i) {
        const lc_class_row *row = &c->rows[i];
        char line[512];
        lc_class_line(line, sizeof line, row);
        fprintf(out, "%s", line);
        if (row->handin)
            fprintf(out, "  %3.0f%% %-23s %3.0f%% %s", 100 * row->solution_share, row->solution, 100 * row->classmate_share, row->classmate);
        fputs(row->handin && c->options->roster && !row->student ? "  (nobody of the roster)\n" : "\n", out);
        missing += !row->handin;
        faults += row->is_fault;
        ungradable += row->is_graded && row->is_ungradable;
        graded += row->is_graded && !row->is_ungradable;
        sum += row->is_graded && !row->is_ungradable ? row->score : 0;
    }
    fprintf(out, "\n%d graded, mean score %.3g; %d not gradable, %d missing, %d faults of ours\n", graded, graded ? sum / graded : 0, ungradable,
            missing, faults);
    fputs("similarity: share of the smaller file's fingerprints that stand in the other, whatever was renamed; a place to look, no proof\n", out);
}

lc_status lc_class_write_tables(const lc_class *c, lc_error *err)
{
    static const struct {
        const char *name;
        void (*write)(FILE *out, const lc_class *c);
    } tables[] = {{"gradebook.csv", write_gradebook}, {"class.csv", write_class_csv}, {"class.txt", write_class_text}};
    for (int i = 0; i < 3; ++i) {
        char path[LC_CLASS_PATH];
        lc_outfile *file;
        lc_status status = lc_class_path(path, c, tables[i].name, NULL, NULL, err);
        if (status == LC_OK)
            status = lc_outfile_open(&file, path, err);
        if (status != LC_OK)
            return status;
        tables[i].write(lc_outfile_stream(file), c);
        status = lc_outfile_commit(file, err);
        if (status != LC_OK)
            return status;
    }
    return LC_OK;
}
