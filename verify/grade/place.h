/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * place.h: a JSON file read with care: each value knows where it stands, so that each complaint is one with file:line and says what is
 * supported. jansson knows the lines of syntax errors only; of a value, the text is asked again.
 */
#ifndef LC_PLACE_H
#define LC_PLACE_H

#include <jansson.h>

#include "core/host.h"

typedef struct lc_json_file {
    char path[1024];
    char *text;
    json_t *root;
} lc_json_file;

/* A value: the root (within NULL), the one under `key` of an object, or number `index` of an array (key NULL). */
typedef struct lc_place {
    const lc_json_file *file;
    const struct lc_place *within;
    const char *key;
    size_t index;
    json_t *value; /* NULL: is not there */
} lc_place;

/* LC_BAD_INPUT: no such file, more than 1 MB, or no JSON object. */
lc_status lc_json_open(lc_json_file *out, const char *path, lc_error *err);
void lc_json_close(lc_json_file *file);

lc_place lc_place_root(const lc_json_file *file);
/* `place` outlives what it returns. */
lc_place lc_place_key(const lc_place *place, const char *key);
lc_place lc_place_item(const lc_place *place, size_t index);
/* The line on which the value starts, counted from 1; of one that is not there, that of what it is missing from. */
int lc_place_line(const lc_place *place);

/* "FILE:LINE: KEY: " and the message; LC_BAD_INPUT. */
lc_status lc_place_fail(lc_error *err, const lc_place *place, const char *format, ...)
#ifdef __GNUC__
    __attribute__((format(printf, 3, 4)))
#endif
    ;

/* Each of these leaves *out alone where there is no value, unless `required`. */
lc_status lc_place_string(char *out, size_t size, const lc_place *place, int required, lc_error *err);
lc_status lc_place_number(double *out, const lc_place *place, double least, double most, int required, lc_error *err);
lc_status lc_place_int(int *out, const lc_place *place, int least, int most, int required, lc_error *err);
/* One of "a|b|c": its number. */
lc_status lc_place_choice(int *out, const lc_place *place, const char *choices, int required, lc_error *err);
/* A moment, ISO 8601 with a zone: 2026-12-01T23:59:00Z or ...+01:00. Seconds since 1970 UTC; what is wrong, or NULL. */
const char *lc_read_moment(int64_t *out, const char *text);
lc_status lc_place_time(int64_t *out, const lc_place *place, lc_error *err);
/* The number of elements, 0 where there is no value. */
lc_status lc_place_array(size_t *count, const lc_place *place, size_t most, int required, lc_error *err);
/* An object with keys of "a|b|c" only. */
lc_status lc_place_object(const lc_place *place, const char *keys, lc_error *err);

/* Index of a word in "a|b|c", or -1. */
int lc_word_index(const char *word, const char *words);
/* The other way round: the word of that index, which there is. Returns `out`. */
const char *lc_word_at(char *out, size_t size, int index, const char *words);

#endif
