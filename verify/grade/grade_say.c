/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * What a test says: status, points, sentence, and the line that shows the same again.
 */
#include <stdio.h>
#include <string.h>

#include "verify/grade/grading.h"

void lc_test_settle(lc_test_result *out, double share)
{
    out->points = share * out->most_points;
    out->code = share >= 1 ? LC_JAIL_AC : LC_JAIL_WA;
    out->status = share >= 1 ? LC_TEST_PASSED : share > LC_NEAR_SHARE ? LC_TEST_PARTIAL : LC_TEST_FAILED;
}

void lc_test_say(lc_test_result *out, const lc_grading *g, const char *id, const lc_words *words)
{
    const char *shown = out->status == LC_TEST_PASSED    ? "hidden_passed"
                        : out->status == LC_TEST_PARTIAL ? "hidden_partial"
                        : out->status == LC_TEST_FAILED  ? "hidden_failed"
                                                         : NULL;
    snprintf(out->sentence_id, sizeof out->sentence_id, "%s", id);
    lc_say(out->sentence, sizeof out->sentence, g->sentences, id, words);
    lc_say(out->shown, sizeof out->shown, g->sentences, lc_test_is_open(out) || !shown ? id : shown, words);
}

void lc_test_bad(lc_test_result *out, const lc_grading *g, const char *scene, const lc_film *film, const lc_term *terms)
{
    const lc_term *term = terms && film->bad_term > 0 ? &terms[film->bad_term - 1] : NULL;
    int fewer = term ? term->shift : 0;
    char file[LC_SHELL_WORD(1024)], where[LC_SHELL_WORD(256)];
    scene = term ? lc_scene_description(term->scene)->name : scene;
    lc_words words = {.count = 0};
    lc_measured *m = &out->measured;
    m->bad_x = film->bad_x;
    m->bad_y = film->bad_y;
    m->bad_sample = film->bad_sample;
    m->bad_count = film->bad;
    memcpy(m->bad_value, film->bad_value, sizeof m->bad_value);
    lc_words_set(&words, "scene", "%s", scene);
    lc_words_set(&words, "count", "%llu", (unsigned long long)film->bad);
    lc_words_set(&words, "red", "%g", film->bad_value[0]);
    lc_words_set(&words, "green", "%g", film->bad_value[1]);
    lc_words_set(&words, "blue", "%g", film->bad_value[2]);
    lc_words_set(&words, "x", "%d", film->bad_x);
    lc_words_set(&words, "y", "%d", film->bad_y);
    lc_words_set(&words, "sample", "%llu", (unsigned long long)film->bad_sample);
    lc_words_set(&words, "seed", "%llu", (unsigned long long)film->seed);
    lc_test_settle(out, 0);
    lc_test_say(out, g, "bad_sample", &words);
    snprintf(out->reproduce, sizeof out->reproduce,
             "%s sample %s -e %s --pixel %d,%d --index %llu --seed %llu --arm %lu --min-bounces %d --bounces %d", g->options->program,
             lc_shell_word(where, scene), lc_grading_file(file, g), film->bad_x, film->bad_y, (unsigned long long)film->bad_sample,
             (unsigned long long)film->seed, (unsigned long)film->arm, film->min_bounces - fewer, film->max_bounces - fewer);
}

void lc_test_end(lc_test_result *out, const lc_grading *g, const char *scene, lc_jail_code code, const char *reason)
{
    lc_words words = {.count = 0};
    char id[32];
    lc_test_settle(out, 0);
    out->code = code;
    if (code == LC_JAIL_IE)
        out->status = LC_TEST_FAULT;
    lc_words_set(&words, "scene", "%s", scene);
    lc_words_set(&words, "reason", "%.190s", reason);
    snprintf(id, sizeof id, "ended_%s", lc_jail_code_name(code));
    lc_test_say(out, g, code == LC_JAIL_IE ? "fault" : id, &words);
}

int lc_test_ended(lc_test_result *out, const lc_grading *g, const char *scene)
{
    const lc_jail_verdict *last = g->jail ? lc_jail_last(g->jail) : NULL;
    if (!last || last->code == LC_JAIL_AC)
        return 0;
    lc_test_end(out, g, scene, last->code, last->text);
    return 1;
}
