/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Our own JSON, and what the formats share.
 */
#include "verify/grade/formats_c.h"

#include <stdlib.h>
#include <string.h>

#include "io/outfile.h"
#include "verify/report/plain.h"

const lc_format lc_formats[] = {
    {"json", lc_result_json},
    {"gradescope", lc_result_gradescope},
    {"prairielearn", lc_result_prairielearn},
    {"classroom", lc_result_classroom},
    {"junit", lc_result_junit},
    {NULL, NULL},
};

const lc_format *lc_format_find(const char *name)
{
    for (const lc_format *f = lc_formats; f->name; ++f)
        if (strcmp(f->name, name) == 0)
            return f;
    return NULL;
}

lc_status lc_result_save(const char *path, const lc_format *format, const lc_grade_result *result, int teacher, lc_error *err)
{
    lc_outfile *file;
    lc_status status = lc_outfile_open(&file, path, err);
    if (status != LC_OK)
        return status;
    status = format->write(lc_outfile_stream(file), result, teacher, err);
    if (status == LC_OK)
        return lc_outfile_commit(file, err);
    lc_outfile_abort(file);
    return status;
}

/* ---- shared ------------------------------------------------------------------------------------------------------ */

void lc_json_set(json_t *object, const char *key, json_t *value, int *ok)
{
    *ok = value && object && json_object_set_new(object, key, value) == 0 && *ok;
}

void lc_json_append(json_t *array, json_t *value, int *ok)
{
    *ok = value && array && json_array_append_new(array, value) == 0 && *ok;
}

json_t *lc_json_seed(uint64_t seed)
{
    char text[32];
    snprintf(text, sizeof text, "%llu", (unsigned long long)seed);
    return json_string(text);
}

lc_status lc_json_dump(FILE *out, json_t *object, int ok, lc_error *err)
{
    if (object && ok) {
        json_dumpf(object, out, JSON_INDENT(2) | JSON_REAL_PRECISION(12));
        fputc('\n', out);
    }
    json_decref(object);
    return object && ok ? LC_OK : lc_fail(err, LC_FAULT, "out of memory for a result");
}

json_t *lc_json_taken(char *text)
{
    json_t *out = text ? lc_json_text(text) : NULL;
    free(text);
    return out;
}

int lc_result_shows(const lc_test_result *test, int teacher) { return teacher || lc_test_is_open(test); }

/* NULL where it was not written to its end. */
static char *close_text(FILE *out, char **text)
{
    int failed = ferror(out);
    if (fclose(out) == 0 && !failed)
        return *text;
    free(*text);
    return NULL;
}

/* A label, a colon and a text, where there is one. */
static void add_line(FILE *out, const char *label, const char *text)
{
    if (!text[0])
        return;
    fputc('\n', out);
    lc_plain(out, label);
    fputs(": ", out);
    lc_plain(out, text);
}

char *lc_result_feedback(const lc_grade_result *r, const lc_test_result *t, int is_public)
{
    int is_open = !is_public || lc_test_is_open(t);
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return NULL;
    if (t->status == LC_TEST_PENDING) {
        lc_plain(out, r->labels[LC_LABEL_PENDING]);
        return close_text(out, &text);
    }
    lc_plain(out, is_open ? t->sentence : t->shown);
    add_line(out, r->labels[LC_LABEL_HINT], t->hint);
    if (is_open) {
        add_line(out, r->labels[LC_LABEL_AGAIN], t->reproduce);
    } else {
        fputc('\n', out);
        lc_plain(out, t->withheld);
    }
    return close_text(out, &text);
}

char *lc_result_summary(const lc_grade_result *r)
{
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return NULL;
    if (r->is_ungradable || r->is_fault) {
        lc_plain(out, r->labels[r->is_fault ? LC_LABEL_FAULT : LC_LABEL_UNGRADABLE]);
        fputs(": ", out);
        lc_plain(out, r->message);
    } else {
        lc_plain(out, r->labels[LC_LABEL_SCORE]);
        if (r->done < r->test_count) {
            fputs(", ", out);
            lc_plain(out, r->labels[LC_LABEL_INCOMPLETE]);
        }
        if (r->late_penalty > 0) {
            fputc('\n', out);
            lc_plain(out, r->labels[LC_LABEL_LATE]);
        }
    }
    fputc('\n', out);
    if (r->warnings[0]) {
        lc_plain(out, r->labels[LC_LABEL_COMPILER]);
        fputs(":\n", out);
        lc_plain_lines(out, r->warnings, "| ");
    }
    lc_plain(out, r->labels[LC_LABEL_SEED]);
    return close_text(out, &text);
}

/* ---- our own ----------------------------------------------------------------------------------------------------- */

static json_t *measured_json(const lc_measured *m, int *ok)
{
    json_t *o = json_object(), *interval = json_array();
    lc_json_set(o, "expected", lc_json_number(m->expected), ok);
    lc_json_set(o, "ratio", lc_json_number(m->measured), ok);
    lc_json_append(interval, lc_json_number(m->low), ok);
    lc_json_append(interval, lc_json_number(m->high), ok);
    lc_json_set(o, "interval", interval, ok);
    lc_json_set(o, "margin", lc_json_number(m->margin), ok);
    lc_json_set(o, "margin_shown", lc_json_number(m->margin_shown), ok);
    lc_json_set(o, "channel", json_string(m->channel == 0 ? "R" : m->channel == 1 ? "G" : "B"), ok);
    lc_json_set(o, "samples_per_pixel", json_integer((json_int_t)m->samples), ok);
    lc_json_set(o, "paths", json_integer((json_int_t)m->paths), ok);
    if (m->worst.width)
        lc_json_set(o, "worst_tile",
                    json_pack("{s:i, s:i, s:i, s:i, s:o}", "x", m->worst.x, "y", m->worst.y, "width", m->worst.width, "height",
                              m->worst.height, "ratio", lc_json_number(m->worst.ratio)),
                    ok);
    if (m->bad_x >= 0 && m->bad_count)
        lc_json_set(o, "bad_samples",
                    json_pack("{s:I, s:i, s:i, s:I}", "count", (json_int_t)m->bad_count, "x", m->bad_x, "y", m->bad_y, "sample",
                              (json_int_t)m->bad_sample),
                    ok);
    return o;
}

static json_t *test_json(const lc_test_result *t, int teacher, int *ok)
{
    json_t *o = json_object();
    lc_json_set(o, "name", lc_json_text(t->name), ok);
    lc_json_set(o, "title", lc_json_text(t->title), ok);
    lc_json_set(o, "check", lc_json_text(t->check), ok);
    lc_json_set(o, "status", json_string(lc_test_status_name(t->status)), ok);
    lc_json_set(o, "code", json_string(lc_jail_code_name(t->code)), ok);
    lc_json_set(o, "visibility", json_string(lc_visibility_name(t->visibility)), ok);
    lc_json_set(o, "points", lc_json_number(t->points), ok);
    lc_json_set(o, "max_points", lc_json_number(t->most_points), ok);
    lc_json_set(o, "because", lc_json_text(t->because), ok);
    lc_json_set(o, "shown", lc_json_text(teacher ? t->sentence : t->shown), ok);
    lc_json_set(o, "hint", lc_json_text(t->hint), ok);
    lc_json_set(o, "withheld", lc_json_text(lc_result_shows(t, teacher) ? "" : t->withheld), ok);
    if (!lc_result_shows(t, teacher))
        return o;
    lc_json_set(o, "scene", lc_json_text(t->scene), ok);
    lc_json_set(o, "seed", lc_json_seed(t->seed), ok);
    lc_json_set(o, "sentence_id", lc_json_text(t->sentence_id), ok);
    lc_json_set(o, "sentence", lc_json_text(t->sentence), ok);
    lc_json_set(o, "reproduce", lc_json_text(t->reproduce), ok);
    lc_json_set(o, "measured", measured_json(&t->measured, ok), ok);
    lc_json_set(o, "seconds", lc_json_number(t->seconds), ok);
    lc_json_set(o, "cpu_seconds", lc_json_number(t->cpu_seconds), ok);
    json_t *pictures = json_array();
    for (int i = 0; i < 3; ++i)
        if (t->pictures[i][0])
            lc_json_append(pictures, lc_json_text(t->pictures[i]), ok);
    lc_json_set(o, "pictures", pictures, ok);
    return o;
}

lc_status lc_result_json(FILE *out, const lc_grade_result *r, int teacher, lc_error *err)
{
    int ok = 1;
    json_t *o = json_object(), *tests = json_array();
    lc_json_set(o, "format", json_string("lightcheck-result"), &ok);
    lc_json_set(o, "version", json_integer(LC_RESULT_VERSION), &ok);
    lc_json_set(o, "program", json_string("lightcheck " LC_VERSION), &ok);
    lc_json_set(o, "assignment", lc_json_text(r->assignment), &ok);
    lc_json_set(o, "title", lc_json_text(r->title), &ok);
    lc_json_set(o, "file", lc_json_text(r->file), &ok);
    lc_json_set(o, "student", lc_json_text(r->student), &ok);
    lc_json_set(o, "estimator", lc_json_text(r->estimator), &ok);
    lc_json_set(o, "seed", lc_json_seed(r->seed), &ok);
    lc_json_set(o, "attempt", json_integer(r->attempt), &ok);
    lc_json_set(o, "jail", lc_json_text(r->jail), &ok);
    lc_json_set(o, "complete", json_boolean(r->is_ungradable || r->done == r->test_count), &ok);
    lc_json_set(o, "ungradable", json_boolean(r->is_ungradable), &ok);
    lc_json_set(o, "fault", json_boolean(r->is_fault), &ok);
    lc_json_set(o, "code", json_string(lc_jail_code_name(r->code)), &ok);
    lc_json_set(o, "message", lc_json_text(r->message), &ok);
    lc_json_set(o, "warnings", lc_json_text(r->warnings), &ok);
    lc_json_set(o, "said", lc_json_text(r->said), &ok);
    lc_json_set(o, "points", lc_json_number(r->points), &ok);
    lc_json_set(o, "max_points", lc_json_number(r->most_points), &ok);
    lc_json_set(o, "late_days", lc_json_number(r->late_days), &ok);
    lc_json_set(o, "late_penalty", lc_json_number(r->late_penalty), &ok);
    lc_json_set(o, "score", r->is_ungradable || r->is_fault ? json_null() : lc_json_number(r->score), &ok);
    lc_json_set(o, "seconds", lc_json_number(r->seconds), &ok);
    lc_json_set(o, "cpu_seconds", lc_json_number(r->cpu_seconds), &ok);
    for (int i = 0; i < r->test_count; ++i)
        lc_json_append(tests, test_json(&r->tests[i], teacher, &ok), &ok);
    lc_json_set(o, "tests", tests, &ok);
    return lc_json_dump(out, o, ok, err);
}
