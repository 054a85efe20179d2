/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * pyramid.h: where in an image is a difference, at any scale? And how the error budget of a run is shared out.
 *
 * Level l of the pyramid has tiles of 2^l x 2^l pixels, clipped at the right and lower edge; level 0 is the pixels, the
 * last is the whole image. A level gets an equal share of alpha_fail, a tile an equal share of its level's (Bonferroni
 * over ALL tiles of the level, tested or not, so that the number does not depend on the outcome). alpha_pass is not
 * split: PASS needs every tile of every declared level to be within the level's margin (an intersection-union test;
 * Berger, Technometrics 24, 1982).
 */
#ifndef LC_PYRAMID_H
#define LC_PYRAMID_H

#include <stddef.h>
#include <stdint.h>

#include "core/host.h"
#include "verify/stats/estimate.h"

/* ---- the budget of a run ------------------------------------------------------------------------------- */

typedef struct lc_budget {
    double fail, pass; /* probability of any false FAIL, and of any false PASS at the margin, in the whole run: 1e-6 */
    int rows;          /* of the table of checks */
    int channels;      /* 3 */
    int looks;         /* most looks of a row */
} lc_budget;

/* Shares of one channel of one row at one look: fail / (rows channels looks); pass / (rows looks), since all channels
 * must pass. NaN when the budget makes no sense (counts below 1, probabilities outside (0, 1)). Looks share equally:
 * Bonferroni holds however they correlate, and one look more costs some 1% more samples at six sigma. */
double lc_budget_row_fail(const lc_budget *budget);
double lc_budget_row_pass(const lc_budget *budget);

/* Writes the split as text for a report, one line a level, ending in a newline; returns the length as snprintf does. */
int lc_budget_text(char *text, size_t size, const lc_budget *budget, int width, int height);

/* ---- looks ------------------------------------------------------------------------------------------------ */

enum { LC_MOST_LOOKS = 5 };

/* Samples a pixel of each look, rising, each whole blocks of LC_BLOCK. */
typedef struct lc_looks {
    uint64_t samples[LC_MOST_LOOKS];
    int count; /* from 1 */
} lc_looks;

/* 1/5, 2/5, 3/5 and all of the planned samples, and four times as much in reserve; none below LC_LEAST_SAMPLES, and none beyond
 * `most` but for the first. The plan leaves room for a mean 5 standard errors off; most are within one or two, and pass at
 * 2/5 (two rows in three) or 3/5 (98 in 100). One look more or less costs hardly anything: five are paid for at 1% more
 * samples than one of them would need. */
lc_looks lc_looks_plan(uint64_t planned, uint64_t most);
/* Looks that the floor made one of several, which are paid for, become reserve: each has four times the samples of the one before,
 * while that is at most `most`. For rows whose pilot cannot tell how many they need. */
void lc_looks_reserve(lc_looks *looks, uint64_t most);
/* Samples in all to decide a relative margin > 0 when a sample's standard deviation is c times the mean, with z =
 * z(alpha) + z(power): (c z / margin)^2. z = 11 leaves hardly any row undecided. */
double lc_samples_needed(double c, double margin, double z);

/* ---- the pyramid -------------------------------------------------------------------------------------------- */

enum { LC_LEVELS = 15 }; /* 2^14 = LC_MAX_SIZE */

/* Whose skewness a test is guarded by. OWN: the tile's. POOLED: also that of an average tile of its size in the image, and
 * in each of the larger tiles around it that it may have missed the rare samples of, because a tile whose rare bright
 * samples were never hit has a small mean, a small variance AND a small skewness; the tiles that were hit know better. Of
 * each, and of the image with all pixels equally bright, since in its sums the variance of a bright part would hide the rare
 * samples of a dim one; and not where so many samples make up the skewness of the larger tile that none of its parts can have missed them. POOLED is the rule;
 * OWN is for fields whose tiles have nothing in common. */
typedef enum lc_guard { LC_GUARD_POOLED, LC_GUARD_OWN } lc_guard;

typedef struct lc_pyramid_plan {
    double alpha_fail, alpha_pass; /* of this pyramid */
    double margin[LC_LEVELS];      /* radiance, > 0; INFINITY: this level is not declared */
    double relative; /* the margins are this multiple of arm b's measured mean, whose noise then enters PASS: a - (1 +- m)
                        b has the variance of a and (1 + m)^2 that of b; 0: they are constants */
    uint64_t least[LC_LEVELS];     /* samples a pixel from which on the level takes part */
    lc_guard guard;
} lc_pyramid_plan;

/* No level declared, LC_LEAST_SAMPLES everywhere, LC_GUARD_POOLED. */
void lc_pyramid_plan_init(lc_pyramid_plan *plan, double alpha_fail, double alpha_pass);
/* Number of levels, 1 + ceil(log2(max(width, height))); the whole image is level lc_pyramid_levels() - 1. 0 when the
 * size is out of [1, LC_MAX_SIZE]. */
int lc_pyramid_levels(int width, int height);

typedef struct lc_tile {
    int level, x, y, width, height; /* upper left corner and size [pixels] */
    lc_student student;             /* means over the tile, guarded */
    double log_p; /* ln of the p value for "|difference| <= tolerance", corrected for both sides, all tiles and all
                     levels: FAIL at p <= alpha_fail; at most 0; NaN when the tile could not be tested */
} lc_tile;

typedef struct lc_level {
    uint32_t tiles;
    uint32_t tested;             /* against FAIL, on the side where the difference lies */
    uint32_t few, still, skewed; /* not tested: too few samples, an arm without variance, heavy tails */
    double alpha;                /* two-sided level of one tile */
    int within;                  /* declared, and every tile shown to be within the margin */
} lc_level;

typedef struct lc_pyramid {
    lc_verdict verdict;
    int levels;
    lc_level level[LC_LEVELS];
    lc_tile whole;    /* the image */
    lc_tile worst;    /* of the smallest p; level -1 when nothing could be tested */
    lc_tile blocking; /* one not shown to be within its margin, on the coarsest level that has one; level -1: none */
} lc_pyramid;

/* Judges a width x height field row by row; allocates nothing, any thread. LC_BAD_INPUT, naming the pixel, when a
 * number is NaN, infinite or a variance below 0; or when alphas, margins or sizes are out of range. */
lc_status lc_pyramid_judge(lc_pyramid *out, const lc_estimate *field, int width, int height,
                           const lc_pyramid_plan *plan, lc_error *err);

#endif
