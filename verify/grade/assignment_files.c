/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/grade/assignment_files.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

int lc_assignment_find(char path[LC_PATH_SIZE], const lc_assignment *assignment, const char *name)
{
    const char *slash = name[0] == '/' ? NULL : strrchr(assignment->path, '/');
    snprintf(path, LC_PATH_SIZE, "%.*s%s", slash ? (int)(slash + 1 - assignment->path) : 0, assignment->path, name);
    if (access(path, R_OK) == 0)
        return 1;
    if (access(name, R_OK) != 0)
        return 0;
    snprintf(path, LC_PATH_SIZE, "%s", name);
    return 1;
}

const char *lc_assignment_scene(char path[LC_PATH_SIZE], const lc_assignment *assignment, const char *name)
{
    if (!lc_scene_is_path(name))
        return name;
    lc_assignment_find(path, assignment, name);
    return path;
}

/* Whether a scene stands in an earlier place than this one, of those that are told. */
static int is_told(const lc_assignment *a, int is_public, int test, int scene)
{
    for (int i = 0; i <= test; ++i)
        for (int s = 0; s < (i == test ? scene : a->tests[i].scene_count); ++s)
            if ((!is_public || a->tests[i].visibility == LC_VISIBLE) && strcmp(a->tests[i].scenes[s], a->tests[test].scenes[scene]) == 0)
                return 1;
    return 0;
}

void lc_assignment_files(const lc_assignment *a, int is_public, void (*each)(void *user, const char *name, const char *path), void *user)
{
    char path[LC_PATH_SIZE];
    if (a->sentences[0] && lc_assignment_find(path, a, a->sentences))
        each(user, a->sentences, path);
    for (int i = 0; i < a->test_count; ++i)
        for (int s = 0; s < a->tests[i].scene_count; ++s) {
            const char *scene = a->tests[i].scenes[s];
            int is_asked = !is_public || a->tests[i].visibility == LC_VISIBLE;
            if (is_asked && lc_scene_is_path(scene) && !is_told(a, is_public, i, s) && lc_assignment_find(path, a, scene))
                each(user, scene, path);
        }
}
