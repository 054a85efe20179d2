/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "io/exr.h"
#include "io/png.h"
#include "verify/report/safe.h"

typedef struct render_arguments {
    const char *estimator, *size, *shard, *out;
    int samples, bounces, min_bounces, by_bounce, threads;
    uint64_t seed;
    double exposure;
    lc_strings definitions;
} render_arguments;

static int ends_with(const char *text, const char *end)
{
    size_t n = strlen(text), m = strlen(end);
    return n >= m && strcmp(text + n - m, end) == 0;
}

static lc_status write_image(const char *path, const lc_film *film, double exposure, lc_error *err)
{
    return ends_with(path, ".png") ? lc_png_write_film(path, film, exposure, err) : lc_exr_write(path, film, err);
}

static void print_summary(const lc_film *film, const char *path)
{
    double mean[3] = {0, 0, 0};
    size_t count = (size_t)film->width * (size_t)film->height;
    for (size_t i = 0; i < count; ++i)
        for (int c = 0; c < 3; ++c)
            mean[c] += film->pixels[i].c[c].mean / (double)count;
    printf("%s: %s by %s, bounces %d to %d, %dx%d, %llu samples a pixel, seed %llu, mean (%.6g, %.6g, %.6g)\n", path,
           film->scene, film->estimator, film->min_bounces, film->max_bounces, film->width, film->height,
           (unsigned long long)film->count, (unsigned long long)film->seed, mean[0], mean[1], mean[2]);
}

/* "x.exr", 2 -> "x.2.exr" */
static void name_of_bounce(char *out, size_t size, const char *path, int bounce)
{
    const char *dot = strrchr(path, '.');
    int stem = dot ? (int)(dot - path) : (int)strlen(path);
    snprintf(out, size, "%.*s.%d%s", stem, path, bounce, dot ? dot : "");
}

/* Each word quoted; `room` is that of the line. */
static void add_count(char *line, size_t room, const char *before, uint64_t count)
{
    char text[32];
    snprintf(text, sizeof text, "%llu", (unsigned long long)count);
    lc_shell_add(line, room, before, text);
}

/* The command that replays the first bad sample of the film. */
static void say_replay(char *line, size_t room, const render_arguments *a, const char *scene, const lc_film *film)
{
    char text[64];
    snprintf(line, room, "lightcheck sample");
    lc_shell_add(line, room, " ", scene);
    lc_shell_add(line, room, " -e ", a->estimator);
    snprintf(text, sizeof text, "%d,%d", film->bad_x, film->bad_y);
    lc_shell_add(line, room, " --pixel ", text);
    add_count(line, room, " --index ", film->bad_sample);
    add_count(line, room, " --seed ", film->seed);
    add_count(line, room, " --bounces ", (uint64_t)film->max_bounces);
    if (film->min_bounces > 0)
        add_count(line, room, " --min-bounces ", (uint64_t)film->min_bounces);
    if (a->size)
        lc_shell_add(line, room, " --size ", a->size);
    for (int i = 0; i < a->definitions.count; ++i)
        lc_shell_add(line, room, " -D ", a->definitions.items[i]);
}

static lc_status render_one(const lc_scene *scene, const lc_estimator *estimator, const lc_render_options *options,
                            int width, int height, const char *path, const render_arguments *a, const char *scene_name,
                            lc_error *err)
{
    char replay[sizeof err->text];
    lc_film *film;
    lc_status status = lc_film_create(&film, width, height, err);
    if (status != LC_OK)
        return status;
    status = lc_render(film, scene, estimator, options, err);
    if (status == LC_OK)
        status = write_image(path, film, a->exposure, err);
    if (status == LC_OK)
        print_summary(film, path);
    if (status == LC_OK && film->bad) {
        say_replay(replay, sizeof replay, a, scene_name, film);
        status = lc_fail(err, LC_WRONG,
                         "%s: %llu samples are NaN, infinite, negative or above 1e60 (written as 0), the first "
                         "(%g, %g, %g) at pixel %d,%d; see it with `%s`",
                         path, (unsigned long long)film->bad, film->bad_value[0], film->bad_value[1],
                         film->bad_value[2], film->bad_x, film->bad_y, replay);
    }
    lc_film_free(film);
    return status;
}

static lc_status render(void *user, const lc_strings *rest, lc_error *err)
{
    const render_arguments *a = user;
    const char *scene_name = rest->items[0];
    const lc_estimator *estimator;
    lc_scene *scene = NULL;
    char path[4096], default_out[128];
    int width, height;
    lc_render_options options = {.seed = a->seed, .threads = a->threads, .shards = 1, .progress = lc_cli_progress};
    if (!a->estimator)
        return lc_fail(err, LC_BAD_INPUT, "-e NAME|FILE.c says which estimator; `lightcheck list estimators` names them");
    lc_status status = lc_cli_find_estimator(&estimator, a->estimator, err);
    if (status == LC_OK)
        status = lc_cli_load_scene(&scene, scene_name, &a->definitions, err);
    if (status != LC_OK)
        return status;

    const lc_scene_desc *desc = lc_scene_description(scene);
    width = desc->width;
    height = desc->height;
    options.arm = lc_arm(estimator->name);
    options.count = (uint64_t)(a->samples > 0 ? a->samples : desc->samples);
    status = lc_cli_bounces(&options.max_bounces, a->bounces, scene, estimator, err);
    options.min_bounces = a->min_bounces;
    if (status == LC_OK && a->size)
        status = lc_cli_read_pair(&width, &height, a->size, 'x', "--size", err);
    if (status == LC_OK && (width < 1 || height < 1 || width > LC_MAX_SIZE || height > LC_MAX_SIZE))
        status = lc_fail(err, LC_BAD_INPUT, "--size %dx%d: expected 1 to %d each", width, height, LC_MAX_SIZE);
    if (status == LC_OK && a->shard)
        status = lc_cli_read_pair(&options.shard, &options.shards, a->shard, '/', "--shard", err);
    if (status == LC_OK && a->shard && options.shard >= options.shards)
        status = lc_fail(err, LC_BAD_INPUT, "--shard %s: expected I/N with 0 <= I < N", a->shard);
    snprintf(default_out, sizeof default_out, "%s.%s.exr", desc->name, estimator->name);
    const char *out = a->out ? a->out : default_out;
    for (int k = 0; status == LC_OK && a->by_bounce && k <= options.max_bounces; ++k) {
        lc_render_options term = options;
        term.min_bounces = term.max_bounces = k;
        name_of_bounce(path, sizeof path, out, k);
        status = render_one(scene, estimator, &term, width, height, path, a, scene_name, err);
    }
    if (status == LC_OK && !a->by_bounce)
        status = render_one(scene, estimator, &options, width, height, out, a, scene_name, err);
    lc_scene_free(scene);
    return status;
}

static int run(const lc_command *self, int argc, char **argv)
{
    render_arguments a = {.bounces = -1, .seed = LC_DEFAULT_SEED};
    const lc_option options[] = {
        {'e', "estimator", LC_OPT_STRING, &a.estimator, "NAME|FILE.c",
         "estimator (see `lightcheck list estimators`), or a file of your own", 0, 0, NULL},
        {'s', "samples", LC_OPT_INT, &a.samples, "SPP", "samples a pixel; default: the scene's", 1, 2e9, NULL},
        {0, "bounces", LC_OPT_INT, &a.bounces, "N", "scattering events at most; default: the scene's, else 5", 0,
         LC_UNBOUNDED, NULL},
        {0, "min-bounces", LC_OPT_INT, &a.min_bounces, "N", "leaves out the terms below; 1: reflected light only", 0,
         LC_UNBOUNDED, NULL},
        {0, "by-bounce", LC_OPT_FLAG, &a.by_bounce, NULL,
         "one image for each number of bounces: OUT.0.exr, OUT.1.exr, ...", 0, 0, NULL},
        {0, "size", LC_OPT_STRING, &a.size, "WxH", "pixels; default: the scene's", 0, 0, NULL},
        {'o', "out", LC_OPT_STRING, &a.out, "FILE",
         "image.exr (means, variances, samples) or image.png; default SCENE.NAME.exr", 0, 0, NULL},
        {0, "exposure", LC_OPT_NUMBER, &a.exposure, "STOPS", "of a .png; default 0", -100, 100, NULL},
        {0, "seed", LC_OPT_UINT64, &a.seed, "N", "default 1; the same seed gives the same bits", 0, 0, NULL},
        {0, "threads", LC_OPT_INT, &a.threads, "N", "default: one a core; changes only the time", 1, 256, NULL},
        {0, "shard", LC_OPT_STRING, &a.shard, "I/N",
         "only every N-th tile from the I-th; put together with `lightcheck merge`", 0, 0, NULL},
        {'D', "define", LC_OPT_LIST, &a.definitions, "NAME=VALUE", "value of a <default> of the scene", 0, 0, NULL},
        {0, NULL, LC_OPT_FLAG, NULL, NULL, NULL, 0, 0, NULL},
    };
    return lc_command_run(self, options, argc, argv, 1, 1,
                          "expected one scene: a name (see `lightcheck list scenes`) or a path to an .xml file", render,
                          &a);
}

const lc_command lc_command_render = {
    "render", "SCENE -e NAME|FILE.c [options]", "renders a scene with an estimator", NULL, run,
};
