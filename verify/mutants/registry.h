/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Estimators that are wrong on purpose: the harness must find each.
 */
#ifndef LC_MUTANTS_REGISTRY_H
#define LC_MUTANTS_REGISTRY_H

#include "lightcheck.h"

typedef struct lc_mutant {
    const lc_estimator *estimator; /* its summary tells the bug */
    const char *of;                /* the right estimator that it was */
} lc_mutant;

extern const lc_mutant lc_mutants[]; /* ends with estimator = NULL */

#endif
