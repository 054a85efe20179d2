/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The program as a user has it: $LIGHTCHECK is run, and its exit status, its output and its files are looked at. */
#include "verify/tests/tests.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "core/host.h"
#include "estimators/registry.h"
#include "io/exr.h"
#include "verify/mutants/registry.h"

enum { OK = 0, WRONG = 1, BAD = 2, UNDECIDED = 3, FAULT = 4 };

static char folder[64];

/* What a run left behind. */
static struct {
    int status; /* exit status, or minus the signal */
    char out[1 << 18], err[1 << 14];
} ran;

static void make_folder(void)
{
    strcpy(folder, "/tmp/lightcheck-test-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
}

static int is_dot(const char *name) { return strcmp(name, ".") == 0 || strcmp(name, "..") == 0; }

/* Number of entries whose name contains `part`. */
static int count_files(const char *part)
{
    int count = 0;
    DIR *dir = opendir(folder);
    ck_assert_ptr_nonnull(dir);
    for (struct dirent *e = readdir(dir); e; e = readdir(dir))
        count += !is_dot(e->d_name) && strstr(e->d_name, part) != NULL;
    closedir(dir);
    return count;
}

static void remove_folder(const char *path)
{
    char entry[512];
    DIR *dir = opendir(path);
    if (!dir)
        return;
    for (struct dirent *e = readdir(dir); e; e = readdir(dir)) {
        if (is_dot(e->d_name))
            continue;
        snprintf(entry, sizeof entry, "%s/%s", path, e->d_name);
        if (unlink(entry) != 0)
            remove_folder(entry);
    }
    closedir(dir);
    rmdir(path);
}

static void clean_folder(void) { remove_folder(folder); }

/* folder/name; the same name gives the same text, at most eight are alive. */
static const char *in_folder(const char *name)
{
    static char paths[8][256];
    static int next;
    char *path = paths[next++ % 8];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

static void read_text(char *text, size_t size, const char *path)
{
    FILE *file = fopen(path, "rb");
    ck_assert_msg(file != NULL, "%s", path);
    text[fread(text, 1, size - 1, file)] = 0;
    fclose(file);
}

/* In the child: the program, with its outputs in files unless `out` is a descriptor. */
static void execute(const char *const *arguments, int out, int err)
{
    const char *program = getenv("LIGHTCHECK");
    const char *argv[32] = {program ? program : "build/lightcheck"};
    for (int i = 0; arguments[i] && i < 30; ++i)
        argv[i + 1] = arguments[i];
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    execv(argv[0], (char *const *)argv);
    _exit(99);
}

static int open_log(const char *name)
{
    int fd = open(name, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    ck_assert_int_ge(fd, 0);
    return fd;
}

static pid_t start(const char *const *arguments, int out, int as_nobody)
{
    char log[96];
    snprintf(log, sizeof log, "%s.err", folder);
    int err = open_log(log);
    pid_t pid = fork();
    ck_assert_int_ge(pid, 0);
    if (pid == 0) {
        /* For good: with two users at once a program runs in secure mode, where sanitizers go their own ways. */
        if (as_nobody && geteuid() == 0 && setuid(65534) != 0)
            _exit(98);
        execute(arguments, out, err);
    }
    close(err);
    return pid;
}

static void finish(pid_t pid)
{
    char log[96];
    int status;
    ck_assert_int_eq(waitpid(pid, &status, 0), pid);
    ran.status = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    snprintf(log, sizeof log, "%s.err", folder);
    read_text(ran.err, sizeof ran.err, log);
    unlink(log);
}

static void run_list(const char *const *arguments, int as_nobody)
{
    char log[96];
    snprintf(log, sizeof log, "%s.out", folder);
    int out = open_log(log);
    finish(start(arguments, out, as_nobody));
    close(out);
    read_text(ran.out, sizeof ran.out, log);
    unlink(log);
}

/* run(0, "list", "scenes"): runs it and checks the exit status. */
#define run(expected, ...) \
    do { \
        run_list((const char *const[]){__VA_ARGS__, NULL}, 0); \
        ck_assert_msg(ran.status == (expected), "exit status %d, expected %d; stderr: %s", ran.status, (expected), \
                      ran.err); \
    } while (0)

/* The same for what must fail: nothing on stdout, one line on stderr that holds `text`. */
#define run_bad(expected, text, ...) \
    do { \
        run(expected, __VA_ARGS__); \
        ck_assert_msg(strstr(ran.err, text) != NULL, "stderr lacks '%s': %s", text, ran.err); \
        ck_assert_msg(strncmp(ran.err, "lightcheck", 10) == 0, "%s", ran.err); \
        ck_assert_msg(strchr(ran.err, '\n') == ran.err + strlen(ran.err) - 1, "not one line: %s", ran.err); \
    } while (0)

static void ck_same_bytes(const char *a, const char *b)
{
    static char left[1 << 20], right[1 << 20];
    FILE *f = fopen(a, "rb"), *g = fopen(b, "rb");
    ck_assert(f && g);
    size_t n = fread(left, 1, sizeof left, f), m = fread(right, 1, sizeof right, g);
    fclose(f);
    fclose(g);
    ck_assert_uint_eq(n, m);
    ck_assert_uint_lt(n, sizeof left);
    ck_assert_msg(memcmp(left, right, n) == 0, "%s and %s differ", a, b);
}

/* ---- help, lists, usage ---------------------------------------------------------------------------------------- */

START_TEST(every_command_explains_itself)
{
    static char help[sizeof ran.out];
    char name[32];
    int commands = 0;
    run(OK, "--help");
    strcpy(help, ran.out);
    for (char *line = strtok(help, "\n"); line; line = strtok(NULL, "\n")) {
        if (strncmp(line, "  ", 2) != 0 || sscanf(line, " %31[a-z]", name) != 1)
            continue;
        char usage[64];
        snprintf(usage, sizeof usage, "usage: lightcheck %s ", name);
        run(OK, name, "--help");
        ck_assert_msg(strncmp(ran.out, usage, strlen(usage)) == 0, "%s", ran.out);
        ck_assert_ptr_nonnull(strstr(ran.out, "--help"));
        ck_assert_str_eq(ran.err, "");
        run(OK, name, "-h");
        run_bad(BAD, "unknown option --nonsense", name, "--nonsense");
        ++commands;
    }
    ck_assert_int_ge(commands, 6);
    run(OK, "help");
    run(OK, "--version");
    ck_assert_str_eq(ran.out, "lightcheck " LC_VERSION "\n");
}
END_TEST

START_TEST(bad_usage_is_2)
{
    run_list((const char *const[]){NULL}, 0);
    ck_assert_int_eq(ran.status, BAD);
    ck_assert_ptr_nonnull(strstr(ran.err, "usage:"));
    run_bad(BAD, "unknown command 'frobnicate'", "frobnicate");
    run_bad(BAD, "expected one of: estimators, scenes, checks, mutants", "list", "nonsense");
    run_bad(BAD, "expected one of", "list");
    run_bad(BAD, "expected one scene", "render");
    run_bad(BAD, "expected one scene", "render", "a", "b", "-e", "light_direct");
    run_bad(BAD, "-e NAME", "render", "cornell");
    run_bad(BAD, "needs a value", "render", "cornell", "-e");
    run_bad(BAD, "takes no value", "render", "cornell", "--by-bounce=3");
    run_bad(BAD, "--pixel", "sample", "cornell", "-e", "light_direct");
    run_bad(BAD, "expected two images", "compare", "a.exr");
    run_bad(BAD, "two or more images", "merge", "a.exr", "-o", "b.exr");
    run_bad(BAD, "two or more images", "merge", "a.exr", "b.exr");
    run_bad(BAD, "unexpected argument 'cornell'", "verify", "cornell");
    run_bad(BAD, "--scene: given twice, the second time with sky", "verify", "--scene", "cornell", "--scene=sky");
    run_bad(BAD, "--samples: given twice", "render", "cornell", "-e", "light_direct", "-s", "1", "--samples", "1");
}
END_TEST

#define RENDER "render", "cornell", "-e", "light_direct"

START_TEST(bad_values_are_2_and_say_what_is_good)
{
    static const char *const pairs[][3] = {
        {"--size", "0x5", "expected 1 to 16384 each"},
        {"--size", "99999x9", "expected 1 to 16384 each"},
        {"--size", "10x", "two whole numbers"},
        {"--size", "axb", "two whole numbers"},
        {"--size", "-1x5", "two whole numbers"},
        {"--size", "5x-1", "two whole numbers"},
        {"--size", "5x5x5", "two whole numbers"},
        {"--size", "99999999999999999999x3", "two whole numbers"},
        {"-s", "0", "a whole number from 1 to"},
        {"-s", "-3", "a whole number from 1 to"},
        {"-s", "1e3", "a whole number from 1 to"},
        {"-s", "99999999999999999999", "a whole number from 1 to"},
        {"--bounces", "-1", "a whole number from 0 to"},
        {"--bounces", "2", "light_direct does at most 1"},
        {"--seed", "-1", "a whole number from 0 to 2^64 - 1"},
        {"--seed", "18446744073709551616", "a whole number from 0 to 2^64 - 1"},
        {"--seed", "", "a whole number from 0 to 2^64 - 1"},
        {"--threads", "0", "a whole number from 1 to 256"},
        {"--threads", "257", "a whole number from 1 to 256"},
        {"--shard", "2/2", "0 <= I < N"},
        {"--shard", "1", "two whole numbers"},
        {"--shard", "0/0", "0 <= I < N"},
        {"--shard", "0/5000", "expected at most 1024"},
        {"--exposure", "nan", "a number above -100"},
        {"-D", "size", "expected NAME=VALUE"},
        {"-D", "=3", "expected NAME=VALUE"},
        {"-D", "nosuch=3", "nosuch"},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; ++i)
        run_bad(BAD, pairs[i][2], RENDER, "-o", in_folder("x.exr"), pairs[i][0], pairs[i][1]);
    run_bad(BAD, "expected 1 to 16384 each", RENDER, "-o", in_folder("x.exr"), "--size=0x0"); /* the other spelling */
    ck_assert_int_eq(count_files(""), 0);
    run_bad(BAD, "counted from 0", "sample", "cornell", "-e", "light_direct", "--pixel", "64,0");
    run_bad(BAD, "two whole numbers", "sample", "cornell", "-e", "light_direct", "--pixel", "1x2");
    run_bad(BAD, "less than 2^32 - 1", "sample", "cornell", "-e", "light_direct", "--pixel", "1,2", "--index",
            "4294967295");
    run_bad(BAD, "not quick|full|proof", "verify", "--suite", "slow");
    run_bad(BAD, "not text|json|junit", "verify", "--format", "yaml");
    run_bad(BAD, "a number above 0", "verify", "--margin", "0");
    run_bad(BAD, "a number above 0", "verify", "--margin", "nan");
    run_bad(BAD, "a number above 0", "verify", "--budget", "1e-6x");
    run_bad(BAD, "neither `random` nor a whole number", "verify", "--seed", "dice");
    run_bad(BAD, "unknown check 'nosuch'", "verify", "-c", "nosuch");
    run_bad(BAD, "'nosuch' is not in the suites", "verify", "--scene", "nosuch");
    run_bad(BAD, "0 <= I < N", "verify", "--shard", "3/3");
    run_bad(BAD, "nothing to verify", "verify", "-c", "furnace", "--scene", "cornell");
}
END_TEST

START_TEST(unknown_names_list_the_known_ones)
{
    run_bad(BAD, "unknown estimator 'nosuch'", "render", "cornell", "-e", "nosuch");
    for (const lc_estimator *const *e = lc_estimators; *e; ++e)
        ck_assert_ptr_nonnull(strstr(ran.err, (*e)->name));
    run_bad(BAD, "unknown estimator 'nosuch'", "verify", "-e", "nosuch");
    run_bad(BAD, "unknown scene 'nosuch'", "render", "nosuch", "-e", "light_direct");
    ck_assert_ptr_nonnull(strstr(ran.err, "cornell"));
    ck_assert_ptr_nonnull(strstr(ran.err, "two_lights"));
}
END_TEST

/* One item a line, the name first, no header. */
static int first_words(char names[][64], int most)
{
    int count = 0;
    for (char *line = strtok(ran.out, "\n"); line && count < most; line = strtok(NULL, "\n"))
        ck_assert_int_eq(sscanf(line, "%63[a-z0-9_]", names[count++]), 1);
    return count;
}

START_TEST(lists_are_for_scripts)
{
    static const char *const what[] = {"estimators", "scenes", "checks", "mutants"};
    static char names[1024][64];
    for (int i = 0; i < 4; ++i) {
        run(OK, "list", what[i]);
        int count = first_words(names, 1024);
        run(OK, "list", what[i], "--json");
        json_error_t why;
        json_t *array = json_loads(ran.out, 0, &why);
        ck_assert_msg(json_is_array(array), "%s", why.text);
        ck_assert_uint_eq(json_array_size(array), (size_t)count);
        for (int k = 0; k < count; ++k)
            ck_assert_str_eq(json_string_value(json_object_get(json_array_get(array, (size_t)k), "name")), names[k]);
        json_decref(array);
        ck_assert_int_ge(count, 3);
        if (i == 0)
            for (int k = 0; k < count; ++k)
                ck_assert_str_eq(names[k], lc_estimators[k]->name);
    }
}
END_TEST

/* What a check claims comes from somewhere. */
START_TEST(checks_name_their_source)
{
    json_error_t why;
    run(OK, "list", "checks", "--json");
    json_t *array = json_loads(ran.out, 0, &why);
    ck_assert_msg(json_is_array(array), "%s", why.text);
    run(OK, "list", "checks");
    for (size_t i = 0; i < json_array_size(array); ++i) {
        const json_t *item = json_array_get(array, i);
        const char *name = json_string_value(json_object_get(item, "name"));
        const char *source = json_string_value(json_object_get(item, "source"));
        ck_assert_msg(source && strlen(source) > 10, "%s has no source", name);
        const char *line = strstr(ran.out, name), *at = line ? strstr(line, source) : NULL;
        ck_assert_msg(at && at < line + strcspn(line, "\n"), "%s: its line does not name %s", name, source);
    }
    json_decref(array);
}
END_TEST

/* ---- input and output -------------------------------------------------------------------------------------------- */

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    ck_assert_ptr_nonnull(file);
    ck_assert_int_ge(fputs(text, file), 0);
    ck_assert_int_eq(fclose(file), 0);
}

START_TEST(bad_files_are_named)
{
    run_bad(BAD, "missing.xml", "render", in_folder("missing.xml"), "-e", "light_direct");
    write_file(in_folder("bad.xml"), "<scene version=\"3.0.0\">\n<shape type=\"sphere\">\n</scene>\n");
    run_bad(BAD, "bad.xml:3:", "render", in_folder("bad.xml"), "-e", "light_direct");
    write_file(in_folder("torus.xml"), "<scene version=\"3.0.0\">\n<shape type=\"torus\"/>\n</scene>\n");
    run_bad(BAD, "torus.xml:2:", "render", in_folder("torus.xml"), "-e", "light_direct");
    run_bad(BAD, "missing.exr", "compare", in_folder("missing.exr"), in_folder("missing.exr"));
    write_file(in_folder("text.exr"), "no image");
    run_bad(BAD, "text.exr", "compare", in_folder("text.exr"), in_folder("text.exr"));
    run_bad(BAD, "text.exr", "merge", in_folder("text.exr"), in_folder("text.exr"), "-o", in_folder("out.exr"));
    ck_assert_int_eq(count_files("out"), 0);
}
END_TEST

#define SMALL "render", "cornell", "-e", "light_direct", "-s", "4", "--size", "20x12"

START_TEST(output_that_cannot_be_written_is_4)
{
    char name[96];
    run_bad(FAULT, "nodir/x.exr", SMALL, "-o", in_folder("nodir/x.exr"));
    run_bad(FAULT, "nodir/x.png", SMALL, "-o", in_folder("nodir/x.png"));
    ck_assert_int_eq(count_files(""), 0);
    ck_assert_int_eq(chmod(folder, 0555), 0);
    snprintf(name, sizeof name, "%s/x.exr", folder);
    run_list((const char *const[]){SMALL, "-o", name, NULL}, 1);
    ck_assert_int_eq(chmod(folder, 0755), 0);
    uid_t before;
    if (!lc_test_drop_root(&before))
        return;
    lc_test_restore_root(before);
    ck_assert_int_eq(ran.status, FAULT);
    ck_assert_ptr_nonnull(strstr(ran.err, "Permission denied"));
    run_list((const char *const[]){SMALL, "-o", "/dev/full", NULL}, 1);
    ck_assert_int_eq(ran.status, FAULT);
    ck_assert_ptr_nonnull(strstr(ran.err, "No space left"));
    ck_assert_int_eq(count_files(""), 0);
}
END_TEST

/* Results that nobody can read are an error, not a death, and not a success. */
START_TEST(a_full_or_closed_stdout_is_4)
{
    int full = open("/dev/full", O_WRONLY), ends[2];
    ck_assert_int_ge(full, 0);
    finish(start((const char *const[]){"list", "scenes", NULL}, full, 0));
    ck_assert_int_eq(ran.status, FAULT);
    ck_assert_ptr_nonnull(strstr(ran.err, "cannot write to standard output"));
    finish(
        start((const char *const[]){"verify", "-c", "emission", "--scene", "glass_sphere", "--format", "json", NULL}, full, 0));
    ck_assert_int_eq(ran.status, FAULT);
    close(full);
    ck_assert_int_eq(pipe(ends), 0);
    close(ends[0]);
    finish(start((const char *const[]){"list", "scenes", NULL}, ends[1], 0));
    ck_assert_int_eq(ran.status, FAULT);
    close(ends[1]);
}
END_TEST

START_TEST(renders_to_exr_and_png)
{
    lc_film *film;
    lc_error err;
    run(OK, SMALL, "-o", in_folder("a.exr"));
    ck_assert_ptr_nonnull(strstr(ran.out, "cornell by light_direct, bounces 0 to 1, 20x12, 4 samples a pixel, seed 1"));
    ck_assert_str_eq(ran.err, "");
    ck_assert_int_eq(lc_exr_read(&film, in_folder("a.exr"), &err), LC_OK);
    ck_assert(film->width == 20 && film->height == 12 && film->count == 4 && film->seed == 1);
    ck_assert(film->min_bounces == 0 && film->max_bounces == 1 && film->arm == lc_arm("light_direct"));
    lc_film_free(film);
    run(OK, SMALL, "-o", in_folder("a.png"), "--exposure", "-1");
    FILE *png = fopen(in_folder("a.png"), "rb");
    unsigned char head[8] = {0};
    ck_assert_ptr_nonnull(png);
    ck_assert_uint_eq(fread(head, 1, 8, png), 8);
    fclose(png);
    ck_assert_mem_eq(head, "\x89PNG\r\n\x1a\n", 8);
    run(OK, SMALL, "-o", in_folder("b.exr"), "--by-bounce");
    ck_assert_int_eq(count_files("b."), 2);
    ck_assert_int_eq(access(in_folder("b.0.exr"), R_OK), 0);
    ck_assert_int_eq(access(in_folder("b.1.exr"), R_OK), 0);
    ck_assert_int_eq(count_files(""), 4);
}
END_TEST

START_TEST(threads_and_shards_change_no_byte)
{
    run(OK, SMALL, "--threads", "1", "-o", in_folder("one.exr"));
    run(OK, SMALL, "--threads", "2", "-o", in_folder("two.exr"));
    run(OK, SMALL, "--threads", "5", "-o", in_folder("five.exr"));
    ck_same_bytes(in_folder("one.exr"), in_folder("two.exr"));
    ck_same_bytes(in_folder("one.exr"), in_folder("five.exr"));
    run(OK, SMALL, "--shard", "0/3", "-o", in_folder("s0.exr"));
    run(OK, SMALL, "--shard", "1/3", "-o", in_folder("s1.exr"));
    run(OK, SMALL, "--shard", "2/3", "-o", in_folder("s2.exr"));
    run(OK, "merge", in_folder("s2.exr"), in_folder("s0.exr"), in_folder("s1.exr"), "-o", in_folder("all.exr"));
    ck_same_bytes(in_folder("one.exr"), in_folder("all.exr"));
    run_bad(BAD, "s0.exr", "merge", in_folder("s0.exr"), in_folder("s0.exr"), "-o", in_folder("twice.exr"));
    ck_assert_int_eq(count_files("twice"), 0);
}
END_TEST

#define RECTANGLE "render", "plane_rectangle", "-s", "1024", "-e"

START_TEST(compare_has_three_answers)
{
    const char *a = in_folder("a.exr"), *b = in_folder("b.exr"), *c = in_folder("c.exr"), *d = in_folder("d.exr"),
               *e = in_folder("e.exr");
    run(OK, RECTANGLE, "light_direct", "-o", a);
    run(OK, RECTANGLE, "light_direct", "--seed", "2", "-o", b);
    run(OK, "render", "plane_disk", "--size", "64x64", "-s", "1024", "-e", "light_direct", "--seed", "2", "-o", c);
    run(OK, RECTANGLE, "light_one_percent", "-o", d);
    run(OK, "compare", a, b, "--margin", "3%");
    ck_assert_ptr_nonnull(strstr(ran.out, " PASS "));
    run(UNDECIDED, "compare", a, b, "--margin", "0.01%");
    ck_assert_ptr_nonnull(strstr(ran.out, "UNDECIDED"));
    run(WRONG, "compare", a, c);
    ck_assert_ptr_nonnull(strstr(ran.out, " FAIL "));
    run(WRONG, "compare", d, b);
    run_bad(BAD, "independent streams", "compare", a, a);
    run(OK, "render", "plane_rectangle", "-e", "light_direct", "-s", "1", "--seed", "2", "-o", e);
    run(UNDECIDED, "compare", a, e);
    ck_assert_ptr_nonnull(strstr(ran.out, "too few samples"));
    run(OK, RECTANGLE, "light_direct", "--size", "8x8", "--seed", "2", "-o", e);
    run_bad(BAD, "expected the same size", "compare", a, e);
}
END_TEST

/* Hardly any noise, and 1 but for so many steps of a float. */
static void write_still(const char *path, uint64_t seed, int steps, int more)
{
    lc_film *film;
    ck_assert_int_eq(lc_film_create(&film, 8, 8, NULL), LC_OK);
    film->has_third = 1;
    film->seed = seed;
    film->count = 4096;
    for (int i = 0; i < 64; ++i) {
        film->pixels[i].n = 4096;
        for (int c = 0; c < 3; ++c) {
            film->pixels[i].c[c].mean = 1 + steps * ldexp(1, -23);
            film->pixels[i].c[c].m2 = 1e-18;
        }
    }
    film->more = more ? &(lc_range){seed + 100, 0, 0, 4096} : NULL;
    film->more_count = more;
    ck_assert_int_eq(lc_exr_write(path, film, NULL), LC_OK);
    film->more = NULL;
    film->more_count = 0;
    lc_film_free(film);
}

/* A file keeps means as floats: what they are rounded by is no difference, once for each time that they were. */
START_TEST(compare_knows_that_files_are_rounded)
{
    const char *a = in_folder("a.exr"), *b = in_folder("b.exr");
    write_still(a, 1, 0, 0);
    write_still(b, 2, 1, 0);
    run(OK, "compare", a, b);
    write_still(b, 2, 2, 0);
    run(WRONG, "compare", a, b);
    write_still(a, 1, 0, 1);
    write_still(b, 2, 2, 1);
    run(OK, "compare", a, b);
}
END_TEST

/* A negative mean is none of good samples, in whichever image: it is named, and nothing is compared. */
START_TEST(compare_names_a_bad_pixel)
{
    static const struct {
        double value;
        const char *words;
    } bad[] = {{-0.5, "bad.exr: pixel 3,2 has G = -0.5, expected"}, {NAN, "bad.exr: pixel 3,2 has G = "}};
    const char *good = in_folder("a.exr"), *path = in_folder("bad.exr");
    lc_film *film;
    write_still(good, 1, 0, 0);
    for (int i = 0; i < 2; ++i) {
        write_still(path, 2, 0, 0);
        ck_assert_int_eq(lc_exr_read(&film, path, NULL), LC_OK);
        film->pixels[2 * 8 + 3].c[1].mean = bad[i].value;
        ck_assert_int_eq(lc_exr_write(path, film, NULL), LC_OK);
        lc_film_free(film);
        run_bad(WRONG, bad[i].words, "compare", good, path);
        run_bad(WRONG, bad[i].words, "compare", path, good);
    }
}
END_TEST

/* Third moments travel in the file: different counts are decided, and the sum of small renders is. Without them nothing is. */
START_TEST(compare_knows_the_tails)
{
    const char *a = in_folder("a.exr"), *b = in_folder("b.exr"), *c = in_folder("c.exr"), *sum = in_folder("sum.exr");
    lc_film *film;
    run(OK, "render", "plane_rectangle", "-s", "256", "--size", "32x32", "-e", "light_direct", "-o", a);
    run(OK, "render", "plane_rectangle", "-s", "1024", "--size", "32x32", "-e", "three_point", "-o", b);
    run(OK, "compare", a, b, "--margin", "3%");
    run(OK, "compare", b, a, "--margin", "3%");
    run(OK, "render", "plane_rectangle", "-s", "64", "--size", "32x32", "-e", "light_direct", "--seed", "2", "-o", c);
    run(UNDECIDED, "compare", c, b, "--margin", "3%");
    ck_assert_ptr_nonnull(strstr(ran.out, "too few samples"));
    run(OK, "merge", a, c, "-o", sum);
    run(OK, "compare", sum, b, "--margin", "3%");
    run_bad(BAD, "independent streams", "compare", sum, c); /* c is the second range of sum, */
    run_bad(BAD, "independent streams", "compare", c, sum);
    run_bad(BAD, "independent streams", "compare", sum, a); /* a the first */
    for (int i = 0; i < 2; ++i) { /* as they were written before there was skewness */
        ck_assert_int_eq(lc_exr_read(&film, i ? b : a, NULL), LC_OK);
        film->has_third = 0;
        ck_assert_int_eq(lc_exr_write(i ? b : a, film, NULL), LC_OK);
        lc_film_free(film);
    }
    run(UNDECIDED, "compare", a, b, "--margin", "3%");
    ck_assert_ptr_nonnull(strstr(ran.out, "too heavy"));
}
END_TEST

/* What `sample` prints last is what a render of that one sample holds. */
START_TEST(sample_repeats_what_render_saw)
{
    lc_film *film;
    lc_error err;
    run(OK, "render", "five_lights", "-e", "three_point", "--size", "9x7", "-s", "1", "--seed", "5", "-o",
        in_folder("a.exr"));
    ck_assert_int_eq(lc_exr_read(&film, in_folder("a.exr"), &err), LC_OK);
    for (int i = 0; i < 63; i += 8) {
        char pixel[32];
        double r, g, b;
        snprintf(pixel, sizeof pixel, "%d,%d", i % 9, i / 9);
        run(OK, "sample", "five_lights", "-e", "three_point", "--size", "9x7", "--seed", "5", "--pixel", pixel,
            "--index", "0");
        const char *last = strstr(ran.out, "radiance (");
        for (const char *next = last; next; next = strstr(next + 1, "\nradiance ("))
            last = next;
        ck_assert_ptr_nonnull(last);
        last = strchr(last, '(');
        ck_assert_int_eq(sscanf(last, "(%lf, %lf, %lf)", &r, &g, &b), 3);
        ck_assert(fabs(r - film->pixels[i].c[0].mean) <= 1e-6 * r);
        ck_assert(fabs(g - film->pixels[i].c[1].mean) <= 1e-6 * g);
        ck_assert(fabs(b - film->pixels[i].c[2].mean) <= 1e-6 * b);
        ck_assert_ptr_nonnull(strstr(ran.out, "  draw 0: "));
        ck_assert_ptr_nonnull(strstr(ran.out, "  camera ray hits: "));
    }
    lc_film_free(film);
}
END_TEST

/* ---- verify -------------------------------------------------------------------------------------------------------- */

START_TEST(verify_says_pass_or_fail)
{
    run(OK, "verify", "-c", "emission", "--scene", "light_behind");
    ck_assert_ptr_nonnull(strstr(ran.out, " PASS "));
    ck_assert_ptr_nonnull(strstr(ran.out, "seed 1"));
    run(WRONG, "verify", "-e", "light_no_pi", "--scene", "plane_point", "--seed", "7");
    ck_assert_ptr_nonnull(strstr(ran.out, " FAIL "));
    ck_assert_ptr_nonnull(strstr(ran.out, "-e light_no_pi --scene plane_point --seed 7"));
    run(OK, "verify", "-c", "emission", "--scene", "light_behind", "--seed", "random");
}
END_TEST

START_TEST(verify_has_formats)
{
    json_error_t why;
    run(WRONG, "verify", "-e", "light_no_pi", "--scene", "plane_point", "--format", "json");
    json_t *report = json_loads(ran.out, 0, &why);
    ck_assert_msg(report != NULL, "%s", why.text);
    ck_assert_str_eq(json_string_value(json_object_get(report, "seed")), "1");
    json_t *row = json_array_get(json_object_get(report, "rows"), 0);
    ck_assert_str_eq(json_string_value(json_object_get(row, "verdict")), "FAIL");
    json_decref(report);
    run(OK, "verify", "-c", "emission", "--scene", "glass_sphere", "--format", "junit");
    ck_assert_int_eq(strncmp(ran.out, "<?xml version=\"1.0\"", 19), 0);
    run(OK, "verify", "-c", "emission", "--scene", "glass_sphere", "--report", in_folder("report"));
    ck_assert_int_eq(access(in_folder("report/report.txt"), R_OK), 0);
    ck_assert_int_eq(access(in_folder("report/report.json"), R_OK), 0);
    ck_assert_int_eq(access(in_folder("report/report.xml"), R_OK), 0);
    run_bad(FAULT, "no/such", "verify", "-c", "emission", "--scene", "glass_sphere", "--report", in_folder("no/such"));
    ck_assert_ptr_nonnull(strstr(ran.out, " PASS ")); /* the verdicts are not lost with the folder */
}
END_TEST

/* What a FAIL looks like, and where that is said. */
START_TEST(verify_draws_what_fails)
{
#define WRONG_PLANE "verify", "-c", "analytic", "-e", "light_no_pi", "--scene", "plane_rectangle"
    const char *report = in_folder("report");
    run(WRONG, WRONG_PLANE, "--report", report);
    char line[256];
    snprintf(line, sizeof line, "pictures: %s/001_analytic_plane_rectangle_light_no_pi_1-1.difference.png", report);
    ck_assert_msg(strstr(ran.out, line) != NULL, "%s", ran.out);
    json_t *root = json_load_file(in_folder("report/report.json"), 0, NULL);
    json_t *pictures = json_object_get(json_array_get(json_object_get(root, "rows"), 0), "pictures");
    const char *name;
    json_t *path;
    ck_assert_uint_eq(json_object_size(pictures), 6);
    json_object_foreach(pictures, name, path)
        ck_assert_msg(access(json_string_value(path), R_OK) == 0, "%s: %s", name, json_string_value(path));
    lc_film *film;
    ck_assert_int_eq(lc_exr_read(&film, json_string_value(json_object_get(pictures, "difference")), NULL), LC_OK);
    ck_assert(film->pixels[0].c[0].mean > 0); /* pi times too much */
    lc_film_free(film);
    json_decref(root);

    ck_assert(chmod(folder, 0755) == 0 && chmod(report, 0555) == 0);
    run_list((const char *const[]){WRONG_PLANE, "--report", report, NULL}, 1);
    ck_assert_int_eq(chmod(report, 0755), 0);
    ck_assert_int_eq(ran.status, FAULT);
    ck_assert_msg(strstr(ran.err, "Permission denied") && strstr(ran.err, "report/001_"), "%s", ran.err);
    ck_assert_ptr_nonnull(strstr(ran.out, " FAIL "));
    ck_assert_ptr_null(strstr(ran.out, "pictures:"));
}
END_TEST

/* ---- signals ---------------------------------------------------------------------------------------------------- */

/* Waits until the folder has a file, or the program has ended. */
static void wait_for_file(pid_t pid)
{
    struct timespec nap = {0, 500000};
    siginfo_t info;
    do {
        nanosleep(&nap, NULL);
        memset(&info, 0, sizeof info);
        ck_assert_int_eq(waitid(P_PID, (id_t)pid, &info, WEXITED | WNOHANG | WNOWAIT), 0);
    } while (info.si_pid == 0 && count_files("") == 0);
}

/* A stop while the image is being written: no part of it stays. The window is short, so several attempts. */
START_TEST(a_signal_leaves_nothing_half_written)
{
    static const int signals[] = {SIGINT, SIGTERM};
    int caught = 0, null = open("/dev/null", O_WRONLY);
    for (int i = 0; i < 20 && caught < 2; ++i) {
        int number = signals[caught % 2];
        pid_t pid = start((const char *const[]){"render", "no_lights", "-e", "light_direct", "-s", "1", "--size",
                                                "1000x1000", "-o", in_folder("x.exr"), NULL},
                          null, 0);
        wait_for_file(pid);
        kill(pid, number);
        finish(pid);
        ck_assert_msg(ran.status == -number || ran.status == OK, "status %d: %s", ran.status, ran.err);
        int is_there = access(in_folder("x.exr"), F_OK) == 0;
        ck_assert_int_eq(count_files(""), is_there); /* no temporary */
        caught += ran.status == -number && !is_there;
        if (is_there) {
            lc_film *film;
            lc_error err;
            ck_assert_int_eq(lc_exr_read(&film, in_folder("x.exr"), &err), LC_OK);
            lc_film_free(film);
        }
        unlink(in_folder("x.exr"));
    }
    close(null);
    ck_assert_msg(caught == 2, "no signal came while the file was written");
}
END_TEST

Suite *lc_suite_cli(void)
{
    Suite *suite = suite_create("cli");
    TCase *tc = tcase_create("core");
    tcase_set_timeout(tc, 120);
    tcase_add_checked_fixture(tc, make_folder, clean_folder);
    tcase_add_test(tc, every_command_explains_itself);
    tcase_add_test(tc, bad_usage_is_2);
    tcase_add_test(tc, bad_values_are_2_and_say_what_is_good);
    tcase_add_test(tc, unknown_names_list_the_known_ones);
    tcase_add_test(tc, lists_are_for_scripts);
    tcase_add_test(tc, checks_name_their_source);
    tcase_add_test(tc, bad_files_are_named);
    tcase_add_test(tc, output_that_cannot_be_written_is_4);
    tcase_add_test(tc, a_full_or_closed_stdout_is_4);
    tcase_add_test(tc, renders_to_exr_and_png);
    tcase_add_test(tc, threads_and_shards_change_no_byte);
    tcase_add_test(tc, sample_repeats_what_render_saw);
    tcase_add_test(tc, verify_says_pass_or_fail);
    tcase_add_test(tc, verify_has_formats);
    tcase_add_test(tc, verify_draws_what_fails);
    suite_add_tcase(suite, tc);
    tc = tcase_create("compare");
    tcase_set_timeout(tc, 120);
    tcase_add_checked_fixture(tc, make_folder, clean_folder);
    tcase_add_test(tc, compare_has_three_answers);
    tcase_add_test(tc, compare_knows_that_files_are_rounded);
    tcase_add_test(tc, compare_names_a_bad_pixel);
    tcase_add_test(tc, compare_knows_the_tails);
    suite_add_tcase(suite, tc);
    tc = tcase_create("signals");
    tcase_set_timeout(tc, 120);
    tcase_add_checked_fixture(tc, make_folder, clean_folder);
    tcase_add_test(tc, a_signal_leaves_nothing_half_written);
    suite_add_tcase(suite, tc);
    return suite;
}
