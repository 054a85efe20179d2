/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reports are read back: JSON by jansson, JUnit by a small reader of the XML that it may contain, text by its lines. */
#include "verify/tests/tests.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "verify/report/report.h"
#include "verify/report/safe.h"
#include "verify/tests/xml_help.h"

static lc_row *add_row(lc_report *report, lc_row_verdict verdict)
{
    lc_row *row = lc_report_add(report);
    ck_assert_ptr_nonnull(row);
    strcpy(row->check, "analytic");
    strcpy(row->scene, "two_lights");
    strcpy(row->estimator, "light_direct");
    strcpy(row->source, "Lambert's \"formula\" <1760> & more");
    strcpy(row->reproduce, "build/lightcheck verify -e light_direct");
    row->verdict = verdict;
    row->ratio = 1.01;
    row->low = 0.99;
    row->high = 1.03;
    row->margin = 0.005;
    row->expected = 0.5;
    row->samples = 256;
    row->paths = 1234567;
    if (verdict == LC_ROW_PASS)
        row->missed = 3;
    else
        strcpy(row->reason, "a <b> & \"c\" \x01 d");
    return row;
}

/* A PASS, an exact PASS, a FAIL with a tile, an UNDECIDED full of what JSON cannot say. */
static void fill(lc_report *report)
{
    memset(report, 0, sizeof *report);
    report->seed = UINT64_MAX;
    strcpy(report->suite, "quick");
    strcpy(report->budget, "the budget\n");
    report->false_fail = report->false_pass = 1e-6;
    report->not_applicable = 8;
    report->paths = 5000000000u;
    add_row(report, LC_ROW_PASS);
    add_row(report, LC_ROW_PASS)->exact = 1;
    lc_row *row = add_row(report, LC_ROW_FAIL);
    row->tile_x = 8, row->tile_y = 16, row->tile_width = 4, row->tile_height = 2;
    row->tile_ratio = NAN;
    row->tile_log10_p = -INFINITY;
    row = add_row(report, LC_ROW_UNDECIDED);
    row->ratio = NAN, row->low = -INFINITY, row->high = INFINITY, row->margin = INFINITY, row->expected = NAN;
}

static char text[1 << 16];

static void write_report(const lc_report *report, const char *format)
{
    FILE *file = tmpfile();
    lc_error err;
    ck_assert_ptr_nonnull(file);
    if (strcmp(format, "json") == 0)
        ck_assert_int_eq(lc_report_json(file, report, &err), LC_OK);
    else if (strcmp(format, "junit") == 0)
        lc_report_junit(file, report);
    else
        lc_report_text(file, report);
    ck_assert(!ferror(file));
    rewind(file);
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
}

static json_t *get(json_t *object, const char *key)
{
    json_t *value = json_object_get(object, key);
    ck_assert_msg(value != NULL, "no key '%s'", key);
    return value;
}

START_TEST(json_reads_back)
{
    lc_report report;
    json_error_t why;
    fill(&report);
    write_report(&report, "json");
    json_t *o = json_loads(text, 0, &why);
    ck_assert_msg(o != NULL, "%s", why.text);
    ck_assert_str_eq(json_string_value(get(o, "seed")), "18446744073709551615");
    ck_assert_str_eq(json_string_value(get(o, "suite")), "quick");
    ck_assert_str_eq(json_string_value(get(o, "version")), LC_VERSION);
    ck_assert(json_real_value(get(o, "false_fail_probability")) == 1e-6);
    ck_assert(json_real_value(get(o, "false_pass_probability")) == 1e-6);
    ck_assert_int_eq(json_integer_value(get(o, "not_applicable")), 8);
    ck_assert(json_integer_value(get(o, "paths")) == 5000000000);
    json_t *rows = get(o, "rows");
    ck_assert_uint_eq(json_array_size(rows), 4);
    static const char *const verdicts[] = {"PASS", "PASS", "FAIL", "UNDECIDED"};
    for (size_t i = 0; i < 4; ++i) {
        json_t *row = json_array_get(rows, i);
        ck_assert_str_eq(json_string_value(get(row, "verdict")), verdicts[i]);
        ck_assert_str_eq(json_string_value(get(row, "check")), "analytic");
        ck_assert_str_eq(json_string_value(get(row, "expected_source")), report.rows[i].source);
        ck_assert_int_eq(json_integer_value(get(row, "samples_per_pixel")), 256);
        ck_assert_int_eq(json_integer_value(get(row, "paths")), 1234567);
        ck_assert_int_eq(json_is_true(get(row, "exact")), i == 1);
        if (i >= 2)
            ck_assert_str_eq(json_string_value(get(row, "reason")), report.rows[i].reason);
    }
    json_t *pass = json_array_get(rows, 0);
    ck_assert(json_real_value(get(pass, "ratio")) == 1.01 && json_real_value(get(pass, "margin")) == 0.005);
    ck_assert(json_real_value(json_array_get(get(pass, "interval"), 0)) == 0.99);
    ck_assert(json_real_value(json_array_get(get(pass, "interval"), 1)) == 1.03);
    for (size_t i = 0; i < 2; ++i) /* exact or not */
        ck_assert(json_real_value(get(json_array_get(rows, i), "excluded_missed_contribution")) == 3);
    json_decref(o);
    lc_report_release(&report);
}
END_TEST

/* What is not a number becomes null; no key vanishes. */
START_TEST(json_has_null_for_what_is_no_number)
{
    static const char *const keys[] = {"ratio", "margin", "expected_mean"};
    lc_report report;
    json_error_t why;
    fill(&report);
    write_report(&report, "json");
    json_t *o = json_loads(text, 0, &why);
    ck_assert_msg(o != NULL, "%s", why.text);
    json_t *row = json_array_get(get(o, "rows"), 3), *tile = get(json_array_get(get(o, "rows"), 2), "worst_tile");
    for (int i = 0; i < 3; ++i)
        ck_assert_msg(json_is_null(get(row, keys[i])), "%s", keys[i]);
    ck_assert(json_is_null(json_array_get(get(row, "interval"), 0)));
    ck_assert(json_is_null(json_array_get(get(row, "interval"), 1)));
    ck_assert(json_is_null(get(tile, "ratio")) && json_is_null(get(tile, "log10_p")));
    ck_assert_int_eq(json_integer_value(get(tile, "x")), 8);
    ck_assert_int_eq(json_integer_value(get(tile, "height")), 2);
    json_decref(o);
    lc_report_release(&report);
}
END_TEST

/* ---- JUnit ------------------------------------------------------------------------------------------------------ */

START_TEST(junit_is_well_formed)
{
    lc_report report;
    fill(&report);
    write_report(&report, "junit");
    ck_assert_int_eq(count_tags(text, "testsuites"), 1);
    ck_assert_int_eq(count_tags(text, "testsuite"), 1);
    ck_assert_int_eq(count_tags(text, "testcase"), 4);
    ck_assert_int_eq(count_tags(text, "failure"), 2);
    ck_assert_int_eq(count_tags(text, "property"), 2);
    ck_assert_ptr_nonnull(strstr(text, "tests=\"4\" failures=\"2\""));
    ck_assert_ptr_nonnull(strstr(text, "type=\"wrong\" message=\"a &lt;b&gt; &amp; &quot;c&quot;   d\""));
    ck_assert_ptr_nonnull(strstr(text, "type=\"undecided\""));
    ck_assert_ptr_nonnull(strstr(text, "&lt;1760&gt; &amp; more"));
    lc_report_release(&report);
}
END_TEST

/* Any bytes: what is UTF-8 stays, what is not becomes '?', and nothing vanishes. */
START_TEST(texts_of_any_bytes)
{
    static const char *const cases[][3] = {
        {"m\xc3\xbc \xe2\x82\xac \xf0\x9f\x98\x80", "m\xc3\xbc \xe2\x82\xac \xf0\x9f\x98\x80", "m\xc3\xbc \xe2\x82\xac \xf0\x9f\x98\x80"},
        {"a\xff" "b\x80", "a?b?", "a?b?"},                          /* no first byte, */
        {"\xc0\xaf \xe0\x80\x80", "?? ???", "?? ???"},           /* overlong, */
        {"\xed\xa0\x80 \xf4\x90\x80\x80", "??? ????", "??? ????"}, /* surrogate, too large, */
        {"\xe2\x82", "??", "??"},                                   /* cut off */
        {"\x01<\"\x1b", "\x01<\"\x1b", " &lt;&quot; "},
        {"\xef\xbf\xbf", "\xef\xbf\xbf", " "}, /* XML has no U+FFFF */
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char xml[64] = "";
        json_t *o = lc_json_text(cases[i][0]);
        ck_assert_str_eq(json_string_value(o), cases[i][1]);
        json_decref(o);
        FILE *out = fmemopen(xml, sizeof xml, "w");
        lc_xml_text(out, cases[i][0]);
        fclose(out);
        ck_assert_str_eq(xml, cases[i][2]);
    }
    ck_assert_ptr_null(json_string("\xff")); /* why this is needed */
    ck_assert_ptr_null(json_real(NAN));
}
END_TEST

START_TEST(text_tells_what_failed)
{
    lc_report report;
    fill(&report);
    write_report(&report, "text");
    ck_assert_ptr_nonnull(strstr(text, "4 rows: 2 PASS, 1 FAIL, 1 UNDECIDED; 8 pairs"));
    ck_assert_ptr_nonnull(strstr(text, "suite quick, seed 18446744073709551615"));
    ck_assert_ptr_nonnull(strstr(text, "[0.99000, 1.03000]"));
    ck_assert_ptr_nonnull(strstr(text, "exact"));
    ck_assert_ptr_nonnull(strstr(text, "(none yet)"));
    ck_assert_ptr_nonnull(strstr(text, "the budget\n"));
    ck_assert_ptr_nonnull(strstr(text, "worst tile: 4x2 pixels at 8,16: light where none is expected, p = "));
    ck_assert_ptr_nonnull(strstr(text, "again: build/lightcheck verify -e light_direct\n"));
    ck_assert_ptr_nonnull(strstr(text, "1.2M"));
    lc_row pass = {.verdict = LC_ROW_PASS, .missed = 1667, .low = 0.99, .high = 1.01}; /* 0.005 x 4.6 M / 13.8 */
    static const struct {
        double missed;
        const char *ending;
    } unseen[] = {{1667, "   1.7k"}, {99.4, "     99"}, {4.2, "    4.2"}, {2.5e6, "   2.5M"}, {0, "       "}};
    for (size_t i = 0; i < sizeof unseen / sizeof unseen[0]; ++i) {
        FILE *out = fmemopen(text, sizeof text, "w");
        pass.missed = unseen[i].missed;
        lc_report_text_row(out, &pass);
        fclose(out);
        ck_assert_str_eq(text + strlen(text) - 7, unseen[i].ending);
    }
    lc_row exact = {.verdict = LC_ROW_PASS, .exact = 1, .missed = 95, .paths = 262144};
    FILE *line = fmemopen(text, sizeof text, "w");
    lc_report_text_row(line, &exact);
    fclose(line);
    ck_assert_msg(strstr(text, "    exact    262.1k      95") != NULL, "%s", text);
    lc_row fail = {.verdict = LC_ROW_FAIL, .missed = 1667};
    FILE *out = fmemopen(text, sizeof text, "w");
    lc_report_text_row(out, &fail);
    fclose(out);
    ck_assert_ptr_null(strstr(text, "1.7k")); /* only a PASS excludes anything */
    lc_report_release(&report);
}
END_TEST

/* Below the table, and only where somebody asked. */
START_TEST(behaviour_is_told)
{
    lc_report report;
    fill(&report);
    write_report(&report, "text");
    ck_assert_ptr_null(strstr(text, "behaves"));
    write_report(&report, "json");
    ck_assert_ptr_null(strstr(text, "diagnosis"));
    report.behaviour = calloc(1, sizeof *report.behaviour);
    ck_assert_ptr_nonnull(report.behaviour);
    lc_behaviour *b = report.behaviour;
    strcpy(b->estimator, "mine");
    strcpy(b->of, "light_direct");
    strcpy(b->names[0], "light_no_pi");
    strcpy(b->summaries[0], "no pi");
    strcpy(b->lines[0], "a factor");
    b->name_count = b->line_count = b->is_certain = 1;
    write_report(&report, "text");
    ck_assert_ptr_nonnull(strstr(text, "mine behaves exactly as light_direct with this bug: no pi (light_no_pi)\n    measured: a factor\n"));
    write_report(&report, "json");
    json_t *o = json_loads(text, 0, NULL), *diagnosis = json_object_get(o, "diagnosis");
    ck_assert_str_eq(json_string_value(json_object_get(json_array_get(json_object_get(diagnosis, "bugs"), 0), "name")), "light_no_pi");
    ck_assert(json_is_true(json_object_get(diagnosis, "certain")));
    json_decref(o);
    b->is_certain = 0;
    write_report(&report, "text");
    ck_assert_ptr_null(strstr(text, "exactly"));
    b->name_count = 0;
    write_report(&report, "text");
    ck_assert_ptr_nonnull(strstr(text, "mine: not all was decided"));
    b->is_certain = 1;
    write_report(&report, "text");
    ck_assert_ptr_nonnull(strstr(text, "mine behaves as none of the known bugs\n"));
    lc_report_release(&report);
    ck_assert_ptr_null(report.behaviour);
}
END_TEST

/* A row that is missing since the renderer under test failed is an error everywhere; one that it refused is not. */
START_TEST(what_was_not_judged_is_no_pass)
{
    lc_report report;
    lc_error err;
    fill(&report);
    report.count = 2; /* those that pass */
    ck_assert_int_eq(lc_report_note(&report, "povray", "sky", 0, "refused", &err), LC_OK);
    ck_assert_int_eq(lc_report_status(&report), LC_OK);
    for (int i = 0; i < 2; ++i) /* the same is said once */
        ck_assert_int_eq(lc_report_note(&report, "analytic", "occluder", 1, "ended by <signal 11>", &err), LC_OK);
    ck_assert_int_eq(lc_report_faults(&report), 1);
    ck_assert_int_eq(lc_report_status(&report), LC_FAULT);
    report.count = 3; /* and one that fails */
    ck_assert_int_eq(lc_report_status(&report), LC_WRONG);
    write_report(&report, "junit");
    ck_assert_int_eq(count_tags(text, "testcase"), 4);
    ck_assert_int_eq(count_tags(text, "error"), 1);
    ck_assert_ptr_nonnull(strstr(text, "tests=\"4\" failures=\"1\" errors=\"1\""));
    ck_assert_ptr_nonnull(strstr(text, "message=\"ended by &lt;signal 11&gt;\""));
    write_report(&report, "text");
    ck_assert_ptr_nonnull(strstr(text, "NOT JUDGED: ended by <signal 11>\n"));
    ck_assert_ptr_nonnull(strstr(text, "no row: refused\n"));
    ck_assert_ptr_nonnull(strstr(text, "; 1 NOT JUDGED; "));
    write_report(&report, "json");
    json_t *root = json_loads(text, 0, NULL), *notes = get(root, "no_row");
    ck_assert(json_is_false(get(json_array_get(notes, 0), "fault")) && json_is_true(get(json_array_get(notes, 1), "fault")));
    json_decref(root);
    lc_report_release(&report);
}
END_TEST

START_TEST(status_is_the_worst_row)
{
    lc_report report;
    memset(&report, 0, sizeof report);
    ck_assert_int_eq(lc_report_status(&report), LC_BAD_INPUT); /* nothing was shown */
    add_row(&report, LC_ROW_PASS);
    ck_assert_int_eq(lc_report_status(&report), LC_OK);
    add_row(&report, LC_ROW_UNDECIDED);
    ck_assert_int_eq(lc_report_status(&report), LC_UNDECIDED);
    add_row(&report, LC_ROW_FAIL);
    add_row(&report, LC_ROW_UNDECIDED);
    ck_assert_int_eq(lc_report_status(&report), LC_WRONG);
    ck_assert_str_eq(lc_row_verdict_name(LC_ROW_UNDECIDED), "UNDECIDED");
    lc_report_release(&report);
}
END_TEST

Suite *lc_suite_report(void)
{
    Suite *suite = suite_create("report");
    TCase *tc = tcase_create("core");
    tcase_add_test(tc, json_reads_back);
    tcase_add_test(tc, json_has_null_for_what_is_no_number);
    tcase_add_test(tc, junit_is_well_formed);
    tcase_add_test(tc, texts_of_any_bytes);
    tcase_add_test(tc, text_tells_what_failed);
    tcase_add_test(tc, behaviour_is_told);
    tcase_add_test(tc, what_was_not_judged_is_no_pass);
    tcase_add_test(tc, status_is_the_worst_row);
    suite_add_tcase(suite, tc);
    return suite;
}
