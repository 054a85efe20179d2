/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Differences of means, and what may be said of them; see estimate.h. */
#include "verify/stats/estimate.h"

#include <math.h>

#include "verify/stats/tails.h"

/* Relative standard deviation that merging equal samples in floating point may leave behind. */
static const double ROUNDING = 1e-12;

lc_verdict lc_verdict_both(lc_verdict a, lc_verdict b)
{
    if (a == LC_FAIL || b == LC_FAIL)
        return LC_FAIL;
    return a == LC_PASS && b == LC_PASS ? LC_PASS : LC_GO_ON;
}

static lc_arm_sums arm_zero(void)
{
    lc_arm_sums arm = {.least = INFINITY};
    return arm;
}

lc_estimate lc_estimate_zero(void)
{
    lc_estimate e = {0, 0, 0, {arm_zero(), arm_zero()}, 0};
    return e;
}

void lc_estimate_add(lc_estimate *into, const lc_estimate *part)
{
    into->difference += part->difference;
    into->expected += part->expected;
    into->tolerance += part->tolerance;
    into->pixels += part->pixels;
    for (int i = 0; i < 2; ++i) {
        lc_arm_sums *a = &into->arm[i];
        const lc_arm_sums *b = &part->arm[i];
        a->variance += b->variance;
        a->variance2 += b->variance2;
        a->third += b->third;
        a->doubt += b->doubt;
        for (int bright = 0; bright < 2; ++bright) {
            a->cubes[bright] += b->cubes[bright];
            a->sixths[bright] += b->sixths[bright];
        }
        a->least = b->least < a->least ? b->least : a->least;
        a->sampled += b->sampled;
        a->still += b->still;
    }
}

static lc_arm_sums arm_of_pixel(const lc_pixel *pixel, int has_third, int channel)
{
    const lc_moments *m = &pixel->c[channel];
    double n = (double)pixel->n;
    lc_arm_sums arm = arm_zero();
    arm.least = n;
    arm.sampled = 1;
    if (n < 2)
        return arm;
    if (m->m2 >= 0 && sqrt(m->m2 / n) <= ROUNDING * fabs(m->mean)) { /* NaN goes on, to be refused later */
        arm.still = 1;
        return arm;
    }
    arm.variance = m->m2 / (n * (n - 1));
    arm.variance2 = arm.variance * arm.variance / (n - 1);
    arm.still = arm.variance == 0;
    double scale = 1 / (n * (n - 1) * fmax(n - 2, 1));
    if (has_third && n > 2) {
        int bright = m->m3 > 0;
        double largest = bright ? m->max - m->mean : fabs(m->mean); /* no sample is negative; `max` is 0 in a film from a file */
        arm.third = m->m3 * scale;
        arm.cubes[bright] = fabs(m->m3);
        arm.sixths[bright] = bright && !(m->max > 0) ? INFINITY : fabs(m->m3) * largest * largest * largest;
    } else
        arm.doubt = m->m2 * sqrt(m->m2) * scale; /* |m3| <= sum |d|^3 <= (sum d^2)^(3/2) */
    return arm;
}

lc_estimate lc_estimate_two(const lc_pixel *a, int a_has_third, const lc_pixel *b, int b_has_third, int channel,
                            double tolerance)
{
    lc_estimate e = lc_estimate_zero();
    e.difference = a->c[channel].mean - b->c[channel].mean;
    e.expected = b->c[channel].mean;
    e.tolerance = tolerance;
    e.arm[0] = arm_of_pixel(a, a_has_third, channel);
    e.arm[1] = arm_of_pixel(b, b_has_third, channel);
    e.pixels = 1;
    return e;
}

lc_estimate lc_estimate_one(const lc_pixel *a, int a_has_third, int channel, double expected, double tolerance)
{
    lc_estimate e = lc_estimate_zero();
    e.difference = a->c[channel].mean - expected;
    e.expected = expected;
    e.tolerance = tolerance;
    e.arm[0] = arm_of_pixel(a, a_has_third, channel);
    e.pixels = 1;
    return e;
}

static lc_status check_film(const lc_film *film, int channel, double tolerance, lc_error *err)
{
    if (channel < 0 || channel > 2)
        return lc_fail(err, LC_FAULT, "channel %d, expected 0, 1 or 2", channel);
    if (!(tolerance >= 0 && tolerance < INFINITY))
        return lc_fail(err, LC_BAD_INPUT, "tolerance %g, expected a number >= 0", tolerance);
    if (film->bad)
        return lc_fail(err, LC_WRONG,
                       "%s, %s: %llu bad samples, the first at pixel (%d, %d), sample %llu: (%g, %g, %g), expected "
                       "finite values >= 0",
                       film->scene, film->estimator, (unsigned long long)film->bad, film->bad_x, film->bad_y,
                       (unsigned long long)film->bad_sample, film->bad_value[0], film->bad_value[1],
                       film->bad_value[2]);
    return LC_OK;
}

static lc_range range_of(const lc_film *film, int i)
{
    return i > 0 ? film->more[i - 1] : (lc_range){film->seed, film->arm, film->first, film->count};
}

/* Of any two ranges: a merged film has several. */
static lc_status check_independent(const lc_film *a, const lc_film *b, lc_error *err)
{
    for (int i = 0; i <= a->more_count; ++i)
        for (int j = 0; j <= b->more_count; ++j) {
            lc_range x = range_of(a, i), y = range_of(b, j);
            if (x.seed == y.seed && x.arm == y.arm && x.first < y.first + y.count && y.first < x.first + x.count)
                return lc_fail(err, LC_BAD_INPUT, "%s: both films are of seed %llu, arm %u, expected independent streams",
                               a->scene, (unsigned long long)x.seed, (unsigned)x.arm);
        }
    return LC_OK;
}

lc_status lc_field_two(lc_estimate *field, const lc_film *a, const lc_film *b, int channel, double tolerance,
                       lc_error *err)
{
    lc_status status = check_film(a, channel, tolerance, err);
    if (!status)
        status = check_film(b, channel, tolerance, err);
    if (status)
        return status;
    if (a->width != b->width || a->height != b->height)
        return lc_fail(err, LC_BAD_INPUT, "films of %dx%d and %dx%d pixels, expected the same size", a->width,
                       a->height, b->width, b->height);
    status = check_independent(a, b, err);
    if (status)
        return status;
    size_t count = (size_t)a->width * (size_t)a->height;
    for (size_t i = 0; i < count; ++i)
        field[i] = lc_estimate_two(&a->pixels[i], a->has_third, &b->pixels[i], b->has_third, channel, tolerance);
    return LC_OK;
}

lc_status lc_field_one(lc_estimate *field, const lc_film *a, const double *expected, int channel, double tolerance,
                       lc_error *err)
{
    lc_status status = check_film(a, channel, tolerance, err);
    if (status)
        return status;
    size_t count = (size_t)a->width * (size_t)a->height;
    for (size_t i = 0; i < count; ++i)
        field[i] = lc_estimate_one(&a->pixels[i], a->has_third, channel, expected[3 * i + (size_t)channel], tolerance);
    return LC_OK;
}

lc_student lc_estimate_student(const lc_estimate *e)
{
    double pixels = e->pixels, spoil[2] = {0, 0};
    double variance = e->arm[0].variance + e->arm[1].variance, variance2 = e->arm[0].variance2 + e->arm[1].variance2;
    lc_student s;
    s.testable = e->pixels > 0 && e->arm[0].sampled + e->arm[1].sampled > 0;
    s.difference = e->difference / pixels;
    s.expected = e->expected / pixels;
    s.tolerance = e->tolerance / pixels;
    s.error = sqrt(variance) / pixels;
    s.df = variance * variance / variance2;
    s.events[LC_LOW] = s.events[LC_HIGH] = INFINITY;
    for (int i = 0; i < 2; ++i) {
        const lc_arm_sums *arm = &e->arm[i];
        if (arm->sampled && !(arm->variance > 0 && arm->least >= 2))
            s.testable = 0;
        if (!(fabs(arm->third) + arm->doubt < INFINITY)) /* fmax below would hide a NaN */
            s.testable = 0;
        double third = i == 0 ? arm->third : -arm->third;
        spoil[LC_LOW] += fmax(third, 0) + arm->doubt;
        spoil[LC_HIGH] += fmax(-third, 0) + arm->doubt;
        int rising = i == 0 ? LC_LOW : LC_HIGH, falling = 1 - rising; /* the sides that bright and dark samples spoil */
        for (int bright = 0; bright < 2; ++bright)
            if (arm->cubes[bright] > 0)
                s.events[bright ? rising : falling] =
                    fmin(s.events[bright ? rising : falling], arm->cubes[bright] * arm->cubes[bright] / arm->sixths[bright]);
        if (arm->doubt > 0)
            s.events[LC_LOW] = s.events[LC_HIGH] = 0;
    }
    s.skew[LC_LOW] = spoil[LC_LOW] / (variance * sqrt(variance));
    s.skew[LC_HIGH] = spoil[LC_HIGH] / (variance * sqrt(variance));
    return s;
}

double lc_skew_weight(double alpha)
{
    double z = lc_normal_quantile(alpha);
    return z > 0 ? (2 * z * z + 1) * exp(-0.5 * z * z) / (2 * sqrt(2 * LC_PI) * alpha) : NAN;
}

int lc_student_trusted(const lc_student *s, int side, double alpha)
{
    return s->testable && s->skew[side] * lc_skew_weight(alpha) <= LC_SKEW_LIMIT;
}

/* ln of the factor by which the nominal tail at z(alpha) may be too small; NaN when it is not trusted. */
static double log_correction(const lc_student *s, int side, double alpha)
{
    if (!lc_student_trusted(s, side, alpha))
        return NAN;
    return s->skew[side] * lc_skew_weight(alpha) / 3 + log(LC_RESERVE);
}

double lc_student_log_p(const lc_student *s, int side, double bound, double alpha)
{
    double correction = log_correction(s, side, alpha);
    if (isnan(correction))
        return NAN;
    double t = (s->difference - bound) / s->error;
    double log_p = lc_t_log_sf(side == LC_LOW ? -t : t, s->df) + correction;
    return log_p > 0 ? 0 : log_p; /* not fmin, which would turn NaN into p = 1 */
}

lc_interval lc_student_interval(const lc_student *s, double alpha)
{
    lc_interval interval = {-INFINITY, INFINITY};
    double high = log_correction(s, LC_HIGH, 0.5 * alpha), low = log_correction(s, LC_LOW, 0.5 * alpha);
    if (!isnan(high))
        interval.lower = s->difference - s->error * lc_t_quantile(0.5 * alpha * exp(-high), s->df);
    if (!isnan(low))
        interval.upper = s->difference + s->error * lc_t_quantile(0.5 * alpha * exp(-low), s->df);
    return interval;
}

/* A NaN compares false: untrusted never decides. */
lc_verdict lc_student_decide(const lc_student *s, double alpha_fail, double alpha_pass, double margin)
{
    double fail = 0.5 * alpha_fail;
    if (lc_student_log_p(s, LC_HIGH, s->tolerance, fail) <= log(fail) ||
        lc_student_log_p(s, LC_LOW, -s->tolerance, fail) <= log(fail))
        return LC_FAIL;
    if (margin > 0 && margin < INFINITY && lc_student_log_p(s, LC_LOW, margin, alpha_pass) <= log(alpha_pass) &&
        lc_student_log_p(s, LC_HIGH, -margin, alpha_pass) <= log(alpha_pass))
        return LC_PASS;
    return LC_GO_ON;
}

lc_verdict lc_decide_exact(double difference, double tolerance)
{
    return fabs(difference) <= tolerance ? LC_PASS : LC_FAIL;
}
