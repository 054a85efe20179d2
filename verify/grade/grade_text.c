/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A result as text, for a terminal of 80 columns or more. Names of files, sentences and what was printed are a student's in part.
 */
#include <math.h>

#include "verify/grade/result.h"
#include "verify/report/plain.h"

static const char *code_of(const lc_test_result *t)
{
    return t->status == LC_TEST_SKIPPED ? "-" : t->status == LC_TEST_PENDING ? "?" : lc_jail_code_name(t->code);
}

/* A line about a test, below it. */
static void print_line(FILE *out, const char *label, const char *text)
{
    fprintf(out, "                     %s%s", label ? label : "", label ? ": " : "");
    lc_plain(out, text);
    fputc('\n', out);
}

static void print_pictures(FILE *out, const lc_grade_result *r, const lc_test_result *t)
{
    char text[3 * sizeof t->pictures[0] + 8];
    snprintf(text, sizeof text, "%s, %s, %s", t->pictures[0], t->pictures[1], t->pictures[2]);
    print_line(out, r->labels[LC_LABEL_PICTURES], text);
}

static void print_test(FILE *out, const lc_grade_result *r, int i, int teacher)
{
    const lc_test_result *t = &r->tests[i];
    int open = teacher || lc_test_is_open(t), is_right = t->status == LC_TEST_PASSED || t->status == LC_TEST_SKIPPED;
    fprintf(out, "%2d %-3s %5.4g / %-4.4g %s\n", i + 1, code_of(t), t->points, t->most_points, t->title);
    if (t->status == LC_TEST_PENDING)
        return;
    print_line(out, NULL, teacher ? t->sentence : t->shown);
    if (t->hint[0])
        print_line(out, r->labels[LC_LABEL_HINT], t->hint);
    if (open && t->pictures[0][0] && !is_right)
        print_pictures(out, r, t);
    if (open && t->reproduce[0] && !is_right)
        print_line(out, r->labels[LC_LABEL_AGAIN], t->reproduce);
    if (!open && !is_right)
        print_line(out, NULL, t->withheld);
}

static void print_head(FILE *out, const lc_grade_result *r)
{
    fprintf(out, "%s: %s\n", r->assignment, r->title);
    lc_plain(out, r->file);
    fputs(r->student[0] ? ", " : "", out);
    lc_plain(out, r->student);
    fprintf(out, ", seed %llu, attempt %d, jail: %s\n", (unsigned long long)r->seed, r->attempt, r->jail);
}

void lc_grade_text(FILE *out, const lc_grade_result *r, int teacher)
{
    print_head(out, r);
    if (r->is_ungradable) {
        fprintf(out, "\n%s: ", r->labels[LC_LABEL_UNGRADABLE]);
        lc_plain(out, r->message);
        fputc('\n', out);
        lc_plain_lines(out, r->warnings, "    | ");
        return;
    }
    fprintf(out, "\n");
    for (int i = 0; i < r->test_count; ++i)
        print_test(out, r, i, teacher);
    if (r->message[0]) {
        fputc('\n', out);
        lc_plain(out, r->message);
        fputc('\n', out);
    }
    if (r->said[0]) {
        fprintf(out, "\n%s:\n", r->labels[LC_LABEL_PRINTED]);
        lc_plain_lines(out, r->said, "    | ");
    }
    if (r->is_fault) {
        fprintf(out, "\n%s\n", r->labels[LC_LABEL_FAULT]);
        return;
    }
    fprintf(out, "\n%s", r->labels[LC_LABEL_SCORE]);
    if (r->late_days > 0)
        fprintf(out, " (%s)", r->labels[LC_LABEL_LATE]);
    fprintf(out, ", in %.1f s\n", r->seconds);
}
