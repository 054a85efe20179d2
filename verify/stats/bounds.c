/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bounds that hold for any number of samples; see stats.h. */
#include <math.h>

#include "verify/stats/stats.h"

double lc_bernstein_bound(double variance, double n, double range, double alpha)
{
    if (!(variance >= 0 && n >= 2 && range > 0 && alpha > 0 && alpha < 1))
        return NAN;
    double l = log(4 / alpha);
    return sqrt(2 * variance * l / n) + 7 * range * l / (3 * (n - 1));
}

double lc_met_bound(double square, double n, double largest, double alpha)
{
    if (!(square >= 0 && n >= 2 && largest > 0 && alpha > 0 && alpha < 1))
        return NAN;
    double l = log(6 / alpha);
    return lc_bernstein_bound(square * n / (n - 1), n, 2 * largest, 4 * exp(-l)) + (3 + exp(1)) * largest * l / n;
}

double lc_missed_value(double margin, double n, double alpha)
{
    return margin >= 0 && n >= 0 && alpha > 0 && alpha < 1 ? margin * n / -log(alpha) : NAN;
}

static double from_logit(double s) { return 1 / (1 + exp(-s)); }

lc_interval lc_clopper_pearson(double k, double n, double alpha)
{
    lc_interval interval = {NAN, NAN};
    if (!(k >= 0 && k <= n && n >= 1 && alpha > 0 && alpha < 1))
        return interval;
    interval.lower = k == 0 ? 0 : from_logit(lc_beta_quantile_logit(0.5 * alpha, k, n - k + 1));
    /* The upper end through 1 - p, whose lower tail it is. */
    interval.upper = k == n ? 1 : from_logit(-lc_beta_quantile_logit(0.5 * alpha, n - k, k + 1));
    return interval;
}
