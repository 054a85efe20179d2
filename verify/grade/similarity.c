/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A text becomes tokens: comments, spaces, braces, parentheses and qualifiers are dropped, every name but the language's
 * and lightcheck's becomes the same one, so does every number and every string. Each GRAM tokens in a row are
 * hashed; of each WINDOW hashes in a row the least is a fingerprint. So whatever two files share over GRAM + WINDOW - 1
 * tokens is found, wherever it stands in either.
 */
#include "verify/grade/similarity.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { GRAM = 14, WINDOW = 8, LEAST = 8, MOST_SOURCE = 1 << 20 };

typedef struct tokens {
    uint64_t *items;
    size_t count, room;
} tokens;

/* ---- tokens ------------------------------------------------------------------------------------------------------ */

static int add(tokens *t, const char *text, size_t size)
{
    if (t->count == t->room) {
        size_t room = t->room ? 2 * t->room : 1024;
        uint64_t *items = realloc(t->items, room * sizeof *items);
        if (!items)
            return 0;
        t->items = items;
        t->room = room;
    }
    t->items[t->count++] = lc_hash(LC_HASH, text, size);
    return 1;
}

static int is_word(const char *text, size_t size, const char *const *words)
{
    for (; *words; ++words)
        if (strlen(*words) == size && memcmp(text, *words, size) == 0)
            return 1;
    return 0;
}

static int add_name(tokens *t, const char *text, size_t size)
{
    static const char *const qualifiers[] = {"const", "static", "inline", "register", "volatile", "extern", NULL};
    static const char *const language[] = {"if",   "else",   "for",    "while",   "do",     "switch", "case", "return",
                                           "goto", "break",  "continue", "default", "sizeof", "struct", "enum", "typedef",
                                           "int",  "double", "float",  "void",    NULL};
    if (is_word(text, size, qualifiers))
        return 1;
    int kept = is_word(text, size, language) || (size > 3 && (memcmp(text, "lc_", 3) == 0 || memcmp(text, "LC_", 3) == 0));
    return kept ? add(t, text, size) : add(t, "x", 1);
}

/* Behind a string or character that begins here. */
static const char *skip_quoted(const char *at)
{
    char quote = *at++;
    while (*at && *at != quote && *at != '\n')
        at += at[0] == '\\' && at[1] ? 2 : 1;
    return *at == quote ? at + 1 : at;
}

/* Behind spaces, comments, and lines that include something. */
static const char *skip_nothing(const char *at)
{
    for (;;) {
        if (isspace((unsigned char)*at)) {
            ++at;
        } else if (at[0] == '/' && at[1] == '*') {
            const char *end = strstr(at + 2, "*/");
            at = end ? end + 2 : at + strlen(at);
        } else if ((at[0] == '/' && at[1] == '/') || strncmp(at, "#include", 8) == 0) {
            at += strcspn(at, "\n");
        } else {
            return at;
        }
    }
}

static int tokenize(tokens *t, const char *at)
{
    int ok = 1;
    for (at = skip_nothing(at); ok && *at; at = skip_nothing(at)) {
        const char *start = at;
        if (isalpha((unsigned char)*at) || *at == '_') {
            while (isalnum((unsigned char)*at) || *at == '_')
                ++at;
            ok = add_name(t, start, (size_t)(at - start));
        } else if (isdigit((unsigned char)*at) || (*at == '.' && isdigit((unsigned char)at[1]))) {
            while (isalnum((unsigned char)*at) || *at == '.')
                ++at;
            ok = add(t, "0", 1);
        } else if (*at == '"' || *at == '\'') {
            at = skip_quoted(at);
            ok = add(t, "\"", 1);
        } else {
            ++at;
            ok = strchr("{}()", *start) ? 1 : add(t, start, 1);
        }
    }
    return ok;
}

/* ---- fingerprints ------------------------------------------------------------------------------------------------ */

static int ascending(const void *a, const void *b)
{
    const uint64_t *x = a, *y = b;
    return *x < *y ? -1 : *x > *y;
}

static int has(const lc_prints *prints, uint64_t item)
{
    return prints && prints->count && bsearch(&item, prints->items, (size_t)prints->count, sizeof item, ascending) != NULL;
}

/* Hashes of each GRAM tokens in a row; in place. */
static size_t make_grams(tokens *t)
{
    size_t grams = t->count >= GRAM ? t->count - GRAM + 1 : 0;
    for (size_t i = 0; i < grams; ++i)
        t->items[i] = lc_hash(LC_HASH, t->items + i, GRAM * sizeof *t->items);
    return grams;
}

/* Keeps the least of each window of hashes; in place. */
static size_t winnow(uint64_t *items, size_t count)
{
    size_t kept = 0, last = count;
    for (size_t i = 0; i + WINDOW <= count; ++i) {
        size_t least = i;
        for (size_t k = i; k < i + WINDOW; ++k)
            if (items[k] <= items[least])
                least = k;
        if (least != last)
            items[kept++] = items[least]; /* kept <= i: those of later windows stay */
        last = least;
    }
    return kept;
}

static lc_status make(lc_prints *out, const char *text, const lc_prints *known, int all, lc_error *err)
{
    tokens t = {NULL, 0, 0};
    int count = 0;
    out->items = NULL;
    out->count = 0;
    if (!tokenize(&t, text)) {
        free(t.items);
        return lc_fail(err, LC_FAULT, "out of memory for the fingerprints of a file");
    }
    size_t grams = make_grams(&t);
    if (!all)
        grams = winnow(t.items, grams);
    if (grams)
        qsort(t.items, grams, sizeof *t.items, ascending);
    for (size_t i = 0; i < grams; ++i)
        if ((i == 0 || t.items[i] != t.items[i - 1]) && !has(known, t.items[i]))
            ++count;
    out->items = malloc(((size_t)count + 1) * sizeof *out->items);
    for (size_t i = 0; out->items && i < grams; ++i)
        if ((i == 0 || t.items[i] != t.items[i - 1]) && !has(known, t.items[i]))
            out->items[out->count++] = t.items[i];
    free(t.items);
    return out->items ? LC_OK : lc_fail(err, LC_FAULT, "out of memory for the fingerprints of a file");
}

lc_status lc_prints_make(lc_prints *out, const char *text, const lc_prints *known, lc_error *err)
{
    return make(out, text, known, 0, err);
}

lc_status lc_prints_make_known(lc_prints *out, const char *text, lc_error *err)
{
    return make(out, text, NULL, 1, err);
}

lc_status lc_prints_read(lc_prints *out, const char *path, const lc_prints *known, lc_error *err)
{
    out->items = NULL;
    out->count = 0;
    FILE *file = fopen(path, "rb");
    if (!file)
        return lc_fail(err, LC_BAD_INPUT, "%s: cannot read: %s", path, strerror(errno));
    char *text = malloc(MOST_SOURCE + 1);
    size_t size = text ? fread(text, 1, MOST_SOURCE, file) : 0;
    int failed = ferror(file);
    fclose(file);
    lc_status status = !text   ? lc_fail(err, LC_FAULT, "out of memory for %s", path)
                       : failed ? lc_fail(err, LC_BAD_INPUT, "%s: cannot read", path)
                                : LC_OK;
    for (size_t i = 0; i < size; ++i)
        text[i] = text[i] ? text[i] : ' ';
    if (text)
        text[size] = 0;
    if (status == LC_OK)
        status = lc_prints_make(out, text, known, err);
    free(text);
    return status;
}

void lc_prints_release(lc_prints *prints)
{
    free(prints->items);
    prints->items = NULL;
    prints->count = 0;
}

double lc_prints_overlap(const lc_prints *a, const lc_prints *b)
{
    const lc_prints *less = a->count < b->count ? a : b, *more = less == a ? b : a;
    int both = 0;
    if (less->count < LEAST)
        return 0;
    for (int i = 0; i < less->count; ++i)
        both += has(more, less->items[i]);
    return (double)both / less->count;
}
