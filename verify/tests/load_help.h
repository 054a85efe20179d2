/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes by name, for the suites that judge estimators on them. */
#ifndef LC_LOAD_HELP_H
#define LC_LOAD_HELP_H

#include "io/scene_path.h"
#include "io/scene_read.h"

/* The scene as its file has it, or side x side pixels large where side > 0. */
static inline lc_status load_sized(lc_scene **out, const char *name, int side, lc_error *err)
{
    char path[LC_PATH_SIZE];
    lc_scene_desc desc;
    lc_status status = lc_scene_locate(path, name, err);
    if (status == LC_OK)
        status = lc_scene_read(&desc, path, NULL, 0, err);
    if (status != LC_OK)
        return status;
    if (side > 0)
        desc.width = desc.height = side;
    status = lc_scene_build(out, &desc, err);
    lc_scene_desc_release(&desc);
    return status;
}

/* An lc_load_scene_fn. */
static inline lc_status load_scene(lc_scene **out, const char *name, lc_error *err)
{
    return load_sized(out, name, 0, err);
}

#endif
