/* SPDX-License-Identifier: GPL-3.0-or-later */
/* scan.c: the visible part of any convex emitter behind any convex shapes, by one smooth-by-pieces integral.
 *
 * In polar coordinates about the receiver's normal, int cos dOmega = int dphi int cos t sin t dt = int dphi [q] / 2,
 * q = sin^2 t: the inner integral is exact. A vertical half-plane meets a convex body in ONE interval of q, so what
 * is visible at an azimuth is an interval minus intervals; their ends are smooth between known azimuths: corners,
 * tangents, the horizon and the crossings of outlines. */
#include "verify/analytic/body.h"

#include <stdlib.h>

/* Goals, relative to what the lamp gives unhidden. */
#define SCAN_LAMP 1e-11
#define SCAN_HIDDEN 1e-11

struct scan {
    const lc_body *lamp;
    const lc_body *const *hiders;
    int count;
    double (*hidden)[2]; /* room for one interval a hider */
};

static int by_start(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* The hider's interval within q, unless it lies behind the lamp there. */
static int hidden_interval(const struct scan *scan, const lc_body *hider, double c, double s, const double q[2],
                           double out[2])
{
    if (!lc_body_interval(hider, c, s, out))
        return 0;
    out[0] = fmax(out[0], q[0]);
    out[1] = fmin(out[1], q[1]);
    if (!(out[0] < out[1]))
        return 0;
    double middle = (out[0] + out[1]) / 2, sin_t = sqrt(middle);
    lc_vec3 d = lc_vec(c * sin_t, s * sin_t, sqrt(1 - middle));
    return lc_body_depth(hider, d) < lc_body_depth(scan->lamp, d) * (1 - LC_TOUCH);
}

static double visible_at(double phi, void *user)
{
    const struct scan *scan = user;
    double c = cos(phi), s = sin(phi), q[2];
    if (!lc_body_interval(scan->lamp, c, s, q))
        return 0;
    int found = 0;
    for (int i = 0; i < scan->count; ++i)
        found += hidden_interval(scan, scan->hiders[i], c, s, q, scan->hidden[found]);
    if (found > 1)
        qsort(scan->hidden, (size_t)found, sizeof scan->hidden[0], by_start);
    double sum = 0, from = q[0];
    for (int i = 0; i < found; ++i) {
        sum += fmax(0, scan->hidden[i][0] - from);
        from = fmax(from, scan->hidden[i][1]);
    }
    return (sum + fmax(0, q[1] - from)) / (2 * LC_PI);
}

/* All azimuths where something begins, ends, has a corner or crosses, sorted in [-pi, pi], with both ends. */
static int break_points(const struct scan *scan, double *phi)
{
    int count = lc_body_azimuths(scan->lamp, phi);
    for (int i = 0; i < scan->count; ++i) {
        count += lc_body_azimuths(scan->hiders[i], phi + count);
        count += lc_body_crossings(scan->lamp, scan->hiders[i], phi + count);
        for (int j = 0; j < i; ++j)
            count += lc_body_crossings(scan->hiders[j], scan->hiders[i], phi + count);
    }
    for (int i = 0; i < count; ++i)
        phi[i] = remainder(phi[i], 2 * LC_PI);
    phi[count++] = -LC_PI;
    phi[count++] = LC_PI;
    qsort(phi, (size_t)count, sizeof phi[0], by_start);
    return count;
}

/* The integral to a few digits, which is what an absolute goal needs to know. */
static double rough(struct scan *scan, const double *phi, int count)
{
    double sum = 0;
    for (int i = 0; i + 1 < count; ++i)
        for (int k = 0; k < 8; ++k) {
            double t = (k + 0.5) / 8, width = phi[i + 1] - phi[i];
            sum += visible_at(phi[i] + width * t * t * (3 - 2 * t), scan) * width * 6 * t * (1 - t) / 8;
        }
    return sum;
}

static lc_status integrate(double *out, struct scan *scan, const double *phi, int count, double absolute, lc_error *err)
{
    *out = 0;
    for (int i = 0; i + 1 < count; ++i) {
        double piece;
        if (!(phi[i] < phi[i + 1]))
            continue;
        lc_status status = lc_quadrature(&piece, visible_at, scan, phi[i], phi[i + 1], absolute / count, 0, err);
        if (status)
            return status;
        *out += piece;
    }
    return LC_OK;
}

lc_status lc_scan_factor(double *factor, const lc_body *lamp, const lc_body *const *hiders, int count, lc_error *err)
{
    struct scan scan = {lamp, hiders, 0, NULL};
    size_t bodies = (size_t)count + 1;
    double *phi = malloc((bodies * LC_BODY_AZIMUTHS + bodies * bodies / 2 * LC_BODY_CROSSINGS + 2) * sizeof *phi);
    scan.hidden = malloc(bodies * sizeof *scan.hidden);
    lc_status status;
    if (!phi || !scan.hidden) {
        status = lc_fail(err, LC_FAULT, "visible part of a lamp: out of memory");
        goto cleanup;
    }
    lc_gsl_silence();
    int points = break_points(&scan, phi);
    double scale = rough(&scan, phi, points);
    scan.count = count;
    points = break_points(&scan, phi);
    *factor = 0;
    status = scale > 0 ? integrate(factor, &scan, phi, points, (count ? SCAN_HIDDEN : SCAN_LAMP) * scale, err) : LC_OK;
cleanup:
    free(scan.hidden);
    free(phi);
    return status;
}

lc_status lc_ellipse_factor(double *factor, lc_vec3 centre, lc_vec3 axis1, lc_vec3 axis2, lc_vec3 p, lc_vec3 n,
                            lc_error *err)
{
    lc_receiver receiver = lc_receiver_at(p, n);
    lc_body body = lc_body_ellipse(&receiver, centre, axis1, axis2, 0);
    *factor = 0;
    if (!(lc_body_height(&body) > 0))
        return LC_OK;
    return lc_scan_factor(factor, &body, NULL, 0, err);
}
