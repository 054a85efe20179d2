/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Far tails of means of a known law; see law_tail.h. */
#include "verify/proof/law_tail.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "verify/stats/stats.h"

/* ---- the mean ------------------------------------------------------------------------------------------------ */

/* ln E exp(s (X - mean) / deviation), and its first two derivatives. */
static void cumulants(double out[3], const lc_law *law, double s)
{
    double sum[3] = {0, 0, 0}, top = -INFINITY;
    for (int i = 0; i < law->values; ++i)
        top = fmax(top, s * (law->value[i] - law->mean) / law->deviation);
    for (int i = 0; i < law->values; ++i) {
        double x = (law->value[i] - law->mean) / law->deviation, w = law->weight[i] * exp(s * x - top);
        sum[0] += w;
        sum[1] += w * x;
        sum[2] += w * x * x;
    }
    out[0] = top + log(sum[0]);
    out[1] = sum[1] / sum[0];
    out[2] = sum[2] / sum[0] - out[1] * out[1];
}

/* The tilt s > 0, on this side, under which the mean lies x > 0 deviations off; NAN beyond the largest or smallest value. */
static double saddlepoint(const lc_law *law, double x, int sign)
{
    double low = 0, high = 1, k[3];
    for (cumulants(k, law, sign * high); sign * k[1] < x && high < 1e6; cumulants(k, law, sign * high))
        high *= 2;
    if (sign * k[1] < x)
        return NAN;
    for (int i = 0; i < 60; ++i) {
        double s = 0.5 * (low + high);
        cumulants(k, law, sign * s);
        if (sign * k[1] < x)
            low = s;
        else
            high = s;
    }
    return high;
}

/* ln P(mean of n samples beyond z standard errors, z > 0, on the side `sign`), by Lugannani and Rice. */
static double law_log_tail(const lc_law *law, double n, double z, int sign)
{
    if (law->values == 0)
        return lc_normal_log_sf(z);
    double x = z / sqrt(n), s = saddlepoint(law, x, sign), k[3];
    if (isnan(s))
        return -INFINITY;
    cumulants(k, law, sign * s);
    double r = sqrt(2 * n * (s * x - k[0])), u = s * sqrt(n * k[2]);
    double log_tail = lc_normal_log_sf(r), log_density = -0.5 * r * r - 0.91893853320467274178;
    return log_tail + log1p((1 / u - 1 / r) * exp(log_density - log_tail));
}

static double saddlepoint_quantile(const lc_law *law, double n, double alpha, int sign)
{
    double low = 0.5, high = 60;
    for (int i = 0; i < 50; ++i) {
        double z = 0.5 * (low + high);
        if (law_log_tail(law, n, z, sign) > log(alpha))
            low = z;
        else
            high = z;
    }
    return high;
}

/* ---- by importance sampling -------------------------------------------------------------------------------------- */

enum { DRAWS = 4096 };

/* Samples from which on skewness is of no account, and which a draw can count. */
static const double MANY = 0x1p30;

typedef struct tilted_draw {
    double t, weight; /* weight: the likelihood ratio */
} tilted_draw;

typedef struct tilt_case {
    const lc_law *law;
    lc_law tilted;
    double n, h, square, log_norm; /* log_norm: ln E exp(h x - square x^2) */
    int sign, studentised;
    tilted_draw *draws;
} tilt_case;

static void draw_tilted(void *user, int trial)
{
    tilt_case *c = user;
    lc_stream stream;
    lc_pixel pixel;
    memset(&pixel, 0, sizeof pixel);
    lc_stream_start(&stream, (uint64_t)c->n, 9000, (uint64_t)trial);
    lc_law_draw(&pixel, &c->tilted, (uint64_t)c->n, 1, 0, &stream);
    double mean = c->sign * (pixel.c[0].mean - c->law->mean) / c->law->deviation;
    double m2 = pixel.c[0].m2 / pow(c->law->deviation, 2), squares = m2 + c->n * mean * mean;
    if (c->studentised)
        c->draws[trial].t = m2 > 0 ? mean / sqrt(m2 / (c->n * (c->n - 1))) : 0;
    else
        c->draws[trial].t = mean * sqrt(c->n);
    c->draws[trial].weight = exp(c->n * (c->log_norm - c->h * mean) + c->square * squares);
}

static int by_t_falling(const void *left, const void *right)
{
    double a = ((const tilted_draw *)left)->t, b = ((const tilted_draw *)right)->t;
    return (a < b) - (a > b);
}

/* The value that is passed with probability alpha, when samples are drawn with weights times exp(h x - square x^2). */
static double tilted_quantile(tilt_case *c, double alpha)
{
    const lc_law *law = c->law;
    tilted_draw draws[DRAWS];
    double sum = 0, tail = 0;
    c->draws = draws;
    c->tilted = *law;
    for (int i = 0; i < law->values; ++i) {
        double x = c->sign * (law->value[i] - law->mean) / law->deviation;
        sum += c->tilted.weight[i] = law->weight[i] * exp(c->h * x - c->square * x * x);
    }
    c->log_norm = log(sum);
    c->tilted.mean = 0;
    for (int i = 0; i < law->values; ++i) {
        c->tilted.weight[i] /= sum;
        c->tilted.mean += c->tilted.weight[i] * law->value[i];
    }
    lc_trials_run(draw_tilted, c, DRAWS);
    qsort(draws, DRAWS, sizeof *draws, by_t_falling);
    for (int i = 0; i < DRAWS; ++i)
        if ((tail += draws[i].weight / DRAWS) > alpha)
            return draws[i].t * (1 + 1e-9); /* equal values are one step of a lattice, and all of them lie within */
    return INFINITY;
}

double lc_law_mean_quantile(const lc_law *law, double n, double alpha, int sign)
{
    double z = saddlepoint_quantile(law, n, alpha, sign);
    if (law->values == 0 || n > MANY)
        return z;
    double h = saddlepoint(law, z / sqrt(n), sign);
    tilt_case c = {.law = law, .n = n, .h = h, .sign = sign};
    return h < 1e5 ? tilted_quantile(&c, alpha) : z; /* else at the end of what the law can give */
}

double lc_law_student_quantile(const lc_law *law, double n, double alpha, int sign)
{
    if (law->values == 0)
        return NAN;
    double z = lc_normal_quantile(alpha);
    tilt_case c = {.law = law, .n = n, .h = z / sqrt(n), .square = 0.5 * z * z / n, .sign = sign, .studentised = 1};
    return n > MANY ? z : tilted_quantile(&c, alpha);
}
