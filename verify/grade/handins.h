/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * handins.h: what was handed in: files, folders with one file each, and folders full of those.
 */
#ifndef LC_HANDINS_H
#define LC_HANDINS_H

#include <time.h>

#include "core/host.h"

typedef struct lc_handin {
    char *name; /* of the file or folder, without its own folder; no other has it */
    char *path; /* of the source file, or adapter, to be graded; NULL: there is none, and */
    char *why;  /* this is why, for its author */
    int is_adapter;
    time_t time; /* when the file, or the folder, was last changed */
} lc_handin;

typedef struct lc_handins {
    lc_handin *items; /* by name */
    int count;
} lc_handins;

/* A source file (.c .cc .cpp .cxx) is a hand-in. Of a folder each source file in it is one, and each folder in it, which is to hold one
 * source file, somewhere in it; what begins with a dot, and any other file, is passed over. With `adapters`, an executable called
 * `adapter` or `adapter.*` in such a folder is graded in place of a source file: it will run with the caller's rights. No link is
 * followed. LC_BAD_INPUT: there is no such file, no hand-in at all, or two of one name. */
lc_status lc_handins_find(lc_handins *out, const char *const *paths, int count, int adapters, lc_error *err);
/* The folder itself is one hand-in. */
lc_status lc_handins_find_one(lc_handins *out, const char *folder, lc_error *err);
void lc_handins_release(lc_handins *handins);

#endif
