/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * rehearse.h: an assignment tried out before it is published: right estimators must get all points, wrong ones must not.
 */
#ifndef LC_REHEARSE_H
#define LC_REHEARSE_H

#include "verify/grade/grade.h"

typedef struct lc_rehearsal_row {
    const lc_estimator *estimator;
    int is_right;          /* a solution; else a mutant */
    double points;
    char first[48];        /* the first test that did not pass; "": all did */
    double seconds;
    uint64_t paths;
} lc_rehearsal_row;

typedef struct lc_rehearsal {
    int solutions, accused;        /* solutions that lost a point */
    int mutants, survivors;        /* mutants that lost none */
    double points;                 /* of the assignment */
    double seconds[2];             /* longest of a solution, of a mutant */
    double false_failure;          /* bound: that a right file loses a point by chance in one grading */
} lc_rehearsal;

/* Grades every solution and every mutant of the assignment in this process, without hints. `on_row` is called after each. */
lc_status lc_rehearse(lc_rehearsal *out, const lc_assignment *assignment, const lc_grade_options *options,
                      void (*on_row)(void *user, const lc_rehearsal_row *row), void *user, lc_error *err);

#endif
