/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Estimators that are wrong on purpose: the harness must find each, and name it.
 *
 * A family is one file: switches in an estimator that is otherwise right, and a table X(id, bugs, summary, category, story,
 * shows, hint) from which it makes estimators and rows, so that a name stands in one place.
 */
#ifndef LC_MUTANTS_REGISTRY_H
#define LC_MUTANTS_REGISTRY_H

#include "lightcheck.h"

typedef struct lc_mutant {
    const lc_estimator *estimator; /* its summary tells the bug */
    const char *of;                /* the right estimator that it was */
    const char *category;          /* one of lc_mutant_categories */
    const char *story;             /* how it comes about, and where it was seen */
    const char *shows;             /* where it shows best, and there: estimate / truth */
    const char *hint;              /* for a student: where to look, without giving it away */
} lc_mutant;

/* A row of a family's table, where OF is the estimator that its mutants were. */
#define LC_MUTANT_ROW(id, bugs, summary, category, story, shows, hint) \
    {&lc_estimator_##id, OF, category, story, shows, hint},
#define LC_MUTANT_END {0, 0, 0, 0, 0, 0}

typedef struct lc_mutant_family {
    const char *name;
    const lc_mutant *mutants; /* ends with estimator = NULL */
} lc_mutant_family;

extern const lc_mutant_family lc_mutant_families[]; /* ends with name = NULL */

/* Mutant i of all families, counted from 0; NULL past the last. */
const lc_mutant *lc_mutant_at(int i);
/* NULL when there is none of that name. */
const lc_mutant *lc_mutant_find(const char *name);

/* Estimators that are right in another way than ours; ends with NULL. No check may accuse one. */
extern const lc_estimator *const lc_variants[];

typedef struct lc_mutant_category {
    const char *name, *words; /* words: "what is wrong has to do with ..." */
} lc_mutant_category;

extern const lc_mutant_category lc_mutant_categories[]; /* ends with name = NULL */

#endif
