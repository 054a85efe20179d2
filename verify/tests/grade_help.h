/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Assignments that a test writes itself. */
#ifndef LC_GRADE_HELP_H
#define LC_GRADE_HELP_H

#include <check.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "verify/grade/assignment.h"

/* Reads the text as an assignment, from a file of its own. */
static inline lc_status read_text_as_assignment(lc_assignment *out, const char *text, lc_error *err)
{
    char path[] = "/tmp/lightcheck-test-XXXXXX";
    int fd = mkstemp(path);
    ck_assert_int_ge(fd, 0);
    ck_assert_int_eq(write(fd, text, strlen(text)), (ssize_t)strlen(text));
    close(fd);
    char with_slash[64];
    snprintf(with_slash, sizeof with_slash, "%s", path);
    lc_status status = lc_assignment_read(out, with_slash, err);
    unlink(path);
    return status;
}

#endif
