/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/report/report.h"

#include <stdlib.h>
#include <string.h>

lc_row *lc_report_add(lc_report *report)
{
    lc_row *rows = realloc(report->rows, ((size_t)report->count + 1) * sizeof *rows);
    if (!rows)
        return NULL;
    report->rows = rows;
    lc_row *row = &rows[report->count++];
    memset(row, 0, sizeof *row);
    return row;
}

lc_status lc_report_note(lc_report *report, const char *check, const char *scene, int is_fault, const char *reason, lc_error *err)
{
    lc_note note = {.is_fault = is_fault};
    snprintf(note.check, sizeof note.check, "%.31s", check);
    snprintf(note.scene, sizeof note.scene, "%.63s", scene);
    snprintf(note.reason, sizeof note.reason, "%.255s", reason);
    for (int i = 0; i < report->note_count; ++i) {
        const lc_note *n = &report->notes[i];
        if (strcmp(n->check, note.check) == 0 && strcmp(n->scene, note.scene) == 0 && strcmp(n->reason, note.reason) == 0)
            return LC_OK;
    }
    lc_note *notes = realloc(report->notes, ((size_t)report->note_count + 1) * sizeof *notes);
    if (!notes)
        return lc_fail(err, LC_FAULT, "out of memory for the report");
    report->notes = notes;
    notes[report->note_count++] = note;
    return LC_OK;
}

int lc_report_faults(const lc_report *report)
{
    int count = 0;
    for (int i = 0; i < report->note_count; ++i)
        count += report->notes[i].is_fault != 0;
    return count;
}

void lc_report_release(lc_report *report)
{
    free(report->rows);
    free(report->notes);
    free(report->behaviour);
    memset(report, 0, sizeof *report);
}

const char *lc_row_verdict_name(lc_row_verdict verdict)
{
    static const char *const names[] = {"PASS", "FAIL", "UNDECIDED"}; /* in the order of lc_row_verdict */
    return names[verdict];
}

lc_status lc_report_status(const lc_report *report)
{
    lc_status status = lc_report_faults(report) ? LC_FAULT : report->count ? LC_OK : LC_BAD_INPUT;
    for (int i = 0; i < report->count; ++i) {
        if (report->rows[i].verdict == LC_ROW_FAIL)
            return LC_WRONG;
        if (report->rows[i].verdict == LC_ROW_UNDECIDED && status == LC_OK)
            status = LC_UNDECIDED;
    }
    return status;
}
