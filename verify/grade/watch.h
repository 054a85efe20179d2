/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Private to verify/grade: what a process of ours does, seen from outside.
 */
#ifndef LC_WATCH_H
#define LC_WATCH_H

#include <sys/types.h>

/* CPU time that the process has taken [s]; 0 when it is not known. */
double lc_watch_cpu(pid_t pid);

/* 1 when it waits for something that a program can wait for. One that wants a processor and gets none, that waits for the disk, or that somebody
 * has stopped does not sleep. */
int lc_watch_sleeps(pid_t pid);

#endif
