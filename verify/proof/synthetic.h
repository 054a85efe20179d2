/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * synthetic.h: pixels whose true mean is known, drawn without drawing their samples; and a loop over all cores.
 *
 * The laws are discrete, so that the counts of their values (one multinomial draw) are a sufficient statistic: n
 * samples cost one binomial draw a value, whatever n is, and mean, M2 and M3 are those that n samples would have given.
 * The mean, deviation and skewness of such a law are sums, hence exact: nothing is lost by its being a ladder of values
 * where the law that it is named after is continuous. The Gaussian law is drawn from the exact joint law of mean and
 * variance (normal and gamma, independent), and of M3 to leading order, a normal of variance 6 n; its largest sample
 * is not known.
 */
#ifndef LC_SYNTHETIC_H
#define LC_SYNTHETIC_H

#include <gsl/gsl_rng.h>
#include <stdint.h>
#include <stdio.h>

#include "core/host.h"

enum { LC_MOST_VALUES = 64 };

typedef struct lc_law {
    char name[48];
    int values; /* 0: Gaussian */
    double value[LC_MOST_VALUES], weight[LC_MOST_VALUES];
    double mean, deviation, skewness; /* of one sample */
} lc_law;

lc_law lc_law_gaussian(double mean, double deviation);
/* 1 with probability p in (0, 1), else 0, times `scale`. */
lc_law lc_law_coin(double p, double scale);
/* Quantiles of the exponential law of mean 1, down to a tail of 2^-30. */
lc_law lc_law_exponential(void);
/* Quantiles of exp(s Z), scaled to mean 1. */
lc_law lc_law_lognormal(double s);
/* 1 +- 0.1, but with probability p a bright sample worth `bright`. */
lc_law lc_law_firefly(double p, double bright);

/* A stream of its own for each (seed, experiment, trial): splitmix64 (Steele, Lea, Flood 2014) from a hash of the
 * three, in the form that GSL's distributions want. */
typedef struct lc_stream {
    gsl_rng rng;
    uint64_t state;
} lc_stream;

void lc_stream_start(lc_stream *stream, uint64_t seed, uint64_t experiment, uint64_t trial);

/* Channel 0 of the pixel becomes n >= 1 samples of scale x law + shift; other channels stay as they are. */
void lc_law_draw(lc_pixel *pixel, const lc_law *law, uint64_t n, double scale, double shift, lc_stream *stream);

/* Calls trial(user, 0 .. count - 1), each once, from one thread a core (at most 64); what each writes must be its own.
 * The order is free, so a result may depend on the number of the trial only. */
typedef void lc_trial_fn(void *user, int trial);
void lc_trials_run(lc_trial_fn *trial, void *user, int count);

/* Opens the table that a program was told to make, and heads it: what it is, the command, seed and version. NULL when
 * it cannot be written; the caller says so. */
FILE *lc_table_open(const char *path, const char *title, const char *command, uint64_t seed);
/* Closes it; 0 when all was written. */
int lc_table_close(FILE *table);

#endif
