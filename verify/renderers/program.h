/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * program.h: another program, run without a shell in a folder of its own, with a deadline. Forks: nothing else of the
 * process is touched.
 */
#ifndef LC_PROGRAM_H
#define LC_PROGRAM_H

#include "core/host.h"

enum { LC_PROGRAM_PATH = 4096 };

typedef struct lc_program {
    const char *path;             /* of the executable */
    const char *name;             /* in messages */
    const char *const *arguments; /* from argv[0], ends with NULL */
    char *const *environment;     /* NULL: ours */
    const char *folder;           /* where it runs, absolute; its words go to the file `log` there */
    double seconds;               /* of wall time, after which it is killed with all that it started: LC_FAULT */
} lc_program;

/* The file of `name` on PATH; 0 where there is none. */
int lc_program_find(char path[LC_PROGRAM_PATH], const char *name);
/* Runs it to its end; `exit_status` as from waitpid. LC_FAULT when it cannot be started or ran out of time. */
lc_status lc_program_run(int *exit_status, const lc_program *program, lc_error *err);
/* Kills what lc_program_run() is waiting for and removes its folder; async-signal-safe, for a handler about to end the process. */
void lc_program_end(void);
/* A new empty folder under $TMPDIR or /tmp; its path is shorter than LC_PROGRAM_PATH - 64. */
lc_status lc_program_folder(char folder[LC_PROGRAM_PATH], lc_error *err);
/* Removes the folder and the files in it. */
void lc_program_clear(const char *folder);

#endif
