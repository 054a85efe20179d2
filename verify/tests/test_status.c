/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/tests/tests.h"

#include <string.h>

#include "core/host.h"

START_TEST(fail_writes_message_and_returns_status)
{
    lc_error err;
    ck_assert_int_eq(lc_fail(&err, LC_BAD_INPUT, "%s:%d: bad", "x.xml", 3), LC_BAD_INPUT);
    ck_assert_str_eq(err.text, "x.xml:3: bad");
}
END_TEST

START_TEST(fail_cuts_a_long_message)
{
    lc_error err;
    char longer[4096];
    memset(longer, 'a', sizeof longer - 1);
    longer[sizeof longer - 1] = 0;
    ck_assert_int_eq(lc_fail(&err, LC_FAULT, "%s", longer), LC_FAULT);
    ck_assert_uint_eq(strlen(err.text), sizeof err.text - 1);
    ck_assert_int_eq(lc_fail(NULL, LC_FAULT, "nobody reads this"), LC_FAULT);
}
END_TEST

Suite *lc_suite_status(void)
{
    Suite *suite = suite_create("status");
    TCase *tc = tcase_create("fail");
    tcase_add_test(tc, fail_writes_message_and_returns_status);
    tcase_add_test(tc, fail_cuts_a_long_message);
    suite_add_tcase(suite, tc);
    return suite;
}
