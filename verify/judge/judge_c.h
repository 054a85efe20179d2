/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Private to verify/judge, and to the programs of verify/proof that measure it: a run in progress.
 */
#ifndef LC_JUDGE_C_H
#define LC_JUDGE_C_H

#include "verify/judge/judge.h"
#include "verify/stats/stats.h"

/* A film of one (scene, estimator, bounces, stream) at one look; the next look's grows from it, and all checks share them. */
typedef struct lc_stock_film {
    const lc_scene *scene;
    const lc_estimator *estimator;
    int min_bounces, max_bounces;
    uint32_t arm;
    const lc_claim *minus; /* less the terms of this claim; NULL: less nothing */
    lc_film *film;
} lc_stock_film;

/* Expected values of a scene, computed once. */
typedef struct lc_stock_values {
    const lc_scene *scene;
    lc_expect_fn *expect;
    int min_bounces, max_bounces;
    lc_expected expected;
} lc_stock_values;

struct lc_session {
    const lc_verify_options *options;
    lc_stock_film *films;
    lc_stock_values *values;
    int film_count, value_count;
    int rows; /* among which the budget is split */
    int number; /* of the claim that is judged, among those that were selected */
    double margin;
    uint64_t paths;
    struct lc_foreign *foreign; /* what is known of the renderer under test on this scene; NULL: nothing yet */
};

/* The film of that stream with exactly `samples` a pixel. The film is the session's. */
lc_status lc_session_film(const lc_film **out, lc_session *session, const lc_scene *scene,
                          const lc_estimator *estimator, int min_bounces, int max_bounces, uint32_t arm,
                          uint64_t samples, lc_error *err);
/* The differences of a paired claim: each sample of its estimator over its scene, less the terms. */
lc_status lc_session_difference(const lc_film **out, lc_session *session, const lc_claim *claim, uint32_t arm,
                                uint64_t samples, lc_error *err);
/* The expected values of the claim. They are the session's. */
lc_status lc_session_values(const lc_expected **out, lc_session *session, const lc_claim *claim, lc_error *err);
/* Drops all films and values: the next scene needs none of them. */
void lc_session_clear(lc_session *session);
/* Drops the films of one estimator: what others are held against stays. */
void lc_session_forget(lc_session *session, const lc_estimator *estimator);

/* Appends what each check claims of the estimator over the scene, of all suites; adds 1 to *not_applicable where none does. */
lc_status lc_plan_pair(lc_claims *claims, int *not_applicable, const lc_scene *scene, const lc_estimator *estimator,
                       lc_error *err);
/* Appends what each claims of the host. */
lc_status lc_plan_host(lc_claims *claims, lc_error *err);

/* 1 for the estimators that the program ships. */
int lc_is_registered(const lc_estimator *estimator);

/* Judges the claims, scenes at the same time, and appends their rows to the report in this order; each thread has a session of its own,
 * that begins as `model`, which has no films yet. */
lc_status lc_judge_all(lc_report *report, const lc_session *model, const lc_claim *const *claims, int count, lc_error *err);
/* What lc_judge_claim does with a paired claim, in paired.c; room for the differences of one channel in `field`. */
lc_status lc_judge_paired(lc_row *row, lc_session *session, const lc_claim *claim, lc_estimate *field, lc_error *err);

/* Parts of both. The margin at noise c; a plan for the whole image only. */
double lc_claim_margin(const lc_session *session, const lc_claim *claim, double c);
void lc_plan_whole(lc_pyramid_plan *plan, int width, int height);
/* The same for a claim about the renderer under test, in foreign.c; LC_BAD_INPUT when it refuses the scene, or the claim asks
 * for what no image can tell. */
lc_status lc_judge_foreign(lc_row *row, lc_session *session, const lc_claim *claim, lc_error *err);
/* 1 for the estimator of the renderer under test. */
int lc_is_foreign(const lc_session *session, const lc_estimator *estimator);
void lc_foreign_free(struct lc_foreign *foreign);

/* c of an estimator of ours on the claim's scene, from the table or from a pilot. */
lc_status lc_claim_noise(double *c, lc_session *session, const lc_claim *claim, const lc_estimator *estimator,
                         lc_error *err);
/* Mean over the pixels that are not skipped, of the film or else of the expected values. */
double lc_claim_mean(const lc_film *film, const lc_expected *expected, const unsigned char *skip, int channel);
/* Share of the pixels that are not skipped; `skip` may be NULL. */
double lc_claim_share(const unsigned char *skip, int pixels);
/* An exact row that passes, for all its samples agree. Such a test has no error that a budget could bound, but a contribution that no
 * sample met is as invisible to it as to any other: the row says how large one of the run's margin has to be. `light`: the mean of what
 * is expected; of black no contribution has a size. */
void lc_row_settle(lc_row *row, const lc_session *session, double share, double light);
/* What a look found, in the hardest of three channels. */
typedef struct lc_look {
    lc_verdict verdict; /* of all channels */
    lc_pyramid hardest;
    int channel;
    double scale; /* what 1 is [radiance]: the mean of what is expected; */
    int is_dark;  /* or, as nothing is, that of what was seen */
    double share; /* of the pixels, that were not left out */
    double reach; /* the difference of the mean is this near to the one seen, by a bound beside Student's [radiance]; INFINITY: no bound */
} lc_look;

/* A film and what it is held against. */
typedef struct lc_comparison {
    const lc_film *film, *other;
    const lc_expected *expected; /* where `other` is NULL */
    const unsigned char *skip;   /* pixels that are left out; may be NULL */
    lc_pixel *const *tiles;      /* of images whose pixels may move together, see tiles.h; NULL: pixels are independent */
    double margin, tolerance;    /* relative to the mean of what it is held against */
    int is_from_files;           /* 1: both films' means were rounded to float, as EXR keeps them, once more with each merge */
} lc_comparison;

/* `field` has room for the differences of one channel. */
lc_status lc_judge_look(lc_look *out, const lc_comparison *what, lc_estimate *field, lc_pyramid_plan *plan, lc_error *err);
/* Verdict, numbers and words of the last look. */
void lc_row_conclude(lc_row *row, const lc_look *look, double alpha_pass);

/* How hard a channel was: the hardest one is shown. */
double lc_row_hardness(const lc_pyramid *p, double scale);
/* Hands the images of a row that failed to whoever asked for them, one row at a time. */
void lc_row_show(const lc_session *session, lc_row *row, lc_exhibit evidence);
/* The command line that gives the row of this claim again. */
void lc_row_reproduce(lc_row *row, const lc_verify_options *options, const lc_claim *claim);
/* Bad samples, of a film, in words. */
void lc_row_bad(lc_row *row, const lc_film *film, uint64_t seed);

#endif
