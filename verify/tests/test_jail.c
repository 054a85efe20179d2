/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The jail: an honest file gets the films that lc_render gives; a cheat gets nothing, in cheats/ one way each. */
#include "verify/tests/tests.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "estimators/registry.h"
#include "io/scene_read.h"
#include "verify/grade/jail.h"
#include "verify/grade/plugin.h"
#include "verify/grade/symbols.h"
#include "verify/judge/judge.h"
#include "verify/tests/docker_like.h"

static char folder[64];
static const char left_behind[] = "/tmp/lightcheck-broke-out";

static void set_up(void)
{
    strcpy(folder, "/tmp/lightcheck-test-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
    ck_assert_int_eq(setenv("TMPDIR", folder, 1), 0);
    ck_assert_int_eq(chmod(folder, 0777), 0);
    unlink(left_behind);
    prctl(PR_SET_CHILD_SUBREAPER, 1); /* whoever is left behind becomes ours */
    signal(SIGPIPE, SIG_IGN);         /* as in the program */
}

static void tear_down(void)
{
    char command[128];
    snprintf(command, sizeof command, "rm -rf %s", folder);
    ck_assert_int_eq(system(command), 0);
}

static void check_clean(const char *name)
{
    int count = 0, status;
    DIR *dir = opendir(folder);
    ck_assert_ptr_nonnull(dir);
    for (struct dirent *e = readdir(dir); e; e = readdir(dir))
        count += e->d_name[0] != '.' && strncmp(e->d_name, "kept", 4) != 0;
    closedir(dir);
    ck_assert_msg(count == 0, "%s: left %d files behind", name, count);
    ck_assert_msg(access(left_behind, F_OK) != 0, "%s: wrote %s", name, left_behind);
    pid_t child = waitpid(-1, &status, WNOHANG);
    ck_assert_msg(child == -1 && errno == ECHILD, "%s: left process %d behind", name, (int)child);
}

static lc_scene *load(const char *name)
{
    char path[128];
    lc_scene_desc desc;
    lc_scene *scene;
    lc_error err = {""};
    snprintf(path, sizeof path, "scenes/%s.xml", name);
    ck_assert_msg(lc_scene_read(&desc, path, NULL, 0, &err) == LC_OK, "%s", err.text);
    ck_assert_msg(lc_scene_build(&scene, &desc, &err) == LC_OK, "%s", err.text);
    lc_scene_desc_release(&desc);
    return scene;
}

static lc_film *make_film(int width, int height)
{
    lc_film *film;
    ck_assert_int_eq(lc_film_create(&film, width, height, NULL), LC_OK);
    return film;
}

/* ---- honest files ------------------------------------------------------------------------------------------------ */

static lc_jail *open_honest(const char *path)
{
    lc_jail *jail;
    lc_error err = {""};
    lc_status status = lc_jail_open(&jail, path, NULL, NULL, &err);
    ck_assert_msg(status == LC_OK, "%s", err.text);
    return jail;
}

static const lc_estimator *find(const char *name)
{
    const lc_estimator *const *e = lc_estimators;
    while (strcmp((*e)->name, name) != 0)
        ++e;
    return *e;
}

/* Grown in two steps, the first no whole block, by any number of workers, whole or as a shard. */
static void compare(const char *name, const char *scene_name, int width, int height, int workers,
                    int shard, int shards, int costs)
{
    char path[64];
    snprintf(path, sizeof path, "estimators/%s.c", name);
    const lc_estimator *e = find(name);
    lc_jail *jail = open_honest(path);
    lc_scene *scene = load(scene_name);
    lc_film *ours = make_film(width, height), *theirs = make_film(width, height);
    lc_error err = {""};
    for (int step = 0; step < 2; ++step) {
        lc_render_options o = {.max_bounces = e->max_bounces < 4 ? e->max_bounces : 4,
                               .seed = 7,
                               .arm = 3,
                               .first = step ? 70 : 0,
                               .count = step ? 129 : 70,
                               .threads = workers,
                               .shard = shard,
                               .shards = shards,
                               .costs = costs};
        ck_assert_int_eq(lc_render(ours, scene, e, &o, NULL), LC_OK);
        lc_status status = lc_render(theirs, scene, lc_jail_estimator(jail), &o, &err);
        ck_assert_msg(status == LC_OK, "%s: %s", path, err.text);
        ck_assert_int_eq(lc_jail_last(jail)->code, LC_JAIL_AC);
    }
    ck_assert_mem_eq(ours->pixels, theirs->pixels, sizeof *ours->pixels * (size_t)width * (size_t)height);
    ck_assert_uint_eq(ours->count, theirs->count);
    ck_assert_uint_eq(ours->seed, theirs->seed);
    ck_assert_int_eq(ours->shards, theirs->shards);
    ck_assert_str_eq(ours->estimator, theirs->estimator);
    ck_assert_uint_eq(theirs->bad, 0);
    const lc_estimator *d = lc_jail_estimator(jail);
    ck_assert_uint_eq(d->lobes, e->lobes);
    ck_assert_uint_eq(d->emitters, e->emitters);
    ck_assert_int_eq(d->max_bounces, e->max_bounces);
    ck_assert_str_eq(d->summary, e->summary);
    ck_assert_str_eq(d->source, e->source);
    lc_film_free(ours);
    lc_film_free(theirs);
    lc_scene_free(scene);
    lc_jail_close(jail);
    check_clean(path);
}

START_TEST(test_jail_same_bits)
{
    compare("path", "cornell", 20, 13, 1, 0, 1, 0);
    compare("path", "furnace_checker", 33, 9, 3, 0, 0, 0);
    compare("light_direct", "mixed_lights", 16, 16, 2, 1, 3, 0);
    compare("dielectric", "glass_blend", 9, 30, 2, 0, 1, 0);
    compare("path", "cornell", 20, 13, 2, 0, 1, 1); /* what samples cost */
}
END_TEST

static void write_source(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    ck_assert_ptr_nonnull(file);
    ck_assert_int_ge(fputs(text, file), 0);
    ck_assert_int_eq(fclose(file), 0);
}

#define PLUGIN(body) \
    "#include \"lightcheck.h\"\n#include <stdio.h>\n#include <assert.h>\n" \
    "static lc_rgb radiance(const lc_scene *s, const lc_ray *r, const lc_hit *h, const lc_options *o, lc_sampler *m)\n" \
    "{\n" body "    return lc_emission(s, h);\n}\n" \
    "LC_ESTIMATOR(kept) = {LC_ABI, \"kept\", \"x\", \"y\", LC_DIFFUSE, LC_AREA, 1, radiance};\n"

/* Differences, with bad samples among them: the same film as of the same file in the open, and the same first bad sample. */
START_TEST(test_jail_differences)
{
    char path[128];
    lc_error err = {""};
    const lc_estimator *open;
    lc_scene *scene = load("cornell"), *other = load("cornell_small");
    const lc_term terms[2] = {{other, 0.5, 0}, {scene, 0.25, 1}};
    lc_render_options o = {
        .min_bounces = 1, .max_bounces = 1, .seed = 9, .count = 80, .threads = 3, .minus = terms, .minus_count = 2};
    lc_film *ours = make_film(17, 12), *theirs = make_film(17, 12);
    snprintf(path, sizeof path, "%s/kept.c", folder);
    write_source(path, PLUGIN("double u = lc_next(m); if (u < 0.001) return lc_color(0, NAN, 0);\n"
                              "if (u < 0.5) return lc_color(u, 2 * u, 1);\n"));
    ck_assert_msg(lc_plugin_load(&open, path, NULL, 0, &err) == LC_OK, "%s", err.text);
    lc_jail *jail = open_honest(path);
    ck_assert_int_eq(lc_render(ours, scene, open, &o, &err), LC_OK);
    ck_assert_msg(lc_render(theirs, scene, lc_jail_estimator(jail), &o, &err) == LC_OK, "%s", err.text);
    ck_assert_mem_eq(ours->pixels, theirs->pixels, sizeof *ours->pixels * 17 * 12);
    ck_assert_uint_gt(ours->bad, 0);
    ck_assert_uint_eq(ours->bad, theirs->bad);
    ck_assert_uint_eq(ours->bad_sample, theirs->bad_sample);
    ck_assert_int_eq(ours->bad_x, theirs->bad_x);
    ck_assert_int_eq(ours->bad_y, theirs->bad_y);
    lc_jail_close(jail);
    lc_film_free(ours);
    lc_film_free(theirs);
    lc_scene_free(scene);
    lc_scene_free(other);
    check_clean("differences");
}
END_TEST

/* C++, words for a person, a NaN with its place, a failed assertion: what happens to honest people. */
START_TEST(test_jail_honest_faults)
{
    char path[128];
    lc_error err = {""};
    lc_scene *scene = load("cornell");
    lc_render_options o = {.max_bounces = 1, .count = 2, .threads = 1};
    lc_film *film = make_film(8, 8);
    snprintf(path, sizeof path, "%s/kept.cpp", folder);
    write_source(path, PLUGIN("if (lc_next(m) < 0) throw 1;\n"));
    lc_jail *jail = open_honest(path);
    ck_assert_msg(lc_render(film, scene, lc_jail_estimator(jail), &o, &err) == LC_OK, "%s", err.text);
    lc_jail_close(jail);
    lc_film_free(film);

    film = make_film(8, 8);
    snprintf(path, sizeof path, "%s/kept.c", folder);
    write_source(path, PLUGIN("static int n; if (n++ == 5) { printf(\"five\\n\"); return lc_color(NAN, 0, 0); }\n"));
    jail = open_honest(path);
    ck_assert_msg(lc_render(film, scene, lc_jail_estimator(jail), &o, &err) == LC_OK, "%s", err.text);
    ck_assert_uint_eq(film->bad, 1);
    ck_assert_int_eq(film->bad_x, 2);
    ck_assert_int_eq(film->bad_y, 0);
    ck_assert_uint_eq(film->bad_sample, 1);
    ck_assert_str_eq(lc_jail_said(jail), "five\n");
    lc_jail_close(jail);
    lc_film_free(film);

    film = make_film(8, 8);
    write_source(path, PLUGIN("assert(!s);\n"));
    jail = open_honest(path);
    ck_assert_int_eq(lc_render(film, scene, lc_jail_estimator(jail), &o, &err), LC_WRONG);
    ck_assert_int_eq(lc_jail_last(jail)->code, LC_JAIL_RTE);
    ck_assert_ptr_nonnull(strstr(lc_jail_said(jail), "Assertion `!s' failed"));
    lc_jail_close(jail);
    lc_film_free(film);
    lc_scene_free(scene);
    check_clean("honest");
}
END_TEST

/* ---- cheats ------------------------------------------------------------------------------------------------------- */

/* What becomes of each. AC: all samples came, and the judge finds them wrong. */
static const struct {
    const char *name;
    lc_jail_code code;
} cheats[] = {
    {"exit_at_once", LC_JAIL_IR},     {"exit_midway", LC_JAIL_IR},         {"fake_report", LC_JAIL_IR},
    {"print_pass", LC_JAIL_AC},       {"forge_samples", LC_JAIL_CE},       {"close_pipe", LC_JAIL_IR},
    {"catch_crash", LC_JAIL_AC},      {"exit_on_crash", LC_JAIL_IR},       {"host_symbols", LC_JAIL_AC},
    {"link_host", LC_JAIL_CE},        {"own_memory_file", LC_JAIL_AC},     {"parent_memory", LC_JAIL_RTE},
    {"read_files", LC_JAIL_AC},       {"list_folders", LC_JAIL_AC},        {"write_file", LC_JAIL_AC},
    {"remove_file", LC_JAIL_RTE},     {"include_secret", LC_JAIL_CE},      {"include_process", LC_JAIL_CE},
    {"incbin_secret", LC_JAIL_CE},    {"environment", LC_JAIL_AC},         {"descriptors", LC_JAIL_AC},
    {"loop", LC_JAIL_TLE},            {"loop_in_constructor", LC_JAIL_TLE}, {"sleep", LC_JAIL_RTE},
    {"stop", LC_JAIL_RTE},            {"fork_bomb", LC_JAIL_RTE},          {"threads", LC_JAIL_RTE},
    {"memory", LC_JAIL_MLE},          {"stack", LC_JAIL_RTE},              {"flood", LC_JAIL_OLE},
    {"network", LC_JAIL_RTE},         {"trace", LC_JAIL_RTE},              {"kill_all", LC_JAIL_RTE},
    {"shell", LC_JAIL_RTE},           {"raise_limits", LC_JAIL_RTE},       {"other_gate", LC_JAIL_RTE},
    {"become_root", LC_JAIL_RTE},     {"giant_object", LC_JAIL_CE},        {"giant_messages", LC_JAIL_CE},
    {"include_itself", LC_JAIL_CE},   {"bad_descriptor", LC_JAIL_RTE},     {"long_name", LC_JAIL_CE},
    {"not_a_number", LC_JAIL_AC},     {"constant", LC_JAIL_AC},
    {"huge", LC_JAIL_AC},             {"trap", LC_JAIL_RTE},               {"trap_in_constructor", LC_JAIL_RTE},
    {"trap_flag", LC_JAIL_RTE},       {"wait_for_itself", LC_JAIL_AC},
};
enum { CHEATS = sizeof cheats / sizeof cheats[0] };

/* The judge on what came: a right estimator passes here. */
static int earns_a_pass(const lc_film *film, const lc_film *right)
{
    lc_row row;
    memset(&row, 0, sizeof row);
    lc_status status = lc_compare_films(&row, film, right, 0.05, 1e-6, 1e-6, NULL);
    return film->bad == 0 && status == LC_OK && row.verdict == LC_ROW_PASS;
}

static void check_quiet(const char *name, const char *text)
{
    ck_assert_msg(!strstr(text, "BROKE") && !strstr(text, "root:") && !strstr(text, "daemon"), "%s: %s", name, text);
}

enum { SIDE = 24, SAMPLES = 256 };

static void contain(const lc_scene *scene, const lc_film *right, int i, const lc_jail_options *options)
{
    char path[128];
    const char *name = cheats[i].name;
    lc_jail *jail;
    lc_jail_verdict why;
    lc_error err = {""};
    snprintf(path, sizeof path, "verify/tests/cheats/%s.c", name);
    lc_status status = lc_jail_open(&jail, path, options, &why, &err);
    if (status == LC_OK) {
        lc_film *film = make_film(SIDE, SIDE);
        lc_render_options o = {.max_bounces = 1, .count = SAMPLES, .threads = 1};
        status = lc_render(film, scene, lc_jail_estimator(jail), &o, &err);
        why = *lc_jail_last(jail);
        ck_assert_msg(status != LC_OK || !earns_a_pass(film, right), "%s: passes", name);
        check_quiet(name, lc_jail_said(jail));
        check_quiet(name, lc_jail_messages(jail));
        lc_film_free(film);
        lc_jail_close(jail);
    }
    ck_assert_msg(why.code == cheats[i].code, "%s: %s, expected %s: %s", name, lc_jail_code_name(why.code),
                  lc_jail_code_name(cheats[i].code), err.text);
    check_quiet(name, err.text);
    check_clean(name);
}

static void contain_all(unsigned parts)
{
    lc_scene *scene = load("plane_rectangle");
    lc_jail_options options;
    lc_jail_options_init(&options);
    options.cpu_seconds = 1;
    options.memory = 64 << 20;
    options.any_symbol = 1; /* the walls are under test, not the sign on the door */
    lc_film *right = make_film(SIDE, SIDE), *honest = make_film(SIDE, SIDE);
    lc_render_options o = {.max_bounces = 1, .count = SAMPLES, .arm = 5, .threads = 1};
    ck_assert_int_eq(lc_render(right, scene, find("light_direct"), &o, NULL), LC_OK);
    lc_jail *jail = open_honest("estimators/light_direct.c");
    o.arm = 6;
    ck_assert_int_eq(lc_render(honest, scene, lc_jail_estimator(jail), &o, NULL), LC_OK);
    ck_assert(earns_a_pass(honest, right));
    ck_assert_msg(lc_jail_parts(jail) == parts, "%s", lc_jail_level(jail));
    lc_jail_close(jail);
    for (int i = 0; i < CHEATS; ++i)
        contain(scene, right, i, &options);
    lc_film_free(right);
    lc_film_free(honest);
    lc_scene_free(scene);
}

/* The C library has it, and no header of POSIX. */
extern int setgroups(size_t count, const gid_t *groups);

static void become_nobody(void)
{
    ck_assert_int_eq(chown(folder, 65534, 65534), 0);
    ck_assert_int_eq(setgroups(0, NULL), 0);
    ck_assert_int_eq(setgid(65534), 0);
    ck_assert_int_eq(setuid(65534), 0);
}

START_TEST(test_jail_cheats) { contain_all(geteuid() == 0 ? LC_JAIL_ALL : LC_JAIL_ALL & ~(unsigned)LC_JAIL_USER); }
END_TEST

START_TEST(test_jail_cheats_nobody)
{
    become_nobody();
    contain_all(LC_JAIL_ALL & ~(unsigned)LC_JAIL_USER);
}
END_TEST

START_TEST(test_jail_cheats_docker)
{
    ck_assert(lc_test_become_docker());
    contain_all(LC_JAIL_ALL);
}
END_TEST

/* Every file there is in the table. */
START_TEST(test_jail_all_cheats)
{
    int count = 0;
    DIR *dir = opendir("verify/tests/cheats");
    ck_assert_ptr_nonnull(dir);
    for (struct dirent *e = readdir(dir); e; e = readdir(dir))
        count += strstr(e->d_name, ".c") != NULL;
    closedir(dir);
    ck_assert_int_eq(count, CHEATS);
}
END_TEST

/* ---- doors --------------------------------------------------------------------------------------------------------- */

START_TEST(test_jail_symbols)
{
    static const char *const right[] = {"lc_next\nsqrt\nfmaf\nmemcpy\nprintf\n", "__stack_chk_fail\ncosl\n", ""};
    static const char *const wrong[] = {"sqrt\nfork\n", "rand\n", "system", "sqr\n", "lcx\n", "f\n", "open\n"};
    lc_error err = {""};
    for (size_t i = 0; i < sizeof right / sizeof right[0]; ++i)
        ck_assert_msg(lc_symbols_check(right[i], "x.c", &err) == LC_OK, "%s", err.text);
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; ++i)
        ck_assert_msg(lc_symbols_check(wrong[i], "x.c", &err) == LC_BAD_INPUT, "%s", wrong[i]);
    lc_jail *jail;
    lc_jail_verdict why;
    ck_assert_int_eq(lc_jail_open(&jail, "verify/tests/cheats/fork_bomb.c", NULL, &why, &err), LC_BAD_INPUT);
    ck_assert_int_eq(why.code, LC_JAIL_CE);
    ck_assert_ptr_nonnull(strstr(why.text, "uses `fork`"));
    check_clean("symbols");
}
END_TEST

/* A hand-in that is a link leads the compiler to somebody else's file. */
START_TEST(test_jail_links)
{
    char secret[128], path[128];
    lc_jail *jail;
    lc_jail_verdict why;
    lc_error err = {""};
    snprintf(secret, sizeof secret, "%s/kept_secret.c", folder);
    snprintf(path, sizeof path, "%s/kept_link.c", folder);
    write_source(secret, "BROKE OUT\n");
    ck_assert_int_eq(symlink(secret, path), 0);
    ck_assert_int_eq(lc_jail_open(&jail, path, NULL, &why, &err), LC_BAD_INPUT);
    ck_assert_ptr_nonnull(strstr(err.text, "no link"));
    check_quiet("link", err.text);
    ck_assert_int_eq(unlink(path), 0);
    ck_assert_int_eq(mkfifo(path, 0600), 0);
    ck_assert_int_eq(lc_jail_open(&jail, path, NULL, &why, &err), LC_BAD_INPUT);
    snprintf(secret, sizeof secret, "#include \"%s/kept_secret.c\"\n", folder);
    ck_assert_int_eq(unlink(path), 0);
    write_source(path, secret);
    ck_assert_int_eq(lc_jail_open(&jail, path, NULL, &why, &err), LC_BAD_INPUT);
    check_quiet("include", err.text);
    check_clean("links");
}
END_TEST

/* Without its wall a cheat breaks out, and is heard: the tests above can fail. */
static void break_out(const char *name, unsigned without)
{
    char path[128];
    lc_jail *jail;
    lc_jail_options options;
    lc_error err = {""};
    lc_scene *scene = load("plane_rectangle");
    lc_film *film = make_film(8, 8);
    lc_render_options o = {.max_bounces = 1, .count = 1, .threads = 1};
    snprintf(path, sizeof path, "verify/tests/cheats/%s.c", name);
    lc_jail_options_init(&options);
    options.parts &= ~without;
    options.any_symbol = 1;
    ck_assert_msg(lc_jail_open(&jail, path, &options, NULL, &err) == LC_OK, "%s", err.text);
    ck_assert_int_eq(lc_render(film, scene, lc_jail_estimator(jail), &o, &err), LC_OK);
    ck_assert_msg(strstr(lc_jail_said(jail), "BROKE OUT"), "%s: %s", name, lc_jail_said(jail));
    lc_film_free(film);
    lc_scene_free(scene);
    lc_jail_close(jail);
}

START_TEST(test_jail_walls)
{
    break_out("read_files", LC_JAIL_LANDLOCK);
    break_out("network", LC_JAIL_SECCOMP);
    break_out("trace", LC_JAIL_SECCOMP);
    check_clean("walls");
}
END_TEST

/* What is missing is said; without walls nothing runs, and that is our fault, not the file's. */
START_TEST(test_jail_levels)
{
    static const struct {
        unsigned parts;
        const char *level;
    } rows[] = {
        {LC_JAIL_LIMITS | LC_JAIL_SECCOMP, "limits, seccomp; without: Landlock, another user"},
        {LC_JAIL_LIMITS | LC_JAIL_LANDLOCK, "limits, Landlock; without: seccomp, another user"},
    };
    lc_jail *jail;
    lc_jail_options options;
    lc_jail_verdict why;
    lc_error err = {""};
    lc_jail_options_init(&options);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        options.parts = rows[i].parts;
        ck_assert_msg(lc_jail_open(&jail, "estimators/path.c", &options, &why, &err) == LC_OK, "%s", err.text);
        ck_assert_str_eq(lc_jail_level(jail), rows[i].level);
        lc_jail_close(jail);
    }
    options.parts = LC_JAIL_LIMITS;
    ck_assert_int_eq(lc_jail_open(&jail, "estimators/path.c", &options, &why, &err), LC_FAULT);
    ck_assert_int_eq(why.code, LC_JAIL_IE);
    check_clean("levels");
}
END_TEST

/* ---- signals from outside -------------------------------------------------------------------------------------------- */

/* The worker of `parent`: its child that is not this process; 0 where there is none yet. */
static pid_t worker_of(pid_t parent)
{
    char path[64];
    int child = 0;
    snprintf(path, sizeof path, "/proc/%d/task/%d/children", (int)parent, (int)parent);
    FILE *file = fopen(path, "r");
    ck_assert_ptr_nonnull(file);
    while (fscanf(file, "%d", &child) == 1 && child == (int)getpid())
        child = 0;
    fclose(file);
    return child;
}

/* In a process of its own: kills the worker of `parent` once it computes. */
static void strike(pid_t parent, int number)
{
    const struct timespec pause = {0, 700000000};
    pid_t worker = 0;
    while (worker == 0)
        worker = worker_of(parent);
    nanosleep(&pause, NULL);
    kill(worker, number);
    _exit(0);
}

/* Whoever kills a worker, as a machine without memory does, is not the file; a file under seccomp cannot do that to itself. Without
 * seccomp it can, so that nothing is believed there. */
START_TEST(test_jail_killed_from_outside)
{
    static const struct {
        int number;
        unsigned without;
        lc_jail_code code;
    } blows[] = {{SIGKILL, 0, LC_JAIL_IE}, {SIGTERM, 0, LC_JAIL_IE}, {SIGHUP, 0, LC_JAIL_IE}, {SIGSTOP, 0, LC_JAIL_IE},
                 {SIGKILL, LC_JAIL_SECCOMP, LC_JAIL_RTE}};
    lc_scene *scene = load("plane_rectangle");
    lc_film *film = make_film(8, 8);
    lc_render_options o = {.max_bounces = 1, .count = 1, .threads = 1};
    lc_error err = {""};
    for (size_t i = 0; i < sizeof blows / sizeof blows[0]; ++i) {
        lc_jail *jail;
        lc_jail_options options;
        lc_jail_options_init(&options);
        options.parts &= ~blows[i].without;
        options.cpu_seconds = 20;
        options.wall_seconds = blows[i].number == SIGSTOP ? 7 : 600; /* longer than any patience with one that sleeps */
        ck_assert_int_eq(lc_jail_open(&jail, "verify/tests/cheats/loop.c", &options, NULL, &err), LC_OK);
        pid_t parent = getpid(), killer = fork();
        if (killer == 0)
            strike(parent, blows[i].number);
        lc_status status = lc_render(film, scene, lc_jail_estimator(jail), &o, &err);
        ck_assert_int_eq(waitpid(killer, NULL, 0), killer);
        ck_assert_msg(lc_jail_last(jail)->code == blows[i].code, "signal %d: %s", blows[i].number, err.text);
        ck_assert_int_eq(status, blows[i].code == LC_JAIL_IE ? LC_FAULT : LC_WRONG);
        lc_jail_close(jail);
    }
    lc_film_free(film);
    lc_scene_free(scene);
    check_clean("killed");
}
END_TEST

/* Without seccomp a file can sleep: it is told from one that gets no processor, long before the clock is at its limit. */
START_TEST(test_jail_sleeps)
{
    lc_jail *jail;
    lc_jail_options options;
    lc_error err = {""};
    lc_scene *scene = load("plane_rectangle");
    lc_film *film = make_film(16, 16);
    lc_render_options o = {.max_bounces = 1, .count = 1, .threads = 3};
    lc_jail_options_init(&options);
    options.parts &= ~(unsigned)LC_JAIL_SECCOMP;
    options.any_symbol = 1;
    ck_assert_int_eq(lc_jail_open(&jail, "verify/tests/cheats/sleep.c", &options, NULL, &err), LC_OK);
    ck_assert_int_eq(lc_render(film, scene, lc_jail_estimator(jail), &o, &err), LC_WRONG);
    ck_assert_int_eq(lc_jail_last(jail)->code, LC_JAIL_TLE);
    ck_assert_msg(strstr(err.text, "of waiting for what does not come"), "%s", err.text);
    ck_assert_double_lt(lc_jail_last(jail)->cpu_seconds, 1);
    lc_jail_close(jail);
    lc_film_free(film);
    lc_scene_free(scene);
    check_clean("sleeps");
}
END_TEST

/* Workers side by side have one limit of time together, and what it takes to start them is not the file's. */
START_TEST(test_jail_time_is_of_all)
{
    static const int workers[] = {1, 2, 8};
    char path[128];
    double first = 0;
    lc_error err = {""};
    lc_scene *scene = load("cornell");
    snprintf(path, sizeof path, "%s/kept.c", folder);
    write_source(path, PLUGIN("for (volatile int i = 0; i < 20000; ++i) {}\n"));
    for (int i = 0; i < 6; ++i) { /* once with time enough, once with less than it takes */
        lc_jail *jail = open_honest(path);
        lc_film *film = make_film(64, 64);
        lc_render_options o = {.max_bounces = 1, .count = 8, .threads = workers[i % 3]};
        lc_jail_set_cpu(jail, i < 3 ? 100 : 0.4 * first);
        lc_status status = lc_render(film, scene, lc_jail_estimator(jail), &o, &err);
        double cpu = lc_jail_last(jail)->cpu_seconds;
        if (i == 0)
            first = cpu;
        ck_assert_msg(status == (i < 3 ? LC_OK : LC_WRONG), "%d workers: %s", o.threads, err.text);
        ck_assert_int_eq(lc_jail_last(jail)->code, i < 3 ? LC_JAIL_AC : LC_JAIL_TLE);
        ck_assert_msg(i >= 3 || (cpu > 0.5 * first && cpu < 2 * first), "%d workers: %g s, one: %g s", o.threads, cpu, first);
        ck_assert_double_eq_tol(lc_jail_cpu_left(jail), (i < 3 ? 100 : 0.4 * first) - cpu, 1e-9);
        lc_jail_close(jail);
        lc_film_free(film);
    }
    lc_scene_free(scene);
    check_clean("time");
}
END_TEST

/* ---- the program --------------------------------------------------------------------------------------------------- */

static int run(char *said, size_t size, const char *arguments)
{
    char command[1024];
    const char *program = getenv("LIGHTCHECK");
    snprintf(command, sizeof command, "%s %s 2>&1", program ? program : "build/lightcheck", arguments);
    FILE *pipe = popen(command, "r");
    ck_assert_ptr_nonnull(pipe);
    said[fread(said, 1, size - 1, pipe)] = 0;
    int status = pclose(pipe);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

START_TEST(test_jail_verify)
{
    static char said[1 << 16];
    const char *rest = "--jail -c analytic --scene plane_rectangle";
    char line[256];
    snprintf(line, sizeof line, "verify -e estimators/light_direct.c %s", rest);
    ck_assert_msg(run(said, sizeof said, line) == 0, "%s", said);
    ck_assert_msg(strstr(said, "in a jail: limits, seccomp, Landlock"), "%s", said);
    snprintf(line, sizeof line, "verify -e verify/tests/cheats/print_pass.c %s", rest);
    ck_assert_msg(run(said, sizeof said, line) == LC_UNDECIDED, "%s", said);
    snprintf(line, sizeof line, "verify -e verify/tests/cheats/not_a_number.c %s", rest);
    ck_assert_msg(run(said, sizeof said, line) == 1, "%s", said);
    ck_assert_msg(strstr(said, "-e verify/tests/cheats/not_a_number.c --jail"), "%s", said);
    snprintf(line, sizeof line, "verify -e verify/tests/cheats/stack.c %s", rest);
    ck_assert_msg(run(said, sizeof said, line) == 1, "%s", said);
    ck_assert_msg(strstr(said, "RTE: it used memory"), "%s", said);
    snprintf(line, sizeof line, "verify -e verify/tests/cheats/include_secret.c %s", rest);
    ck_assert_msg(run(said, sizeof said, line) == 2, "%s", said);
    ck_assert_int_eq(run(said, sizeof said, "verify -e path --jail"), 2);
    check_clean("verify");
}
END_TEST

/* A program without its worker is broken: exit status 4, no verdict. */
START_TEST(test_jail_no_worker)
{
    static char said[1 << 14];
    char line[256];
    const char *program = getenv("LIGHTCHECK");
    snprintf(line, sizeof line, "cp %s %s/kept && ln -s $PWD/scenes %s/kept_scenes", program ? program : "build/lightcheck",
             folder, folder);
    ck_assert_int_eq(system(line), 0);
    snprintf(line, sizeof line, "list checks > /dev/null; exec %s/kept verify -e estimators/path.c --jail", folder);
    ck_assert_msg(run(said, sizeof said, line) == LC_FAULT, "%s", said);
    ck_assert_msg(strstr(said, "lightcheck-worker is missing"), "%s", said);
}
END_TEST

Suite *lc_suite_jail(void)
{
    Suite *suite = suite_create("jail");
    TCase *tcase = tcase_create("jail");
    tcase_set_timeout(tcase, 300);
    tcase_add_checked_fixture(tcase, set_up, tear_down);
    tcase_add_test(tcase, test_jail_all_cheats);
    tcase_add_test(tcase, test_jail_symbols);
#ifndef __SANITIZE_ADDRESS__ /* which needs more of the system than a worker has */
    tcase_add_test(tcase, test_jail_same_bits);
    tcase_add_test(tcase, test_jail_differences);
    tcase_add_test(tcase, test_jail_honest_faults);
    tcase_add_test(tcase, test_jail_links);
    tcase_add_test(tcase, test_jail_walls);
    tcase_add_test(tcase, test_jail_levels);
    tcase_add_test(tcase, test_jail_killed_from_outside);
    tcase_add_test(tcase, test_jail_sleeps);
    tcase_add_test(tcase, test_jail_time_is_of_all);
    tcase_add_test(tcase, test_jail_verify);
    tcase_add_test(tcase, test_jail_no_worker);
    tcase_add_test(tcase, test_jail_cheats);
    if (geteuid() == 0) {
        tcase_add_test(tcase, test_jail_cheats_nobody);
        tcase_add_test(tcase, test_jail_cheats_docker);
    }
#endif
    suite_add_tcase(suite, tcase);
    return suite;
}
