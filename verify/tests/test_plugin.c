/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Estimators from a file, as a user has them: `-e FILE.c`, `new`, `sample --gdb`. */
#include "verify/tests/tests.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "verify/grade/plugin.h"

static char folder[64], program[4096], sources[4096], scenes[4096], said[1 << 16];

static void make_absolute(char path[4096], const char *name)
{
    char here[2048];
    ck_assert_ptr_nonnull(getcwd(here, sizeof here));
    snprintf(path, 4096, "%s%s%.2000s", name[0] == '/' ? "" : here, name[0] == '/' ? "" : "/", name);
}

/* A folder of its own, which is the temporary folder as well: so what is left behind is seen. */
static void set_up(void)
{
    const char *name = getenv("LIGHTCHECK");
    strcpy(folder, "/tmp/lightcheck-test-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
    make_absolute(program, name ? name : "build/lightcheck");
    make_absolute(sources, "estimators");
    make_absolute(scenes, "scenes");
    ck_assert_int_eq(chdir(folder), 0);
    ck_assert_int_eq(symlink(scenes, "scenes"), 0); /* a program two folders deep does not find them beside itself */
    ck_assert_int_eq(setenv("TMPDIR", folder, 1), 0);
    ck_assert_int_eq(setenv("LIGHTCHECK", program, 1), 0);
    ck_assert_int_eq(setenv("S", sources, 1), 0);
}

static void tear_down(void)
{
    char command[128];
    snprintf(command, sizeof command, "rm -rf %s", folder);
    ck_assert_int_eq(system(command), 0);
}

/* Runs a line of the shell with L for the program and $S for estimators/; `said` is what it wrote. Its exit status. */
static int run(const char *line)
{
    char command[8192];
    snprintf(command, sizeof command, "L() { \"$LIGHTCHECK\" \"$@\"; }\n{ %s; } 2>&1", line);
    FILE *pipe = popen(command, "r");
    ck_assert_ptr_nonnull(pipe);
    size_t n = fread(said, 1, sizeof said - 1, pipe);
    said[n] = 0;
    int status = pclose(pipe);
    ck_assert_msg(WIFEXITED(status), "%s: ended by a signal", line);
    return WEXITSTATUS(status);
}

static int count_left(void)
{
    int count = 0;
    DIR *dir = opendir(folder);
    for (struct dirent *e = readdir(dir); e; e = readdir(dir))
        count += strncmp(e->d_name, "lightcheck-", 11) == 0;
    closedir(dir);
    return count;
}

static void expect(const char *line, int status, const char *text)
{
    int got = run(line);
    ck_assert_msg(got == status, "%s: exit status %d, expected %d: %s", line, got, status, said);
    ck_assert_msg(strstr(said, text) != NULL, "%s: '%s' is not in: %s", line, text, said);
    ck_assert_int_eq(count_left(), 0);
}

START_TEST(test_plugin_same_bits)
{
    static const char *const names[] = {"path", "light_direct", "dielectric"};
    for (int i = 0; i < 3; ++i) {
        char line[512];
        snprintf(line, sizeof line,
                 "L render glass_blend -e $S/%s.c -s 3 --size 24x24 -o a.exr && L render glass_blend -e %s -s 3 "
                 "--size 24x24 -o b.exr && cmp a.exr b.exr",
                 names[i], names[i]);
        expect(line, 0, names[i]);
    }
}
END_TEST

START_TEST(test_plugin_verify)
{
    expect("L verify -e $S/light_direct.c -c analytic --scene plane_disk", 0, "PASS");
    expect("sed 's/count \\* cos_surface/2 * count * cos_surface/' $S/light_direct.c > twice.c && "
           "L verify -e twice.c -c analytic --scene plane_disk",
           1, " -e twice.c ");
    expect("L sample cornell -e $S/path.c --pixel 30,50 --index 2", 0, "draw 8");
}
END_TEST

/* The line below a row that failed gives the same row, and the one of a bad sample that very sample, whatever the options and the path. */
START_TEST(test_plugin_again)
{
    const char *run_again = "sed -n 's|^ *again: build/lightcheck|L|p' first > again.sh && . ./again.sh > second; "
                            "grep -E ' FAIL  |again:' first > a; grep -E ' FAIL  |again:' second > b; diff a b && grep -c ' FAIL  ' a";
    expect("mkdir \"it's a\" && sed 's/count \\* cos_surface/1.02 * count * cos_surface/' $S/light_direct.c > \"it's a/two.c\"", 0, "");
    expect("L verify -e \"it's a/two.c\" -c analytic --scene plane_disk --margin 0.0125 --budget 0.001 --seed 7 > first", 1, "");
    expect("grep again: first", 0,
           "again: build/lightcheck verify --suite quick -c analytic -e 'it'\\''s a/two.c' --scene plane_disk --seed 7 --margin 0.0125 "
           "--budget 0.001\n");
    expect(run_again, 0, "1\n");
    expect("sed 's/^    lc_rgb sum = lc_black();/    if (options->min_bounces == 1) return lc_color(-1 - lc_next(sampler), 0, 0);\\n&/' "
           "$S/light_direct.c > \"it's a/less.c\" && grep -c lc_color \"it's a/less.c\"", 0, "1\n");
    expect("L render cornell -e \"it's a/less.c\" -s 1 --size 8x8 --min-bounces 1 --bounces 1 -o x.exr > first", 1,
           "see it with `lightcheck sample cornell -e 'it'\\''s a/less.c' --pixel 0,0 --index 0 --seed 1 --bounces 1 --min-bounces 1 "
           "--size 8x8`");
    expect("L render cornell -e \"it's a/less.c\" -s 1 --size 8x8 --min-bounces 1 -o x.exr 2>&1 | "
           "sed -n 's/.*first (\\(-[0-9.]\\{5\\}\\)[^`]*`lightcheck\\([^`]*\\)`.*/\\1\\nL\\2/p' > line; "
           "sed 1d line > again.sh; . ./again.sh | grep -c \"radiance ($(head -n 1 line)\"", 0, "1\n");
}
END_TEST

START_TEST(test_plugin_errors)
{
    expect("L new mine && printf 'int x = y;\\n' >> mine.c; L render cornell -e mine.c", 2, "mine.c:32:9: error:");
    expect("sed 's/LC_ABI,/LC_ABI + 1,/' $S/path.c > abi.c; L render cornell -e abi.c", 2,
           "abi.c: written for interface 2, this program has 1");
    expect("echo 'int x;' > none.c; L render cornell -e none.c", 2, "none.c: defines no estimator");
    expect("L render cornell -e absent.c", 2, "absent.c: cannot read");
    expect("sed 's/\"path\"/\"pa th\"/' $S/path.c > name.c; L render cornell -e name.c", 2, "letters, digits and _");
    expect("sed 's/lc_trace(/lc_intersect(/' $S/path.c > host.c; L render cornell -e host.c", 2, "`lc_intersect`");
    expect("echo nothing > x.so; L render cornell -e x.so", 2, "x.so: cannot load");
}
END_TEST

START_TEST(test_plugin_new)
{
    expect("L new mine", 0, "mine.c");
    expect("L render cornell -e mine.c -s 1 --size 8x8 -o x.exr", 0, "cornell by mine");
    expect("L new mine", 2, "is not overwritten");
    expect("L new 2much", 2, "no name");
    expect("L new ../x", 2, "no name");
    expect("cp mine.c mine.cpp && L render cornell -e mine.cpp -s 1 --size 8x8 -o x.exr", 0, "cornell by mine");
    expect("cp mine.c mine.CXX && L render cornell -e mine.CXX -s 1 --size 8x8 -o x.exr", 0, "cornell by mine");
    expect("sed 's/lc_rgb sum = lc_black();/&\\n    int class = 0;\\n    (void)class;/' mine.c > c.c && L render cornell -e c.c -s 1 --size 8x8 -o x.exr", 0,
           "cornell by mine");
    expect("cp c.c c.C && L render cornell -e c.C -s 1 --size 8x8 -o x.exr", 2, "does not compile"); /* C++ */
}
END_TEST

/* What a plug-in may call is what lightcheck.h declares, and nothing else of the program. */
START_TEST(test_plugin_exports)
{
    expect("for f in $(nm -D --defined-only \"$LIGHTCHECK\" | sed -n 's/.* [TDRB] lc_/lc_/p'); do "
           "grep -q \"^[a-z].*$f(\" $S/../src/core/lightcheck.h && continue; echo $f; exit 9; done",
           0, "");
    expect("nm -D --defined-only \"$LIGHTCHECK\" | grep -c ' lc_render$'", 1, "0");
    expect("nm -D --defined-only \"$LIGHTCHECK\"", 0, " lc_light_sample_union\n");
}
END_TEST

START_TEST(test_plugin_gdb)
{
    expect("PATH=/nowhere L sample cornell -e path --pixel 3,4 --gdb", 2, "no program `gdb`");
    if (run("command -v gdb") == 0)
        expect("cp $S/path.c walk.c; printf 'bt 1\\nprint *options\\n' | L sample cornell -e walk.c --pixel 30,50 --bounces 3 --gdb", 0,
               "{min_bounces = 0, max_bounces = 3}");
    expect("ls /tmp | grep -c lightcheck-gdb", 1, "0");
}
END_TEST

/* The caller dies, even of a signal that nobody can catch: the helper still takes the folder away. */
START_TEST(test_plugin_killed)
{
    static const char *const signals[] = {"KILL", "TERM"};
    for (int i = 0; i < 2; ++i) {
        char line[512];
        snprintf(line, sizeof line,
                 "mkdir -p bin; printf '#!/bin/sh\\necho $$ > %s/pid; sleep 30\\n' > bin/cc; chmod +x bin/cc; rm -f pid; "
                 "L new k%d; (PATH=$PWD/bin:$PATH; exec \"$LIGHTCHECK\" render cornell -e k%d.c) & "
                 "p=$!; while ! [ -s pid ]; do sleep 0.05; done; kill -%s $p; wait $p; n=0; "
                 "while ls -d lightcheck-* && [ $n -lt 200 ]; do sleep 0.05; n=$((n+1)); done; "
                 "kill -0 $(cat pid) && exit 9; true",
                 folder, i, i, signals[i]);
        expect(line, 0, "");
    }
}
END_TEST

Suite *lc_suite_plugin(void)
{
    Suite *suite = suite_create("plugin");
    TCase *tcase = tcase_create("plugin");
    tcase_set_timeout(tcase, 120);
    tcase_add_checked_fixture(tcase, set_up, tear_down);
    tcase_add_test(tcase, test_plugin_same_bits);
    tcase_add_test(tcase, test_plugin_verify);
    tcase_add_test(tcase, test_plugin_again);
    tcase_add_test(tcase, test_plugin_errors);
    tcase_add_test(tcase, test_plugin_new);
    tcase_add_test(tcase, test_plugin_exports);
#ifndef __SANITIZE_ADDRESS__ /* whose search for leaks does not go under a debugger */
    tcase_add_test(tcase, test_plugin_gdb);
#endif
    tcase_add_test(tcase, test_plugin_killed);
    suite_add_tcase(suite, tcase);
    return suite;
}
