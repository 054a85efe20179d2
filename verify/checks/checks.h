/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * checks.h: a check turns (scene, estimator) into claims; the judge decides them. One file = one kind of check = one line in registry.c.
 */
#ifndef LC_CHECKS_H
#define LC_CHECKS_H

#include "core/host.h"

struct lc_claim;

/* Fills width x height x 3 expected means (radiance, box-filtered over each pixel), row by row. */
typedef lc_status lc_expect_fn(double *rgb, const struct lc_claim *claim, const lc_scene *scene, int width, int height, lc_error *err);

/* "Over this scene, the mean of this estimator is ...": */
typedef struct lc_claim {
    const struct lc_check *check;
    const lc_scene *scene;
    const lc_estimator *estimator;
    int min_bounces, max_bounces;
    const lc_estimator *other; /* ... that of this one, or where NULL */
    lc_expect_fn *expect;      /* ... these values */
    int exact;                 /* 1: sample by sample, no statistics; `other` then draws the same numbers */
    double tolerance;          /* error of the expected values, relative to their mean; a difference below it is none */
    const char *source;        /* of what is expected, in words */
} lc_claim;

typedef struct lc_claims {
    lc_claim *items;
    int count;
} lc_claims;

typedef struct lc_check {
    const char *name, *summary, *source;
    /* Appends the claims of this kind about (scene, estimator); none where it does not apply. */
    lc_status (*plan)(const struct lc_check *self, lc_claims *claims, const lc_scene *scene, const lc_estimator *estimator, lc_error *err);
} lc_check;

extern const lc_check *const lc_checks[]; /* ends with NULL */

/* Appends a claim of `check` with bounces 1 to 1; NULL without memory. */
lc_claim *lc_claims_add(lc_claims *claims, const lc_check *check, const lc_scene *scene, const lc_estimator *estimator);
void lc_claims_release(lc_claims *claims);

/* What `estimator` may see of `scene`: its lobes and emitters, restricted to those that occur. Two estimators estimate the same integral where
 * both agree (and the bounces do). */
unsigned lc_language(const lc_scene *scene, const lc_estimator *estimator);
/* 1 when the estimator follows every lobe and reaches every emitter that occurs. */
int lc_sees_everything(const lc_scene *scene, const lc_estimator *estimator);

/* The mean of a function over a pixel, by Gauss-Legendre nodes, the pixel cut in four (down to 1/64) where `kind` differs inside it.
 * `value` gives the radiance seen along the camera ray through (x, y), and a number that changes across discontinuities. */
typedef lc_status lc_view_fn(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user, lc_error *err);
lc_status lc_expect_view(double *rgb, lc_view_fn *view, void *user, const lc_scene *scene, int width, int height, lc_error *err);

#endif
