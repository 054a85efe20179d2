/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * confine.h: locks up the calling process, for good, before it runs what nobody vouches for. What the system lacks is
 * left out, and the answer says what was had: a jail shows how strong it is.
 */
#ifndef LC_CONFINE_H
#define LC_CONFINE_H

#include <stdint.h>

/* The parts of a jail. */
enum {
    LC_JAIL_LIMITS = 1,   /* rlimits: time, memory, files, processes */
    LC_JAIL_SECCOMP = 2,  /* of the system calls only those that are needed */
    LC_JAIL_LANDLOCK = 4, /* no file but those named */
    LC_JAIL_USER = 8,     /* another user, with nothing of its own; only root can give that */
    LC_JAIL_ALL = 15
};

typedef struct lc_confinement {
    unsigned parts;       /* those wanted */
    double cpu_seconds;   /* of this process, rounded up to whole ones */
    uint64_t memory;      /* bytes of address space beyond what the process has already */
    uint64_t file_size;   /* of any file written [bytes] */
} lc_confinement;

/* Who root's prisoners are. */
enum { LC_JAIL_UID = 65534 };

/* Of a worker: it may compute, map its plug-in, and write to descriptors 1, 2 and `samples`. Files cannot be opened
 * but by /proc/self/fd. Descriptors are not touched. Returns the parts that hold from now on. */
unsigned lc_confine_worker(const lc_confinement *c, int samples);

/* Of a compiler, before its exec: it reads the system's programs, headers and libraries and writes within the current
 * folder, which must be the prisoner's own where it becomes another user; no network, no other process. */
unsigned lc_confine_compiler(const lc_confinement *c);

/* From now on the process dies with its parent `parent`; 0 when that is dead already. To be said again after a change of user. */
int lc_confine_follow(int parent);

#endif
