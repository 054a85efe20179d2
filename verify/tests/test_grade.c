/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Grading one file: points, prerequisites, what is withheld, faults of either side, and that cheating earns nothing. */
#include "verify/tests/tests.h"

#include <dirent.h>
#include <math.h>
#include <sys/stat.h>

#include "verify/grade/grading.h"
#include "verify/tests/grade_help.h"
#include "verify/tests/load_help.h"

static lc_grade_result r, again;

/* Writes FILE.c of that text into a folder of its own; the caller removes both. */
static void write_source(char path[64], const char *text)
{
    strcpy(path, "/tmp/lightcheck-test-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(path));
    strcat(path, "/mine.c");
    FILE *f = fopen(path, "w");
    ck_assert_ptr_nonnull(f);
    fputs(text, f);
    ck_assert_int_eq(fclose(f), 0);
}

static void remove_source(char path[64])
{
    unlink(path);
    *strrchr(path, '/') = 0;
    ck_assert_int_eq(rmdir(path), 0);
}

/* ---- points -------------------------------------------------------------------------------------------------------------- */

static const struct {
    lc_row_verdict verdict;
    double low, high;
    int tile_width;
    double tile_ratio;
    int exact, dependent;
    double share;
} rows[] = {
    {LC_ROW_PASS, 0.995, 1.005, 0, 0, 0, 0, 1},
    {LC_ROW_PASS, 0, 0, 0, 0, 1, 0, 1},
    {LC_ROW_UNDECIDED, 0.985, 1.002, 0, 0, 0, 0, 0.7},
    {LC_ROW_UNDECIDED, 0.985, 1.021, 0, 0, 0, 0, 0.4},
    {LC_ROW_UNDECIDED, 0.901, 1.09, 0, 0, 0, 0, 0.4},
    {LC_ROW_UNDECIDED, 0.89, 1.0, 0, 0, 0, 0, 0},
    {LC_ROW_UNDECIDED, 0.99, INFINITY, 0, 0, 0, 0, 0},
    {LC_ROW_FAIL, 1.02, 1.04, 0, 0, 0, 0, 0.3},
    {LC_ROW_FAIL, 1.02, 1.04, 4, 1.03, 0, 0, 0.3},
    {LC_ROW_FAIL, 1.02, 1.04, 4, 1.3, 0, 0, 0},  /* a shadow that is missing */
    {LC_ROW_FAIL, 1.02, 1.06, 0, 0, 0, 0, 0},
    {LC_ROW_FAIL, 0.999, 1.001, 0, 0, 1, 0, 0},  /* exact: there is no near */
    {LC_ROW_FAIL, 0.999, 1.001, 0, 0, 0, 1, 0},  /* an interval that means nothing */
};

START_TEST(test_grade_points)
{
    lc_row row = {.verdict = rows[_i].verdict, .low = rows[_i].low, .high = rows[_i].high, .margin = 0.01, .samples = 64,
                  .tile_width = rows[_i].tile_width, .tile_ratio = rows[_i].tile_ratio, .exact = rows[_i].exact,
                  .dependent = rows[_i].dependent};
    double shown;
    ck_assert_double_eq(lc_grade_share(&shown, &row), rows[_i].share);
    ck_assert_int_eq(isnan(shown), !(rows[_i].share > 0));
    ck_assert(isnan(shown) || rows[_i].exact || (shown >= row.low - 1 && shown >= 1 - row.high));
}
END_TEST

START_TEST(test_grade_right_file)
{
    assign(HEAD "\"tests\": [" FIRST LAMP "]}");
    lc_grade_options o = options();
    grade(&r, "estimators/three_point.c", &o);
    ck_assert_double_eq(r.score, 7);
    ck_assert_int_eq(r.code, LC_JAIL_AC);
    ck_assert_int_eq(lc_grade_status(&r), LC_OK);
    ck_assert_str_eq(r.estimator, "three_point");
    ck_assert_msg(strncmp(r.jail, "limits, seccomp", 15) == 0, "%s", r.jail);
    ck_assert_str_eq(r.tests[2].sentence_id, "right");
    ck_assert_msg(r.tests[2].measured.low < 1 && r.tests[2].measured.high > 1, "%s", r.tests[2].sentence);
    ck_assert_int_eq(r.tests[2].hint[0], 0);
}
END_TEST

START_TEST(test_grade_wrong_estimator)
{
    assign(HEAD "\"tests\": [" FIRST LAMP "]}");
    lc_grade_options o = options();
    o.estimator = mutant("three_point_no_pi");
    grade(&r, "mine.c", &o);
    ck_assert_double_eq(r.score, 2);
    ck_assert_int_eq(lc_grade_status(&r), LC_WRONG);
    ck_assert_int_eq(r.tests[2].status, LC_TEST_FAILED);
    ck_assert_int_eq(r.tests[2].code, LC_JAIL_WA);
    ck_assert_msg(fabs(r.tests[2].measured.measured - LC_PI) < 0.1, "%s", r.tests[2].sentence);
    ck_assert_str_eq(r.tests[2].hint, "think");
    ck_assert_int_eq(r.tests[3].status, LC_TEST_SKIPPED); /* behind a prerequisite that failed */
    ck_assert_str_eq(r.tests[3].because, "lamp");
    ck_assert_str_eq(r.tests[3].shown, "left out, because `lamp` did not pass");
    ck_assert_msg(strstr(r.tests[2].reproduce, "lightcheck grade mine.c -a /tmp/") && strstr(r.tests[2].reproduce, "--seed 1 --only lamp"),
                  "%s", r.tests[2].reproduce);
    o.only = "lamp"; /* the line that reproduces it does */
    grade(&again, "mine.c", &o);
    ck_assert_int_eq(again.test_count, 1);
    ck_assert_str_eq(again.tests[0].sentence, r.tests[2].sentence);
}
END_TEST

START_TEST(test_grade_known_bug)
{
    assign(HEAD "\"hints\": {\"show\": \"category\", \"after_attempts\": 2}, \"tests\": [" FIRST LAMP "]}");
    lc_grade_options o = options();
    o.estimator = mutant("three_point_no_pi");
    grade(&r, "mine.c", &o);
    ck_assert_int_eq(r.tests[2].hint[0], 0); /* not at the first attempt */
    o.attempt = 2;
    grade(&r, "mine.c", &o);
    ck_assert_str_eq(r.tests[2].hint, "think; what is wrong has to do with the BRDF");
    a.hints = LC_HINT_NONE;
    grade(&r, "mine.c", &o);
    ck_assert_str_eq(r.tests[2].hint, "think");
}
END_TEST

START_TEST(test_grade_by_seed)
{
    assign(HEAD "\"tests\": [" FIRST LAMP "]}");
    lc_grade_options o = options();
    o.seed = 12345;
    o.threads = 1;
    grade(&r, "estimators/three_point.c", &o);
    o.threads = 2;
    grade(&again, "estimators/three_point.c", &o);
    ck_assert_str_eq(r.tests[2].sentence, again.tests[2].sentence);
    ck_assert_mem_eq(&r.tests[2].measured.measured, &again.tests[2].measured.measured, sizeof(double));
    o.seed = 12346;
    grade(&again, "estimators/three_point.c", &o);
    ck_assert_msg(r.tests[2].measured.expected != again.tests[2].measured.expected, "the same scene was drawn");
    ck_assert_double_eq(again.score, r.score);
}
END_TEST

/* ---- a method ------------------------------------------------------------------------------------------------------------------ */

START_TEST(test_grade_method)
{
    lc_grade_options o = options();
    assign(HEAD METHOD "\"at_least\": 0.8, \"at_most\": 1.25}]}");
    o.estimator = lc_right_estimator("three_point");
    grade(&r, "right", &o);
    ck_assert_msg(r.score > 0 && strcmp(r.tests[0].sentence_id, "variance_right") == 0, "%s", r.tests[0].sentence);
    o.estimator = lc_right_estimator("light_two_samples"); /* half of it */
    grade(&r, "low", &o);
    ck_assert_msg(!(r.score > 0) && strcmp(r.tests[0].sentence_id, "variance_low") == 0, "%s", r.tests[0].sentence);
    ck_assert_msg(fabs(r.tests[0].measured.measured - 0.5) < 0.05, "%s", r.tests[0].sentence);
    o.estimator = lc_right_estimator("hemisphere_direct");
    grade(&r, "high", &o);
    ck_assert_msg(!(r.score > 0) && strcmp(r.tests[0].sentence_id, "variance_high") == 0, "%s", r.tests[0].sentence);
}
END_TEST

/* Two points on the lamp in place of one: twice the rays and numbers, and no more work for the same noise. */
static const struct {
    const char *kind, *bounds, *sentence;
    double measured;
} costs[] = {
    {"rays", "\"at_most\": 1.5", "rays_high", 2},       {"rays", "\"at_least\": 0.5, \"at_most\": 4", "rays_right", 2},
    {"numbers", "\"at_most\": 1.5", "numbers_high", 2}, {"numbers", "\"at_most\": 2.5", "numbers_right", 2},
    {"work", "\"at_least\": 0.8, \"at_most\": 1.25", "work_right", 1},
};

START_TEST(test_grade_costs)
{
    char text[1024];
    snprintf(text, sizeof text,
             HEAD "\"tests\": [{\"name\": \"costs\", \"title\": \"T\", \"kind\": \"%s\", \"points\": 1, \"scenes\": [\"plane_rectangle\"], %s}]}",
             costs[_i].kind, costs[_i].bounds);
    assign(text);
    lc_grade_options o = options();
    o.estimator = lc_right_estimator("light_two_samples");
    grade(&r, "two", &o);
    const lc_test_result *t = &r.tests[0];
    ck_assert_msg(strcmp(t->sentence_id, costs[_i].sentence) == 0, "%s: %s", t->sentence_id, t->sentence);
    ck_assert_str_eq(t->check, costs[_i].kind);
    ck_assert_msg(fabs(t->measured.measured - costs[_i].measured) < 0.05, "%s", t->sentence);
    ck_assert_int_eq(t->points >= 1, strstr(costs[_i].sentence, "_right") != NULL);
}
END_TEST

static lc_rgb no_light(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *o, lc_sampler *sampler)
{
    (void)scene, (void)ray, (void)hit, (void)o, (void)sampler;
    return lc_black();
}

/* ---- what a student must not see yet --------------------------------------------------------------------------------------------- */

START_TEST(test_grade_withheld)
{
    assign(HEAD "\"due\": \"2026-12-01T00:00:00Z\", \"tests\": [" SEEN("v", "visible") ", " SEEN("d", "after_due_date") ", "
                SEEN("p", "after_published") ", " SEEN("h", "hidden") "]}");
    lc_grade_options o = options();
    o.estimator = mutant("three_point_back_emits");
    o.now = a.due - 1;
    grade(&r, "mine.c", &o);
    ck_assert_int_eq(lc_test_is_open(&r.tests[0]), 1);
    ck_assert_str_eq(r.tests[0].shown, r.tests[0].sentence);
    for (int i = 1; i < 4; ++i) {
        ck_assert_int_eq(lc_test_is_open(&r.tests[i]), 0);
        ck_assert_str_eq(r.tests[i].shown, "wrong");
        ck_assert_msg(strstr(r.tests[i].sentence, "light_behind") != NULL, "%s", r.tests[i].sentence);
    }
    ck_assert_msg(strstr(r.tests[1].withheld, "until 2026-12-01 00:00 UTC") != NULL, "%s", r.tests[1].withheld);
    ck_assert_msg(strstr(r.tests[2].withheld, "until the course publishes") != NULL, "%s", r.tests[2].withheld);
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    lc_grade_text(out, &r, 0);
    fclose(out);
    ck_assert_msg(strstr(text, "--only v") && !strstr(text, "--only d") && !strstr(text, "--only p") && !strstr(text, "--only h"), "%s",
                  text);
    free(text);
    o.now = a.due + 1;
    grade(&r, "mine.c", &o);
    ck_assert_int_eq(lc_test_is_open(&r.tests[1]), 1);
    ck_assert_int_eq(lc_test_is_open(&r.tests[3]), 0);
    o.is_teacher = 1;
    grade(&r, "mine.c", &o);
    ck_assert_int_eq(lc_test_is_open(&r.tests[3]), 1);
}
END_TEST

/* A table beside the assignment, for the tests and for what is said besides. */
START_TEST(test_grade_translated)
{
    char path[] = "/tmp/lightcheck-test-XXXXXX", *text = NULL;
    size_t size;
    int fd = mkstemp(path);
    ck_assert_int_ge(fd, 0);
    ck_assert_int_gt(dprintf(fd, "{\"black\": \"{scene}: es bleibt dunkel\", \"label_score\": \"{score} von {points} Punkten\"}"), 0);
    close(fd);
    assign(HEAD "\"tests\": [" FIRST LAMP "]}");
    snprintf(a.sentences, sizeof a.sentences, "%s", strrchr(path, '/') + 1);
    lc_grade_options o = options();
    lc_estimator black = *lc_right_estimator("three_point");
    black.radiance = no_light;
    o.estimator = &black;
    grade(&r, "mine.c", &o);
    unlink(path);
    ck_assert_str_eq(r.tests[2].sentence, "random_rectangle: es bleibt dunkel");
    FILE *out = open_memstream(&text, &size);
    lc_grade_text(out, &r, 0);
    fclose(out);
    ck_assert_msg(strstr(text, "2 von 7 Punkten, in") && !strstr(text, "score"), "%s", text);
    free(text);
}
END_TEST

START_TEST(test_grade_late)
{
    assign(HEAD "\"due\": \"2026-12-01T00:00:00Z\", \"late\": {\"per_day\": 0.25, \"most\": 0.6}, \"tests\": [" SEEN("v", "visible") "]}");
    static const struct {
        int seconds;
        double score;
    } rows_of_days[] = {{0, 1}, {1, 0.75}, {86400, 0.75}, {86401, 0.5}, {864000, 0.4}};
    lc_grade_options o = options();
    o.estimator = lc_right_estimator("three_point");
    for (int i = 0; i < 5; ++i) {
        o.submitted = a.due + rows_of_days[i].seconds;
        grade(&r, "mine.c", &o);
        ck_assert_double_eq_tol(r.score, rows_of_days[i].score, 1e-12);
    }
}
END_TEST

/* ---- faults ------------------------------------------------------------------------------------------------------------------------ */

#define SOURCE(body) \
    "#include \"lightcheck.h\"\nstatic lc_rgb radiance(const lc_scene *s, const lc_ray *r, const lc_hit *h, const lc_options *o, lc_sampler *p)\n{\n" \
    body "}\nLC_ESTIMATOR(mine) = {LC_ABI, \"mine\", \"m\", \"me\", LC_DIFFUSE, LC_AREA, 1, radiance};\n"

START_TEST(test_grade_not_compiled)
{
    char path[64];
    assign(HEAD "\"tests\": [" FIRST LAMP "]}");
    write_source(path, SOURCE("return 1 +;\n"));
    lc_grade_options o = options();
    for (o.is_open = 0; o.is_open < 2; ++o.is_open) {
        grade(&r, path, &o);
        ck_assert_int_eq(r.is_ungradable, 1);
        ck_assert_int_eq(r.code, LC_JAIL_CE);
        ck_assert_int_eq(lc_grade_status(&r), LC_BAD_INPUT);
        ck_assert_int_eq(r.tests[0].status, LC_TEST_PENDING); /* not 0 points: not graded */
        ck_assert_msg(strstr(r.message, "mine.c:4:") != NULL, "%s", r.message);
    }
    remove_source(path);
}
END_TEST

START_TEST(test_grade_own_fault)
{
    assign(HEAD "\"tests\": [" FIRST LAMP "]}");
    lc_grade_options o = options();
    ck_assert_int_eq(setenv("PATH", "/nowhere", 1), 0); /* no compiler */
    grade(&r, "estimators/three_point.c", &o);
    ck_assert_int_eq(r.is_fault, 1);
    ck_assert_int_eq(r.is_ungradable, 0);
    ck_assert_int_eq(r.code, LC_JAIL_IE);
    ck_assert_int_eq(lc_grade_status(&r), LC_FAULT);
    ck_assert_int_eq(r.tests[2].status, LC_TEST_FAULT);
}
END_TEST

/* ---- results on the way ------------------------------------------------------------------------------------------------------------- */

static lc_status count_calls(void *user, const lc_grade_result *result, lc_error *err)
{
    int *calls = user;
    if (result->done == 3 && *calls >= 100)
        return lc_fail(err, LC_FAULT, "the disk is full");
    ck_assert_int_ge(result->done, 0);
    ck_assert_int_eq(result->tests[result->done < result->test_count ? result->done : 0].status == LC_TEST_PENDING,
                     result->done < result->test_count);
    ++*calls;
    return LC_OK;
}

START_TEST(test_grade_after_every_test)
{
    int calls = 0;
    lc_error err = {""};
    assign(HEAD "\"tests\": [" FIRST LAMP "]}");
    lc_grade_options o = options();
    o.on_test = count_calls;
    o.user = &calls;
    o.estimator = lc_right_estimator("three_point");
    grade(&r, "mine.c", &o);
    ck_assert_int_eq(calls, 6); /* before the first, after each, at the end */
    calls = 100;
    ck_assert_int_eq(lc_grade_file(&r, &a, "mine.c", &o, &err), LC_FAULT);
    ck_assert_str_eq(err.text, "the disk is full");
}
END_TEST

START_TEST(test_grade_pictures)
{
    static const char *const ends[] = {"yours", "reference", "difference"};
    char folder[] = "/tmp/lightcheck-test-XXXXXX", path[128];
    struct stat info;
    ck_assert_ptr_nonnull(mkdtemp(folder));
    assign(HEAD "\"tests\": [" FIRST LAMP "]}");
    lc_grade_options o = options();
    o.report = folder;
    o.estimator = mutant("three_point_no_pi");
    grade(&r, "mine.c", &o);
    for (int i = 0; i < 3; ++i) {
        snprintf(path, sizeof path, "lamp_%s.png", ends[i]);
        ck_assert_str_eq(r.tests[2].pictures[i], path);
        snprintf(path, sizeof path, "%s/%s", folder, r.tests[2].pictures[i]);
        ck_assert_msg(stat(path, &info) == 0 && info.st_size > 100, "%s", path);
        unlink(path);
    }
    ck_assert_int_eq(rmdir(folder), 0);
}
END_TEST

/* ---- cheats --------------------------------------------------------------------------------------------------------------------------- */

/* What a cheat may earn: that it compiles, and is finite. Nothing for light. */
START_TEST(test_grade_cheats)
{
    int count = 0;
    assign(HEAD "\"tests\": [" FIRST LAMP "]}");
    lc_grade_options o = options();
    DIR *folder = opendir("verify/tests/cheats");
    ck_assert_ptr_nonnull(folder);
    for (struct dirent *entry = readdir(folder); entry; entry = readdir(folder)) {
        char path[300];
        if (!strstr(entry->d_name, ".c"))
            continue;
        snprintf(path, sizeof path, "verify/tests/cheats/%s", entry->d_name);
        grade(&r, path, &o);
        ck_assert_msg(!r.is_fault, "%s: %s", path, r.message);
        ck_assert_msg(r.is_ungradable || lc_grade_status(&r) == LC_WRONG, "%s: passes", path);
        for (int i = 2; i < r.test_count; ++i)
            ck_assert_msg(!(r.tests[i].points > 0), "%s earns %g points for %s: %s", path, r.tests[i].points, r.tests[i].name,
                          r.tests[i].sentence);
        ck_assert_msg(!r.is_ungradable || !(r.score > 0), "%s: ungradable, and %g points", path, r.score);
        ++count;
    }
    closedir(folder);
    ck_assert_int_ge(count, 40);
}
END_TEST

Suite *lc_suite_grade(void)
{
    Suite *suite = suite_create("grade");
    TCase *points = tcase_create("points"), *seen = tcase_create("seen"), *faults = tcase_create("faults"), *cheats = tcase_create("cheats");
    tcase_set_timeout(points, 60);
    tcase_set_timeout(seen, 60);
    tcase_set_timeout(faults, 60);
    tcase_set_timeout(cheats, 200);
    tcase_add_loop_test(points, test_grade_points, 0, sizeof rows / sizeof rows[0]);
    tcase_add_test(points, test_grade_right_file);
    tcase_add_test(points, test_grade_wrong_estimator);
    tcase_add_test(points, test_grade_known_bug);
    tcase_add_test(points, test_grade_by_seed);
    tcase_add_test(points, test_grade_method);
    tcase_add_loop_test(points, test_grade_costs, 0, sizeof costs / sizeof costs[0]);
    tcase_add_test(seen, test_grade_withheld);
    tcase_add_test(seen, test_grade_translated);
    tcase_add_test(seen, test_grade_late);
    tcase_add_test(seen, test_grade_after_every_test);
    tcase_add_test(seen, test_grade_pictures);
    tcase_add_test(faults, test_grade_not_compiled);
    tcase_add_test(faults, test_grade_own_fault);
    tcase_add_test(cheats, test_grade_cheats);
    suite_add_tcase(suite, points);
    suite_add_tcase(suite, seen);
    suite_add_tcase(suite, faults);
    suite_add_tcase(suite, cheats);
    return suite;
}
