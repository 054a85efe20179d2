/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/renderers/replicates.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "io/hash_file.h"
#include "verify/renderers/adapter_c.h"

enum { MOST_NAME = 256, MOST_IMAGES = 1 << 16 };

/* ---- what lies in a folder ------------------------------------------------------------------------------------------ */

typedef struct names {
    char (*items)[MOST_NAME]; /* sorted */
    int count;
} names;

static int by_name(const void *left, const void *right) { return strcmp(left, right); }

/* 1 for "SCENE.BOUNCES". */
static int is_set(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot && dot > name && dot[1] && strspn(dot + 1, "0123456789") == strlen(dot + 1);
}

static int is_image(const char *name)
{
    size_t length = strlen(name);
    return length > 4 && strcmp(name + length - 4, ".exr") == 0;
}

/* Folders of images, or images: what is of the kind, begins with no dot and is no link. */
static lc_status list(names *out, const char *folder, int folders, lc_error *err)
{
    DIR *dir = opendir(folder);
    lc_status status = LC_OK;
    *out = (names){NULL, 0};
    for (struct dirent *e = dir ? readdir(dir) : NULL; e && status == LC_OK; e = readdir(dir)) {
        char path[LC_PROGRAM_PATH];
        struct stat info;
        int n = snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        if (e->d_name[0] == '.' || n >= LC_PROGRAM_PATH || strlen(e->d_name) >= MOST_NAME || lstat(path, &info) != 0 ||
            !(folders ? S_ISDIR(info.st_mode) && is_set(e->d_name) : S_ISREG(info.st_mode) && is_image(e->d_name)))
            continue;
        char(*items)[MOST_NAME] = realloc(out->items, ((size_t)out->count + 1) * sizeof *items);
        if (items)
            out->items = items;
        if (!items || out->count == MOST_IMAGES)
            status = lc_fail(err, items ? LC_BAD_INPUT : LC_FAULT, "%s: more files than can be read", folder);
        else
            strcpy(out->items[out->count++], e->d_name);
    }
    if (dir)
        closedir(dir);
    if (out->items)
        qsort(out->items, (size_t)out->count, sizeof *out->items, by_name);
    return status;
}

/* The images of one folder SCENE.BOUNCES. */
static lc_status list_set(names *out, char set[LC_PROGRAM_PATH], const lc_adapter *a, const char *scene, int bounces, lc_error *err)
{
    *out = (names){NULL, 0};
    if (snprintf(set, LC_PROGRAM_PATH, "%s/%s.%d", a->path, scene, bounces) >= LC_PROGRAM_PATH)
        return lc_fail(err, LC_BAD_INPUT, "%s: too long a path", a->path);
    return list(out, set, 0, err);
}

static int has_images(const char *folder, const char *set)
{
    char path[LC_PROGRAM_PATH];
    names images;
    lc_error none;
    if (snprintf(path, sizeof path, "%s/%s", folder, set) >= LC_PROGRAM_PATH)
        return 0;
    lc_status status = list(&images, path, 0, &none);
    free(images.items);
    return status == LC_OK && images.count > 0;
}

/* `scene` NULL: any. */
static int find_set(const char *folder, const char *scene)
{
    names sets;
    lc_error none;
    int found = 0;
    lc_status status = list(&sets, folder, 1, &none);
    for (int i = 0; status == LC_OK && i < sets.count && !found; ++i) {
        size_t length = (size_t)(strrchr(sets.items[i], '.') - sets.items[i]);
        if (!scene || (strlen(scene) == length && strncmp(scene, sets.items[i], length) == 0))
            found = has_images(folder, sets.items[i]);
    }
    free(sets.items);
    return found;
}

int lc_replicates_are_in(const char *folder) { return find_set(folder, NULL); }

int lc_replicates_show(const lc_adapter *a, const char *scene) { return !a->is_folder || find_set(a->path, scene); }

lc_status lc_replicates_open(lc_adapter *out, const char *folder, lc_error *err)
{
    lc_status status = lc_adapter_prepare(out, folder, err);
    if (status != LC_OK)
        return status;
    out->is_folder = 1;
    out->seconds = LC_ADAPTER_SECONDS;
    out->estimator.summary = "images that were rendered before";
    if (!lc_replicates_are_in(out->path))
        return lc_fail(err, LC_BAD_INPUT, "%s: no images: expected folders SCENE.BOUNCES (such as plane_rectangle.1) of .exr files", folder);
    return LC_OK;
}

/* ---- images ------------------------------------------------------------------------------------------------------------ */

typedef struct print {
    uint64_t hash;
    int index;
} print;

static int by_hash(const void *left, const void *right)
{
    const print *a = left, *b = right;
    return a->hash != b->hash ? (a->hash > b->hash) - (a->hash < b->hash) : a->index - b->index;
}

/* One image twice has no noise of its own the second time; but light without any noise gives one image only. */
static lc_status refuse_copies(const names *images, const char *set, lc_error *err)
{
    print *prints = malloc((size_t)images->count * sizeof *prints);
    lc_status status = prints ? LC_OK : lc_fail(err, LC_FAULT, "out of memory for the images of %s", set);
    for (int i = 0; i < images->count && prints; ++i) {
        char path[LC_PROGRAM_PATH];
        snprintf(path, sizeof path, "%.*s/%s", LC_PROGRAM_PATH - MOST_NAME - 2, set, images->items[i]);
        prints[i] = (print){lc_hash_file(LC_HASH, path), i};
    }
    if (prints)
        qsort(prints, (size_t)images->count, sizeof *prints, by_hash);
    for (int i = 1; i < images->count && status == LC_OK && prints[0].hash != prints[images->count - 1].hash; ++i)
        if (prints[i].hash == prints[i - 1].hash)
            status = lc_fail(err, LC_BAD_INPUT, "%s: %s and %s are the same image; each has to have a seed of its own", strrchr(set, '/') + 1,
                             images->items[prints[i - 1].index], images->items[prints[i].index]);
    free(prints);
    return status;
}

int lc_replicates_count(const lc_adapter *a, const lc_scene_desc *scene, int bounces)
{
    char set[LC_PROGRAM_PATH];
    names images;
    lc_error none;
    lc_status status = list_set(&images, set, a, scene->name, bounces, &none);
    free(images.items);
    return status == LC_OK ? images.count : 0;
}

lc_status lc_replicates_differ(const lc_adapter *a, const lc_scene_desc *scene, int bounces, lc_error *err)
{
    char set[LC_PROGRAM_PATH];
    names images;
    lc_status status = list_set(&images, set, a, scene->name, bounces, err);
    if (status == LC_OK && images.count > 0)
        status = refuse_copies(&images, set, err);
    free(images.items);
    return status;
}

lc_status lc_replicates_read(float *rgb, const lc_adapter *a, const lc_adapter_job *job, lc_error *err)
{
    char set[LC_PROGRAM_PATH];
    names images;
    size_t floats = 3 * (size_t)job->scene->width * (size_t)job->scene->height;
    lc_status status = list_set(&images, set, a, job->scene->name, job->bounces, err);
    if (status == LC_OK && (int64_t)job->seed + job->count > images.count)
        status = lc_fail(err, LC_BAD_INPUT, "%s.%d: %d images, too few", job->scene->name, job->bounces, images.count);
    for (int i = 0; i < job->count && status == LC_OK; ++i) {
        char path[LC_PROGRAM_PATH], what[2 * MOST_NAME];
        const char *name = images.items[job->seed + (uint32_t)i];
        snprintf(path, sizeof path, "%.*s/%s", LC_PROGRAM_PATH - MOST_NAME - 2, set, name);
        snprintf(what, sizeof what, "%.100s.%d/%s", job->scene->name, job->bounces, name);
        status = lc_adapter_read_image(rgb + (size_t)i * floats, path, job->scene, what, err);
    }
    free(images.items);
    return status;
}

typedef void visit_image(void *user, const char *set, const char *name, const char *path);

/* All images of a folder, in the order of their names. */
static void visit_all(const char *folder, visit_image *visit, void *user)
{
    names sets;
    lc_error none;
    list(&sets, folder, 1, &none);
    for (int s = 0; s < sets.count; ++s) {
        char set[LC_PROGRAM_PATH], path[LC_PROGRAM_PATH];
        names images;
        snprintf(set, sizeof set, "%.*s/%s", LC_PROGRAM_PATH - MOST_NAME - 2, folder, sets.items[s]);
        list(&images, set, 0, &none);
        for (int i = 0; i < images.count; ++i) {
            snprintf(path, sizeof path, "%.*s/%s", LC_PROGRAM_PATH - MOST_NAME - 2, set, images.items[i]);
            visit(user, sets.items[s], images.items[i], path);
        }
        free(images.items);
    }
    free(sets.items);
}

static void mix_image(void *user, const char *set, const char *name, const char *path)
{
    uint64_t *hash = user;
    *hash = lc_hash(lc_hash(*hash, set, strlen(set)), name, strlen(name));
    *hash = lc_hash_file(*hash, path);
}

uint64_t lc_replicates_digest(const char *folder)
{
    uint64_t hash = LC_HASH;
    visit_all(folder, mix_image, &hash);
    return hash;
}

static void find_newest(void *user, const char *set, const char *name, const char *path)
{
    time_t *newest = user;
    struct stat info;
    (void)set;
    (void)name;
    if (lstat(path, &info) == 0 && info.st_mtime > *newest)
        *newest = info.st_mtime;
}

time_t lc_replicates_time(const char *folder)
{
    time_t newest = 0;
    visit_all(folder, find_newest, &newest);
    return newest;
}
