/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * estimate.h: what is known of one difference, (mean of arm a) - (mean of arm b) or - (a constant), and what may be
 * said of it.
 *
 * An lc_estimate holds sums over independent pixels, so that a tile's is the sum of its pixels': differences, variances
 * and third cumulants of independent means add up. It becomes a statement through an lc_student: Student's t with Welch
 * and Satterthwaite's degrees of freedom, (sum v)^2 / sum(v^2 / (n - 1)) over every contributing mean (Biometrics
 * Bulletin 2, 1946).
 *
 * Heavy tails. A studentised mean X of n samples of skewness g has, to first order in G = g / sqrt(n), the skewness of
 * the mean (Edgeworth's term, Hall, Ann. Probab. 15(3), 1987),
 *
 *     P(X <= -z) = Q exp(G w / 3),  P(X >= z) = Q exp(-G w / 3),  Q = P(Z >= z),  w = (2 z^2 + 1) phi(z) / (2 Q),
 *
 * and w tends to z^3, the moderate deviations of Jing, Shao and Wang, Ann. Probab. 31(4), 2003. Samples that miss the
 * rare bright values have too low a mean AND too small a variance. So a positive skew of arm a spoils the test that
 * sees a below b (and that which bounds the difference from above); the other test is only less sensitive. In arm b the
 * sides change places. Each side's G is the sum over the arms that spoil it; arms never cancel, for two equal skewed
 * arms have a G of 0 but not a normal tail.
 *
 * A test at one-sided level alpha is trusted where G w <= 2.08 = 3 ln 2 at z = z(alpha): n >= (g z^3 / 2.08)^2 for
 * large z; there its p is multiplied by exp(G w / 3), which is at most 2, and by LC_RESERVE for what the first order
 * leaves out (lattices; Welch's approximation, see LC_LEAST_SAMPLES). Untrusted means unusable: an interval's end at
 * infinity, p = NaN. Exact binomial tails from 1e-2 to 1e-11 then stay at or under their level.
 *
 * A measured skewness knows nothing of values that were never hit; see LC_GUARD_POOLED and lc_missed_value().
 */
#ifndef LC_ESTIMATE_H
#define LC_ESTIMATE_H

#include <stdint.h>

#include "core/host.h"

/* Largest G w, and the factor that covers what the correction leaves out. */
#define LC_SKEW_LIMIT 2.08
#define LC_RESERVE 1.1

/* Samples a pixel from which on tiles are tested: where one pixel of 256 samples has 3/4 of a tile's variance, the
 * worst share, Welch's tail is off by 1.01 at 1e-6, 1.05 at 1e-11, 1.12 at 1e-14; 64 samples: 1.11, 2.1, 4.8; 16
 * samples: 4, 545, 3e4 (numerical integration over the chi-square of that pixel's variance). */
enum { LC_LEAST_SAMPLES = 256 };

typedef enum lc_verdict {
    LC_GO_ON, /* more samples are needed */
    LC_PASS,  /* shown equal within the margin */
    LC_FAIL   /* shown different by more than the tolerance */
} lc_verdict;

/* Of two parts of one claim (channels): FAIL if either fails, PASS if both pass. */
lc_verdict lc_verdict_both(lc_verdict a, lc_verdict b);

/* One arm: sums over its pixels. */
typedef struct lc_arm_sums {
    double variance;  /* sum of v, the variances of the pixels' means */
    double variance2; /* sum of v^2 / (n - 1) */
    double third;     /* sum of the third cumulants of the means */
    double doubt;     /* bound of the sum of those that are unknown (films from files); counts on both sides */
    double cubes[2];  /* of pixels skewed to dark samples, [1] to bright ones: sum |d|^3, d a sample less its pixel's mean, */
    double sixths[2]; /* and a bound of their sum d^6; INFINITY where the largest sample is not known */
    double least;     /* fewest samples of a pixel; INFINITY for a constant */
    uint32_t sampled; /* pixels that were sampled; 0 for a constant */
    uint32_t still;   /* pixels among them whose samples are all equal: variance 0 as far as anybody knows */
} lc_arm_sums;

typedef struct lc_estimate {
    double difference, expected; /* sums over the pixels of a - b, and of b */
    double tolerance;            /* sum of the declared errors of what is compared (rounding, reference): they add up */
    lc_arm_sums arm[2];
    uint32_t pixels;
} lc_estimate;

/* The sum of no pixel. */
lc_estimate lc_estimate_zero(void);
void lc_estimate_add(lc_estimate *into, const lc_estimate *part);

/* One pixel's, of one channel: against another film's pixel, or against a constant. `tolerance` >= 0 in units of
 * radiance. v = m2 / (n (n - 1)); third cumulant of the mean m3 / (n (n - 1) (n - 2)): unbiased (Fisher's k-statistics
 * over n and n^2). With n < 2 the variance is unknown: `least` says so and nothing is tested. has_third = 0: m3 is
 * bounded by m2^(3/2). Samples that differ only by rounding (standard deviation below 1e-12 of the mean) count as
 * equal. */
lc_estimate lc_estimate_two(const lc_pixel *a, int a_has_third, const lc_pixel *b, int b_has_third, int channel,
                            double tolerance);
lc_estimate lc_estimate_one(const lc_pixel *a, int a_has_third, int channel, double expected, double tolerance);

/* Fills width x height estimates, row by row. Refuses films of different sizes, bad samples (says where), a tolerance
 * below 0, and two films of the same stream (seed and arm), whose differences would not be independent. */
lc_status lc_field_two(lc_estimate *field, const lc_film *a, const lc_film *b, int channel, double tolerance,
                       lc_error *err);
/* `expected` is R G B of each pixel, row by row. */
lc_status lc_field_one(lc_estimate *field, const lc_film *a, const double *expected, int channel, double tolerance,
                       lc_error *err);

/* LC_LOW: the difference seems too low (a test against "it is at least x"; the upper end of an interval). LC_HIGH: the
 * reverse. */
enum { LC_LOW, LC_HIGH };

/* A studentised difference, a mean over the pixels. */
typedef struct lc_student {
    int testable; /* every sampled arm has a variance, known and > 0 */
    double difference, expected, tolerance;
    double error;   /* standard error of the difference */
    double df;      /* degrees of freedom */
    double skew[2]; /* G >= 0 on the side LC_LOW, LC_HIGH */
    double events[2]; /* so many samples make up the skewness of a side at least, (sum |d|^3)^2 / sum d^6; INFINITY: it has none */
} lc_student;

lc_student lc_estimate_student(const lc_estimate *estimate);

/* w above, of a one-sided level in (0, 1/2); else NaN. */
double lc_skew_weight(double alpha);
/* 1 when the test of this side may be used at the one-sided level alpha in (0, 1/2). */
int lc_student_trusted(const lc_student *student, int side, double alpha);
/* ln of the one-sided p value against "the difference is at least `bound`" (LC_LOW) or "at most" (LC_HIGH), for a
 * decision at level alpha, corrected for skewness; NaN when not trusted or not testable. p <= alpha decides. */
double lc_student_log_p(const lc_student *student, int side, double bound, double alpha);

/* The set of differences that neither one-sided test at alpha / 2 excludes; an end is infinite where its test is not
 * trusted. */
typedef struct lc_interval {
    double lower, upper;
} lc_interval;
lc_interval lc_student_interval(const lc_student *student, double alpha);

/* FAIL: the interval at alpha_fail lies wholly outside +-tolerance. Else PASS: both one-sided tests at alpha_pass show
 * the difference within +-margin (two one-sided tests, Schuirmann, J. Pharmacokinet. Biopharm. 15, 1987; an
 * intersection-union test, so alpha_pass is not split). Else, and where nothing can be tested, GO_ON. margin > 0;
 * INFINITY: undeclared, never PASS. */
lc_verdict lc_student_decide(const lc_student *student, double alpha_fail, double alpha_pass, double margin);

/* For rows DECLARED deterministic only: FAIL when |difference| > tolerance (or NaN), else PASS. */
lc_verdict lc_decide_exact(double difference, double tolerance);

#endif
