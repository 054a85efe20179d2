/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Who is in a class, and what each has handed in.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/hash_file.h"
#include "verify/grade/class_c.h"
#include "verify/renderers/replicates.h"
#include "verify/report/plain.h"

/* Of all that its result depends on: the file, or why there is none; and where late work loses points, when it was handed in. */
static uint64_t digest_row(const lc_class *c, const lc_class_row *row)
{
    const lc_handin *h = row->handin;
    const int64_t when = (int64_t)row->submitted;
    uint64_t hash = !h->path       ? lc_hash(LC_HASH, h->why, strlen(h->why))
                    : h->is_images ? lc_replicates_digest(h->path)
                                   : lc_hash_file(LC_HASH, h->path);
    return c->options->assignment->late_per_day > 0 ? lc_hash(hash, &when, sizeof when) : hash;
}

/* The label is the name of files and stands in tables: of a name that is too long, or has characters that do not belong there, it is what
 * can be read of it and a number. */
static void make_label(lc_class_row *row, const char *name)
{
    char plain[LC_CLASS_LABEL];
    lc_plain_copy(plain, sizeof plain, name);
    if (row->student)
        snprintf(row->label, sizeof row->label, "%s", row->student->pseudonym);
    else if (strcmp(plain, name) == 0)
        snprintf(row->label, sizeof row->label, "%s", name);
    else
        snprintf(row->label, sizeof row->label, "%.*s~%016llx", LC_CLASS_LABEL - 20, plain,
                 (unsigned long long)lc_hash(LC_HASH, name, strlen(name)));
}

/* What the gradebook calls its author: student_id, or without a roster the name without its ending. */
static void make_id(lc_class_row *row)
{
    snprintf(row->id, sizeof row->id, "%s", row->student ? row->student->id : row->label);
    char *dot = row->student ? NULL : strrchr(row->id, '.');
    if (dot && dot != row->id)
        *dot = 0;
}

static lc_class_row make_row(const lc_class *c, const lc_handin *handin)
{
    lc_class_row row = {.handin = handin, .submitted = handin->time};
    row.student = c->options->roster ? lc_roster_find(c->options->roster, handin->name) : NULL;
    if (row.student && row.student->submitted)
        row.submitted = row.student->submitted;
    make_label(&row, handin->name);
    make_id(&row);
    row.digest = digest_row(c, &row);
    return row;
}

static int is_same_author(const lc_class_row *a, const lc_class_row *b)
{
    return a->student == b->student && (a->student || strcmp(a->id, b->id) == 0);
}

/* A text or an archive beside a source file of the same author is no work of its own; of two such the first stands for both. An author with
 * two files to grade is an error: nobody knows which of them counts. */
static lc_status add_row(lc_class *c, const lc_class_row *row, lc_error *err)
{
    for (int i = 0; i < c->count; ++i) {
        lc_class_row *other = &c->rows[i];
        if (!is_same_author(other, row))
            continue;
        if (row->handin->is_other)
            return LC_OK;
        if (other->handin->is_other) {
            *other = *row;
            return LC_OK;
        }
        return lc_fail(err, LC_BAD_INPUT, "%s and %s are both of student %s: put one of them away", other->handin->name,
                       row->handin->name, row->id);
    }
    c->rows[c->count++] = *row;
    return LC_OK;
}

static void add_missing(lc_class *c)
{
    const lc_roster *roster = c->options->roster;
    int handins = c->count;
    for (int s = 0; roster && s < roster->count; ++s) {
        int has_one = 0;
        for (int i = 0; i < handins; ++i)
            has_one |= c->rows[i].student == &roster->students[s];
        if (has_one)
            continue;
        lc_class_row *row = &c->rows[c->count++];
        row->student = &roster->students[s];
        row->most_points = lc_assignment_points(c->options->assignment);
        make_label(row, "");
        snprintf(row->id, sizeof row->id, "%s", row->student->id);
    }
}

lc_status lc_class_make_rows(lc_class *c, lc_error *err)
{
    const lc_class_options *o = c->options;
    lc_status status = LC_OK;
    c->rows = calloc((size_t)(o->handins->count + (o->roster ? o->roster->count : 0)), sizeof *c->rows);
    if (!c->rows)
        return lc_fail(err, LC_FAULT, "out of memory for a class");
    for (int i = 0; i < o->handins->count && status == LC_OK; ++i) {
        lc_class_row row = make_row(c, &o->handins->items[i]);
        status = add_row(c, &row, err);
    }
    if (status == LC_OK)
        add_missing(c);
    return status;
}
