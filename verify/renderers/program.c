/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A child, its folder, its deadline.
 */
#include "verify/renderers/program.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

extern char **environ; /* POSIX asks for the declaration */

/* The group that is waited for; one at a time: it has all cores, and a signal ends one only. */
static pthread_mutex_t alone = PTHREAD_MUTEX_INITIALIZER;
static volatile sig_atomic_t running;
static char running_in[LC_PROGRAM_PATH]; /* its folder */

void lc_program_end(void)
{
    char program[] = "/bin/rm", option[] = "-rf";
    char *const arguments[] = {program, option, running_in, NULL};
    if (running <= 0)
        return;
    kill(-(pid_t)running, SIGKILL);
    pid_t child = fork();
    if (child == 0) {
        execve(program, arguments, environ);
        _exit(127);
    }
    if (child > 0)
        waitpid(child, NULL, 0);
}

/* Searched here, for a child may not. */
int lc_program_find(char path[LC_PROGRAM_PATH], const char *name)
{
    const char *list = getenv("PATH");
    for (const char *at = list ? list : "/usr/local/bin:/usr/bin:/bin"; *at;) {
        size_t length = strcspn(at, ":");
        int n = snprintf(path, LC_PROGRAM_PATH, "%.*s/%s", length ? (int)length : 1, length ? at : ".", name);
        struct stat info;
        if (n > 0 && n < LC_PROGRAM_PATH && access(path, X_OK) == 0 && stat(path, &info) == 0 && S_ISREG(info.st_mode))
            return 1;
        at += length + (at[length] == ':');
    }
    return 0;
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* At the deadline the whole group is killed: a script does not end those whom it waits for. */
static lc_status wait_for(pid_t child, const lc_program *p, int *exit_status, lc_error *err)
{
    double deadline = now() + p->seconds;
    /* A small renderer takes some milliseconds and is run hundreds of times. */
    for (long nanoseconds = 200000;; nanoseconds += nanoseconds < 5000000 ? nanoseconds / 4 : 0) {
        pid_t done = waitpid(child, exit_status, WNOHANG);
        if (done == child) {
            kill(-child, SIGKILL); /* whatever it left behind */
            return LC_OK;
        }
        if (done < 0 && errno != EINTR)
            return lc_fail(err, LC_FAULT, "cannot wait for %s: %s", p->name, strerror(errno));
        if (now() > deadline) {
            kill(-child, SIGKILL);
            kill(child, SIGKILL);
            while (waitpid(child, exit_status, 0) < 0 && errno == EINTR)
                ;
            return lc_fail(err, LC_FAULT, "%s was stopped after %g s", p->name, p->seconds);
        }
        const struct timespec pause = {0, nanoseconds};
        nanosleep(&pause, NULL);
    }
}

/* Between fork and exec only what a signal handler may do: other threads may hold any lock. */
static void become(const lc_program *p, char *const *arguments)
{
    int null = open("/dev/null", O_RDONLY);
    setpgid(0, 0);
    signal(SIGPIPE, SIG_DFL);
    signal(SIGXFSZ, SIG_DFL);
    if (chdir(p->folder) != 0 || null < 0 || dup2(null, 0) < 0)
        _exit(127);
    int log = open("log", O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (log < 0 || dup2(log, 1) < 0 || dup2(log, 2) < 0)
        _exit(127);
    execve(p->path, arguments, p->environment ? p->environment : environ);
    _exit(127);
}

lc_status lc_program_run(int *exit_status, const lc_program *program, lc_error *err)
{
    /* execve takes pointers to what it never writes to. */
    union {
        const char *const *given;
        char *const *taken;
    } arguments = {program->arguments};
    pthread_mutex_lock(&alone);
    pid_t child = fork();
    if (child == 0)
        become(program, arguments.taken);
    lc_status status = LC_OK;
    if (child < 0) {
        status = lc_fail(err, LC_FAULT, "cannot start %s: %s", program->name, strerror(errno));
    } else {
        setpgid(child, child); /* whoever comes first */
        snprintf(running_in, sizeof running_in, "%s", program->folder);
        running = child;
        status = wait_for(child, program, exit_status, err);
        running = 0;
    }
    pthread_mutex_unlock(&alone);
    return status;
}

lc_status lc_program_folder(char folder[LC_PROGRAM_PATH], lc_error *err)
{
    const char *base = getenv("TMPDIR");
    int n = snprintf(folder, LC_PROGRAM_PATH - 64, "%s/lightcheck-XXXXXX", base && base[0] ? base : "/tmp");
    if (n < 0 || n >= LC_PROGRAM_PATH - 64)
        return lc_fail(err, LC_BAD_INPUT, "TMPDIR is too long a path");
    if (!mkdtemp(folder))
        return lc_fail(err, LC_FAULT, "%s: cannot make a folder for another program: %s", folder, strerror(errno));
    return LC_OK;
}

void lc_program_clear(const char *folder)
{
    char path[LC_PROGRAM_PATH];
    DIR *dir = opendir(folder);
    for (struct dirent *entry = dir ? readdir(dir) : NULL; entry; entry = readdir(dir))
        if (snprintf(path, sizeof path, "%s/%s", folder, entry->d_name) < LC_PROGRAM_PATH)
            unlink(path); /* "." and ".." stay */
    if (dir)
        closedir(dir);
    rmdir(folder);
}
