/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The line under each test shows the same again, and no line of a class tells the seeds of what is withheld. */
#include "verify/tests/tests.h"

#include <math.h>
#include <sys/stat.h>

#include "verify/grade/grading.h"
#include "verify/grade/seeds.h"
#include "verify/tests/grade_help.h"

static lc_grade_result r, again;

#define SOURCE(body) \
    "#include \"lightcheck.h\"\nstatic lc_rgb radiance(const lc_scene *s, const lc_ray *r, const lc_hit *h, const lc_options *o, lc_sampler *p)\n{\n" \
    body "}\nLC_ESTIMATOR(mine) = {LC_ABI, \"mine\", \"m\", \"me\", LC_DIFFUSE, LC_AREA | LC_POINT | LC_DIRECTIONAL, 1, radiance};\n"

/* What is wrong shows in these bounces only, or over the scene that a relation compares with only. */
static const struct {
    const char *test, *source, *scene, *value;
} bad[] = {
    {"{\"name\": \"t\", \"title\": \"T\", \"kind\": \"finite\", \"points\": 1, \"scenes\": [\"plane_rectangle\"]}",
     SOURCE("    return lc_next(p) < 1e-3 ? lc_color(NAN, 0, 0) : lc_black();\n"), "sample plane_rectangle -e", "radiance (nan"},
    {"{\"name\": \"t\", \"title\": \"T\", \"kind\": \"check\", \"check\": \"analytic\", \"points\": 1, \"scenes\": [\"plane_rectangle\"]}",
     SOURCE("    return o->min_bounces == 1 && lc_next(p) < 1e-3 ? lc_color(-1, 0, 0) : lc_black();\n"), "--min-bounces 1 --bounces 1",
     "radiance (-1"},
    {"{\"name\": \"t\", \"title\": \"T\", \"kind\": \"check\", \"check\": \"metamorphic\", \"relation\": \"small\", \"points\": 1, "
     "\"scenes\": [\"five_lights\"]}",
     SOURCE("    double d = h->valid ? lc_length(lc_sub(h->p, r->o)) : 1;\n    return d < 0.1 && lc_next(p) < 0.1 ? lc_color(INFINITY, 0, 0) : "
            "lc_black();\n"),
     "sample five_lights/small:0 -e", "radiance (inf"},
    {"{\"name\": \"t\", \"title\": \"T\", \"kind\": \"finite\", \"points\": 1, \"scenes\": [\"random_rectangle\"]}",
     SOURCE("    return h->valid && h->p.x > 0.1 ? lc_color(0, -2, 0) : lc_black();\n"), "sample random_rectangle -e", ", -2, "},
};

static void run(char said[8192], const char *line)
{
    char command[LC_COMMAND + 16];
    snprintf(command, sizeof command, "%s 2>&1", line);
    FILE *pipe = popen(command, "r");
    ck_assert_ptr_nonnull(pipe);
    said[fread(said, 1, 8191, pipe)] = 0;
    ck_assert_msg(pclose(pipe) == 0, "%s: %s", line, said);
}

/* From a folder whose name a shell would take apart. */
START_TEST(the_bad_sample_is_replayed)
{
    char folder[] = "/tmp/lightcheck it's $(one)-XXXXXX", path[128], text[2048], said[8192];
    snprintf(text, sizeof text, "{\"title\": \"T\", \"reference\": \"light_direct\", \"bounces\": 1, \"cpu_seconds\": 10, \"tests\": [%s]}",
             bad[_i].test);
    assign(text);
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/mine.c", folder);
    FILE *f = fopen(path, "w");
    ck_assert_ptr_nonnull(f);
    fputs(bad[_i].source, f);
    fclose(f);
    lc_grade_options o = options();
    o.program = getenv("LIGHTCHECK") ? getenv("LIGHTCHECK") : "build/lightcheck";
    grade(&r, path, &o);
    ck_assert_str_eq(r.tests[0].sentence_id, "bad_sample");
    ck_assert_msg(strstr(r.tests[0].reproduce, bad[_i].scene) != NULL, "%s", r.tests[0].reproduce);
    run(said, r.tests[0].reproduce);
    ck_assert_msg(strstr(said, bad[_i].value) != NULL, "%s: %s", r.tests[0].reproduce, said);
    unlink(path);
    rmdir(folder);
}
END_TEST

#define DRAWN(name, visibility) \
    "{\"name\": \"" name "\", \"title\": \"A\", \"kind\": \"check\", \"check\": \"analytic\", \"scenes\": [\"random_rectangle\"], \"points\": 1, " \
    "\"visibility\": \"" visibility "\"}"

/* Whoever has all lines of a class that are shown, before and after the due date, cannot draw the scene of a test that is not. */
START_TEST(lines_do_not_tell_the_hidden_seeds)
{
    static const lc_visibility kinds[] = {LC_VISIBLE, LC_AFTER_DUE, LC_AFTER_PUBLISHED, LC_HIDDEN};
    assign(HEAD "\"due\": \"2026-12-01T00:00:00Z\", \"published\": \"2026-12-02T00:00:00Z\", \"tests\": [" DRAWN("v", "visible") ", "
                DRAWN("d", "after_due_date") ", " DRAWN("p", "after_published") ", " DRAWN("h", "hidden") "]}");
    const uint64_t secret = 8675309;
    lc_grade_options o = options(), home = options();
    o.estimator = home.estimator = mutant("three_point_no_pi");
    o.seed = secret;
    o.is_secret = 1;
    grade(&r, "handins/ann/mine.c", &o);
    ck_assert_uint_ne(r.seed, secret);
    for (int i = 0; i < 4; ++i) {
        char seed[64], file[128];
        snprintf(seed, sizeof seed, "--seed %llu ", (unsigned long long)lc_seed_of(secret, 1, kinds[i]));
        snprintf(file, sizeof file, "grade mine.c -a %s ", a.name); /* as it is called at home */
        ck_assert_msg(strstr(r.tests[i].reproduce, seed) && strstr(r.tests[i].reproduce, file), "%s", r.tests[i].reproduce);
        home.seed = lc_seed_of(secret, 1, kinds[i]); /* a line shows what it belongs to, and nothing else */
        grade(&again, "mine.c", &home);
        for (int j = 0; j < 4; ++j)
            ck_assert_msg((strcmp(r.tests[j].sentence, again.tests[j].sentence) == 0) == (i == j), "test %d by the seed of %d: %s", j, i,
                          again.tests[j].sentence);
    }
    o.is_secret = 0; /* one's own file, at home */
    grade(&again, "mine.c", &o);
    ck_assert_uint_eq(again.seed, secret);
}
END_TEST

/* Against the generator's published answers the library is tested; here, that it is used as a function of both, without a weak half. */
START_TEST(seeds_differ_in_all_bits)
{
    uint64_t any = 0, all = UINT64_MAX, base = lc_seed_for(1, "visible");
    for (uint64_t secret = 0; secret < 64; ++secret) {
        uint64_t other = lc_seed_for((uint64_t)1 << secret ^ 1, "visible");
        ck_assert_uint_ne(other, base);
        any |= other ^ base;
        all &= other ^ base;
    }
    ck_assert_uint_eq(any, UINT64_MAX);
    ck_assert_uint_eq(all, 0);
    ck_assert_uint_ne(base, lc_seed_for(1, "hidden"));
    ck_assert_uint_ne(lc_seed_for(1, "hand-in 12"), lc_seed_for(1, "hand-in 21"));
    ck_assert_uint_eq(base, lc_seed_for(1, "visible"));
}
END_TEST

/* A test that runs nothing does not show what the one before printed, which may be about a hidden scene. */
START_TEST(what_was_printed_stays_with_its_test)
{
    char path[64] = "/tmp/lightcheck-test-XXXXXX";
    assign(HEAD "\"tests\": [" SEEN("h", "hidden") ", {\"name\": \"compiles\", \"title\": \"C\", \"kind\": \"descriptor\", \"points\": 1}]}");
    ck_assert_ptr_nonnull(mkdtemp(path));
    strcat(path, "/mine.c");
    FILE *f = fopen(path, "w");
    ck_assert_ptr_nonnull(f);
    fputs("#include <stdio.h>\n" SOURCE("    static int once;\n    if (!once++)\n        printf(\"SPY %g\\n\", h->p.x);\n    return lc_black();\n"), f);
    fclose(f);
    lc_grade_options o = options();
    grade(&r, path, &o);
    ck_assert_str_eq(r.said, "");
    unlink(path);
    *strrchr(path, '/') = 0;
    rmdir(path);
}
END_TEST

Suite *lc_suite_grade_again(void)
{
    Suite *suite = suite_create("grade_again");
    TCase *lines = tcase_create("lines"), *seeds = tcase_create("seeds");
    tcase_add_loop_test(lines, the_bad_sample_is_replayed, 0, sizeof bad / sizeof bad[0]);
    tcase_add_test(lines, what_was_printed_stays_with_its_test);
    tcase_add_test(seeds, lines_do_not_tell_the_hidden_seeds);
    tcase_add_test(seeds, seeds_differ_in_all_bits);
    tcase_set_timeout(lines, 60);
    tcase_set_timeout(seeds, 60);
    suite_add_tcase(suite, lines);
    suite_add_tcase(suite, seeds);
    return suite;
}
