/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Threads take tiles; each pixel is a pure function of the options, so that who took which tile cannot show.
 */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/scene_c.h"

typedef struct job {
    lc_film *film;
    const lc_scene *scene;
    const lc_estimator *estimator;
    const lc_render_options *options;
    lc_camera_frame frame, minus_frame[LC_MAX_TERMS];
    int tiles_x, tiles;
    pthread_mutex_t lock; /* of all that follows */
    int next_tile, done;
} job;

/* The first bad sample of a thread's share, and their number. */
typedef struct bad_samples {
    uint64_t count, pixel, sample;
    double value[3];
    int term; /* as lc_film's bad_term */
} bad_samples;

static int is_bad(lc_rgb c)
{
    const double most = LC_LARGEST_SAMPLE;
    return !(c.r >= 0 && c.g >= 0 && c.b >= 0 && c.r <= most && c.g <= most && c.b <= most);
}

/* LC_PACKET neighbouring samples of a pixel: their camera rays are made and traced together. */
typedef struct packet {
    lc_sampler samplers[LC_PACKET]; /* where the estimator begins */
    lc_ray rays[LC_PACKET];
    lc_hit hits[LC_PACKET];
} packet;

/* The whole packet that holds sample `s`, whichever of it are wanted: a sample must not depend on where a render starts or ends. */
static void look(packet *p, const lc_scene *scene, const lc_camera_frame *frame, const lc_render_options *o,
                 uint32_t pixel, int x, int y, uint64_t s, const lc_trace_log *log)
{
    for (int i = 0; i < LC_PACKET; ++i) {
        uint64_t sample = s / LC_PACKET * LC_PACKET + (uint64_t)i;
        lc_sampler *sampler = &p->samplers[i];
        lc_sampler_start(sampler, o->seed, o->arm, pixel, (uint32_t)sample);
        sampler->log = sample == s ? log : NULL;
        p->rays[i] = lc_camera_sample(frame, sampler, x, y);
        lc_sampler_seek(sampler, LC_DIMENSION_ESTIMATOR);
    }
    lc_camera_see_packet(scene, p->rays, p->hits);
}

static void note_bad(bad_samples *bad, lc_rgb c, int term, uint32_t pixel, uint64_t sample)
{
    if (bad->count++ != 0 && pixel >= bad->pixel)
        return;
    bad->pixel = pixel;
    bad->sample = sample;
    bad->value[0] = c.r;
    bad->value[1] = c.g;
    bad->value[2] = c.b;
    bad->term = term;
}

/* The packets that hold sample `s`: packet 0 of the scene, packet 1 + t of term t. */
static void look_everywhere(packet *packets, const job *j, uint32_t pixel, int x, int y, uint64_t s)
{
    const lc_render_options *o = j->options;
    look(&packets[0], j->scene, &j->frame, o, pixel, x, y, s, NULL);
    for (int t = 0; t < o->minus_count; ++t)
        look(&packets[1 + t], o->minus[t].scene, &j->minus_frame[t], o, pixel, x, y, s, NULL);
}

/* Adds what term `t` gave, or -1: the scene; returns 0, with the value, where that is bad. */
static int add_term(lc_rgb *sum, lc_rgb c, int t, const lc_render_options *o)
{
    if (is_bad(c)) {
        *sum = c;
        return 0;
    }
    *sum = t < 0 ? c : lc_rgb_add(*sum, lc_rgb_scale(-o->minus[t].factor, c));
    return 1;
}

/* A sample less the terms, each from the same random numbers; returns 0, with the value that is bad and where, if one is. */
static int sample_of(lc_rgb *out, int *bad_term, packet *packets, const job *j, uint64_t s)
{
    const lc_render_options *o = j->options;
    int i = (int)(s % LC_PACKET);
    for (int t = -1; t < o->minus_count; ++t) {
        const lc_term self = {j->scene, 1, 0}, *term = t < 0 ? &self : &o->minus[t];
        packet *p = &packets[1 + t];
        lc_options bounces = {o->min_bounces - term->shift, o->max_bounces - term->shift};
        if (o->costs)
            lc_cost_start();
        lc_rgb c = j->estimator->radiance(term->scene, &p->rays[i], &p->hits[i], &bounces, &p->samplers[i]);
        if (o->costs)
            c = lc_cost_of(&p->samplers[i]);
        if (!add_term(out, c, t, o)) {
            *bad_term = 1 + t;
            return 0;
        }
    }
    return 1;
}

static void render_pixel(const job *j, int x, int y, bad_samples *bad)
{
    const lc_render_options *o = j->options;
    uint32_t pixel = (uint32_t)(y * j->film->width + x);
    double block[LC_BLOCK][3];
    packet packets[1 + LC_MAX_TERMS];
    int filled = 0;
    for (uint64_t s = o->first; s < o->first + o->count; ++s) {
        lc_rgb c;
        int term = 0;
        if (s % LC_PACKET == 0 || s == o->first)
            look_everywhere(packets, j, pixel, x, y, s);
        if (!sample_of(&c, &term, packets, j, s)) {
            note_bad(bad, c, term, pixel, s);
            c = lc_black(); /* the film stays readable; the count makes it fail */
        }
        block[filled][0] = c.r;
        block[filled][1] = c.g;
        block[filled][2] = c.b;
        if (++filled == LC_BLOCK || s + 1 == o->first + o->count) {
            lc_pixel_add(&j->film->pixels[pixel], (const double(*)[3])block, filled);
            filled = 0;
        }
    }
}

static int take_tile(job *j)
{
    pthread_mutex_lock(&j->lock);
    int tile = j->next_tile;
    j->next_tile += j->options->shards;
    pthread_mutex_unlock(&j->lock);
    return tile;
}

static void finish_tile(job *j, int reports)
{
    pthread_mutex_lock(&j->lock);
    int done = ++j->done;
    pthread_mutex_unlock(&j->lock);
    if (reports && j->options->progress)
        j->options->progress(j->options->user, fmin((double)done * j->options->shards / j->tiles, 1.0));
}

static void report_bad(lc_film *film, const bad_samples *bad)
{
    if (bad->count == 0)
        return;
    uint64_t known = (uint64_t)film->bad_y * (uint64_t)film->width + (uint64_t)film->bad_x;
    /* The first by pixel and sample, so that the report is the same for any number of threads. */
    if (film->bad == 0 || bad->pixel < known || (bad->pixel == known && bad->sample < film->bad_sample)) {
        film->bad_x = (int)(bad->pixel % (uint64_t)film->width);
        film->bad_y = (int)(bad->pixel / (uint64_t)film->width);
        film->bad_sample = bad->sample;
        memcpy(film->bad_value, bad->value, sizeof film->bad_value);
        film->bad_term = bad->term;
    }
    film->bad += bad->count;
}

static void work(job *j, int reports)
{
    bad_samples bad = {0, 0, 0, {0, 0, 0}, 0};
    for (int tile = take_tile(j); tile < j->tiles; tile = take_tile(j)) {
        int x0 = tile % j->tiles_x * LC_TILE, y0 = tile / j->tiles_x * LC_TILE;
        for (int y = y0; y < y0 + LC_TILE && y < j->film->height; ++y)
            for (int x = x0; x < x0 + LC_TILE && x < j->film->width; ++x)
                render_pixel(j, x, y, &bad);
        finish_tile(j, reports);
    }
    pthread_mutex_lock(&j->lock);
    report_bad(j->film, &bad);
    pthread_mutex_unlock(&j->lock);
}

static void *work_in_thread(void *argument)
{
    work(argument, 0);
    return NULL;
}

static lc_status check_options(const lc_film *film, const lc_scene *scene, const lc_estimator *estimator,
                               const lc_render_options *o, lc_error *err)
{
    const char *scene_name = scene->desc.name;
    if (estimator->abi != LC_ABI)
        return lc_fail(err, LC_BAD_INPUT, "%s: written for interface %d, this program has %d", estimator->name,
                       estimator->abi, LC_ABI);
    if (o->min_bounces < 0 || o->max_bounces < o->min_bounces || o->max_bounces > estimator->max_bounces)
        return lc_fail(err, LC_BAD_INPUT, "%s: bounces %d to %d, expected 0 to %d", estimator->name, o->min_bounces,
                       o->max_bounces, estimator->max_bounces);
    if (o->count < 1 || o->first > UINT32_MAX || o->count > UINT32_MAX || o->first + o->count > UINT32_MAX)
        return lc_fail(err, LC_BAD_INPUT,
                       "%s: samples %llu to %llu of a pixel, expected at least one and at most 2^32 - 1", scene_name,
                       (unsigned long long)o->first, (unsigned long long)(o->first + o->count));
    if (o->shards > LC_MAX_SHARDS)
        return lc_fail(err, LC_BAD_INPUT, "%s: %d shards, expected at most %d", scene_name, o->shards, LC_MAX_SHARDS);
    if (o->shards > 1 && (o->shard < 0 || o->shard >= o->shards))
        return lc_fail(err, LC_BAD_INPUT, "%s: shard %d of %d, expected 0 to %d", scene_name, o->shard, o->shards,
                       o->shards - 1);
    if (o->minus_count < 0 || o->minus_count > LC_MAX_TERMS)
        return lc_fail(err, LC_BAD_INPUT, "%s: less %d scenes, expected at most %d", scene_name, o->minus_count,
                       LC_MAX_TERMS);
    for (int i = 0; i < o->minus_count; ++i)
        if (o->minus[i].shift > o->min_bounces || o->max_bounces - o->minus[i].shift > estimator->max_bounces)
            return lc_fail(err, LC_BAD_INPUT, "%s: bounces %d to %d over another scene, expected 0 to %d", scene_name,
                           o->min_bounces - o->minus[i].shift, o->max_bounces - o->minus[i].shift,
                           estimator->max_bounces);
    if (film->count == 0)
        return LC_OK;
    if (film->seed != o->seed || film->arm != o->arm || film->first + film->count != o->first ||
        film->min_bounces != o->min_bounces || film->max_bounces != o->max_bounces ||
        strcmp(film->scene, scene_name) != 0 || strcmp(film->estimator, estimator->name) != 0 ||
        film->shards != (o->shards > 1 ? o->shards : 1))
        return lc_fail(err, LC_FAULT, "%s: a film grows only by the next samples of its own stream", scene_name);
    return LC_OK;
}

/* What the film holds now. */
static void write_down(lc_film *film, const lc_scene *scene, const lc_estimator *estimator, const lc_render_options *o)
{
    if (film->count == 0) {
        film->first = o->first;
        film->seed = o->seed;
        film->arm = o->arm;
        film->min_bounces = o->min_bounces;
        film->max_bounces = o->max_bounces;
        film->shard = o->shard;
        film->shards = o->shards;
        film->has_third = 1;
        snprintf(film->scene, sizeof film->scene, "%s", scene->desc.name);
        snprintf(film->estimator, sizeof film->estimator, "%s", estimator->name);
    }
    film->count += o->count;
}

lc_status lc_render(lc_film *film, const lc_scene *scene, const lc_estimator *estimator,
                    const lc_render_options *options, lc_error *err)
{
    lc_status status = check_options(film, scene, estimator, options, err);
    if (status != LC_OK)
        return status;
    lc_render_options o = *options;
    if (o.shards < 1) {
        o.shard = 0;
        o.shards = 1;
    }
    if (estimator->radiance == lc_radiance_outside) {
        const lc_outside *outside = (const lc_outside *)(const void *)estimator;
        status = outside->fill(outside->user, film, scene, &o, err);
        if (status == LC_OK)
            write_down(film, scene, estimator, &o);
        return status;
    }
    job j = {.film = film,
             .scene = scene,
             .estimator = estimator,
             .options = &o,
             .tiles_x = (film->width + LC_TILE - 1) / LC_TILE,
             .lock = PTHREAD_MUTEX_INITIALIZER,
             .next_tile = o.shard};
    lc_camera_prepare(&j.frame, &scene->desc.camera, film->width, film->height);
    j.frame.moves = scene->moves;
    for (int i = 0; i < o.minus_count; ++i) {
        lc_camera_prepare(&j.minus_frame[i], &o.minus[i].scene->desc.camera, film->width, film->height);
        j.minus_frame[i].moves = o.minus[i].scene->moves;
    }
    j.tiles = j.tiles_x * ((film->height + LC_TILE - 1) / LC_TILE);

    long cores = o.threads > 0 ? o.threads : sysconf(_SC_NPROCESSORS_ONLN);
    int helpers = (int)(cores < 1 ? 1 : cores > 256 ? 256 : cores) - 1, started = 0;
    pthread_t threads[256];
    while (started < helpers && pthread_create(&threads[started], NULL, work_in_thread, &j) == 0)
        ++started; /* fewer threads than asked for change nothing but the time */
    work(&j, 1);
    for (int i = 0; i < started; ++i)
        pthread_join(threads[i], NULL);
    if (o.progress)
        o.progress(o.user, 1.0);

    write_down(film, scene, estimator, &o);
    return LC_OK;
}

lc_rgb lc_radiance_outside(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                           lc_sampler *sampler)
{
    (void)scene, (void)ray, (void)hit, (void)options, (void)sampler;
    return lc_color(NAN, NAN, NAN);
}

void lc_film_put(lc_film *film, const lc_render_options *options, uint32_t pixel, uint64_t first,
                 const double (*samples)[3], int count)
{
    bad_samples bad = {0, 0, 0, {0, 0, 0}, 0};
    double block[LC_BLOCK][3];
    for (int i = 0; i < count; ++i) {
        lc_rgb sum = lc_black();
        for (int t = -1, good = 1; good && t < options->minus_count; ++t, ++samples) {
            good = add_term(&sum, lc_color((*samples)[0], (*samples)[1], (*samples)[2]), t, options);
            if (!good) {
                note_bad(&bad, sum, 1 + t, pixel, first + (uint64_t)i);
                sum = lc_black();
                samples += options->minus_count - 1 - t;
            }
        }
        block[i][0] = sum.r;
        block[i][1] = sum.g;
        block[i][2] = sum.b;
    }
    lc_pixel_add(&film->pixels[pixel], (const double(*)[3])block, count);
    report_bad(film, &bad);
}

/* Where `lightcheck sample --gdb` stops first, to learn the address of the estimator's function. */
#ifdef __GNUC__
__attribute__((noinline))
#endif
void lc_replay_begin(lc_radiance_fn *radiance)
{
    static lc_radiance_fn *volatile next;
    next = radiance;
    (void)next;
}

lc_rgb lc_replay(lc_scene *scene, const lc_estimator *estimator, const lc_render_options *options, int width,
                 int height, int x, int y, uint64_t sample, const lc_trace_log *log)
{
    lc_options bounces = {options->min_bounces, options->max_bounces};
    lc_camera_frame frame;
    packet p;
    int i = (int)(sample % LC_PACKET);
    lc_replay_begin(estimator->radiance);
    lc_camera_prepare(&frame, &scene->desc.camera, width, height);
    frame.moves = scene->moves;
    look(&p, scene, &frame, options, (uint32_t)(y * width + x), x, y, sample, log);
    scene->log = log;
    if (log)
        lc_log_hit(scene, "camera ray hits", &p.hits[i]);
    lc_rgb radiance = estimator->radiance(scene, &p.rays[i], &p.hits[i], &bounces, &p.samplers[i]);
    scene->log = NULL;
    return radiance;
}
