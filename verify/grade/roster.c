/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/grade/roster.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "verify/grade/csv.h"
#include "verify/grade/place.h"

enum { MOST_FIELDS = 64, MOST_ROSTER = 4 << 20, COLUMNS = 6 };

static const char *const columns[COLUMNS] = {"student_id", "last_name", "first_name", "email", "file", "submitted"};

static char **member(lc_student *s, int column)
{
    char **const members[COLUMNS] = {&s->id, &s->last_name, &s->first_name, &s->email, &s->file, &s->submitted_text};
    return members[column];
}

static char *copy_text(const char *text)
{
    size_t size = strlen(text) + 1;
    char *copy = malloc(size);
    return copy ? memcpy(copy, text, size) : NULL;
}

/* The whole file, ending with a 0; a byte order mark is passed over. */
static lc_status read_text(char **out, char **begin, const char *path, lc_error *err)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return lc_fail(err, LC_BAD_INPUT, "%s: cannot read: %s", path, strerror(errno));
    *out = malloc(MOST_ROSTER + 1);
    size_t size = *out ? fread(*out, 1, MOST_ROSTER + 1, file) : 0;
    int failed = ferror(file);
    fclose(file);
    if (!*out)
        return lc_fail(err, LC_FAULT, "out of memory for %s", path);
    if (failed || size > MOST_ROSTER || memchr(*out, 0, size))
        return lc_fail(err, LC_BAD_INPUT, "%s: expected a text file of at most %d bytes", path, MOST_ROSTER);
    (*out)[size] = 0;
    *begin = *out + (strncmp(*out, "\xef\xbb\xbf", 3) == 0 ? 3 : 0);
    return LC_OK;
}

/* Which field is which column; -1: none. */
static lc_status read_header(int where[COLUMNS], char **fields, int count, lc_error *err)
{
    for (int c = 0; c < COLUMNS; ++c) {
        where[c] = -1;
        for (int i = count - 1; i >= 0; --i)
            if (strcmp(fields[i], columns[c]) == 0)
                where[c] = i;
    }
    return where[0] >= 0 ? LC_OK
                         : lc_fail(err, LC_BAD_INPUT,
                                   "expected the names of columns, among them student_id; known are also last_name, "
                                   "first_name, email, file, submitted");
}

/* 60-odd students and 32 bits: none will share one, but if so the second gets the next. */
static void name_anew(lc_roster *roster, uint64_t seed)
{
    lc_student *s = &roster->students[roster->count - 1];
    uint64_t hash = lc_hash(LC_HASH ^ seed, s->id, strlen(s->id));
    hash = (hash ^ hash >> 30) * 0xbf58476d1ce4e5b9ULL; /* SplitMix64's mixing: FNV leaves neighbours neighbours */
    hash = (hash ^ hash >> 27) * 0x94d049bb133111ebULL;
    uint32_t number = (uint32_t)(hash >> 32);
    for (int again = 1; again; ++number) {
        snprintf(s->pseudonym, sizeof s->pseudonym, "s%08x", (unsigned)number);
        again = 0;
        for (int i = 0; i < roster->count - 1; ++i)
            again |= strcmp(roster->students[i].pseudonym, s->pseudonym) == 0;
    }
}

static lc_status add_student(lc_roster *roster, const int where[COLUMNS], char **fields, int count, uint64_t seed,
                             lc_error *err)
{
    lc_student *students = realloc(roster->students, ((size_t)roster->count + 1) * sizeof *students);
    if (!students)
        return lc_fail(err, LC_FAULT, "out of memory for a roster");
    roster->students = students;
    lc_student *s = &students[roster->count++];
    memset(s, 0, sizeof *s);
    for (int c = 0; c < COLUMNS; ++c) {
        const char *text = where[c] >= 0 && where[c] < count ? fields[where[c]] : "";
        *member(s, c) = copy_text(text);
        if (!*member(s, c))
            return lc_fail(err, LC_FAULT, "out of memory for a roster");
    }
    if (!s->id[0])
        return lc_fail(err, LC_BAD_INPUT, "a student without student_id");
    for (int i = 0; i < roster->count - 1; ++i) {
        if (strcmp(students[i].id, s->id) == 0)
            return lc_fail(err, LC_BAD_INPUT, "student_id '%.64s' is there twice", s->id);
        if (s->file[0] && strcmp(students[i].file, s->file) == 0)
            return lc_fail(err, LC_BAD_INPUT, "file '%.64s' is there twice", s->file);
    }
    int64_t when = 0;
    const char *why = s->submitted_text[0] ? lc_read_moment(&when, s->submitted_text) : NULL;
    if (why)
        return lc_fail(err, LC_BAD_INPUT, "submitted '%.40s': %s", s->submitted_text, why);
    s->submitted = (time_t)when;
    name_anew(roster, seed);
    return LC_OK;
}

static lc_status read_students(lc_roster *out, char *text, const char *path, uint64_t seed, lc_error *err)
{
    char *fields[MOST_FIELDS];
    int count, where[COLUMNS];
    lc_csv csv = {text, 1, 1};
    lc_error why;
    lc_status status = lc_csv_record(fields, MOST_FIELDS, &count, &csv, &why);
    if (status == LC_OK)
        status = read_header(where, fields, count, &why);
    while (status == LC_OK) {
        status = lc_csv_record(fields, MOST_FIELDS, &count, &csv, &why);
        if (status == LC_OK && count == 0)
            return LC_OK;
        if (status == LC_OK)
            status = add_student(out, where, fields, count, seed, &why);
    }
    return lc_fail(err, status, "%s:%d: %.900s", path, csv.first, why.text);
}

lc_status lc_roster_read(lc_roster *out, const char *path, uint64_t seed, lc_error *err)
{
    char *text = NULL, *begin = NULL;
    out->students = NULL;
    out->count = 0;
    lc_status status = read_text(&text, &begin, path, err);
    if (status == LC_OK)
        status = read_students(out, begin, path, seed, err);
    free(text);
    if (status != LC_OK)
        lc_roster_release(out);
    return status;
}

void lc_roster_release(lc_roster *roster)
{
    for (int i = 0; i < roster->count; ++i)
        for (int c = 0; c < COLUMNS; ++c)
            free(*member(&roster->students[i], c));
    free(roster->students);
    roster->students = NULL;
    roster->count = 0;
}

const lc_student *lc_roster_find(const lc_roster *roster, const char *name)
{
    const char *dot = strrchr(name, '.');
    size_t stem = dot && dot > name ? (size_t)(dot - name) : strlen(name);
    for (int i = 0; i < roster->count; ++i)
        if (strcmp(roster->students[i].file, name) == 0 && name[0])
            return &roster->students[i];
    for (int i = 0; i < roster->count; ++i) {
        const lc_student *s = &roster->students[i];
        if (!s->file[0] && ((strlen(s->id) == stem && memcmp(s->id, name, stem) == 0) || strcmp(s->id, name) == 0))
            return s;
    }
    return NULL;
}
