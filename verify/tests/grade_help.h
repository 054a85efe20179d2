/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Assignments that a test writes itself. */
#ifndef LC_GRADE_HELP_H
#define LC_GRADE_HELP_H

#include <check.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "io/scene_read.h"
#include "verify/grade/grade.h"

/* Reads the text as an assignment, from a file of its own. */
static inline lc_status read_text_as_assignment(lc_assignment *out, const char *text, lc_error *err)
{
    char path[] = "/tmp/lightcheck-test-XXXXXX";
    int fd = mkstemp(path);
    ck_assert_int_ge(fd, 0);
    ck_assert_int_eq(write(fd, text, strlen(text)), (ssize_t)strlen(text));
    close(fd);
    lc_status status = lc_assignment_read(out, path, err);
    unlink(path);
    return status;
}

static lc_assignment a; /* the one under test */

/* Cheap, and for everybody who claims diffuse surfaces and area lights. */
#define HEAD "{\"title\": \"T\", \"reference\": \"three_point\", \"bounces\": 1, \"cpu_seconds\": 10, \"mutants_of\": [\"three_point\"],\n"
#define FIRST \
    "{\"name\": \"compiles\", \"title\": \"A\", \"kind\": \"descriptor\", \"points\": 1},\n" \
    "{\"name\": \"finite\", \"title\": \"B\", \"kind\": \"finite\", \"points\": 1, \"scenes\": [\"plane_rectangle\"], \"requires\": [\"compiles\"]},\n"
#define LAMP \
    "{\"name\": \"lamp\", \"title\": \"C\", \"kind\": \"check\", \"check\": \"analytic\", \"points\": 4, \"scenes\": [\"random_rectangle\"], " \
    "\"requires\": [\"finite\"], \"hint\": \"think\"},\n" \
    "{\"name\": \"more\", \"title\": \"D\", \"kind\": \"descriptor\", \"points\": 1, \"requires\": [\"lamp\"]}"

static inline void assign(const char *text)
{
    lc_error err = {""};
    ck_assert_msg(read_text_as_assignment(&a, text, &err) == LC_OK, "%s", err.text);
}

static inline lc_grade_options options(void)
{
    lc_grade_options o;
    lc_grade_options_init(&o);
    o.load = lc_scene_open;
    return o;
}

static inline void grade(lc_grade_result *out, const char *path, const lc_grade_options *o)
{
    lc_error err = {""};
    lc_status status = lc_grade_file(out, &a, path, o, &err);
    ck_assert_msg(status == LC_OK, "%s: %s", path, err.text);
    ck_assert_int_eq(out->done, out->test_count);
}

static inline const lc_estimator *mutant(const char *name)
{
    ck_assert_ptr_nonnull(lc_mutant_find(name));
    return lc_mutant_find(name)->estimator;
}

#define METHOD \
    "\"tests\": [{\"name\": \"method\", \"title\": \"M\", \"kind\": \"variance\", \"points\": 1, \"scenes\": [\"plane_rectangle\"], "

#define SEEN(name, visibility) \
    "{\"name\": \"" name "\", \"title\": \"A\", \"kind\": \"check\", \"check\": \"analytic\", \"scenes\": [\"light_behind\"], \"points\": 1, " \
    "\"visibility\": \"" visibility "\"}"

#endif
