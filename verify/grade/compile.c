/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Three processes: the caller reads messages; a helper owns the folder, waits for the compiler, copies the object into
 * memory and removes the folder, whatever becomes of the caller; the compiler itself.
 */
#define _GNU_SOURCE
#include "verify/grade/compile.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "verify/grade/texts.h"

enum { PATH_SIZE = 4096, MOST_OUTPUT = 1 << 18, MOST_OBJECT = 16 << 20, MOST_SECONDS = 60 };

/* How a helper ends. */
enum { MADE, NOT_MADE, TOO_LONG, NO_COMPILER, FAULT };

typedef struct job {
    const char *path;
    const lc_compile_options *options;
    int image, messages;
    char folder[PATH_SIZE - 64];
} job;

static int ends_with_one_of(const char *path, const char *const *ends)
{
    size_t length = strlen(path);
    for (; *ends; ++ends)
        if (length > strlen(*ends) && strcmp(path + length - strlen(*ends), *ends) == 0)
            return 1;
    return 0;
}

static int is_cpp(const char *path)
{
    static const char *const ends[] = {".cc", ".cpp", ".cxx", NULL};
    return ends_with_one_of(path, ends);
}

int lc_is_source(const char *path)
{
    static const char *const ends[] = {".c", NULL};
    return is_cpp(path) || ends_with_one_of(path, ends);
}

/* ---- the compiler ------------------------------------------------------------------------------------------------ */

static void become_compiler(const job *j)
{
    char include[PATH_SIZE], out[PATH_SIZE], file[PATH_SIZE];
    const char *words[24];
    int n = 0, cpp = is_cpp(j->path);
    snprintf(include, sizeof include, "-I%s", j->folder);
    snprintf(out, sizeof out, "%s/plugin.so", j->folder);
    snprintf(file, sizeof file, "%s%s", j->path[0] == '-' ? "./" : "", j->path);
    words[n++] = cpp ? "c++" : "cc";
    words[n++] = cpp ? "-std=gnu++17" : "-std=gnu11";
    words[n++] = j->options->debug ? "-O0" : "-O2";
    /* As the program's own estimators, so that the same file gives the same bits. */
    words[n++] = "-ffp-contract=off";
    words[n++] = "-g";
    words[n++] = "-Wall";
    words[n++] = "-fPIC";
    words[n++] = "-shared";
    words[n++] = "-DLC_PLUGIN";
    words[n++] = include;
    words[n++] = "-o";
    words[n++] = out;
    words[n++] = file;
    if (cpp) {
        words[n++] = "-static-libstdc++";
        words[n++] = "-static-libgcc";
    }
    words[n++] = "-lm";
    words[n] = NULL;
    int null = open("/dev/null", O_RDONLY);
    if (null < 0 || dup2(null, 0) < 0 || dup2(j->messages, 1) < 0 || dup2(j->messages, 2) < 0 ||
        setenv("TMPDIR", j->folder, 1) != 0 || setenv("LC_ALL", "C", 1) != 0)
        _exit(127);
    close_range(3, ~0U, 0);
    signal(SIGPIPE, SIG_DFL);
    execvp(words[0], (char *const *)words);
    _exit(errno == ENOENT ? 126 : 127);
}

/* ---- the helper -------------------------------------------------------------------------------------------------- */

static volatile sig_atomic_t caller_died;

static void on_death(int number)
{
    (void)number;
    caller_died = 1;
}

static int write_all(int to, const void *data, size_t size)
{
    const char *at = data;
    while (size > 0) {
        ssize_t n = write(to, at, size);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return 0;
        at += n;
        size -= (size_t)n;
    }
    return 1;
}

static int make_folder(job *j)
{
    char path[PATH_SIZE];
    const char *base = getenv("TMPDIR"), *text = (const char *)lc_text_lightcheck_h;
    int n = snprintf(j->folder, sizeof j->folder, "%s/lightcheck-cc-XXXXXX", base && base[0] ? base : "/tmp");
    if (n < 0 || n >= (int)sizeof j->folder || !mkdtemp(j->folder)) {
        j->folder[0] = 0;
        return 0;
    }
    snprintf(path, sizeof path, "%s/lightcheck.h", j->folder);
    int header = open(path, O_WRONLY | O_CREAT | O_EXCL, 0644);
    int ok = header >= 0 && write_all(header, text, strlen(text));
    if (header >= 0)
        close(header);
    return ok;
}

static void remove_folder(const job *j)
{
    char path[PATH_SIZE + 256];
    DIR *dir = j->folder[0] ? opendir(j->folder) : NULL;
    if (!dir)
        return;
    for (struct dirent *entry = readdir(dir); entry; entry = readdir(dir)) {
        snprintf(path, sizeof path, "%s/%s", j->folder, entry->d_name);
        unlink(path); /* "." and ".." stay */
    }
    closedir(dir);
    rmdir(j->folder);
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int run_compiler(const job *j)
{
    int status = 0, ended = 0;
    pid_t compiler = fork();
    if (compiler < 0)
        return FAULT;
    if (compiler == 0) {
        setpgid(0, 0);
        become_compiler(j);
    }
    setpgid(compiler, compiler);
    for (double deadline = now() + MOST_SECONDS; !ended;) {
        const struct timespec pause = {0, 2000000};
        ended = waitpid(compiler, &status, WNOHANG) == compiler;
        if (!ended && (caller_died || now() > deadline))
            break;
        if (!ended)
            nanosleep(&pause, NULL);
    }
    kill(-compiler, SIGKILL); /* whatever the compiler left */
    if (!ended) {
        waitpid(compiler, &status, 0);
        return TOO_LONG;
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) >= 126)
        return WEXITSTATUS(status) == 126 ? NO_COMPILER : FAULT;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? MADE : NOT_MADE;
}

static int copy_object(const job *j)
{
    char path[PATH_SIZE], buffer[1 << 16];
    size_t size = 0;
    snprintf(path, sizeof path, "%s/plugin.so", j->folder);
    int from = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK);
    if (from < 0)
        return 0;
    for (;;) {
        ssize_t n = read(from, buffer, sizeof buffer);
        size += n > 0 ? (size_t)n : 0;
        if (n <= 0 || size > MOST_OBJECT || !write_all(j->image, buffer, (size_t)n)) {
            close(from);
            return n == 0;
        }
    }
}

static int help(job *j)
{
    struct sigaction action = {.sa_handler = on_death};
    pid_t caller = getppid();
    sigaction(SIGTERM, &action, NULL);
    signal(SIGINT, SIG_IGN);
    signal(SIGHUP, SIG_IGN);
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    caller_died |= getppid() != caller;
    int result = make_folder(j) ? run_compiler(j) : FAULT;
    if (result == MADE && !copy_object(j))
        result = FAULT;
    remove_folder(j);
    return result;
}

/* ---- the caller -------------------------------------------------------------------------------------------------- */

/* Reads to the end, or until it is too much; keeps what fits. */
static void read_messages(char *text, size_t size, int from)
{
    char buffer[4096];
    size_t used = 0, total = 0;
    while (total < MOST_OUTPUT) {
        ssize_t n = read(from, buffer, sizeof buffer);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            break;
        total += (size_t)n;
        size_t fits = size - 1 - used < (size_t)n ? size - 1 - used : (size_t)n;
        for (size_t i = 0; i < fits; ++i)
            text[used++] = buffer[i] ? buffer[i] : '?';
    }
    text[used] = 0;
}

/* The first line that speaks of an error, else the first of all. */
static lc_status report_error(const char *path, const char *messages, lc_error *err)
{
    static const char *const signs[] = {"error:", "multiple definition", "undefined reference", "ld:"};
    const char *line = messages;
    for (size_t i = 0; i < sizeof signs / sizeof signs[0] && line == messages; ++i) {
        const char *at = strstr(messages, signs[i]);
        while (at && at > messages && at[-1] != '\n')
            --at;
        line = at ? at : messages;
    }
    int length = (int)strcspn(line, "\n");
    return lc_fail(err, LC_BAD_INPUT, "%s does not compile: %.*s", path, length > 700 ? 700 : length,
                   length ? line : "the compiler failed and said nothing");
}

static lc_status report(const char *path, int result, const char *messages, lc_error *err)
{
    switch (result) {
    case MADE:
        return LC_OK;
    case NOT_MADE:
        return report_error(path, messages, err);
    case TOO_LONG:
        return lc_fail(err, LC_BAD_INPUT, "%s does not compile: the compiler was stopped after %d s", path,
                       MOST_SECONDS);
    case NO_COMPILER:
        return lc_fail(err, LC_FAULT, "there is no program `%s`: install gcc", is_cpp(path) ? "c++" : "cc");
    default:
        return lc_fail(err, LC_FAULT, "%s: cannot compile: no room in the temporary folder, or no processes", path);
    }
}

static lc_status open_pipes(job *j, int *from, lc_error *err)
{
    int ends[2];
    j->image = memfd_create("plugin", MFD_CLOEXEC | MFD_ALLOW_SEALING);
    if (j->image < 0)
        return lc_fail(err, LC_FAULT, "no file in memory for an object: %s", strerror(errno));
    if (pipe2(ends, O_CLOEXEC) != 0) {
        close(j->image);
        return lc_fail(err, LC_FAULT, "no pipe for a compiler: %s", strerror(errno));
    }
    *from = ends[0];
    j->messages = ends[1];
    return LC_OK;
}

lc_status lc_compile(lc_compiled *out, const char *path, const lc_compile_options *options, lc_error *err)
{
    static const lc_compile_options defaults = {0};
    job j = {.path = path, .options = options ? options : &defaults};
    int from = -1, status = 0;
    out->image = -1;
    out->messages[0] = 0;
    if (access(path, R_OK) != 0)
        return lc_fail(err, LC_BAD_INPUT, "%s: cannot read: %s", path, strerror(errno));
    lc_status opened = open_pipes(&j, &from, err);
    if (opened != LC_OK)
        return opened;
    pid_t helper = fork();
    if (helper == 0) {
        close(from);
        _exit(help(&j));
    }
    close(j.messages);
    if (helper > 0)
        read_messages(out->messages, sizeof out->messages, from);
    close(from);
    while (helper > 0 && waitpid(helper, &status, 0) < 0 && errno == EINTR)
        ;
    int result = helper > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : FAULT;
    if (result == MADE && fcntl(j.image, F_ADD_SEALS, F_SEAL_WRITE | F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0)
        result = FAULT;
    if (result == MADE)
        out->image = j.image;
    else
        close(j.image);
    return report(path, result, out->messages, err);
}
