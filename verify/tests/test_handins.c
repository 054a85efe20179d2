/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/tests/tests.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "verify/grade/handins.h"

static char folder[64];

static void shell(const char *line)
{
    char command[2048];
    snprintf(command, sizeof command, "cd %s && %s", folder, line);
    ck_assert_int_eq(system(command), 0);
}

static void set_up(void)
{
    strcpy(folder, "/tmp/lightcheck-handins-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
}

static void tear_down(void) { shell("rm -rf \"$PWD\""); }

static const char *at(const char *name)
{
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

START_TEST(test_handins_find)
{
    static const char *const names[] = {"ann", "b.c", "dup", "folder", "link.c", "none", "roster.csv", "z .cpp"};
    lc_handins h;
    lc_error err;
    const char *path = folder;
    shell("touch b.c 'z .cpp' roster.csv .hidden.c; mkdir -p ann/src/deep dup none .git; touch ann/src/deep/x.c ann/a.txt ann/.y.c "
          "dup/1.c dup/2.cc none/a.py .git/g.c; ln -s ../b.c none/link.c; ln -s b.c link.c; ln -s ann folder; "
          "touch -d @1000 ann/src/deep/x.c");
    ck_assert_msg(lc_handins_find(&h, &path, 1, NULL, &err) == LC_OK, "%s", err.text);
    ck_assert_int_eq(h.count, 8);
    for (int i = 0; i < 8; ++i)
        ck_assert_str_eq(h.items[i].name, names[i]);
    ck_assert_str_eq(h.items[0].path, at("ann/src/deep/x.c"));
    ck_assert_int_eq(h.items[0].time, 1000);
    ck_assert_str_eq(h.items[1].path, at("b.c"));
    ck_assert_ptr_null(h.items[2].path);
    ck_assert_ptr_nonnull(strstr(h.items[2].why, "expected one source file, and found 2: "));
    ck_assert_ptr_nonnull(strstr(h.items[5].why, "there is no source file"));
    ck_assert(h.items[3].is_other && h.items[4].is_other && h.items[6].is_other && !h.items[5].is_other);
    ck_assert_str_eq(h.items[4].why, "link.c is a link, and none is followed; expected one source file (.c, .cc, .cpp, .cxx)");
    lc_handins_release(&h);
    ck_assert_int_eq(lc_handins_find_one(&h, at("ann"), &err), LC_OK);
    ck_assert_int_eq(h.count, 1);
    ck_assert_str_eq(h.items[0].name, "ann");
    lc_handins_release(&h);
}
END_TEST

/* Whatever was handed in is there; what systems leave, and the class's own files, is not. */
START_TEST(test_handins_others)
{
    static const char *const names[] = {"BIG.C", "a.c", "eve.ZIP", "late.txt", "pipe", "x.CPP", "y.Cxx", "z.CC"};
    lc_handins h;
    lc_error err;
    char results[256], roster[256];
    const char *path = folder, *const except[] = {strcpy(results, at("results")), strcpy(roster, at("roster.csv")), at("absent"), NULL};
    const lc_handins_options options = {0, 0, except};
    shell("touch a.c BIG.C x.CPP y.Cxx z.CC late.txt eve.ZIP Index.html THUMBS.DB desktop.ini .DS_Store roster.csv; mkfifo pipe; "
          "mkdir results __MACOSX; touch results/a.c __MACOSX/a.c");
    ck_assert_msg(lc_handins_find(&h, &path, 1, &options, &err) == LC_OK, "%s", err.text);
    ck_assert_int_eq(h.count, 8);
    for (int i = 0; i < 8; ++i) {
        ck_assert_str_eq(h.items[i].name, names[i]);
        ck_assert_int_eq(h.items[i].is_other, i >= 2 && i <= 4);
        ck_assert_int_eq(h.items[i].path == NULL, h.items[i].is_other);
    }
    ck_assert_ptr_nonnull(strstr(h.items[2].why, "eve.ZIP is an archive"));
    ck_assert_ptr_nonnull(strstr(h.items[3].why, "late.txt is no source file; expected one source file"));
    ck_assert_ptr_nonnull(strstr(h.items[4].why, "pipe is no regular file"));
    lc_handins_release(&h);
}
END_TEST

/* Only where it is asked for: an adapter runs with all rights of who grades. */
START_TEST(test_handins_adapter)
{
    lc_handins h;
    lc_error err;
    const char *path = folder;
    shell("mkdir -p ann/src bob; touch ann/src/x.c ann/src/y.c ann/adapter.py bob/adapter bob/b.c; chmod +x ann/adapter.py");
    const lc_handins_options with = {1, 0, NULL};
    ck_assert_int_eq(lc_handins_find(&h, &path, 1, &with, &err), LC_OK);
    ck_assert_int_eq(h.count, 2);
    ck_assert_str_eq(h.items[0].path, at("ann/adapter.py"));
    ck_assert(h.items[0].is_adapter && !h.items[1].is_adapter); /* that one is not executable */
    lc_handins_release(&h);
    ck_assert_int_eq(lc_handins_find(&h, &path, 1, NULL, &err), LC_OK);
    ck_assert_ptr_null(h.items[0].path);
    lc_handins_release(&h);
}
END_TEST

/* Images count where they are asked for, and nothing else is there to be graded; the newest tells when. */
START_TEST(test_handins_images)
{
    lc_handins h;
    lc_error err;
    const char *path = folder;
    shell("mkdir -p ann/plane.1 ann/plane.2 bob/plane.1 cy/plane dan/plane.1 eve; touch ann/plane.1/1.exr ann/plane.2/b.exr bob/plane.1/1.exr bob/b.c "
          "cy/plane/1.exr dan/plane.1/1.png; ln -s ../ann/plane.1 eve/plane.1; touch -d @1000 ann/plane.1/1.exr; touch -d @2000 ann/plane.2/b.exr");
    const lc_handins_options with = {0, 1, NULL};
    ck_assert_int_eq(lc_handins_find(&h, &path, 1, &with, &err), LC_OK);
    ck_assert_int_eq(h.count, 5);
    ck_assert_str_eq(h.items[0].path, at("ann"));
    ck_assert_int_eq(h.items[0].time, 2000);
    ck_assert_str_eq(h.items[1].path, at("bob/b.c"));
    for (int i = 0; i < 5; ++i)
        ck_assert_int_eq(h.items[i].is_images, i == 0);
    for (int i = 2; i < 5; ++i)
        ck_assert_ptr_nonnull(strstr(h.items[i].why, "and no folder SCENE.BOUNCES of images (.exr)"));
    lc_handins_release(&h);
    ck_assert_int_eq(lc_handins_find(&h, &path, 1, NULL, &err), LC_OK);
    ck_assert_ptr_null(h.items[0].path);
    lc_handins_release(&h);
}
END_TEST

static void refuses(const char *const *paths, int count, const char *text)
{
    lc_handins h;
    lc_error err;
    ck_assert_int_eq(lc_handins_find(&h, paths, count, NULL, &err), LC_BAD_INPUT);
    ck_assert_msg(strstr(err.text, text) != NULL, "'%s' is not in '%s'", text, err.text);
    ck_assert_int_eq(h.count, 0);
}

START_TEST(test_handins_errors)
{
    char a[256], b[256];
    shell("mkdir x y empty; touch x/a.c y/a.c t.txt");
    strcpy(a, at("x"));
    strcpy(b, at("y/a.c"));
    refuses((const char *const[]){a, b}, 2, "two hand-ins are called a.c");
    refuses((const char *const[]){strcpy(a, at("empty"))}, 1, "no hand-in");
    shell("touch empty/a.txt empty/b.zip");
    refuses((const char *const[]){strcpy(a, at("empty"))}, 1, "no hand-in"); /* a wrong folder, rather than a class */
    refuses((const char *const[]){strcpy(a, at("absent"))}, 1, "cannot read");
    refuses((const char *const[]){strcpy(a, at("t.txt"))}, 1, "expected a source file");
}
END_TEST

Suite *lc_suite_handins(void)
{
    Suite *suite = suite_create("handins");
    TCase *tests = tcase_create("handins");
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, test_handins_find);
    tcase_add_test(tests, test_handins_others);
    tcase_add_test(tests, test_handins_adapter);
    tcase_add_test(tests, test_handins_images);
    tcase_add_test(tests, test_handins_errors);
    suite_add_tcase(suite, tests);
    return suite;
}
