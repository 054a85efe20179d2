/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/grade/pool.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
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
    int started = 0, running = 0, first = 0;
    lc_status status = LC_OK;
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
