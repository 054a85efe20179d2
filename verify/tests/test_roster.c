/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/tests/tests.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "verify/grade/csv.h"
#include "verify/grade/roster.h"

static char path[64];

static void write_roster(const char *text)
{
    strcpy(path, "/tmp/lightcheck-roster-XXXXXX");
    int fd = mkstemp(path);
    ck_assert_int_ge(fd, 0);
    ck_assert_int_eq(write(fd, text, strlen(text)), (ssize_t)strlen(text));
    close(fd);
}

static lc_status read_roster(lc_roster *out, const char *text, lc_error *err)
{
    write_roster(text);
    lc_status status = lc_roster_read(out, path, 7, err);
    unlink(path);
    return status;
}

/* Columns in any order, quotes, a byte order mark, Windows' ends of lines, further columns, lines that end early. */
START_TEST(test_roster_read)
{
    lc_roster r;
    lc_error err;
    ck_assert_msg(read_roster(&r,
                              "\xef\xbb\xbf" "group,last_name,student_id,file,first_name\r\n"
                              "1,\"O'Neil, \"\"Jr\"\"\",ab1,hand in.c,Ann\r\n\r\n"
                              "2,\"two\nlines\",cd2\r\n"
                              "3,M\xc3\xbcller,ef3,,J.",
                              &err) == LC_OK,
                  "%s", err.text);
    ck_assert_int_eq(r.count, 3);
    ck_assert_str_eq(r.students[0].last_name, "O'Neil, \"Jr\"");
    ck_assert_str_eq(r.students[0].first_name, "Ann");
    ck_assert_str_eq(r.students[0].email, "");
    ck_assert_str_eq(r.students[1].last_name, "two\nlines");
    ck_assert_str_eq(r.students[1].file, "");
    ck_assert_str_eq(r.students[2].last_name, "M\xc3\xbcller");
    ck_assert_ptr_eq(lc_roster_find(&r, "hand in.c"), &r.students[0]);
    ck_assert_ptr_null(lc_roster_find(&r, "ab1.c")); /* its file is another */
    ck_assert_ptr_eq(lc_roster_find(&r, "cd2.c"), &r.students[1]);
    ck_assert_ptr_eq(lc_roster_find(&r, "ef3"), &r.students[2]);
    ck_assert_ptr_null(lc_roster_find(&r, "ef.c"));
    ck_assert_ptr_null(lc_roster_find(&r, ""));
    ck_assert_str_ne(r.students[0].pseudonym, r.students[1].pseudonym);
    ck_assert_ptr_null(strstr(r.students[0].pseudonym, "ab1"));
    lc_roster_release(&r);
}
END_TEST

/* Not the place in the roster, nor who else is in it, makes a pseudonym. */
START_TEST(test_roster_pseudonyms)
{
    lc_roster a, b;
    lc_error err;
    ck_assert_int_eq(read_roster(&a, "student_id\nx\ny\n", &err), LC_OK);
    ck_assert_int_eq(read_roster(&b, "student_id\nw\ny\nx\n", &err), LC_OK);
    ck_assert_str_eq(a.students[0].pseudonym, b.students[2].pseudonym);
    lc_roster_release(&a);
    lc_roster_release(&b);
}
END_TEST

START_TEST(test_roster_errors)
{
    static const char *const cases[][2] = {
        {"", ":1: expected the names of columns"},
        {"name,id\nx,y\n", ":1: expected the names of columns"},
        {"student_id\nx\r\ny\r\nx\r\n", ":4: student_id 'x' is there twice"},
        {"student_id,file\nx,a.c\n\ny,a.c\n", ":4: file 'a.c' is there twice"},
        {"student_id,file\n,a.c\n", ":2: a student without student_id"},
        {"student_id\n\"x\n", ":2: a quote that is not closed"},
        {"student_id\nx\"y\n", ":2: a quote within a field"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        lc_roster r;
        lc_error err;
        ck_assert_int_eq(read_roster(&r, cases[i][0], &err), LC_BAD_INPUT);
        ck_assert_msg(strstr(err.text, cases[i][1]) != NULL, "'%s' is not in '%s'", cases[i][1], err.text);
        ck_assert_int_eq(r.count, 0);
    }
    lc_roster r;
    lc_error err;
    ck_assert_int_eq(lc_roster_read(&r, "/absent.csv", 0, &err), LC_BAD_INPUT);
}
END_TEST

/* What was written is read back, but for what a spreadsheet would run. */
START_TEST(test_csv_round)
{
    static const char *const texts[] = {"plain", "", "a,b", "\"", "x\r\ny", "=1+1", "-2", "o'neil", "\"\"", " a "};
    enum { COUNT = sizeof texts / sizeof texts[0] };
    char text[512] = "", *fields[COUNT];
    FILE *out = fmemopen(text, sizeof text, "w");
    for (int i = 0; i < COUNT; ++i) {
        lc_csv_field(out, texts[i]);
        fputs(i < COUNT - 1 ? "," : "\r\n", out);
    }
    fclose(out);
    lc_csv csv = {text, 1, 1};
    lc_error err;
    int count;
    ck_assert_int_eq(lc_csv_record(fields, COUNT, &count, &csv, &err), LC_OK);
    ck_assert_int_eq(count, COUNT);
    for (int i = 0; i < COUNT; ++i)
        ck_assert_str_eq(fields[i] + (texts[i][0] == '=' || texts[i][0] == '-'), texts[i]);
    ck_assert_int_eq(fields[5][0], '\'');
    ck_assert_int_eq(lc_csv_record(fields, COUNT, &count, &csv, &err), LC_OK);
    ck_assert_int_eq(count, 0);
}
END_TEST

Suite *lc_suite_roster(void)
{
    Suite *suite = suite_create("roster");
    TCase *tests = tcase_create("roster");
    tcase_add_test(tests, test_roster_read);
    tcase_add_test(tests, test_roster_pseudonyms);
    tcase_add_test(tests, test_roster_errors);
    tcase_add_test(tests, test_csv_round);
    suite_add_tcase(suite, tests);
    return suite;
}
