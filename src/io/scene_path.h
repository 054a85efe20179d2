/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Scenes by name: the folder scenes/ beside the program's own folder (build/../scenes), else ./scenes.
 */
#ifndef LC_SCENE_PATH_H
#define LC_SCENE_PATH_H

#include "core/host.h"

enum { LC_PATH_SIZE = 4096 };

/* The path of `name`: itself when it has a slash or ends in .xml, else the file NAME.xml of the scenes' folder; LC_BAD_INPUT lists the valid names. */
lc_status lc_scene_locate(char path[LC_PATH_SIZE], const char *name, lc_error *err);

/* The names of all scenes, sorted; release with lc_scene_names_free. */
lc_status lc_scene_names(char ***names, int *count, lc_error *err);
void lc_scene_names_free(char **names, int count);

#endif
