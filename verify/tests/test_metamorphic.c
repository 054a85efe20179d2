/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes made of scenes, differences of films, and what the relations say of the right and of the black. */
#include "verify/tests/tests.h"

#include <stdio.h>
#include <stdlib.h>

#include "estimators/registry.h"
#include "verify/checks/transform.h"
#include "verify/judge/judge.h"
#include "verify/tests/load_help.h"
#include "verify/tests/scene_help.h"

enum { SIDE = 16 };

static lc_scene_desc read_scene(const char *name)
{
    lc_scene_desc desc;
    lc_error err = {""};
    ck_assert_msg(lc_scene_describe(&desc, name, &err) == LC_OK, "%s", err.text);
    desc.width = desc.height = SIDE;
    return desc;
}

static lc_status load_small(lc_scene **out, const char *name, lc_error *err)
{
    return load_sized(out, name, SIDE, err);
}

static const lc_estimator *find(const char *name)
{
    for (const lc_estimator *const *e = lc_estimators; *e; ++e)
        if (strcmp((*e)->name, name) == 0)
            return *e;
    ck_abort_msg("no estimator %s", name);
    return NULL;
}

static lc_film *render(const lc_scene *scene, const lc_estimator *estimator, int most, const lc_term *minus)
{
    lc_film *film;
    lc_error err = {""};
    lc_render_options options = {.min_bounces = 1, .max_bounces = most, .seed = 5, .arm = 9, .count = 64};
    options.minus = minus;
    options.minus_count = minus ? 1 : 0;
    ck_assert_int_eq(lc_film_create(&film, SIDE, SIDE, &err), LC_OK);
    ck_assert_msg(lc_render(film, scene, estimator, &options, &err) == LC_OK, "%s", err.text);
    ck_assert_uint_eq(film->bad, 0);
    return film;
}

/* ---- differences ---------------------------------------------------------------------------------------------------- */

START_TEST(a_difference_is_the_difference)
{
    lc_scene_desc desc = read_scene("five_lights");
    lc_scene *scene = build_scene(&desc);
    desc = read_scene("plane_tilted");
    lc_scene *other = build_scene(&desc);
    const lc_estimator *e = find("light_direct");
    lc_term term = {other, 0.75, 0};
    lc_film *a = render(scene, e, 1, NULL), *b = render(other, e, 1, NULL), *d = render(scene, e, 1, &term);
    int negative = 0;
    for (int i = 0; i < SIDE * SIDE; ++i) {
        double expected = a->pixels[i].c[1].mean - 0.75 * b->pixels[i].c[1].mean;
        ck_assert_double_eq_tol(d->pixels[i].c[1].mean, expected, 1e-12);
        negative += expected < 0;
    }
    ck_assert_int_gt(negative, 0); /* which a film of its own would call bad */
    lc_film_free(a);
    lc_film_free(b);
    lc_film_free(d);
    lc_scene_free(scene);
    lc_scene_free(other);
}
END_TEST

static lc_rgb bad(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                  lc_sampler *sampler)
{
    (void)ray, (void)hit, (void)options, (void)sampler;
    return lc_color(1, 1, lc_light_count(scene) > 1 ? -1 : 1);
}

START_TEST(bad_samples_of_a_term_are_found)
{
    lc_scene_desc desc = read_scene("five_lights");
    lc_scene *many = build_scene(&desc);
    desc = read_scene("plane_tilted");
    lc_scene *one = build_scene(&desc);
    const lc_estimator e = {LC_ABI, "bad", "", "", LC_DIFFUSE, LC_AREA, 1, bad};
    lc_term term = {many, 1, 0};
    lc_error err = {""};
    lc_film *film;
    lc_render_options options = {.min_bounces = 1, .max_bounces = 1, .count = 64, .minus = &term, .minus_count = 1};
    ck_assert_int_eq(lc_film_create(&film, SIDE, SIDE, &err), LC_OK);
    ck_assert_int_eq(lc_render(film, one, &e, &options, &err), LC_OK);
    ck_assert_uint_eq(film->bad, 64 * SIDE * SIDE);
    term.shift = 2; /* a bounce less than none */
    ck_assert_int_eq(lc_render(film, one, &e, &options, &err), LC_BAD_INPUT);
    term.shift = -1; /* more than the estimator can */
    ck_assert_int_eq(lc_render(film, one, &e, &options, &err), LC_BAD_INPUT);
    options.minus_count = LC_MAX_TERMS + 1;
    ck_assert_int_eq(lc_render(film, one, &e, &options, &err), LC_BAD_INPUT);
    lc_film_free(film);
    lc_scene_free(many);
    lc_scene_free(one);
}
END_TEST

/* ---- powers of two, to the bit --------------------------------------------------------------------------------------- */

static const char *const fixed_length[] = {"hemisphere_direct", "light_direct", "three_point",
                                           "path",              "mirror",       "dielectric"};

static void ck_same_bits(const char *name, const lc_estimator *e, const lc_scene *scene, lc_scene_desc *changed,
                         double factor, int least, int most)
{
    lc_scene *other = build_scene(changed);
    lc_term term = {other, factor, 0};
    lc_film *film;
    lc_error err = {""};
    lc_render_options options = {.min_bounces = least, .max_bounces = most, .seed = 3, .count = 64};
    options.minus = &term;
    options.minus_count = 1;
    ck_assert_int_eq(lc_film_create(&film, SIDE, SIDE, &err), LC_OK);
    ck_assert_msg(lc_render(film, scene, e, &options, &err) == LC_OK, "%s", err.text);
    for (int i = 0; i < SIDE * SIDE; ++i)
        for (int c = 0; c < 3; ++c)
            ck_assert_msg(film->pixels[i].c[c].mean == 0 && film->pixels[i].c[c].m2 == 0 && film->bad == 0,
                          "%s, %s: pixel %d differs by %g", name, e->name, i, film->pixels[i].c[c].mean);
    lc_film_free(film);
    lc_scene_free(other);
}

START_TEST(powers_of_two_give_the_same_bits)
{
    const lc_estimator *e = find(fixed_length[_i]);
    static const char *const scenes[] = {"bright_mirrors", "cornell_glass", "mixed_lights"};
    for (int s = 0; s < 3; ++s) {
        lc_scene_desc desc = read_scene(scenes[s]), changed;
        lc_error err = {""};
        int most = e->max_bounces < 3 ? e->max_bounces : 3, k = most < 2 ? most : 2;
        lc_scene_desc copy;
        ck_assert_int_eq(lc_scene_desc_copy(&copy, &desc, &err), LC_OK);
        lc_scene *scene = build_scene(&desc);
        ck_assert_int_eq(lc_scene_desc_copy(&changed, &copy, &err), LC_OK);
        lc_transform_emission(&changed, 1024);
        ck_same_bits("emission", e, scene, &changed, 1.0 / 1024, 1, most);
        ck_assert_int_eq(lc_scene_desc_copy(&changed, &copy, &err), LC_OK);
        lc_transform_albedo(&changed, 0.5);
        ck_same_bits("albedo", e, scene, &changed, ldexp(1, k), k, k);
        for (int large = 0; large < 2; ++large) {
            ck_assert_int_eq(lc_scene_desc_copy(&changed, &copy, &err), LC_OK);
            lc_transform_scale(&changed, large ? 1024 : 1.0 / 1024);
            ck_same_bits("scale", e, scene, &changed, 1, 1, most);
        }
        lc_scene_desc_release(&copy);
        lc_scene_free(scene);
    }
}
END_TEST

/* ---- transforms ------------------------------------------------------------------------------------------------------ */

static double area_of_lamps(const lc_scene_desc *desc)
{
    lc_scene *scene;
    lc_error err = {""};
    ck_assert_int_eq(lc_scene_build(&scene, desc, &err), LC_OK);
    double area = lc_scene_emitting_area(scene);
    lc_scene_free(scene);
    return area;
}

START_TEST(pieces_have_the_area_and_the_texture_of_the_whole)
{
    lc_scene_desc desc = read_scene("textured_lamp");
    lc_error err = {""};
    int before = desc.shape_count, lamp = 0;
    double area = area_of_lamps(&desc);
    while (!desc.shapes[lamp].emits)
        ++lamp;
    lc_texture whole = desc.shapes[lamp].radiance;
    ck_assert(whole.is_checkerboard);
    ck_assert_int_eq(lc_transform_cut(&desc, 1, 2, 2, &err), LC_OK);
    ck_assert_int_eq(desc.shape_count, before + 3);
    ck_assert_double_eq_tol(area_of_lamps(&desc), area, 1e-12 * area);
    uint64_t state = 1;
    for (int i = 0; i < 1000; ++i) {
        double u = next_uniform(&state), v = next_uniform(&state);
        int piece = (u >= 0.5) + 2 * (v >= 0.5);
        const lc_shape_desc *part = &desc.shapes[piece == 0 ? lamp : before + piece - 1];
        lc_rgb is = lc_texture_at(&part->radiance, 2 * u - (u >= 0.5), 2 * v - (v >= 0.5));
        lc_rgb should = lc_texture_at(&whole, u, v);
        ck_assert(is.r == should.r && is.g == should.g && is.b == should.b);
    }
    lc_scene_desc_release(&desc);
}
END_TEST

START_TEST(each_light_shines_alone_once)
{
    lc_scene_desc whole = read_scene("mixed_lights");
    lc_error err = {""};
    int count = lc_transform_lights(&whole), seen[3] = {0, 0, 0};
    ck_assert_int_eq(count, 3);
    for (int i = 0; i < count; ++i) {
        lc_scene_desc desc;
        ck_assert_int_eq(lc_scene_desc_copy(&desc, &whole, &err), LC_OK);
        lc_transform_only_light(&desc, i);
        ck_assert_int_eq(lc_transform_lights(&desc), 1);
        ck_assert_int_eq(desc.shape_count, whole.shape_count); /* it still hides and reflects */
        seen[desc.point_count ? 1 : desc.directional_count ? 2 : 0] += 1;
        lc_scene_desc_release(&desc);
    }
    ck_assert(seen[0] == 1 && seen[1] == 1 && seen[2] == 1);
    lc_scene_desc_release(&whole);
}
END_TEST

/* A point before the mirror and its image behind, normals on the same sides; reflected twice, all is where it was. */
START_TEST(unfolding_reflects)
{
    lc_scene_desc desc;
    lc_scene_desc_init(&desc);
    lc_vec3 n = lc_normalize(lc_vec(1, 2, -0.5));
    lc_affine turn = pose_rotate(n, 0.3), mirror = turn;
    mirror.m[0][3] = 0.4;
    add_shape(&desc, LC_RECTANGLE, mirror);
    add_shape(&desc, LC_DISK, pose_translate(0.1, 0.2, 0.3));
    lc_point_desc *point = lc_scene_desc_add_point(&desc);
    point->position = lc_vec(0.5, 0.6, 0.7);
    lc_vec3 before = lc_vec(0.1, 0.2, 0.3), o = lc_vec(0.4, 0, 0);
    lc_transform_unfold(&desc, 0);
    ck_assert_int_eq(desc.shape_count, 1);
    lc_vec3 after = lc_affine_point(&desc.shapes[0].to_world, lc_vec(0, 0, 0));
    ck_assert_double_eq_tol(lc_dot(n, lc_sub(before, o)), -lc_dot(n, lc_sub(after, o)), 1e-12);
    ck_assert_double_eq_tol(lc_length(lc_cross(n, lc_sub(after, before))), 0, 1e-12);
    ck_assert_double_lt(lc_affine_determinant(&desc.shapes[0].to_world), 0);
    lc_scene *scene = build_scene(&desc); /* releases desc */
    lc_vec3 normal = lc_vec(0, 0, 1);     /* of the disk; reflected */
    normal = lc_sub(normal, lc_scale(2 * lc_dot(n, normal), n));
    lc_hit hit = see(scene, lc_add(after, normal), lc_neg(normal));
    ck_assert(hit.valid);
    ck_assert_double_eq_tol(lc_dot(hit.n, normal), 1, 1e-12);
    lc_scene_free(scene);
}
END_TEST

START_TEST(a_camera_faces_its_square)
{
    lc_scene_desc desc = read_scene("two_patches");
    lc_error err = {""};
    lc_transform_exchange(&desc, 1, 0);
    ck_assert(desc.shapes[0].emits && !desc.shapes[1].emits);
    lc_affine square = desc.shapes[1].to_world;
    lc_scene *scene;
    ck_assert_int_eq(lc_scene_build(&scene, &desc, &err), LC_OK);
    for (int i = 0; i < 4; ++i) { /* just inside the image's corners are the square's */
        double x = i % 2 ? SIDE - 1e-6 : 1e-6, y = i / 2 ? SIDE - 1e-6 : 1e-6;
        lc_ray ray = lc_camera_ray(&desc.camera, SIDE, SIDE, x, y);
        lc_hit hit;
        lc_camera_see(scene, &ray, &hit);
        ck_assert(hit.valid && hit.shape == 1);
        ck_assert_double_gt(lc_dot(hit.n, hit.wo), 0);
        lc_affine back;
        ck_assert(lc_affine_invert(&back, &square));
        lc_vec3 local = lc_affine_point(&back, hit.p);
        ck_assert_double_eq_tol(fabs(local.x), 1, 1e-6);
        ck_assert_double_eq_tol(fabs(local.y), 1, 1e-6);
    }
    lc_scene_free(scene);
    lc_scene_desc_release(&desc);
}
END_TEST

/* ---- the check ------------------------------------------------------------------------------------------------------- */

START_TEST(each_estimator_has_relations)
{
    int relations[64] = {0};
    lc_error err = {""};
    for (const char *const *name = lc_suite_scenes; *name; ++name) {
        lc_scene *scene;
        lc_claims claims = {.count = 0};
        ck_assert_msg(lc_suite_scene(&scene, *name, 1, load_small, &err) == LC_OK, "%s", err.text);
        for (const lc_check *const *check = lc_checks; *check; ++check)
            for (int i = 0; strcmp((*check)->name, "metamorphic") == 0 && lc_estimators[i]; ++i)
                ck_assert_msg((*check)->plan(*check, &claims, scene, lc_estimators[i], &err) == LC_OK, "%s", err.text);
        for (int k = 0; k < claims.count; ++k)
            for (int i = 0; lc_estimators[i]; ++i)
                relations[i] += claims.items[k].estimator == lc_estimators[i] && !claims.items[k].full_only;
        lc_claims_release(&claims);
        lc_scene_free(scene);
    }
    for (int i = 0; lc_estimators[i]; ++i)
        ck_assert_msg(relations[i] >= 2, "%s: %d relations in the quick suite", lc_estimators[i]->name, relations[i]);
}
END_TEST

static lc_rgb black(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                    lc_sampler *sampler)
{
    (void)scene, (void)ray, (void)hit, (void)options, (void)sampler;
    return lc_black();
}

/* Knows nothing of the lamps. */
static lc_rgb noise(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    (void)scene, (void)ray, (void)hit, (void)options;
    double u = lc_next(sampler);
    return lc_color(u, 2 * u, 3 * u);
}

static lc_report verify(const lc_estimator *e, const char *scene)
{
    lc_verify_options options;
    lc_report report;
    lc_error err = {""};
    lc_verify_options_init(&options);
    options.estimator = e;
    options.check = "metamorphic";
    options.scene = scene;
    ck_assert_msg(lc_verify(&report, &options, load_small, &err) == LC_OK, "%s", err.text);
    ck_assert_int_gt(report.count, 0);
    return report;
}

START_TEST(black_agrees_with_itself_and_does_not_pass)
{
    lc_estimator e = *find("light_direct");
    e.name = "mine";
    e.radiance = black;
    lc_report report = verify(&e, "five_lights");
    for (int i = 0; i < report.count; ++i)
        ck_assert_int_eq(report.rows[i].verdict, LC_ROW_UNDECIDED);
    lc_report_release(&report);
    e.radiance = noise;
    report = verify(&e, "five_lights");
    ck_assert_int_eq(lc_report_status(&report), LC_WRONG);
    ck_assert_ptr_nonnull(strstr(report.rows[0].scene, "five_lights/"));
    ck_assert_ptr_nonnull(strstr(report.rows[0].reproduce, "--scene five_lights --seed"));
    lc_report_release(&report);
}
END_TEST

/* An estimator that plays roulette against the albedo takes other paths in a darker scene: held to the mean, not to the bits. */
static lc_rgb gambler(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                      lc_sampler *sampler)
{
    double q = fmin(1, 0.1 + lc_rgb_max(lc_material_at(scene, hit).diffuse));
    if (lc_next(sampler) >= q)
        return options->min_bounces > 0 ? lc_black() : lc_emission(scene, hit);
    return lc_rgb_scale(1 / q, find("light_direct")->radiance(scene, ray, hit, options, sampler));
}

START_TEST(roulette_is_not_called_wrong)
{
    lc_estimator e = *find("light_direct");
    e.name = "mine";
    e.radiance = gambler;
    lc_report report = verify(&e, "five_lights");
    int statistical = 0;
    for (int i = 0; i < report.count; ++i) {
        ck_assert_msg(report.rows[i].verdict == LC_ROW_PASS, "%s", report.rows[i].reason);
        statistical += strcmp(report.rows[i].scene, "five_lights/albedo") == 0 && !report.rows[i].exact;
    }
    ck_assert_int_eq(statistical, 1);
    lc_report_release(&report);
}
END_TEST

Suite *lc_suite_metamorphic(void)
{
    Suite *suite = suite_create("metamorphic");
    TCase *c = tcase_create("metamorphic");
    tcase_set_timeout(c, 60);
    tcase_add_test(c, a_difference_is_the_difference);
    tcase_add_test(c, bad_samples_of_a_term_are_found);
    tcase_add_loop_test(c, powers_of_two_give_the_same_bits, 0, (int)(sizeof fixed_length / sizeof fixed_length[0]));
    tcase_add_test(c, pieces_have_the_area_and_the_texture_of_the_whole);
    tcase_add_test(c, each_light_shines_alone_once);
    tcase_add_test(c, unfolding_reflects);
    tcase_add_test(c, a_camera_faces_its_square);
    tcase_add_test(c, each_estimator_has_relations);
    tcase_add_test(c, black_agrees_with_itself_and_does_not_pass);
    tcase_add_test(c, roulette_is_not_called_wrong);
    suite_add_tcase(suite, c);
    return suite;
}
