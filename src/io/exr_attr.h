/* SPDX-License-Identifier: GPL-3.0-or-later */
/* exr_attr.h: private to exr: the lightcheck.* attributes of an image. */
#ifndef LC_EXR_ATTR_H
#define LC_EXR_ATTR_H

#include <OpenEXR/openexr.h>

#include "core/host.h"

/* Adds all attributes of the film to part 0, before the header is written. */
exr_result_t lc_exr_put_attributes(exr_context_t exr, const lc_film *film);

/* Fills in the film from part 0; leaves it as created where the image is not lightcheck's. `path` is for messages.
 * LC_BAD_INPUT for attributes that are missing or senseless, LC_FAULT without memory. */
lc_status lc_exr_take_attributes(lc_film *film, exr_const_context_t exr, const char *path, lc_error *err);

#endif
