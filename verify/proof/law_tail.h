/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * law_tail.h: far tails of means of n samples of a law that is known, with which other programs' rules are brought to a given rate of
 * false failures also where samples are skewed. No test of a renderer has that law; ours is not given it.
 */
#ifndef LC_LAW_TAIL_H
#define LC_LAW_TAIL_H

#include "verify/proof/synthetic.h"

/* The z > 0 that (mean - true mean) / exact standard error passes with probability alpha, below (sign = -1) or above (+1): near it by
 * Lugannani and Rice's saddlepoint formula (Adv. Appl. Probab. 12, 1980), then by importance sampling with that formula's tilt.
 * A Gaussian law: the normal quantile. */
double lc_law_mean_quantile(const lc_law *law, double n, double alpha, int sign);

/* The same of (mean - true mean) / its error as estimated from the same n samples, by importance sampling: samples are drawn with
 * weights times exp(h x - h^2 x^2 / 2), x = sign (value - mean) / deviation and h = z(alpha) / sqrt(n), under which the
 * studentised mean lies about z (Jing, Shao, Wang, Ann. Probab. 31(4), 2003); 4096 draws, an error of some 3% of alpha.
 * INFINITY where all draws together weigh less than alpha (few samples). NaN for a Gaussian law, whose tail is Student's. */
double lc_law_student_quantile(const lc_law *law, double n, double alpha, int sign);

#endif
