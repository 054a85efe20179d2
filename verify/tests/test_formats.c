/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Results in each format are read back and held against its specification, written down here as tables: a key that it does not know, a
 * missing one, one of another type or with another word fails. */
#include "verify/tests/tests.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "verify/grade/formats.h"
#include "verify/grade/grading.h"
#include "verify/grade/metadata.h"
#include "verify/grade/public.h"
#include "verify/tests/xml_help.h"

/* ---- specifications ------------------------------------------------------------------------------------------------ */

typedef struct key {
    const char *name;
    char type;         /* n number, i integer, s string, b boolean, o object, a array of `items`, t array of texts, 0: null too (with n) */
    int needed;
    const char *words; /* |these|only| */
    const struct key *items;
} key;

#define SHOWN "|hidden|after_due_date|after_published|visible|"

static const key gradescope_test[] = {
    {"score", 'n', 0, NULL, NULL},          {"max_score", 'n', 0, NULL, NULL},
    {"status", 's', 0, "|passed|failed|", NULL}, {"name", 's', 0, NULL, NULL},
    {"number", 's', 0, NULL, NULL},         {"output", 's', 0, NULL, NULL},
    {"output_format", 's', 0, "|text|html|simple_format|md|ansi|", NULL}, {"tags", 't', 0, NULL, NULL},
    {"visibility", 's', 0, SHOWN, NULL},    {"extra_data", 'o', 0, NULL, NULL},
    {NULL, 0, 0, NULL, NULL}};
static const key gradescope[] = {
    {"score", 'n', 1, NULL, NULL},          {"execution_time", 'n', 0, NULL, NULL},
    {"output", 's', 0, NULL, NULL},         {"output_format", 's', 0, "|text|html|simple_format|md|ansi|", NULL},
    {"visibility", 's', 0, SHOWN, NULL},    {"stdout_visibility", 's', 0, SHOWN, NULL},
    {"extra_data", 'o', 0, NULL, NULL},     {"tests", 'a', 0, NULL, gradescope_test},
    {NULL, 0, 0, NULL, NULL}};

static const key prairielearn_test[] = {
    {"name", 's', 0, NULL, NULL},   {"description", 's', 0, NULL, NULL}, {"points", 'n', 0, NULL, NULL},
    {"max_points", 'n', 1, NULL, NULL}, {"message", 's', 0, NULL, NULL}, {"output", 's', 0, NULL, NULL},
    {NULL, 0, 0, NULL, NULL}};
static const key prairielearn[] = {
    {"gradable", 'b', 0, NULL, NULL}, {"score", 'n', 1, NULL, NULL}, {"message", 's', 0, NULL, NULL},
    {"output", 's', 0, NULL, NULL}, {"format_errors", 't', 0, NULL, NULL}, {"tests", 'a', 0, NULL, prairielearn_test},
    {NULL, 0, 0, NULL, NULL}};

static const key classroom_test[] = {
    {"name", 's', 1, NULL, NULL}, {"status", 's', 1, "|pass|fail|error|", NULL}, {"score", 'n', 0, NULL, NULL},
    {"message", 's', 0, NULL, NULL}, {NULL, 0, 0, NULL, NULL}};
static const key classroom[] = {
    {"version", 'i', 1, NULL, NULL}, {"status", 's', 1, "|pass|fail|error|", NULL}, {"max_score", 'n', 1, NULL, NULL},
    {"tests", 'a', 1, NULL, classroom_test}, {NULL, 0, 0, NULL, NULL}};

static const key own_test[] = {
    {"name", 's', 1, NULL, NULL}, {"title", 's', 1, NULL, NULL}, {"check", 's', 1, NULL, NULL},
    {"status", 's', 1, "|pending|passed|partial|failed|skipped|fault|", NULL},
    {"code", 's', 1, "|AC|WA|RTE|TLE|MLE|OLE|IR|IE|CE|", NULL}, {"visibility", 's', 1, SHOWN, NULL},
    {"points", '0', 1, NULL, NULL}, {"max_points", 'n', 1, NULL, NULL}, {"because", 's', 1, NULL, NULL},
    {"withheld", 's', 1, NULL, NULL}, {"scene", 's', 0, NULL, NULL}, {"seed", 's', 0, NULL, NULL},
    {"sentence_id", 's', 0, NULL, NULL}, {"sentence", 's', 0, NULL, NULL}, {"hint", 's', 1, NULL, NULL},
    {"shown", 's', 1, NULL, NULL},
    {"reproduce", 's', 0, NULL, NULL}, {"measured", 'o', 0, NULL, NULL}, {"seconds", '0', 0, NULL, NULL},
    {"cpu_seconds", '0', 0, NULL, NULL}, {"pictures", 't', 0, NULL, NULL}, {NULL, 0, 0, NULL, NULL}};
static const key own[] = {
    {"format", 's', 1, "|lightcheck-result|", NULL}, {"version", 'i', 1, NULL, NULL}, {"program", 's', 1, NULL, NULL},
    {"assignment", 's', 1, NULL, NULL}, {"title", 's', 1, NULL, NULL}, {"file", 's', 1, NULL, NULL},
    {"student", 's', 1, NULL, NULL}, {"estimator", 's', 1, NULL, NULL}, {"seed", 's', 1, NULL, NULL},
    {"attempt", 'i', 1, NULL, NULL}, {"jail", 's', 1, NULL, NULL}, {"complete", 'b', 1, NULL, NULL},
    {"ungradable", 'b', 1, NULL, NULL}, {"fault", 'b', 1, NULL, NULL},
    {"code", 's', 1, "|AC|WA|RTE|TLE|MLE|OLE|IR|IE|CE|", NULL}, {"message", 's', 1, NULL, NULL},
    {"warnings", 's', 1, NULL, NULL}, {"said", 's', 1, NULL, NULL}, {"points", '0', 1, NULL, NULL},
    {"max_points", 'n', 1, NULL, NULL}, {"late_days", 'n', 1, NULL, NULL}, {"late_penalty", 'n', 1, NULL, NULL},
    {"score", '0', 1, NULL, NULL}, {"seconds", '0', 1, NULL, NULL}, {"cpu_seconds", '0', 1, NULL, NULL},
    {"tests", 'a', 1, NULL, own_test}, {NULL, 0, 0, NULL, NULL}};

static int has_type(const json_t *value, char type)
{
    switch (type) {
    case 'n':
        return json_is_number(value);
    case '0':
        return json_is_number(value) || json_is_null(value);
    case 'i':
        return json_is_integer(value);
    case 's':
        return json_is_string(value);
    case 'b':
        return json_is_boolean(value);
    case 'o':
        return json_is_object(value);
    default:
        return json_is_array(value);
    }
}

static void conforms(json_t *o, const key *keys)
{
    const char *name;
    json_t *value;
    ck_assert(json_is_object(o));
    for (const key *k = keys; k->name; ++k)
        ck_assert_msg(!k->needed || json_object_get(o, k->name), "no key '%s'", k->name);
    json_object_foreach(o, name, value) {
        const key *k = keys;
        char word[64];
        while (k->name && strcmp(k->name, name) != 0)
            ++k;
        ck_assert_msg(k->name && has_type(value, k->type), "'%s' is unknown there, or of another type", name);
        snprintf(word, sizeof word, "|%s|", k->words ? json_string_value(value) : "");
        ck_assert_msg(!k->words || strstr(k->words, word), "'%s' cannot be %s", name, word);
        for (size_t i = 0; json_is_array(value) && i < json_array_size(value); ++i)
            if (k->items)
                conforms(json_array_get(value, i), k->items);
            else
                ck_assert(json_is_string(json_array_get(value, i)));
    }
}

/* ---- results -------------------------------------------------------------------------------------------------------- */

static lc_test_result *add_test(lc_grade_result *r, const char *name, lc_test_status status, double points)
{
    lc_test_result *t = &r->tests[r->test_count++];
    snprintf(t->name, sizeof t->name, "%s", name);
    snprintf(t->title, sizeof t->title, "Title of %s, <b> & \"c\"", name);
    strcpy(t->sentence, "Measured 1.2, expected 1 \xff\x01");
    strcpy(t->reproduce, "lightcheck grade x.c");
    strcpy(t->hint, "look at the cosine");
    strcpy(t->scene, "plane_disk");
    t->status = status;
    t->code = status == LC_TEST_PASSED ? LC_JAIL_AC : LC_JAIL_WA;
    t->points = points;
    t->most_points = 10;
    t->seconds = 0.5;
    t->measured = (lc_measured){.expected = NAN, .measured = 1.2, .low = -INFINITY, .high = INFINITY, .margin_shown = NAN, .bad_x = -1};
    r->done += status != LC_TEST_PENDING;
    return t;
}

/* One test of each kind, one of them hidden; numbers and texts that JSON does not know. */
static void fill(lc_grade_result *r)
{
    memset(r, 0, sizeof *r);
    strcpy(r->assignment, "light_direct");
    strcpy(r->file, "o'neil \xc3\xbc.c");
    strcpy(r->jail, "limits, seccomp");
    strcpy(r->warnings, "x.c:1: warning: \xfe");
    r->seed = UINT64_MAX;
    r->attempt = 2;
    r->code = LC_JAIL_WA;
    add_test(r, "compiles", LC_TEST_PASSED, 10);
    add_test(r, "mean", LC_TEST_PARTIAL, 4);
    add_test(r, "furnace", LC_TEST_FAILED, 0);
    add_test(r, "variance", LC_TEST_SKIPPED, 0);
    add_test(r, "fault", LC_TEST_FAULT, 0);
    add_test(r, "later", LC_TEST_PENDING, 0);
    lc_test_result *t = add_test(r, "hidden", LC_TEST_FAILED, 0);
    t->visibility = LC_AFTER_DUE;
    strcpy(t->withheld, "Shown after the due date.");
    strcpy(t->sentence, "SECRET");
    strcpy(t->reproduce, "SECRET");
    strcpy(t->shown, "Shown wrong.");
    strcpy(t->scene, "SECRET");
    r->points = 14;
    r->most_points = 70;
    r->late_days = 1;
    r->late_penalty = 7;
    r->score = 7;
    r->seconds = NAN;
}

static void fill_ungradable(lc_grade_result *r)
{
    memset(r, 0, sizeof *r);
    strcpy(r->assignment, "light_direct");
    strcpy(r->message, "x.c:1: error: <'\xff'>");
    r->is_ungradable = 1;
    r->code = LC_JAIL_CE;
    r->most_points = 70;
}

static char text[1 << 16];

static const char *write_result(lc_grade_result *r, const char *format, int teacher)
{
    lc_error err;
    lc_grade_labels(r, NULL);
    FILE *file = tmpfile();
    ck_assert_msg(lc_format_find(format)->write(file, r, teacher, &err) == LC_OK, "%s", err.text);
    ck_assert(!ferror(file));
    rewind(file);
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
    return text;
}

static json_t *read_json(const char *from)
{
    json_error_t why;
    json_t *o = json_loads(from, JSON_REJECT_DUPLICATES, &why);
    ck_assert_msg(o != NULL, "%s: %s", why.text, from);
    return o;
}

static json_t *at(json_t *o, size_t i) { return json_array_get(json_object_get(o, "tests"), i); }
static double number(json_t *o, const char *name) { return json_number_value(json_object_get(o, name)); }
static const char *word(json_t *o, const char *name) { return json_string_value(json_object_get(o, name)); }

/* ---- tests ------------------------------------------------------------------------------------------------------------ */

START_TEST(test_formats_own)
{
    static const char *const shown[] = {"scene", "sentence", "reproduce", "measured", "pictures"};
    lc_grade_result r;
    fill(&r);
    json_t *o = read_json(write_result(&r, "json", 0));
    conforms(o, own);
    ck_assert_int_eq((int)number(o, "version"), LC_RESULT_VERSION);
    ck_assert_str_eq(word(o, "seed"), "18446744073709551615");
    ck_assert(json_is_null(json_object_get(o, "seconds")));
    ck_assert(json_is_false(json_object_get(o, "complete")));
    ck_assert_str_eq(word(o, "file"), r.file);
    json_t *measured = json_object_get(at(o, 1), "measured"), *interval = json_object_get(measured, "interval");
    ck_assert(json_is_null(json_object_get(measured, "expected")) && json_is_null(json_object_get(measured, "margin_shown")));
    ck_assert(json_array_size(interval) == 2 && json_is_null(json_array_get(interval, 0)) && json_is_null(json_array_get(interval, 1)));
    for (int i = 0; i < 5; ++i) {
        ck_assert_msg(json_object_get(at(o, 1), shown[i]) != NULL, "%s", shown[i]);
        ck_assert_msg(json_object_get(at(o, 6), shown[i]) == NULL, "%s", shown[i]);
    }
    ck_assert_ptr_null(strstr(text, "SECRET"));
    json_decref(o);
    o = read_json(write_result(&r, "json", 1));
    conforms(o, own);
    ck_assert_str_eq(word(at(o, 6), "scene"), "SECRET");
    json_decref(o);
    fill_ungradable(&r);
    o = read_json(write_result(&r, "json", 0));
    conforms(o, own);
    ck_assert(json_is_null(json_object_get(o, "score")));
    json_decref(o);
}
END_TEST

/* Gradescope is told what to hide, and hides it itself. */
START_TEST(test_formats_gradescope)
{
    lc_grade_result r;
    fill(&r);
    json_t *o = read_json(write_result(&r, "gradescope", 0));
    conforms(o, gradescope);
    ck_assert(number(o, "score") == 7);
    ck_assert_ptr_nonnull(strstr(word(o, "output"), "14, less 7: days late: 1"));
    ck_assert_str_eq(word(at(o, 0), "status"), "passed");
    ck_assert_str_eq(word(at(o, 1), "status"), "failed");
    ck_assert(number(at(o, 1), "score") == 4 && number(at(o, 1), "max_score") == 10);
    ck_assert_str_eq(word(at(o, 6), "visibility"), "after_due_date");
    ck_assert_ptr_nonnull(strstr(word(at(o, 6), "output"), "SECRET"));
    ck_assert_str_eq(word(at(o, 5), "output"), "not judged yet");
    json_decref(o);
    fill_ungradable(&r);
    o = read_json(write_result(&r, "gradescope", 0));
    conforms(o, gradescope);
    ck_assert(number(o, "score") == 0);
    ck_assert_ptr_nonnull(strstr(word(o, "output"), "ungradable, which costs no attempt: x.c:1: error: <'\\xff'>"));
    json_decref(o);
}
END_TEST

START_TEST(test_formats_prairielearn)
{
    lc_grade_result r;
    fill(&r);
    json_t *o = read_json(write_result(&r, "prairielearn", 0));
    conforms(o, prairielearn);
    ck_assert_double_eq_tol(number(o, "score"), 0.1, 1e-12);
    ck_assert(json_is_true(json_object_get(o, "gradable")));
    ck_assert_ptr_null(strstr(text, "SECRET"));
    ck_assert_ptr_nonnull(strstr(word(at(o, 6), "output"), "Shown wrong."));
    ck_assert_ptr_nonnull(strstr(word(at(o, 6), "output"), "Shown after the due date."));
    json_decref(o);
    fill_ungradable(&r);
    o = read_json(write_result(&r, "prairielearn", 0));
    conforms(o, prairielearn);
    ck_assert(json_is_false(json_object_get(o, "gradable")));
    ck_assert_uint_eq(json_array_size(json_object_get(o, "format_errors")), 1);
    json_decref(o);
}
END_TEST

/* The other way round: what base64(1) does. */
static void decode(char *out, const char *in)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    ck_assert_uint_eq(strspn(in, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/=") % 4, 0);
    for (unsigned bits = 0, count = 0; *in && *in != '=' && *in != '\n'; ++in) {
        bits = bits << 6 | (unsigned)(strchr(digits, *in) - digits);
        count += 6;
        if (count >= 8)
            *out++ = (char)(bits >> (count -= 8) & 255);
    }
    *out = 0;
}

START_TEST(test_formats_classroom)
{
    static char plain[1 << 16];
    lc_grade_result r;
    for (int n = 0; n < 3; ++n) { /* each padding */
        fill(&r);
        r.tests[0].title[strlen(r.tests[0].title) - (size_t)n] = 0;
        write_result(&r, "classroom", 0);
        ck_assert_ptr_eq(strchr(text, '\n'), text + strlen(text) - 1);
        decode(plain, text);
        json_t *o = read_json(plain);
        conforms(o, classroom);
        ck_assert_str_eq(word(o, "status"), "fail");
        ck_assert_str_eq(word(at(o, 4), "status"), "error");
        ck_assert_ptr_null(strstr(plain, "SECRET"));
        json_decref(o);
    }
    r.test_count = r.done = 1;
    decode(plain, write_result(&r, "classroom", 0));
    json_t *o = read_json(plain);
    ck_assert_str_eq(word(o, "status"), "pass");
    json_decref(o);
    fill_ungradable(&r);
    decode(plain, write_result(&r, "classroom", 0));
    o = read_json(plain);
    conforms(o, classroom);
    ck_assert_str_eq(word(o, "status"), "error");
    json_decref(o);
}
END_TEST

START_TEST(test_formats_junit)
{
    lc_grade_result r;
    fill(&r);
    write_result(&r, "junit", 0);
    ck_assert_int_eq(count_tags(text, "testsuites"), 1);
    ck_assert_int_eq(count_tags(text, "testsuite"), 1);
    ck_assert_int_eq(count_tags(text, "testcase"), 7);
    ck_assert_int_eq(count_tags(text, "failure"), 3);
    ck_assert_int_eq(count_tags(text, "error"), 1);
    ck_assert_int_eq(count_tags(text, "skipped"), 2);
    ck_assert_ptr_nonnull(strstr(text, "tests=\"7\" failures=\"3\" errors=\"1\" skipped=\"2\""));
    ck_assert_ptr_null(strstr(text, "SECRET"));
    ck_assert_ptr_null(strstr(text, "nan"));
    fill_ungradable(&r);
    write_result(&r, "junit", 0);
    ck_assert_int_eq(count_tags(text, "error"), 1);
    ck_assert_ptr_nonnull(strstr(text, "tests=\"1\" failures=\"0\" errors=\"1\" skipped=\"0\""));
    ck_assert_ptr_nonnull(strstr(text, "error: &lt;'?'&gt;"));
}
END_TEST

/* A file is the old one or the new one: what cannot be written leaves it as it is. */
static lc_status fail_write(FILE *out, const lc_grade_result *r, int teacher, lc_error *err)
{
    (void)r;
    (void)teacher;
    fputs("half", out);
    return lc_fail(err, LC_FAULT, "no");
}

START_TEST(test_formats_save)
{
    const lc_format broken = {"broken", fail_write};
    char folder[] = "/tmp/lightcheck-formats-XXXXXX", path[64];
    lc_grade_result r;
    lc_error err;
    fill(&r);
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/r.json", folder);
    ck_assert_int_eq(lc_result_save(path, lc_format_find("json"), &r, 0, &err), LC_OK);
    ck_assert_int_eq(lc_result_save(path, &broken, &r, 0, &err), LC_FAULT);
    json_t *o = json_load_file(path, 0, NULL);
    conforms(o, own);
    json_decref(o);
    unlink(path);
    ck_assert_int_eq(rmdir(folder), 0); /* nothing else is there */
    ck_assert_ptr_null(lc_format_find("xml"));
}
END_TEST

/* ---- what Gradescope says of a hand-in, and what students are given ----------------------------------------------------- */

static char path[64];

static void write_file(const char *content)
{
    strcpy(path, "/tmp/lightcheck-formats-XXXXXX");
    int fd = mkstemp(path);
    ck_assert_int_ge(fd, 0);
    ck_assert_int_eq(write(fd, content, strlen(content)), (ssize_t)strlen(content));
    close(fd);
}

START_TEST(test_formats_metadata)
{
    int64_t when = 0;
    int attempt = 0;
    char id[32];
    lc_error err;
    write_file("{\"id\": 1, \"created_at\": \"2018-07-01T14:22:32.365935-07:00\", \"previous_submissions\": ["
               "{\"score\": 0.0}, {\"results\": {\"extra_data\": {\"code\": \"CE\"}}}, {\"autograder_error\": true},"
               "{\"results\": {\"extra_data\": {\"code\": \"WA\"}}}, {\"results\": null}]}");
    ck_assert_msg(lc_metadata_read(&when, &attempt, id, path, &err) == LC_OK, "%s", err.text);
    ck_assert_int_eq(when, 1530480152);
    ck_assert_int_eq(attempt, 4); /* two were not graded */
    ck_assert_str_eq(id, "1");
    unlink(path);
    write_file("{\"created_at\": \"2018-07-01T14:22:32Z\"}");
    ck_assert_int_eq(lc_metadata_read(&when, &attempt, id, path, &err), LC_OK);
    ck_assert_int_eq(when, 1530454952);
    ck_assert_int_eq(attempt, 1);
    ck_assert_str_eq(id, "");
    unlink(path);
    write_file("{\"created_at\": \"yesterday\"}");
    ck_assert_int_eq(lc_metadata_read(&when, &attempt, id, path, &err), LC_BAD_INPUT);
    unlink(path);
    ck_assert_int_eq(lc_metadata_read(&when, &attempt, id, path, &err), LC_BAD_INPUT);
}
END_TEST

START_TEST(test_formats_public)
{
    lc_error err;
    write_file("{\"title\": \"T\", \"solutions\": [\"path\"], \"mutants_of\": [\"path\"], \"tests\": ["
               "{\"name\": \"a\"}, {\"name\": \"b\", \"visibility\": \"hidden\", \"scenes\": [\"SECRET\"]},"
               "{\"name\": \"c\", \"visibility\": \"visible\", \"requires\": [\"a\", \"b\", \"d\"]},"
               "{\"name\": \"d\", \"visibility\": \"after_due_date\"}]}");
    FILE *out = tmpfile();
    ck_assert_msg(lc_assignment_write_public(out, path, &err) == LC_OK, "%s", err.text);
    rewind(out);
    text[fread(text, 1, sizeof text - 1, out)] = 0;
    fclose(out);
    unlink(path);
    json_t *o = read_json(text), *expected = read_json("{\"title\": \"T\", \"tests\": [{\"name\": \"a\"},"
                                                       "{\"name\": \"c\", \"visibility\": \"visible\", \"requires\": [\"a\"]}]}");
    ck_assert_msg(json_equal(o, expected), "%s", text);
    json_decref(o);
    json_decref(expected);
    write_file("{\"tests\": 3}");
    ck_assert_int_eq(lc_assignment_write_public(stdout, path, &err), LC_BAD_INPUT);
    unlink(path);
    write_file("{\n\"tests\": [}");
    ck_assert_int_eq(lc_assignment_write_public(stdout, path, &err), LC_BAD_INPUT);
    ck_assert_ptr_nonnull(strstr(err.text, ":2: "));
    unlink(path);
}
END_TEST

Suite *lc_suite_formats(void)
{
    Suite *suite = suite_create("formats");
    TCase *tests = tcase_create("formats");
    tcase_add_test(tests, test_formats_own);
    tcase_add_test(tests, test_formats_gradescope);
    tcase_add_test(tests, test_formats_prairielearn);
    tcase_add_test(tests, test_formats_classroom);
    tcase_add_test(tests, test_formats_junit);
    tcase_add_test(tests, test_formats_save);
    tcase_add_test(tests, test_formats_metadata);
    tcase_add_test(tests, test_formats_public);
    suite_add_tcase(suite, tests);
    return suite;
}
