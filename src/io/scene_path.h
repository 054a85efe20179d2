/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Scenes by name: the folder scenes/ beside the program's own folder (build/../scenes), else ./scenes.
 */
#ifndef LC_SCENE_PATH_H
#define LC_SCENE_PATH_H

#include "core/host.h"

enum { LC_PATH_SIZE = 4096 };

/* 1 for what names a file, not a scene of that folder: it has a slash or ends in .xml. */
int lc_scene_is_path(const char *name);
/* The path of `name`: itself when it is one, else the file NAME.xml of the scenes' folder; LC_BAD_INPUT lists the valid names. */
lc_status lc_scene_locate(char path[LC_PATH_SIZE], const char *name, lc_error *err);

/* The names of all scenes, sorted; release with lc_scene_names_free. */
lc_status lc_scene_names(char ***names, int *count, lc_error *err);
void lc_scene_names_free(char **names, int count);

#endif
