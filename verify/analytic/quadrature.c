/* SPDX-License-Identifier: GPL-3.0-or-later */
/* quadrature.c: GSL's adaptive quadrature behind our way of saying that it failed. */
#include "verify/analytic/analytic.h"

#include <pthread.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>

enum { MAX_PIECES = 2000 };

struct smoothed {
    lc_integrand *f;
    void *user;
    double a, width;
};

static double smoothed_value(double t, void *user)
{
    const struct smoothed *s = user;
    return s->f(s->a + s->width * t * t * (3 - 2 * t), s->user) * s->width * 6 * t * (1 - t);
}

/* GSL's own handler aborts the process; the status that it returns says the same. */
static void silence_gsl(void)
{
    gsl_set_error_handler_off();
}

lc_status lc_quadrature(double *out, lc_integrand *f, void *user, double a, double b, double absolute, double relative,
                        lc_error *err)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, silence_gsl);
    struct smoothed smoothed = {f, user, a, b - a};
    gsl_function function = {smoothed_value, &smoothed};
    gsl_integration_workspace *work = gsl_integration_workspace_alloc(MAX_PIECES);
    if (!work)
        return lc_fail(err, LC_FAULT, "quadrature: out of memory");
    double error = INFINITY;
    int status = gsl_integration_qag(&function, 0, 1, absolute, relative, MAX_PIECES, GSL_INTEG_GAUSS21, work, out,
                                     &error);
    gsl_integration_workspace_free(work);
    /* GSL also reports rounding that stops it a little short of the goal: what counts is the error it is left with */
    if (status && !(error <= 100 * fmax(absolute, relative * fabs(*out))))
        return lc_fail(err, LC_FAULT, "quadrature over [%g, %g]: %s, error %g left, expected %g", a, b,
                       gsl_strerror(status), error, fmax(absolute, relative * fabs(*out)));
    return LC_OK;
}
