/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The report as JSON. JSON has no infinity and no NaN: such a number is null (jansson would drop the key without a word).
 */
#include "verify/report/pictures.h"
#include "verify/report/safe.h"

/* The files of a row by what they show. */
static json_t *pictures_json(const lc_row *row)
{
    json_t *o = json_object();
    for (const lc_picture_kind *kind = lc_picture_kinds; o && kind->name; ++kind)
        json_object_set_new(o, kind->name, json_sprintf("%s%s", row->pictures, kind->ending));
    return o;
}

static json_t *row_json(const lc_row *row)
{
    json_t *o = json_pack("{s:s, s:s, s:s, s:i, s:i, s:s, s:b, s:s, s:I, s:I, s:s}", "check", row->check, "scene",
                          row->scene, "estimator", row->estimator, "min_bounces", row->min_bounces, "max_bounces",
                          row->max_bounces, "verdict", lc_row_verdict_name(row->verdict), "exact", row->exact,
                          "expected_source", row->source, "samples_per_pixel", (json_int_t)row->samples, "paths",
                          (json_int_t)row->paths, "reproduce", row->reproduce);
    if (!o)
        return NULL;
    if (!row->exact) {
        json_object_set_new(o, "channel", json_string(row->channel == 0 ? "R" : row->channel == 1 ? "G" : "B"));
        json_object_set_new(o, "ratio", lc_json_number(row->ratio));
        json_object_set_new(o, "interval", json_pack("[o, o]", lc_json_number(row->low), lc_json_number(row->high)));
        json_object_set_new(o, "margin", lc_json_number(row->margin));
        json_object_set_new(o, "expected_mean", lc_json_number(row->expected));
    }
    if (row->verdict == LC_ROW_PASS && (!row->exact || row->missed > 0))
        json_object_set_new(o, "excluded_missed_contribution", lc_json_number(row->missed));
    if (row->verdict != LC_ROW_PASS)
        json_object_set_new(o, "reason", lc_json_text(row->reason));
    if (row->pictures[0])
        json_object_set_new(o, "pictures", pictures_json(row));
    if (row->tile_width && !row->exact)
        json_object_set_new(o, "worst_tile",
                            json_pack("{s:i, s:i, s:i, s:i, s:o, s:o}", "x", row->tile_x, "y", row->tile_y, "width",
                                      row->tile_width, "height", row->tile_height, "ratio", lc_json_number(row->tile_ratio),
                                      "log10_p", lc_json_number(row->tile_log10_p)));
    return o;
}

static json_t *notes_json(const lc_report *report)
{
    json_t *notes = json_array();
    for (int i = 0; notes && i < report->note_count; ++i) {
        const lc_note *n = &report->notes[i];
        json_array_append_new(notes, json_pack("{s:s, s:s, s:b, s:s}", "check", n->check, "scene", n->scene, "fault",
                                               n->is_fault, "reason", n->reason));
    }
    return notes;
}

static json_t *behaviour_json(const lc_behaviour *b)
{
    json_t *names = json_array(), *lines = json_array();
    for (int i = 0; names && i < b->name_count; ++i)
        json_array_append_new(names, json_pack("{s:s, s:s}", "name", b->names[i], "summary", b->summaries[i]));
    for (int i = 0; lines && i < b->line_count; ++i)
        json_array_append_new(lines, json_string(b->lines[i]));
    return json_pack("{s:s, s:s, s:b, s:o, s:o}", "estimator", b->estimator, "of", b->of, "certain", b->is_certain, "bugs", names,
                     "measured", lines);
}

lc_status lc_report_json(FILE *out, const lc_report *report, lc_error *err)
{
    json_t *rows = json_array();
    for (int i = 0; rows && i < report->count; ++i)
        json_array_append_new(rows, row_json(&report->rows[i]));
    char seed[32];
    snprintf(seed, sizeof seed, "%llu",
             (unsigned long long)report->seed); /* 64 bits do not fit a JSON number everywhere */
    json_t *o = json_pack("{s:s, s:s, s:s, s:s, s:o, s:o, s:i, s:I, s:o, s:o}", "program", "lightcheck", "version",
                          LC_VERSION, "suite", report->suite, "seed", seed, "false_fail_probability",
                          lc_json_number(report->false_fail), "false_pass_probability", lc_json_number(report->false_pass),
                          "not_applicable", report->not_applicable, "paths", (json_int_t)report->paths, "rows", rows, "no_row",
                          notes_json(report));
    if (!o)
        return lc_fail(err, LC_FAULT, "out of memory for the JSON report");
    if (report->behaviour)
        json_object_set_new(o, "diagnosis", behaviour_json(report->behaviour));
    json_dumpf(o, out, JSON_INDENT(2) | JSON_REAL_PRECISION(12));
    fputc('\n', out);
    json_decref(o);
    return LC_OK;
}
