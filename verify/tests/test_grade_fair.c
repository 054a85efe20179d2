/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files that once earned points for what they do not do, or that ended a grading without a result: each gets what it earns. */
#include "verify/tests/tests.h"

#include <dirent.h>
#include <math.h>
#include <sys/wait.h>

#include "verify/grade/grading.h"
#include "verify/tests/grade_help.h"
#include "verify/tests/load_help.h"

static lc_grade_result r;

static char source[64]; /* a file of its own, in a folder of its own */

static void set_up(void)
{
    strcpy(source, "/tmp/lightcheck-test-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(source));
    strcat(source, "/mine.c");
}

static void tear_down(void)
{
    unlink(source);
    *strrchr(source, '/') = 0;
    ck_assert_int_eq(rmdir(source), 0);
}

/* Direct light from one lamp, right as it stands; `c` is what the sample is worth. */
#define RIGHT \
    "#include \"lightcheck.h\"\n" \
    "static lc_rgb light(const lc_scene *s, const lc_hit *h, lc_sampler *p)\n" \
    "{\n" \
    "    lc_light_sample l;\n" \
    "    int count = lc_light_count(s);\n" \
    "    if (!h->valid || !count)\n" \
    "        return lc_black();\n" \
    "    lc_light_sample_one(s, (int)(lc_next(p) * count), h, p, &l);\n" \
    "    double cos_surface = lc_dot(lc_facing(h->n, h->wo), l.wi), cos_light = -lc_dot(l.n, l.wi);\n" \
    "    if (!(cos_surface > 0 && cos_light > 0) || !lc_visible(s, h, &l))\n" \
    "        return lc_black();\n" \
    "    double g = cos_surface * cos_light / (l.distance * l.distance);\n" \
    "    return lc_rgb_mul(lc_bsdf_eval(s, h, l.wi), lc_rgb_scale(count * g / l.pdf_area, l.radiance));\n" \
    "}\n" \
    "static lc_rgb radiance(const lc_scene *s, const lc_ray *r, const lc_hit *h, const lc_options *o, lc_sampler *p)\n" \
    "{\n" \
    "    lc_rgb c = lc_black();\n" \
    "    if (o->min_bounces <= 0)\n" \
    "        c = lc_emission(s, h);\n" \
    "    if (o->max_bounces >= 1 && o->min_bounces <= 1)\n" \
    "        c = lc_rgb_add(c, light(s, h, p));\n"
#define END(bounces) \
    "    return c;\n}\n" \
    "LC_ESTIMATOR(mine) = {LC_ABI, \"mine\", \"m\", \"me\", LC_DIFFUSE, LC_AREA, " bounces ", radiance};\n"

static void write_source(const char *text)
{
    FILE *f = fopen(source, "w");
    ck_assert_ptr_nonnull(f);
    fputs(text, f);
    ck_assert_int_eq(fclose(f), 0);
}

/* What a command prints; its exit status. */
static int run(char *said, size_t size, const char *line)
{
    char command[1024];
    snprintf(command, sizeof command, "exec 2>&1; %s", line);
    FILE *pipe = popen(command, "r");
    ck_assert_ptr_nonnull(pipe);
    said[fread(said, 1, size - 1, pipe)] = 0;
    int status = pclose(pipe);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static const char *program(void) { return getenv("LIGHTCHECK") ? getenv("LIGHTCHECK") : "build/lightcheck"; }

#define TEST(name, kind, rest) "{\"name\": \"" name "\", \"title\": \"T\", \"kind\": \"" kind "\", \"points\": 1" rest "}"
#define LAMP_ONLY TEST("lamp", "check", ", \"check\": \"analytic\", \"scenes\": [\"plane_rectangle\"]")

/* ---- samples that cannot be squared ----------------------------------------------------------------------------------- */

static const char *const huge[] = {"1e300", "1e150", "1e100"};

/* A wrong answer with its place, not an error of the judge that ends the grading. */
START_TEST(test_fair_huge)
{
    static char said[1 << 14];
    char line[700], text[2048];
    snprintf(text, sizeof text, RIGHT "    c.g *= %s;\n" END("1"), huge[_i]);
    assign(HEAD "\"tests\": [" LAMP_ONLY "]}");
    write_source(text);
    lc_grade_options o = options();
    o.program = program();
    for (o.is_open = 0; o.is_open < 2; ++o.is_open) {
        grade(&r, source, &o);
        const lc_test_result *t = &r.tests[0];
        ck_assert_int_eq(t->code, LC_JAIL_WA);
        ck_assert_str_eq(t->sentence_id, "bad_sample");
        ck_assert(t->measured.bad_x >= 0 && t->measured.bad_value[1] > LC_LARGEST_SAMPLE);
    }
    ck_assert_int_eq(run(said, sizeof said, r.tests[0].reproduce), 0);
    ck_assert_msg(strstr(said, "radiance (") && strstr(said, "e+"), "%s", said);
    snprintf(line, sizeof line, "%s verify -e %s -c analytic --scene plane_rectangle", program(), source);
    ck_assert_msg(run(said, sizeof said, line) == 1, "%s", said);
    ck_assert_msg(strstr(said, "above 1e60, the first (") && strstr(said, "at pixel "), "%s", said);
}
END_TEST

/* ---- faults of ours ---------------------------------------------------------------------------------------------------- */

/* Kills the workers of the grading $p, once they compute. */
static const char kill_workers[] =
    "for i in $(seq 200); do c=$(cat /proc/$p/task/$p/children); "
    "if [ -n \"$c\" ] && grep -q ^lightcheck-work /proc/${c%% *}/comm; then "
    "sleep 0.5; kill -9 $(cat /proc/$p/task/$p/children); break; fi; sleep 0.05; done;";

/* A grading that a fault of ours ends midway has a result all the same: it says so. */
START_TEST(test_fair_fault_is_written)
{
    static char said[1 << 14];
    char line[1000], path[64];
    strcpy(path, source);
    strcpy(strrchr(path, '/'), "/a.json");
    FILE *f = fopen(path, "w");
    ck_assert_ptr_nonnull(f);
    fputs("{\"title\": \"T\", \"reference\": \"three_point\", \"bounces\": 1, \"tests\": [" LAMP_ONLY ", "
          TEST("mean", "mean", ", \"scenes\": [\"occluder\"]") "]}", f);
    ck_assert_int_eq(fclose(f), 0);
    snprintf(line, sizeof line, "%s grade verify/tests/cheats/loop.c -a %s --format json & p=$!; %s wait $p", program(), path, kill_workers);
    int status = run(said, sizeof said, line);
    unlink(path);
    ck_assert_msg(status == LC_FAULT, "%d: %.500s", status, said);
    ck_assert_msg(strstr(said, "\"IE\"") && strstr(said, "ended from outside, by signal 9"), "%.500s", said);
}
END_TEST

/* ---- files that claim less than a test asks for ----------------------------------------------------------------------- */

/* Each test that needs more bounces fails, and says why; the others are judged. Once, the grading ended without a result. */
START_TEST(test_fair_claims_less)
{
    assign(HEAD "\"tests\": [" TEST("finite", "finite", ", \"scenes\": [\"plane_rectangle\"]") ", "
                TEST("seen", "finite", ", \"scenes\": [\"plane_rectangle\"], \"bounces\": [0, 0]") ", " LAMP_ONLY ", "
                TEST("mean", "mean", ", \"scenes\": [\"occluder\"]") ", "
                TEST("hidden", "check", ", \"check\": \"analytic\", \"scenes\": [\"random_rectangle\"], \"visibility\": \"hidden\"") ", "
                TEST("method", "variance", ", \"scenes\": [\"plane_rectangle\"], \"at_most\": 2") "]}");
    write_source(RIGHT END("0"));
    lc_grade_options o = options();
    for (o.is_open = 0; o.is_open < 2; ++o.is_open) {
        grade(&r, source, &o);
        ck_assert_int_eq(lc_grade_status(&r), LC_WRONG);
        for (int i = 0; i < r.test_count; ++i) {
            const lc_test_result *t = &r.tests[i];
            int is_fewer = strcmp(t->name, "seen") == 0;
            ck_assert_msg(t->code == (is_fewer ? LC_JAIL_AC : LC_JAIL_WA), "%s: %s", t->name, t->sentence);
            ck_assert_str_eq(t->sentence_id, is_fewer ? "finite" : "claims_less");
            ck_assert(is_fewer || strstr(t->sentence, "does not claim 1 bounce,"));
        }
    }
}
END_TEST

/* ---- methods that are not used, and answers learnt by heart ------------------------------------------------------------ */

/* cheats/learnt/: files that are right somewhere, and say whatever is asked for elsewhere. `lamp` and `method` are over a public scene, the others
 * over one that is drawn and hidden. What is learnt by heart earns points where it is right, over scenes that everybody can see: a
 * table of their images is an answer as good as another. Nothing is earned for a method that is not used, nor over scenes
 * that the file has not seen; little noise by much work, and light without a ray, are found by what samples cost. */
enum { LEARNT_TESTS = 7 };
static const struct {
    const char *name;
    int earned[LEARNT_TESTS]; /* lamp, method, drawn, drawn_method, rays, numbers, work */
} learnt[] = {
    {"dark_noise", {1, 0, 1, 0, 0, 0, 0}},    {"dim_noise", {1, 0, 1, 0, 0, 0, 0}},     {"running_mean", {1, 0, 1, 0, 0, 0, 0}},
    {"known_scene", {1, 1, 0, 0, 0, 0, 0}},   {"known_bounces", {1, 0, 1, 0, 0, 0, 0}}, {"many_paths", {1, 1, 1, 0, 0, 0, 0}},
    {"own_generator", {1, 0, 1, 0, 1, 0, 0}},
};
enum { LEARNT = sizeof learnt / sizeof learnt[0] };

/* As much work as three_point's, give or take what is left out where a cosine is negative. */
#define COST(name) TEST(#name, #name, ", \"scenes\": [\"plane_rectangle\"], \"at_least\": 0.5, \"at_most\": 2")

static void assign_method(void)
{
    assign("{\"title\": \"T\", \"reference\": \"three_point\", \"bounces\": 1, \"cpu_seconds\": 120, \"tests\": [" LAMP_ONLY ", " TEST("method", "variance", ", \"scenes\": [\"plane_rectangle\"], \"at_most\": 2") ", "
                TEST("drawn", "check", ", \"check\": \"analytic\", \"scenes\": [\"random_rectangle\"], \"visibility\": \"hidden\"") ", "
                TEST("drawn_method", "variance", ", \"scenes\": [\"random_rectangle\"], \"at_most\": 2, \"visibility\": \"hidden\"") ", "
                COST(rays) ", " COST(numbers) ", " COST(work) "]}");
}

START_TEST(test_fair_learnt)
{
    const int *earned = learnt[_i].earned;
    char path[128];
    assign_method();
    lc_grade_options o = options();
    o.seed = 20 + (uint64_t)_i;
    snprintf(path, sizeof path, "verify/tests/cheats/learnt/%s.c", learnt[_i].name);
    grade(&r, path, &o);
    for (int i = 0; i < LEARNT_TESTS; ++i) {
        const lc_test_result *t = &r.tests[i];
        ck_assert_msg((t->points >= 1) == earned[i], "%s: %g points for %s: %s", path, t->points, t->name, t->sentence);
        ck_assert_msg(earned[i] || !(t->points > 0), "%s: %g points for %s: %s", path, t->points, t->name, t->sentence);
        ck_assert_msg(!strstr(t->sentence, "nan") && !strstr(t->sentence, "inf "), "%s", t->sentence);
    }
}
END_TEST

/* ---- without noise ------------------------------------------------------------------------------------------------------- */

static const lc_estimator *base;
static double factor; /* < 0: -factor times as much, in every -factor-th sample */

static lc_rgb changed(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *o, lc_sampler *sampler)
{
    lc_rgb c = base->radiance(scene, ray, hit, o, sampler);
    return lc_rgb_scale(factor >= 0 ? factor : lc_next(sampler) * -factor < 1 ? -factor : 0, c);
}

/* Right files may have no noise at all, where the reference has some or none; nothing is then known of their error, but of the
 * reference's. Where the light is wrong, its noise counts for nothing. */
static const struct {
    const char *reference, *scene, *bounds, *estimator;
    double factor;
    const char *sentence, *says;
} still[] = {
    {"hemisphere_direct", "furnace_sphere", "\"at_most\": 2", "hemisphere_cosine", 1, "variance_right", " 0 times"},
    {"hemisphere_direct", "furnace_sphere", "\"at_least\": 0.5, \"at_most\": 2", "hemisphere_cosine", 1, "variance_low", " 0 times"},
    {"hemisphere_direct", "furnace_sphere", "\"at_most\": 2", "hemisphere_cosine", 0.9, "variance_wrong", "32 x 32 pixels at 0,0"},
    {"hemisphere_direct", "furnace_sphere", "\"at_most\": 2", "hemisphere_direct", 0.9, "variance_wrong", "32 x 32 pixels at 0,0"},
    {"hemisphere_direct", "furnace_sphere", "\"at_most\": 2", "hemisphere_direct", 0, "variance_wrong", "is 0% of"},
    {"hemisphere_direct", "furnace_sphere", "\"at_most\": 2", "hemisphere_direct", 1e-200, "variance_wrong", "e-198% of"},
    {"light_direct", "plane_directional", "\"at_most\": 2", "light_all", 1, "variance_right", " 1 times"},
    {"light_direct", "plane_directional", "\"at_most\": 2", "light_all", 0.99, "variance_wrong", "is 99% of"},
    {"light_direct", "plane_directional", "\"at_most\": 2", "light_all", 0, "variance_wrong", "is 0% of"},
    {"light_direct", "plane_directional", "\"at_most\": 2", "light_all", -2, "variance_high", "infinitely many times"},
};

START_TEST(test_fair_still)
{
    char text[1024];
    lc_estimator e = *lc_right_estimator(still[_i].estimator);
    snprintf(text, sizeof text,
             "{\"title\": \"T\", \"reference\": \"%s\", \"bounces\": 1, \"tests\": [" TEST("method", "variance", ", \"scenes\": [\"%s\"], %s") "]}",
             still[_i].reference, still[_i].scene, still[_i].bounds);
    assign(text);
    base = lc_right_estimator(still[_i].estimator);
    factor = still[_i].factor;
    e.radiance = changed;
    lc_grade_options o = options();
    o.estimator = &e;
    grade(&r, "mine.c", &o);
    const lc_test_result *t = &r.tests[0];
    ck_assert_msg(strcmp(t->sentence_id, still[_i].sentence) == 0 && strstr(t->sentence, still[_i].says), "%s: %s", t->sentence_id,
                  t->sentence);
    ck_assert_int_eq(t->status, strcmp(still[_i].sentence, "variance_right") == 0 ? LC_TEST_PASSED : LC_TEST_FAILED);
    ck_assert_msg(!strstr(t->sentence, "nan") && !strstr(t->sentence, "inf "), "%s", t->sentence);
}
END_TEST

/* Right files earn all of it: the method that is asked for, and one that is like it. */
START_TEST(test_fair_costs_of_the_right)
{
    static const char *const right[] = {"estimators/three_point.c", "estimators/light_direct.c"};
    assign_method();
    lc_grade_options o = options();
    grade(&r, right[_i], &o);
    for (int i = 0; i < LEARNT_TESTS; ++i)
        ck_assert_msg(r.tests[i].points >= 1, "%s: %s", r.tests[i].name, r.tests[i].sentence);
}
END_TEST

/* Every file there is in the table. */
START_TEST(test_fair_all_learnt)
{
    int count = 0;
    DIR *folder = opendir("verify/tests/cheats/learnt");
    ck_assert_ptr_nonnull(folder);
    for (struct dirent *entry = readdir(folder); entry; entry = readdir(folder))
        count += strstr(entry->d_name, ".c") != NULL;
    closedir(folder);
    ck_assert_int_eq(count, LEARNT);
}
END_TEST

/* ---- some points ------------------------------------------------------------------------------------------------------ */

/* A test that earns some of its points is partial, and what requires it is judged, unless it was shown wrong: the row says that, not the
 * interval of the whole image. An interval may miss 1 where nothing is shown yet, and hold it where one tile is wrong. */
static const struct {
    lc_row row;
    double share;
    lc_test_status status;
    const char *relation; /* the sentence where it is about a relation between scenes */
} some[] = {
    {{.verdict = LC_ROW_UNDECIDED, .low = 1.001, .high = 1.015}, 0.7, LC_TEST_PARTIAL, "relation_near"},
    {{.verdict = LC_ROW_UNDECIDED, .low = 0.93, .high = 0.99}, 0.4, LC_TEST_PARTIAL, "relation_near"},
    {{.verdict = LC_ROW_UNDECIDED, .low = 0.99, .high = 1.015}, 0.7, LC_TEST_PARTIAL, "relation_near"},
    {{.verdict = LC_ROW_FAIL, .low = 0.99, .high = 1.01, .tile_width = 4, .tile_ratio = 1.03}, 0.3, LC_TEST_FAILED, "relation_wrong"},
    {{.verdict = LC_ROW_FAIL, .low = 1.02, .high = 1.03}, 0.3, LC_TEST_FAILED, "relation_wrong"},
    {{.verdict = LC_ROW_FAIL, .low = 1.2, .high = 1.3}, 0, LC_TEST_FAILED, "relation_wrong"},
    {{.verdict = LC_ROW_UNDECIDED, .low = 0.5, .high = 1.5}, 0, LC_TEST_FAILED, "relation_open"},
    {{.verdict = LC_ROW_PASS, .low = 1.001, .high = 1.003}, 1, LC_TEST_PASSED, "relation_right"},
};

START_TEST(test_fair_some_points)
{
    lc_row row = some[_i].row;
    lc_test_result t = {.most_points = 2, .measured = {.low = row.low, .high = row.high}};
    double shown;
    row.margin = 0.01;
    row.samples = 256;
    ck_assert_double_eq(lc_grade_share(&shown, &row), some[_i].share);
    lc_test_settle(&t, some[_i].share);
    ck_assert_double_eq(t.points, 2 * some[_i].share);
    ck_assert_msg(t.status == some[_i].status, "%s", lc_test_status_name(t.status));
    lc_grade_options o = options();
    const lc_grading g = {.options = &o};
    const lc_claim claim = {.relation = "moved", .source = "the same image"};
    lc_test_row(&t, &g, &claim, &row, NULL);
    ck_assert_str_eq(t.sentence_id, some[_i].relation);
    ck_assert_msg(!strchr(t.sentence, '{') && strstr(t.sentence, "same"), "%s", t.sentence);
}
END_TEST

/* With this seed one ray in a million meets the seam of a lamp that is cut: a right file once lost a point over it. */
START_TEST(test_fair_seam)
{
    char said[4096], line[512];
    snprintf(line, sizeof line, "%s grade estimators/hemisphere_direct.c -a hemisphere_direct --seed 160799830870 --only itself", program());
    ck_assert_msg(run(said, sizeof said, line) == 0 && strstr(said, "score 1 of 1,"), "%s", said);
}
END_TEST

Suite *lc_suite_grade_fair(void)
{
    Suite *suite = suite_create("grade_fair");
    TCase *tcase = tcase_create("fair");
    tcase_set_timeout(tcase, 200);
    tcase_add_checked_fixture(tcase, set_up, tear_down);
    tcase_add_loop_test(tcase, test_fair_huge, 0, sizeof huge / sizeof huge[0]);
    tcase_add_test(tcase, test_fair_fault_is_written);
    tcase_add_test(tcase, test_fair_claims_less);
    tcase_add_test(tcase, test_fair_seam);
    tcase_add_loop_test(tcase, test_fair_some_points, 0, sizeof some / sizeof some[0]);
    tcase_add_test(tcase, test_fair_all_learnt);
    tcase_add_loop_test(tcase, test_fair_still, 0, sizeof still / sizeof still[0]);
    suite_add_tcase(suite, tcase);
    TCase *learnt_ones = tcase_create("learnt");
    tcase_set_tags(learnt_ones, "long"); /* many samples, no code that other tests do not run */
    tcase_set_timeout(learnt_ones, 200);
    tcase_add_checked_fixture(learnt_ones, set_up, tear_down);
    tcase_add_loop_test(learnt_ones, test_fair_learnt, 0, LEARNT);
    tcase_add_loop_test(learnt_ones, test_fair_costs_of_the_right, 0, 2);
    suite_add_tcase(suite, learnt_ones);
    return suite;
}
