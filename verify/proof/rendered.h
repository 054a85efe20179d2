/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * rendered.h: false FAILs of the judge on real renders, where nothing is wrong: the samples of shipped estimators, with
 * their black pixels, edges and tails, through camera, sampler and film.
 */
#ifndef LC_RENDERED_H
#define LC_RENDERED_H

#include <stdint.h>
#include <stdio.h>

#include "core/host.h"

/* Appends the section; adds to *broken the number of rates that exceed their level. */
lc_status lc_rendered_report(FILE *table, int *broken, uint64_t seed, lc_error *err);

#endif
