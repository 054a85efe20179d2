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
    char *path; /* of the source file, adapter or folder of images to be graded; NULL: there is none, and */
    char *why;  /* this is why, for its author */
    int is_adapter, is_images;
    int is_other; /* 1: neither source file nor folder, such as a text, an archive or a link. Work all the same, where its author has no other */
    time_t time;  /* when the file, the newest of the images, or else the folder was last changed */
} lc_handin;

typedef struct lc_handins {
    lc_handin *items; /* by name */
    int count;
} lc_handins;

typedef struct lc_handins_options {
    int adapters;              /* 1: an executable called `adapter` or `adapter.*` in a folder is graded in place of a source file: it will run
                                * with the caller's rights */
    int images;                /* 1: a folder of images (verify/renderers/replicates.h) without source file is a hand-in, too */
    const char *const *except; /* paths of what is no hand-in, wherever it lies: the class's own files; ends with NULL. NULL: none */
} lc_handins_options;

/* A source file (compile.h) is a hand-in. Of a folder everything in it is one: each source file; each folder, which is to hold one source
 * file, somewhere in it; and anything else, which cannot be graded, but was handed in. Only what begins with a dot, and what
 * systems leave in folders (index.html, __MACOSX, Thumbs.db, desktop.ini), is passed over. No link is followed. `options` may be NULL.
 * LC_BAD_INPUT: there is no such file, nothing that could be graded, or two of one name. */
lc_status lc_handins_find(lc_handins *out, const char *const *paths, int count, const lc_handins_options *options, lc_error *err);
/* The folder itself is one hand-in. */
lc_status lc_handins_find_one(lc_handins *out, const char *folder, lc_error *err);
void lc_handins_release(lc_handins *handins);

#endif
