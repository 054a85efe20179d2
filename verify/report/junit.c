/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The report in the common subset of JUnit's XML: testsuites / testsuite / properties / testcase / failure. UNDECIDED is a failure of
 * type "undecided": no CI system must take it for a pass. What could not be judged, since the renderer under test failed, is an error.
 */
#include "verify/report/report.h"
#include "verify/report/safe.h"

/* A test case up to the end of its name. */
static void begin_case(FILE *out, const char *check, const char *scene)
{
    fputs("    <testcase classname=\"lightcheck.", out);
    lc_xml_text(out, check);
    fputs("\" name=\"", out);
    lc_xml_text(out, scene);
}

static void print_row(FILE *out, const lc_row *row)
{
    begin_case(out, row->check, row->scene);
    fputc('/', out);
    lc_xml_text(out, row->estimator);
    if (row->verdict == LC_ROW_PASS) {
        fputs("\"/>\n", out);
        return;
    }
    fprintf(out, "\">\n      <failure type=\"%s\" message=\"", row->verdict == LC_ROW_FAIL ? "wrong" : "undecided");
    lc_xml_text(out, row->reason);
    fputs("\">expected: ", out);
    lc_xml_text(out, row->source);
    fputs("; again: ", out);
    lc_xml_text(out, row->reproduce);
    fputs("</failure>\n    </testcase>\n", out);
}

static void print_fault(FILE *out, const lc_note *note)
{
    begin_case(out, note->check, note->scene);
    fputs("\">\n      <error type=\"fault\" message=\"", out);
    lc_xml_text(out, note->reason);
    fputs("\"/>\n    </testcase>\n", out);
}

void lc_report_junit(FILE *out, const lc_report *report)
{
    int failures = 0, errors = lc_report_faults(report), tests = report->count + errors;
    for (int i = 0; i < report->count; ++i)
        failures += report->rows[i].verdict != LC_ROW_PASS;
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n", out);
    fprintf(out,
            "<testsuites tests=\"%d\" failures=\"%d\" errors=\"%d\">\n  <testsuite name=\"lightcheck.%s\" tests=\"%d\" "
            "failures=\"%d\" errors=\"%d\" skipped=\"0\">\n",
            tests, failures, errors, report->suite, tests, failures, errors);
    fprintf(out,
            "    <properties>\n      <property name=\"seed\" value=\"%llu\"/>\n      <property name=\"version\" "
            "value=\"%s\"/>\n    </properties>\n",
            (unsigned long long)report->seed, LC_VERSION);
    for (int i = 0; i < report->count; ++i)
        print_row(out, &report->rows[i]);
    for (int i = 0; i < report->note_count; ++i)
        if (report->notes[i].is_fault)
            print_fault(out, &report->notes[i]);
    fputs("  </testsuite>\n</testsuites>\n", out);
}
