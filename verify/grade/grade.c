/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * One grading: open the file, judge test after test, add up.
 */
#include "verify/grade/grade.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "verify/grade/assignment_files.h"
#include "verify/grade/grading.h"
#include "verify/grade/plugin.h"

void lc_grade_options_init(lc_grade_options *options)
{
    memset(options, 0, sizeof *options);
    options->seed = 1;
    options->attempt = 1;
    options->program = "lightcheck";
}

/* ---- the kinds that need no judge -------------------------------------------------------------------------------------- */

static const char *say_bounces(char out[64], const lc_grading *g, int count)
{
    lc_words words = {.count = 0};
    lc_words_set(&words, "count", "%d", count);
    return lc_say(out, 64, g->sentences, count == 1 ? "word_bounce" : "word_bounces", &words);
}

static void list_missing(lc_words *words, const lc_grading *g)
{
    static const char *const lobes[] = {"diffuse", "mirror", "glass", "glossy"};
    static const char *const emitters[] = {"area", "point", "directional", "sky"};
    const lc_assignment *a = g->assignment;
    char text[160] = "", bounces[64];
    size_t used = 0;
    for (int i = 0; i < 4; ++i)
        if (a->lobes & ~g->estimator->lobes & 1U << i)
            used += (size_t)snprintf(text + used, sizeof text - used, "%s%s", used ? ", " : "", lobes[i]);
    for (int i = 0; i < 4; ++i)
        if (a->emitters & ~g->estimator->emitters & 1U << i)
            used += (size_t)snprintf(text + used, sizeof text - used, "%s%s", used ? ", " : "", emitters[i]);
    if (g->estimator->max_bounces < a->bounces)
        snprintf(text + used, sizeof text - used, "%s%s", used ? ", " : "", say_bounces(bounces, g, a->bounces));
    lc_words_set(words, "missing", "%s", text);
}

static lc_status grade_descriptor(lc_grading *g, lc_test_result *out)
{
    char bounces[64];
    lc_words words = {.count = 0};
    list_missing(&words, g);
    int is_less = words.items[0].text[0] != 0;
    lc_words_set(&words, "language", "%s, %s", g->reference->name, say_bounces(bounces, g, g->assignment->bounces));
    lc_test_settle(out, is_less ? 0 : 1);
    lc_test_say(out, g, is_less ? "claims_less" : "compiled", &words);
    return LC_OK;
}

lc_status lc_grade_finite(lc_grading *g, const lc_job *job, lc_test_result *out, lc_error *err)
{
    lc_words words = {.count = 0};
    char scenes[192] = "";
    for (int i = 0; i < job->scene_count; ++i) {
        const lc_scene_desc *desc = lc_scene_description(job->scenes[i]);
        lc_film *film;
        lc_render_options o = {.min_bounces = job->test->min_bounces < 0 ? 0 : job->test->min_bounces,
                               .max_bounces = job->test->max_bounces < 0 ? g->assignment->bounces : job->test->max_bounces,
                               .seed = job->seed,
                               .arm = lc_session_arm(g->estimator),
                               .count = LC_BLOCK,
                               .threads = g->options->threads};
        lc_status status = lc_film_create(&film, desc->width, desc->height, err);
        if (status == LC_OK)
            status = lc_render(film, job->scenes[i], g->estimator, &o, err);
        if (status == LC_OK && film->bad)
            lc_test_bad(out, g, desc->name, film, NULL);
        int is_bad = status == LC_OK && film->bad;
        out->measured.paths += o.count * (uint64_t)desc->width * (uint64_t)desc->height;
        if (status == LC_OK || status == LC_WRONG)
            lc_film_free(film);
        snprintf(out->scene, sizeof out->scene, "%s", desc->name);
        if (is_bad || (status == LC_WRONG && lc_test_ended(out, g, desc->name)))
            return LC_OK;
        if (status != LC_OK)
            return status;
        snprintf(scenes + strlen(scenes), sizeof scenes - strlen(scenes), "%s%s", i ? ", " : "", desc->name);
    }
    lc_words_set(&words, "scene", "%s", scenes);
    lc_words_set(&words, "paths", "%llu", (unsigned long long)out->measured.paths);
    lc_test_settle(out, 1);
    lc_test_say(out, g, "finite", &words);
    return LC_OK;
}

/* The deepest bounce that the test sums: its claims say, or where it has none, it does. */
static int bounces_of(const lc_grading *g, const lc_job *job)
{
    int most = 0;
    for (int i = 0; i < job->claims.count; ++i)
        if (job->claims.items[i].max_bounces > most)
            most = job->claims.items[i].max_bounces;
    if (job->claims.count > 0)
        return most;
    return job->test->max_bounces < 0 ? g->assignment->bounces : job->test->max_bounces;
}

/* Nothing can be rendered beyond what the file claims: that is its answer, also where no test before this one was required. 1 when
 * the test is settled by that. */
static int claims_less(const lc_grading *g, const lc_job *job, lc_test_result *out)
{
    int needed = bounces_of(g, job);
    char bounces[64];
    lc_words words = {.count = 0};
    if (g->estimator->max_bounces >= needed)
        return 0;
    lc_words_set(&words, "missing", "%s", say_bounces(bounces, g, needed));
    lc_test_settle(out, 0);
    lc_test_say(out, g, "claims_less", &words);
    return 1;
}

/* ---- one test ----------------------------------------------------------------------------------------------------------- */

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* A hang shows in the first test that runs the file: that one may take a twentieth only. */
static double cpu_for(const lc_grading *g, const lc_test *test)
{
    return test->kind == LC_KIND_FINITE ? fmin(g->cpu_left, g->assignment->cpu_seconds / 20) : g->cpu_left;
}

static lc_status judge_test(lc_grading *g, int i, lc_error *err)
{
    lc_job *job = &g->jobs[i];
    lc_test_result *out = &g->result->tests[g->options->only ? 0 : i];
    double start = now(), cpu = cpu_for(g, job->test);
    if (g->jail) {
        lc_jail_set_cpu(g->jail, cpu);
        lc_jail_forget_said(g->jail); /* a test that runs nothing shows nothing of the one before, which may be hidden */
    }
    lc_error why = {""};
    lc_status status = g->options->adapter                    ? lc_grade_images(g, job, out, &why)
                       : job->test->kind == LC_KIND_DESCRIPTOR ? grade_descriptor(g, out)
                       : claims_less(g, job, out)              ? LC_OK
                       : job->test->kind == LC_KIND_FINITE   ? lc_grade_finite(g, job, out, &why)
                       : lc_is_of_method(job->test->kind) ? lc_grade_method(g, job, out, &why)
                                                             : lc_grade_claims(g, job, out, &why);
    out->seconds = now() - start;
    if (g->jail) {
        out->cpu_seconds = cpu - lc_jail_cpu_left(g->jail);
        g->cpu_left -= out->cpu_seconds;
        if (lc_jail_said(g->jail)[0] && lc_test_is_open(out)) /* a file could print what it saw of a hidden scene */
            snprintf(g->result->said, sizeof g->result->said, "%s", lc_jail_said(g->jail));
        snprintf(g->result->jail, sizeof g->result->jail, "%s", lc_jail_level(g->jail));
    }
    if (status == LC_FAULT && g->jail && lc_jail_last(g->jail)->code == LC_JAIL_IE) { /* the result says so */
        lc_test_end(out, g, job->test->name, LC_JAIL_IE, why.text);
        return LC_OK;
    }
    return status == LC_OK ? LC_OK : lc_fail(err, status, "%s: %s", job->test->name, why.text);
}

/* The prerequisite that did not pass, or NULL. */
static const char *obstacle(const lc_grading *g, const lc_test *test)
{
    for (int i = 0; i < test->required_count; ++i) {
        const lc_test_result *r = &g->result->tests[test->required[i]];
        if (r->status != LC_TEST_PASSED && r->status != LC_TEST_PARTIAL)
            return r->name;
    }
    return NULL;
}

static void skip_test(lc_grading *g, int i, const char *because)
{
    lc_test_result *out = &g->result->tests[i];
    lc_words words = {.count = 0};
    lc_words_set(&words, "because", "%s", because);
    out->status = LC_TEST_SKIPPED;
    out->code = LC_JAIL_WA;
    memmove(out->because, because, strlen(because) + 1); /* the name of another test: as long at most */
    lc_test_say(out, g, "skipped", &words);
    out->reproduce[0] = 0;
}

/* ---- before the first test ------------------------------------------------------------------------------------------------- */

static void withhold(lc_test_result *out, const lc_grading *g, time_t when, time_t is_now)
{
    lc_words words = {.count = 0};
    char date[48] = "";
    struct tm parts;
    int is_dated = out->visibility == LC_AFTER_DUE || out->visibility == LC_AFTER_PUBLISHED;
    if (out->visibility == LC_VISIBLE || g->options->is_teacher || (is_dated && when && is_now > when))
        return;
    if (is_dated && when && gmtime_r(&when, &parts))
        strftime(date, sizeof date, "%Y-%m-%d %H:%M UTC", &parts);
    lc_words_set(&words, "until", "%s", date);
    lc_say(out->withheld, sizeof out->withheld, g->sentences, date[0] ? "withheld" : is_dated ? "withheld_undated" : "withheld_ever",
           &words);
}

static void start_test(lc_grading *g, lc_test_result *out, const lc_test *test, time_t is_now)
{
    const lc_assignment *a = g->assignment;
    snprintf(out->name, sizeof out->name, "%s", test->name);
    snprintf(out->title, sizeof out->title, "%s", test->title);
    out->most_points = test->points;
    out->visibility = test->visibility;
    out->measured.bad_x = out->measured.bad_y = -1;
    out->measured.measured = out->measured.low = out->measured.high = out->measured.expected = NAN;
    out->measured.margin = out->measured.margin_shown = NAN;
    if (test->kind == LC_KIND_CHECK)
        snprintf(out->check, sizeof out->check, "%s", test->check);
    else
        lc_test_kind_name(out->check, sizeof out->check, test->kind);
    withhold(out, g, test->visibility == LC_AFTER_DUE ? a->due : a->published, is_now);
    char file[LC_SHELL_WORD(1024)], which[LC_SHELL_WORD(256)];
    snprintf(out->reproduce, sizeof out->reproduce, "%s grade %s%s -a %s --seed %llu --only %s", g->options->program,
             lc_grading_file(file, g), g->options->adapter ? g->options->adapter->is_folder ? " --images" : " --adapters" : "",
             lc_shell_word(which, g->options->is_secret ? a->name : a->given),
             (unsigned long long)lc_grading_seed(g->options, test->visibility), test->name);
}

static void set_late(lc_grading *g)
{
    const lc_assignment *a = g->assignment;
    lc_grade_result *r = g->result;
    if (!a->due || g->options->submitted <= a->due)
        return;
    r->late_days = ceil(difftime(g->options->submitted, a->due) / 86400);
    r->late_penalty = fmin(a->late_most, a->late_per_day * r->late_days) * lc_assignment_points(a);
}

void lc_grade_labels(lc_grade_result *r, const lc_sentences *sentences)
{
    static const char *const ids[LC_LABELS] = {"label_hint",    "label_pictures", "label_again", "label_ungradable",
                                               "label_printed", "label_fault",    "label_score", "label_late",
                                               "label_pending", "label_incomplete", "label_compiler", "label_seed"};
    lc_words words = {.count = 0};
    lc_words_set(&words, "score", "%.4g", r->score);
    lc_words_set(&words, "points", "%.4g", r->most_points);
    lc_words_set(&words, "earned", "%.4g", r->points);
    lc_words_set(&words, "penalty", "%.4g", r->late_penalty);
    lc_words_set(&words, "days", "%.0f", r->late_days);
    lc_words_set(&words, "seed", "%llu", (unsigned long long)r->seed);
    lc_words_set(&words, "jail", "%s", r->jail);
    for (int i = 0; i < LC_LABELS; ++i)
        lc_say(r->labels[i], sizeof r->labels[i], sentences, ids[i], &words);
}

/* Whose, of what, by which seed. */
static void start(lc_grade_result *r, const lc_assignment *a, const char *file, const lc_grade_options *o)
{
    memset(r, 0, sizeof *r);
    snprintf(r->assignment, sizeof r->assignment, "%s", a->name);
    snprintf(r->title, sizeof r->title, "%s", a->title);
    snprintf(r->file, sizeof r->file, "%s", file);
    snprintf(r->student, sizeof r->student, "%s", o->student ? o->student : "");
    snprintf(r->jail, sizeof r->jail, "none");
    r->seed = lc_grading_seed(o, LC_VISIBLE);
    r->attempt = o->attempt > 0 ? o->attempt : 1;
}

static lc_status open_sentences(lc_sentences **out, const lc_assignment *a, lc_error *err)
{
    char path[LC_PATH_SIZE];
    if (a->sentences[0])
        lc_assignment_find(path, a, a->sentences);
    return lc_sentences_open(out, a->sentences[0] ? path : NULL, err);
}

void lc_grade_refused(lc_grade_result *out, const lc_assignment *assignment, const char *file,
                      const lc_grade_options *options, int is_fault, const char *why)
{
    start(out, assignment, file, options);
    snprintf(out->message, sizeof out->message, "%s", why);
    out->is_fault = is_fault;
    out->is_ungradable = !is_fault;
    out->code = is_fault ? LC_JAIL_IE : LC_JAIL_CE;
    out->most_points = lc_assignment_points(assignment);
    lc_sentences *sentences = NULL;
    lc_error none; /* without the course's words it is said in the program's */
    if (open_sentences(&sentences, assignment, &none) != LC_OK)
        sentences = NULL;
    lc_grade_labels(out, sentences);
    lc_sentences_close(sentences);
}

static lc_status fail_no_test(const lc_assignment *a, const char *name, lc_error *err)
{
    char list[LC_MOST_TESTS * sizeof a->tests[0].name] = "";
    for (int i = 0; i < a->test_count; ++i)
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", i ? ", " : "", a->tests[i].name);
    return lc_fail(err, LC_BAD_INPUT, "%s: there is no test '%.60s'; it has: %s", a->path, name, list);
}

static lc_status start_result(lc_grading *g, lc_error *err)
{
    const lc_assignment *a = g->assignment;
    const lc_grade_options *o = g->options;
    lc_grade_result *r = g->result;
    time_t is_now = o->now ? o->now : time(NULL);
    start(r, a, g->path, o);
    for (int i = 0; i < a->test_count; ++i) {
        if (o->only && strcmp(o->only, a->tests[i].name) != 0)
            continue;
        g->jobs[i].test = &a->tests[i];
        start_test(g, &r->tests[r->test_count], &a->tests[i], is_now);
        r->tests[r->test_count].seed = lc_test_seed(lc_grading_seed(o, a->tests[i].visibility), a->tests[i].name);
        r->most_points += a->tests[i].points;
        ++r->test_count;
    }
    if (r->test_count == 0)
        return fail_no_test(a, o->only, err);
    set_late(g);
    lc_grade_labels(g->result, g->sentences);
    return LC_OK;
}

/* ---- the file --------------------------------------------------------------------------------------------------------------- */

/* Whatever the file does before it is asked anything is its own fault, or ours. */
static void refuse(lc_grading *g, const lc_jail_verdict *why)
{
    lc_grade_result *r = g->result;
    r->code = why->code;
    r->is_ungradable = why->code == LC_JAIL_CE;
    r->is_fault = why->code == LC_JAIL_IE;
    snprintf(r->message, sizeof r->message, "%s", why->text);
    for (int i = 0; i < r->test_count && why->code != LC_JAIL_CE; ++i)
        lc_test_end(&r->tests[i], g, r->tests[i].name, why->code, why->text);
    r->done = r->test_count;
}

static lc_status open_in_jail(lc_grading *g, lc_jail_verdict *why, lc_error *err)
{
    lc_jail_options options;
    lc_jail_options_init(&options);
    options.cpu_seconds = g->cpu_left;
    options.wall_seconds = 60 + 10 * g->cpu_left; /* a machine as busy as that is at fault */
    lc_status status = lc_jail_open(&g->jail, g->path, &options, why, err);
    if (status != LC_OK)
        return status;
    g->estimator = lc_jail_estimator(g->jail);
    snprintf(g->result->warnings, sizeof g->result->warnings, "%s", lc_jail_messages(g->jail));
    return LC_OK;
}

static lc_status open_in_process(lc_grading *g, lc_jail_verdict *why, lc_error *err)
{
    const lc_estimator *e = g->options->estimator;
    lc_status status = e ? LC_OK : lc_plugin_load(&e, g->path, g->result->warnings, sizeof g->result->warnings, err);
    if (status == LC_OK) {
        g->copy = *e;
        g->estimator = &g->copy;
    }
    why->code = status == LC_OK ? LC_JAIL_AC : status == LC_BAD_INPUT ? LC_JAIL_CE : LC_JAIL_IE;
    return status;
}

/* *refused: there is a result already. */
static lc_status open_file(lc_grading *g, int *refused, lc_error *err)
{
    lc_jail_verdict why = {LC_JAIL_AC, "", 0};
    lc_error text = {""};
    *refused = 0;
    if (g->options->adapter) {
        g->estimator = &g->options->adapter->estimator;
        snprintf(g->result->estimator, sizeof g->result->estimator, "%s", g->estimator->name);
        return LC_OK;
    }
    if (!g->options->estimator && access(g->path, R_OK) != 0)
        return lc_fail(err, LC_BAD_INPUT, "%s: %s", g->path, strerror(errno));
    lc_status status = g->options->estimator || g->options->is_open ? open_in_process(g, &why, &text)
                                                                    : open_in_jail(g, &why, &text);
    if (status == LC_OK) {
        snprintf(g->result->estimator, sizeof g->result->estimator, "%s", g->estimator->name);
        return LC_OK;
    }
    snprintf(why.text, sizeof why.text, "%.511s", text.text);
    refuse(g, &why);
    *refused = 1;
    return LC_OK;
}

/* ---- after the last test ------------------------------------------------------------------------------------------------------ */

static void add_up(lc_grade_result *r)
{
    r->points = 0;
    r->code = r->is_ungradable ? LC_JAIL_CE : r->is_fault ? LC_JAIL_IE : LC_JAIL_AC;
    r->cpu_seconds = 0;
    for (int i = 0; i < r->test_count; ++i) {
        const lc_test_result *t = &r->tests[i];
        r->points += t->points;
        r->cpu_seconds += t->cpu_seconds;
        r->is_fault |= t->status == LC_TEST_FAULT;
        if (r->code == LC_JAIL_AC && t->code != LC_JAIL_AC && t->status != LC_TEST_PENDING)
            r->code = t->code;
    }
    if (r->is_fault)
        r->code = LC_JAIL_IE;
    r->score = r->is_fault || r->is_ungradable ? 0 : fmax(0, r->points - r->late_penalty);
}

/* The hints that a teacher wrote, and what a known bug has to do with, where the assignment allows it by now. */
static lc_status give_hints(lc_grading *g, lc_error *err)
{
    const lc_assignment *a = g->assignment;
    lc_grade_result *r = g->result;
    lc_test_result *first = NULL;
    if ((r->attempt < a->hint_after_attempts && !g->options->is_final) || r->is_fault || r->is_ungradable)
        return LC_OK;
    for (int i = 0; i < r->test_count; ++i) {
        lc_test_result *t = &r->tests[i];
        if (t->status != LC_TEST_FAILED && t->status != LC_TEST_PARTIAL)
            continue;
        int at = 0;
        while (strcmp(a->tests[at].name, t->name) != 0)
            ++at;
        snprintf(t->hint, sizeof t->hint, "%s", a->tests[at].hint);
        if (!first && t->code == LC_JAIL_WA && t->measured.bad_x < 0)
            first = t;
    }
    return first && a->hints != LC_HINT_NONE ? lc_grade_hint(g, first, err) : LC_OK;
}

static lc_status tell(const lc_grading *g, lc_error *err)
{
    return g->options->on_test ? g->options->on_test(g->options->user, g->result, err) : LC_OK;
}

static lc_status judge_all(lc_grading *g, lc_error *err)
{
    lc_grade_result *r = g->result;
    lc_status status = lc_grading_plan(g, err);
    for (int i = 0; i < g->assignment->test_count && status == LC_OK && !r->is_fault; ++i) {
        const lc_test *test = &g->assignment->tests[i];
        int is_left_out = g->options->adapter && lc_images_cannot_tell(g, &g->jobs[i]);
        const char *because = g->options->only || is_left_out ? NULL : obstacle(g, test);
        if (g->options->only && strcmp(g->options->only, test->name) != 0)
            continue;
        if (because)
            skip_test(g, i, because);
        else
            status = judge_test(g, i, err);
        ++r->done;
        add_up(r);
        lc_grade_labels(g->result, g->sentences);
        if (status == LC_OK)
            status = tell(g, err);
    }
    return status == LC_OK && !g->options->adapter ? give_hints(g, err) : status;
}

/* Whether anything is claimed does not depend on what the file is: the reference stands for it. */
lc_status lc_grade_plan(const lc_assignment *assignment, const lc_grade_options *options, lc_error *err)
{
    int has_test = !options->only;
    for (int i = 0; i < assignment->test_count; ++i)
        has_test |= options->only && strcmp(options->only, assignment->tests[i].name) == 0;
    if (!has_test)
        return fail_no_test(assignment, options->only, err);
    lc_grading *g = calloc(1, sizeof *g);
    if (!g)
        return lc_fail(err, LC_FAULT, "out of memory for a grading");
    g->assignment = assignment;
    g->options = options;
    g->reference = g->estimator = lc_right_estimator(assignment->reference);
    lc_status status = lc_grading_plan(g, err);
    lc_grading_release(g);
    free(g);
    return status;
}

lc_status lc_grade_file(lc_grade_result *out, const lc_assignment *assignment, const char *path,
                        const lc_grade_options *options, lc_error *err)
{
    lc_grading *g = calloc(1, sizeof *g);
    double start = now();
    int refused = 0;
    if (!g)
        return lc_fail(err, LC_FAULT, "out of memory for a grading");
    g->assignment = assignment;
    g->options = options;
    g->path = path;
    g->result = out;
    g->cpu_left = assignment->cpu_seconds;
    g->reference = lc_right_estimator(assignment->reference);
    lc_status status = open_sentences(&g->sentences, assignment, err);
    if (status == LC_OK)
        status = start_result(g, err);
    if (status == LC_OK)
        status = tell(g, err);
    if (status == LC_OK)
        status = open_file(g, &refused, err);
    if (status == LC_OK && !refused)
        status = judge_all(g, err);
    if (status == LC_OK) {
        add_up(out);
        out->seconds = now() - start;
        lc_grade_labels(g->result, g->sentences);
        status = tell(g, err);
    }
    lc_grading_release(g);
    free(g);
    return status;
}
