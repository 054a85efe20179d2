/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * diagnose.h: which bug an estimator has. Its films over a handful of scenes are compared with those of every mutant that speaks the same
 * language, by the judge's own test of equality. A mutant's name is given only where it alone is shown equal, on scenes that show the
 * truth to be something else, and all other mutants are shown different. Otherwise the fingerprint says what was measured.
 */
#ifndef LC_DIAGNOSE_H
#define LC_DIAGNOSE_H

#include "verify/judge/judge.h"
#include "verify/mutants/registry.h"

enum { LC_MOST_VIEWS = 40, LC_MOST_CANDIDATES = 64, LC_MOST_LINES = 8 };

typedef enum lc_sight {
    LC_SIGHT_NONE,      /* not compared */
    LC_SIGHT_OPEN,      /* neither is shown */
    LC_SIGHT_EQUAL,     /* within the margin */
    LC_SIGHT_DIFFERENT
} lc_sight;

/* estimate / truth as powers of: the cosine at the surface, that at the lamp, the distance, the cosine with the viewer. */
enum { LC_ANGLE_POWERS = 4 };
typedef struct lc_angle_fit {
    int is_good; /* it explains all pixels */
    double power[LC_ANGLE_POWERS], error[LC_ANGLE_POWERS];
} lc_angle_fit;

/* What was seen of the estimator against the truth, at one scene and depth. */
typedef struct lc_view_result {
    char scene[64];
    int min_bounces, max_bounces;
    int size, light; /* lengths and emission are 2^this times those of the scene's file */
    int lights;
    lc_sight sight;
    int is_black, truth_is_black;   /* not one sample carried light */
    double low[3], high[3];         /* interval of estimate / truth a channel, at six sigma; NAN where the truth is black */
    int tile_x, tile_y, tile_width; /* the worst tile; width 0: none */
    double albedo[3];               /* of all surfaces that the camera sees; NAN where they differ */
    lc_angle_fit angles;            /* of views of one lamp where the estimate is wrong */
} lc_view_result;

typedef struct lc_diagnosis {
    const lc_estimator *truth;
    int is_wrong;                                /* shown different from the truth somewhere, or its noise is wrong */
    const lc_mutant *names[LC_MOST_CANDIDATES];  /* equal wherever they were compared; one: that is the bug */
    int name_count;
    int is_certain;                              /* each other candidate was shown different */
    int candidates;
    int has_bad;                                 /* NaN, infinite, negative or huge samples */
    int repeats;                                 /* its samples depend on each other */
    lc_view_result views[LC_MOST_VIEWS];
    int view_count;
    char lines[LC_MOST_LINES][240];              /* the fingerprint, in words */
    int line_count;
    uint64_t paths;
} lc_diagnosis;

typedef struct lc_diagnose_options {
    uint64_t seed;
    int threads; /* 0: one a core */
} lc_diagnose_options;

/* LC_BAD_INPUT when no estimator of the registry has this one's lobes, emitters and depth. Deterministic. */
lc_status lc_diagnose(lc_diagnosis *out, const lc_estimator *subject, const lc_diagnose_options *options,
                      lc_load_scene_fn *load, lc_error *err);
/* The fit under the scene's only lamp, a rectangle; not good where there is another. */
void lc_fit_angles(lc_angle_fit *out, const lc_scene *scene, const lc_film *film, const lc_film *truth);
/* Fills `lines` from what the views say. */
void lc_diagnose_fingerprint(lc_diagnosis *diagnosis);

#endif
