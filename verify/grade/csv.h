/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * csv.h: records of comma-separated values (RFC 4180), read and written.
 */
#ifndef LC_CSV_H
#define LC_CSV_H

#include <stdio.h>

#include "core/host.h"

typedef struct lc_csv {
    char *at;  /* the text that is left; it is changed */
    int line;  /* of `at`; begins at 1 */
    int first; /* line of the record read last */
} lc_csv;

/* Splits the next record, in place: "a","b ""c""" is two fields. Empty lines are passed over; LF ends a line as CR LF
 * does. The fields lie in the text. *count = 0: there is no further one. LC_BAD_INPUT: a quote that is not closed or
 * stands wrong, more than `most` fields; the line is `first`. */
lc_status lc_csv_record(char **fields, int most, int *count, lc_csv *csv, lc_error *err);

/* Writes one field, quoted where it must be. One that a spreadsheet would take for a formula (= + - @) gets a ' before it:
 * names of hand-ins are chosen by students. */
void lc_csv_field(FILE *out, const char *text);

#endif
