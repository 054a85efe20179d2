/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef LC_METADATA_H
#define LC_METADATA_H

#include <stdint.h>

#include "core/host.h"

/* What Gradescope's submission_metadata.json says of a hand-in: when it came, and which attempt it is, counted from 1 (earlier ones
 * that could not be graded are none), and its number there, "" where there is none. LC_BAD_INPUT where it is not such a file. */
lc_status lc_metadata_read(int64_t *submitted, int *attempt, char id[32], const char *path, lc_error *err);

#endif
