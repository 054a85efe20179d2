/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Private to grade*.c: a grading in progress.
 */
#ifndef LC_GRADING_H
#define LC_GRADING_H

#include "verify/grade/grade.h"
#include "verify/grade/seeds.h"
#include "verify/grade/sentences.h"
#include "verify/report/safe.h"

/* What a test needs: its scenes, and what is claimed over them. */
typedef struct lc_job {
    const lc_test *test;
    uint64_t seed; /* of its samples and drawn scenes */
    lc_scene *scenes[LC_MOST_SCENES];
    int scene_count;
    lc_claims claims;
} lc_job;

typedef struct lc_grading {
    const lc_assignment *assignment;
    const lc_grade_options *options;
    const char *path;
    lc_grade_result *result;
    lc_sentences *sentences;
    lc_jail *jail;                 /* NULL: in the open */
    lc_estimator copy;             /* of an estimator of this process: never taken for the registered one */
    const lc_estimator *estimator; /* under test */
    const lc_estimator *reference;
    lc_job jobs[LC_MOST_TESTS];
    int rows;                      /* claims in all, among which the budget is split */
    double cpu_left;               /* of the assignment's, for the jail */
} lc_grading;

/* grade_jobs.c: builds the scenes of all tests and claims about them; the estimator is known by then. */
lc_status lc_grading_plan(lc_grading *g, lc_error *err);
void lc_grading_release(lc_grading *g);
/* The seed from which tests of this visibility are drawn. */
uint64_t lc_grading_seed(const lc_grade_options *options, lc_visibility visibility);
/* The file as its author types it: a word of a shell, and of a class without the folder that it was collected in. Of LC_SHELL_WORD(1024) bytes. */
char *lc_grading_file(char *out, const lc_grading *g);
/* What a session of this test is run with. */
void lc_grading_options(lc_verify_options *out, const lc_grading *g, const lc_job *job);

/* Each judges one test and fills its result: status, code, points, sentence, numbers. An error is one of ours. */
lc_status lc_grade_finite(lc_grading *g, const lc_job *job, lc_test_result *out, lc_error *err);
lc_status lc_grade_claims(lc_grading *g, const lc_job *job, lc_test_result *out, lc_error *err);
lc_status lc_grade_method(lc_grading *g, const lc_job *job, lc_test_result *out, lc_error *err);

/* The same of any kind, for an adapter or images; in grade_images.c. What images cannot tell counts for nothing: no points are asked for. */
int lc_images_cannot_tell(const lc_grading *g, const lc_job *job);
lc_status lc_grade_images(lc_grading *g, const lc_job *job, lc_test_result *out, lc_error *err);

/* What is shown wrong, but by less than 5% in every part of the image, earns this share of the points; what is not shown wrong earns more, or
 * nothing. */
#define LC_NEAR_SHARE 0.3

/* The share of its points that a decided row earns, and the margin that was shown for it. */
double lc_grade_share(double *margin_shown, const lc_row *row);

/* What a row means for a test: numbers, status, points, sentence; returns the share of the points. `film`: what was rendered, or NULL. */
double lc_test_row(lc_test_result *out, const lc_grading *g, const lc_claim *claim, const lc_row *row, const lc_film *film);
/* The texts besides the tests, by what the result says now; `sentences` NULL: the program's own. */
void lc_grade_labels(lc_grade_result *r, const lc_sentences *sentences);
/* Sets status, points and code of a test from its share of the points. */
void lc_test_settle(lc_test_result *out, double share);
/* Writes sentence and its id. */
void lc_test_say(lc_test_result *out, const lc_grading *g, const char *id, const lc_words *words);
/* Of a film with bad samples: sentence, numbers and the line that replays the first. `scene` as on a command line; of a claim about several
 * scenes, `terms` are the others, else NULL. */
void lc_test_bad(lc_test_result *out, const lc_grading *g, const char *scene, const lc_film *film, const lc_term *terms);
/* Of a file that ended by `code`: its own fault, or with IE ours. */
void lc_test_end(lc_test_result *out, const lc_grading *g, const char *scene, lc_jail_code code, const char *reason);
/* 1, and everything filled in, when the last film of the jail did not end well. */
int lc_test_ended(lc_test_result *out, const lc_grading *g, const char *scene);

/* Looks for a known bug, and says of it in the test's hint what the assignment allows. */
lc_status lc_grade_hint(lc_grading *g, lc_test_result *out, lc_error *err);

/* Yours, the reference, the difference, into the report's folder. */
lc_status lc_grade_pictures(lc_grading *g, const lc_seen *seen, lc_test_result *out, lc_error *err);

#endif
