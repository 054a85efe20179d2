/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Adapters: what they may say of themselves, every way in which one can fail, and that a right one passes and a wrong one
 * does not. The adapters are shell scripts made here; LIGHTCHECK is the program.
 */
#include "verify/tests/tests.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "estimators/registry.h"
#include "io/scene_read.h"
#include "verify/judge/judge.h"

static lc_error err;
static char folder[256], script[300], work[300];

/* $LIGHTCHECK as seen from any folder. */
static void make_absolute(void)
{
    char here[2048], path[4096];
    const char *program = getenv("LIGHTCHECK");
    program = program ? program : "build/lightcheck";
    ck_assert_ptr_nonnull(getcwd(here, sizeof here));
    snprintf(path, sizeof path, "%s/%s", here, program);
    if (program[0] != '/')
        ck_assert_int_eq(setenv("LIGHTCHECK", path, 1), 0);
}

/* A script in a folder of its own, and $TMPDIR beside it. */
static void make_script(const char *text)
{
    make_absolute();
    snprintf(folder, sizeof folder, "/tmp/lc-adapter-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(script, sizeof script, "%s/any.sh", folder);
    snprintf(work, sizeof work, "%s/work", folder);
    ck_assert_int_eq(mkdir(work, 0700), 0);
    ck_assert_int_eq(setenv("TMPDIR", work, 1), 0);
    FILE *file = fopen(script, "wb");
    ck_assert_ptr_nonnull(file);
    fprintf(file, "#!/bin/sh\n%s\n", text);
    ck_assert_int_eq(fclose(file), 0);
    ck_assert_int_eq(chmod(script, 0700), 0);
}

/* Nothing may be left behind. */
static void remove_script(void)
{
    DIR *dir = opendir(work);
    int count = 0;
    ck_assert_ptr_nonnull(dir);
    while (readdir(dir))
        ++count;
    closedir(dir);
    ck_assert_int_eq(count, 2);
    ck_assert_int_eq(rmdir(work), 0);
    ck_assert_int_eq(unlink(script), 0);
    ck_assert_int_eq(rmdir(folder), 0);
    unsetenv("TMPDIR");
}

/* ---- --describe -------------------------------------------------------------------------------------------------- */

START_TEST(a_description_is_read)
{
    lc_adapter a;
    make_script("echo name=my.tracer-2\necho lobes=diffuse,glass\necho emitters=sky\necho max_bounces=7\n"
                "echo rounding=1e-4\necho batch=8\necho noise=none");
    ck_assert_msg(lc_adapter_open(&a, script, 10, &err) == LC_OK, "%s", err.text);
    ck_assert_str_eq(a.name, "my.tracer-2");
    ck_assert_str_eq(a.estimator.name, "my.tracer-2");
    ck_assert_uint_eq(a.estimator.lobes, LC_DIFFUSE | LC_GLASS);
    ck_assert_uint_eq(a.estimator.emitters, LC_SKY);
    ck_assert_int_eq(a.estimator.max_bounces, 7);
    ck_assert_double_eq(a.rounding, 1e-4);
    ck_assert_int_eq(a.batch, 8);
    ck_assert_int_eq(a.is_exact, 1);
    remove_script();
}
END_TEST

START_TEST(without_a_description_it_can_do_everything)
{
    lc_adapter a;
    make_script("echo what is --describe? >&2; exit 1");
    ck_assert_int_eq(lc_adapter_open(&a, script, 10, &err), LC_OK);
    ck_assert_str_eq(a.name, "any");
    ck_assert_uint_eq(a.estimator.lobes, LC_DIFFUSE | LC_MIRROR | LC_GLASS | LC_GLOSSY);
    ck_assert_uint_eq(a.estimator.emitters, LC_AREA | LC_POINT | LC_DIRECTIONAL | LC_SKY);
    ck_assert_int_eq(a.estimator.max_bounces, LC_UNBOUNDED);
    ck_assert_int_eq(a.batch, 1);
    ck_assert_int_eq(a.is_exact, 0);
    remove_script();
}
END_TEST

static const char *const nonsense[] = {"hello", "lobes=diffuse,shiny", "emitters=lamp", "max_bounces=1.5", "batch=0",
                                       "rounding=1", "noise=some", "colour=blue", "name=a b"};

START_TEST(a_description_that_is_not_understood_is_bad_input)
{
    lc_adapter a;
    char text[128];
    snprintf(text, sizeof text, "echo '%s'", nonsense[_i]);
    make_script(text);
    ck_assert_int_eq(lc_adapter_open(&a, script, 10, &err), LC_BAD_INPUT);
    ck_assert_msg(strstr(err.text, nonsense[_i]) != NULL, "%s", err.text);
    remove_script();
}
END_TEST

START_TEST(no_program_is_bad_input)
{
    lc_adapter a;
    ck_assert_int_eq(lc_adapter_open(&a, "/no/such/adapter", 10, &err), LC_BAD_INPUT);
    ck_assert_int_eq(lc_adapter_open(&a, "no-such-adapter", 10, &err), LC_BAD_INPUT);
    ck_assert_int_eq(lc_adapter_open(&a, "README.md", 10, &err), LC_BAD_INPUT);
}
END_TEST

/* ---- failures ---------------------------------------------------------------------------------------------------- */

static void read_scene(lc_scene_desc *desc, const char *name)
{
    ck_assert_int_eq(lc_scene_describe(desc, name, &err), LC_OK);
}

#define DESCRIBE "[ \"$1\" = --describe ] && exit 1\n"
#define RENDER "\"$LIGHTCHECK\" render \"$1\" -e light_direct -s \"$4\" --seed \"$5\" --bounces \"$6\" -o \"$7\" --size "

static const struct {
    const char *text, *words;
    lc_status status;
} failures[] = {
    {DESCRIBE "echo starting; echo my stomach hurts >&2; exit 3", "my stomach hurts", LC_FAULT},
    {DESCRIBE "kill -SEGV $$", "signal 11", LC_FAULT},
    {DESCRIBE "sleep 60 & sleep 60", "stopped after", LC_FAULT},
    {DESCRIBE "exit 0", "no image", LC_FAULT},
    {DESCRIBE "echo none of EXR >\"$7\"", "no valid OpenEXR", LC_FAULT},
    {DESCRIBE RENDER "16x16", "16 x 16", LC_FAULT},
    {DESCRIBE "echo I have no lamps; exit 2", "refuses no_lights: I have no lamps", LC_BAD_INPUT},
    {DESCRIBE RENDER "\"$2x$3\" && exit 0", "", LC_OK},
};

START_TEST(every_failure_is_said)
{
    lc_adapter a;
    lc_scene_desc desc;
    make_script(failures[_i].text);
    read_scene(&desc, "no_lights");
    ck_assert_int_eq(lc_adapter_open(&a, script, 1.5, &err), LC_OK);
    lc_adapter_job job = {&desc, 1, 1, 5, 2};
    float *rgb = malloc(2 * 3 * sizeof *rgb * (size_t)(desc.width * desc.height));
    ck_assert_ptr_nonnull(rgb);
    a.seconds = failures[_i].status == LC_OK ? 60 : 1.5;
    err.text[0] = 0;
    lc_status status = lc_adapter_render(rgb, &a, &job, &err);
    ck_assert_msg(status == failures[_i].status, "%d %s", status, err.text);
    ck_assert_msg(strstr(err.text, failures[_i].words) != NULL, "%s", err.text);
    free(rgb);
    lc_scene_desc_release(&desc);
    remove_script();
}
END_TEST

/* ---- verdicts ---------------------------------------------------------------------------------------------------- */

/* light_direct and wrong versions of it, each a program. */
static const struct {
    const char *scene, *estimator, *check;
    lc_row_verdict verdict;
} verdicts[] = {
    {"light_below", "light_direct", "analytic", LC_ROW_PASS},
    {"plane_directional", "light_direct", "analytic", LC_ROW_PASS},
    {"furnace_sphere", "light_direct", "furnace", LC_ROW_PASS},
    {"light_behind", "light_direct", "emission", LC_ROW_PASS},
    {"enclosure_point", "light_direct", "furnace", LC_ROW_PASS}, /* about the mean of all, which no pixel has */
    {"glass_sphere", "dielectric", "specular", LC_ROW_PASS},
    {"glass_sphere", "dielectric_schlick", "specular", LC_ROW_FAIL},
    {"furnace_sphere", "light_no_pi", "furnace", LC_ROW_FAIL},
    {"plane_directional", "light_no_pi", "analytic", LC_ROW_FAIL},
};

START_TEST(right_adapters_pass_and_wrong_ones_fail)
{
    char text[512];
    lc_adapter a;
    lc_verify_options options;
    lc_report report;
    snprintf(text, sizeof text,
             "[ \"$1\" = --describe ] && { echo max_bounces=%d; exit; }\n\"$LIGHTCHECK\" render \"$1\" -e %s --size \"$2x$3\" "
             "-s \"$4\" --seed \"$5\" --bounces \"$6\" -o \"$7\"",
             strncmp(verdicts[_i].estimator, "light", 5) == 0 ? 1 : 9, verdicts[_i].estimator);
    make_script(text);
    ck_assert_msg(lc_adapter_open(&a, script, 60, &err) == LC_OK, "%s", err.text);
    lc_verify_options_init(&options);
    options.renderer = &a;
    options.estimator = &a.estimator;
    options.check = verdicts[_i].check;
    options.scene = verdicts[_i].scene;
    ck_assert_msg(lc_verify(&report, &options, lc_scene_open, &err) == LC_OK, "%s", err.text);
    ck_assert_int_ge(report.count, 1);
    ck_assert_msg(report.rows[0].verdict == verdicts[_i].verdict, "%s", report.rows[0].reason);
    lc_report_release(&report);
    remove_script();
}
END_TEST

/* Each image is right but for a factor of its own, whose mean is 1: one of eight, within 1.5%, by a hash of the seed. So a pixel shows a
 * noise of 1% that the number of pixels does not reduce. */
#define FACTORS \
    "[ \"$1\" = --describe ] && { echo max_bounces=1; echo batch=64; exit; }\n" \
    "xml=$1 size=$2x$3 seed=$5 out=$7\nshift 7\nwhile :; do\n" \
    "h=$(( (seed ^ seed >> 16) * 0x45d9f3b & 0xffffffff )) h=$(( (h ^ h >> 16) * 0x45d9f3b & 0xffffffff )) k=$(( (h ^ h >> 16) % 8 ))\n" \
    "if ! [ -e \"$0.$k.exr\" ]; then\n" \
    "f=$(awk \"BEGIN { f = 1 + 0.015 * (2 * $k - 7) / 7; print 2 * f, 3 * f, 4 * f }\")\n" \
    "sed \"s/\\(name=.irradiance. value=.\\)[^\\\"]*/\\1$f/\" \"$xml\" >\"$0.$k.xml\"\n" \
    "\"$LIGHTCHECK\" render \"$0.$k.xml\" -e light_direct --bounces 1 --size \"$size\" -s 1 -o \"$0.$k.exr\" >&2 || exit 1\n" \
    "fi\ncp \"$0.$k.exr\" \"$out\"\n[ $# -gt 0 ] || break\nseed=$1 out=$2\nshift 2\ndone"

START_TEST(images_that_move_as_one_do_not_fail)
{
    char command[sizeof script + 32];
    lc_adapter a;
    lc_verify_options options;
    lc_report report;
    make_script(FACTORS);
    ck_assert_msg(lc_adapter_open(&a, script, 60, &err) == LC_OK, "%s", err.text);
    lc_verify_options_init(&options);
    options.renderer = &a;
    options.estimator = &a.estimator;
    options.check = "analytic";
    options.scene = "plane_directional";
    ck_assert_msg(lc_verify(&report, &options, lc_scene_open, &err) == LC_OK, "%s", err.text);
    ck_assert_int_eq(report.count, 1);
    ck_assert_msg(report.rows[0].verdict == LC_ROW_PASS && !report.rows[0].exact, "%s", report.rows[0].reason);
    ck_assert_double_ge(report.rows[0].high - report.rows[0].low, 0.002);
    lc_report_release(&report);
    snprintf(command, sizeof command, "rm %s.*", script);
    ck_assert_int_eq(system(command), 0);
    remove_script();
}
END_TEST

START_TEST(what_is_refused_is_noted)
{
    lc_adapter a;
    lc_verify_options options;
    lc_report report;
    make_script(DESCRIBE "echo not a fine scene; exit 2");
    ck_assert_int_eq(lc_adapter_open(&a, script, 60, &err), LC_OK);
    lc_verify_options_init(&options);
    options.renderer = &a;
    options.estimator = &a.estimator;
    options.check = "analytic";
    options.scene = "light_below";
    ck_assert_msg(lc_verify(&report, &options, lc_scene_open, &err) == LC_OK, "%s", err.text);
    ck_assert_int_eq(report.count, 0);
    ck_assert_int_eq(report.note_count, 1);
    ck_assert_msg(strstr(report.notes[0].reason, "not a fine scene") != NULL, "%s", report.notes[0].reason);
    ck_assert_str_eq(report.notes[0].scene, "light_below");
    lc_report_release(&report);
    remove_script();
}
END_TEST

/* A renderer that crashes once loses a row; one that always does is given up. */
START_TEST(a_crash_loses_one_row)
{
    lc_adapter a;
    lc_verify_options options;
    lc_report report;
    char once[sizeof work + 8];
    make_script("[ \"$1\" = --describe ] && { echo max_bounces=1; exit; }\n[ -e \"$0.once\" ] || { touch \"$0.once\"; kill -SEGV $$; }\n"
                RENDER "\"$2x$3\"");
    ck_assert_int_eq(lc_adapter_open(&a, script, 60, &err), LC_OK);
    lc_verify_options_init(&options);
    options.renderer = &a;
    options.estimator = &a.estimator;
    options.scene = "light_below";
    ck_assert_msg(lc_verify(&report, &options, lc_scene_open, &err) == LC_OK, "%s", err.text);
    ck_assert_int_ge(report.count, 1);
    ck_assert_int_eq(lc_report_faults(&report), 1);
    ck_assert_int_eq(lc_report_status(&report), LC_FAULT);
    for (int i = 0; i < report.count; ++i)
        ck_assert_msg(report.rows[i].verdict == LC_ROW_PASS, "%s", report.rows[i].reason);
    lc_report_release(&report);
    snprintf(once, sizeof once, "%s.once", script);
    ck_assert_int_eq(unlink(once), 0);
    remove_script();

    make_script("[ \"$1\" = --describe ] && exit 1\necho no licence >&2; exit 1");
    ck_assert_int_eq(lc_adapter_open(&a, script, 60, &err), LC_OK);
    options.scene = NULL;
    ck_assert_int_eq(lc_verify(&report, &options, lc_scene_open, &err), LC_FAULT);
    ck_assert_msg(strstr(err.text, "no licence") != NULL, "%s", err.text);
    lc_report_release(&report);
    remove_script();
}
END_TEST

/* In the language of the example, where it is installed: mean irradiance within six standard errors, and a refusal. */
START_TEST(the_example_renders_what_it_says)
{
    char python[LC_PROGRAM_PATH];
    lc_adapter a;
    lc_scene_desc desc;
    lc_scene *scene;
    lc_film *film;
    if (!lc_program_find(python, "python3"))
        return;
    ck_assert_msg(lc_adapter_open(&a, "verify/renderers/example.py", 60, &err) == LC_OK, "%s", err.text);
    ck_assert_str_eq(a.name, "example");
    ck_assert_int_eq(a.estimator.max_bounces, 1);
    read_scene(&desc, "plane_rectangle");
    desc.width = desc.height = 12;
    enum { FLOATS = 3 * 12 * 12, SAMPLES = 64 };
    float rgb[FLOATS];
    lc_adapter_job job = {&desc, 1, SAMPLES, 3, 1};
    ck_assert_msg(lc_adapter_render(rgb, &a, &job, &err) == LC_OK, "%s", err.text);
    ck_assert_int_eq(lc_scene_build(&scene, &desc, &err), LC_OK);
    ck_assert_int_eq(lc_film_create(&film, 12, 12, &err), LC_OK);
    const lc_estimator *const *e = lc_estimators;
    while (strcmp((*e)->name, "light_direct") != 0)
        ++e;
    lc_render_options options = {.max_bounces = 1, .seed = 1, .arm = 1, .count = 4096, .threads = 2};
    ck_assert_int_eq(lc_render(film, scene, *e, &options, &err), LC_OK);
    for (int c = 0; c < 3; ++c) {
        double mine = 0, its = 0, variance = 0;
        for (int i = 0; i < 144; ++i) {
            mine += film->pixels[i].c[c].mean;
            its += (double)rgb[3 * i + c];
            variance += lc_pixel_variance(&film->pixels[i], c) * (1 + 4096.0 / SAMPLES);
        }
        ck_assert_msg(fabs(its - mine) < 6 * sqrt(variance), "%g, expected %g +- %g", its, mine, sqrt(variance));
        ck_assert_double_lt(6 * sqrt(variance), 0.05 * mine);
    }
    lc_film_free(film);
    lc_scene_free(scene);
    lc_scene_desc_release(&desc);
    read_scene(&desc, "cornell");
    job.scene = &desc;
    ck_assert_int_eq(lc_adapter_render(rgb, &a, &job, &err), LC_BAD_INPUT);
    ck_assert_msg(strstr(err.text, "two rectangles") != NULL, "%s", err.text);
    lc_scene_desc_release(&desc);
}
END_TEST

Suite *lc_suite_adapter(void)
{
    Suite *suite = suite_create("adapter");
    TCase *tc = tcase_create("adapter");
    tcase_set_timeout(tc, 30);
    tcase_add_test(tc, a_description_is_read);
    tcase_add_test(tc, without_a_description_it_can_do_everything);
    tcase_add_loop_test(tc, a_description_that_is_not_understood_is_bad_input, 0, sizeof nonsense / sizeof nonsense[0]);
    tcase_add_test(tc, no_program_is_bad_input);
    tcase_add_loop_test(tc, every_failure_is_said, 0, sizeof failures / sizeof failures[0]);
    tcase_add_test(tc, what_is_refused_is_noted);
    tcase_add_test(tc, a_crash_loses_one_row);
    tcase_add_test(tc, the_example_renders_what_it_says);
    suite_add_tcase(suite, tc);
    tc = tcase_create("verdicts");
    tcase_set_tags(tc, "long"); /* many programs are started; suite replicates runs the same code of ours */
    tcase_set_timeout(tc, 30);
    tcase_add_loop_test(tc, right_adapters_pass_and_wrong_ones_fail, 0, sizeof verdicts / sizeof verdicts[0]);
    suite_add_tcase(suite, tc);
    tc = tcase_create("images");
    tcase_set_tags(tc, "long");
    tcase_set_timeout(tc, 60);
    tcase_add_test(tc, images_that_move_as_one_do_not_fail);
    suite_add_tcase(suite, tc);
    return suite;
}
