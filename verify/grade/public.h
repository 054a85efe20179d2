/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef LC_PUBLIC_H
#define LC_PUBLIC_H

#include <stdio.h>

#include "core/host.h"

/* Writes the part of an assignment's JSON that a course gives to its students: without the tests that are not visible, and without what
 * is for the check of the assignment only (solutions, mutants_of, beyond). Students' points are then out of fewer. LC_BAD_INPUT with file:line. */
lc_status lc_assignment_write_public(FILE *out, const char *path, lc_error *err);

#endif
