/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * rules.h: how others decide that an image is wrong, written anew from their sources and papers, to be put beside ours
 * on the same samples. A rule is brought to a given false-failure rate `alpha` in the way that leaves most of it as it
 * was published; where the published form has a rate of its own, it is kept beside as a rule of its own.
 */
#ifndef LC_RULES_H
#define LC_RULES_H

#include "verify/proof/synthetic.h"
#include "verify/stats/stats.h"

enum { LC_RULE_SIDE = 64, LC_RULE_PIXELS = LC_RULE_SIDE * LC_RULE_SIDE };

/* Thresholds, computed once for a law, a number of samples and a rate. */
typedef struct lc_limits {
    double alpha;
    double mean_z;                                /* of one two-sided normal test */
    double published_z, quorum_z[2], strict_z[2]; /* Mitsuba; [0] a pixel too dark, [1] too bright */
    double sidak_log_p[3], ks[3];                 /* Jung: tiles of 32, 8, 1 pixels a side */
    double sidak_t[3][2];                         /* of a law that is not Gaussian, as quorum_z; else NaN */
} lc_limits;

void lc_limits_init(lc_limits *limits, double alpha, const lc_law *law, double samples);

/* A 64 x 64 image of `samples` a pixel and arm, whose true mean is 1 everywhere. */
typedef struct lc_evidence {
    const lc_estimate *field;
    int arms;
    double samples;
    double deviation; /* of a sample, exactly: rules that take the reference's variance get a perfect reference */
    const lc_limits *limits;
} lc_evidence;

typedef struct lc_rule {
    const char *name;
    int two_films;  /* 1: applies to two films as well as to one film and exact values */
    int equal_rate; /* 0: as published, at its own false-failure rate */
    int (*fails)(const lc_evidence *evidence);
} lc_rule;

extern const lc_rule lc_rules[];        /* the last is ours, then name = NULL */
extern const char *const lc_rule_notes; /* sources, and how each was brought to an equal rate */

#endif
