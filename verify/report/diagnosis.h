/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef LC_REPORT_DIAGNOSIS_H
#define LC_REPORT_DIAGNOSIS_H

#include <stdio.h>

#include "verify/diagnose/diagnose.h"

/* How much a student is told: that it is wrong; what it has to do with, and a question; the bug and the measurements. */
typedef enum lc_hint { LC_HINT_NONE, LC_HINT_CATEGORY, LC_HINT_NAME } lc_hint;

void lc_report_diagnosis(FILE *out, const lc_diagnosis *diagnosis, const char *name, lc_hint hint);

/* The same for a report of rows: everything. */
void lc_report_behaviour(lc_behaviour *out, const lc_diagnosis *diagnosis, const char *name);

#endif
