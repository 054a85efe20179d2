/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * similarity.h: how much of one source file stands in another, whatever was renamed, moved or written into comments. Fingerprints by
 * winnowing (Schleimer, Wilkerson, Aiken: Winnowing: local algorithms for document fingerprinting, SIGMOD 2003).
 *
 * It tells where a teacher should look, and proves nothing: a short task has few solutions, and who rewrites each
 * expression is not found.
 */
#ifndef LC_SIMILARITY_H
#define LC_SIMILARITY_H

#include "core/host.h"

/* Fingerprints of one file: distinct, ascending. */
typedef struct lc_prints {
    uint64_t *items;
    int count;
} lc_prints;

/* Of a text of C or C++. What stands in `known` (may be NULL) is no fingerprint: the template from which everybody
 * started. LC_FAULT without memory. */
lc_status lc_prints_make(lc_prints *out, const char *text, const lc_prints *known, lc_error *err);
/* The same of all its sequences of tokens, not of chosen ones: for a text to be `known`. */
lc_status lc_prints_make_known(lc_prints *out, const char *text, lc_error *err);
/* Of a file, of which at most the first MiB is read. LC_BAD_INPUT where it cannot be read. */
lc_status lc_prints_read(lc_prints *out, const char *path, const lc_prints *known, lc_error *err);
void lc_prints_release(lc_prints *prints);

/* The share of the smaller file's fingerprints that are the other's, too; in [0, 1]. 0 where one has too few to tell. */
double lc_prints_overlap(const lc_prints *a, const lc_prints *b);

#endif
