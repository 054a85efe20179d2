/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cubature.c: adaptive quadrature over a box. */
#include "verify/analytic/effects.h"

enum { MOST_BOXES = 1000000, MOST_CUTS = 40 };

struct cubature {
    lc_integrand2 *f;
    void *user;
    int count, boxes;
    double absolute;
};

/* Gauss and Legendre on [0, 1]. */
static const double nodes[4] = {0.069431844202973712, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629};
static const double weights[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693};

static void gauss(struct cubature *c, double *sum, double x, double y, double w, double h)
{
    ++c->boxes;
    for (int k = 0; k < c->count; ++k)
        sum[k] = 0;
    for (int i = 0; i < 16; ++i) {
        double value[LC_CUBATURE_MOST];
        c->f(value, x + w * nodes[i % 4], y + h * nodes[i / 4], c->user);
        for (int k = 0; k < c->count; ++k)
            sum[k] += w * h * weights[i % 4] * weights[i / 4] * value[k];
    }
}

/* sum: what the box gives uncut, then cut. A box may be off by its side's share of `absolute`: cuts towards a point or
 * along a line then add up to little more than that. */
static void adapt(struct cubature *c, double *sum, double x, double y, double w, double h, int cuts)
{
    double quarter[4][LC_CUBATURE_MOST], change = 0;
    for (int i = 0; i < 4; ++i)
        gauss(c, quarter[i], x + w / 2 * (i % 2), y + h / 2 * (i / 2), w / 2, h / 2);
    for (int k = 0; k < c->count; ++k) {
        double all = quarter[0][k] + quarter[1][k] + quarter[2][k] + quarter[3][k];
        change = fmax(change, fabs(all - sum[k]) - 1e-15 * fabs(all));
        sum[k] = all;
    }
    if (change <= ldexp(c->absolute, -cuts) || cuts == MOST_CUTS || c->boxes > MOST_BOXES)
        return;
    for (int k = 0; k < c->count; ++k)
        sum[k] = 0;
    for (int i = 0; i < 4; ++i) {
        adapt(c, quarter[i], x + w / 2 * (i % 2), y + h / 2 * (i / 2), w / 2, h / 2, cuts + 1);
        for (int k = 0; k < c->count; ++k)
            sum[k] += quarter[i][k];
    }
}

lc_status lc_cubature(double *out, int count, lc_integrand2 *f, void *user, double x0, double x1, double y0, double y1,
                      double absolute, lc_error *err)
{
    struct cubature c = {f, user, count, 0, absolute};
    gauss(&c, out, x0, y0, x1 - x0, y1 - y0);
    adapt(&c, out, x0, y0, x1 - x0, y1 - y0, 0);
    if (c.boxes > MOST_BOXES)
        return lc_fail(err, LC_FAULT, "cubature over [%g, %g] x [%g, %g]: more than %d boxes for an error of %g", x0,
                       x1, y0, y1, MOST_BOXES, absolute);
    return LC_OK;
}
