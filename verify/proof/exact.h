/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * exact.h: error rates at the levels at which the judge works, 1e-6 to 1e-11, which no simulation of 10 000 trials
 * reaches: by enumeration of all counts of coins, and by importance sampling where there are too many pixels.
 */
#ifndef LC_EXACT_H
#define LC_EXACT_H

#include <stdint.h>
#include <stdio.h>

/* Appends the sections on exact tails; returns the number of guarded rates that exceed their level. */
int lc_exact_report(FILE *table, uint64_t seed);

#endif
