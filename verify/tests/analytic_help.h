/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What both suites of closed forms need. */
#ifndef LC_ANALYTIC_HELP_H
#define LC_ANALYTIC_HELP_H

#include <check.h>

#include "core/lightcheck.h"

/* Fails when a and b differ by more than tol of the larger, and says by how much. */
#define ASSERT_CLOSE(a, b, tol) \
    do { \
        double a_ = (a), b_ = (b), off_ = fabs(a_ - b_), size_ = fmax(fabs(a_), fabs(b_)); \
        ck_assert_msg(off_ <= (tol)*size_, "%s = %.17g, expected %.17g, off by %.2g", #a, a_, b_, off_ / size_); \
    } while (0)

/* In [0, 1); any generator will do here. */
static inline double uniform(unsigned *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

static inline lc_vec3 direction(unsigned *state)
{
    lc_vec3 v;
    do {
        v = lc_vec(2 * uniform(state) - 1, 2 * uniform(state) - 1, 2 * uniform(state) - 1);
    } while (lc_length(v) > 1 || lc_length(v) < 0.1);
    return lc_normalize(v);
}

/* Corners of c + s a + t b, |s|, |t| <= 1, counter-clockwise about a x b. */
static inline void parallelogram_about(lc_vec3 corner[4], lc_vec3 c, lc_vec3 a, lc_vec3 b)
{
    corner[0] = lc_sub(lc_sub(c, a), b);
    corner[1] = lc_sub(lc_add(c, a), b);
    corner[2] = lc_add(lc_add(c, a), b);
    corner[3] = lc_add(lc_sub(c, a), b);
}

#endif
