/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * seeds.h: which seed each part of a grading has.
 *
 * Of a class, the seed is the teacher's secret. What students see is made from another one, and so is each kind of what is withheld: the line
 * that reproduces a visible test would else reproduce the hidden ones, too.
 */
#ifndef LC_SEEDS_H
#define LC_SEEDS_H

#include "verify/grade/result.h"

/* The seed that a secret one gives for a purpose. Who knows the results for other purposes can get neither at the secret nor at this:
 * Threefry-2x64 of 20 rounds (Salmon, Moraes, Dror, Shaw, SC 2011), keyed by the secret. */
uint64_t lc_seed_for(uint64_t secret, const char *purpose);

/* The seed from which tests of this visibility are drawn: the one that was given, or where that is secret one made from it. */
uint64_t lc_seed_of(uint64_t seed, int is_secret, lc_visibility visibility);

/* The seed of one test, of its samples and of the scenes that it draws, from that of its visibility. */
uint64_t lc_test_seed(uint64_t seed, const char *test);

#endif
