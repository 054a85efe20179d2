/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Results as the systems read them that courses use.
 */
#include "verify/grade/formats_c.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* None of these systems knows null where a number belongs. */
static double known(double value) { return isfinite(value) ? value : 0; }
static json_t *known_json(double value) { return json_real(known(value)); }

/* ---- Gradescope --------------------------------------------------------------------------------------------------- */

/* gradescope-autograders.readthedocs.io: "specs". What is hidden is written, with its visibility: the teacher sees it. */
static json_t *gradescope_test(const lc_grade_result *r, const lc_test_result *t, int number, int *ok)
{
    char text[16];
    json_t *o = json_object();
    snprintf(text, sizeof text, "%d", number);
    lc_json_set(o, "name", lc_json_text(t->title), ok);
    lc_json_set(o, "number", json_string(text), ok);
    lc_json_set(o, "score", known_json(t->points), ok);
    lc_json_set(o, "max_score", known_json(t->most_points), ok);
    lc_json_set(o, "status", json_string(t->status == LC_TEST_PASSED ? "passed" : "failed"), ok);
    lc_json_set(o, "output", lc_json_taken(lc_result_feedback(r, t, 0)), ok);
    lc_json_set(o, "output_format", json_string("text"), ok);
    lc_json_set(o, "visibility", json_string(lc_visibility_name(t->visibility)), ok);
    return o;
}

/* Gradescope knows no hand-in without a score: what could not be graded has 0 there, and the reason comes first. */
lc_status lc_result_gradescope(FILE *out, const lc_grade_result *r, int teacher, lc_error *err)
{
    int ok = 1;
    json_t *o = json_object(), *tests = json_array(), *extra = json_object();
    (void)teacher;
    lc_json_set(o, "score", known_json(r->is_ungradable || r->is_fault ? 0 : r->score), &ok);
    lc_json_set(o, "execution_time", known_json(r->seconds), &ok);
    lc_json_set(o, "output", lc_json_taken(lc_result_summary(r)), &ok);
    lc_json_set(o, "output_format", json_string("text"), &ok);
    lc_json_set(o, "visibility", json_string("visible"), &ok);
    lc_json_set(o, "stdout_visibility", json_string("hidden"), &ok);
    lc_json_set(extra, "code", json_string(lc_jail_code_name(r->code)), &ok);
    lc_json_set(extra, "seed", lc_json_seed(r->seed), &ok);
    lc_json_set(extra, "attempt", json_integer(r->attempt), &ok);
    lc_json_set(extra, "complete", json_boolean(r->done == r->test_count), &ok);
    lc_json_set(o, "extra_data", extra, &ok);
    for (int i = 0; i < r->test_count; ++i)
        lc_json_append(tests, gradescope_test(r, &r->tests[i], i + 1, &ok), &ok);
    lc_json_set(o, "tests", tests, &ok);
    return lc_json_dump(out, o, ok, err);
}

/* ---- PrairieLearn -------------------------------------------------------------------------------------------------- */

static json_t *prairielearn_test(const lc_grade_result *r, const lc_test_result *t, int teacher, int *ok)
{
    json_t *o = json_object();
    lc_json_set(o, "name", lc_json_text(t->title), ok);
    lc_json_set(o, "description", lc_json_text(t->name), ok);
    lc_json_set(o, "points", known_json(t->points), ok);
    lc_json_set(o, "max_points", known_json(t->most_points), ok);
    lc_json_set(o, "message", json_string(lc_test_status_name(t->status)), ok);
    lc_json_set(o, "output", lc_json_taken(lc_result_feedback(r, t, !teacher)), ok);
    return o;
}

/* Not gradable costs no attempt there. */
lc_status lc_result_prairielearn(FILE *out, const lc_grade_result *r, int teacher, lc_error *err)
{
    int ok = 1, gradable = !r->is_ungradable && !r->is_fault;
    double most = r->most_points > 0 ? r->most_points : 1;
    json_t *o = json_object(), *tests = json_array(), *errors = json_array();
    lc_json_set(o, "gradable", json_boolean(gradable), &ok);
    lc_json_set(o, "score", known_json(gradable ? r->score / most : 0), &ok);
    lc_json_set(o, "output", lc_json_taken(lc_result_summary(r)), &ok);
    if (!gradable)
        lc_json_append(errors, lc_json_taken(lc_result_summary(r)), &ok);
    lc_json_set(o, "format_errors", errors, &ok);
    for (int i = 0; gradable && i < r->test_count; ++i)
        lc_json_append(tests, prairielearn_test(r, &r->tests[i], teacher, &ok), &ok);
    lc_json_set(o, "tests", tests, &ok);
    return lc_json_dump(out, o, ok, err);
}

/* ---- GitHub Classroom ----------------------------------------------------------------------------------------------- */

static json_t *classroom_test(const lc_grade_result *r, const lc_test_result *t, int teacher, int *ok)
{
    json_t *o = json_object();
    lc_json_set(o, "name", lc_json_text(t->title), ok);
    lc_json_set(o, "status", json_string(t->status == LC_TEST_PASSED ? "pass" : t->status == LC_TEST_FAULT ? "error" : "fail"), ok);
    lc_json_set(o, "score", known_json(t->points), ok);
    lc_json_set(o, "message", lc_json_taken(lc_result_feedback(r, t, !teacher)), ok);
    return o;
}

/* RFC 4648, section 4. */
static void write_base64(FILE *out, const unsigned char *c, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        unsigned second = i + 1 < size ? c[i + 1] : 0, third = i + 2 < size ? c[i + 2] : 0;
        unsigned bits = (unsigned)c[i] << 16 | second << 8 | third;
        fputc(digits[bits >> 18], out);
        fputc(digits[bits >> 12 & 63], out);
        fputc(i + 1 < size ? digits[bits >> 6 & 63] : '=', out);
        fputc(i + 2 < size ? digits[bits & 63] : '=', out);
    }
}

lc_status lc_result_classroom(FILE *out, const lc_grade_result *r, int teacher, lc_error *err)
{
    int ok = 1;
    json_t *o = json_object(), *tests = json_array();
    for (int i = 0; i < r->test_count; ++i)
        lc_json_append(tests, classroom_test(r, &r->tests[i], teacher, &ok), &ok);
    lc_json_set(o, "version", json_integer(1), &ok);
    lc_json_set(o, "status",
                json_string(r->is_ungradable || r->is_fault        ? "error"
                            : lc_grade_status(r) == LC_OK && r->test_count ? "pass"
                                                                   : "fail"),
                &ok);
    lc_json_set(o, "max_score", known_json(r->most_points), &ok);
    lc_json_set(o, "tests", tests, &ok);
    char *text = o && ok ? json_dumps(o, JSON_COMPACT | JSON_REAL_PRECISION(12)) : NULL;
    json_decref(o);
    if (!text)
        return lc_fail(err, LC_FAULT, "out of memory for a result");
    write_base64(out, (const unsigned char *)text, strlen(text));
    fputc('\n', out);
    free(text);
    return LC_OK;
}

/* ---- JUnit ----------------------------------------------------------------------------------------------------------- */

static void junit_attribute(FILE *out, const char *name, const char *value)
{
    fprintf(out, " %s=\"", name);
    lc_xml_text(out, value);
    fputc('"', out);
}

static lc_status junit_test(FILE *out, const lc_grade_result *r, const lc_test_result *t, int teacher, lc_error *err)
{
    char *text = lc_result_feedback(r, t, !teacher);
    if (!text)
        return lc_fail(err, LC_FAULT, "out of memory for a result");
    fputs("    <testcase", out);
    junit_attribute(out, "classname", r->assignment);
    junit_attribute(out, "name", t->name);
    fprintf(out, " time=\"%.3f\"", known(t->seconds));
    const char *tag = t->status == LC_TEST_FAULT                                      ? "error"
                      : t->status == LC_TEST_SKIPPED || t->status == LC_TEST_PENDING ? "skipped"
                                                                                      : "failure";
    if (t->status == LC_TEST_PASSED) {
        fputs("/>\n", out);
    } else {
        fprintf(out, ">\n      <%s", tag);
        if (strcmp(tag, "skipped") != 0)
            junit_attribute(out, "type", lc_jail_code_name(t->code));
        junit_attribute(out, "message", t->title);
        fputc('>', out);
        lc_xml_text(out, text);
        fprintf(out, "</%s>\n    </testcase>\n", tag);
    }
    free(text);
    return LC_OK;
}

/* What could not be graded is one error, in place of the tests. */
static void junit_ungradable(FILE *out, const lc_grade_result *r)
{
    fputs("    <testcase", out);
    junit_attribute(out, "classname", r->assignment);
    fputs(" name=\"graded\">\n      <error", out);
    junit_attribute(out, "type", lc_jail_code_name(r->code));
    junit_attribute(out, "message", r->message);
    fputs("/>\n    </testcase>\n", out);
}

lc_status lc_result_junit(FILE *out, const lc_grade_result *r, int teacher, lc_error *err)
{
    int counts[LC_TEST_FAULT + 1] = {0}, total = r->is_ungradable ? 0 : r->test_count, extra = r->is_ungradable || total == 0;
    lc_status status = LC_OK;
    for (int i = 0; i < total; ++i)
        ++counts[r->tests[i].status];
    fprintf(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n  <testsuite");
    junit_attribute(out, "name", r->assignment);
    fprintf(out, " tests=\"%d\" failures=\"%d\" errors=\"%d\" skipped=\"%d\" time=\"%.3f\">\n    <properties>\n", total + extra,
            counts[LC_TEST_FAILED] + counts[LC_TEST_PARTIAL], counts[LC_TEST_FAULT] + extra,
            counts[LC_TEST_SKIPPED] + counts[LC_TEST_PENDING], known(r->seconds));
    fprintf(out, "      <property name=\"seed\" value=\"%llu\"/>\n      <property name=\"score\" value=\"%g\"/>\n",
            (unsigned long long)r->seed, known(r->score));
    fprintf(out, "      <property name=\"max_score\" value=\"%g\"/>\n    </properties>\n", known(r->most_points));
    for (int i = 0; i < total && status == LC_OK; ++i)
        status = junit_test(out, r, &r->tests[i], teacher, err);
    if (extra)
        junit_ungradable(out, r);
    fputs("  </testsuite>\n</testsuites>\n", out);
    return status;
}
