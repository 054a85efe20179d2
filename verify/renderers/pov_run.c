/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Running POV-Ray: a scene, a child, an image.
 */
#include "verify/renderers/pov_run.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/exr.h"
#include "verify/renderers/program.h"

enum { PATH_SIZE = LC_PROGRAM_PATH, MOST_ARGUMENTS = 16 };

void lc_pov_run_init(lc_pov_run *run)
{
    const lc_pov_run defaults = {8, 0, 600};
    *run = defaults;
}

/* ---- the program ------------------------------------------------------------------------------------------------- */

/* In `folder`, with that as HOME and nothing else of the user's, so that no configuration changes the image. */
static lc_status run_program(int *exit_status, const char *const *options, const char *folder, double seconds,
                             lc_error *err)
{
    char program[LC_PROGRAM_PATH], home[LC_PROGRAM_PATH], locale[] = "LC_ALL=C";
    const char *arguments[MOST_ARGUMENTS + 2] = {"povray"};
    char *const environment[] = {home, locale, NULL};
    if (!lc_program_find(program, "povray"))
        return lc_fail(err, LC_BAD_INPUT, "there is no program `povray`: install POV-Ray 3.7 (package povray)");
    snprintf(home, sizeof home, "HOME=%.*s", LC_PROGRAM_PATH - 8, folder);
    for (int i = 0; options[i] && i < MOST_ARGUMENTS; ++i) {
        arguments[i + 1] = options[i];
        arguments[i + 2] = NULL;
    }
    lc_program run = {program, "POV-Ray", arguments, environment, folder, seconds};
    return lc_program_run(exit_status, &run, err);
}

static lc_status write_scene(const char *folder, const char *text, size_t length, lc_error *err)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%.*s/scene.pov", PATH_SIZE - 64, folder);
    FILE *file = fopen(path, "wb");
    int ok = file && fwrite(text, 1, length, file) == length;
    if (file && fclose(file) != 0)
        ok = 0;
    return ok ? LC_OK : lc_fail(err, LC_FAULT, "%s: cannot write: %s", path, strerror(errno));
}

/* The first and last lines of the log that speak of an error, else its last line. */
static lc_status report_failure(const char *folder, int exit_status, lc_error *err)
{
    char path[PATH_SIZE], line[512], first[300] = "", last[300] = "", end[300] = "";
    snprintf(path, sizeof path, "%.*s/log", PATH_SIZE - 64, folder);
    FILE *log = fopen(path, "rb");
    while (log && fgets(line, sizeof line, log)) {
        line[strcspn(line, "\r\n")] = 0;
        if (line[0])
            snprintf(end, sizeof end, "%.299s", line);
        if (!strstr(line, "rror"))
            continue;
        snprintf(first[0] ? last : first, sizeof first, "%.299s", line);
    }
    if (log)
        fclose(log);
    const char *words = first[0] ? first : end;
    if (WIFSIGNALED(exit_status))
        return lc_fail(err, LC_FAULT, "POV-Ray was ended by signal %d: %s", WTERMSIG(exit_status), words);
    return lc_fail(err, LC_FAULT, "POV-Ray failed with status %d: %s%s%s", WEXITSTATUS(exit_status), words,
                   last[0] ? "; " : "", last);
}

lc_status lc_pov_version(char *version, size_t size, lc_error *err)
{
    static const char *const options[] = {"--version", NULL};
    char folder[PATH_SIZE], path[PATH_SIZE], line[256];
    int exit_status = 0, found = 0;
    lc_status status = lc_program_folder(folder, err);
    if (status != LC_OK)
        return status;
    status = run_program(&exit_status, options, folder, 30, err);
    snprintf(path, sizeof path, "%.*s/log", PATH_SIZE - 64, folder);
    FILE *log = status == LC_OK ? fopen(path, "rb") : NULL;
    while (log && !found && fgets(line, sizeof line, log)) {
        static const char start[] = "POV-Ray ";
        found = strncmp(line, start, sizeof start - 1) == 0;
        line[strcspn(line, "\r\n")] = 0;
        if (found)
            snprintf(version, size, "%s", line + sizeof start - 1);
    }
    if (log)
        fclose(log);
    if (status == LC_OK && !found)
        status = report_failure(folder, exit_status, err);
    lc_program_clear(folder);
    return status;
}

/* ---- an image ---------------------------------------------------------------------------------------------------- */

/* Means of s x s blocks. */
static lc_status average(double *rgb, const lc_film *film, int width, int height, int s, lc_error *err)
{
    if (film->width != width * s || film->height != height * s)
        return lc_fail(err, LC_FAULT, "POV-Ray wrote %d x %d pixels, expected %d x %d", film->width, film->height,
                       width * s, height * s);
    if (film->bad)
        return lc_fail(err, LC_FAULT, "POV-Ray wrote %llu pixels that are not finite, the first at %d,%d",
                       (unsigned long long)film->bad, film->bad_x, film->bad_y);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) {
                double sum = 0;
                for (int j = 0; j < s; ++j)
                    for (int i = 0; i < s; ++i)
                        sum += film->pixels[(size_t)(y * s + j) * (size_t)film->width + (size_t)(x * s + i)].c[c].mean;
                rgb[3 * ((size_t)y * (size_t)width + (size_t)x) + (size_t)c] = sum / (s * s);
            }
    return LC_OK;
}

lc_status lc_pov_render_text(double *rgb, const char *text, size_t length, int width, int height, const lc_pov_run *run,
                             lc_error *err)
{
    char folder[PATH_SIZE], path[PATH_SIZE], w[32], h[32], threads[32];
    int exit_status = 0, s = run->supersampling;
    lc_film *film = NULL;
    if (s < 1 || s > 16 || width < 1 || height < 1 || width > LC_MAX_SIZE / s || height > LC_MAX_SIZE / s)
        return lc_fail(err, LC_BAD_INPUT, "%d x %d pixels, %d times as many a side for POV-Ray: expected 1 to %d",
                       width, height, s, LC_MAX_SIZE);
    lc_status status = lc_program_folder(folder, err);
    if (status != LC_OK)
        return status;
    long cores = run->threads > 0 ? run->threads : sysconf(_SC_NPROCESSORS_ONLN);
    snprintf(w, sizeof w, "+W%d", width * s);
    snprintf(h, sizeof h, "+H%d", height * s);
    snprintf(threads, sizeof threads, "+WT%ld", cores < 1 ? 1 : cores > 64 ? 64 : cores);
    const char *const options[] = {"+Iscene.pov", "+Oscene.exr", "+FE", w,    h,    threads,
                                   "-A",          "-D",          "-P",  "-V", "-C", NULL};
    status = write_scene(folder, text, length, err);
    if (status == LC_OK)
        status = run_program(&exit_status, options, folder, run->seconds, err);
    snprintf(path, sizeof path, "%.*s/scene.exr", PATH_SIZE - 64, folder);
    if (status == LC_OK && (!WIFEXITED(exit_status) || WEXITSTATUS(exit_status) != 0 || access(path, R_OK) != 0))
        status = report_failure(folder, exit_status, err);
    if (status == LC_OK)
        status = lc_exr_read(&film, path, err);
    if (status == LC_OK)
        status = average(rgb, film, width, height, s, err);
    lc_film_free(film);
    lc_program_clear(folder);
    return status;
}

lc_status lc_pov_render(double *rgb, const lc_scene_desc *desc, const lc_pov_options *options, const lc_pov_run *run,
                        lc_error *err)
{
    char *text = NULL;
    size_t length = 0;
    FILE *memory = open_memstream(&text, &length);
    if (!memory)
        return lc_fail(err, LC_FAULT, "out of memory for a scene of POV-Ray");
    lc_status status = lc_pov_export(memory, desc, options, err);
    if (fclose(memory) != 0 && status == LC_OK)
        status = lc_fail(err, LC_FAULT, "out of memory for a scene of POV-Ray");
    if (status == LC_OK)
        status = lc_pov_render_text(rgb, text, length, desc->width, desc->height, run, err);
    free(text);
    return status;
}
