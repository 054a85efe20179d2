/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/tests/tests.h"

#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "verify/grade/pool.h"

static int order[16], ended;

static lc_status note(lc_pool_job *job, lc_error *err)
{
    (void)err;
    order[ended++] = (int)(size_t)job->user;
    return LC_OK;
}

static lc_status refuse(lc_pool_job *job, lc_error *err)
{
    return lc_fail(err, LC_FAULT, "enough after %d", (int)(size_t)job->user);
}

static lc_pool_job shell(const char *const *words, double seconds, size_t number)
{
    const lc_pool_job job = {.words = words, .seconds = seconds, .user = (void *)number};
    return job;
}

/* One that hangs, and has told SIGTERM to be ignored, holds up none of the others. */
START_TEST(test_pool_stuck)
{
    static const char *const stuck[] = {"/bin/sh", "-c", "trap '' TERM; sleep 1000 & while :; do sleep 1000; done", NULL};
    static const char *const quick[] = {"/bin/sh", "-c", "exit 3", NULL}, *const dies[] = {"/bin/sh", "-c", "kill -9 $$", NULL};
    static const char *const absent[] = {"/absent", NULL};
    lc_pool_job jobs[] = {shell(stuck, 0.3, 0), shell(quick, 60, 1), shell(dies, 60, 2), shell(absent, 60, 3), shell(quick, 60, 4)};
    lc_error err;
    ended = 0;
    ck_assert_int_eq(lc_pool_run(jobs, 5, 2, note, &err), LC_OK);
    ck_assert_int_eq(ended, 5);
    for (int i = 0; i < 4; ++i)
        ck_assert_int_eq(order[i], i + 1);
    ck_assert(jobs[0].is_late && jobs[0].signal == SIGKILL && jobs[0].exit_status == -1);
    ck_assert(jobs[0].took > 2 && jobs[0].took < 20);
    ck_assert(!jobs[1].is_late && jobs[1].exit_status == 3 && jobs[4].exit_status == 3);
    ck_assert(!jobs[2].is_late && jobs[2].signal == SIGKILL);
    ck_assert(jobs[3].exit_status == -1 && jobs[3].signal == 0);
}
END_TEST

/* It runs; one that nobody has buried yet does not. */
static int is_alive(int pid)
{
    char path[64], state = 'Z';
    snprintf(path, sizeof path, "/proc/%d/stat", pid);
    FILE *file = fopen(path, "r");
    if (file) {
        ck_assert(fscanf(file, "%*d %*s %c", &state) <= 1);
        fclose(file);
    }
    return state != 'Z';
}

/* What it printed is in its log, and nothing that it started outlives it. */
START_TEST(test_pool_log)
{
    char path[] = "/tmp/lightcheck-pool-XXXXXX", text[64] = "";
    int fd = mkstemp(path), child = 0;
    static const char *const words[] = {"/bin/sh", "-c", "sleep 1000 & echo $!; echo said >&2", NULL};
    lc_pool_job job = shell(words, 60, 0);
    lc_error err;
    job.log = path;
    ended = 0;
    ck_assert_int_eq(lc_pool_run(&job, 1, 4, note, &err), LC_OK);
    ck_assert_int_gt((int)read(fd, text, sizeof text - 1), 0);
    ck_assert_ptr_nonnull(strstr(text, "\nsaid\n"));
    ck_assert_int_eq(sscanf(text, "%d", &child), 1);
    const struct timespec moment = {0, 20000000};
    for (int i = 0; i < 100 && is_alive(child); ++i)
        nanosleep(&moment, NULL);
    ck_assert(!is_alive(child));
    close(fd);
    unlink(path);
}
END_TEST

static int work(void *user)
{
    printf("number %d\n", (int)(size_t)user);
    return 40 + (int)(size_t)user;
}

/* A function of ours, in a process of its own; what the caller had printed is not printed twice. */
START_TEST(test_pool_function)
{
    char path[] = "/tmp/lightcheck-pool-XXXXXX", text[64] = "";
    int fd = mkstemp(path);
    lc_pool_job job = {.run = work, .log = path, .seconds = 60, .user = (void *)2};
    lc_error err;
    printf(" "); /* stays in the buffer */
    ended = 0;
    ck_assert_int_eq(lc_pool_run(&job, 1, 1, note, &err), LC_OK);
    ck_assert_int_eq(job.exit_status, 42);
    ck_assert_int_gt((int)read(fd, text, sizeof text - 1), 0);
    ck_assert_str_eq(text, "number 2\n");
    close(fd);
    unlink(path);
}
END_TEST

static void *idle(void *unused)
{
    pause();
    return unused;
}

static lc_status refuse_input(void *user, lc_error *err) { return lc_fail(err, LC_BAD_INPUT, "no %s", (const char *)user); }

/* Starts a thread, as Embree does when it builds a scene. */
static lc_status start_thread(void *user, lc_error *err)
{
    pthread_t *thread = user;
    return pthread_create(thread, NULL, idle, NULL) == 0 ? LC_OK : lc_fail(err, LC_FAULT, "no thread");
}

static lc_status die(void *user, lc_error *err)
{
    (void)user, (void)err;
    raise(SIGKILL);
    return LC_OK;
}

/* What is done apart leaves only its answer here. */
START_TEST(test_pool_apart)
{
    char what[] = "such scene";
    pthread_t thread;
    lc_error err = {""};
    lc_pool_job job = {.run = work, .seconds = 60, .user = (void *)1};
    ck_assert_int_eq(lc_pool_apart(refuse_input, what, &err), LC_BAD_INPUT);
    ck_assert_str_eq(err.text, "no such scene");
    ck_assert_int_eq(lc_pool_apart(die, NULL, &err), LC_FAULT);
    ck_assert_ptr_nonnull(strstr(err.text, "signal 9"));
    ck_assert_int_eq(lc_pool_apart(start_thread, &thread, &err), LC_OK);
    ended = 0;
    ck_assert_int_eq(lc_pool_run(&job, 1, 1, note, &err), LC_OK);
    ck_assert_int_eq(job.exit_status, 41);
}
END_TEST

/* A lock that another thread holds is never given back in the child of a fork: it would wait for ever, now and then. */
START_TEST(test_pool_threads)
{
    static const char *const quick[] = {"/bin/sh", "-c", "exit 0", NULL};
    pthread_t thread;
    char what[] = "scene";
    lc_error err = {""};
    lc_pool_job jobs[] = {shell(quick, 60, 1), {.run = work, .seconds = 60, .user = (void *)1}};
    ck_assert_int_eq(start_thread(&thread, &err), LC_OK);
    ended = 0;
    ck_assert_int_eq(lc_pool_run(jobs, 2, 1, note, &err), LC_FAULT);
    ck_assert_str_eq(err.text, "a process with 2 threads cannot be split in two");
    ck_assert_int_eq(ended, 0);
    ck_assert_int_eq(lc_pool_apart(refuse_input, what, &err), LC_FAULT);
    ck_assert_int_eq(lc_pool_run(jobs, 1, 1, note, &err), LC_OK); /* a program takes no lock along */
}
END_TEST

/* The first failure of the caller's ends the run, and what still runs. */
START_TEST(test_pool_refused)
{
    static const char *const quick[] = {"/bin/sh", "-c", "exit 0", NULL}, *const slow[] = {"/bin/sh", "-c", "sleep 1000", NULL};
    lc_pool_job jobs[] = {shell(slow, 1000, 0), shell(quick, 60, 1), shell(slow, 1000, 2)};
    lc_error err;
    ck_assert_int_eq(lc_pool_run(jobs, 3, 2, refuse, &err), LC_FAULT);
    ck_assert_str_eq(err.text, "enough after 1");
    ck_assert_int_eq(waitpid(-1, NULL, WNOHANG), -1); /* no child is left */
}
END_TEST

Suite *lc_suite_pool(void)
{
    Suite *suite = suite_create("pool");
    TCase *tests = tcase_create("pool");
    tcase_set_timeout(tests, 30);
    tcase_add_test(tests, test_pool_stuck);
    tcase_add_test(tests, test_pool_log);
    tcase_add_test(tests, test_pool_function);
    tcase_add_test(tests, test_pool_apart);
    tcase_add_test(tests, test_pool_threads);
    tcase_add_test(tests, test_pool_refused);
    suite_add_tcase(suite, tests);
    return suite;
}
