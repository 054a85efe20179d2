/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * scene_write.h: a description as a scene file, for other programs: a scene that was made or changed in memory has none.
 */
#ifndef LC_SCENE_WRITE_H
#define LC_SCENE_WRITE_H

#include <stdio.h>

#include "core/host.h"

/* Writes what lc_scene_read() reads back as the same scene; the numbers of blends alone may differ by rounding. Bounces and
 * samples that are unknown are left out. LC_BAD_INPUT for what the format cannot say (a blend with a rough mirror, or whose sides transmit and
 * differ); LC_FAULT when writing fails. Any thread. */
lc_status lc_scene_write(FILE *out, const lc_scene_desc *desc, lc_error *err);

#endif
