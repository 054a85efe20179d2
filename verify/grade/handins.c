/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/grade/handins.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "verify/grade/compile.h"
#include "verify/renderers/replicates.h"

enum { PATH_SIZE = 4096, MOST_DEPTH = 8 };

static char *copy_text(const char *text)
{
    size_t size = strlen(text) + 1;
    char *copy = malloc(size);
    return copy ? memcpy(copy, text, size) : NULL;
}

/* "a/b/" -> "b" */
static void name_of(char *name, size_t size, const char *path)
{
    size_t end = strlen(path);
    while (end > 1 && path[end - 1] == '/')
        --end;
    size_t begin = end;
    while (begin > 0 && path[begin - 1] != '/')
        --begin;
    snprintf(name, size, "%.*s", (int)(end - begin), path + begin);
}

static lc_status no_memory(lc_error *err) { return lc_fail(err, LC_FAULT, "out of memory for the hand-ins"); }

static lc_status add(lc_handins *out, const char *name, const char *path, const char *why, time_t when, lc_error *err)
{
    lc_handin *items = realloc(out->items, ((size_t)out->count + 1) * sizeof *items);
    if (!items)
        return no_memory(err);
    out->items = items;
    lc_handin *h = &items[out->count++];
    *h = (lc_handin){.name = copy_text(name), .path = path ? copy_text(path) : NULL, .why = path ? NULL : copy_text(why), .time = when};
    return h->name && (path ? h->path : h->why) ? LC_OK : no_memory(err);
}

static const lc_handins_options defaults = {0, 0, NULL};

/* ---- a folder that is one hand-in ------------------------------------------------------------------------------------ */

typedef struct search {
    char path[PATH_SIZE]; /* of the first source file */
    char names[256];      /* of all */
    int count;
    int adapters;         /* 1: these are looked for, too */
    char adapter[PATH_SIZE];
} search;

static int is_adapter(const char *name, const struct stat *info)
{
    return strncmp(name, "adapter", 7) == 0 && (name[7] == 0 || name[7] == '.') && (info->st_mode & S_IXUSR);
}

static void look_into(search *s, const char *folder, int depth)
{
    DIR *dir = depth < MOST_DEPTH ? opendir(folder) : NULL;
    if (!dir)
        return;
    for (struct dirent *e = readdir(dir); e; e = readdir(dir)) {
        char path[PATH_SIZE];
        struct stat info;
        int n = snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        if (e->d_name[0] == '.' || strcmp(e->d_name, "__MACOSX") == 0 || n >= PATH_SIZE || lstat(path, &info) != 0)
            continue;
        if (S_ISDIR(info.st_mode))
            look_into(s, path, depth + 1);
        if (s->adapters && S_ISREG(info.st_mode) && is_adapter(e->d_name, &info))
            strcpy(s->adapter, path);
        if (!S_ISREG(info.st_mode) || !lc_is_source(e->d_name))
            continue;
        size_t used = strlen(s->names);
        if (s->count++ == 0)
            strcpy(s->path, path);
        snprintf(s->names + used, sizeof s->names - used, "%s%s", used ? ", " : "", e->d_name);
    }
    closedir(dir);
}

static lc_status add_folder(lc_handins *out, const char *name, const char *folder, time_t when, const lc_handins_options *options,
                            lc_error *err)
{
    char why[512];
    search *s = calloc(1, sizeof *s);
    if (!s)
        return no_memory(err);
    s->adapters = options->adapters;
    look_into(s, folder, 0);
    if (s->adapter[0])
        strcpy(s->path, s->adapter);
    if (s->count == 0)
        snprintf(why, sizeof why, "there is no source file (.c, .cc, .cpp, .cxx) in what was handed in%s",
                 options->images ? ", and no folder SCENE.BOUNCES of images (.exr)" : "");
    else
        snprintf(why, sizeof why, "expected one source file, and found %d: %s", s->count, s->names);
    struct stat info;
    int images = options->images && s->count == 0 && !s->adapter[0] && lc_replicates_are_in(folder);
    int one = (s->adapter[0] || s->count == 1) && lstat(s->path, &info) == 0;
    if (one)
        when = info.st_mtime;
    if (images)
        when = lc_replicates_time(folder);
    lc_status status = add(out, name, one ? s->path : images ? folder : NULL, why, when, err);
    if (status == LC_OK)
        out->items[out->count - 1].is_adapter = s->adapter[0] != 0;
    if (status == LC_OK)
        out->items[out->count - 1].is_images = images;
    free(s);
    return status;
}

/* ---- a folder of hand-ins --------------------------------------------------------------------------------------------- */

/* What no student has put there. */
static int is_left_by_a_system(const char *name)
{
    static const char *const names[] = {"index.html", "__MACOSX", "Thumbs.db", "desktop.ini"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i)
        if (strcasecmp(name, names[i]) == 0)
            return 1;
    return name[0] == '.';
}

static int is_among(const char *const *paths, const struct stat *info)
{
    struct stat other;
    for (; paths && *paths; ++paths)
        if (stat(*paths, &other) == 0 && other.st_dev == info->st_dev && other.st_ino == info->st_ino)
            return 1;
    return 0;
}

static int is_archive(const char *name)
{
    static const char *const ends[] = {".zip", ".tar", ".gz", ".tgz", ".xz", ".bz2", ".7z", ".rar"};
    const char *dot = strrchr(name, '.');
    for (size_t i = 0; dot && i < sizeof ends / sizeof ends[0]; ++i)
        if (strcasecmp(dot, ends[i]) == 0)
            return 1;
    return 0;
}

/* What was handed in, and is neither a source file nor a folder. */
static lc_status add_other(lc_handins *out, const char *name, const struct stat *info, lc_error *err)
{
    char why[512];
    const char *is = !info                       ? "cannot be read"
                     : S_ISLNK(info->st_mode)    ? "is a link, and none is followed"
                     : !S_ISREG(info->st_mode)   ? "is no regular file"
                     : is_archive(name)          ? "is an archive, and none is unpacked"
                                                 : "is no source file";
    snprintf(why, sizeof why, "%.200s %s; expected one source file (.c, .cc, .cpp, .cxx)", name, is);
    lc_status status = add(out, name, NULL, why, info ? info->st_mtime : 0, err);
    if (status == LC_OK)
        out->items[out->count - 1].is_other = 1;
    return status;
}

static lc_status add_entry(lc_handins *out, const char *folder, const char *name, const lc_handins_options *options, lc_error *err)
{
    char path[PATH_SIZE];
    struct stat info;
    int n = snprintf(path, sizeof path, "%s/%s", folder, name);
    if (n >= PATH_SIZE || lstat(path, &info) != 0)
        return add_other(out, name, NULL, err);
    if (is_among(options->except, &info))
        return LC_OK;
    if (S_ISREG(info.st_mode) && lc_is_source(name))
        return add(out, name, path, NULL, info.st_mtime, err);
    if (S_ISDIR(info.st_mode))
        return add_folder(out, name, path, info.st_mtime, options, err);
    return add_other(out, name, &info, err);
}

static lc_status add_all(lc_handins *out, const char *folder, const lc_handins_options *options, lc_error *err)
{
    lc_status status = LC_OK;
    DIR *dir = opendir(folder);
    if (!dir)
        return lc_fail(err, LC_BAD_INPUT, "%s: cannot read: %s", folder, strerror(errno));
    for (struct dirent *e = readdir(dir); e && status == LC_OK; e = readdir(dir))
        if (!is_left_by_a_system(e->d_name))
            status = add_entry(out, folder, e->d_name, options, err);
    closedir(dir);
    return status;
}

static int by_name(const void *a, const void *b)
{
    const lc_handin *x = a, *y = b;
    return strcmp(x->name, y->name);
}

static int has_one_to_grade(const lc_handins *h)
{
    for (int i = 0; i < h->count; ++i)
        if (!h->items[i].is_other)
            return 1;
    return 0;
}

lc_status lc_handins_find(lc_handins *out, const char *const *paths, int count, const lc_handins_options *options, lc_error *err)
{
    lc_status status = LC_OK;
    options = options ? options : &defaults;
    *out = (lc_handins){NULL, 0};
    for (int i = 0; i < count && status == LC_OK; ++i) {
        char name[PATH_SIZE];
        struct stat info;
        name_of(name, sizeof name, paths[i]);
        if (stat(paths[i], &info) != 0)
            status = lc_fail(err, LC_BAD_INPUT, "%s: cannot read: %s", paths[i], strerror(errno));
        else if (S_ISDIR(info.st_mode))
            status = add_all(out, paths[i], options, err);
        else if (lc_is_source(paths[i]))
            status = add(out, name, paths[i], NULL, info.st_mtime, err);
        else
            status = lc_fail(err, LC_BAD_INPUT, "%s: expected a source file (.c, .cc, .cpp, .cxx) or a folder", paths[i]);
    }
    if (status == LC_OK && !has_one_to_grade(out))
        status = lc_fail(err, LC_BAD_INPUT, "%s: no hand-in: expected source files (.c, .cc, .cpp, .cxx), or folders with one each",
                         count ? paths[0] : "");
    if (status == LC_OK)
        qsort(out->items, (size_t)out->count, sizeof *out->items, by_name);
    for (int i = 1; i < out->count && status == LC_OK; ++i)
        if (strcmp(out->items[i - 1].name, out->items[i].name) == 0)
            status = lc_fail(err, LC_BAD_INPUT, "two hand-ins are called %s", out->items[i].name);
    if (status != LC_OK)
        lc_handins_release(out);
    return status;
}

lc_status lc_handins_find_one(lc_handins *out, const char *folder, lc_error *err)
{
    char name[PATH_SIZE];
    struct stat info;
    *out = (lc_handins){NULL, 0};
    name_of(name, sizeof name, folder);
    if (stat(folder, &info) != 0 || !S_ISDIR(info.st_mode))
        return lc_fail(err, LC_BAD_INPUT, "%s: expected a folder", folder);
    lc_status status = add_folder(out, name, folder, info.st_mtime, &defaults, err);
    if (status != LC_OK)
        lc_handins_release(out);
    return status;
}

void lc_handins_release(lc_handins *handins)
{
    for (int i = 0; i < handins->count; ++i) {
        free(handins->items[i].name);
        free(handins->items[i].path);
        free(handins->items[i].why);
    }
    free(handins->items);
    *handins = (lc_handins){NULL, 0};
}
