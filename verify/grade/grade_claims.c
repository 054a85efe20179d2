/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Tests of the mean: the judge's rows become points and sentences.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "verify/grade/grading.h"

/* The steps of points: how near to the expected value the mean was shown to be, in margins of the assignment. */
static const struct {
    double margins, share;
} steps[] = {{1, 1}, {2, 0.7}, {10, 0.4}};
static const double NEAR = 0.05;

double lc_grade_share(double *margin_shown, const lc_row *row)
{
    double off = fmax(fabs(row->low - 1), fabs(row->high - 1));
    *margin_shown = NAN;
    if (row->verdict == LC_ROW_PASS) {
        *margin_shown = row->exact ? 0 : row->margin;
        return 1;
    }
    if (row->exact || row->dependent || row->samples == 0 || !isfinite(off))
        return 0;
    if (row->verdict == LC_ROW_FAIL) {
        int is_near = off <= NEAR && (row->tile_width == 0 || fabs(row->tile_ratio - 1) <= NEAR);
        *margin_shown = is_near ? NEAR : NAN;
        return is_near ? LC_NEAR_SHARE : 0;
    }
    for (size_t i = 1; i < sizeof steps / sizeof steps[0]; ++i)
        if (off <= steps[i].margins * row->margin) {
            *margin_shown = steps[i].margins * row->margin;
            return steps[i].share;
        }
    return 0;
}

/* ---- words ------------------------------------------------------------------------------------------------------------ */

static void set_percent(lc_words *words, const char *name, double ratio)
{
    double percent = 100 * ratio;
    if (!isfinite(percent))
        lc_words_set(words, name, "%s", percent < 0 ? "-infinity" : percent > 0 ? "infinity" : "?");
    else
        lc_words_set(words, name, fabs(percent) < 1000 ? "%.4g%%" : "%.3g%%", percent);
}

static void set_words(lc_words *words, const lc_grading *g, const lc_test_result *out, const lc_row *row, const lc_claim *claim)
{
    char tile[64];
    const lc_measured *m = &out->measured;
    lc_words_set(words, "scene", "%s", row->scene);
    set_percent(words, "measured", m->measured);
    set_percent(words, "low", m->low);
    set_percent(words, "high", m->high);
    lc_words_set(words, "margin", "%.3g%%", 100 * m->margin);
    lc_words_set(words, "shown", "%.3g%%", 100 * m->margin_shown);
    lc_words_set(words, "samples", "%llu", (unsigned long long)m->samples);
    lc_words_set(words, "paths", "%llu", (unsigned long long)m->paths);
    lc_words_set(words, "relation", "%.150s", claim->source);
    set_percent(words, "tile_measured", m->worst.ratio);
    lc_words_set(words, "x", "%d", m->worst.x);
    lc_words_set(words, "y", "%d", m->worst.y);
    lc_words_set(words, "width", "%d", m->worst.width);
    lc_words_set(words, "height", "%d", m->worst.height);
    lc_words_set(words, "tile", "%s", lc_say(tile, sizeof tile, g->sentences, "word_tile", words));
    lc_words_set(words, "is", "%.6g", m->measured * m->expected);
    lc_words_set(words, "should", "%.6g", m->expected);
}

static void fill_numbers(lc_test_result *out, const lc_row *row)
{
    lc_measured *m = &out->measured;
    uint64_t paths = m->paths;
    *m = (lc_measured){row->expected, row->ratio, row->low, row->high, row->margin, NAN, row->channel, row->samples, paths,
                       {row->tile_x, row->tile_y, row->tile_width, row->tile_height, row->tile_ratio}, -1, -1, 0, 0, {0, 0, 0}};
    lc_grade_share(&m->margin_shown, row);
    snprintf(out->scene, sizeof out->scene, "%s", row->scene);
}

static const char *sentence_of(const lc_row *row, const lc_claim *claim, const lc_film *film, double share)
{
    if (row->dependent)
        return "dependent";
    if (row->verdict == LC_ROW_PASS)
        return claim->relation ? "relation_right" : row->exact ? "right_exactly" : "right";
    if (claim->relation)
        return row->verdict == LC_ROW_FAIL ? "relation_wrong" : share > 0 ? "relation_near" : "relation_open";
    if (row->exact)
        return isfinite(row->ratio) ? "wrong_pixel" : "light_from_nowhere";
    if (film && lc_film_is_black(film))
        return "black";
    if (row->verdict == LC_ROW_UNDECIDED)
        return share > 0 ? "near" : "open";
    return share > 0 ? "wrong_but_near" : row->tile_width ? "wrong_tile" : "wrong";
}

double lc_test_row(lc_test_result *out, const lc_grading *g, const lc_claim *claim, const lc_row *row, const lc_film *film)
{
    lc_words words = {.count = 0};
    double margin_shown, share = lc_grade_share(&margin_shown, row);
    fill_numbers(out, row);
    lc_test_settle(out, share);
    set_words(&words, g, out, row, claim);
    lc_test_say(out, g, sentence_of(row, claim, film, share), &words);
    return share;
}

/* ---- one claim ---------------------------------------------------------------------------------------------------------- */

/* What the row means for the test; the share of its points. */
static double report(lc_test_result *out, const lc_grading *g, const lc_claim *claim, const lc_row *row, const lc_seen *seen)
{
    const char *scene = lc_scene_description(claim->scene)->name;
    lc_words words = {.count = 0};
    fill_numbers(out, row);
    lc_test_settle(out, 0);
    if (row->verdict == LC_ROW_FAIL && lc_test_ended(out, g, scene))
        return 0;
    if (seen->bad) {
        lc_test_bad(out, g, scene, seen->bad, claim->term_count ? claim->term : NULL);
        return 0;
    }
    if (row->verdict == LC_ROW_FAIL && !seen->film) { /* there is nothing to hold it against */
        lc_words_set(&words, "reason", "%.190s", row->reason);
        out->status = LC_TEST_FAULT;
        out->code = LC_JAIL_IE;
        lc_test_say(out, g, "fault", &words);
        return 0;
    }
    return lc_test_row(out, g, claim, row, seen->film);
}

lc_status lc_grade_claims(lc_grading *g, const lc_job *job, lc_test_result *out, lc_error *err)
{
    lc_verify_options options;
    lc_session *session;
    double least = 2;
    lc_grading_options(&options, g, job);
    lc_status status = lc_session_open(&session, &options, g->rows, err);
    const lc_claim *worst = NULL;
    for (int i = 0; status == LC_OK && i < job->claims.count && least > 0; ++i) {
        const lc_claim *claim = &job->claims.items[i];
        lc_row row;
        lc_seen seen;
        memset(&row, 0, sizeof row);
        status = lc_judge_claim(&row, session, claim, err);
        if (status != LC_OK)
            break;
        out->measured.paths += row.paths;
        double margin_shown, share = lc_grade_share(&margin_shown, &row);
        lc_session_seen(&seen, session, claim);
        if (share >= least)
            continue;
        least = report(out, g, claim, &row, &seen);
        worst = claim;
    }
    if (status == LC_OK && worst && g->options->report && lc_test_is_open(out)) {
        lc_seen seen;
        lc_session_seen(&seen, session, worst);
        status = lc_grade_pictures(g, &seen, out, err);
    }
    lc_session_close(session);
    return status;
}
