/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * kill.h: what became of a mutant, or of a right variant, at the hands of a check.
 */
#ifndef LC_KILL_H
#define LC_KILL_H

#include <stdio.h>

#include "verify/judge/judge.h"

/* One estimator under one check of one suite. Of a mutant rows are judged until one kills. */
typedef struct lc_meeting {
    char subject[64], check[32], suite[16];
    int is_variant;
    int verdicts[3];  /* rows by lc_row_verdict, at the last plan that was tried */
    int coarse;       /* killed at the coarse plan */
    double paths;     /* of the estimator, in the row that killed */
    char scene[64];   /* of that row */
} lc_meeting;

typedef struct lc_meetings {
    lc_meeting *items;
    int count;
    double seconds; /* of all cores together */
} lc_meetings;

/* Writes the tables; returns the number of things that are not as they should be: mutants alive, variants accused, checks that
 * kill nothing on their own without a reason to stay. */
int lc_kill_tables(FILE *out, const lc_meetings *meetings);

#endif
