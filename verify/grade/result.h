/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * result.h: the one result model of a grading. lc_grade_file() fills it; each format is a function of it.
 *
 * Texts are UTF-8, "" where there is none. A number that is not known is NAN. What a student must not see yet (the scene of a hidden
 * test, its numbers, its pictures) is in here all the same: a format for students writes `shown` instead of `sentence`, and asks
 * lc_test_is_open() before it shows scene, numbers, pictures or command line.
 */
#ifndef LC_RESULT_H
#define LC_RESULT_H

#include <stdio.h>
#include <time.h>

#include "verify/grade/jail.h"

typedef enum lc_test_status {
    LC_TEST_PENDING, /* not judged yet: a result is written after each test */
    LC_TEST_PASSED,  /* all points */
    LC_TEST_PARTIAL, /* some */
    LC_TEST_FAILED,  /* none, or shown wrong but near */
    LC_TEST_SKIPPED, /* a test that it requires did not pass: no points, `because` names it */
    LC_TEST_FAULT    /* our own fault (IE): no points are given or taken; grade again */
} lc_test_status;

typedef enum lc_visibility {
    LC_VISIBLE,        /* everything is shown at once */
    LC_AFTER_DUE,      /* title, points and verdict at once; scene, numbers, pictures and command line after the due date */
    LC_AFTER_PUBLISHED, /* the same, after the day on which the course publishes */
    LC_HIDDEN          /* the same, never */
} lc_visibility;

/* A command line that names two paths, each in quotes. */
enum { LC_COMMAND = 9216 };

/* A part of the image, in pixels; width 0: none. */
typedef struct lc_tile {
    int x, y, width, height;
    double ratio; /* there: measured / expected */
} lc_tile;

/* What a test measured. For a test of the mean, everything is relative to the expected mean of reflected light; for a test of a
 * method, to the reference's variance, rays, random numbers, or variance times rays. */
typedef struct lc_measured {
    double expected;       /* what 1 is: mean radiance [W sr^-1 m^-2], or of one sample variance [its square], rays, random numbers or variance times rays */
    double measured;       /* measured / expected */
    double low, high;      /* interval of that ratio, may be infinite */
    double margin;         /* relative: what all points ask for */
    double margin_shown;   /* relative: the tightest step that was shown; NAN: none */
    int channel;           /* 0 1 2: the one that was hardest */
    uint64_t samples;      /* a pixel */
    uint64_t paths;        /* of the estimator under test, in all */
    lc_tile worst;
    int bad_x, bad_y;      /* a NaN, infinite, negative or huge sample: its pixel, -1: none */
    uint64_t bad_sample, bad_count;
    double bad_value[3];
} lc_measured;

typedef struct lc_test_result {
    char name[48];           /* in the assignment, of letters, digits, _ */
    char title[128];         /* for a person */
    char scene[64];          /* of the suites, or a family's; that of the worst claim */
    char check[32];          /* which kind of test: compiles, finite, mean, variance, rays, ... */
    uint64_t seed;           /* of its samples, and of its scene if drawn */
    double points;           /* earned */
    double most_points;
    lc_test_status status;
    lc_jail_code code;       /* AC for PASSED; WA shown wrong, or not shown right; else how it ended */
    lc_visibility visibility;
    char sentence_id[48];    /* the entry of the table of sentences that `sentence` was made from */
    char sentence[640];      /* what was measured against what was expected, with its interval */
    char shown[640];         /* `sentence`, or where that is withheld what a student may read instead */
    char hint[400];          /* where to look; "" when the assignment gives none (yet) */
    char because[48];        /* SKIPPED: the test that did not pass */
    char reproduce[LC_COMMAND]; /* a command line */
    char withheld[128];      /* why `reproduce` and the numbers are not shown yet, in a sentence; "": they are */
    char pictures[3][320];   /* paths below the report's folder: yours, reference, difference; "": none was written */
    lc_measured measured;
    double seconds;          /* of the clock */
    double cpu_seconds;      /* of the jail's workers */
} lc_test_result;

enum { LC_MOST_TESTS = 12 };

/* What the text says besides the tests, from the table of sentences. */
typedef enum lc_label {
    LC_LABEL_HINT,
    LC_LABEL_PICTURES,
    LC_LABEL_AGAIN,
    LC_LABEL_UNGRADABLE,
    LC_LABEL_PRINTED,
    LC_LABEL_FAULT,
    LC_LABEL_SCORE,
    LC_LABEL_LATE,
    LC_LABEL_PENDING,
    LC_LABEL_INCOMPLETE,
    LC_LABEL_COMPILER,
    LC_LABEL_SEED,
    LC_LABELS
} lc_label;

typedef struct lc_grade_result {
    char assignment[64], title[128];
    char file[1024];          /* as given */
    char student[128];        /* id; "" when not known */
    char estimator[64];       /* the descriptor's name; "" before it was read */
    uint64_t seed;            /* that was asked for or drawn: with it and the file, the same result again */
    char jail[128];           /* level, in words: "limits, seccomp, Landlock, another user"; "none" */
    int is_ungradable;        /* 1: does not compile or is no estimator: no score, costs no attempt */
    int is_fault;             /* 1: our own fault somewhere (IE): no score yet, grade again */
    lc_jail_code code;        /* AC: all passed; else of the first test that did not, CE when ungradable, IE for a fault */
    char message[1024];       /* of the compiler or the jail, where is_ungradable or is_fault */
    char warnings[2048];      /* what the compiler said */
    char said[4097];          /* what the file's code printed in a test that is open, to be shown, never to be believed */
    lc_test_result tests[LC_MOST_TESTS];
    int test_count;
    int done;                 /* how many are judged; equal to test_count at the end */
    double points, most_points; /* sums over the tests */
    double late_days;         /* begun days after the due date, 0: in time, or not known */
    double late_penalty;      /* points taken off */
    double score;             /* max(0, points - late_penalty); 0 while ungradable or fault, and then it means nothing */
    int attempt;              /* counted from 1 */
    double seconds, cpu_seconds;
    char labels[LC_LABELS][128];
} lc_grade_result;

/* 1 when the student may see scene, numbers, pictures and command line of this test now. */
int lc_test_is_open(const lc_test_result *test);
const char *lc_test_status_name(lc_test_status status); /* "passed", "partial", "failed", "skipped", "fault", "pending" */
const char *lc_visibility_name(lc_visibility visibility); /* "visible", "after_due_date", "after_published", "hidden": Gradescope's words */
/* The exit status: FAULT for a fault, BAD_INPUT when ungradable, WRONG unless all tests passed, else OK. */
lc_status lc_grade_status(const lc_grade_result *result);

/* For a student, on a terminal. `teacher`: 1 shows what is withheld, too. Errors stay in the stream. */
void lc_grade_text(FILE *out, const lc_grade_result *result, int teacher);

#endif
