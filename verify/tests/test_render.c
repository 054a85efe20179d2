/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rendering: the film is a function of the options, not of threads, shards or the order of growth; bad samples are found. */
#include "verify/tests/tests.h"

#include <stdio.h>
#include <stdlib.h>

#include "core/scene_c.h"
#include "estimators/registry.h"
#include "io/scene_read.h"
#include "verify/tests/scene_help.h"

enum { WIDTH = 21, HEIGHT = 19 }; /* no multiple of a tile */

/* Draws some numbers, looks at the camera's hit. */
static lc_rgb noisy(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                    lc_sampler *sampler)
{
    (void)scene;
    (void)options;
    double u = lc_next(sampler), v = lc_next(sampler);
    return lc_color(u, hit->valid ? u * v : 0.5, fabs(ray->d.x));
}

static const lc_estimator noisy_estimator = {LC_ABI, "noisy", "", "", 0, 0, 3, noisy};

/* Bad at a few places. An estimator must not look into its sampler, but this one has to know where it is. */
static const struct {
    uint32_t pixel, sample;
    double value;
} bad_places[] = {{300, 7, NAN}, {77, 130, INFINITY}, {77, 131, NAN}, {77, 600, -1e-300}, {398, 0, -INFINITY}};
enum { BAD = sizeof bad_places / sizeof bad_places[0] };

static lc_rgb bad(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                  lc_sampler *sampler)
{
    for (int i = 0; i < BAD; ++i)
        if (sampler->pixel == bad_places[i].pixel && sampler->sample == bad_places[i].sample)
            return lc_color(1, bad_places[i].value, 2);
    return noisy(scene, ray, hit, options, sampler);
}

static const lc_estimator bad_estimator = {LC_ABI, "bad", "", "", 0, 0, 1, bad};

static lc_scene *small_scene(void)
{
    lc_scene_desc desc;
    lc_scene_desc_init(&desc);
    strcpy(desc.name, "small");
    add_shape(&desc, LC_SPHERE, pose_translate(0, 0, 5));
    return build_scene(&desc);
}

static lc_film *render(const lc_scene *scene, const lc_estimator *estimator, lc_render_options options)
{
    lc_film *film;
    lc_error err = {""};
    ck_assert_int_eq(lc_film_create(&film, WIDTH, HEIGHT, &err), LC_OK);
    lc_status status = lc_render(film, scene, estimator, &options, &err);
    ck_assert_msg(status == LC_OK, "%s", err.text);
    return film;
}

static void ck_same_film(const lc_film *a, const lc_film *b)
{
    ck_assert(a->width == b->width && a->height == b->height && a->count == b->count && a->first == b->first);
    ck_assert(a->seed == b->seed && a->arm == b->arm && a->shard == b->shard && a->shards == b->shards);
    ck_assert(a->bad == b->bad && a->bad_x == b->bad_x && a->bad_y == b->bad_y && a->bad_sample == b->bad_sample);
    ck_assert_mem_eq(a->bad_value, b->bad_value, sizeof a->bad_value);
    ck_assert_str_eq(a->scene, b->scene);
    ck_assert_str_eq(a->estimator, b->estimator);
    for (int i = 0; i < a->width * a->height; ++i)
        ck_assert_msg(memcmp(&a->pixels[i], &b->pixels[i], sizeof a->pixels[i]) == 0, "pixel %d differs", i);
}

START_TEST(any_number_of_threads_gives_the_same_film)
{
    lc_scene *scene = small_scene();
    lc_render_options options = {.seed = 3, .arm = 4, .count = 70, .max_bounces = 1, .threads = 1};
    lc_film *one = render(scene, &noisy_estimator, options);
    static const int threads[] = {2, 5, 0};
    for (int i = 0; i < 3; ++i) {
        options.threads = threads[i];
        lc_film *film = render(scene, &noisy_estimator, options);
        ck_same_film(film, one);
        lc_film_free(film);
    }
    ck_assert_str_eq(one->scene, "small");
    ck_assert_str_eq(one->estimator, "noisy");
    ck_assert(one->count == 70 && one->first == 0 && one->seed == 3 && one->arm == 4 && one->max_bounces == 1);
    ck_assert(one->pixels[5].n == 70 && one->pixels[5].batches == 1 && one->bad == 0);
    /* And another seed, another arm give other films. */
    options.seed = 4;
    lc_film *other = render(scene, &noisy_estimator, options);
    ck_assert(memcmp(other->pixels, one->pixels, sizeof *one->pixels) != 0);
    lc_film_free(other);
    lc_film_free(one);
    lc_scene_free(scene);
}
END_TEST

/* As many rays as the sample has bounces asked for, each from a hit or into nothing; two numbers a ray. */
static lc_rgb costly(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                     lc_sampler *sampler)
{
    (void)ray;
    lc_hit next;
    for (int i = 0; i < options->max_bounces; ++i) {
        double u = lc_next(sampler), v = lc_next(sampler);
        lc_trace(scene, hit, lc_uniform_hemisphere(lc_vec(0, 0, 1), u, v), &next);
    }
    return lc_color(NAN, -1, 0); /* what it would have been is not asked */
}

static const lc_estimator costly_estimator = {LC_ABI, "costly", "", "", 0, 0, 3, costly};

/* A film of costs: in every sample of a pixel the same, here, whatever the threads and wherever the film starts. */
START_TEST(costs_are_counted)
{
    lc_scene *scene = small_scene();
    for (int bounces = 0; bounces <= 3; ++bounces)
        for (int threads = 1; threads <= 3; threads += 2) {
            lc_render_options options = {
                .seed = 3, .arm = 4, .first = 5, .count = 70, .max_bounces = bounces, .threads = threads, .costs = 1};
            lc_film *film = render(scene, &costly_estimator, options);
            ck_assert_uint_eq(film->bad, 0);
            for (int i = 0; i < WIDTH * HEIGHT; ++i) {
                const lc_moments *rays = &film->pixels[i].c[0], *numbers = &film->pixels[i].c[1], *none = &film->pixels[i].c[2];
                ck_assert(!(fabs(rays->mean - bounces) > 0) && !(rays->m2 > 0));
                ck_assert(!(fabs(numbers->mean - 2 * bounces) > 0) && !(numbers->m2 > 0));
                ck_assert(!(none->max > 0));
            }
            lc_film_free(film);
        }
    lc_scene_free(scene);
}
END_TEST

START_TEST(a_film_grows_to_what_it_would_have_been)
{
    static const uint64_t steps[] = {320, 960, 0};
    lc_scene *scene = small_scene();
    lc_error err;
    lc_render_options options = {.seed = 3, .arm = 4, .count = 1280, .threads = 2};
    const lc_estimator *estimators[] = {&noisy_estimator, &bad_estimator};
    for (int e = 0; e < 2; ++e) {
        options.first = 0;
        options.count = 1280;
        lc_film *whole = render(scene, estimators[e], options), *grown;
        ck_assert_int_eq(lc_film_create(&grown, WIDTH, HEIGHT, &err), LC_OK);
        for (int i = 0; steps[i]; ++i) {
            options.first = grown->count;
            options.count = steps[i];
            ck_assert_int_eq(lc_render(grown, scene, estimators[e], &options, &err), LC_OK);
        }
        ck_same_film(grown, whole);
        lc_film_free(whole);
        lc_film_free(grown);
    }
    lc_scene_free(scene);
}
END_TEST

START_TEST(shards_make_the_whole)
{
    lc_scene *scene = small_scene();
    lc_error err;
    lc_render_options options = {.seed = 3, .arm = 4, .count = 140, .threads = 2};
    const lc_estimator *estimators[] = {&noisy_estimator, &bad_estimator};
    for (int e = 0; e < 2; ++e)
        for (int shards = 2; shards <= 11; shards += 3) { /* 9 tiles: some shards of 11 are empty */
            options.shards = options.shard = 0;
            lc_film *whole = render(scene, estimators[e], options);
            options.shards = shards;
            options.shard = shards - 1;
            lc_film *sum = render(scene, estimators[e], options);
            ck_assert(sum->shard == shards - 1 && sum->shards == shards);
            for (options.shard = 0; options.shard < shards - 1; ++options.shard) {
                lc_film *film = render(scene, estimators[e], options);
                ck_assert_int_eq(lc_film_merge(sum, film, &err), LC_OK);
                lc_film_free(film);
            }
            ck_same_film(sum, whole);
            lc_film_free(sum);
            lc_film_free(whole);
        }
    lc_scene_free(scene);
}
END_TEST

START_TEST(bad_samples_are_counted_and_the_first_is_named)
{
    lc_scene *scene = small_scene();
    for (int threads = 1; threads <= 5; ++threads) {
        lc_render_options options = {.seed = 3, .arm = 4, .count = 640, .threads = threads};
        lc_film *film = render(scene, &bad_estimator, options);
        ck_assert_uint_eq(film->bad, BAD);
        ck_assert(film->bad_x == 77 % WIDTH && film->bad_y == 77 / WIDTH && film->bad_sample == 130);
        ck_assert(film->bad_value[0] == 1 && isinf(film->bad_value[1]) && film->bad_value[2] == 2);
        for (int i = 0; i < WIDTH * HEIGHT; ++i) {
            ck_assert(film->pixels[i].n == 640);
            for (int c = 0; c < 3; ++c)
                ck_assert(film->pixels[i].c[c].mean >= 0 && film->pixels[i].c[c].mean < 2);
        }
        lc_film_free(film);
    }
    lc_scene_free(scene);
}
END_TEST

static lc_rgb minus_zero(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                         lc_sampler *sampler)
{
    (void)scene, (void)ray, (void)hit, (void)options, (void)sampler;
    return lc_color(-0.0, 0, LC_LARGEST_SAMPLE);
}

/* -0 is 0, and large is not huge: the square of its variance is a number. */
START_TEST(odd_but_right_samples_are_not_bad)
{
    static const lc_estimator odd = {LC_ABI, "odd", "", "", 0, 0, 0, minus_zero};
    lc_scene *scene = small_scene();
    lc_film *film = render(scene, &odd, (lc_render_options){.count = 3});
    ck_assert_uint_eq(film->bad, 0);
    lc_film_free(film);
    lc_scene_free(scene);
}
END_TEST

static lc_rgb now_and_then_huge(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                                lc_sampler *sampler)
{
    (void)scene, (void)ray, (void)hit, (void)options;
    return lc_color(0, lc_next(sampler) < 0.5 ? 0 : sampler->pixel == 9 ? 1e61 : LC_LARGEST_SAMPLE, 0);
}

/* What cannot be squared is no sample: it used to end a whole run, by an error of the judge that named no sample. */
START_TEST(huge_samples_are_bad)
{
    static const lc_estimator huge = {LC_ABI, "huge", "", "", 0, 0, 0, now_and_then_huge};
    lc_scene *scene = small_scene();
    lc_film *film = render(scene, &huge, (lc_render_options){.count = 64});
    ck_assert(film->bad > 0 && film->bad < 64 && film->bad_x == 9 && film->bad_y == 0);
    ck_assert_double_eq(film->bad_value[1], 1e61);
    double sum = 0;
    for (int i = 0; i < WIDTH * HEIGHT; ++i) {
        double v = lc_pixel_variance(&film->pixels[i], 1);
        ck_assert(isfinite(film->pixels[i].c[1].m3));
        sum += v * v;
    }
    ck_assert(sum > 0 && isfinite(sum));
    lc_film_free(film);
    lc_scene_free(scene);
}
END_TEST

static void refuse(lc_film *film, const lc_scene *scene, const lc_estimator *estimator, lc_render_options options,
                   lc_status expected, const char *text)
{
    lc_error err = {""};
    uint64_t before = film->count;
    ck_assert_int_eq(lc_render(film, scene, estimator, &options, &err), expected);
    ck_assert_msg(strstr(err.text, text) != NULL, "message '%s' lacks '%s'", err.text, text);
    ck_assert_uint_eq(film->count, before);
}

START_TEST(bad_options_are_refused)
{
    lc_scene *scene = small_scene();
    lc_film *film;
    lc_error err;
    lc_estimator other = noisy_estimator;
    const lc_estimator *e = &noisy_estimator;
    other.abi = LC_ABI + 1;
    ck_assert_int_eq(lc_film_create(&film, 2, 2, &err), LC_OK);
    refuse(film, scene, &other, (lc_render_options){.count = 1}, LC_BAD_INPUT, "noisy: written for interface 2");
    refuse(film, scene, e, (lc_render_options){.count = 1, .max_bounces = 4}, LC_BAD_INPUT,
           "noisy: bounces 0 to 4, expected 0 to 3");
    refuse(film, scene, e, (lc_render_options){.count = 1, .min_bounces = -1}, LC_BAD_INPUT, "bounces -1 to 0");
    refuse(film, scene, e, (lc_render_options){.count = 1, .min_bounces = 2, .max_bounces = 1}, LC_BAD_INPUT,
           "bounces 2 to 1");
    refuse(film, scene, e, (lc_render_options){.count = 0}, LC_BAD_INPUT, "at least one");
    refuse(film, scene, e, (lc_render_options){.count = 2, .first = UINT32_MAX - 1}, LC_BAD_INPUT, "at most 2^32 - 1");
    refuse(film, scene, e, (lc_render_options){.count = UINT64_MAX, .first = 2}, LC_BAD_INPUT, "at most 2^32 - 1");
    refuse(film, scene, e, (lc_render_options){.count = 1, .shard = 3, .shards = 3}, LC_BAD_INPUT,
           "shard 3 of 3, expected 0 to 2");
    refuse(film, scene, e, (lc_render_options){.count = 1, .shard = -1, .shards = 3}, LC_BAD_INPUT, "shard -1 of 3");
    refuse(film, scene, e, (lc_render_options){.count = 1, .shards = LC_MAX_SHARDS + 1}, LC_BAD_INPUT, "1025");

    ck_assert_int_eq(lc_render(film, scene, e, &(lc_render_options){.count = 64, .seed = 1}, &err), LC_OK);
    static const char grows[] = "a film grows only by the next samples of its own stream";
    lc_render_options next = {.count = 64, .seed = 1, .first = 64}, wrong = next;
    refuse(film, scene, &bad_estimator, next, LC_FAULT, grows);
    wrong.seed = 2;
    refuse(film, scene, e, wrong, LC_FAULT, grows);
    wrong = next, wrong.arm = 1;
    refuse(film, scene, e, wrong, LC_FAULT, grows);
    wrong = next, wrong.first = 63;
    refuse(film, scene, e, wrong, LC_FAULT, grows);
    wrong = next, wrong.max_bounces = 1;
    refuse(film, scene, e, wrong, LC_FAULT, grows);
    wrong = next, wrong.shards = 2;
    refuse(film, scene, e, wrong, LC_FAULT, grows);
    ck_assert_int_eq(lc_render(film, scene, e, &next, &err), LC_OK);
    lc_film_free(film);
    lc_scene_free(scene);
}
END_TEST

typedef struct progress_log {
    double last;
    int calls, fell;
} progress_log;

static void follow(void *user, double done)
{
    progress_log *log = user;
    log->fell += done < log->last;
    log->last = done;
    ++log->calls;
}

START_TEST(progress_rises_to_one)
{
    lc_scene *scene = small_scene();
    for (int i = 0; i < 20; ++i) {
        progress_log log = {0, 0, 0};
        lc_render_options options = {.count = 30, .threads = 1 + i % 5, .progress = follow, .user = &log};
        options.shards = i / 5;
        lc_film *film = render(scene, &noisy_estimator, options);
        ck_assert_msg(log.fell == 0 && log.last == 1, "%d threads, %d shards: fell %d times, ended at %g",
                      options.threads, options.shards, log.fell, log.last);
        lc_film_free(film);
    }
    lc_scene_free(scene);
}
END_TEST

/* ---- replay ---------------------------------------------------------------------------------------------------- */

static void count_line(void *user, const char *text)
{
    ck_assert_ptr_null(strchr(text, '\n'));
    ++*(int *)user;
}

static lc_scene *load(const char *name)
{
    lc_scene_desc desc;
    lc_error err = {""};
    ck_assert_msg(lc_scene_describe(&desc, name, &err) == LC_OK, "%s", err.text);
    return build_scene(&desc);
}

static int same_hit(const lc_hit *a, const lc_hit *b)
{
    return a->valid == b->valid && a->wo.x == b->wo.x && a->time == b->time &&
           (!a->valid || (a->part == b->part && a->shape == b->shape && a->p.x == b->p.x && a->p.y == b->p.y &&
                          a->p.z == b->p.z && a->n.z == b->n.z && a->distance == b->distance));
}

/* Eight camera rays traced together see what each sees alone, to the bit, but for one in a thousand that meets an edge. Flat, round and
 * textured parts, misses, and a camera so far off that its rays start at the scene's border. */
START_TEST(a_packet_sees_what_its_rays_see)
{
    static const char *const names[] = {"five_lights", "furnace_sphere", "cornell_small",
                                        "glass_sphere", "plane_disk",    "cornell"};
    for (size_t k = 0; k < sizeof names / sizeof names[0]; ++k) {
        lc_scene *scene = load(names[k]);
        lc_camera_desc camera = lc_scene_description(scene)->camera;
        int rays = 0, other = 0;
        if (k == 5)
            camera.to_world.m[1][3] -= 100;
        for (int i = 0; i < 32 * 32; ++i) {
            lc_ray ray[LC_PACKET];
            lc_hit hit[LC_PACKET], alone;
            for (int j = 0; j < LC_PACKET; ++j)
                ray[j] = lc_camera_ray(&camera, 32, 32, i % 32 + (j + 0.37) / LC_PACKET,
                                       i / 32 + (j * 5 % LC_PACKET + 0.59) / LC_PACKET);
            lc_camera_see_packet(scene, ray, hit);
            for (int j = 0; j < LC_PACKET; ++j, ++rays) {
                lc_camera_see(scene, &ray[j], &alone);
                other += !same_hit(&hit[j], &alone);
            }
        }
        ck_assert_msg(1000 * other <= rays, "%s: %d of %d rays", names[k], other, rays);
        lc_scene_free(scene);
    }
}
END_TEST

/* A film of one sample is made of what the replay gives, bit for bit. */
START_TEST(replay_is_what_the_film_saw)
{
    lc_scene *scene = load("five_lights");
    for (const lc_estimator *const *e = lc_estimators; *e; ++e) {
        lc_render_options options = {.seed = 9, .arm = lc_arm((*e)->name), .first = 5, .count = 1};
        options.max_bounces = (*e)->max_bounces < 3 ? (*e)->max_bounces : 3;
        lc_film *film = render(scene, *e, options);
        for (int i = 0; i < WIDTH * HEIGHT; ++i) {
            int lines = 0;
            lc_trace_log log = {count_line, &lines};
            lc_rgb c = lc_replay(scene, *e, &options, WIDTH, HEIGHT, i % WIDTH, i / WIDTH, 5, &log);
            const lc_moments *m = film->pixels[i].c;
            ck_assert_msg(c.r == m[0].mean && c.g == m[1].mean && c.b == m[2].mean, "%s: pixel %d", (*e)->name, i);
            ck_assert_int_ge(lines, 3); /* two draws and the camera's hit */
        }
        lc_film_free(film);
    }
    lc_scene_free(scene);
}
END_TEST

/* Of shipped estimators: one ray to the lamp from each hit, from its three numbers; one ray from two numbers. */
START_TEST(costs_of_direct_light)
{
    static const struct {
        const char *name;
        double numbers;
    } known[] = {{"light_direct", 3}, {"hemisphere_direct", 2}};
    lc_scene *scene = load("plane_rectangle");
    lc_render_options options = {.seed = 3, .count = 4, .min_bounces = 1, .max_bounces = 1, .threads = 2, .costs = 1};
    const lc_estimator *const *e = lc_estimators;
    while (strcmp((*e)->name, known[_i].name) != 0)
        ++e;
    lc_film *film = render(scene, *e, options);
    int hits = 0;
    for (int i = 0; i < WIDTH * HEIGHT; ++i) {
        const lc_pixel *p = &film->pixels[i];
        ck_assert_double_eq_tol(p->c[1].mean, known[_i].numbers * p->c[0].mean, 1e-12);
        hits += !(fabs(p->c[0].mean - 1) > 0);
    }
    ck_assert_int_gt(hits, WIDTH * HEIGHT / 2);
    lc_film_free(film);
    lc_scene_free(scene);
}
END_TEST

Suite *lc_suite_render(void)
{
    Suite *suite = suite_create("render");
    TCase *tc = tcase_create("core");
    tcase_set_timeout(tc, 60);
    tcase_add_test(tc, any_number_of_threads_gives_the_same_film);
    tcase_add_test(tc, costs_are_counted);
    tcase_add_loop_test(tc, costs_of_direct_light, 0, 2);
    tcase_add_test(tc, a_film_grows_to_what_it_would_have_been);
    tcase_add_test(tc, shards_make_the_whole);
    tcase_add_test(tc, bad_samples_are_counted_and_the_first_is_named);
    tcase_add_test(tc, odd_but_right_samples_are_not_bad);
    tcase_add_test(tc, huge_samples_are_bad);
    tcase_add_test(tc, bad_options_are_refused);
    tcase_add_test(tc, progress_rises_to_one);
    tcase_add_test(tc, a_packet_sees_what_its_rays_see);
    tcase_add_test(tc, replay_is_what_the_film_saw);
    suite_add_tcase(suite, tc);
    return suite;
}
