/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An assignment before it is published, and grading from the command line. */
#include "verify/tests/tests.h"

#include <sys/wait.h>

#include "verify/grade/rehearse.h"
#include "verify/tests/grade_help.h"

static lc_grade_result r;

static char met[4096];

static void note_row(void *user, const lc_rehearsal_row *row)
{
    (void)user;
    snprintf(met + strlen(met), sizeof met - strlen(met), "%s %s%s%s\n", row->is_right ? "right" : "wrong", row->estimator->name,
             row->first[0] ? " loses " : "", row->first);
}

START_TEST(test_rehearse)
{
    lc_rehearsal rehearsal;
    lc_error err = {""};
    lc_grade_options o = options();
    /* What is asked about light from behind alone finds one mutant, and not the others; one is not asked about. */
    assign(HEAD "\"solutions\": [\"three_point\", \"light_all\"], \"beyond\": [\"three_point_no_pi\"], \"tests\": [" SEEN("v", "visible") "]}");
    met[0] = 0;
    ck_assert_msg(lc_rehearse(&rehearsal, &a, &o, note_row, NULL, &err) == LC_OK, "%s", err.text);
    ck_assert_int_eq(rehearsal.solutions, 2);
    ck_assert_int_eq(rehearsal.accused, 0);
    ck_assert_int_ge(rehearsal.mutants, 9);
    ck_assert_int_eq(rehearsal.survivors, rehearsal.mutants - 1);
    ck_assert_msg(strstr(met, "wrong three_point_back_emits loses v\n") && strstr(met, "right light_all\n"), "%s", met);
    ck_assert_msg(!strstr(met, "no_pi"), "%s", met);
    /* One whose method is not what a solution does accuses it. */
    assign(HEAD "\"solutions\": [\"light_two_samples\"],\n" METHOD "\"at_least\": 0.8}]}");
    a.mutant_count = 0;
    ck_assert_int_eq(lc_rehearse(&rehearsal, &a, &o, note_row, NULL, &err), LC_OK);
    ck_assert_int_eq(rehearsal.accused, 1);
}
END_TEST

START_TEST(test_rehearse_senseless_assignment)
{
    static const struct {
        const char *test, *says;
    } rows_of_sense[] = {
        {"\"check\": \"furnace\", \"scenes\": [\"cornell\"]", "the check furnace says nothing about three_point over cornell"},
        {"\"check\": \"metamorphic\", \"relation\": \"louder\", \"scenes\": [\"five_lights\"]", "with this relation"},
        {"\"check\": \"analytic\", \"bounces\": [2, 2], \"scenes\": [\"plane_rectangle\"]", "these bounces"},
    };
    for (int i = 0; i < 3; ++i) {
        char text[600];
        lc_error err = {""};
        lc_grade_options o = options();
        o.estimator = lc_right_estimator("three_point");
        snprintf(text, sizeof text, HEAD "\"tests\": [{\"name\": \"x\", \"title\": \"X\", \"kind\": \"check\", \"points\": 1, %s}]}",
                 rows_of_sense[i].test);
        assign(text);
        ck_assert_int_eq(lc_grade_file(&r, &a, "mine.c", &o, &err), LC_BAD_INPUT);
        ck_assert_msg(strstr(err.text, rows_of_sense[i].says) != NULL, "%s", err.text);
    }
}
END_TEST

/* ---- from the command line ------------------------------------------------------------------------------------------------------------- */

static char said[1 << 16];

static int run(const char *arguments)
{
    char line[1024];
    snprintf(line, sizeof line, "%s %s 2>&1", getenv("LIGHTCHECK") ? getenv("LIGHTCHECK") : "build/lightcheck", arguments);
    FILE *pipe = popen(line, "r");
    ck_assert_ptr_nonnull(pipe);
    said[fread(said, 1, sizeof said - 1, pipe)] = 0;
    int status = pclose(pipe);
    ck_assert_msg(WIFEXITED(status), "%s", line);
    return WEXITSTATUS(status);
}

START_TEST(test_grade_command)
{
    ck_assert_int_eq(run("grade estimators/light_direct.c -a light_direct --only points"), 0);
    ck_assert_msg(strstr(said, "score 3 of 3") && strstr(said, "jail: limits"), "%s", said);
    ck_assert_int_eq(run("grade light_no_pi -a light_direct --only points"), 1);
    ck_assert_msg(strstr(said, "again: lightcheck grade light_no_pi -a light_direct --seed 1 --only points"), "%s", said);
    ck_assert_int_eq(run("grade verify/tests/cheats/include_secret.c -a light_direct"), 2);
    ck_assert_msg(strstr(said, "ungradable, which costs no attempt"), "%s", said);
    ck_assert_int_eq(run("grade no_such.c -a light_direct"), 2);
    ck_assert_msg(strstr(said, "no_such.c: No such file"), "%s", said);
    ck_assert_int_eq(run("grade light_direct -a light_direct --only nothing"), 2);
    ck_assert_msg(strstr(said, "there is no test 'nothing'"), "%s", said);
    ck_assert_int_eq(run("grade light_direct"), 2);
    ck_assert_int_eq(run("list assignments"), 0);
    ck_assert_msg(strstr(said, "light_direct ") && strstr(said, "path_rr "), "%s", said);
    ck_assert_int_eq(run("assignment sentences"), 0);
    ck_assert_msg(strstr(said, "\"skipped\": \"left out"), "%s", said);
    ck_assert_int_eq(run("assignment check no/such.json"), 2);
    ck_assert_int_eq(run("assignment"), 2);
}
END_TEST

Suite *lc_suite_rehearse(void)
{
    Suite *suite = suite_create("rehearse");
    TCase *c = tcase_create("rehearse");
    tcase_set_timeout(c, 60);
    tcase_add_test(c, test_rehearse);
    tcase_add_test(c, test_rehearse_senseless_assignment);
    tcase_add_test(c, test_grade_command);
    suite_add_tcase(suite, c);
    return suite;
}
