/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tails of distributions and their inverses; see tails.h. */
#include "verify/stats/tails.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_sf_erf.h>
#include <gsl/gsl_sf_gamma.h>
#include <math.h>

#include "core/lightcheck.h"

static const double LN2 = 0.69314718055994530942;
static const double TINY = 1e-300; /* keeps Lentz's quotients from 0 / 0 */
enum { FRACTION_STEPS = 1000000 }; /* beta needs O(sqrt(a + b)) */
static const double FRACTION_ERROR = 1e-15;

static int is_probability(double alpha) { return alpha > 0 && alpha < 1; }

/* ln(1 - exp(x)), x <= 0, without cancellation (Maechler 2012). */
static double log_complement(double x) { return x > -LN2 ? log(-expm1(x)) : log1p(-exp(x)); }

double lc_normal_log_sf(double z)
{
    if (isnan(z))
        return NAN;
    if (isinf(z))
        return z > 0 ? -INFINITY : 0;
    return gsl_sf_log_erfc(z * sqrt(0.5)) - LN2;
}

double lc_normal_quantile(double alpha) { return is_probability(alpha) ? gsl_cdf_ugaussian_Qinv(alpha) : NAN; }

/* The continued fraction of DLMF 8.17.22 by Lentz's method as modified by Thompson and Barnett (1986). */
static double beta_fraction(double x, double a, double b)
{
    double c = 1, d = 1 - (a + b) * x / (a + 1);
    d = 1 / (fabs(d) < TINY ? TINY : d);
    double f = d;
    for (int i = 1; i <= FRACTION_STEPS; ++i) {
        double m = i;
        double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        double step = 1;
        for (int k = 0; k < 2; ++k) {
            double term = k == 0 ? even : odd;
            d = 1 + term * d;
            d = 1 / (fabs(d) < TINY ? TINY : d);
            c = 1 + term / c;
            c = fabs(c) < TINY ? TINY : c;
            f *= c * d;
            step = c * d;
        }
        if (fabs(step - 1) < FRACTION_ERROR)
            return f;
    }
    return NAN;
}

/* ln I_x(a, b) where the fraction converges fast: x <= (a + 1) / (a + b + 2). */
static double beta_log_tail(double x, double y, double a, double b)
{
    double log_x = y < 0.5 ? log1p(-y) : log(x);
    double log_y = x < 0.5 ? log1p(-x) : log(y);
    return a * log_x + b * log_y - log(a) - gsl_sf_lnbeta(a, b) + log(beta_fraction(x, a, b));
}

double lc_beta_log_cdf(double x, double y, double a, double b)
{
    if (!(a > 0 && b > 0 && x >= 0 && y >= 0))
        return NAN;
    if (x == 0)
        return -INFINITY;
    if (y == 0)
        return 0;
    if (x <= (a + 1) / (a + b + 2))
        return beta_log_tail(x, y, a, b);
    return log_complement(beta_log_tail(y, x, b, a));
}

double lc_beta_quantile_logit(double alpha, double a, double b)
{
    if (!(is_probability(alpha) && a > 0 && b > 0))
        return NAN;
    double target = log(alpha), low = -745, high = 745;
    for (int i = 0; i < 70; ++i) {
        double s = 0.5 * (low + high);
        if (lc_beta_log_cdf(1 / (1 + exp(-s)), 1 / (1 + exp(s)), a, b) < target)
            low = s;
        else
            high = s;
    }
    return 0.5 * (low + high);
}

double lc_t_log_sf(double t, double df)
{
    if (isnan(t) || !(df > 0))
        return NAN;
    if (isinf(df) || isinf(t))
        return lc_normal_log_sf(t);
    if (t < 0)
        return log_complement(lc_t_log_sf(-t, df));
    double ratio = t * t / df;
    if (isinf(ratio)) /* the leading term of the tail, t^-df */
        return -df * (log(t) - 0.5 * log(df)) - log(df) - gsl_sf_lnbeta(0.5 * df, 0.5);
    double x = 1 / (1 + ratio), y = ratio / (1 + ratio);
    return lc_beta_log_cdf(x, y, 0.5 * df, 0.5) - LN2;
}

double lc_t_quantile(double alpha, double df)
{
    if (!(is_probability(alpha) && df > 0))
        return NAN;
    double z = lc_normal_quantile(alpha);
    if (isinf(df) || z == 0)
        return z;
    if (alpha > 0.5)
        return -lc_t_quantile(1 - alpha, df);
    /* ln P is concave in s = ln t: Newton's method comes from the right without overshooting after its first step. */
    double target = log(alpha), log_norm = gsl_sf_lnbeta(0.5 * df, 0.5) + 0.5 * log(df);
    double s = 0.5 * log(df * expm1(fmin(z * z / df, 600)));
    for (int i = 0; i < 200; ++i) {
        double t = exp(s), log_p = lc_t_log_sf(t, df);
        double ratio = t * t / df, log_ratio = isinf(ratio) ? 2 * s - log(df) : log1p(ratio);
        double log_density = -log_norm - 0.5 * (df + 1) * log_ratio;
        double step = (log_p - target) * exp(log_p - log_density - s);
        s += fmax(-20, fmin(20, step));
        if (fabs(step) < 1e-13 * fmax(1, fabs(s)))
            break;
    }
    return exp(s);
}

double lc_f_log_sf(double f, double d1, double d2)
{
    if (!(f >= 0 && d1 > 0 && d2 > 0))
        return NAN;
    double odds = f * d1 / d2;
    if (isinf(odds))
        return -INFINITY;
    return lc_beta_log_cdf(1 / (1 + odds), odds / (1 + odds), 0.5 * d2, 0.5 * d1);
}

double lc_f_quantile(double alpha, double d1, double d2)
{
    return d2 / d1 * exp(-lc_beta_quantile_logit(alpha, 0.5 * d2, 0.5 * d1));
}

/* ln Q(a, x) for x > a + 1; DLMF 8.9.2 in its even form, by Lentz's method. */
static double gamma_log_tail(double a, double x)
{
    double b = x + 1 - a, c = 1 / TINY, d = 1 / b, f = d;
    for (int i = 1; i <= FRACTION_STEPS; ++i) {
        double term = -i * (i - a);
        b += 2;
        d = term * d + b;
        d = 1 / (fabs(d) < TINY ? TINY : d);
        c = b + term / c;
        c = fabs(c) < TINY ? TINY : c;
        f *= c * d;
        if (fabs(c * d - 1) < FRACTION_ERROR)
            return a * log(x) - x - gsl_sf_lngamma(a) + log(f);
    }
    return NAN;
}

double lc_chi_square_log_sf(double x, double df)
{
    if (!(x >= 0 && df > 0))
        return NAN;
    if (isinf(x))
        return -INFINITY;
    return x > df + 2 ? gamma_log_tail(0.5 * df, 0.5 * x) : log(gsl_cdf_chisq_Q(x, df));
}

double lc_sidak_level(double alpha, double m)
{
    return alpha >= 0 && alpha <= 1 && m >= 1 ? -expm1(log1p(-alpha) / m) : NAN;
}

double lc_sidak_combine(double p, double m) { return p >= 0 && p <= 1 && m >= 1 ? -expm1(m * log1p(-p)) : NAN; }

double lc_bonferroni_combine(double p, double m) { return p >= 0 && p <= 1 && m >= 1 ? fmin(1, m * p) : NAN; }
