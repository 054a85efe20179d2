/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * judge.h: from scenes and estimators to a report. It plans the rows, shares out one error budget, grows films look by look until each claim
 * is shown equal (PASS) or shown different (FAIL) or its samples run out (UNDECIDED). The rules are in docs/architecture.md.
 */
#ifndef LC_JUDGE_H
#define LC_JUDGE_H

#include "verify/checks/checks.h"
#include "verify/renderers/adapter.h"
#include "verify/report/pictures.h"
#include "verify/report/report.h"

/* ---- suites ------------------------------------------------------------------------------------------------ */

/* A scene of the suites and what was measured of the estimators there: c, the standard deviation of a sample of reflected light
 * over its mean, pooled over the image. It sets margin (margin of the suite times max(1, c)) and samples. */
typedef struct lc_cell {
    const char *scene, *estimator;
    int max_bounces; /* from 1 */
    double c;
} lc_cell;

typedef struct lc_suite {
    const char *name;
    double margin;       /* relative, of a row with c <= 1 */
    double most_samples; /* cap on the planned samples of all cells together, and on those of any row: no margin asks for more */
} lc_suite;

extern const lc_suite lc_suites[];          /* ends with name = NULL */
extern const char *const lc_suite_scenes[]; /* ends with NULL */
extern const lc_cell lc_cells[];            /* ends with scene = NULL */

const lc_suite *lc_suite_find(const char *name);
/* 1 when the suite judges this claim. The quick one leaves out what is full_only; an estimator that varies another has chosen rows only. */
int lc_suite_has(const lc_suite *suite, const lc_claim *claim);
/* c of that cell; NAN when the table does not know it (then a discarded pilot measures it). */
double lc_cell_noise(const char *scene, const char *estimator, int max_bounces);
/* Samples a pixel that a row plans for, so that hardly any ends undecided: (c z / margin)^2 over the pixels, z = 11; at most 2^62. */
uint64_t lc_planned_samples(double c, double margin, int pixels);

/* ---- a run --------------------------------------------------------------------------------------------------- */

typedef struct lc_verify_options {
    const lc_suite *suite;
    double margin;                 /* relative, for c <= 1; 0: the suite's */
    double false_fail, false_pass; /* of the whole run */
    uint64_t seed;
    int threads;
    const lc_estimator *estimator; /* only this one (it need not be in the registry), or NULL: all */
    const char *given;             /* how that was named on the command line; NULL: by its name */
    int is_jailed;                 /* and that it was to be locked up */
    const char *check, *scene;     /* only these, or NULL */
    int shard, shards;             /* only every shards-th scene, from `shard` on, 0 <= shard < shards; what is said of the host
                                      counts as the first scene. 0 0: all */
    const lc_adapter *renderer;    /* another program whose estimator `estimator` is, or NULL */
    /* Called after each row, in the order of the report; may be NULL. */
    void (*on_row)(void *user, const lc_row *row, int done, int count);
    /* Called with each row that failed, its number in the table and the images that show it, where there are any; may be NULL. Never twice at
     * the same time, but by any thread, and in any order. For lc_report_pictures(). */
    void (*on_fail)(void *user, lc_row *row, int number, const lc_exhibit *evidence);
    void *user; /* of both */
    const char *program; /* for the reproducing lines */
} lc_verify_options;

/* suite quick, 1e-6 both, seed 1, all cores. */
void lc_verify_options_init(lc_verify_options *options);

/* Fills the report. LC_OK even when rows failed: lc_report_status() tells. Loads scenes through `load`, which owns nothing of them. */
typedef lc_status lc_load_scene_fn(lc_scene **out, const char *name, lc_error *err);
/* A scene of the suites: through `load`, or where the name is a family's, the one of this seed. */
lc_status lc_suite_scene(lc_scene **out, const char *name, uint64_t seed, lc_load_scene_fn *load, lc_error *err);
lc_status lc_verify(lc_report *report, const lc_verify_options *options, lc_load_scene_fn *load, lc_error *err);

/* Measures c of every cell of all suites (of one estimator, of one scene, where not NULL), and calls `line` with each as a row of
 * lc_cells: how that table is made. */
lc_status lc_measure_cells(lc_load_scene_fn *load, const lc_estimator *estimator, const char *scene,
                           void (*line)(void *user, const char *text), void *user, lc_error *err);

/* c of a film: standard deviation of a sample over the mean, both pooled over the image, in the channel where it is largest. */
double lc_film_noise(const lc_film *film);
/* 1 when not one sample carries light. */
int lc_film_is_black(const lc_film *film);

/* ---- one claim at a time: what a grader needs ---------------------------------------------------------------------- */

typedef struct lc_session lc_session;

/* The budget of the options is split among `rows` claims. The options outlive the session. LC_FAULT without memory. */
lc_status lc_session_open(lc_session **out, const lc_verify_options *options, int rows, lc_error *err);
void lc_session_close(lc_session *session); /* NULL is fine */
/* Images without which no claim about a folder of them (verify/renderers/replicates.h) is judged: 64 tell their noise, 256 are judged. */
enum { LC_LEAST_IMAGES = 320 };

/* Fills a zeroed row, as lc_verify does. An estimator that gives no film fails its row. */
lc_status lc_judge_claim(lc_row *row, lc_session *session, const lc_claim *claim, lc_error *err);

/* What a claim was judged by last; NULL: none of that. They are the session's. */
typedef struct lc_seen {
    const lc_film *film;          /* of the estimator */
    const lc_film *other;         /* of the one that it was compared with */
    const lc_film *difference;    /* of a relation: each sample less those of the terms */
    const lc_expected *expected;
    const lc_film *bad;           /* a film of the estimator that has bad samples, pilots included */
} lc_seen;
void lc_session_seen(lc_seen *out, const lc_session *session, const lc_claim *claim);

/* The stream of an estimator in this run. One that is not in the registry never shares a stream with one that is, even under the same name. */
uint32_t lc_session_arm(const lc_estimator *estimator);

/* ---- two images ------------------------------------------------------------------------------------------------ */

/* Decides whether two films of different streams have the same mean, within a relative margin of the second's mean. */
lc_status lc_compare_films(lc_row *row, const lc_film *a, const lc_film *b, double margin, double false_fail,
                           double false_pass, lc_error *err);
/* The same of films that were read from files, whose means were rounded to float: a difference that rounding explains is none. */
lc_status lc_compare_files(lc_row *row, const lc_film *a, const lc_film *b, double margin, double false_fail,
                           double false_pass, lc_error *err);
/* The same of one film and of values without error, R G B of each pixel, row by row. */
lc_status lc_compare_values(lc_row *row, const lc_film *a, const double *rgb, double margin, double false_fail,
                            double false_pass, lc_error *err);
/* 1 when samples of a film, in batches of `size`, are shown to depend on each other in some channel, at the level alpha. */
int lc_film_depends(const lc_film *film, uint64_t size, double alpha);

#endif
