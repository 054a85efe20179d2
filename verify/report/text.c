/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The report as a table for a person: one line a row, what failed in words below it.
 */
#include <math.h>
#include <string.h>

#include "verify/report/report.h"

void lc_report_text_header(FILE *out)
{
    fprintf(out, "%-11s %-24s %-20s %-5s %-9s %10s  %-22s %8s %9s %7s\n", "check", "scene", "estimator", "k", "verdict",
            "estimate", "interval", "margin", "paths", "unseen");
}

/* 4.6M */
static void format_count(char *text, size_t size, uint64_t count)
{
    if (count >= 1000000)
        snprintf(text, size, "%.1fM", (double)count * 1e-6);
    else if (count >= 1000)
        snprintf(text, size, "%.1fk", (double)count * 1e-3);
    else
        snprintf(text, size, "%llu", (unsigned long long)count);
}

/* How large a contribution may be that no sample met, in units of the mean; a PASS excludes larger ones. */
static void format_unseen(char *text, size_t size, const lc_row *row)
{
    text[0] = 0;
    if (row->verdict == LC_ROW_PASS && row->missed >= 1e15)
        snprintf(text, size, "%.1e", row->missed);
    else if (row->verdict == LC_ROW_PASS && row->missed >= 100)
        format_count(text, size, (uint64_t)(row->missed + 0.5));
    else if (row->verdict == LC_ROW_PASS && row->missed > 0)
        snprintf(text, size, "%.2g", row->missed);
}

void lc_report_text_row(FILE *out, const lc_row *row)
{
    char interval[64] = "", margin[16] = "exact", estimate[32] = "", paths[32], unseen[32];
    char bounces[32];
    if (row->min_bounces == row->max_bounces)
        snprintf(bounces, sizeof bounces, "%d", row->min_bounces);
    else
        snprintf(bounces, sizeof bounces, "%d-%d", row->min_bounces, row->max_bounces);
    format_count(paths, sizeof paths, row->paths);
    format_unseen(unseen, sizeof unseen, row);
    if (!row->exact) {
        snprintf(estimate, sizeof estimate, "%.5f", row->ratio);
        if (isfinite(row->low) && isfinite(row->high))
            snprintf(interval, sizeof interval, "[%.5f, %.5f]", row->low, row->high);
        else
            snprintf(interval, sizeof interval, "(none yet)");
        snprintf(margin, sizeof margin, "%.2f%%", 100 * row->margin);
    }
    fprintf(out, "%-11s %-24s %-20s %-5s %-9s %10s  %-22s %8s %9s %7s", row->check, row->scene, row->estimator, bounces,
            lc_row_verdict_name(row->verdict), estimate, interval, margin, paths, unseen);
}

static void print_tile(FILE *out, const lc_row *row)
{
    fprintf(out, "    worst tile: %dx%d pixels at %d,%d: ", row->tile_width, row->tile_height, row->tile_x, row->tile_y);
    if (isfinite(row->tile_ratio))
        fprintf(out, "%.4g times what is expected there", row->tile_ratio);
    else
        fprintf(out, "light where none is expected");
    fprintf(out, ", p = 1e%.0f\n", row->tile_log10_p);
}

static void print_trouble(FILE *out, const lc_row *row)
{
    fprintf(out, "    %s\n    expected: %s\n", row->reason, row->source);
    if (row->tile_width && !row->exact)
        print_tile(out, row);
    if (row->pictures[0])
        fprintf(out, "    pictures: %s.difference.png (red: too much, blue: too little), .is, .expected, .difference, each .exr and .png\n",
                row->pictures);
    fprintf(out, "    again: %s\n", row->reproduce);
}

static void print_behaviour(FILE *out, const lc_behaviour *b)
{
    if (b->name_count == 1 && b->is_certain)
        fprintf(out, "\n%s behaves exactly as %s with this bug: %s (%s)\n", b->estimator, b->of, b->summaries[0], b->names[0]);
    else if (b->name_count) {
        fprintf(out, "\n%s: %s\n", b->estimator,
                b->is_certain ? "behaves exactly as any of these, which no view tells apart"
                              : "not all was decided; what was shown equal to it, while the truth was not");
        for (int i = 0; i < b->name_count; ++i)
            fprintf(out, "    %s: %s\n", b->names[i], b->summaries[i]);
    } else
        fprintf(out, b->is_certain ? "\n%s behaves as none of the known bugs\n"
                                   : "\n%s: not all was decided; no known bug is shown equal to it\n",
                b->estimator);
    for (int i = 0; i < b->line_count; ++i)
        fprintf(out, "    measured: %s\n", b->lines[i]);
}

void lc_report_text(FILE *out, const lc_report *report)
{
    int counts[3] = {0, 0, 0};
    lc_report_text_header(out);
    for (int i = 0; i < report->count; ++i) {
        const lc_row *row = &report->rows[i];
        lc_report_text_row(out, row);
        fputc('\n', out);
        if (row->verdict != LC_ROW_PASS)
            print_trouble(out, row);
        ++counts[row->verdict];
    }
    for (int i = 0; i < report->note_count; ++i) {
        const lc_note *n = &report->notes[i];
        fprintf(out, "%s%-10s %-18s %s: %s\n", i ? "" : "\n", n->check, n->scene, n->is_fault ? "NOT JUDGED" : "no row", n->reason);
    }
    if (report->behaviour)
        print_behaviour(out, report->behaviour);
    fprintf(out, "\nestimate: mean of reflected light / what is expected, in the hardest of three channels; PASS: "
                 "shown within 1 +- margin.\n"
                 "unseen: light of the margin's size that no sample met can only come in samples worth more than this many "
                 "times the mean (of an exact row: light of the size of the run's margin).\n");
    fprintf(out, "%s", report->budget);
    fprintf(out,
            "%d rows: %d PASS, %d FAIL, %d UNDECIDED; ",
            report->count, counts[LC_ROW_PASS], counts[LC_ROW_FAIL], counts[LC_ROW_UNDECIDED]);
    if (lc_report_faults(report))
        fprintf(out, "%d NOT JUDGED; ", lc_report_faults(report));
    fprintf(out,
            "%d pairs of estimator and scene not applicable; %.0f M paths; "
            "suite %s, seed %llu\n",
            report->not_applicable, (double)report->paths * 1e-6, report->suite, (unsigned long long)report->seed);
}
