/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/scene_path.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int ends_with(const char *text, const char *end)
{
    size_t n = strlen(text), m = strlen(end);
    return n >= m && strcmp(text + n - m, end) == 0;
}

/* Opens the scenes' folder and tells its path. */
static DIR *open_folder(char path[LC_PATH_SIZE])
{
    char exe[LC_PATH_SIZE - 32];
    ssize_t length = readlink("/proc/self/exe", exe, sizeof exe - 1);
    if (length > 0) {
        exe[length] = 0;
        char *slash = strrchr(exe, '/'); /* .../build/lightcheck -> .../build/../scenes */
        if (slash) {
            *slash = 0;
            snprintf(path, LC_PATH_SIZE, "%s/../scenes", exe);
            DIR *folder = opendir(path);
            if (folder)
                return folder;
        }
    }
    snprintf(path, LC_PATH_SIZE, "scenes");
    return opendir(path);
}

static int by_name(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

lc_status lc_scene_names(char ***names, int *count, lc_error *err)
{
    char path[LC_PATH_SIZE];
    *names = NULL;
    *count = 0;
    DIR *folder = open_folder(path);
    if (!folder)
        return lc_fail(err, LC_BAD_INPUT,
                       "no folder scenes/ here or beside the program: give a path to an .xml file instead");
    for (struct dirent *entry = readdir(folder); entry; entry = readdir(folder)) {
        if (!ends_with(entry->d_name, ".xml"))
            continue;
        size_t stem = strlen(entry->d_name) - 4;
        char **longer = realloc(*names, ((size_t)*count + 1) * sizeof **names);
        char *name = malloc(stem + 1);
        if (longer)
            *names = longer;
        if (!longer || !name) {
            free(name);
            closedir(folder);
            lc_scene_names_free(*names, *count);
            *names = NULL;
            return lc_fail(err, LC_FAULT, "out of memory for the list of scenes");
        }
        memcpy(name, entry->d_name, stem);
        name[stem] = 0;
        (*names)[(*count)++] = name;
    }
    closedir(folder);
    if (*count)
        qsort(*names, (size_t)*count, sizeof **names, by_name);
    return LC_OK;
}

void lc_scene_names_free(char **names, int count)
{
    for (int i = 0; i < count; ++i)
        free(names[i]);
    free(names);
}

static lc_status unknown_scene(const char *name, lc_error *err)
{
    char **names, list[sizeof err->text - 128] = "";
    int count;
    lc_status status = lc_scene_names(&names, &count, err);
    if (status != LC_OK)
        return status;
    size_t used = 0;
    for (int i = 0; i < count && used + strlen(names[i]) + 3 < sizeof list; ++i)
        used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "", names[i]);
    lc_scene_names_free(names, count);
    return lc_fail(err, LC_BAD_INPUT, "unknown scene '%s'; expected a path to an .xml file or one of: %s", name, list);
}

int lc_scene_is_path(const char *name) { return strchr(name, '/') || ends_with(name, ".xml"); }

lc_status lc_scene_locate(char path[LC_PATH_SIZE], const char *name, lc_error *err)
{
    if (strlen(name) >= LC_PATH_SIZE / 2)
        return lc_fail(err, LC_BAD_INPUT, "the scene's path is longer than %d characters", LC_PATH_SIZE / 2);
    if (lc_scene_is_path(name)) {
        snprintf(path, LC_PATH_SIZE, "%s", name);
        return LC_OK;
    }
    DIR *folder = open_folder(path);
    if (!folder)
        return unknown_scene(name, err);
    closedir(folder);
    size_t length = strlen(path);
    if (length + strlen(name) + sizeof "/.xml" > LC_PATH_SIZE)
        return unknown_scene(name, err);
    snprintf(path + length, LC_PATH_SIZE - length, "/%s.xml", name);
    if (access(path, R_OK) != 0)
        return unknown_scene(name, err);
    return LC_OK;
}
