/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * pool.h: processes beside each other, each with a time limit of its own: one that is stuck holds nobody up. All of them end with the
 * caller, however that ends.
 */
#ifndef LC_POOL_H
#define LC_POOL_H

#include <sys/types.h>

#include "core/host.h"

typedef struct lc_pool_job {
    int (*run)(void *user);   /* in a process of its own, whose exit status it returns; or NULL, and then */
    const char *const *words; /* a program's path and its arguments, to a NULL */
    const char *log;          /* file for what it prints; NULL: nobody listens */
    double seconds;           /* of wall time */
    void *user;
    /* How it ended: */
    int exit_status; /* of its own accord; -1: otherwise, and then */
    int signal;      /* this ended it (0: it could not start) */
    int is_late;     /* 1: it was ended because its time was over */
    double took;     /* [s] */
    /* The pool's own. */
    pid_t pid;
    double begun;
} lc_pool_job;

/* Runs the jobs in their order, at most `at_once` at a time, and calls `on_end` after each, in the order in which they
 * end. One that is late gets SIGTERM, two seconds later SIGKILL. What `on_end` returns ends the run where it is not LC_OK: the
 * jobs that still run are killed. LC_FAULT where a job is a function and the process has more than one thread: of these the
 * function's process would have only what they had locked. */
lc_status lc_pool_run(lc_pool_job *jobs, int count, int at_once, lc_status (*on_end)(lc_pool_job *job, lc_error *err),
                      lc_error *err);

/* What `work` returns, from a process of its own: the threads that it starts, and the memory that it takes, are gone with
 * that, and nothing comes back but its error. LC_FAULT where the process dies; the caller has one thread. */
lc_status lc_pool_apart(lc_status (*work)(void *user, lc_error *err), void *user, lc_error *err);

#endif
