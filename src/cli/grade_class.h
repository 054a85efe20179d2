/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * `lightcheck grade` of more than one file: the part of a class.
 */
#ifndef LC_GRADE_CLASS_H
#define LC_GRADE_CLASS_H

#include "cli/commands.h"
#include "verify/grade/grade.h"

typedef struct lc_cli_class {
    int jobs, resume, has_seed, has_attempt, adapters, images;
    const char *roster, *shard, *solutions, *folder, *secret; /* NULL where not given */
} lc_cli_class;

int lc_cli_is_folder(const char *path);
/* Grades it; `grade` is for each hand-in. LC_FAULT, at the end, when some are faults of ours. */
lc_status lc_cli_grade_class(const lc_cli_class *self, const lc_strings *words, const lc_assignment *assignment,
                             const lc_grade_options *grade, lc_error *err);

#endif
