/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Assignments: what is read of them, and where each mistake is said to be. */
#include "verify/tests/tests.h"

#include <math.h>

#include "verify/grade/assignment_files.h"
#include "verify/grade/place.h"
#include "verify/grade/sentences.h"
#include "verify/tests/grade_help.h"

#define OPENING "{\"title\": \"T\",\n\"reference\": \"path\",\n\"bounces\": 5,\n"
#define ONE "{\"name\": \"one\", \"title\": \"One\", \"kind\": \"descriptor\", \"points\": 2}"
#define TESTS(text) OPENING "\"tests\": [\n" text "]}"

/* ---- mistakes ---------------------------------------------------------------------------------------------------------- */

static const struct {
    const char *text, *line, *says;
} mistakes[] = {
    {"[1]", ":1: ", "expected an object"},
    {"{\"title\": \"T\",\n oops}", ":2: ", "string or '}' expected"},
    {"{\"title\": \"T\", \"title\": \"U\"}", ":1: ", "duplicate object key"},
    {"{\"reference\": \"path\"}", ":1: ", "title: is missing"},
    {"{\"title\": 7}", ":1: ", "expected a text"},
    {"{\"title\": \"\"}", ":1: ", "is empty"},
    {"{\"title\": \"T\",\n\n\"colour\": 1}", ":3: colour: ", "unknown key; supported: title, summary, reference"},
    {"{\"title\": \"T\",\n\"reference\": \"paht\"}", ":2: reference: ", "unknown estimator 'paht'"},
    {"{\"title\": \"T\",\n\"reference\": \"path\"}", ":1: bounces: ", "is missing"},
    {"{\"title\": \"T\", \"reference\": \"light_direct\",\n\"bounces\": 2}", ":2: bounces: ", "a whole number from 0 to 1"},
    {"{\"title\": \"T\", \"reference\": \"path\", \"bounces\": 2,\n\"emitters\": [\"area\",\n \"point\"]}", ":2: emitters: ", "path has less"},
    {"{\"title\": \"T\", \"reference\": \"path\", \"bounces\": 2,\n\"lobes\": [\"diffuse\",\n \"shiny\"]}", ":3: number 2: ",
     "unknown 'shiny'; supported: diffuse, mirror, glass, glossy"},
    {OPENING "\"margin\": 1, \"tests\": []}", ":4: margin: ", "from 0.001 to 0.1"},
    {OPENING "\"hints\": {\"show\": \"all\"}}", ":4: show: ", "supported: none, category, name"},
    {OPENING "\"hints\": {\n\"show\": \"name\",\n\"after\": 3}}", ":6: after: ", "supported: show, after_attempts"},
    {OPENING "\"due\": \"2026-12-01\"}", ":4: due: ", "a moment with its zone"},
    {OPENING "\"due\": \"2026-12-01T10:00:00\"}", ":4: due: ", "a moment with its zone"},
    {OPENING "\"due\": \"2026-13-01T10:00:00Z\"}", ":4: due: ", "a moment with its zone"},
    {OPENING "\"due\": \"2026-02-31T10:00:00Z\"}", ":4: due: ", "no such day"},
    {OPENING "\"due\": \"2026-04-31T10:00:00Z\"}", ":4: due: ", "no such day"},
    {OPENING "\"due\": \"2100-02-29T10:00:00Z\"}", ":4: due: ", "no such day"}, /* no leap year */
    {OPENING "\"published\": \"2027-02-29T10:00:00Z\"}", ":4: published: ", "no such day"},
    {OPENING "\"late\": {\"per_day\": 0.1}}", ":4: late: ", "without `due` nothing is late"},
    {OPENING "\"solutions\": [\"path\",\n\"path_no_pi\"]}", ":5: number 2: ", "lightcheck list estimators|variants"},
    {OPENING "\"beyond\": [\"path\"]}", ":4: number 1: ", "lightcheck list mutants"},
    {OPENING "\"tests\": []}", ":4: tests: ", "has 0 elements, expected 1 to 12"},
    {OPENING "\"tests\": 3}", ":4: tests: ", "expected a list"},
    {TESTS("7"), ":5: number 1: ", "expected an object"},
    {TESTS("{\"title\": \"}{][\\\"\", \n \"name\": \"a b\"}"), ":6: name: ", "expected letters, digits and _"},
    {TESTS(ONE ",\n" ONE), ":6: name: ", "there is a test 'one' already"},
    {TESTS("{\"name\": \"a\", \"title\": \"A\", \"kind\": \"equal\"}"), ":5: kind: ", "supported: descriptor, finite, check, mean, variance"},
    {TESTS("{\"name\": \"a\", \"title\": \"A\", \"kind\": \"mean\", \"points\": -1}"), ":5: points: ", "from 0 to 1000"},
    {TESTS("{\"name\": \"a\", \"title\": \"A\", \"kind\": \"mean\", \"points\": 1}"), ":5: scenes: ", "is missing"},
    {TESTS("{\"name\": \"a\", \"title\": \"A\", \"kind\": \"mean\", \"points\": 1, \"scenes\": [\"cornel\"]}"), ":5: number 1: ",
     "unknown scene 'cornel'"},
    {TESTS("{\"name\": \"a\", \"title\": \"A\", \"kind\": \"descriptor\", \"points\": 1, \"scenes\": [\"cornell\"]}"), ":5: scenes: ",
     "renders nothing"},
    {TESTS("{\"name\": \"a\", \"title\": \"A\", \"kind\": \"check\", \"points\": 1, \"scenes\": [\"cornell\"]}"), ":5: check: ", "is missing"},
    {TESTS("{\"name\": \"a\", \"title\": \"A\", \"kind\": \"check\", \"points\": 1, \"scenes\": [\"cornell\"],\n\"check\": \"luck\"}"),
     ":6: check: ", "unknown check 'luck'; supported: "},
    {TESTS("{\"name\": \"a\", \"title\": \"A\", \"kind\": \"mean\", \"points\": 1, \"scenes\": [\"cornell\"],\n\"at_most\": 2}"),
     ":6: at_most: ", "is for tests of kind variance"},
    {TESTS("{\"name\": \"a\", \"title\": \"A\", \"kind\": \"variance\", \"points\": 1, \"scenes\": [\"cornell\"]}"), ":5: number 1: ",
     "needs at_least, at_most, or both"},
    {TESTS("{\"name\": \"a\", \"title\": \"A\", \"kind\": \"mean\", \"points\": 1, \"scenes\": [\"cornell\"],\n\"bounces\": [3, 2]}"),
     ":6: number 2: ", "a whole number from 3 to 64"},
    {TESTS(ONE ",\n{\"name\": \"a\", \"title\": \"A\", \"kind\": \"descriptor\", \"points\": 1,\n\"requires\": [\"one\",\n\"two\"]}"),
     ":8: number 2: ", "there is no test 'two' before this one"},
    {TESTS("{\"name\": \"a\", \"title\": \"A\", \"kind\": \"descriptor\", \"points\": 0}"), ":4: tests: ", "no test is worth a point"},
};

START_TEST(test_assignment_mistakes)
{
    lc_error err = {""};
    ck_assert_int_eq(read_text_as_assignment(&a, mistakes[_i].text, &err), LC_BAD_INPUT);
    ck_assert_msg(strstr(err.text, mistakes[_i].says) != NULL, "%s\nexpected: %s", err.text, mistakes[_i].says);
    ck_assert_msg(strstr(err.text, mistakes[_i].line) != NULL, "%s\nexpected: %s", err.text, mistakes[_i].line);
}
END_TEST

/* What shows only when all is planned: a check that has nothing to say, a scene that is none. */
#define ASKS(extra) \
    "{\"title\": \"T\", \"reference\": \"light_direct\", \"bounces\": 1, \"tests\": [\n" ONE ",\n" \
    "{\"name\": \"x\", \"title\": \"X\", \"points\": 1, \"kind\": \"check\",\n" extra "}]}"

static const struct {
    const char *text, *says;
} plans[] = {
    {ASKS("\"check\": \"furnace\", \"scenes\":\n[\"plane_rectangle\"]"), ":5: test x: the check furnace says nothing about light_direct over plane_rectangle"},
    {ASKS("\"check\": \"analytic\", \"scenes\": [\"plane_rectangle\",\n\"mirror_corridor\"]"),
     ":5: test x: the check analytic says nothing about light_direct over mirror_corridor"},
    {ASKS("\"check\": \"metamorphic\", \"relation\": \"luck\", \"scenes\": [\"five_lights\"]"), ":4: test x: the check metamorphic says nothing about light_direct over five_lights with this relation"},
};

START_TEST(test_assignment_plan)
{
    lc_error err = {""};
    lc_grade_options o = options();
    ck_assert_msg(read_text_as_assignment(&a, plans[_i].text, &err) == LC_OK, "%s", err.text);
    ck_assert_int_eq(lc_grade_plan(&a, &o, &err), LC_BAD_INPUT);
    ck_assert_msg(strstr(err.text, plans[_i].says) != NULL, "%s\nexpected: %s", err.text, plans[_i].says);
}
END_TEST

START_TEST(test_assignment_only)
{
    lc_error err = {""};
    lc_grade_options o = options();
    assign(HEAD "\"tests\": [" FIRST LAMP "]}");
    ck_assert_msg(lc_grade_plan(&a, &o, &err) == LC_OK, "%s", err.text);
    o.only = "lamp";
    ck_assert_msg(lc_grade_plan(&a, &o, &err) == LC_OK, "%s", err.text);
    o.only = "lampe";
    ck_assert_int_eq(lc_grade_plan(&a, &o, &err), LC_BAD_INPUT);
    ck_assert_msg(strstr(err.text, "there is no test 'lampe'; it has: compiles, finite, lamp, more"), "%s", err.text);
}
END_TEST

/* ---- files that it names ------------------------------------------------------------------------------------------------ */

static char folder[64];

static void write_file(const char *name, const char *text)
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    ck_assert_ptr_nonnull(file);
    fputs(text, file);
    ck_assert_int_eq(fclose(file), 0);
}

static void set_up(void)
{
    char command[512];
    strcpy(folder, "/tmp/lightcheck-course-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(command, sizeof command, "mkdir %s/own && cp scenes/plane_rectangle.xml %s/own/mine.xml && cp scenes/plane_disk.xml %s/own/other.xml",
             folder, folder, folder);
    ck_assert_int_eq(system(command), 0);
}

static void tear_down(void)
{
    char command[128];
    snprintf(command, sizeof command, "rm -rf %s", folder);
    ck_assert_int_eq(system(command), 0);
}

static lc_status read_course(const char *text, lc_error *err)
{
    char path[128];
    write_file("course.json", text);
    snprintf(path, sizeof path, "%s/course.json", folder);
    return lc_assignment_read(&a, path, err);
}

#define OWN(sentences, scene, other) \
    "{\"title\": \"T\", \"reference\": \"light_direct\", \"bounces\": 1,\n\"sentences\": \"" sentences "\", \"tests\": [\n" ONE ",\n" \
    "{\"name\": \"x\", \"title\": \"X\", \"points\": 1, \"kind\": \"mean\", \"scenes\": [\"" scene "\", \"cornell\", \"" scene "\"]},\n" \
    "{\"name\": \"y\", \"title\": \"Y\", \"points\": 1, \"kind\": \"mean\", \"visibility\": \"hidden\",\n" \
    "\"scenes\": [\"" other "\", \"random_rectangle\", \"" scene "\"]}]}"

static void list_file(void *user, const char *name, const char *path)
{
    char *list = user;
    ck_assert_msg(access(path, R_OK) == 0, "%s", path);
    strcat(strcat(list, name), " ");
}

/* Beside the assignment, whatever the working directory is; and where there is none, as before. */
START_TEST(test_assignment_files)
{
    char list[256] = "", path[LC_PATH_SIZE], expected[128];
    lc_error err = {""};
    lc_grade_options o = options();
    write_file("de.json", "{\"skipped\": \"wegen {because}\"}");
    ck_assert_msg(read_course(OWN("de.json", "own/mine.xml", "own/other.xml"), &err) == LC_OK, "%s", err.text);
    ck_assert_msg(lc_grade_plan(&a, &o, &err) == LC_OK, "%s", err.text);
    lc_assignment_files(&a, 0, list_file, list);
    ck_assert_str_eq(list, "de.json own/mine.xml own/other.xml ");
    list[0] = 0;
    lc_assignment_files(&a, 1, list_file, list);
    ck_assert_str_eq(list, "de.json own/mine.xml ");
    snprintf(expected, sizeof expected, "%s/own/mine.xml", folder);
    ck_assert_str_eq(lc_assignment_scene(path, &a, "own/mine.xml"), expected);
    ck_assert_str_eq(lc_assignment_scene(path, &a, "scenes/cornell.xml"), "scenes/cornell.xml"); /* not beside it, but here */
    ck_assert_str_eq(lc_assignment_scene(path, &a, expected), expected);
    ck_assert_str_eq(lc_assignment_scene(path, &a, "cornell"), "cornell");
}
END_TEST

START_TEST(test_assignment_files_missing)
{
    lc_error err = {""};
    lc_grade_options o = options();
    ck_assert_int_eq(read_course(OWN("nix.json", "own/mine.xml", "own/other.xml"), &err), LC_BAD_INPUT);
    ck_assert_msg(strstr(err.text, "course.json:2: sentences: cannot read 'nix.json'"), "%s", err.text);
    write_file("de.json", "{\n\"skiped\": \"x\"}");
    ck_assert_int_eq(read_course(OWN("de.json", "own/mine.xml", "own/other.xml"), &err), LC_BAD_INPUT);
    ck_assert_msg(strstr(err.text, "de.json:2: skiped: there is no sentence of this name"), "%s", err.text);
    write_file("de.json", "{}");
    ck_assert_int_eq(read_course(OWN("de.json", "own/mine.xml", "own/none.xml"), &err), LC_BAD_INPUT);
    ck_assert_msg(strstr(err.text, "course.json:6: number 1: cannot read 'own/none.xml'"), "%s", err.text);
    write_file("own/other.xml", "<scene>\n<bulb/></scene>");
    ck_assert_msg(read_course(OWN("de.json", "own/mine.xml", "own/other.xml"), &err) == LC_OK, "%s", err.text);
    ck_assert_int_eq(lc_grade_plan(&a, &o, &err), LC_BAD_INPUT);
    ck_assert_msg(strstr(err.text, "course.json:6: test y: ") && strstr(err.text, "other.xml:"), "%s", err.text);
}
END_TEST

START_TEST(test_assignment_no_such)
{
    lc_error err = {""};
    ck_assert_int_eq(lc_assignment_read(&a, "no/such.json", &err), LC_BAD_INPUT);
    ck_assert_msg(strstr(err.text, "no/such.json: No such file") != NULL, "%s", err.text);
    ck_assert_int_eq(lc_assignment_read(&a, "lihgt_direct", &err), LC_BAD_INPUT);
    ck_assert_msg(strstr(err.text, "unknown assignment 'lihgt_direct'") && strstr(err.text, "of: ") && strstr(strstr(err.text, "of: "), "light_direct"), "%s", err.text);
}
END_TEST

/* ---- what is read -------------------------------------------------------------------------------------------------------- */

START_TEST(test_assignment_values)
{
    lc_error err = {""};
    lc_status status = read_text_as_assignment(
        &a,
        OPENING "\"due\": \"2026-03-01T12:00:00+02:00\", \"published\": \"1972-03-01T00:00:00Z\", \"late\": {\"per_day\": 0.1, \"most\": 0.5},\n"
             "\"hints\": {\"show\": \"name\", \"after_attempts\": 3}, \"cpu_seconds\": 20, \"emitters\": [\"sky\"],\n"
             "\"solutions\": [\"path\", \"path_by_cosine\"], \"mutants_of\": [\"path\"], \"tests\": [" ONE ",\n"
             "{\"name\": \"two\", \"title\": \"Two\", \"kind\": \"variance\", \"points\": 1.5, \"requires\": [\"one\"], \"visibility\": \"hidden\",\n"
             "\"scenes\": [\"random_furnace\", \"cornell\"], \"bounces\": [1, 3], \"at_most\": 2, \"hint\": \"H\"}]}",
        &err);
    ck_assert_msg(status == LC_OK, "%s", err.text);
    ck_assert_int_eq((int64_t)a.due, 1772359200); /* date -u -d 2026-03-01T10:00 +%s */
    ck_assert_int_eq((int64_t)a.published, 68256000);
    ck_assert_int_eq(a.hints, LC_HINT_NAME);
    ck_assert_int_eq(a.hint_after_attempts, 3);
    ck_assert_int_eq((int)a.emitters, LC_SKY);
    ck_assert_int_eq((int)a.lobes, LC_DIFFUSE);
    ck_assert_int_eq(a.solution_count, 2);
    ck_assert_int_eq(a.test_count, 2);
    ck_assert_double_eq(lc_assignment_points(&a), 3.5);
    const lc_test *t = &a.tests[1];
    ck_assert_int_eq(t->kind, LC_KIND_VARIANCE);
    ck_assert_int_eq(t->visibility, LC_HIDDEN);
    ck_assert_int_eq(t->required_count, 1);
    ck_assert_int_eq(t->required[0], 0);
    ck_assert_int_eq(t->scene_count, 2);
    ck_assert_int_eq(t->min_bounces, 1);
    ck_assert_int_eq(t->max_bounces, 3);
    ck_assert_double_eq(t->most, 2);
    ck_assert_double_eq(t->least, 0);
    ck_assert_int_eq(a.tests[0].max_bounces, -1);
    ck_assert(isinf(a.tests[0].most));
}
END_TEST

START_TEST(test_assignment_leap_days)
{
    static const struct {
        const char *text;
        int64_t seconds; /* date -u -d TEXT +%s */
    } days[] = {{"2024-02-29T00:00:00Z", 1709164800}, {"2000-02-29T00:00:00Z", 951782400}, {"2026-01-31T00:00:00Z", 1769817600}};
    for (size_t i = 0; i < sizeof days / sizeof days[0]; ++i) {
        int64_t seconds = 0;
        ck_assert_ptr_null(lc_read_moment(&seconds, days[i].text));
        ck_assert_int_eq(seconds, days[i].seconds);
    }
}
END_TEST

/* ---- those that are shipped ------------------------------------------------------------------------------------------------ */

static void check_shipped(void *user, const char *name, const char *title)
{
    lc_error err = {""};
    int hidden = 0, drawn = 0;
    ++*(int *)user;
    ck_assert_msg(lc_assignment_read(&a, name, &err) == LC_OK, "%s", err.text);
    ck_assert_str_eq(a.name, name);
    ck_assert_str_eq(a.title, title);
    ck_assert_msg(a.solution_count >= 3, "%s: %d right solutions", name, a.solution_count);
    ck_assert_str_eq(a.solutions[0], a.reference);
    ck_assert_msg(a.mutant_count >= 1, "%s: nothing that must not pass", name);
    ck_assert_double_eq(a.margin, 0.01);
    ck_assert_int_eq(a.tests[0].kind, LC_KIND_DESCRIPTOR);
    ck_assert_int_eq(a.tests[1].kind, LC_KIND_FINITE);
    for (int i = 0; i < a.test_count; ++i) {
        hidden += a.tests[i].visibility != LC_VISIBLE;
        for (int s = 0; s < a.tests[i].scene_count; ++s)
            drawn += i > 1 && strncmp(a.tests[i].scenes[s], "random_", 7) == 0;
        ck_assert_msg(i == 0 || a.tests[i].required_count > 0, "%s: %s requires nothing", name, a.tests[i].name);
    }
    ck_assert_msg(hidden > 0 && drawn > 0, "%s: %d hidden tests, %d drawn scenes", name, hidden, drawn);
}

START_TEST(test_assignment_shipped)
{
    int count = 0;
    lc_error err = {""};
    ck_assert_msg(lc_assignment_list(check_shipped, &count, &err) == LC_OK, "%s", err.text);
    ck_assert_int_ge(count, 1);
}
END_TEST

/* ---- sentences --------------------------------------------------------------------------------------------------------------- */

static lc_status open_table(lc_sentences **out, const char *text, lc_error *err)
{
    char path[] = "/tmp/lightcheck-test-XXXXXX";
    int fd = mkstemp(path);
    ck_assert_int_eq(write(fd, text, strlen(text)), (ssize_t)strlen(text));
    close(fd);
    lc_status status = lc_sentences_open(out, path, err);
    unlink(path);
    return status;
}

START_TEST(test_sentences_translated)
{
    lc_sentences *s;
    lc_words words = {.count = 0};
    char text[64];
    lc_error err = {""};
    lc_words_set(&words, "because", "%s", "first");
    lc_words_set(&words, "because", "%s", "second"); /* anew */
    ck_assert_msg(open_table(&s, "{\"skipped\": \"wegen {because} {ausgelassen\"}", &err) == LC_BAD_INPUT, "%s", err.text);
    ck_assert_msg(strstr(err.text, ":1: skipped: a { without its }"), "%s", err.text);
    ck_assert_int_eq(open_table(&s, "{\"skipped\": \"wegen {warum} ausgelassen\"}", &err), LC_BAD_INPUT);
    ck_assert_msg(strstr(err.text, "unknown word {warum}"), "%s", err.text);
    ck_assert_int_eq(open_table(&s, "{\n\"ueber\": \"x\"}", &err), LC_BAD_INPUT);
    ck_assert_msg(strstr(err.text, ":2: ueber: there is no sentence"), "%s", err.text);
    ck_assert_int_eq(open_table(&s, "{\"skipped\": \"wegen {because} ausgelassen\"}", &err), LC_OK);
    ck_assert_str_eq(lc_say(text, sizeof text, s, "skipped", &words), "wegen second ausgelassen");
    ck_assert_str_eq(lc_say(text, sizeof text, s, "hidden_failed", &words), "wrong"); /* the program's */
    ck_assert_str_eq(lc_say(text, 8, s, "skipped", &words), "wegen s");               /* cut, and ended */
    ck_assert_str_eq(lc_say(text, sizeof text, s, "hint_name", &words), "{hint}");      /* not set */
    lc_sentences_close(s);
}
END_TEST

Suite *lc_suite_assignment(void)
{
    Suite *suite = suite_create("assignment");
    TCase *reader = tcase_create("reader");
    tcase_add_loop_test(reader, test_assignment_mistakes, 0, sizeof mistakes / sizeof mistakes[0]);
    tcase_add_loop_test(reader, test_assignment_plan, 0, sizeof plans / sizeof plans[0]);
    tcase_add_test(reader, test_assignment_only);
    tcase_add_test(reader, test_assignment_no_such);
    tcase_add_test(reader, test_assignment_values);
    tcase_add_test(reader, test_assignment_leap_days);
    tcase_add_test(reader, test_assignment_shipped);
    tcase_add_test(reader, test_sentences_translated);
    suite_add_tcase(suite, reader);
    TCase *files = tcase_create("files");
    tcase_add_checked_fixture(files, set_up, tear_down);
    tcase_add_test(files, test_assignment_files);
    tcase_add_test(files, test_assignment_files_missing);
    suite_add_tcase(suite, files);
    return suite;
}
