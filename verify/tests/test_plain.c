/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Texts of students on a terminal: nothing of them is a command to it, or looks like a line of ours. */
#include "verify/tests/tests.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "verify/grade/formats.h"
#include "verify/report/plain.h"

static const char *const cases[][2] = {
    {"plain", "plain"},
    {"", ""},
    {"M\xc3\xbcller \xe2\x82\xac \xf0\x9f\x98\x80", "M\xc3\xbcller \xe2\x82\xac \xf0\x9f\x98\x80"},
    {"\033[2J\a", "\\x1b[2J\\x07"},
    {"a\nscore 6 of 6\tb\r\x7f", "a\\x0ascore 6 of 6\\x09b\\x0d\\x7f"},
    {"M\xfcller", "M\\xfcller"},                 /* Latin 1 */
    {"\xc2\x9b" "2J", "\\u009b2J"},              /* CSI as one character */
    {"\xe2\x80\xae" "c.exe", "\\u202ec.exe"},    /* from right to left */
    {"\xe2\x81\xa6x\xe2\x81\xa9", "\\u2066x\\u2069"},
    {"\xe2\x80\xa8", "\\u2028"},                 /* a separator of lines */
    {"\xe2\x80\x8f", "\xe2\x80\x8f"},         /* a mark of Hebrew and Arabic */
    {"\xe2\x80", "\\xe2\\x80"},                  /* cut off */
};

static char *as_text(void (*write)(FILE *out, const char *text, const char *prefix), const char *from, const char *prefix)
{
    char *out = NULL;
    size_t size;
    FILE *file = open_memstream(&out, &size);
    write(file, from, prefix);
    ck_assert_int_eq(fclose(file), 0);
    return out;
}

static void one_line(FILE *out, const char *from, const char *prefix)
{
    (void)prefix;
    lc_plain(out, from);
}

START_TEST(test_plain_line)
{
    char copy[128], cut[6];
    char *written = as_text(one_line, cases[_i][0], NULL);
    ck_assert_str_eq(written, cases[_i][1]);
    ck_assert_str_eq(lc_plain_copy(copy, sizeof copy, cases[_i][0]), cases[_i][1]);
    lc_plain_copy(cut, sizeof cut, cases[_i][0]);
    ck_assert_int_eq(strncmp(cut, cases[_i][1], strlen(cut)), 0);
    free(written);
}
END_TEST

START_TEST(test_plain_lines)
{
    static const char *const lines[][2] = {
        {"", ""}, {"a", "| a\n"}, {"a\n", "| a\n"}, {"a\r\n\tb\033\n\n", "| a\n| \tb\\x1b\n| \n"}, {"a\rb", "| a\\x0db\n"},
    };
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; ++i) {
        char *written = as_text(lc_plain_lines, lines[i][0], "| ");
        ck_assert_str_eq(written, lines[i][1]);
        free(written);
    }
}
END_TEST

#define EVIL "\033[2J\x9b\nscore 6 of 6\n"

static void fill(lc_grade_result *r, int is_ungradable)
{
    memset(r, 0, sizeof *r);
    strcpy(r->file, "a" EVIL ".c");
    strcpy(r->message, EVIL);
    strcpy(r->warnings, EVIL);
    strcpy(r->said, EVIL);
    r->is_ungradable = is_ungradable;
    r->test_count = r->done = 1;
    strcpy(r->tests[0].name, "one");
    strcpy(r->tests[0].sentence, "died: " EVIL);
    strcpy(r->tests[0].shown, "died: " EVIL);
    strcpy(r->tests[0].reproduce, "lightcheck grade 'a" EVIL ".c'");
    r->tests[0].status = LC_TEST_FAILED;
}

/* The text, and each format that other programs show. */
START_TEST(test_plain_results)
{
    static lc_grade_result r;
    lc_error err;
    for (const lc_format *f = lc_formats; f == lc_formats || f[-1].name; ++f) {
        char *text = NULL;
        size_t size;
        FILE *out = open_memstream(&text, &size);
        fill(&r, _i);
        if (f->name)
            ck_assert_int_eq(f->write(out, &r, 0, &err), LC_OK);
        else
            lc_grade_text(out, &r, 0);
        ck_assert_int_eq(fclose(out), 0);
        ck_assert_msg(!strchr(text, 033) && !strchr(text, '\x9b'), "%s: %s", f->name ? f->name : "text", text);
        ck_assert_msg(!strstr(text, "\nscore 6"), "%s: %s", f->name ? f->name : "text", text);
        if (f->name && strcmp(f->name, "json") != 0)
            ck_assert_msg(!strstr(text, "u001b"), "%s: %s", f->name, text); /* JSON that somebody shows */
        free(text);
    }
}
END_TEST

Suite *lc_suite_plain(void)
{
    Suite *suite = suite_create("plain");
    TCase *tests = tcase_create("plain");
    tcase_add_loop_test(tests, test_plain_line, 0, sizeof cases / sizeof cases[0]);
    tcase_add_test(tests, test_plain_lines);
    tcase_add_loop_test(tests, test_plain_results, 0, 2);
    suite_add_tcase(suite, tests);
    return suite;
}
