/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Private to verify/grade/formats*: what the formats share.
 */
#ifndef LC_FORMATS_C_H
#define LC_FORMATS_C_H

#include "verify/grade/formats.h"
#include "verify/report/safe.h"

/* Sets a key; *ok becomes 0 where jansson would have left it out: without memory. */
void lc_json_set(json_t *object, const char *key, json_t *value, int *ok);
void lc_json_append(json_t *array, json_t *value, int *ok);
json_t *lc_json_seed(uint64_t seed); /* text: 64 bits do not fit a JSON number everywhere */
/* Writes and releases it; LC_FAULT where it is not `ok`, and nothing is written. */
lc_status lc_json_dump(FILE *out, json_t *object, int ok, lc_error *err);

/* A text of the heap, or NULL. */
/* The whole result in a few sentences for its author. */
char *lc_result_summary(const lc_grade_result *result);
/* What is known of a test: the sentence, hint, what to type; where `is_public`, less what is withheld. */
char *lc_result_feedback(const lc_grade_result *result, const lc_test_result *test, int is_public);
/* The same as JSON; frees the text. */
json_t *lc_json_taken(char *text);

/* Whether details of the test go out. */
int lc_result_shows(const lc_test_result *test, int teacher);

#endif
