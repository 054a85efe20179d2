/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * assignment_files.h: what an assignment's file names besides: a table of sentences, scenes of its own.
 */
#ifndef LC_ASSIGNMENT_FILES_H
#define LC_ASSIGNMENT_FILES_H

#include "io/scene_path.h"
#include "verify/grade/assignment.h"

/* The path of a file as the assignment names it: beside the assignment, else in the working directory. 0: in neither can it be read,
 * and `path` is the first. */
int lc_assignment_find(char path[LC_PATH_SIZE], const lc_assignment *assignment, const char *name);
/* Of a scene: the same where it is named by a path, else the name. */
const char *lc_assignment_scene(char path[LC_PATH_SIZE], const lc_assignment *assignment, const char *name);

/* Calls `each` with the name and the path of every such file, once. With `is_public` those of visible tests only. Scenes name no files. */
void lc_assignment_files(const lc_assignment *assignment, int is_public, void (*each)(void *user, const char *name, const char *path),
                         void *user);

#endif
