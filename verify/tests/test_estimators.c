/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What every estimator promises in lightcheck.h, whatever it estimates. The registry is walked: a new one is held to it. */
#include "verify/tests/tests.h"

#include <ctype.h>
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "estimators/registry.h"
#include "io/scene_read.h"
#include "verify/mutants/registry.h"
#include "verify/tests/scene_help.h"

static void load_desc(lc_scene_desc *desc, const char *name)
{
    lc_error err = {""};
    ck_assert_msg(lc_scene_describe(desc, name, &err) == LC_OK, "%s", err.text);
}

static lc_scene *load(const char *name)
{
    lc_scene_desc desc;
    load_desc(&desc, name);
    return build_scene(&desc);
}

static int most_bounces(const lc_estimator *e, int most) { return e->max_bounces < most ? e->max_bounces : most; }

static lc_film *render(const lc_scene *scene, const lc_estimator *e, int samples, int size)
{
    lc_film *film;
    lc_error err = {""};
    lc_render_options options = {.max_bounces = most_bounces(e, 5), .seed = 1, .arm = 7, .count = (uint64_t)samples};
    ck_assert_int_eq(lc_film_create(&film, size, size, &err), LC_OK);
    ck_assert_msg(lc_render(film, scene, e, &options, &err) == LC_OK, "%s", err.text);
    ck_assert_msg(film->bad == 0, "%s on %s: %llu bad samples", e->name, film->scene, (unsigned long long)film->bad);
    return film;
}

static double total(const lc_film *film)
{
    double sum = 0;
    for (int i = 0; i < film->width * film->height; ++i)
        sum += film->pixels[i].c[0].mean + film->pixels[i].c[1].mean + film->pixels[i].c[2].mean;
    return sum;
}

static void ck_descriptor(const lc_estimator *e)
{
    ck_assert_int_eq(e->abi, LC_ABI);
    ck_assert_uint_gt(strlen(e->name), 0);
    ck_assert_uint_lt(strlen(e->name), 64);
    for (const char *c = e->name; *c; ++c)
        ck_assert_msg(isalnum((unsigned char)*c) || *c == '_', "%s", e->name);
    ck_assert_msg(strlen(e->summary) > 0 && !strchr(e->summary, '\n'), "%s: summary", e->name);
    ck_assert_msg(strlen(e->source) > 0 && !strchr(e->source, '\n'), "%s: source", e->name);
    ck_assert_uint_eq(e->lobes & ~(unsigned)(LC_DIFFUSE | LC_MIRROR | LC_GLASS | LC_GLOSSY), 0);
    ck_assert_uint_eq(e->emitters & ~(unsigned)(LC_AREA | LC_POINT | LC_DIRECTIONAL | LC_SKY), 0);
    ck_assert(e->max_bounces >= 0 && e->max_bounces <= LC_UNBOUNDED);
    ck_assert(e->radiance != NULL);
}

/* name = file = descriptor */
START_TEST(descriptors_are_sane)
{
    char path[128];
    for (const lc_estimator *const *e = lc_estimators; *e; ++e) {
        ck_descriptor(*e);
        snprintf(path, sizeof path, "estimators/%s.c", (*e)->name);
        ck_assert_msg(access(path, R_OK) == 0, "no %s", path);
        for (const lc_estimator *const *f = lc_estimators; f < e; ++f)
            ck_assert_str_ne((*e)->name, (*f)->name);
    }
    const lc_mutant *m;
    for (int i = 0; (m = lc_mutant_at(i)) != NULL; ++i) {
        int known = 0;
        ck_descriptor(m->estimator);
        for (const lc_estimator *const *e = lc_estimators; *e; ++e)
            known |= strcmp((*e)->name, m->of) == 0;
        ck_assert_msg(known, "%s is of %s, which is no estimator", m->estimator->name, m->of);
    }
}
END_TEST

static lc_rgb sample_of(const lc_scene *scene, const lc_estimator *e, int low, int high, int i)
{
    lc_options bounces = {low, high};
    lc_sampler sampler;
    lc_hit hit;
    lc_sampler_start(&sampler, 5, 6, (uint32_t)i, 0);
    double x = 16 * lc_next(&sampler), y = 16 * lc_next(&sampler);
    lc_ray ray = lc_camera_ray(&lc_scene_description(scene)->camera, 16, 16, x, y);
    lc_camera_see(scene, &ray, &hit);
    lc_sampler_seek(&sampler, LC_DIMENSION_ESTIMATOR);
    return e->radiance(scene, &ray, &hit, &bounces, &sampler);
}

static void ck_near(const lc_estimator *e, double a, double b)
{
    ck_assert_msg(fabs(a - b) <= 1e-12 * (fabs(a) + fabs(b)), "%s: %.17g, expected %.17g", e->name, a, b);
}

/* L_0 + L_1 of one stream are the two terms of that stream; L_0 is the emission; beyond the last bounce is nothing. */
START_TEST(bounces_add_up)
{
    static const char *const scenes[] = {"cornell", "five_lights", "sky", "furnace_checker"};
    for (int s = 0; s < 4; ++s) {
        lc_scene *scene = load(scenes[s]);
        for (const lc_estimator *const *p = lc_estimators; *p; ++p) {
            const lc_estimator *e = *p;
            for (int i = 0; i < 2000; ++i) {
                lc_rgb zero = sample_of(scene, e, 0, 0, i);
                lc_sampler sampler;
                lc_sampler_start(&sampler, 5, 6, (uint32_t)i, 0);
                double x = 16 * lc_next(&sampler), y = 16 * lc_next(&sampler);
                lc_ray ray = lc_camera_ray(&lc_scene_description(scene)->camera, 16, 16, x, y);
                lc_hit hit;
                lc_camera_see(scene, &ray, &hit);
                lc_rgb emitted = lc_emission(scene, &hit);
                ck_assert_msg(zero.r == emitted.r && zero.g == emitted.g && zero.b == emitted.b, "%s on %s: L_0",
                              e->name, scenes[s]);
                if (e->max_bounces >= 1) {
                    lc_rgb one = sample_of(scene, e, 1, 1, i), both = sample_of(scene, e, 0, 1, i);
                    ck_near(e, both.r, zero.r + one.r);
                    ck_near(e, both.g, zero.g + one.g);
                    ck_near(e, both.b, zero.b + one.b);
                }
                if (e->max_bounces < LC_UNBOUNDED) {
                    lc_rgb beyond = sample_of(scene, e, e->max_bounces + 1, e->max_bounces + 1, i);
                    ck_assert(lc_rgb_max(beyond) == 0);
                }
            }
        }
        lc_scene_free(scene);
    }
}
END_TEST

/* Means of 8x8 tiles; a scene of millimetres or kilometres is the same image from the same stream. */
static double worst_tile(const lc_film *a, const lc_film *b)
{
    double worst = 0, floor = 1e-3 * total(b) / (a->width * a->height) * 64; /* of dark tiles */
    for (int y = 0; y < a->height; y += 8)
        for (int x = 0; x < a->width; x += 8) {
            double sum[2] = {0, 0};
            for (int i = 0; i < 64; ++i) {
                int k = (y + i / 8) * a->width + x + i % 8;
                for (int c = 0; c < 3; ++c) {
                    sum[0] += a->pixels[k].c[c].mean;
                    sum[1] += b->pixels[k].c[c].mean;
                }
            }
            worst = fmax(worst, fabs(sum[0] - sum[1]) / fmax(sum[1], floor));
        }
    return worst;
}

START_TEST(scale_does_not_show)
{
    static const char *const scenes[] = {"cornell", "five_lights", "occluder", "mixed_lights"};
    static const double scales[] = {1e-3, 1e3};
    for (int s = 0; s < 4; ++s)
        for (const lc_estimator *const *e = lc_estimators; *e; ++e) {
            lc_scene *unit = load(scenes[s]);
            lc_film *expected = render(unit, *e, 64, 32);
            for (int k = 0; k < 2; ++k) {
                lc_scene_desc desc;
                load_desc(&desc, scenes[s]);
                scale_desc(&desc, scales[k]);
                lc_scene *scene = build_scene(&desc);
                lc_film *film = render(scene, *e, 64, 32);
                double off = worst_tile(film, expected);
                ck_assert_msg(off < 1e-4, "%s on %s x %g: a tile is off by %g", (*e)->name, scenes[s], scales[k], off);
                lc_film_free(film);
                lc_scene_free(scene);
            }
            lc_film_free(expected);
            lc_scene_free(unit);
        }
}
END_TEST

START_TEST(no_light_no_light)
{
    lc_scene *scene = load("no_lights");
    for (const lc_estimator *const *e = lc_estimators; *e; ++e) {
        lc_film *film = render(scene, *e, 64, 16);
        ck_assert_msg(total(film) == 0, "%s: %g", (*e)->name, total(film));
        lc_film_free(film);
    }
    lc_scene_free(scene);
}
END_TEST

/* Odd places to look from: nothing crashes, and no sample is NaN, infinite or negative. The camera is at the origin
 * and looks along +z. */
START_TEST(odd_cameras_do_no_harm)
{
    for (int i = 0; i < 8; ++i) {
        lc_scene_desc desc;
        lc_scene_desc_init(&desc);
        switch (i) {
        case 0: /* nothing at all */
            break;
        case 1: /* nothing but a sky */
            desc.has_sky = 1;
            desc.sky = lc_color(1, 2, 3);
            break;
        case 2: /* in the plane of an emitting wall that it looks along, */
            add_lamp(&desc, LC_RECTANGLE, pose_rotate(lc_vec(1, 0, 0), 0), lc_color(1, 1, 1));
            break;
        case 3: /* or across */
            add_lamp(&desc, LC_RECTANGLE, pose_scale(1, 1, 1), lc_color(1, 1, 1));
            break;
        case 4: /* on the skin of a sphere */
            add_lamp(&desc, LC_SPHERE, pose_translate(0, 0, 1), lc_color(1, 1, 1));
            break;
        case 5: /* within one that shines inwards */
            add_lamp(&desc, LC_SPHERE, pose_scale(2, 2, 2), lc_color(1, 1, 1))->flip_normals = 1;
            break;
        case 6: /* within a cube that shines outwards */
            add_lamp(&desc, LC_CUBE, pose_scale(2, 2, 2), lc_color(1, 1, 1));
            break;
        default: /* at a point light, which also lies on a surface */
            add_shape(&desc, LC_RECTANGLE, pose_translate(0, 0, 0));
            add_shape(&desc, LC_RECTANGLE, pose_translate(0, 0, 2))->flip_normals = 1;
            lc_scene_desc_add_point(&desc)->intensity = lc_color(1, 1, 1);
        }
        lc_scene *scene = build_scene(&desc);
        for (const lc_estimator *const *e = lc_estimators; *e; ++e) {
            lc_film *film = render(scene, *e, 64, 16);
            if (i == 0 || i == 6)
                ck_assert(total(film) == 0);
            if (i == 1) /* a miss sees the sky */
                ck_near(*e, total(film), 6 * 256);
            lc_film_free(film);
        }
        lc_scene_free(scene);
    }
}
END_TEST

/* ---- the template ------------------------------------------------------------------------------------------ */

static int have(const char *program)
{
    char command[128];
    snprintf(command, sizeof command, "command -v %s >/dev/null 2>&1", program);
    return system(command) == 0;
}

#define STRICT "-pedantic -Wall -Wextra -Wshadow -Wconversion -Werror -Isrc/core"

START_TEST(template_is_c99_and_cxx17)
{
    ck_assert_int_eq(system("cc -std=c99 " STRICT " -fsyntax-only estimators/template.c"), 0);
    if (have("g++"))
        ck_assert_int_eq(system("g++ -std=c++17 " STRICT " -x c++ -fsyntax-only estimators/template.c"), 0);
    /* The test would notice: */
    ck_assert_int_ne(system("cc -std=c99 " STRICT " -fsyntax-only -DLC_ABI=x estimators/template.c 2>/dev/null"), 0);
}
END_TEST

START_TEST(template_is_a_plugin)
{
    char library[] = "/tmp/lightcheck-test-XXXXXX", command[512];
    int fd = mkstemp(library);
    ck_assert_int_ge(fd, 0);
    close(fd);
    snprintf(command, sizeof command, "cc -std=c99 " STRICT " -DLC_PLUGIN -shared -fPIC -o %s estimators/template.c",
             library);
    ck_assert_int_eq(system(command), 0);
    void *handle = dlopen(library, RTLD_LAZY | RTLD_LOCAL);
    unlink(library);
    ck_assert_msg(handle != NULL, "%s", dlerror());
    const lc_estimator *plugin = dlsym(handle, "lc_plugin");
    ck_assert_msg(plugin != NULL, "%s", dlerror());
    ck_descriptor(plugin);
    ck_assert_str_eq(plugin->name, "template");
    dlclose(handle);
}
END_TEST

Suite *lc_suite_estimators(void)
{
    Suite *suite = suite_create("estimators");
    TCase *tc = tcase_create("core");
    tcase_set_timeout(tc, 120);
    tcase_add_test(tc, descriptors_are_sane);
    tcase_add_test(tc, bounces_add_up);
    tcase_add_test(tc, scale_does_not_show);
    tcase_add_test(tc, no_light_no_light);
    tcase_add_test(tc, odd_cameras_do_no_harm);
    tcase_add_test(tc, template_is_c99_and_cxx17);
    tcase_add_test(tc, template_is_a_plugin);
    suite_add_tcase(suite, tc);
    return suite;
}
