/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A straight line through logarithms; see stats.h. */
#include <math.h>

#include "verify/stats/stats.h"

static lc_status check_points(const double *x, const double *y, const double *sigma, size_t count, lc_error *err)
{
    size_t least = sigma ? 2 : 3;
    if (count < least)
        return lc_fail(err, LC_BAD_INPUT, "%zu points, expected %zu or more", count, least);
    for (size_t i = 0; i < count; ++i)
        if (!(x[i] > 0 && x[i] < INFINITY && y[i] > 0 && y[i] < INFINITY &&
              (!sigma || (sigma[i] > 0 && sigma[i] < INFINITY))))
            return lc_fail(err, LC_BAD_INPUT, "point %zu (%g, %g), expected finite numbers above 0", i, x[i], y[i]);
    return LC_OK;
}

lc_status lc_slope_fit(lc_slope *out, const double *x, const double *y, const double *sigma, size_t count, double alpha,
                       lc_error *err)
{
    lc_status status = check_points(x, y, sigma, count, err);
    if (status)
        return status;
    if (!(alpha > 0 && alpha < 1))
        return lc_fail(err, LC_BAD_INPUT, "level %g, expected a number in (0, 1)", alpha);
    double sw = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, misfit = 0;
    for (size_t i = 0; i < count; ++i) {
        double w = sigma ? 1 / (sigma[i] * sigma[i]) : 1;
        sw += w;
        sx += w * log(x[i]);
        sy += w * log(y[i]);
    }
    double mean_x = sx / sw, mean_y = sy / sw;
    for (size_t i = 0; i < count; ++i) {
        double w = sigma ? 1 / (sigma[i] * sigma[i]) : 1, dx = log(x[i]) - mean_x;
        sxx += w * dx * dx;
        sxy += w * dx * (log(y[i]) - mean_y);
    }
    if (!(sxx > 0))
        return lc_fail(err, LC_BAD_INPUT, "all points at x = %g, expected two or more places", x[0]);
    out->slope = sxy / sxx;
    out->intercept = mean_y - out->slope * mean_x;
    for (size_t i = 0; i < count; ++i) {
        double w = sigma ? 1 / (sigma[i] * sigma[i]) : 1, r = log(y[i]) - out->intercept - out->slope * log(x[i]);
        misfit += w * r * r;
    }
    double df = (double)count - 2;
    out->error = sqrt((sigma ? 1 : misfit / df) / sxx);
    out->misfit_log_p = sigma && df > 0 ? lc_chi_square_log_sf(misfit, df) : NAN;
    double reach = out->error * (sigma ? lc_normal_quantile(0.5 * alpha) : lc_t_quantile(0.5 * alpha, df));
    out->bounds.lower = out->slope - reach;
    out->bounds.upper = out->slope + reach;
    return LC_OK;
}
