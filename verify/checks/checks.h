/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * checks.h: a check turns (scene, estimator) into claims; the judge decides them. One file = one kind of check = one
 * line in registry.c. A claim may also be about the host itself; then it brings its own decision, and the judge only
 * gives it its share of the budget.
 */
#ifndef LC_CHECKS_H
#define LC_CHECKS_H

#include "core/host.h"

struct lc_claim;
struct lc_row;

/* What is expected of each pixel, box-filtered, row by row. */
typedef struct lc_expected {
    int width, height;
    double *rgb; /* 3 a pixel: mean radiance [W sr^-1 m^-2] */
    unsigned char *
        skip; /* 1: a silhouette or an edge of a checkerboard runs through the pixel, whose mean has no closed form: left out */
} lc_expected;

/* Fills rgb and skip, which are there already and zero. LC_WRONG: there is nothing to hold it against, a failure of the row. */
typedef lc_status lc_expect_fn(lc_expected *out, const struct lc_claim *claim, const lc_scene *scene, int threads,
                               lc_error *err);

/* What a claim that decides itself may spend. */
typedef struct lc_share {
    double false_fail, false_pass; /* probability of each, for the whole row */
    double margin;                 /* relative: what PASS has to show */
    uint64_t seed;
    uint32_t arm; /* the estimator's stream */
    int threads;
} lc_share;

/* Fills verdict, numbers and reason of a row whose names are there already. An error is one of ours, not a verdict. */
typedef lc_status lc_decide_fn(struct lc_row *row, const struct lc_claim *claim, const lc_share *share, lc_error *err);

/* "Over this scene, the mean of this estimator is ...": */
typedef struct lc_claim {
    const struct lc_check *check;
    const lc_scene *scene;
    const lc_estimator *estimator;
    int min_bounces, max_bounces;
    const lc_estimator *other; /* ... that of this one, or where NULL */
    lc_term term[LC_MAX_TERMS]; /* ... the sum of its own over these scenes, if any: a relation; or */
    int term_count;
    lc_expect_fn *expect;      /* ... these values */
    int exact;                 /* 1: sample by sample, no statistics; `other` then draws the same numbers */
    int may_be_still;   /* declared: an estimator may have no variance here, and is then held to the values exactly */
    int full_only;    /* 1: for the full suite only: too dear for the quick one, or told by another of its rows */
    double tolerance;   /* error of the expected values, relative to their mean; a difference below it is none */
    double noise;       /* in the full suite PASS waits, while there are looks, until the standard error of the mean is below this; 0: it does not */
    /* Of relations. The claims own the scenes of the terms. */
    const char *relation; /* its name, shown behind the scene's */
    int paired;           /* 1: the terms draw the same numbers; differences are tested sample by sample, and where all
                             agree to `tolerance`, that is it. 0: one term of factor 1, which draws others */
    int whole_only;       /* 1: about the mean of the whole image, not about its pixels */
    double slack;         /* the margin is this multiple of the run's; 0: 1 */
    double margin;      /* relative; 0: the run's. A wider one than the run's holds: nothing is shown closer than `tolerance` */
    const char *source; /* of what is expected, in words */
    /* A claim that is not about a mean is decided by */
    lc_decide_fn *decide; /* this; else NULL. Without a scene and an estimator it is about the host: */
    const char *subject;  /* what of it, shown in the scene's place */
} lc_claim;

typedef struct lc_claims {
    lc_claim *items;
    int count;
    lc_scene **scenes; /* made for them, by the name of the description */
    int scene_count;
} lc_claims;

typedef struct lc_check {
    const char *name, *summary, *source;
    /* Appends the claims of this kind about (scene, estimator), none where it does not apply; NULL: it never does. */
    lc_status (*plan)(const struct lc_check *self, lc_claims *claims, const lc_scene *scene,
                      const lc_estimator *estimator, lc_error *err);
    /* Appends the claims about the host, once a run; NULL where there are none. */
    lc_status (*plan_host)(const struct lc_check *self, lc_claims *claims, lc_error *err);
} lc_check;

extern const lc_check *const lc_checks[]; /* ends with NULL */

/* Direct light in closed form, over a scene whose lamps the analytic check knows. */
lc_expect_fn lc_expect_direct;
/* The light inside a sphere of any emission and albedo. */
lc_expect_fn lc_expect_inside;

/* 0 where POV-Ray renders the scene for the check of that name; else 1, and why it does not, in words. */
int lc_povray_excuse(lc_error *why, const lc_scene *scene);

/* The scene that a relation of the metamorphic check compares with, called SCENE/RELATION:TERM; the caller releases it. LC_BAD_INPUT where
 * there is no such relation, or the scene has not what it changes. */
lc_status lc_relation_scene(lc_scene_desc *out, const lc_scene_desc *from, const char *relation, int term, lc_error *err);

/* 1 for a relation that holds sample by sample, or would but for roulette: a few samples tell. The others are of the mean, in wide margins. */
int lc_relation_is_sharp(const lc_claim *claim);

/* Appends a claim of `check` with bounces 1 to 1; NULL without memory. */
lc_claim *lc_claims_add(lc_claims *claims, const lc_check *check, const lc_scene *scene, const lc_estimator *estimator);
void lc_claims_release(lc_claims *claims);
/* The scene of that name among those made for claims, or NULL. */
const lc_scene *lc_claims_scene(const lc_claims *claims, const char *name);
/* Builds one more, which is released with the claims. */
lc_status lc_claims_build(const lc_scene **out, lc_claims *claims, const lc_scene_desc *desc, lc_error *err);

/* What `estimator` may see of `scene`: its lobes and emitters, restricted to those that occur. Two estimators estimate the same integral where
 * both agree (and the bounces do). */
unsigned lc_language(const lc_scene *scene, const lc_estimator *estimator);
/* 1 when the estimator follows every lobe and reaches every emitter that occurs. */
int lc_sees_everything(const lc_scene *scene, const lc_estimator *estimator);

/* Radiance seen at a hit, and a number that changes where the radiance jumps. With value = NULL only the kind is asked for. Any thread. */
typedef lc_status lc_view_fn(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                             lc_error *err);
/* The mean of a view over each pixel, by adaptive quadrature to `tolerance` times the image's mean; pixels of more than one kind are
 * skipped. threads 0: one a core. */
lc_status lc_expect_view(lc_expected *out, lc_view_fn *view, void *user, const lc_scene *scene, double tolerance,
                         int threads, lc_error *err);

#endif
