/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * roster.h: which hand-in is whose. A CSV file (RFC 4180) whose first line names its columns, in any order:
 *
 *     student_id,last_name,first_name,email,file,submitted
 *
 * student_id is needed; the others may be missing or empty, and further ones are passed over. `file` is the name of what was
 * handed in; where it is missing, a student's file is the one whose stem is the student_id (ab123.c). `submitted` is when
 * (2026-12-01T23:59:00+01:00); where it is missing, it is when the file was last changed.
 */
#ifndef LC_ROSTER_H
#define LC_ROSTER_H

#include <time.h>

#include "core/host.h"

typedef struct lc_student {
    char *id, *last_name, *first_name, *email, *file; /* never NULL; "" where unknown */
    char *submitted_text;
    time_t submitted;                                 /* 0: not known */
    char pseudonym[16];                               /* for reports that others may see */
} lc_student;

typedef struct lc_roster {
    lc_student *students; /* in the file's order */
    int count;
} lc_roster;

/* LC_BAD_INPUT with file:line for what is no such file, or names a student or a file twice. `seed` makes the pseudonyms: the same
 * for the same student and seed. */
lc_status lc_roster_read(lc_roster *out, const char *path, uint64_t seed, lc_error *err);
void lc_roster_release(lc_roster *roster);

/* Whose it is: `name` is that of a file or folder, without its own folder. NULL: nobody's. */
const lc_student *lc_roster_find(const lc_roster *roster, const char *name);

#endif
