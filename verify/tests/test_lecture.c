/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of docs/checks.md, sentence by sentence: each row names a check, a scene and an estimator that exist, and the suites plan it. */
#include "verify/tests/tests.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "estimators/registry.h"
#include "verify/judge/judge.h"
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

/* 1 when a claim about the scene, with this relation or none, is among them. */
static int is_planned(const lc_claims *claims, const sentence *s, const lc_estimator *estimator)
{
    for (int i = 0; i < claims->count; ++i) {
        const lc_claim *claim = &claims->items[i];
        char name[160];
        if (!claim->scene)
            snprintf(name, sizeof name, "%s", claim->subject);
        else
            snprintf(name, sizeof name, "%s%s%s", lc_scene_description(claim->scene)->name, claim->relation ? "/" : "",
                     claim->relation ? claim->relation : "");
        if (claim->estimator == estimator && strcmp(name, s->scene) == 0)
            return 1;
    }
    return 0;
}

START_TEST(each_sentence_is_a_row)
{
    static sentence table[100];
    int count = read_table(table, 100);
    lc_error err = {""};
    ck_assert_int_gt(count, 30);
    for (int i = 0; i < count; ++i) {
        const sentence *s = &table[i];
        const lc_check *check = find_check(s);
        lc_claims claims = {.count = 0};
        lc_scene *scene = NULL;
        int is_mutant = 0;
        const lc_estimator *estimator = NULL;
        lc_status status = LC_OK;
        if (strcmp(s->estimator, "host") == 0)
            status = check->plan_host(check, &claims, &err);
        else {
            char name[64];
            estimator = find(s, &is_mutant);
            snprintf(name, sizeof name, "%.*s", (int)strcspn(s->scene, "/"), s->scene);
            ck_assert_msg(lc_suite_scene(&scene, name, 1, load_scene, &err) == LC_OK, "\"%s\": %s", s->text, err.text);
            status = check->plan(check, &claims, scene, estimator, &err);
        }
        ck_assert_msg(status == LC_OK, "\"%s\": %s", s->text, err.text);
        ck_assert_msg(is_planned(&claims, s, estimator), "\"%s\": %s does not plan %s for %s", s->text, s->check,
                      s->scene, s->estimator);
        ck_assert_msg(strcmp(s->result, is_mutant ? "FAIL" : "PASS") == 0, "\"%s\": %s cannot be %s", s->text,
                      s->estimator, s->result);
        lc_claims_release(&claims);
        lc_scene_free(scene);
    }
}
END_TEST

Suite *lc_suite_lecture(void)
{
    Suite *suite = suite_create("lecture");
    TCase *c = tcase_create("lecture");
    tcase_set_timeout(c, 60);
    tcase_add_test(c, each_sentence_is_a_row);
    suite_add_tcase(suite, c);
    return suite;
}
