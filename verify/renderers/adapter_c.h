/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Private to adapter.c and replicates.c.
 */
#ifndef LC_ADAPTER_C_H
#define LC_ADAPTER_C_H

#include "verify/renderers/adapter.h"

/* Path, name and what is assumed of it until it says something else. `out` must not be moved. */
lc_status lc_adapter_prepare(lc_adapter *out, const char *path, lc_error *err);

/* One image of the scene: 3 numbers a pixel. LC_FAULT, which begins with `what`, for a file that is none, of another size, or with values
 * that are not finite or negative. */
lc_status lc_adapter_read_image(float *rgb, const char *path, const lc_scene_desc *scene, const char *what, lc_error *err);

#endif
