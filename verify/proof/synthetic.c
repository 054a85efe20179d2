/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Laws, streams and threads of the proofs; see synthetic.h. */
#include "verify/proof/synthetic.h"

#include <gsl/gsl_randist.h>
#include <math.h>
#include <pthread.h>
#include <string.h>
#include <unistd.h>

#include "verify/stats/tails.h"

/* ---- laws ------------------------------------------------------------------------------------------------- */

static void finish(lc_law *law)
{
    double total = 0, second = 0, third = 0;
    for (int i = 0; i < law->values; ++i)
        total += law->weight[i];
    law->mean = 0;
    for (int i = 0; i < law->values; ++i) {
        law->weight[i] /= total;
        law->mean += law->weight[i] * law->value[i];
    }
    for (int i = 0; i < law->values; ++i) {
        double d = law->value[i] - law->mean;
        second += law->weight[i] * d * d;
        third += law->weight[i] * d * d * d;
    }
    law->deviation = sqrt(second);
    law->skewness = third / (second * law->deviation);
}

static void scale_to_mean_one(lc_law *law)
{
    finish(law);
    for (int i = 0; i < law->values; ++i)
        law->value[i] /= law->mean;
    finish(law);
}

lc_law lc_law_gaussian(double mean, double deviation)
{
    lc_law law;
    memset(&law, 0, sizeof law);
    snprintf(law.name, sizeof law.name, "Gaussian, c = %g", deviation / mean);
    law.mean = mean;
    law.deviation = deviation;
    return law;
}

lc_law lc_law_coin(double p, double scale)
{
    lc_law law;
    memset(&law, 0, sizeof law);
    law.values = 2;
    law.value[1] = scale;
    law.weight[0] = 1 - p;
    law.weight[1] = p;
    finish(&law);
    snprintf(law.name, sizeof law.name, "coin, p = %g", p);
    return law;
}

/* Steps of equal probability in the middle, halving ones in the upper tail; each stands for its median. */
static int quantile_steps(double *upper, double *weight)
{
    enum { EQUAL = 16, HALVING = 26 };
    int count = 0;
    for (int i = 0; i < EQUAL - 1; ++i) {
        upper[count] = 1 - (i + 0.5) / EQUAL;
        weight[count++] = 1.0 / EQUAL;
    }
    double left = 1.0 / EQUAL;
    for (int i = 0; i < HALVING; ++i, left /= 2) {
        upper[count] = left * (i + 1 < HALVING ? 0.75 : 0.5);
        weight[count++] = i + 1 < HALVING ? left / 2 : left;
    }
    return count;
}

lc_law lc_law_exponential(void)
{
    lc_law law;
    double upper[LC_MOST_VALUES];
    memset(&law, 0, sizeof law);
    law.values = quantile_steps(upper, law.weight);
    for (int i = 0; i < law.values; ++i)
        law.value[i] = -log(upper[i]);
    scale_to_mean_one(&law);
    snprintf(law.name, sizeof law.name, "exponential");
    return law;
}

lc_law lc_law_lognormal(double s)
{
    lc_law law;
    double upper[LC_MOST_VALUES];
    memset(&law, 0, sizeof law);
    law.values = quantile_steps(upper, law.weight);
    for (int i = 0; i < law.values; ++i)
        law.value[i] = exp(s * lc_normal_quantile(upper[i]));
    scale_to_mean_one(&law);
    snprintf(law.name, sizeof law.name, "lognormal, s = %g", s);
    return law;
}

lc_law lc_law_firefly(double p, double bright)
{
    lc_law law;
    memset(&law, 0, sizeof law);
    law.values = 3;
    law.value[0] = 0.9;
    law.value[1] = 1.1;
    law.value[2] = bright;
    law.weight[0] = law.weight[1] = (1 - p) / 2;
    law.weight[2] = p;
    finish(&law);
    snprintf(law.name, sizeof law.name, "firefly, p = %g, worth %g", p, bright);
    return law;
}

/* ---- streams ---------------------------------------------------------------------------------------------- */

static uint64_t mix(uint64_t z)
{
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static uint64_t next(void *state)
{
    uint64_t *s = state;
    return mix(*s += 0x9e3779b97f4a7c15u);
}

static void set(void *state, unsigned long seed) { *(uint64_t *)state = seed; }
static unsigned long get(void *state) { return (unsigned long)(next(state) >> 32); }
static double get_double(void *state) { return (double)(next(state) >> 11) * 0x1p-53; }

static const gsl_rng_type splitmix = {"splitmix64", 0xffffffffu, 0, sizeof(uint64_t), set, get, get_double};

void lc_stream_start(lc_stream *stream, uint64_t seed, uint64_t experiment, uint64_t trial)
{
    stream->state = mix(mix(mix(seed + 1) + experiment + 1) + trial + 1);
    stream->rng.type = &splitmix;
    stream->rng.state = &stream->state;
}

/* ---- pixels ----------------------------------------------------------------------------------------------- */

static lc_moments draw_gaussian(const lc_law *law, double n, gsl_rng *rng)
{
    lc_moments m = {0, 0, 0, 0, 0, 0};
    double variance = law->deviation * law->deviation;
    m.mean = law->mean + law->deviation * gsl_ran_gaussian_ziggurat(rng, 1) / sqrt(n);
    m.m2 = n > 1 ? variance * 2 * gsl_ran_gamma(rng, 0.5 * (n - 1), 1) : 0;
    m.m3 = variance * law->deviation * gsl_ran_gaussian_ziggurat(rng, 1) * sqrt(6 * n);
    return m;
}

static lc_moments draw_discrete(const lc_law *law, uint64_t n, gsl_rng *rng)
{
    lc_moments m = {0, 0, 0, 0, 0, 0};
    unsigned left = (unsigned)n, count[LC_MOST_VALUES] = {0};
    double rest = 1, sum = 0;
    int only = -1;
    for (int i = 0; i < law->values && left > 0; ++i) {
        int last = i == law->values - 1 || law->weight[i] >= rest;
        count[i] = last ? left : gsl_ran_binomial(rng, law->weight[i] / rest, left);
        rest -= law->weight[i];
        left -= count[i];
        m.max = count[i] && law->value[i] > m.max ? law->value[i] : m.max;
        sum += count[i] * (law->value[i] - law->mean);
        only = count[i] == n ? i : only;
    }
    if (only >= 0) { /* equal samples have no variance at all, not even by rounding */
        m.mean = law->value[only];
        return m;
    }
    double offset = sum / (double)n;
    m.mean = law->mean + offset;
    for (int i = 0; i < law->values; ++i) {
        double d = law->value[i] - law->mean - offset, square = count[i] * d * d;
        m.m2 += square;
        m.m3 += square * d;
    }
    return m;
}

void lc_law_draw(lc_pixel *pixel, const lc_law *law, uint64_t n, double scale, double shift, lc_stream *stream)
{
    lc_moments m = law->values ? draw_discrete(law, n, &stream->rng) : draw_gaussian(law, (double)n, &stream->rng);
    m.mean = scale * m.mean + shift;
    m.max = m.max > 0 ? fmax(scale * m.max + shift, 0) : 0;
    m.m2 *= scale * scale;
    m.m3 *= scale * scale * scale;
    pixel->n = n;
    pixel->c[0] = m;
}

/* ---- trials ----------------------------------------------------------------------------------------------- */

typedef struct pool {
    lc_trial_fn *trial;
    void *user;
    int count, next;
    pthread_mutex_t lock;
} pool;

static void *work(void *argument)
{
    pool *p = argument;
    for (;;) {
        pthread_mutex_lock(&p->lock);
        int trial = p->next < p->count ? p->next++ : -1;
        pthread_mutex_unlock(&p->lock);
        if (trial < 0)
            return NULL;
        p->trial(p->user, trial);
    }
}

void lc_trials_run(lc_trial_fn *trial, void *user, int count)
{
    pool p = {trial, user, count, 0, PTHREAD_MUTEX_INITIALIZER};
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    int helpers = (int)(cores < 1 ? 1 : cores > 64 ? 64 : cores) - 1, started = 0;
    pthread_t threads[64];
    while (started < helpers && pthread_create(&threads[started], NULL, work, &p) == 0)
        ++started;
    work(&p);
    for (int i = 0; i < started; ++i)
        pthread_join(threads[i], NULL);
}

/* ---- tables ----------------------------------------------------------------------------------------------- */

FILE *lc_table_open(const char *path, const char *title, const char *command, uint64_t seed)
{
    FILE *table = fopen(path, "w");
    if (table)
        fprintf(
            table,
            "# %s\n\nMade by `%s`, seed %llu, lightcheck %s. The numbers depend on nothing else: not on the machine's\n"
            "speed or number of cores.\n",
            title, command, (unsigned long long)seed, LC_VERSION);
    return table;
}

int lc_table_close(FILE *table)
{
    int broken = ferror(table);
    return fclose(table) != 0 || broken ? -1 : 0;
}
