/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Variances: of two films, and between batches against within; see stats.h. */
#include <math.h>

#include "verify/stats/stats.h"

lc_spread lc_spread_of_film(const lc_film *film, int channel, double excess_kurtosis)
{
    size_t count = (size_t)film->width * (size_t)film->height;
    double sum = 0, squares = 0, deflate = 1 + 0.5 * excess_kurtosis / LC_BLOCK;
    long pixels = 0;
    for (size_t i = 0; i < count; ++i) {
        const lc_pixel *p = &film->pixels[i];
        if (p->batches < 2)
            continue;
        double df = (double)p->batches - 1, v = LC_BLOCK * p->c[channel].batch_m2 / df;
        sum += v;
        squares += v * v / df;
        ++pixels;
    }
    lc_spread spread = {NAN, NAN, pixels};
    if (pixels > 0) {
        spread.variance = sum / (double)pixels;
        spread.df = sum * sum / squares / deflate;
    }
    return spread;
}

/* ln of twice the smaller tail of F, at most 0. */
static double two_sided_log_p(double f, double d1, double d2)
{
    double upper = lc_f_log_sf(f, d1, d2), lower = lc_f_log_sf(1 / f, d2, d1);
    double log_p = (upper < lower ? upper : lower) + log(2);
    return log_p > 0 ? 0 : log_p;
}

lc_ratio lc_variance_ratio(const lc_spread *a, const lc_spread *b, double alpha)
{
    lc_ratio r = {NAN, {NAN, NAN}, NAN};
    if (!(a->variance > 0 && b->variance > 0 && a->df > 0 && b->df > 0 && alpha > 0 && alpha < 1))
        return r;
    r.ratio = a->variance / b->variance;
    r.bounds.lower = r.ratio / lc_f_quantile(0.5 * alpha, a->df, b->df);
    r.bounds.upper = r.ratio * lc_f_quantile(0.5 * alpha, b->df, a->df);
    r.log_p = two_sided_log_p(r.ratio, a->df, b->df);
    return r;
}

lc_batches lc_batches_of_size(const lc_film *film, int channel, uint64_t size)
{
    size_t count = (size_t)film->width * (size_t)film->height;
    double between = 0, within = 0, total = 0, squares[2] = {0, 0};
    lc_batches out = {NAN, {NAN, NAN}, NAN, 0};
    for (size_t i = 0; i < count; ++i) {
        const lc_pixel *p = &film->pixels[i];
        const lc_moments *m = &p->c[channel];
        if (p->batches < 2 || p->n != p->batches * size || !(m->m2 > 0))
            continue;
        double n = (double)p->n, b = (double)p->batches, v = m->m2 / (n - 1);
        double among = (double)size * m->batch_m2;
        between += among / (b - 1);
        within += fmax(0, m->m2 - among) / (n - b); /* rounding may take it below 0 */
        total += v;
        squares[0] += v * v / (b - 1);
        squares[1] += v * v / (n - b);
        ++out.pixels;
    }
    if (out.pixels == 0)
        return out;
    out.ratio = between / within;
    out.df[0] = total * total / squares[0];
    out.df[1] = total * total / squares[1];
    out.log_p = two_sided_log_p(out.ratio, out.df[0], out.df[1]);
    return out;
}

lc_batches lc_batches_of_film(const lc_film *film, int channel) { return lc_batches_of_size(film, channel, LC_BLOCK); }

int lc_batches_depend(const lc_batches *b, double alpha)
{
    const double least_df = 100;
    return b->pixels > 0 && b->df[0] >= least_df && b->log_p <= 2 * log(alpha);
}
