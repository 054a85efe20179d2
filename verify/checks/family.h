/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * family.h: scenes that are drawn. A family has a closed form for any size, pose, colour and albedo; the seed of the run
 * chooses one of its scenes, so that nobody can know them beforehand, and the same seed gives the same scene again.
 */
#ifndef LC_FAMILY_H
#define LC_FAMILY_H

#include "core/host.h"

typedef struct lc_family {
    const char *name, *summary; /* the name stands where a scene's does */
    lc_status (*make)(lc_scene_desc *desc, lc_sampler *random, lc_error *err); /* fills an empty description */
} lc_family;

extern const lc_family lc_families[]; /* ends with name = NULL */

const lc_family *lc_family_find(const char *name); /* NULL: no such family */
/* The scene of this seed. LC_FAULT without memory. */
lc_status lc_family_describe(lc_scene_desc *out, const lc_family *family, uint64_t seed, lc_error *err);

#endif
