/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * assignment.h: what is asked of a file, and what it is worth: JSON, described in docs/assignments.md.
 */
#ifndef LC_ASSIGNMENT_H
#define LC_ASSIGNMENT_H

#include <time.h>

#include "core/host.h"
#include "verify/grade/result.h"
#include "verify/report/diagnosis.h"

typedef enum lc_test_kind {
    LC_KIND_DESCRIPTOR, /* compiles, and claims the lobes, emitters and bounces that are asked for */
    LC_KIND_FINITE,     /* a few samples over its scenes: none is NaN, infinite, negative or huge; nothing crashes or hangs */
    LC_KIND_CHECK,      /* all claims of one check of `lightcheck verify` about its scenes */
    LC_KIND_MEAN,       /* the mean of the reference estimator over its scenes */
    LC_KIND_VARIANCE,   /* the variance of the reference: the method that was asked for */
    LC_KIND_RAYS,       /* as many rays a sample as the reference */
    LC_KIND_NUMBERS,    /* as many random numbers a sample as the reference */
    LC_KIND_WORK        /* variance times rays: what the same noise costs, however many paths are averaged in one sample */
} lc_test_kind;

/* 1: a test of the method: something about single samples, beside the same of the reference. */
static inline int lc_is_of_method(lc_test_kind kind) { return kind >= LC_KIND_VARIANCE; }
/* As an assignment's file has it. Returns `out`. */
const char *lc_test_kind_name(char *out, size_t size, lc_test_kind kind);

enum { LC_MOST_SCENES = 6, LC_MOST_SOLUTIONS = 12, LC_MOST_REQUIRED = LC_MOST_TESTS };

typedef struct lc_test {
    char name[48], title[128];
    lc_test_kind kind;
    char check[32];                     /* CHECK: which */
    char scenes[LC_MOST_SCENES][64];    /* of the suites, families, or files (assignment_files.h) */
    int scene_lines[LC_MOST_SCENES];    /* where they stand in the assignment's file */
    int scene_count;
    int min_bounces, max_bounces;       /* MEAN, FINITE, of a method: what is summed; CHECK: only claims of these; -1: all that there are */
    double points;
    lc_visibility visibility;
    int required[LC_MOST_REQUIRED], required_count; /* indices of earlier tests */
    char relation[32];                  /* CHECK: only the claims of this relation; "": all */
    char hint[400];                     /* of the test itself, before the bug is known; may be "" */
    double least, most;                 /* of a method: that of the reference times these; 0 and INFINITY where not given */
} lc_test;

typedef struct lc_assignment {
    char name[64], title[128], summary[512];
    char given[256];                 /* how it was named, for reproducing lines */
    char path[1024];                 /* of its file, for messages */
    char reference[64];              /* a shipped estimator: language, mean and variance are its */
    unsigned lobes, emitters;        /* that the file must claim at least: the reference's, unless given */
    int bounces;                     /* that the file must reach, and that tests ask for */
    double margin;                   /* relative, times max(1, c): all points */
    double false_failure;            /* probability that a right file loses a point by chance */
    char solutions[LC_MOST_SOLUTIONS][64]; /* right estimators, shipped or variants, that must get all points */
    int solution_count;
    char mutants[LC_MOST_SOLUTIONS][64];   /* of: wrong versions of these estimators must not get all points */
    int mutant_count;
    char beyond[LC_MOST_SOLUTIONS][64];    /* wrong versions that it does not ask about, such as of motion blur */
    int beyond_count;
    lc_hint hints;                   /* whether a known bug is looked for, and how much is told of it */
    int hint_after_attempts;         /* no hint before this many attempts */
    time_t due, published;           /* 0: never set */
    double late_per_day, late_most;  /* share of all points a begun day, and at most; 0: the course's own system does it */
    double cpu_seconds;              /* for the file, all tests and workers together; more is TLE */
    char sentences[256];             /* a translated table (sentences.h, assignment_files.h); "": the program's */
    lc_test tests[LC_MOST_TESTS];
    int test_count;
} lc_assignment;

/* Reads it from a file, or from verify/assignments/NAME.json. LC_BAD_INPUT with file:line, what is wrong and what is supported. */
lc_status lc_assignment_read(lc_assignment *out, const char *name_or_path, lc_error *err);
/* Calls `each` with the name and title of every assignment that the program ships, by name. */
lc_status lc_assignment_list(void (*each)(void *user, const char *name, const char *title), void *user, lc_error *err);
/* A shipped estimator or a variant of that name, in this process; NULL: there is none. */
const lc_estimator *lc_right_estimator(const char *name);
double lc_assignment_points(const lc_assignment *assignment);

#endif
