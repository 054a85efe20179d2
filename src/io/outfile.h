/* SPDX-License-Identifier: GPL-3.0-or-later */
/* outfile.h: a file that appears whole under its name, or not at all. Every file the program writes goes through here.
 *
 * The bytes go to a temporary in the target's folder, which is synced and renamed on commit. A target that exists and
 * is no regular file (/dev/stdout, a FIFO) is written in place. Failures are LC_FAULT, and read
 * "path: cannot write: No space left on device".
 *
 * The program should ignore SIGXFSZ and SIGPIPE, so that a file-size limit or a closed pipe is an error rather than
 * a death, and call lc_outfile_unlink_all() in its handlers of SIGINT and SIGTERM. */
#ifndef LC_OUTFILE_H
#define LC_OUTFILE_H

#include <stdint.h>
#include <stdio.h>

#include "core/host.h"

typedef struct lc_outfile lc_outfile;

/* Starts writing `path`; a file of that name stays as it is until the commit. LC_FAULT where that could not be. */
lc_status lc_outfile_open(lc_outfile **out, const char *path, lc_error *err);

/* The stream to write to, for fprintf and libraries; owned by `file`. Its errors are found by the commit. */
FILE *lc_outfile_stream(lc_outfile *file);

/* Appends `size` bytes. After a failure the file can only be aborted; a commit fails. */
lc_status lc_outfile_write(lc_outfile *file, const void *data, size_t size, lc_error *err);

/* Writes `size` bytes at `offset` [bytes from the start]; LC_FAULT where the target cannot seek. */
lc_status lc_outfile_write_at(lc_outfile *file, uint64_t offset, const void *data, size_t size, lc_error *err);

/* Puts the file under its name and frees `file`, also on failure, when nothing of it remains. */
lc_status lc_outfile_commit(lc_outfile *file, lc_error *err);

/* Drops what was written and frees `file`, which may be NULL. */
void lc_outfile_abort(lc_outfile *file);

/* Removes the temporaries of all open files of this process; async-signal-safe, for a handler about to end it. */
void lc_outfile_unlink_all(void);

#endif
