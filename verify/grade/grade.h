/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * grade.h: one file, one assignment, one seed -> one result (result.h).
 */
#ifndef LC_GRADE_H
#define LC_GRADE_H

#include "verify/grade/assignment.h"
#include "verify/grade/result.h"
#include "verify/judge/judge.h"

typedef struct lc_grade_options {
    uint64_t seed;            /* of samples and of drawn scenes; draw it after hand-in */
    int is_secret;            /* 1: students never learn the seed; results and lines name those that are made from it (seeds.h) */
    int threads;              /* 0: one a core */
    int is_open;              /* 1: no jail, the file runs in this process: for one's own code only */
    int is_teacher;           /* 1: nothing is withheld */
    const char *only;         /* only this test, and without its prerequisites; NULL: all */
    const char *report;       /* folder for pictures, made if need be; NULL: none */
    const char *report_below; /* folder in it, for those of this file alone; NULL: none */
    const char *student;      /* id, or NULL */
    int attempt;              /* counted from 1, for hint_after_attempts; 0: 1 */
    int is_final;             /* 1: no attempt follows, so that hints are given whatever `attempt` is */
    time_t submitted;         /* for the late policy; 0: not known, never late */
    time_t now;               /* what is withheld until a date; 0: the clock's */
    const lc_estimator *estimator; /* graded instead of a file: for the check of an assignment; NULL: the file */
    const struct lc_adapter *adapter; /* graded instead of a file, by its images, without a jail: grade_images.c; NULL: the file */
    lc_load_scene_fn *load;   /* scenes by name */
    /* After every test, and once before the first: write the result now, atomically. `result->done` tests are judged. NULL: nobody asks. An error
     * ends the grading, and is returned. */
    lc_status (*on_test)(void *user, const lc_grade_result *result, lc_error *err);
    void *user;
    const char *program;      /* for the reproducing lines */
} lc_grade_options;

/* seed 1, all cores, jailed, attempt 1, the program "lightcheck". `load` is the caller's to set. */
void lc_grade_options_init(lc_grade_options *options);

/* Whether an assignment can be graded by: draws and builds the scenes of this seed, and plans what is claimed over them; renders
 * nothing. LC_BAD_INPUT with file:line and what is wrong. To be asked once, before the first file. */
lc_status lc_grade_plan(const lc_assignment *assignment, const lc_grade_options *options, lc_error *err);

/* Fills `out`, whatever the file does: a file that does not compile, a hang, a cheat are results, not errors. LC_OK then; lc_grade_status(out) has the
 * verdict. An error (LC_BAD_INPUT: no such file, scene or test; LC_FAULT) says that there is no result. One grading a process at a time; it
 * forks, so that the caller has no other threads running. Same file, assignment and seed: same points, unless it is at its limit of time. */
lc_status lc_grade_file(lc_grade_result *out, const lc_assignment *assignment, const char *path,
                        const lc_grade_options *options, lc_error *err);

/* The result of what was not graded: by a fault of ours, or because there is nothing that could be. Seed, attempt and student are those of
 * the options. */
void lc_grade_refused(lc_grade_result *out, const lc_assignment *assignment, const char *file,
                      const lc_grade_options *options, int is_fault, const char *why);

#endif
