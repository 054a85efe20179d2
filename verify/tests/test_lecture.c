/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of docs/checks.md, sentence by sentence: each row names a check, a scene and an estimator that exist, the full suite has it,
 * and it comes out as the table says. */
#include "verify/tests/tests.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "estimators/registry.h"
#include "verify/judge/judge_c.h"
#include "verify/mutants/registry.h"
#include "verify/tests/load_help.h"

#define HEADING "## The lecture, sentence by sentence"

typedef struct sentence {
    char text[160], check[32], scene[64], estimator[64], result[16];
} sentence;

/* The next cell of a table's line, trimmed; returns what follows it. */
static const char *cell(char *out, size_t size, const char *line)
{
    const char *end = strchr(line, '|');
    ck_assert_msg(end != NULL, "not a row: %s", line);
    while (*line == ' ')
        ++line;
    size_t length = (size_t)(end - line);
    while (length > 0 && line[length - 1] == ' ')
        --length;
    ck_assert_msg(length > 0 && length < size, "an empty or too long cell: %s", line);
    memcpy(out, line, length);
    out[length] = '\0';
    return end + 1;
}

/* Reads the table; its head and the line below it are not sentences. */
static int read_table(sentence *out, int most)
{
    FILE *file = fopen("docs/checks.md", "r");
    char line[1024];
    int inside = 0, rows = 0;
    ck_assert_msg(file != NULL, "docs/checks.md cannot be read");
    while (fgets(line, sizeof line, file)) {
        if (strncmp(line, "## ", 3) == 0)
            inside = strncmp(line, HEADING, strlen(HEADING)) == 0;
        if (!inside || line[0] != '|' || rows++ < 2)
            continue;
        ck_assert_int_lt(rows - 3, most);
        sentence *s = &out[rows - 3];
        const char *rest = cell(s->text, sizeof s->text, line + 1);
        rest = cell(s->check, sizeof s->check, rest);
        rest = cell(s->scene, sizeof s->scene, rest);
        rest = cell(s->estimator, sizeof s->estimator, rest);
        cell(s->result, sizeof s->result, rest);
    }
    fclose(file);
    return rows - 2;
}

/* NULL for the host; *is_mutant tells where it was found. */
static const lc_estimator *find(const sentence *s, int *is_mutant)
{
    *is_mutant = 0;
    for (const lc_estimator *const *e = lc_estimators; *e; ++e)
        if (strcmp((*e)->name, s->estimator) == 0)
            return *e;
    *is_mutant = 1;
    const lc_mutant *mutant = lc_mutant_find(s->estimator);
    if (mutant)
        return mutant->estimator;
    ck_abort_msg("\"%s\": no estimator %s", s->text, s->estimator);
    return NULL;
}

static const lc_check *find_check(const sentence *s)
{
    for (const lc_check *const *c = lc_checks; *c; ++c)
        if (strcmp((*c)->name, s->check) == 0)
            return *c;
    ck_abort_msg("\"%s\": no check %s", s->text, s->check);
    return NULL;
}

enum { MOST_SENTENCES = 100, SIDE = 16 }; /* images are small: what is expected of a pixel is dear */

static lc_status load_small(lc_scene **out, const char *name, lc_error *err) { return load_sized(out, name, SIDE, err); }

/* The claim of the full suite about the scene, with this relation or none; the last, where there are several depths. */
static const lc_claim *find_claim(const lc_claims *claims, const sentence *s, const lc_estimator *estimator)
{
    const lc_claim *found = NULL;
    for (int i = 0; i < claims->count; ++i) {
        const lc_claim *claim = &claims->items[i];
        char name[160];
        if (!claim->scene)
            snprintf(name, sizeof name, "%s", claim->subject);
        else
            snprintf(name, sizeof name, "%s%s%s", lc_scene_description(claim->scene)->name, claim->relation ? "/" : "",
                     claim->relation ? claim->relation : "");
        if (claim->estimator == estimator && strcmp(name, s->scene) == 0 &&
            lc_suite_has(lc_suite_find("full"), claim))
            found = claim;
    }
    return found;
}

static void plan(lc_claims *claims, lc_scene **scene, const sentence *s, const lc_estimator *estimator)
{
    const lc_check *check = find_check(s);
    lc_error err = {""};
    char name[64];
    *scene = NULL;
    memset(claims, 0, sizeof *claims);
    if (!estimator) {
        ck_assert_msg(check->plan_host(check, claims, &err) == LC_OK, "\"%s\": %s", s->text, err.text);
        return;
    }
    snprintf(name, sizeof name, "%.*s", (int)strcspn(s->scene, "/"), s->scene);
    ck_assert_msg(lc_suite_scene(scene, name, 1, load_small, &err) == LC_OK, "\"%s\": %s", s->text, err.text);
    ck_assert_msg(check->plan(check, claims, *scene, estimator, &err) == LC_OK, "\"%s\": %s", s->text, err.text);
}

/* As in the full suite, at eight times its margin, which spares 63 of 64 samples; where these are too few for their skewness, at twice. */
static void judge(lc_row *row, const lc_claim *claim, const sentence *s)
{
    lc_verify_options options;
    lc_error err = {""};
    lc_verify_options_init(&options);
    options.suite = lc_suite_find("full");
    for (int factor = 8; factor > 1; factor /= 4) {
        lc_session session = {.options = &options, .rows = MOST_SENTENCES, .margin = factor * options.suite->margin};
        memset(row, 0, sizeof *row);
        ck_assert_msg(lc_judge_claim(row, &session, claim, &err) == LC_OK, "\"%s\": %s", s->text, err.text);
        lc_session_clear(&session);
        if (row->verdict != LC_ROW_UNDECIDED)
            return;
    }
}

START_TEST(each_sentence_is_a_row)
{
    sentence table[MOST_SENTENCES];
    int count = read_table(table, MOST_SENTENCES);
    ck_assert_int_gt(count, 60);
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < i; ++k)
            ck_assert_msg(strcmp(table[i].text, table[k].text) != 0, "\"%s\" stands there twice", table[i].text);
}
END_TEST

START_TEST(a_sentence_is_as_it_says)
{
    sentence table[MOST_SENTENCES];
    if (_i >= read_table(table, MOST_SENTENCES))
        return;
    const sentence *s = &table[_i];
    int is_mutant = 0;
    const lc_estimator *estimator = strcmp(s->estimator, "host") == 0 ? NULL : find(s, &is_mutant);
    lc_claims claims;
    lc_scene *scene;
    lc_row row;
    ck_assert_msg(strcmp(s->result, is_mutant ? "FAIL" : "PASS") == 0, "\"%s\": %s cannot be %s", s->text,
                  s->estimator, s->result);
    plan(&claims, &scene, s, estimator);
    const lc_claim *claim = find_claim(&claims, s, estimator);
    ck_assert_msg(claim != NULL, "\"%s\": the full suite has no row %s %s %s", s->text, s->check, s->scene,
                  s->estimator);
    judge(&row, claim, s);
    ck_assert_msg(strcmp(lc_row_verdict_name(row.verdict), s->result) == 0, "\"%s\": %s, not %s: %s", s->text,
                  lc_row_verdict_name(row.verdict), s->result, row.reason);
    lc_claims_release(&claims);
    lc_scene_free(scene);
}
END_TEST

Suite *lc_suite_lecture(void)
{
    Suite *suite = suite_create("lecture");
    TCase *c = tcase_create("lecture");
    tcase_set_timeout(c, 60);
    tcase_set_tags(c, "long"); /* many samples, no code that other tests do not run */
    tcase_add_test(c, each_sentence_is_a_row);
    tcase_add_loop_test(c, a_sentence_is_as_it_says, 0, MOST_SENTENCES);
    suite_add_tcase(suite, c);
    return suite;
}
