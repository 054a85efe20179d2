/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/commands.h"
#include "verify/checks/family.h"
#include "verify/grade/plugin.h"
#include "verify/judge/judge.h"

typedef struct sample_arguments {
    const char *estimator, *pixel, *size;
    int bounces, min_bounces, gdb;
    uint64_t index, seed, arm;
    lc_strings definitions;
    int argc; /* as given, for --gdb */
    char **argv;
} sample_arguments;

static void print_line(void *user, const char *text)
{
    (void)user;
    printf("  %s\n", text);
}

/* Compiles FILE.c for the debugger, where one is given, to an object of its own: gdb could not read it from memory. */
static lc_status make_object(char object[64], const sample_arguments *a, lc_error *err)
{
    char messages[8192];
    object[0] = 0;
    if (!a->estimator || !lc_is_source(a->estimator))
        return LC_OK;
    snprintf(object, 64, "/tmp/lightcheck-gdb-%ld.so", (long)getpid());
    lc_status status = lc_plugin_write(object, a->estimator, messages, sizeof messages, err);
    fputs(messages, stderr);
    if (status != LC_OK)
        object[0] = 0;
    return status;
}

/* gdb with the terminal to itself; its exit status, or -1 when there is none. */
static int run_gdb(const char *const *command)
{
    int status = 0;
    struct sigaction ignored = {.sa_handler = SIG_IGN}, before;
    sigaction(SIGINT, &ignored, &before); /* ^C is gdb's */
    pid_t child = fork();
    if (child == 0) {
        sigaction(SIGINT, &before, NULL);
        execvp(command[0], (char *const *)command);
        _exit(127);
    }
    while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR)
        ;
    sigaction(SIGINT, &before, NULL);
    return child > 0 && WIFEXITED(status) && WEXITSTATUS(status) != 127 ? WEXITSTATUS(status) : -1;
}

/* The same command again, under gdb, stopped in the estimator's function. */
static lc_status debug(const sample_arguments *a, lc_error *err)
{
    const char *command[64] = {"gdb", "-q", "-ex", "set breakpoint pending on", "-ex", "break lc_replay_begin", "-ex",
                               "run", "-ex", "tbreak *radiance", "-ex", "continue", "-ex", "next", "--args",
                               "/proc/self/exe"}; /* the arguments stand only at the function's first line */
    char exe[4096], object[64];
    int n = 16;
    ssize_t length = readlink("/proc/self/exe", exe, sizeof exe - 1);
    if (length > 0) {
        exe[length] = 0;
        command[n - 1] = exe;
    }
    lc_status status = make_object(object, a, err);
    if (status != LC_OK)
        return status;
    for (int i = 0; i < a->argc && n < 63; ++i)
        if (strcmp(a->argv[i], "--gdb") != 0)
            command[n++] = object[0] && strcmp(a->argv[i], a->estimator) == 0 ? object : a->argv[i];
    command[n] = NULL;
    if (run_gdb(command) < 0)
        status = lc_fail(err, LC_BAD_INPUT, "--gdb: there is no program `gdb`: install the package gdb");
    if (object[0])
        unlink(object);
    return status;
}

static lc_status replay(void *user, const lc_strings *rest, lc_error *err)
{
    const sample_arguments *a = user;
    const char *scene_name = rest->items[0];
    if (a->gdb)
        return debug(a, err);
    const lc_estimator *estimator;
    lc_scene *scene = NULL;
    int width, height, x, y;
    lc_render_options options = {.seed = a->seed, .min_bounces = a->min_bounces};
    if (!a->estimator || !a->pixel)
        return lc_fail(err, LC_BAD_INPUT, "-e NAME|FILE.c and --pixel X,Y say which sample");
    lc_status status = lc_cli_find_estimator(&estimator, a->estimator, err);
    if (status == LC_OK)
        status = lc_cli_read_pair(&x, &y, a->pixel, ',', "--pixel", err);
    if (status == LC_OK)
        status = lc_family_find(scene_name) ? lc_suite_scene(&scene, scene_name, a->seed, NULL, err)
                                            : lc_cli_load_scene(&scene, scene_name, &a->definitions, err);
    if (status != LC_OK)
        return status;
    width = lc_scene_description(scene)->width;
    height = lc_scene_description(scene)->height;
    status = lc_cli_bounces(&options.max_bounces, a->bounces, scene, estimator, err);
    if (status == LC_OK && a->size)
        status = lc_cli_read_pair(&width, &height, a->size, 'x', "--size", err);
    if (status == LC_OK && (x >= width || y >= height))
        status =
            lc_fail(err, LC_BAD_INPUT, "--pixel %s: the image is %d x %d, counted from 0", a->pixel, width, height);
    if (status == LC_OK && a->index >= UINT32_MAX)
        status = lc_fail(err, LC_BAD_INPUT, "--index %llu: expected less than 2^32 - 1", (unsigned long long)a->index);
    if (status == LC_OK) {
        lc_trace_log log = {print_line, NULL};
        options.arm = a->arm <= UINT32_MAX ? (uint32_t)a->arm : lc_arm(estimator->name);
        printf("sample %llu of pixel %d,%d of %s (%dx%d), %s, bounces %d to %d, seed %llu\n",
               (unsigned long long)a->index, x, y, lc_scene_description(scene)->name, width, height, estimator->name,
               options.min_bounces, options.max_bounces, (unsigned long long)a->seed);
        lc_rgb c = lc_replay(scene, estimator, &options, width, height, x, y, a->index, &log);
        printf("radiance (%.9g, %.9g, %.9g) W sr^-1 m^-2\n", c.r, c.g, c.b);
    }
    lc_scene_free(scene);
    return status;
}

static int run(const lc_command *self, int argc, char **argv)
{
    sample_arguments a = {.bounces = -1, .seed = LC_DEFAULT_SEED, .arm = UINT64_MAX, .argc = argc, .argv = argv};
    const lc_option options[] = {
        {'e', "estimator", LC_OPT_STRING, &a.estimator, "NAME|FILE.c",
         "estimator (see `lightcheck list estimators`), or a file of your own", 0, 0, NULL},
        {0, "pixel", LC_OPT_STRING, &a.pixel, "X,Y", "counted from 0,0, the upper left", 0, 0, NULL},
        {0, "index", LC_OPT_UINT64, &a.index, "K", "which sample of the pixel; default 0", 0, 0, NULL},
        {0, "seed", LC_OPT_UINT64, &a.seed, "N", "default 1", 0, 0, NULL},
        {0, "arm", LC_OPT_UINT64, &a.arm, "N", "stream, as `grade` names it; default: the estimator's in a render", 0, 0, NULL},
        {0, "bounces", LC_OPT_INT, &a.bounces, "N", "as for render", 0, LC_UNBOUNDED, NULL},
        {0, "min-bounces", LC_OPT_INT, &a.min_bounces, "N", "as for render", 0, LC_UNBOUNDED, NULL},
        {0, "size", LC_OPT_STRING, &a.size, "WxH", "as for render", 0, 0, NULL},
        {'D', "define", LC_OPT_LIST, &a.definitions, "NAME=VALUE", "value of a <default> of the scene", 0, 0, NULL},
        {0, "gdb", LC_OPT_FLAG, &a.gdb, NULL, "under gdb, stopped in the estimator; FILE.c is compiled without optimisation", 0, 0, NULL},
        {0, NULL, LC_OPT_FLAG, NULL, NULL, NULL, 0, 0, NULL},
    };
    return lc_command_run(self, options, argc, argv, 1, 1,
                          "expected one scene: a name (see `lightcheck list scenes`) or a path to an .xml file", replay,
                          &a);
}

const lc_command lc_command_sample = {
    "sample",
    "SCENE -e NAME|FILE.c --pixel X,Y --index K [options]",
    "replays one sample and prints each draw, hit and value",
    NULL,
    run,
};
