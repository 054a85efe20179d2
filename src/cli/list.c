/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "estimators/registry.h"
#include "io/scene_path.h"
#include "verify/checks/checks.h"
#include "verify/grade/assignment.h"
#include "verify/mutants/registry.h"

#define EXPECTED "expected one of: estimators, scenes, checks, mutants, variants, assignments"

/* One item of a list; summary and source may be NULL. */
typedef void item_fn(json_t *array, const char *name, const char *summary, const char *source);

static void print_item(json_t *array, const char *name, const char *summary, const char *source)
{
    (void)array;
    if (!summary)
        printf("%s\n", name);
    else if (!source)
        printf("%-24s %s\n", name, summary);
    else
        printf("%-24s %s [%s]\n", name, summary, source);
}

static void add_item(json_t *array, const char *name, const char *summary, const char *source)
{
    json_t *item = json_pack("{s:s}", "name", name);
    if (summary)
        json_object_set_new(item, "summary", json_string(summary));
    if (source)
        json_object_set_new(item, "source", json_string(source));
    json_array_append_new(array, item);
}

static void list_estimators(item_fn *item, json_t *array)
{
    for (const lc_estimator *const *e = lc_estimators; *e; ++e)
        item(array, (*e)->name, (*e)->summary, (*e)->source);
}

static void list_checks(item_fn *item, json_t *array)
{
    for (const lc_check *const *c = lc_checks; *c; ++c)
        item(array, (*c)->name, (*c)->summary, (*c)->source);
}

static void list_mutants(item_fn *item, json_t *array)
{
    const lc_mutant *m;
    for (int i = 0; (m = lc_mutant_at(i)) != NULL; ++i)
        item(array, m->estimator->name, m->estimator->summary, m->of);
}

static void list_variants(item_fn *item, json_t *array)
{
    for (const lc_estimator *const *e = lc_variants; *e; ++e)
        item(array, (*e)->name, (*e)->summary, (*e)->source);
}

static lc_status list_scenes(item_fn *item, json_t *array, lc_error *err)
{
    char **names;
    int count;
    lc_status status = lc_scene_names(&names, &count, err);
    if (status != LC_OK)
        return status;
    for (int i = 0; i < count; ++i)
        item(array, names[i], NULL, NULL);
    lc_scene_names_free(names, count);
    return LC_OK;
}

typedef struct item_user {
    item_fn *item;
    json_t *array;
} item_user;

static void list_assignment(void *user, const char *name, const char *title)
{
    item_user *u = user;
    u->item(u->array, name, title, NULL);
}

static lc_status list(void *user, const lc_strings *rest, lc_error *err)
{
    int json = *(int *)user;
    const char *what = rest->items[0];
    json_t *array = json ? json_array() : NULL;
    item_fn *item = json ? add_item : print_item;
    lc_status status = LC_OK;
    if (strcmp(what, "estimators") == 0)
        list_estimators(item, array);
    else if (strcmp(what, "checks") == 0)
        list_checks(item, array);
    else if (strcmp(what, "mutants") == 0)
        list_mutants(item, array);
    else if (strcmp(what, "variants") == 0)
        list_variants(item, array);
    else if (strcmp(what, "scenes") == 0)
        status = list_scenes(item, array, err);
    else if (strcmp(what, "assignments") == 0)
        status = lc_assignment_list(list_assignment, &(item_user){item, array}, err);
    else
        status = lc_fail(err, LC_BAD_INPUT, EXPECTED);
    if (json && status == LC_OK) {
        json_dumpf(array, stdout, JSON_INDENT(2));
        putchar('\n');
    }
    json_decref(array);
    return status;
}

static int run(const lc_command *self, int argc, char **argv)
{
    int json = 0;
    const lc_option options[] = {{0, "json", LC_OPT_FLAG, &json, NULL, "as a JSON array", 0, 0, NULL},
                                 {0, NULL, LC_OPT_FLAG, NULL, NULL, NULL, 0, 0, NULL}};
    return lc_command_run(self, options, argc, argv, 1, 1, EXPECTED, list, &json);
}

const lc_command lc_command_list = {
    "list", "estimators|scenes|checks|mutants|variants|assignments [--json]", "what there is: one item a line, the name first", NULL, run,
};
