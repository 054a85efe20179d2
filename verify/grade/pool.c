/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/grade/pool.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { GRACE = 2 }; /* seconds to clean up in */

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* A fork takes one thread along and every lock. Embree's workers hold some for a moment when they start or wake, and a scene
 * that is built in the child then waits for ever: seen once in a thousand forks, more often on a busy machine. */
static lc_status check_alone(lc_error *err)
{
    int threads = 0;
    DIR *tasks = opendir("/proc/self/task");
    for (struct dirent *entry = tasks ? readdir(tasks) : NULL; entry; entry = readdir(tasks))
        threads += entry->d_name[0] != '.';
    if (tasks)
        closedir(tasks);
    return threads <= 1 ? LC_OK : lc_fail(err, LC_FAULT, "a process with %d threads cannot be split in two", threads);
}

/* In the child. */
static void become(const lc_pool_job *job, pid_t parent)
{
    int in = open("/dev/null", O_RDONLY);
    int out = open(job->log ? job->log : "/dev/null", O_WRONLY | O_CREAT | O_TRUNC, 0666);
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent || in < 0 || out < 0 || dup2(in, 0) < 0 || dup2(out, 1) < 0 || dup2(out, 2) < 0)
        _exit(127);
    for (int i = 3; i < 256; ++i)
        close(i);
    if (job->run) {
        int status = job->run(job->user);
        fflush(NULL);
        _exit(status);
    }
    signal(SIGPIPE, SIG_DFL);
    signal(SIGXFSZ, SIG_DFL);
    execv(job->words[0], (char *const *)job->words);
    _exit(127);
}

static void start(lc_pool_job *job)
{
    pid_t parent = getpid();
    job->begun = now();
    job->exit_status = -1;
    job->signal = job->is_late = 0;
    fflush(NULL); /* or the child would write it once more */
    job->pid = fork();
    if (job->pid == 0)
        become(job, parent);
    if (job->pid > 0)
        setpgid(job->pid, job->pid);
}

static void kill_group(const lc_pool_job *job, int number)
{
    kill(-job->pid, number);
    kill(job->pid, number); /* should it not have its group yet */
}

/* 1 when it has ended; it keeps its number until it is waited for. */
static int has_ended(const lc_pool_job *job)
{
    siginfo_t info = {0};
    return job->pid <= 0 || waitid(P_PID, (id_t)job->pid, &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid != 0;
}

/* 1 when it is over. */
static int look_after(lc_pool_job *job)
{
    int status = 0;
    job->took = now() - job->begun;
    if (!has_ended(job)) {
        if (job->took > job->seconds && !job->is_late)
            kill_group(job, SIGTERM);
        job->is_late |= job->took > job->seconds;
        if (job->took > job->seconds + GRACE)
            kill_group(job, SIGKILL);
        return 0;
    }
    if (job->pid > 0) {
        kill(-job->pid, SIGKILL); /* what it left behind */
        waitpid(job->pid, &status, 0);
        job->signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
        job->exit_status = WIFEXITED(status) && WEXITSTATUS(status) != 127 ? WEXITSTATUS(status) : -1;
    }
    job->pid = 0;
    return 1;
}

static void kill_all(lc_pool_job *jobs, int count)
{
    for (int i = 0; i < count; ++i)
        if (jobs[i].pid > 0) {
            kill_group(&jobs[i], SIGKILL);
            waitpid(jobs[i].pid, NULL, 0);
            jobs[i].pid = 0;
        }
}

lc_status lc_pool_run(lc_pool_job *jobs, int count, int at_once, lc_status (*on_end)(lc_pool_job *job, lc_error *err),
                      lc_error *err)
{
    const struct timespec pause = {0, 5000000};
    int started = 0, running = 0, first = 0, has_function = 0;
    for (int i = 0; i < count; ++i)
        has_function |= jobs[i].run != NULL;
    lc_status status = has_function ? check_alone(err) : LC_OK;
    while (status == LC_OK && (started < count || running > 0)) {
        for (; started < count && running < at_once; ++running)
            start(&jobs[started++]);
        for (int i = first; i < started && status == LC_OK; ++i) {
            if (jobs[i].begun == 0 || !look_after(&jobs[i]))
                continue;
            jobs[i].begun = 0; /* done */
            --running;
            status = on_end(&jobs[i], err);
        }
        while (first < started && jobs[first].begun == 0)
            ++first;
        if (status == LC_OK && running > 0)
            nanosleep(&pause, NULL);
    }
    kill_all(jobs, started);
    return status;
}

lc_status lc_pool_apart(lc_status (*work)(void *user, lc_error *err), void *user, lc_error *err)
{
    struct answer {
        lc_status status;
        lc_error err;
    } answer = {LC_FAULT, {""}};
    int ends[2], how = 0;
    pid_t parent = getpid();
    lc_status status = check_alone(err);
    if (status == LC_OK && pipe(ends) != 0)
        status = lc_fail(err, LC_FAULT, "cannot start a process: %s", strerror(errno));
    if (status != LC_OK)
        return status;
    fflush(NULL); /* or the child would write it once more */
    pid_t child = fork();
    if (child == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (getppid() != parent)
            _exit(127);
        answer.status = work(user, &answer.err);
        fflush(NULL);
        _exit(write(ends[1], &answer, sizeof answer) != sizeof answer); /* far below what a pipe holds */
    }
    close(ends[1]);
    while (child > 0 && waitpid(child, &how, 0) < 0 && errno == EINTR)
        ;
    if (child < 0)
        status = lc_fail(err, LC_FAULT, "cannot start a process: %s", strerror(errno));
    else if (WIFSIGNALED(how))
        status = lc_fail(err, LC_FAULT, "a process of ours was ended by signal %d", WTERMSIG(how));
    else if (read(ends[0], &answer, sizeof answer) != sizeof answer)
        status = lc_fail(err, LC_FAULT, "a process of ours ended before it had answered");
    else if ((status = answer.status) != LC_OK)
        *err = answer.err;
    close(ends[0]);
    return status;
}
