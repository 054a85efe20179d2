/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Reading an assignment. What it names (scenes, checks, estimators) is looked up here, so that a mistake is found before the first hand-in.
 */
#include "verify/grade/assignment.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "estimators/registry.h"
#include "io/scene_path.h"
#include "verify/checks/family.h"
#include "verify/grade/assignment_files.h"
#include "verify/grade/place.h"
#include "verify/grade/sentences.h"

static const char root_keys[] = "title|summary|reference|lobes|emitters|bounces|margin|false_failure|cpu_seconds|hints|due|"
                                "published|late|solutions|mutants_of|beyond|sentences|tests";
static const char test_keys[] =
    "name|title|kind|points|requires|visibility|scenes|check|relation|bounces|at_least|at_most|hint";
static const char kinds[] = "descriptor|finite|check|mean|variance|rays|numbers|work"; /* in the order of lc_test_kind */
static const char visibilities[] = "visible|after_due_date|after_published|hidden";
static const char lobe_words[] = "diffuse|mirror|glass|glossy"; /* bit 0, 1, ... */
static const char emitter_words[] = "area|point|directional|sky";

/* ---- names ---------------------------------------------------------------------------------------------------------- */

const lc_estimator *lc_right_estimator(const char *name)
{
    for (const lc_estimator *const *e = lc_estimators; *e; ++e)
        if (strcmp((*e)->name, name) == 0)
            return *e;
    for (const lc_estimator *const *e = lc_variants; *e; ++e)
        if (strcmp((*e)->name, name) == 0)
            return *e;
    return NULL;
}

static lc_status check_file(const lc_assignment *a, const lc_place *place, const char *name, lc_error *err)
{
    char path[LC_PATH_SIZE];
    return lc_assignment_find(path, a, name) ? LC_OK
                                             : lc_place_fail(err, place, "cannot read '%s': it is neither beside this file nor here", name);
}

static lc_status check_scene(const lc_assignment *a, const lc_place *place, const char *name, lc_error *err)
{
    char path[LC_PATH_SIZE];
    lc_error why;
    if (lc_scene_is_path(name))
        return check_file(a, place, name, err);
    if (lc_family_find(name) || lc_scene_locate(path, name, &why) == LC_OK)
        return LC_OK;
    return lc_place_fail(err, place, "%.700s", why.text);
}

static lc_status check_check(const lc_place *place, const char *name, lc_error *err)
{
    char list[256] = "";
    size_t used = 0;
    for (const lc_check *const *c = lc_checks; *c; ++c) {
        if (strcmp((*c)->name, name) == 0 && (*c)->plan)
            return LC_OK;
        if ((*c)->plan && used < sizeof list)
            used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", used ? ", " : "", (*c)->name);
    }
    return lc_place_fail(err, place, "unknown check '%s'; supported: %s", name, list);
}

/* Bits of a list of words. */
static lc_status read_mask(unsigned *out, const lc_place *place, const char *words, lc_error *err)
{
    size_t count;
    lc_status status = lc_place_array(&count, place, 4, 0, err);
    for (size_t i = 0; i < count && status == LC_OK; ++i) {
        lc_place item = lc_place_item(place, i);
        int bit = 0;
        status = lc_place_choice(&bit, &item, words, 1, err);
        *out = (i == 0 ? 0 : *out) | 1U << bit;
    }
    return status;
}

static int is_right(const char *name) { return lc_right_estimator(name) != NULL; }
static int is_mutant(const char *name) { return lc_mutant_find(name) != NULL; }

/* A list of estimators, of which `exists` knows the names; `lists` is what lists them. */
static lc_status read_names(char (*out)[64], int *count, const lc_place *place, int (*exists)(const char *name),
                            const char *lists, lc_error *err)
{
    size_t length;
    lc_status status = lc_place_array(&length, place, LC_MOST_SOLUTIONS, 0, err);
    for (size_t i = 0; i < length && status == LC_OK; ++i) {
        lc_place item = lc_place_item(place, i);
        status = lc_place_string(out[i], sizeof out[i], &item, 1, err);
        if (status == LC_OK && !exists(out[i]))
            status = lc_place_fail(err, &item, "unknown estimator '%s'; supported: see `lightcheck list %s`", out[i], lists);
        *count = (int)i + 1;
    }
    return status;
}

/* ---- a test ---------------------------------------------------------------------------------------------------------- */

static lc_status read_requires(lc_test *test, const lc_assignment *a, const lc_place *place, lc_error *err)
{
    size_t count;
    lc_status status = lc_place_array(&count, place, LC_MOST_REQUIRED, 0, err);
    for (size_t i = 0; i < count && status == LC_OK; ++i) {
        lc_place item = lc_place_item(place, i);
        char name[48] = "";
        int index = 0;
        status = lc_place_string(name, sizeof name, &item, 1, err);
        while (index < a->test_count && strcmp(a->tests[index].name, name) != 0)
            ++index;
        if (status == LC_OK && index == a->test_count)
            status = lc_place_fail(err, &item, "there is no test '%s' before this one", name);
        test->required[test->required_count++] = index;
    }
    return status;
}

static lc_status read_scenes(lc_test *test, const lc_assignment *a, const lc_place *place, lc_error *err)
{
    size_t count;
    int needs = test->kind != LC_KIND_DESCRIPTOR;
    lc_status status = lc_place_array(&count, place, LC_MOST_SCENES, needs, err);
    if (status == LC_OK && !needs && place->value)
        return lc_place_fail(err, place, "a test of kind descriptor renders nothing");
    for (size_t i = 0; i < count && status == LC_OK; ++i) {
        lc_place item = lc_place_item(place, i);
        status = lc_place_string(test->scenes[i], sizeof test->scenes[i], &item, 1, err);
        if (status == LC_OK)
            status = check_scene(a, &item, test->scenes[i], err);
        test->scene_lines[i] = lc_place_line(&item);
        test->scene_count = (int)i + 1;
    }
    return status;
}

static lc_status read_bounces(lc_test *test, const lc_place *place, lc_error *err)
{
    int *out[] = {&test->min_bounces, &test->max_bounces};
    if (!place->value)
        return LC_OK;
    if (json_array_size(place->value) != 2)
        return lc_place_fail(err, place, "expected two whole numbers, [first, last]");
    lc_status status = LC_OK;
    for (size_t i = 0; i < 2 && status == LC_OK; ++i) {
        lc_place item = lc_place_item(place, i);
        status = lc_place_int(out[i], &item, i ? test->min_bounces : 0, 64, 1, err);
    }
    return status;
}

const char *lc_test_kind_name(char *out, size_t size, lc_test_kind kind) { return lc_word_at(out, size, (int)kind, kinds); }

/* What only some kinds know. */
static lc_status read_particulars(lc_test *test, const lc_place *place, lc_error *err)
{
    static const struct {
        const char *key;
        int is_of_method;
    } only[] = {{"check", 0}, {"relation", 0}, {"at_least", 1}, {"at_most", 1}};
    for (size_t i = 0; i < sizeof only / sizeof only[0]; ++i) {
        lc_place given = lc_place_key(place, only[i].key);
        if (given.value && !(only[i].is_of_method ? lc_is_of_method(test->kind) : test->kind == LC_KIND_CHECK))
            return lc_place_fail(err, &given, "is for tests of kind %s", only[i].is_of_method ? "variance, rays, numbers or work" : "check");
    }
    lc_place check = lc_place_key(place, "check"), relation = lc_place_key(place, "relation");
    lc_place least = lc_place_key(place, "at_least"), most = lc_place_key(place, "at_most");
    lc_status status = lc_place_string(test->check, sizeof test->check, &check, test->kind == LC_KIND_CHECK, err);
    if (status == LC_OK && test->kind == LC_KIND_CHECK)
        status = check_check(&check, test->check, err);
    if (status == LC_OK)
        status = lc_place_string(test->relation, sizeof test->relation, &relation, 0, err);
    if (status == LC_OK)
        status = lc_place_number(&test->least, &least, 0, 0.95, 0, err);
    if (status == LC_OK)
        status = lc_place_number(&test->most, &most, 1.05, 100, 0, err);
    if (status == LC_OK && lc_is_of_method(test->kind) && !least.value && !most.value)
        status = lc_place_fail(err, place, "a test of kind variance, rays, numbers or work needs at_least, at_most, or both");
    return status;
}

static lc_status read_test(lc_assignment *a, const lc_place *place, lc_error *err)
{
    lc_test *test = &a->tests[a->test_count];
    int kind = 0, visibility = 0;
    test->min_bounces = test->max_bounces = -1;
    test->most = INFINITY;
    lc_place name = lc_place_key(place, "name"), title = lc_place_key(place, "title"), points = lc_place_key(place, "points");
    lc_place which = lc_place_key(place, "kind"), seen = lc_place_key(place, "visibility"), hint = lc_place_key(place, "hint");
    lc_place needs = lc_place_key(place, "requires"), scenes = lc_place_key(place, "scenes"), bounces = lc_place_key(place, "bounces");
    lc_status status = lc_place_object(place, test_keys, err);
    if (status == LC_OK)
        status = lc_place_string(test->name, sizeof test->name, &name, 1, err);
    if (status == LC_OK && strspn(test->name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_") !=
                               strlen(test->name))
        status = lc_place_fail(err, &name, "'%s': expected letters, digits and _", test->name);
    for (int i = 0; i < a->test_count && status == LC_OK; ++i)
        if (strcmp(a->tests[i].name, test->name) == 0)
            status = lc_place_fail(err, &name, "there is a test '%s' already", test->name);
    if (status == LC_OK)
        status = lc_place_string(test->title, sizeof test->title, &title, 1, err);
    if (status == LC_OK)
        status = lc_place_choice(&kind, &which, kinds, 1, err);
    test->kind = (lc_test_kind)kind;
    if (status == LC_OK)
        status = lc_place_number(&test->points, &points, 0, 1000, 1, err);
    if (status == LC_OK)
        status = lc_place_choice(&visibility, &seen, visibilities, 0, err);
    test->visibility = (lc_visibility)visibility;
    if (status == LC_OK)
        status = lc_place_string(test->hint, sizeof test->hint, &hint, 0, err);
    if (status == LC_OK)
        status = read_requires(test, a, &needs, err);
    if (status == LC_OK)
        status = read_scenes(test, a, &scenes, err);
    if (status == LC_OK)
        status = read_bounces(test, &bounces, err);
    if (status == LC_OK)
        status = read_particulars(test, place, err);
    ++a->test_count;
    return status;
}

/* ---- the whole ------------------------------------------------------------------------------------------------------- */

static lc_status read_reference(lc_assignment *a, const lc_place *root, lc_error *err)
{
    lc_place reference = lc_place_key(root, "reference"), lobes = lc_place_key(root, "lobes");
    lc_place emitters = lc_place_key(root, "emitters"), bounces = lc_place_key(root, "bounces");
    lc_status status = lc_place_string(a->reference, sizeof a->reference, &reference, 1, err);
    if (status != LC_OK)
        return status;
    const lc_estimator *e = lc_right_estimator(a->reference);
    if (!e)
        return lc_place_fail(err, &reference, "unknown estimator '%s'; `lightcheck list estimators` names them", a->reference);
    a->lobes = e->lobes & ~(unsigned)LC_GLOSSY; /* rough mirrors are asked for by name only */
    a->emitters = e->emitters;
    a->bounces = 1;
    status = read_mask(&a->lobes, &lobes, lobe_words, err);
    if (status == LC_OK)
        status = read_mask(&a->emitters, &emitters, emitter_words, err);
    if (status == LC_OK && (a->lobes & ~e->lobes || a->emitters & ~e->emitters))
        return lc_place_fail(err, a->lobes & ~e->lobes ? &lobes : &emitters, "%s has less than that", a->reference);
    if (status == LC_OK)
        status = lc_place_int(&a->bounces, &bounces, 0, e->max_bounces < 64 ? e->max_bounces : 64, 1, err);
    return status;
}

static lc_status read_hints(lc_assignment *a, const lc_place *place, lc_error *err)
{
    int show = LC_HINT_NONE;
    if (!place->value)
        return LC_OK;
    lc_place level = lc_place_key(place, "show"), after = lc_place_key(place, "after_attempts");
    lc_status status = lc_place_object(place, "show|after_attempts", err);
    if (status == LC_OK)
        status = lc_place_choice(&show, &level, "none|category|name", 1, err);
    a->hints = (lc_hint)show;
    return status == LC_OK ? lc_place_int(&a->hint_after_attempts, &after, 0, 1000, 0, err) : status;
}

static lc_status read_late(lc_assignment *a, const lc_place *place, lc_error *err)
{
    if (!place->value)
        return LC_OK;
    lc_place day = lc_place_key(place, "per_day"), most = lc_place_key(place, "most");
    lc_status status = lc_place_object(place, "per_day|most", err);
    a->late_most = 1;
    if (status == LC_OK && !a->due)
        status = lc_place_fail(err, place, "without `due` nothing is late");
    if (status == LC_OK)
        status = lc_place_number(&a->late_per_day, &day, 0, 1, 1, err);
    return status == LC_OK ? lc_place_number(&a->late_most, &most, 0, 1, 0, err) : status;
}

static lc_status read_times(lc_assignment *a, const lc_place *root, lc_error *err)
{
    lc_place due = lc_place_key(root, "due"), published = lc_place_key(root, "published"), late = lc_place_key(root, "late");
    int64_t moments[2] = {0, 0};
    lc_status status = lc_place_time(&moments[0], &due, err);
    if (status == LC_OK)
        status = lc_place_time(&moments[1], &published, err);
    a->due = (time_t)moments[0];
    a->published = (time_t)moments[1];
    return status == LC_OK ? read_late(a, &late, err) : status;
}

/* The table is read once here, for the mistakes in it. */
static lc_status read_sentences(lc_assignment *a, const lc_place *place, lc_error *err)
{
    char path[LC_PATH_SIZE];
    lc_sentences *table = NULL;
    lc_status status = lc_place_string(a->sentences, sizeof a->sentences, place, 0, err);
    if (status != LC_OK || !a->sentences[0])
        return status;
    status = check_file(a, place, a->sentences, err);
    if (status == LC_OK && lc_assignment_find(path, a, a->sentences))
        status = lc_sentences_open(&table, path, err);
    lc_sentences_close(table);
    return status;
}

static lc_status read_root(lc_assignment *a, const lc_place *root, lc_error *err)
{
    size_t count = 0;
    lc_place title = lc_place_key(root, "title"), summary = lc_place_key(root, "summary"), hints = lc_place_key(root, "hints");
    lc_place margin = lc_place_key(root, "margin"), budget = lc_place_key(root, "false_failure");
    lc_place seconds = lc_place_key(root, "cpu_seconds"), tests = lc_place_key(root, "tests");
    lc_place solutions = lc_place_key(root, "solutions"), mutants = lc_place_key(root, "mutants_of");
    lc_place sentences = lc_place_key(root, "sentences"), beyond = lc_place_key(root, "beyond");
    a->margin = 0.01;
    a->false_failure = 1e-6;
    a->cpu_seconds = 60;
    lc_status status = lc_place_object(root, root_keys, err);
    if (status == LC_OK)
        status = lc_place_string(a->title, sizeof a->title, &title, 1, err);
    if (status == LC_OK)
        status = lc_place_string(a->summary, sizeof a->summary, &summary, 0, err);
    if (status == LC_OK)
        status = read_reference(a, root, err);
    if (status == LC_OK)
        status = lc_place_number(&a->margin, &margin, 0.001, 0.1, 0, err);
    if (status == LC_OK)
        status = lc_place_number(&a->false_failure, &budget, 1e-12, 0.01, 0, err);
    if (status == LC_OK)
        status = lc_place_number(&a->cpu_seconds, &seconds, 1, 86400, 0, err);
    if (status == LC_OK)
        status = read_hints(a, &hints, err);
    if (status == LC_OK)
        status = read_times(a, root, err);
    if (status == LC_OK)
        status = read_names(a->solutions, &a->solution_count, &solutions, is_right, "estimators|variants", err);
    if (status == LC_OK)
        status = read_names(a->mutants, &a->mutant_count, &mutants, is_right, "estimators", err);
    if (status == LC_OK)
        status = read_names(a->beyond, &a->beyond_count, &beyond, is_mutant, "mutants", err);
    if (status == LC_OK)
        status = read_sentences(a, &sentences, err);
    if (status == LC_OK)
        status = lc_place_array(&count, &tests, LC_MOST_TESTS, 1, err);
    for (size_t i = 0; i < count && status == LC_OK; ++i) {
        lc_place test = lc_place_item(&tests, i);
        status = read_test(a, &test, err);
    }
    if (status == LC_OK && lc_assignment_points(a) <= 0)
        status = lc_place_fail(err, &tests, "no test is worth a point");
    return status;
}

double lc_assignment_points(const lc_assignment *assignment)
{
    double sum = 0;
    for (int i = 0; i < assignment->test_count; ++i)
        sum += assignment->tests[i].points;
    return sum;
}

/* ---- where they are ---------------------------------------------------------------------------------------------------- */

/* As the scenes: beside the program's folder, else here. */
static DIR *open_folder(char *path, size_t size)
{
    static const char *const places[] = {"../verify/assignments", "../assignments"};
    char exe[1024];
    ssize_t length = readlink("/proc/self/exe", exe, sizeof exe - 1);
    char *slash = length > 0 ? (exe[length] = 0, strrchr(exe, '/')) : NULL;
    for (int i = 0; slash && i < 2; ++i) {
        snprintf(path, size, "%.*s/%s", (int)(slash - exe), exe, places[i]);
        DIR *folder = opendir(path);
        if (folder)
            return folder;
    }
    snprintf(path, size, "verify/assignments");
    return opendir(path);
}

static int is_json(const char *name)
{
    size_t length = strlen(name);
    return length > 5 && strcmp(name + length - 5, ".json") == 0;
}

/* What an assignment names may lie beside it, such as its sentences. What is no JSON is told when it is read. */
static int is_assignment(const char *folder, const char *name)
{
    char path[1500];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    json_t *o = is_json(name) ? json_load_file(path, 0, NULL) : NULL;
    int has_tests = is_json(name) && (!o || json_object_get(o, "tests"));
    json_decref(o);
    return has_tests;
}

/* Calls `each` with every name, in the order of the alphabet. */
static lc_status list_names(void (*each)(void *user, const char *folder, const char *name), void *user, lc_error *err)
{
    char path[1200], names[64][64], last[64] = "";
    int count = 0;
    DIR *folder = open_folder(path, sizeof path);
    if (!folder)
        return lc_fail(err, LC_BAD_INPUT, "no folder verify/assignments/ here or beside the program: give a path to a .json file");
    for (struct dirent *entry = readdir(folder); entry && count < 64; entry = readdir(folder))
        if (is_assignment(path, entry->d_name) && strlen(entry->d_name) < sizeof names[0]) {
            memset(names[count], 0, sizeof names[0]);
            memcpy(names[count++], entry->d_name, strlen(entry->d_name) - 5);
        }
    closedir(folder);
    for (int i = 0; i < count; ++i) {
        const char *next = NULL;
        for (int j = 0; j < count; ++j)
            if (strcmp(names[j], last) > 0 && (!next || strcmp(names[j], next) < 0))
                next = names[j];
        if (next)
            memcpy(last, next, sizeof last);
        each(user, path, last);
    }
    return LC_OK;
}

typedef struct text_list {
    char text[800];
    size_t used;
} text_list;

static void add_name(void *user, const char *folder, const char *name)
{
    text_list *list = user;
    (void)folder;
    if (list->used + strlen(name) + 3 < sizeof list->text)
        list->used += (size_t)snprintf(list->text + list->used, sizeof list->text - list->used, "%s%s",
                                       list->used ? ", " : "", name);
}

static lc_status locate(char *path, size_t size, const char *name, lc_error *err)
{
    text_list list = {"", 0};
    char folder[1200];
    if (strchr(name, '/') || is_json(name)) {
        snprintf(path, size, "%s", name);
        return strlen(name) < size ? LC_OK : lc_fail(err, LC_BAD_INPUT, "the path of the assignment is too long");
    }
    DIR *there = open_folder(folder, sizeof folder);
    if (there) {
        closedir(there);
        int length = snprintf(path, size, "%s/%s.json", folder, name);
        if (length > 0 && (size_t)length < size && access(path, R_OK) == 0)
            return LC_OK;
    }
    lc_status status = list_names(add_name, &list, err);
    return status != LC_OK ? status
                           : lc_fail(err, LC_BAD_INPUT, "unknown assignment '%.60s'; expected a path to a .json file or one of: %s",
                                     name, list.text);
}

lc_status lc_assignment_read(lc_assignment *out, const char *name_or_path, lc_error *err)
{
    lc_json_file file;
    memset(out, 0, sizeof *out);
    snprintf(out->given, sizeof out->given, "%s", name_or_path);
    lc_status status = locate(out->path, sizeof out->path, name_or_path, err);
    if (status == LC_OK)
        status = lc_json_open(&file, out->path, err);
    if (status != LC_OK)
        return status;
    const char *stem = strrchr(out->path, '/') ? strrchr(out->path, '/') + 1 : out->path;
    size_t length = strlen(stem) - (is_json(stem) ? 5 : 0);
    if (length < sizeof out->name)
        memcpy(out->name, stem, length);
    else
        status = lc_fail(err, LC_BAD_INPUT, "%s: the name is longer than %zu characters", out->path, sizeof out->name - 1);
    lc_place root = lc_place_root(&file);
    if (status == LC_OK)
        status = read_root(out, &root, err);
    lc_json_close(&file);
    return status;
}

typedef struct list_user {
    void (*each)(void *user, const char *name, const char *title);
    void *user;
    lc_error *err;
    lc_status status;
} list_user;

static void list_one(void *user, const char *folder, const char *name)
{
    list_user *l = user;
    char path[1400];
    lc_assignment *a = malloc(sizeof *a);
    snprintf(path, sizeof path, "%s/%s.json", folder, name);
    if (l->status == LC_OK)
        l->status = a ? lc_assignment_read(a, path, l->err) : lc_fail(l->err, LC_FAULT, "out of memory for an assignment");
    if (l->status == LC_OK)
        l->each(l->user, a->name, a->title);
    free(a);
}

lc_status lc_assignment_list(void (*each)(void *user, const char *name, const char *title), void *user, lc_error *err)
{
    list_user l = {each, user, err, LC_OK};
    lc_status status = list_names(list_one, &l, err);
    return status == LC_OK ? l.status : status;
}
