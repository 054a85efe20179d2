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
#include <strings.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "verify/grade/texts.h"
#include "verify/grade/wire.h"

enum { PATH_SIZE = 4096, MOST_SOURCE = 1 << 20, MOST_OUTPUT = 1 << 18, MOST_OBJECT = 16 << 20, MOST_SECONDS = 60 };

/* How a helper ends. */
enum { MADE, NOT_MADE, TOO_LONG, NO_COMPILER, NO_FILE, FAULT };

typedef struct job {
    const char *path;
    const lc_compile_options *options;
    int image, messages, symbols; /* descriptors that the helper writes to; symbols: -1 where nobody asks */
    char folder[PATH_SIZE - 64];
} job;

static int ends_with(const char *path, const char *end, int (*compare)(const char *a, const char *b))
{
    size_t length = strlen(path);
    return length > strlen(end) && compare(path + length - strlen(end), end) == 0;
}

/* `.C` is C++ by the custom of cc and make; the other names mean the same in any case, as files from Windows come. */
static int is_cpp(const char *path)
{
    return ends_with(path, ".C", strcmp) || ends_with(path, ".cc", strcasecmp) || ends_with(path, ".cpp", strcasecmp) ||
           ends_with(path, ".cxx", strcasecmp);
}

int lc_is_source(const char *path) { return is_cpp(path) || ends_with(path, ".c", strcmp); }

/* ---- the compiler ------------------------------------------------------------------------------------------------ */

enum { MOST_WORDS = 24 };

/* The compiler's command line. A confined one works in the folder itself, which another user could not reach by its path. */
static void write_command(const char *words[MOST_WORDS], char texts[3][PATH_SIZE], const job *j)
{
    int n = 0, cpp = is_cpp(j->path), here = j->options->confined != NULL;
    const char *slash = strrchr(j->path, '/'), *base = here && slash ? slash + 1 : j->path;
    snprintf(texts[0], PATH_SIZE, "-I%s", here ? "." : j->folder);
    snprintf(texts[1], PATH_SIZE, "%s/plugin.so", here ? "." : j->folder);
    snprintf(texts[2], PATH_SIZE, "%s%s", base[0] == '-' ? "./" : "", base);
    words[n++] = cpp ? "c++" : "cc";
    words[n++] = cpp ? "-std=gnu++17" : "-std=gnu11";
    words[n++] = j->options->debug ? "-O0" : "-O2";
    words[n++] = "-ffp-contract=off"; /* as the program's own estimators, so that the same file gives the same bits */
    words[n++] = "-g";
    words[n++] = "-Wall";
    words[n++] = "-fPIC";
    words[n++] = "-shared";
    words[n++] = "-DLC_PLUGIN";
    words[n++] = texts[0];
    words[n++] = "-o";
    words[n++] = texts[1];
    words[n++] = "-x"; /* of .CXX and .CC not every compiler knows what they are */
    words[n++] = cpp ? "c++" : "c";
    words[n++] = texts[2];
    words[n++] = "-lm";
    words[n] = NULL;
}

/* In a child: runs a program, its output to `out` and its complaints to the messages. */
static void become(const job *j, const char *const *words, int out)
{
    const lc_confinement *c = j->options->confined;
    char path[] = "PATH=/usr/local/bin:/usr/bin:/bin", locale[] = "LC_ALL=C", temporary[] = "TMPDIR=.";
    char *const clean[] = {path, locale, temporary, NULL};
    int null = open("/dev/null", O_RDONLY);
    if (null < 0 || dup2(null, 0) < 0 || dup2(out, 1) < 0 || dup2(j->messages, 2) < 0)
        _exit(127);
    close_range(3, ~0U, 0);
    signal(SIGPIPE, SIG_DFL);
    signal(SIGXFSZ, SIG_DFL);
    if (c) {
        if (chdir(j->folder) != 0 || !(lc_confine_compiler(c) & LC_JAIL_LIMITS))
            _exit(127);
        execvpe(words[0], (char *const *)words, clean);
    } else if (setenv("TMPDIR", j->folder, 1) == 0 && setenv("LC_ALL", "C", 1) == 0) {
        execvp(words[0], (char *const *)words);
    }
    _exit(errno == ENOENT ? 126 : 127);
}

/* ---- the helper -------------------------------------------------------------------------------------------------- */

static volatile sig_atomic_t caller_died;

static void on_death(int number)
{
    (void)number;
    caller_died = 1;
}

/* Writes a file into the folder, for the prisoner where there is one. */
static int write_file(const job *j, const char *name, const void *data, size_t size)
{
    char path[PATH_SIZE + 256];
    snprintf(path, sizeof path, "%s/%.255s", j->folder, name);
    int file = open(path, O_WRONLY | O_CREAT | O_EXCL, 0644);
    int ok = file >= 0 && lc_wire_send(file, data, size);
    if (file >= 0)
        close(file);
    return ok;
}

static int make_folder(job *j)
{
    const lc_confinement *c = j->options->confined;
    const char *base = getenv("TMPDIR"), *text = (const char *)lc_text_lightcheck_h;
    int n = snprintf(j->folder, sizeof j->folder, "%s/lightcheck-cc-XXXXXX", base && base[0] ? base : "/tmp");
    if (n < 0 || n >= (int)sizeof j->folder || !mkdtemp(j->folder)) {
        j->folder[0] = 0;
        return 0;
    }
    if (!write_file(j, "lightcheck.h", text, strlen(text)))
        return 0;
    return !c || !(c->parts & LC_JAIL_USER) || geteuid() != 0 || chown(j->folder, LC_JAIL_UID, LC_JAIL_UID) == 0;
}

/* The copy that a confined compiler sees. No link is followed: it could lead to somebody else's file. */
static int copy_source(const job *j)
{
    static char source[MOST_SOURCE + 1]; /* the helper's own */
    const char *slash = strrchr(j->path, '/');
    struct stat info;
    size_t size = 0;
    ssize_t n = 1;
    int from = open(j->path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK);
    if (from < 0 || fstat(from, &info) != 0 || !S_ISREG(info.st_mode))
        n = -1;
    while (n > 0 && size < sizeof source) {
        n = read(from, source + size, sizeof source - size);
        size += n > 0 ? (size_t)n : 0;
    }
    if (from >= 0)
        close(from);
    return n == 0 && write_file(j, slash ? slash + 1 : j->path, source, size);
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

static int run(const job *j, const char *const *words, int out)
{
    int status = 0, ended = 0;
    pid_t compiler = fork();
    if (compiler < 0)
        return FAULT;
    if (compiler == 0) {
        setpgid(0, 0);
        become(j, words, out);
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
        if (n <= 0 || size > MOST_OBJECT || !lc_wire_send(j->image, buffer, (size_t)n)) {
            close(from);
            return n == 0;
        }
    }
}

static int compile(job *j)
{
    static const char *const list[] = {"nm", "-D", "-u", "-P", "./plugin.so", NULL};
    const char *words[MOST_WORDS];
    char texts[3][PATH_SIZE];
    if (!make_folder(j))
        return FAULT;
    if (j->options->confined && !copy_source(j))
        return NO_FILE;
    write_command(words, texts, j);
    int result = run(j, words, j->messages);
    if (result == MADE && j->symbols >= 0)
        result = run(j, list, j->symbols);
    return result == MADE && !copy_object(j) ? FAULT : result;
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
    int result = compile(j);
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
        return lc_fail(err, LC_FAULT, is_cpp(path) ? "there is no program `c++`: install g++" : "there is no program `cc`: install gcc");
    case NO_FILE:
        return lc_fail(err, LC_BAD_INPUT, "%s: expected a regular file, and no link, of at most %d bytes", path,
                       MOST_SOURCE);
    default:
        return lc_fail(err, LC_FAULT, "%s: cannot compile: no room in the temporary folder, or no processes", path);
    }
}

static lc_status open_files(job *j, int *from, lc_error *err)
{
    int ends[2] = {-1, -1};
    j->image = memfd_create("plugin", MFD_CLOEXEC | MFD_ALLOW_SEALING);
    j->symbols = j->options->confined ? memfd_create("symbols", MFD_CLOEXEC) : -1;
    int failed = j->image < 0 || (j->options->confined && j->symbols < 0) || pipe2(ends, O_CLOEXEC) != 0;
    *from = ends[0];
    j->messages = ends[1];
    return failed ? lc_fail(err, LC_FAULT, "no pipe or file in memory for a compiler: %s", strerror(errno)) : LC_OK;
}

/* "lc_next U" -> "lc_next"; a list that does not fit ends in '?'. */
static void read_symbols(char *text, size_t size, int from)
{
    char line[512];
    size_t used = 0;
    FILE *file = from >= 0 && lseek(from, 0, SEEK_SET) == 0 ? fdopen(dup(from), "r") : NULL;
    text[0] = 0;
    while (file && fgets(line, sizeof line, file)) {
        line[strcspn(line, " @\n")] = 0;
        int n = snprintf(text + used, size - used, "%s\n", line);
        if (n < 0 || (size_t)n >= size - used) {
            text[size - 2] = '?';
            break;
        }
        used += (size_t)n;
    }
    if (file)
        fclose(file);
}

static lc_status work(lc_compiled *out, job *j, int from, lc_error *err)
{
    int status = 0;
    pid_t helper = fork();
    if (helper == 0) {
        close(from);
        _exit(help(j));
    }
    close(j->messages);
    if (helper > 0)
        read_messages(out->messages, sizeof out->messages, from);
    close(from); /* a compiler that still talks is cut off */
    while (helper > 0 && waitpid(helper, &status, 0) < 0 && errno == EINTR)
        ;
    int result = helper > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : FAULT;
    if (result == MADE && fcntl(j->image, F_ADD_SEALS, F_SEAL_WRITE | F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0)
        result = FAULT;
    read_symbols(out->symbols, sizeof out->symbols, j->symbols);
    return report(j->path, result, out->messages, err);
}

lc_status lc_compile(lc_compiled *out, const char *path, const lc_compile_options *options, lc_error *err)
{
    static const lc_compile_options defaults = {0, NULL};
    job j = {.path = path, .options = options ? options : &defaults};
    int from = -1;
    out->image = -1;
    out->messages[0] = out->symbols[0] = 0;
    if (access(path, R_OK) != 0)
        return lc_fail(err, LC_BAD_INPUT, "%s: cannot read: %s", path, strerror(errno));
    lc_status status = open_files(&j, &from, err);
    if (status == LC_OK)
        status = work(out, &j, from, err);
    if (j.symbols >= 0)
        close(j.symbols);
    if (status == LC_OK)
        out->image = j.image;
    else if (j.image >= 0)
        close(j.image);
    return status;
}
