/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A result as text, for a terminal of 80 columns or more.
 */
#include <math.h>

#include "verify/grade/result.h"

static const char *code_of(const lc_test_result *t)
{
    return t->status == LC_TEST_SKIPPED ? "-" : t->status == LC_TEST_PENDING ? "?" : lc_jail_code_name(t->code);
}

static void print_test(FILE *out, const lc_grade_result *r, int i, int teacher)
{
    const lc_test_result *t = &r->tests[i];
    int open = teacher || lc_test_is_open(t), is_right = t->status == LC_TEST_PASSED || t->status == LC_TEST_SKIPPED;
    fprintf(out, "%2d %-3s %5.4g / %-4.4g %s\n", i + 1, code_of(t), t->points, t->most_points, t->title);
    if (t->status == LC_TEST_PENDING)
        return;
    fprintf(out, "                     %s\n", teacher ? t->sentence : t->shown);
    if (t->hint[0])
        fprintf(out, "                     %s: %s\n", r->labels[LC_LABEL_HINT], t->hint);
    if (open && t->pictures[0][0] && !is_right)
        fprintf(out, "                     %s: %s, %s, %s\n", r->labels[LC_LABEL_PICTURES], t->pictures[0], t->pictures[1], t->pictures[2]);
    if (open && t->reproduce[0] && !is_right)
        fprintf(out, "                     %s: %s\n", r->labels[LC_LABEL_AGAIN], t->reproduce);
    if (!open && !is_right)
        fprintf(out, "                     %s\n", t->withheld);
}

void lc_grade_text(FILE *out, const lc_grade_result *r, int teacher)
{
    fprintf(out, "%s: %s\n%s%s%s, seed %llu, attempt %d, jail: %s\n", r->assignment, r->title, r->file,
            r->student[0] ? ", " : "", r->student, (unsigned long long)r->seed, r->attempt, r->jail);
    if (r->is_ungradable) {
        fprintf(out, "\n%s: %s\n%s", r->labels[LC_LABEL_UNGRADABLE], r->message, r->warnings);
        return;
    }
    fprintf(out, "\n");
    for (int i = 0; i < r->test_count; ++i)
        print_test(out, r, i, teacher);
    if (r->message[0])
        fprintf(out, "\n%s\n", r->message);
    if (r->said[0])
        fprintf(out, "\n%s:\n%s\n", r->labels[LC_LABEL_PRINTED], r->said);
    if (r->is_fault) {
        fprintf(out, "\n%s\n", r->labels[LC_LABEL_FAULT]);
        return;
    }
    fprintf(out, "\n%s", r->labels[LC_LABEL_SCORE]);
    if (r->late_days > 0)
        fprintf(out, " (%s)", r->labels[LC_LABEL_LATE]);
    fprintf(out, ", in %.1f s\n", r->seconds);
}
