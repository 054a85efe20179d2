/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes by name, for the suites that judge estimators on them. */
#ifndef LC_LOAD_HELP_H
#define LC_LOAD_HELP_H

#include "io/scene_read.h"

/* The scene, side x side pixels large. */
static inline lc_status load_sized(lc_scene **out, const char *name, int side, lc_error *err)
{
    lc_scene_desc desc;
    lc_status status = lc_scene_describe(&desc, name, err);
    if (status != LC_OK)
        return status;
    desc.width = desc.height = side;
    status = lc_scene_build(out, &desc, err);
    lc_scene_desc_release(&desc);
    return status;
}

#endif
