/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A small class, as a teacher has it: see class.sh. `make class` grades sixty. */
#include "verify/tests/tests.h"

#include <stdio.h>
#include <stdlib.h>

START_TEST(test_class_small)
{
    char command[512];
    const char *program = getenv("LIGHTCHECK");
    snprintf(command, sizeof command, "sh verify/tests/class.sh '%.200s' 8 verify/tests/class_small.json",
             program ? program : "build/lightcheck");
    ck_assert_int_eq(system(command), 0);
}
END_TEST

Suite *lc_suite_class(void)
{
    Suite *suite = suite_create("class");
    TCase *tests = tcase_create("class");
    tcase_set_tags(tests, "long");
    tcase_set_timeout(tests, 300);
    tcase_add_test(tests, test_class_small);
    suite_add_tcase(suite, tests);
    return suite;
}
