/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a course does with a class beyond grading it: feedback of every kind, and all that course.sh tries at the command line. */
#include "verify/tests/tests.h"

#include "verify/tests/grade_help.h"

static lc_grade_result r;

static char *as_text(const lc_grade_result *result)
{
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    lc_grade_text(out, result, 0);
    ck_assert_int_eq(fclose(out), 0);
    return text;
}

/* What was not graded says so in the course's own words, and of a fault what comes next. */
START_TEST(test_course_refused)
{
    assign(HEAD "\"tests\": [" FIRST LAMP "]}");
    lc_grade_options o = options();
    lc_grade_refused(&r, &a, "ann", &o, 0, "there is no source file");
    char *text = as_text(&r);
    ck_assert_msg(strstr(text, "\nungradable, which costs no attempt: there is no source file\n") != NULL, "%s", text);
    free(text);
    lc_grade_refused(&r, &a, "ann", &o, 1, "no memory");
    text = as_text(&r);
    ck_assert_msg(strstr(text, "\nno memory\n") && strstr(text, "Grade again."), "%s", text);
    free(text);
    char path[] = "/tmp/lightcheck-test-XXXXXX";
    int fd = mkstemp(path);
    ck_assert_int_gt(dprintf(fd, "{\"label_ungradable\": \"nicht bewertbar\"}"), 0);
    close(fd);
    snprintf(a.sentences, sizeof a.sentences, "%s", path);
    lc_grade_refused(&r, &a, "ann", &o, 0, "there is no source file");
    unlink(path);
    ck_assert_str_eq(r.labels[LC_LABEL_UNGRADABLE], "nicht bewertbar");
}
END_TEST

/* Where no attempt follows, nobody has to wait for a hint. */
START_TEST(test_course_final)
{
    assign(HEAD "\"hints\": {\"show\": \"category\", \"after_attempts\": 3}, \"tests\": [" FIRST LAMP "]}");
    lc_grade_options o = options();
    o.estimator = mutant("three_point_no_pi");
    grade(&r, "mine.c", &o);
    ck_assert_str_eq(r.tests[2].hint, "");
    o.is_final = 1;
    grade(&r, "mine.c", &o);
    ck_assert_str_eq(r.tests[2].hint, "think; what is wrong has to do with the BRDF");
    ck_assert_int_eq(r.attempt, 1);
}
END_TEST

START_TEST(test_course_commands)
{
    char command[512];
    const char *program = getenv("LIGHTCHECK");
    snprintf(command, sizeof command, "sh verify/tests/course.sh '%.200s'", program ? program : "build/lightcheck");
    ck_assert_int_eq(system(command), 0);
}
END_TEST

Suite *lc_suite_course(void)
{
    Suite *suite = suite_create("course");
    TCase *tests = tcase_create("course");
    tcase_set_timeout(tests, 180);
    tcase_add_test(tests, test_course_refused);
    tcase_add_test(tests, test_course_final);
    tcase_add_test(tests, test_course_commands);
    suite_add_tcase(suite, tests);
    return suite;
}
