/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Output files: whole or absent, whatever goes wrong. */
#include "verify/tests/tests.h"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/outfile.h"

int lc_test_drop_root(uid_t *before)
{
    *before = geteuid();
    return *before != 0 || seteuid(65534) == 0;
}

void lc_test_restore_root(uid_t before)
{
    if (geteuid() != before)
        ck_assert_int_eq(seteuid(before), 0);
}

static char folder[64], target[80];

static void make_folder(void)
{
    strcpy(folder, "/tmp/lightcheck-test-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(target, sizeof target, "%s/out", folder);
}

static int count_entries(void)
{
    int count = -2; /* . and .. */
    DIR *dir = opendir(folder);
    ck_assert_ptr_nonnull(dir);
    while (readdir(dir))
        ++count;
    closedir(dir);
    return count;
}

static void remove_folder(void)
{
    unlink(target);
    ck_assert_int_eq(count_entries(), 0);
    ck_assert_int_eq(rmdir(folder), 0);
}

static void ck_content(const char *path, const char *expected)
{
    char text[64] = "";
    FILE *file = fopen(path, "rb");
    ck_assert_ptr_nonnull(file);
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
    ck_assert_str_eq(text, expected);
}

static void write_text(const char *path, const char *text)
{
    lc_error err;
    lc_outfile *file;
    ck_assert_msg(lc_outfile_open(&file, path, &err) == LC_OK, "%s", err.text);
    ck_assert_int_ge(fputs(text, lc_outfile_stream(file)), 0);
    ck_assert_msg(lc_outfile_commit(file, &err) == LC_OK, "%s", err.text);
}

START_TEST(commit_replaces_abort_does_not)
{
    lc_outfile *file;
    struct stat st;
    mode_t mask = umask(027);
    write_text(target, "first");
    ck_assert_int_eq(stat(target, &st), 0);
    ck_assert_int_eq(st.st_mode & 0777, 0640);
    umask(mask);
    ck_assert_int_eq(chmod(target, 0604), 0);
    write_text(target, "second");
    ck_assert_int_eq(stat(target, &st), 0);
    ck_assert_int_eq(st.st_mode & 0777, 0604);
    ck_assert_int_eq(lc_outfile_open(&file, target, NULL), LC_OK);
    fputs("third", lc_outfile_stream(file));
    ck_content(target, "second"); /* untouched until the commit */
    lc_outfile_abort(file);
    lc_outfile_abort(NULL);
    ck_content(target, "second");
    ck_assert_int_eq(count_entries(), 1);
}
END_TEST

START_TEST(several_files_at_once)
{
    lc_outfile *a, *b;
    ck_assert_int_eq(lc_outfile_open(&a, target, NULL), LC_OK);
    ck_assert_int_eq(lc_outfile_open(&b, target, NULL), LC_OK);
    ck_assert_int_eq(lc_outfile_write(a, "a", 1, NULL), LC_OK);
    ck_assert_int_eq(lc_outfile_write_at(b, 3, "d", 1, NULL), LC_OK);
    ck_assert_int_eq(lc_outfile_write_at(b, 0, "bbb", 3, NULL), LC_OK);
    ck_assert_int_eq(lc_outfile_commit(a, NULL), LC_OK);
    ck_content(target, "a");
    ck_assert_int_eq(lc_outfile_commit(b, NULL), LC_OK);
    ck_content(target, "bbbd");
}
END_TEST

START_TEST(a_link_stays_a_link)
{
    char link[96], real[96];
    struct stat st;
    snprintf(link, sizeof link, "%s/link", folder);
    ck_assert_int_eq(symlink("out", link), 0); /* dangling at first */
    write_text(link, "one");
    write_text(link, "two");
    ck_content(target, "two");
    ck_assert_int_eq(lstat(link, &st), 0);
    ck_assert(S_ISLNK(st.st_mode));
    ck_assert_int_eq(unlink(link), 0);
    snprintf(real, sizeof real, "%s/loop", folder);
    ck_assert_int_eq(symlink("loop", real), 0);
    lc_outfile *file;
    ck_assert_int_eq(lc_outfile_open(&file, real, NULL), LC_FAULT);
    ck_assert_int_eq(unlink(real), 0);
}
END_TEST

START_TEST(open_fails_with_the_reason)
{
    char path[128];
    lc_error err;
    lc_outfile *file;
    ck_assert_int_eq(lc_outfile_open(&file, folder, &err), LC_FAULT);
    ck_assert_ptr_null(file);
    ck_assert_ptr_nonnull(strstr(err.text, "Is a directory"));
    snprintf(path, sizeof path, "%s/none/out", folder);
    ck_assert_int_eq(lc_outfile_open(&file, path, &err), LC_FAULT);
    ck_assert_ptr_nonnull(strstr(err.text, "No such file"));
    ck_assert_ptr_nonnull(strstr(err.text, path));
    snprintf(path, sizeof path, "%s/none/", folder);
    ck_assert_int_eq(lc_outfile_open(&file, path, &err), LC_FAULT);
    ck_assert_int_eq(lc_outfile_open(&file, "", &err), LC_FAULT);
    write_text(target, "x");
    snprintf(path, sizeof path, "%s/out", target);
    ck_assert_int_eq(lc_outfile_open(&file, path, &err), LC_FAULT);
    ck_assert_ptr_nonnull(strstr(err.text, "Not a directory"));
}
END_TEST

START_TEST(what_is_protected_stays)
{
    lc_error err;
    lc_outfile *file;
    write_text(target, "precious");
    ck_assert_int_eq(chmod(target, 0444), 0);
    ck_assert_int_eq(chmod(folder, 0777), 0);
    uid_t us;
    if (!lc_test_drop_root(&us)) /* root may write anything */
        return;
    lc_status protected_file = lc_outfile_open(&file, target, &err);
    lc_status protected_folder = lc_outfile_open(&file, "/etc/lightcheck-test", &err);
    lc_test_restore_root(us);
    ck_assert_int_eq(protected_file, LC_FAULT);
    ck_assert_int_eq(protected_folder, LC_FAULT);
    ck_assert_str_eq(err.text, "/etc/lightcheck-test: cannot write: Permission denied");
}
END_TEST

/* 1: noticed while writing; 0: only when the buffer is flushed by the commit. */
START_TEST(a_full_device_is_a_fault)
{
    static char big[1 << 16];
    lc_error err = {""};
    lc_outfile *file;
    size_t size = _i ? sizeof big : 10;
    uid_t us;
    if (!lc_test_drop_root(&us))
        return;
    ck_assert_int_eq(lc_outfile_open(&file, "/dev/full", &err), LC_OK);
    ck_assert_int_eq(lc_outfile_write(file, big, size, &err), _i ? LC_FAULT : LC_OK);
    ck_assert_int_eq(lc_outfile_commit(file, &err), LC_FAULT);
    ck_assert_str_eq(err.text, "/dev/full: cannot write: No space left on device");
    lc_test_restore_root(us);
}
END_TEST

START_TEST(a_file_size_limit_is_a_fault)
{
    static char big[1 << 16];
    const struct rlimit limit = {1000, RLIM_INFINITY};
    lc_error err = {""};
    lc_outfile *file;
    struct rlimit before;
    write_text(target, "old");
    ck_assert_int_eq(lc_outfile_open(&file, target, &err), LC_OK);
    ck_assert_int_eq(getrlimit(RLIMIT_FSIZE, &before), 0);
    signal(SIGXFSZ, SIG_IGN);
    ck_assert_int_eq(setrlimit(RLIMIT_FSIZE, &limit), 0);
    if (_i)
        ck_assert_int_eq(lc_outfile_write(file, big, sizeof big, &err), LC_FAULT);
    else
        ck_assert_uint_eq(fwrite(big, 1, 2000, lc_outfile_stream(file)), 2000); /* fits the buffer */
    lc_status status = lc_outfile_commit(file, &err);
    setrlimit(RLIMIT_FSIZE, &before); /* or Check could not tell what happened */
    ck_assert_int_eq(status, LC_FAULT);
    ck_assert_ptr_nonnull(strstr(err.text, "File too large"));
    ck_content(target, "old");
    ck_assert_int_eq(count_entries(), 1);
}
END_TEST

START_TEST(a_stream_error_that_nobody_saw_is_found_by_the_commit)
{
    lc_outfile *file;
    static char big[1 << 16];
    uid_t us;
    if (!lc_test_drop_root(&us))
        return;
    ck_assert_int_eq(lc_outfile_open(&file, "/dev/full", NULL), LC_OK);
    (void)!fwrite(big, 1, sizeof big, lc_outfile_stream(file));
    ck_assert_int_eq(lc_outfile_commit(file, NULL), LC_FAULT);
    lc_test_restore_root(us);
}
END_TEST

/* No device is at risk here: what is no regular file is written in place, and stays what it was. */
START_TEST(a_fifo_is_written_in_place)
{
    char text[8] = "";
    struct stat st;
    ck_assert_int_eq(mkfifo(target, 0600), 0);
    int fd = open(target, O_RDONLY | O_NONBLOCK);
    ck_assert_int_ge(fd, 0);
    write_text(target, "through");
    ck_assert_int_eq(read(fd, text, sizeof text), 7);
    ck_assert_str_eq(text, "through");
    close(fd);
    ck_assert_int_eq(lstat(target, &st), 0);
    ck_assert(S_ISFIFO(st.st_mode));
    ck_assert_int_eq(count_entries(), 1);
}
END_TEST

START_TEST(a_handler_can_remove_temporaries)
{
    lc_outfile *files[20]; /* more than the table holds */
    for (int i = 0; i < 20; ++i)
        ck_assert_int_eq(lc_outfile_open(&files[i], target, NULL), LC_OK);
    ck_assert_int_eq(count_entries(), 20);
    lc_outfile_unlink_all();
    ck_assert_int_eq(count_entries(), 4);
    for (int i = 0; i < 20; ++i)
        lc_outfile_abort(files[i]);
    ck_assert_int_eq(lc_outfile_open(&files[0], target, NULL), LC_OK); /* places are free again */
    lc_outfile_unlink_all();
    ck_assert_int_eq(count_entries(), 0);
    ck_assert_int_eq(lc_outfile_commit(files[0], NULL), LC_FAULT); /* and nothing is said to be there that is not */
}
END_TEST

Suite *lc_suite_outfile(void)
{
    Suite *suite = suite_create("outfile");
    TCase *tc = tcase_create("outfile");
    tcase_add_checked_fixture(tc, make_folder, remove_folder);
    tcase_add_test(tc, commit_replaces_abort_does_not);
    tcase_add_test(tc, several_files_at_once);
    tcase_add_test(tc, a_link_stays_a_link);
    tcase_add_test(tc, open_fails_with_the_reason);
    tcase_add_test(tc, what_is_protected_stays);
    tcase_add_loop_test(tc, a_full_device_is_a_fault, 0, 2);
    tcase_add_loop_test(tc, a_file_size_limit_is_a_fault, 0, 2);
    tcase_add_test(tc, a_stream_error_that_nobody_saw_is_found_by_the_commit);
    tcase_add_test(tc, a_fifo_is_written_in_place);
    tcase_add_test(tc, a_handler_can_remove_temporaries);
    suite_add_tcase(suite, tc);
    return suite;
}
