/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/grade/result.h"

int lc_test_is_open(const lc_test_result *test) { return test->withheld[0] == 0; }

const char *lc_test_status_name(lc_test_status status)
{
    static const char *const names[] = {"pending", "passed", "partial", "failed", "skipped", "fault"};
    return names[status];
}

const char *lc_visibility_name(lc_visibility visibility)
{
    static const char *const names[] = {"visible", "after_due_date", "after_published", "hidden"};
    return names[visibility];
}

lc_status lc_grade_status(const lc_grade_result *result)
{
    if (result->is_fault)
        return LC_FAULT;
    if (result->is_ungradable)
        return LC_BAD_INPUT;
    for (int i = 0; i < result->test_count; ++i)
        if (result->tests[i].status != LC_TEST_PASSED)
            return LC_WRONG;
    return LC_OK;
}
