/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Calling an adapter: a scene file, a command, images.
 */
#include "verify/renderers/adapter_c.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/exr.h"
#include "io/scene_write.h"
#include "verify/renderers/replicates.h"

enum { MOST_BATCH = 256, WORD = 24 };

/* The last line that it said. */
static void last_words(char words[256], const char *folder)
{
    char path[LC_PROGRAM_PATH], line[256];
    snprintf(path, sizeof path, "%.*s/log", LC_PROGRAM_PATH - 64, folder);
    FILE *log = fopen(path, "rb");
    snprintf(words, 256, "it said nothing");
    while (log && fgets(line, sizeof line, log)) {
        line[strcspn(line, "\r\n")] = 0;
        if (line[0])
            snprintf(words, 256, "%.255s", line);
    }
    if (log)
        fclose(log);
}

/* ---- what it says of itself -------------------------------------------------------------------------------------- */

typedef struct word {
    const char *name;
    unsigned bit;
} word;

static const word lobe_words[] = {
    {"diffuse", LC_DIFFUSE}, {"mirror", LC_MIRROR}, {"glass", LC_GLASS}, {"glossy", LC_GLOSSY}, {NULL, 0}};
static const word emitter_words[] = {
    {"area", LC_AREA}, {"point", LC_POINT}, {"directional", LC_DIRECTIONAL}, {"sky", LC_SKY}, {NULL, 0}};

/* "diffuse,mirror"; 0 when a word is none of these. */
static int read_set(unsigned *out, const char *text, const word *words)
{
    *out = 0;
    while (*text) {
        size_t length = strcspn(text, ",");
        const word *w = words;
        while (w->name && !(strlen(w->name) == length && strncmp(w->name, text, length) == 0))
            ++w;
        if (!w->name)
            return 0;
        *out |= w->bit;
        text += length + (text[length] == ',');
    }
    return 1;
}

static int read_number(double *out, const char *text, double least, double most)
{
    char *end;
    *out = strtod(text, &end);
    return end != text && *end == 0 && *out >= least && *out <= most;
}

static int take(lc_adapter *a, const char *key, const char *value)
{
    double number = 0;
    int ok = 0;
    if (strcmp(key, "name") == 0) {
        ok = value[0] && strlen(value) < sizeof a->name && value[strspn(value, "abcdefghijklmnopqrstuvwxyz"
                                                                             "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-")] == 0;
        if (ok)
            snprintf(a->name, sizeof a->name, "%s", value);
    } else if (strcmp(key, "lobes") == 0) {
        ok = read_set(&a->estimator.lobes, value, lobe_words);
    } else if (strcmp(key, "emitters") == 0) {
        ok = read_set(&a->estimator.emitters, value, emitter_words);
    } else if (strcmp(key, "max_bounces") == 0) {
        ok = read_number(&number, value, 0, LC_UNBOUNDED) && number == floor(number);
        a->estimator.max_bounces = (int)number;
    } else if (strcmp(key, "rounding") == 0) {
        ok = read_number(&a->rounding, value, 0, 0.01);
    } else if (strcmp(key, "batch") == 0) {
        ok = read_number(&number, value, 1, MOST_BATCH) && number == floor(number);
        a->batch = (int)number;
    } else if (strcmp(key, "noise") == 0) {
        ok = strcmp(value, "seed") == 0 || strcmp(value, "none") == 0;
        a->is_exact = strcmp(value, "none") == 0;
    }
    return ok;
}

static lc_status read_description(lc_adapter *a, const char *folder, lc_error *err)
{
    char path[LC_PROGRAM_PATH], line[512];
    lc_status status = LC_OK;
    snprintf(path, sizeof path, "%.*s/log", LC_PROGRAM_PATH - 64, folder);
    FILE *log = fopen(path, "rb");
    while (log && status == LC_OK && fgets(line, sizeof line, log)) {
        line[strcspn(line, "\r\n")] = 0;
        char *equals = strchr(line, '=');
        if (equals)
            *equals = 0;
        if (line[0] && (!equals || !take(a, line, equals + 1)))
            status = lc_fail(err, LC_BAD_INPUT,
                             "%s --describe: cannot understand '%.100s%s%.100s'; expected name, lobes, emitters, "
                             "max_bounces, rounding, batch or noise=seed|none",
                             a->path, line, equals ? "=" : "", equals ? equals + 1 : "");
    }
    if (log)
        fclose(log);
    return status;
}

static lc_status describe(lc_adapter *a, lc_error *err)
{
    char folder[LC_PROGRAM_PATH];
    const char *arguments[] = {a->path, "--describe", NULL};
    int exit_status = 0;
    lc_status status = lc_program_folder(folder, err);
    if (status != LC_OK)
        return status;
    lc_program program = {a->path, a->path, arguments, NULL, folder, a->seconds};
    status = lc_program_run(&exit_status, &program, err);
    if (status == LC_OK && WIFEXITED(exit_status) && WEXITSTATUS(exit_status) == 127)
        status = lc_fail(err, LC_BAD_INPUT, "%s: cannot be run", a->path);
    else if (status == LC_OK && WIFEXITED(exit_status) && WEXITSTATUS(exit_status) == 0)
        status = read_description(a, folder, err);
    lc_program_clear(folder);
    return status;
}

static void name_after_file(lc_adapter *a)
{
    const char *slash = strrchr(a->path, '/'), *stem = slash ? slash + 1 : a->path, *dot = strrchr(stem, '.');
    snprintf(a->name, sizeof a->name, "%.*s", dot && dot > stem ? (int)(dot - stem) : 63, stem);
}

lc_status lc_adapter_prepare(lc_adapter *out, const char *path, lc_error *err)
{
    memset(out, 0, sizeof *out);
    char here[LC_PROGRAM_PATH] = "";
    if ((path[0] != '/' && !getcwd(here, sizeof here - 1)) ||
        snprintf(out->path, sizeof out->path, "%s%s%s", here, here[0] ? "/" : "", path) >= LC_PROGRAM_PATH)
        return lc_fail(err, LC_BAD_INPUT, "%s: too long a path", path);
    name_after_file(out);
    out->estimator = (lc_estimator){LC_ABI,
                                    out->name,
                                    "a renderer behind an adapter",
                                    "its own",
                                    LC_DIFFUSE | LC_MIRROR | LC_GLASS | LC_GLOSSY,
                                    LC_AREA | LC_POINT | LC_DIRECTIONAL | LC_SKY,
                                    LC_UNBOUNDED,
                                    NULL};
    out->rounding = 1e-6;
    out->batch = 1;
    return LC_OK;
}

lc_status lc_adapter_open(lc_adapter *out, const char *path, double seconds, lc_error *err)
{
    char found[LC_PROGRAM_PATH];
    struct stat info;
    if (stat(path, &info) == 0 && S_ISDIR(info.st_mode))
        return lc_replicates_open(out, path, err);
    if (!strchr(path, '/') && !lc_program_find(found, path))
        return lc_fail(err, LC_BAD_INPUT, "--renderer %s: there is no such program", path);
    lc_status status = lc_adapter_prepare(out, strchr(path, '/') ? path : found, err);
    if (status != LC_OK)
        return status;
    if (access(out->path, X_OK) != 0)
        return lc_fail(err, LC_BAD_INPUT, "--renderer %s: not an executable: %s", path, strerror(errno));
    out->seconds = seconds;
    return describe(out, err);
}

/* ---- images ------------------------------------------------------------------------------------------------------ */

static lc_status write_scene(const char *folder, const lc_scene_desc *desc, lc_error *err)
{
    char path[LC_PROGRAM_PATH];
    snprintf(path, sizeof path, "%.*s/scene.xml", LC_PROGRAM_PATH - 64, folder);
    FILE *file = fopen(path, "wb");
    if (!file)
        return lc_fail(err, LC_FAULT, "%s: cannot write: %s", path, strerror(errno));
    lc_status status = lc_scene_write(file, desc, err);
    if (fclose(file) != 0 && status == LC_OK)
        status = lc_fail(err, LC_FAULT, "%s: cannot write: %s", path, strerror(errno));
    return status;
}

lc_status lc_adapter_read_image(float *rgb, const char *path, const lc_scene_desc *d, const char *what, lc_error *err)
{
    lc_film *film = NULL;
    lc_error why = {""};
    lc_status status = lc_exr_read(&film, path, &why);
    if (status != LC_OK)
        return lc_fail(err, LC_FAULT, "%s: %.300s", what, why.text);
    if (film->width != d->width || film->height != d->height)
        status = lc_fail(err, LC_FAULT, "%s: %d x %d pixels, expected %d x %d", what, film->width, film->height, d->width, d->height);
    size_t count = (size_t)d->width * (size_t)d->height;
    for (size_t i = 0; status == LC_OK && i < count; ++i)
        for (size_t c = 0; c < 3; ++c) {
            double value = film->pixels[i].c[c].mean;
            if (film->bad || !(value >= 0 && value < INFINITY))
                status = lc_fail(err, LC_FAULT, "%s: the image has NaN, infinite or negative values", what);
            rgb[3 * i + c] = (float)value;
        }
    lc_film_free(film);
    return status;
}

static lc_status take_image(float *rgb, const lc_adapter *a, const lc_adapter_job *job, const char *folder, uint32_t seed,
                            lc_error *err)
{
    char path[LC_PROGRAM_PATH], words[256], what[256];
    snprintf(path, sizeof path, "%.*s/%lu.exr", LC_PROGRAM_PATH - 64, folder, (unsigned long)seed);
    last_words(words, folder);
    if (access(path, R_OK) != 0)
        return lc_fail(err, LC_FAULT, "%s wrote no image of %s, seed %lu: %s", a->name, job->scene->name, (unsigned long)seed, words);
    snprintf(what, sizeof what, "%s, %.100s, seed %lu", a->name, job->scene->name, (unsigned long)seed);
    lc_status status = lc_adapter_read_image(rgb, path, job->scene, what, err);
    unlink(path);
    return status;
}

/* One call: images of `count` seeds from `seed` on. */
static lc_status call(float *rgb, const lc_adapter *a, const lc_adapter_job *job, const char *folder, uint32_t seed,
                      int count, lc_error *err)
{
    char numbers[4][WORD], seeds[MOST_BATCH][WORD], files[MOST_BATCH][WORD], words[256];
    const char *arguments[2 * MOST_BATCH + 8] = {a->path, "scene.xml", numbers[0], numbers[1], numbers[2]};
    int given[4] = {job->scene->width, job->scene->height, job->samples, job->bounces}, at = 5, exit_status = 0;
    for (int i = 0; i < 4; ++i)
        snprintf(numbers[i], WORD, "%d", given[i]);
    for (int i = 0; i < count; ++i) {
        snprintf(seeds[i], WORD, "%lu", (unsigned long)seed + (unsigned long)i);
        snprintf(files[i], WORD, "%lu.exr", (unsigned long)seed + (unsigned long)i);
        arguments[at++] = seeds[i];
        if (i == 0)
            arguments[at++] = numbers[3];
        arguments[at++] = files[i];
    }
    arguments[at] = NULL;
    lc_program program = {a->path, a->name, arguments, NULL, folder, a->seconds};
    lc_status status = lc_program_run(&exit_status, &program, err);
    if (status != LC_OK)
        return status;
    last_words(words, folder);
    if (WIFSIGNALED(exit_status))
        return lc_fail(err, LC_FAULT, "%s was ended by signal %d over %s: %s", a->name, WTERMSIG(exit_status),
                       job->scene->name, words);
    if (WEXITSTATUS(exit_status) == 2)
        return lc_fail(err, LC_BAD_INPUT, "%s refuses %s: %s", a->name, job->scene->name, words);
    if (WEXITSTATUS(exit_status) != 0)
        return lc_fail(err, LC_FAULT, "%s failed with status %d over %s: %s", a->name, WEXITSTATUS(exit_status),
                       job->scene->name, words);
    size_t floats = 3 * (size_t)job->scene->width * (size_t)job->scene->height;
    for (int i = 0; i < count && status == LC_OK; ++i)
        status = take_image(rgb + (size_t)i * floats, a, job, folder, seed + (uint32_t)i, err);
    return status;
}

lc_status lc_adapter_render(float *rgb, const lc_adapter *a, const lc_adapter_job *job, lc_error *err)
{
    char folder[LC_PROGRAM_PATH];
    size_t floats = 3 * (size_t)job->scene->width * (size_t)job->scene->height;
    if (a->is_folder)
        return lc_replicates_read(rgb, a, job, err);
    lc_status status = lc_program_folder(folder, err);
    if (status != LC_OK)
        return status;
    status = write_scene(folder, job->scene, err);
    for (int done = 0; done < job->count && status == LC_OK; done += a->batch) {
        int count = job->count - done < a->batch ? job->count - done : a->batch;
        status = call(rgb + (size_t)done * floats, a, job, folder, job->seed + (uint32_t)done, count, err);
    }
    lc_program_clear(folder);
    return status;
}
