/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * formats.h: a graded hand-in as others read it. Each format writes the whole result, judged to its end or not: a test that is not
 * judged yet says so. Bytes that are no UTF-8 become '?', numbers that are none become null, or 0 where null is not known. What other
 * systems show as text has no control characters (verify/report/plain.h): some of them show colours, and more.
 */
#ifndef LC_FORMATS_H
#define LC_FORMATS_H

#include "verify/grade/result.h"

enum { LC_RESULT_VERSION = 1 }; /* of our own JSON: goes up when a key goes or changes its meaning */

/* `teacher` 0: what a student may not see yet is left out, but where the other side hides it. LC_FAULT without memory; errors of
 * the stream stay there. */
typedef lc_status lc_result_write_fn(FILE *out, const lc_grade_result *result, int teacher, lc_error *err);

/* Our own: all that the model has. */
lc_result_write_fn lc_result_json;
/* results.json of Gradescope's autograders. Tests carry their visibility, and Gradescope hides them. */
lc_result_write_fn lc_result_gradescope;
/* results.json of PrairieLearn's external graders. */
lc_result_write_fn lc_result_prairielearn;
/* What a step of GitHub Classroom's autograding hands to its reporter: base64 of JSON, one line. */
lc_result_write_fn lc_result_classroom;
/* The subset of JUnit's XML that its readers share. */
lc_result_write_fn lc_result_junit;

typedef struct lc_format {
    const char *name; /* on the command line */
    lc_result_write_fn *write;
} lc_format;

extern const lc_format lc_formats[]; /* ends with name = NULL */

const lc_format *lc_format_find(const char *name); /* or NULL */

/* Writes it to the file, which is the old one until all of the new one is there. */
lc_status lc_result_save(const char *path, const lc_format *format, const lc_grade_result *result, int teacher,
                         lc_error *err);

#endif
