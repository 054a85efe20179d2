/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Running POV-Ray: a folder, a child, a deadline, an image.
 */
#include "verify/renderers/pov_run.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "io/exr.h"

enum { PATH_SIZE = 4096, MOST_ARGUMENTS = 16 };

void lc_pov_run_init(lc_pov_run *run)
{
    const lc_pov_run defaults = {8, 0, 600};
    *run = defaults;
}

/* ---- the program ------------------------------------------------------------------------------------------------- */

/* The file of `povray` on PATH. Searched here, for a child may not. */
static lc_status find_program(char path[PATH_SIZE], lc_error *err)
{
    const char *list = getenv("PATH");
    for (const char *at = list ? list : "/usr/local/bin:/usr/bin:/bin"; *at;) {
        size_t length = strcspn(at, ":");
        int n = snprintf(path, PATH_SIZE, "%.*s%s", (int)length, at, length ? "/povray" : "./povray");
        struct stat info;
        if (n > 0 && n < PATH_SIZE && access(path, X_OK) == 0 && stat(path, &info) == 0 && S_ISREG(info.st_mode))
            return LC_OK;
        at += length + (at[length] == ':');
    }
    return lc_fail(err, LC_BAD_INPUT, "there is no program `povray`: install POV-Ray 3.7 (package povray)");
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Waits for the child, kills it at the deadline. */
static lc_status wait_for(pid_t child, double seconds, int *exit_status, lc_error *err)
{
    double deadline = now() + seconds;
    for (;;) {
        pid_t done = waitpid(child, exit_status, WNOHANG);
        if (done == child)
            return LC_OK;
        if (done < 0 && errno != EINTR)
            return lc_fail(err, LC_FAULT, "cannot wait for POV-Ray: %s", strerror(errno));
        if (now() > deadline) {
            kill(child, SIGKILL);
            while (waitpid(child, exit_status, 0) < 0 && errno == EINTR)
                ;
            return lc_fail(err, LC_FAULT, "POV-Ray was stopped after %g s", seconds);
        }
        const struct timespec pause = {0, 5000000};
        nanosleep(&pause, NULL);
    }
}

/* Between fork and exec only what a signal handler may do: other threads may hold any lock. */
static void become(const char *program, char *const *arguments, char *const *environment, const char *folder)
{
    int null = open("/dev/null", O_RDONLY);
    if (chdir(folder) != 0 || null < 0 || dup2(null, 0) < 0)
        _exit(127);
    int log = open("log", O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (log < 0 || dup2(log, 1) < 0 || dup2(log, 2) < 0)
        _exit(127);
    execve(program, arguments, environment);
    _exit(127);
}

static lc_status run_program(int *exit_status, const char *const *options, const char *folder, double seconds,
                             lc_error *err)
{
    char program[PATH_SIZE], home[PATH_SIZE], name[] = "povray", locale[] = "LC_ALL=C";
    char words[MOST_ARGUMENTS][64], *arguments[MOST_ARGUMENTS + 2] = {name};
    char *const environment[] = {home, locale, NULL};
    lc_status status = find_program(program, err);
    if (status != LC_OK)
        return status;
    snprintf(home, sizeof home, "HOME=%s", folder);
    for (int i = 0; options[i] && i < MOST_ARGUMENTS; ++i) {
        snprintf(words[i], sizeof words[i], "%s", options[i]);
        arguments[i + 1] = words[i];
        arguments[i + 2] = NULL;
    }
    pid_t child = fork();
    if (child < 0)
        return lc_fail(err, LC_FAULT, "cannot start POV-Ray: %s", strerror(errno));
    if (child == 0)
        become(program, arguments, environment, folder);
    return wait_for(child, seconds, exit_status, err);
}

/* ---- its folder -------------------------------------------------------------------------------------------------- */

static lc_status make_folder(char folder[PATH_SIZE], lc_error *err)
{
    const char *base = getenv("TMPDIR");
    int n = snprintf(folder, PATH_SIZE - 64, "%s/lightcheck-pov-XXXXXX", base && base[0] ? base : "/tmp");
    if (n < 0 || n >= PATH_SIZE - 64)
        return lc_fail(err, LC_BAD_INPUT, "TMPDIR is too long a path");
    if (!mkdtemp(folder))
        return lc_fail(err, LC_FAULT, "%s: cannot make a folder for POV-Ray: %s", folder, strerror(errno));
    return LC_OK;
}

static void remove_folder(const char *folder)
{
    char path[PATH_SIZE];
    DIR *dir = opendir(folder);
    for (struct dirent *entry = dir ? readdir(dir) : NULL; entry; entry = readdir(dir))
        if (snprintf(path, sizeof path, "%s/%s", folder, entry->d_name) < PATH_SIZE)
            unlink(path); /* "." and ".." stay */
    if (dir)
        closedir(dir);
    rmdir(folder);
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
    lc_status status = find_program(path, err);
    if (status == LC_OK)
        status = make_folder(folder, err);
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
    remove_folder(folder);
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
    lc_status status = make_folder(folder, err);
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
    remove_folder(folder);
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
