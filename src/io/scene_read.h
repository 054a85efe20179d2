/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads a scene: the subset of Mitsuba 3's XML that docs/scenes.md describes. */
#ifndef LC_SCENE_READ_H
#define LC_SCENE_READ_H

#include "core/host.h"

/* A value that wins over the file's <default name="..." value="..."/>, like Mitsuba's -Dname=value. */
typedef struct lc_parameter {
    const char *name, *value;
} lc_parameter;

enum { LC_SCENE_MAX_BYTES = 16 << 20 }; /* of a scene's file */

/* Reads the file into `out`, which may be uninitialised; release it with lc_scene_desc_release(). LC_BAD_INPUT and
 * "file:line: what, what is supported" for anything outside the subset; LC_FAULT when the file cannot be read or memory
 * ends. After a failure `out` is empty. One call a thread; independent of the locale. */
lc_status lc_scene_read(lc_scene_desc *out, const char *path, const lc_parameter *overrides, int override_count,
                        lc_error *err);

/* The scene of that name, or of that path (scene_path.h): its description, or ready to render. */
lc_status lc_scene_describe(lc_scene_desc *out, const char *name, lc_error *err);
lc_status lc_scene_open(lc_scene **out, const char *name, lc_error *err);

/* The same from `length` bytes of memory; `name` stands for the file in messages, and its stem names the scene. */
lc_status lc_scene_read_memory(lc_scene_desc *out, const char *text, size_t length, const char *name,
                               const lc_parameter *overrides, int override_count, lc_error *err);

/* Calls `line` once for each supported plugin: "shape sphere: to_world, flip_normals, center, radius". The list is made
 * from the table that the reader itself follows. */
void lc_scene_read_describe(void (*line)(void *user, const char *text), void *user);

#endif
