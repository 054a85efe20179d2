/* SPDX-License-Identifier: GPL-3.0-or-later */
/* quadrature.c: GSL's adaptive quadrature behind our way of saying that it failed. */
#include "verify/analytic/analytic.h"

#include <pthread.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>

#include "verify/analytic/body.h"

enum { MAX_PIECES = 150 };

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

static void silence(void) { gsl_set_error_handler_off(); }

void lc_gsl_silence(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, silence);
}

lc_status lc_quadrature(double *out, lc_integrand *f, void *user, double a, double b, double absolute, double relative,
                        lc_error *err)
{
    lc_gsl_silence();
    struct smoothed smoothed = {f, user, a, b - a};
    gsl_function function = {smoothed_value, &smoothed};
    /* Most pieces are smooth: 21 or 43 points will do, where the adaptive rule begins with 33 and 65. */
    size_t evaluations;
    double quick_error;
    if (gsl_integration_qng(&function, 0, 1, absolute, relative, out, &quick_error, &evaluations) == GSL_SUCCESS)
        return LC_OK;
    gsl_integration_cquad_workspace *work = gsl_integration_cquad_workspace_alloc(MAX_PIECES);
    if (!work)
        return lc_fail(err, LC_FAULT, "quadrature: out of memory");
    double error = INFINITY;
    int status = gsl_integration_cquad(&function, 0, 1, absolute, relative, work, out, &error, NULL);
    gsl_integration_cquad_workspace_free(work);
    /* GSL calls it a success when intervals get too small to cut: what counts is the error that is left */
    double goal = fmax(absolute, relative * fabs(*out));
    if (!(error <= 100 * goal))
        return lc_fail(err, LC_FAULT, "quadrature over [%g, %g]: %s, error %g left, expected %g", a, b,
                       gsl_strerror(status), error, goal);
    return LC_OK;
}
