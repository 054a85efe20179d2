/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Only what comes through the pipe of samples counts, and only its exact number: when that is complete, the worker is
 * killed; when it cannot become complete any more, the verdict follows from how the process ended.
 */
#define _GNU_SOURCE
#include "verify/grade/crew.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "verify/grade/watch.h"

enum { MOST_WORKERS = 64, PIPE_SIZE = 1 << 18 };

/* How often the workers' time is looked at [s], and how many looks in a row must find them asleep. */
static const double LOOK = 0.02;
enum { PATIENCE = 250 };

typedef enum killed_for { NOT_KILLED, COMPLETE, OUTPUT, OTHERS, CLOSED } killed_for;

typedef struct worker {
    pid_t pid;
    int samples, said; /* our ends of the pipes; -1: closed */
    killed_for reason;
    int greeted, died_alone; /* before we killed it */
    lc_wire_greeting greeting;
    double cpu; /* of the plug-in, when last looked at [s] */
    /* Where the next bytes go. */
    char *target;
    size_t wanted, got;
    /* Where the next block of samples belongs. */
    int index, tile, x, y, block_count;
    uint64_t sample;
    double block[LC_BLOCK * (1 + LC_MAX_TERMS)][3];
} worker;

typedef struct crew {
    const lc_crew_task *task;
    lc_crew_result *result;
    worker *workers;
    int count, request;
    uint64_t printed;
    size_t said_used;
    double deadline, next_look;
    int asleep; /* looks in a row that found nobody at work */
} crew;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void judge(crew *c, lc_jail_code code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* The first verdict stands. */
static void judge(crew *c, lc_jail_code code, const char *format, ...)
{
    va_list args;
    if (c->result->verdict.code != LC_JAIL_AC)
        return;
    c->result->verdict.code = code;
    va_start(args, format);
    vsnprintf(c->result->verdict.text, sizeof c->result->verdict.text, format, args);
    va_end(args);
}

/* ---- start ------------------------------------------------------------------------------------------------------- */

/* In the child: the five descriptors of a worker, no environment, no signals that we ignore. */
static void become_worker(const crew *c, int index, int said, int samples, const char *program, pid_t parent)
{
    char texts[3][16], name[] = "lightcheck-worker";
    char *const words[] = {name, texts[0], texts[1], texts[2], NULL}, *const environment[] = {NULL};
    const int from[] = {c->request, said, said, c->task->image, samples};
    int moved[LC_WIRE_FIRST_UNUSED];
    sigset_t none;
    snprintf(texts[0], sizeof texts[0], "%d", (int)parent);
    snprintf(texts[1], sizeof texts[1], "%d", index);
    snprintf(texts[2], sizeof texts[2], "%d", c->count);
    for (int i = 0; i < LC_WIRE_FIRST_UNUSED; ++i) /* out of the way of those to come */
        if ((moved[i] = fcntl(from[i], F_DUPFD_CLOEXEC, LC_WIRE_FIRST_UNUSED)) < 0)
            _exit(127);
    for (int i = 0; i < LC_WIRE_FIRST_UNUSED; ++i)
        if (dup2(moved[i], i) < 0)
            _exit(127);
    if (close_range(LC_WIRE_FIRST_UNUSED, ~0U, 0) != 0)
        for (int i = LC_WIRE_FIRST_UNUSED; i < 1 << 16; ++i)
            close(i);
    setpgid(0, 0);
    for (int i = 1; i < NSIG; ++i)
        signal(i, SIG_DFL);
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    execve(program, words, environment);
    _exit(127);
}

/* The worker's program stands beside ours. */
static int find_worker(char path[4096])
{
    static const char name[] = "lightcheck-worker";
    ssize_t length = readlink("/proc/self/exe", path, 4096 - sizeof name - 1);
    if (length <= 0)
        return 0;
    path[length] = 0;
    snprintf(strrchr(path, '/') + 1, sizeof name, "%s", name);
    return access(path, X_OK) == 0;
}

/* Nobody may open it anew: a worker could open our end of it, and wait there for what never comes. */
static int open_pipe(int ends[2]) { return pipe2(ends, O_CLOEXEC) == 0 && fchmod(ends[0], 0) == 0; }

static void start(crew *c, worker *w, const char *program)
{
    int said[2] = {-1, -1}, samples[2] = {-1, -1};
    pid_t parent = getpid();
    w->pid = open_pipe(said) && open_pipe(samples) ? fork() : -1;
    if (w->pid == 0)
        become_worker(c, w->index, said[1], samples[1], program, parent);
    if (w->pid > 0) {
        setpgid(w->pid, w->pid);
        fcntl(samples[0], F_SETPIPE_SZ, PIPE_SIZE);
        fcntl(samples[0], F_SETFL, O_NONBLOCK);
        fcntl(said[0], F_SETFL, O_NONBLOCK);
        w->samples = samples[0];
        w->said = said[0];
        samples[0] = said[0] = -1;
    } else {
        judge(c, LC_JAIL_IE, "cannot start a worker: %s", strerror(errno));
    }
    const int rest[] = {said[0], said[1], samples[0], samples[1]};
    for (int i = 0; i < 4; ++i)
        if (rest[i] >= 0)
            close(rest[i]);
}

/* ---- time -------------------------------------------------------------------------------------------------------- */

/* Of the plug-in alone: each worker has a start of its own, and how many workers there are must not decide. */
static double plugin_cpu(const worker *w, double cpu) { return w->greeted ? fmax(0, cpu - w->greeting.cpu_seconds) : 0; }

/* The limit is of all workers together, so that threads change only the time of the clock. */
static void judge_cpu(crew *c, double cpu)
{
    double most = c->task->limits->cpu_seconds;
    if (cpu > most)
        judge(c, LC_JAIL_TLE, "it computed for %.3g s, and had %.3g s left", cpu, most);
}

/* 1 when a worker has computed since it was last looked at, or could. */
static int is_at_work(worker *w)
{
    double cpu = plugin_cpu(w, lc_watch_cpu(w->pid));
    int is_on = cpu > w->cpu;
    w->cpu = fmax(cpu, w->cpu);
    return is_on || !w->greeted || !lc_watch_sleeps(w->pid);
}

/* Looks at all workers, now and then; `quiet`: nothing has come from any of them. */
static void look_at_time(crew *c, int quiet)
{
    double cpu = 0;
    int at_work = !quiet;
    if (now() < c->next_look)
        return;
    c->next_look = now() + LOOK;
    for (int i = 0; i < c->count; ++i) {
        worker *w = &c->workers[i];
        if (w->samples >= 0 && is_at_work(w))
            at_work = 1;
        cpu += w->cpu;
    }
    judge_cpu(c, cpu);
    c->asleep = at_work ? 0 : c->asleep + 1;
    if (c->asleep >= PATIENCE)
        judge(c, LC_JAIL_TLE, "it was stopped after %g s of waiting for what does not come", PATIENCE * LOOK);
}

/* The clock's time is no measure of a file: that of a machine with much to do runs away. A file that sleeps has been found before;
 * without seccomp it may sleep a little, again and again, and that is not told from a machine that gives it nothing. */
static void judge_clock(crew *c)
{
    double cpu = 0;
    for (int i = 0; i < c->count; ++i)
        cpu += c->workers[i].cpu;
    judge(c, c->result->parts & LC_JAIL_SECCOMP ? LC_JAIL_IE : LC_JAIL_TLE, "it was stopped after %g s of the clock, of which it got %.3g s to compute in",
          c->task->limits->wall_seconds, cpu);
}

/* ---- what comes -------------------------------------------------------------------------------------------------- */

static void stop(worker *w, killed_for reason)
{
    if (w->pid > 0 && w->reason == NOT_KILLED) {
        w->reason = reason;
        kill(-w->pid, SIGKILL);
        kill(w->pid, SIGKILL); /* should it not have its group yet */
    }
}

/* A process that ends closes its pipes a moment before it is dead. One that lives on has closed them itself, and is killed by us; only when that
 * is told apart does it mean something to have died of SIGKILL. */
static int dies_alone(pid_t pid)
{
    const struct timespec pause = {0, 1000000};
    for (int i = 0; i < 200; ++i) {
        siginfo_t info = {0};
        if (waitid(P_PID, (id_t)pid, &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid != 0)
            return 1;
        nanosleep(&pause, NULL);
    }
    return 0;
}

static void expect(worker *w, void *target, size_t wanted)
{
    w->target = target;
    w->wanted = wanted;
    w->got = 0;
}

/* The next block of the shard's next pixel; 0 when there is none. */
static int next_block(const crew *c, worker *w)
{
    const lc_film *film = c->task->film;
    const lc_render_options *o = &c->task->request.options;
    int tiles_x = (film->width + LC_TILE - 1) / LC_TILE, tiles = tiles_x * ((film->height + LC_TILE - 1) / LC_TILE);
    int x_end = w->tile % tiles_x * LC_TILE + LC_TILE, y_end = w->tile / tiles_x * LC_TILE + LC_TILE;
    w->sample += (uint64_t)w->block_count;
    if (w->sample == o->first + o->count) {
        w->sample = o->first;
        if (++w->x >= (x_end < film->width ? x_end : film->width)) {
            w->x = x_end - LC_TILE;
            if (++w->y >= (y_end < film->height ? y_end : film->height)) {
                w->tile += o->shards * c->count;
                w->x = w->tile % tiles_x * LC_TILE;
                w->y = w->tile / tiles_x * LC_TILE;
            }
        }
    }
    uint64_t left = o->first + o->count - w->sample;
    w->block_count = left < LC_BLOCK ? (int)left : LC_BLOCK;
    expect(w, w->block, sizeof w->block[0] * (size_t)(w->block_count * (1 + o->minus_count)));
    return w->tile < tiles;
}

static void first_block(const crew *c, worker *w)
{
    const lc_render_options *o = &c->task->request.options;
    int tiles_x = (c->task->film->width + LC_TILE - 1) / LC_TILE;
    w->tile = o->shard + o->shards * w->index;
    w->x = w->tile % tiles_x * LC_TILE;
    w->y = w->tile / tiles_x * LC_TILE;
    w->sample = o->first;
    w->block_count = 0;
}

static void take_greeting(crew *c, worker *w)
{
    const lc_wire_greeting *g = &w->greeting;
    const unsigned walls = LC_JAIL_SECCOMP | LC_JAIL_LANDLOCK;
    w->greeted = 1;
    if (g->build != lc_wire_build() || g->status != LC_OK)
        judge(c, LC_JAIL_IE, "a worker could not begin: %.200s", g->build == lc_wire_build() ? g->error : "another build");
    else if (!(g->reached & LC_JAIL_LIMITS) || !(g->reached & walls))
        judge(c, LC_JAIL_IE, "this system offers no jail: neither seccomp nor Landlock, or no limits");
    c->result->parts &= g->reached;
}

/* What was waited for is there. Returns 0 when nothing more is wanted of the worker. */
static int take(crew *c, worker *w)
{
    if (!w->greeted) {
        take_greeting(c, w);
        if (c->result->verdict.code != LC_JAIL_AC)
            return 0;
        if (c->task->description) {
            expect(w, c->task->description, sizeof *c->task->description);
            return 1;
        }
        first_block(c, w);
    } else if (c->task->description) {
        return 0;
    } else {
        const lc_film *film = c->task->film;
        lc_film_put(c->task->film, &c->task->request.options, (uint32_t)(w->y * film->width + w->x), w->sample,
                    (const double(*)[3])w->block, w->block_count);
    }
    return next_block(c, w);
}

static void end_pipe(int *fd)
{
    if (*fd >= 0)
        close(*fd);
    *fd = -1;
}

static void read_samples(crew *c, worker *w)
{
    static const size_t chunk = 1 << 16;
    char buffer[1 << 16];
    ssize_t n = read(w->samples, buffer, chunk);
    if (n < 0 && (errno == EAGAIN || errno == EINTR))
        return;
    if (n <= 0) {
        w->died_alone = dies_alone(w->pid);
        stop(w, CLOSED);
        end_pipe(&w->samples);
        return;
    }
    for (size_t at = 0; at < (size_t)n;) {
        size_t size = w->wanted - w->got < (size_t)n - at ? w->wanted - w->got : (size_t)n - at;
        memcpy(w->target + w->got, buffer + at, size);
        at += size;
        w->got += size;
        if (w->got == w->wanted && !take(c, w)) {
            stop(w, COMPLETE);
            end_pipe(&w->samples);
            return;
        }
    }
}

/* Returns 0 when there is nothing more, now or for good. */
static int read_said(crew *c, worker *w)
{
    char buffer[4096];
    ssize_t n = read(w->said, buffer, sizeof buffer);
    if (n < 0 && (errno == EAGAIN || errno == EINTR))
        return 0;
    if (n <= 0) {
        end_pipe(&w->said);
        return 0;
    }
    for (ssize_t i = 0; i < n && c->said_used + 1 < sizeof c->result->said; ++i)
        c->result->said[c->said_used++] = buffer[i] ? buffer[i] : '?';
    c->result->said[c->said_used] = 0;
    c->printed += (uint64_t)n;
    if (c->printed <= c->task->limits->output)
        return 1;
    judge(c, LC_JAIL_OLE, "it printed more than %llu bytes", (unsigned long long)c->task->limits->output);
    stop(w, OUTPUT);
    end_pipe(&w->said);
    return 0;
}

static void listen_to(crew *c)
{
    struct pollfd polled[2 * MOST_WORKERS];
    worker *of[2 * MOST_WORKERS];
    nfds_t count = 1;
    while (count > 0 && c->result->verdict.code == LC_JAIL_AC) {
        int news = 0;
        count = 0;
        for (int i = 0; i < c->count; ++i) {
            worker *w = &c->workers[i];
            if (w->samples < 0)
                continue;
            of[count] = w;
            polled[count++] = (struct pollfd){.fd = w->samples, .events = POLLIN};
            of[count] = w;
            polled[count++] = (struct pollfd){.fd = w->said, .events = POLLIN}; /* -1 is passed over */
        }
        double left = c->deadline - now();
        if (count > 0 && left < 0)
            judge_clock(c);
        if (count > 0)
            news = poll(polled, count, (int)(1000 * LOOK));
        if (count > 0)
            look_at_time(c, news == 0);
        for (nfds_t i = 0; i < count && news > 0; ++i) {
            if (polled[i].revents && (i & 1) == 0)
                read_samples(c, of[i]);
            else if (polled[i].revents && of[i]->said >= 0)
                read_said(c, of[i]);
        }
        for (int i = 0; i < c->count; ++i) /* one that cannot finish ends all */
            if (c->workers[i].reason == CLOSED)
                return;
    }
}

/* ---- end --------------------------------------------------------------------------------------------------------- */

static const char *name_of_signal(int number)
{
    switch (number) {
    case SIGSEGV:
        return "it used memory that is not its own: a bad pointer or index, or a recursion without end";
    case SIGBUS:
        return "it used memory that is not there";
    case SIGFPE:
        return "it divided a whole number by zero";
    case SIGILL:
        return "it ran into an invalid instruction: a function without a return, perhaps";
    case SIGABRT:
        return "it aborted: a failed assertion, or a broken heap";
    case SIGTRAP:
        return "it ran into a trap: a function without a return, perhaps, or a breakpoint";
    case SIGSYS:
        return "it made a system call that no estimator needs: files, processes, network, waiting";
    default:
        return "it ended itself by a signal";
    }
}

/* What other processes send, and a machine without memory. Under seccomp a file can send itself SIGABRT and no other signal; all that the kernel
 * sends for what code does, rare ones like SIGTRAP too, is the file's own fault. Without seccomp any signal may be its own, and is: or it
 * would be graded again for ever, and a wrong file had no 0. */
static int is_from_outside(const worker *w, int number)
{
    int is_sent = number == SIGKILL || number == SIGTERM || number == SIGHUP || number == SIGINT || number == SIGQUIT;
    return is_sent && (w->greeting.reached & LC_JAIL_SECCOMP);
}

static void judge_end(crew *c, const worker *w, int status, const struct rusage *use, double cpu)
{
    const lc_jail_options *limits = c->task->limits;
    if (w->reason == COMPLETE || w->reason == OUTPUT || w->reason == OTHERS)
        return;
    int number = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    int ours = number == SIGKILL && !w->died_alone; /* it only closed its pipe */
    if (!w->greeted) {
        judge(c, LC_JAIL_IE, "a worker did not begin: %s %d", number ? "signal" : "exit status",
              number ? number : WEXITSTATUS(status));
    } else if (number == SIGXCPU || (number == SIGKILL && cpu >= 0.9 * limits->cpu_seconds)) { /* clocks differ, by up to 6% as seen */
        judge(c, LC_JAIL_TLE, "it computed for %.3g s, and had %.3g s left", cpu, limits->cpu_seconds);
    } else if (number && number != SIGSYS && (double)use->ru_maxrss * 1024 >= 0.75 * (double)limits->memory) {
        judge(c, LC_JAIL_MLE, "it died with its memory full: %llu MiB are allowed",
              (unsigned long long)(limits->memory >> 20));
    } else if (ours) {
        judge(c, LC_JAIL_IR, "it closed its output before all samples were made");
    } else if (is_from_outside(w, number)) {
        judge(c, LC_JAIL_IE, "a worker was ended from outside, by signal %d%s", number,
              number == SIGKILL ? ", as by a machine that has no memory left" : "");
    } else if (number) {
        judge(c, LC_JAIL_RTE, "%s (signal %d)", name_of_signal(number), number);
    } else {
        judge(c, LC_JAIL_IR, "it ended by itself, with exit status %d, before all samples were made",
              WEXITSTATUS(status));
    }
}

/* Waits for all of them; the one that failed first to be seen is the one that is judged. */
static void finish(crew *c)
{
    for (int i = 0; i < c->count; ++i)
        stop(&c->workers[i], OTHERS);
    for (int i = 0; i < c->count; ++i) {
        worker *w = &c->workers[i];
        struct rusage use;
        int status = 0;
        end_pipe(&w->samples);
        if (w->pid <= 0)
            continue;
        kill(-w->pid, SIGKILL); /* once more its group, should it have managed to have one */
        while (wait4(w->pid, &status, 0, &use) < 0 && errno == EINTR)
            ;
        while (w->said >= 0 && read_said(c, w)) /* what it left in the pipe */
            ;
        end_pipe(&w->said);
        double cpu = (double)(use.ru_utime.tv_sec + use.ru_stime.tv_sec) +
                     1e-6 * (double)(use.ru_utime.tv_usec + use.ru_stime.tv_usec);
        c->result->verdict.cpu_seconds += plugin_cpu(w, cpu);
        judge_end(c, w, status, &use, plugin_cpu(w, cpu));
    }
    judge_cpu(c, c->result->verdict.cpu_seconds); /* what was not looked at in time is too much all the same */
}

lc_status lc_crew_run(lc_crew_result *result, const lc_crew_task *task, lc_error *err)
{
    char program[4096];
    crew c = {.task = task, .result = result, .count = task->workers < MOST_WORKERS ? task->workers : MOST_WORKERS};
    memset(result, 0, sizeof *result);
    result->parts = LC_JAIL_ALL;
    c.workers = calloc((size_t)c.count, sizeof *c.workers);
    lc_status status = c.workers ? lc_wire_write(&c.request, &task->request, task->scene, err)
                                 : lc_fail(err, LC_FAULT, "out of memory for workers");
    if (status != LC_OK) {
        judge(&c, LC_JAIL_IE, "%s", err ? err->text : "no memory");
        free(c.workers);
        return status;
    }
    c.deadline = now() + task->limits->wall_seconds;
    if (!find_worker(program))
        judge(&c, LC_JAIL_IE, "%s is missing; it belongs beside the program", program);
    for (int i = 0; i < c.count; ++i) {
        worker *w = &c.workers[i];
        w->index = i;
        w->samples = w->said = -1;
        expect(w, &w->greeting, sizeof w->greeting);
        if (result->verdict.code == LC_JAIL_AC)
            start(&c, w, program);
    }
    if (result->verdict.code == LC_JAIL_AC)
        listen_to(&c);
    finish(&c);
    close(c.request);
    free(c.workers);
    lc_jail_code code = result->verdict.code;
    return code == LC_JAIL_AC ? LC_OK
                              : lc_fail(err, code == LC_JAIL_IE ? LC_FAULT : LC_WRONG, "%s: %s",
                                        lc_jail_code_name(code), result->verdict.text);
}
