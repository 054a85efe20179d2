/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes that are drawn: by the seed alone, each another one, and each such that its closed form applies. */
#include "verify/tests/tests.h"

#include <stdlib.h>

#include "verify/analytic/analytic.h"
#include "verify/checks/family.h"
#include "verify/judge/judge.h"
#include "verify/tests/scene_help.h"

enum { SEEDS = 200 };

static lc_scene_desc draw(const lc_family *family, uint64_t seed)
{
    lc_scene_desc desc;
    lc_error err = {""};
    ck_assert_msg(lc_family_describe(&desc, family, seed, &err) == LC_OK, "%s", err.text);
    return desc;
}

static int same(const lc_scene_desc *a, const lc_scene_desc *b)
{
    if (a->shape_count != b->shape_count || memcmp(&a->camera.to_world, &b->camera.to_world, sizeof(lc_affine)) != 0)
        return 0;
    for (int i = 0; i < a->shape_count; ++i)
        if (memcmp(&a->shapes[i].to_world, &b->shapes[i].to_world, sizeof(lc_affine)) != 0 ||
            memcmp(&a->shapes[i].radiance.color, &b->shapes[i].radiance.color, 2 * sizeof(lc_rgb)) != 0)
            return 0;
    return 1;
}

START_TEST(the_seed_alone_decides)
{
    const lc_family *family = &lc_families[_i];
    lc_scene_desc a = draw(family, 7), b = draw(family, 7), c = draw(family, 8);
    ck_assert(same(&a, &b));
    ck_assert(!same(&a, &c));
    ck_assert_ptr_eq(lc_family_find(family->name), family);
    int in_suites = 0;
    for (const char *const *s = lc_suite_scenes; *s; ++s)
        in_suites += strcmp(*s, family->name) == 0;
    ck_assert_int_eq(in_suites, 1);
    lc_scene_desc_release(&a);
    lc_scene_desc_release(&b);
    lc_scene_desc_release(&c);
}
END_TEST

/* Share of the image's pixels whose centre sees `shape`. */
static double share_of(const lc_scene *scene, int shape)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    int seen = 0;
    for (int i = 0; i < desc->width * desc->height; ++i) {
        lc_ray ray = lc_camera_ray(&desc->camera, desc->width, desc->height, i % desc->width + 0.5,
                                   i / desc->width + 0.5);
        lc_hit hit;
        lc_camera_see(scene, &ray, &hit);
        seen += hit.valid && hit.shape == shape;
    }
    return seen / (double)(desc->width * desc->height);
}

/* The receiver (or sphere, mirror, slab), which is shape 0, fills most of the image, so that no row judges nothing. */
START_TEST(the_camera_sees_what_it_is_about)
{
    const lc_family *family = &lc_families[_i];
    int all = strcmp(family->name, "random_furnace") == 0 || strcmp(family->name, "random_corridor") == 0 ||
              strcmp(family->name, "random_slab") == 0;
    for (uint64_t seed = 1; seed <= SEEDS; ++seed) {
        lc_scene_desc desc = draw(family, seed);
        lc_scene *scene = build_scene(&desc);
        double share = share_of(scene, 0);
        ck_assert_msg(all ? share == 1 : share > 0.5, "%s, seed %d: %g of the image", family->name, (int)seed, share);
        lc_scene_free(scene);
    }
}
END_TEST

/* Lamps neither touch the plane nor each other, and light the middle of the image. */
START_TEST(lamps_stand_apart)
{
    const lc_family *family = &lc_families[_i];
    lc_error err = {""};
    for (uint64_t seed = 1; seed <= SEEDS; ++seed) {
        lc_scene_desc desc = draw(family, seed);
        lc_affine back;
        ck_assert(lc_affine_invert(&back, &desc.shapes[0].to_world));
        lc_vec3 centre[4];
        double reach[4];
        for (int i = 1; i < desc.shape_count; ++i) {
            const lc_affine *m = &desc.shapes[i].to_world;
            int flat = desc.shapes[i].kind != LC_SPHERE;
            double a = lc_length(lc_affine_vector(m, lc_vec(1, 0, 0))), b = lc_length(lc_affine_vector(m, lc_vec(0, 1, 0)));
            double c = lc_length(lc_affine_vector(m, lc_vec(0, 0, 1)));
            reach[i] = desc.shapes[i].kind == LC_CUBE        ? sqrt(a * a + b * b + c * c)
                       : desc.shapes[i].kind == LC_RECTANGLE ? hypot(a, b)
                                                             : fmax(a, b);
            centre[i] = lc_affine_point(m, lc_vec(0, 0, 0));
            for (int k = 0; k < 64; ++k) { /* its rim is above the plane */
                lc_vec3 rim = desc.shapes[i].kind == LC_RECTANGLE
                                  ? lc_vec(k % 2 ? 1 : -1, k % 4 / 2 ? 1 : -1, 0)
                                  : lc_vec(cos(k * LC_PI / 32), sin(k * LC_PI / 32), 0);
                if (desc.shapes[i].kind == LC_CUBE)
                    rim = lc_vec(k % 2 ? 1 : -1, k % 4 / 2 ? 1 : -1, k % 8 / 4 ? 1 : -1);
                else if (!flat)
                    rim = lc_vec(cos(k * LC_PI / 32), 0, sin(k * LC_PI / 32));
                ck_assert_double_gt(lc_affine_point(&back, lc_affine_point(m, rim)).z, 0);
            }
            for (int k = 1; k < i; ++k)
                ck_assert_msg(lc_length(lc_sub(centre[i], centre[k])) > reach[i] + reach[k],
                              "%s, seed %d: two lamps may touch", family->name, (int)seed);
        }
        lc_rgb e;
        const lc_affine *plane = &desc.shapes[0].to_world;
        lc_vec3 n = lc_normalize(lc_affine_vector(plane, lc_vec(0, 0, 1)));
        ck_assert_int_eq(lc_direct_unoccluded(&e, &desc, lc_affine_point(plane, lc_vec(0, 0, 0)), n, &err), LC_OK);
        ck_assert_double_gt(e.r, 0);
        lc_scene_desc_release(&desc);
    }
}
END_TEST

/* Else it would be random_lights once more. */
START_TEST(the_camera_sees_the_shadow)
{
    const lc_family *family = lc_family_find("random_occluder");
    int kinds[2][4] = {{0}, {0}};
    lc_error err = {""};
    for (uint64_t seed = 1; seed <= SEEDS; ++seed) {
        lc_scene_desc drawn = draw(family, seed);
        lc_scene *scene = build_scene(&drawn);
        const lc_scene_desc *desc = lc_scene_description(scene);
        int dark = 0, bright = 0;
        ++kinds[0][desc->shapes[1].kind];
        ++kinds[1][desc->shapes[2].kind];
        for (int i = 0; i < 256; ++i) {
            lc_ray ray = lc_camera_ray(&desc->camera, 16, 16, i % 16 + 0.5, i / 16 + 0.5);
            lc_hit hit;
            lc_rgb is, free;
            lc_camera_see(scene, &ray, &hit);
            if (!hit.valid || hit.shape != 0)
                continue;
            ck_assert_int_eq(lc_direct_irradiance(&is, desc, hit.p, hit.n, &err), LC_OK);
            ck_assert_int_eq(lc_direct_unoccluded(&free, desc, hit.p, hit.n, &err), LC_OK);
            dark += is.g < 0.9 * free.g;
            bright += is.g > 0.9999 * free.g;
        }
        ck_assert_msg(dark >= 4 && bright >= 4, "seed %d: %d of 256 points in the shadow, %d outside", (int)seed, dark,
                      bright);
        lc_scene_free(scene);
    }
    for (int i = 0; i < 8; ++i) /* no cube shines */
        ck_assert(kinds[i / 4][i % 4] > SEEDS / 10 || i == LC_CUBE);
}
END_TEST

static int count_families(void)
{
    int count = 0;
    while (lc_families[count].name)
        ++count;
    return count;
}

Suite *lc_suite_family(void)
{
    Suite *suite = suite_create("family");
    TCase *c = tcase_create("family");
    tcase_set_timeout(c, 60);
    tcase_add_loop_test(c, the_seed_alone_decides, 0, count_families());
    tcase_add_loop_test(c, the_camera_sees_what_it_is_about, 0, count_families());
    tcase_add_loop_test(c, lamps_stand_apart, 0, 5); /* those over a plane stand first */
    tcase_add_test(c, the_camera_sees_the_shadow);
    suite_add_tcase(suite, c);
    return suite;
}
