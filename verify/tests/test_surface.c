/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Materials, emission and textures, as seen from both sides; every expected value follows from docs/scenes.md by hand. */
#include "verify/tests/tests.h"

#include "verify/tests/scene_help.h"

static const lc_vec3 down = {0, 0, -1}, up = {0, 0, 1};

static void ck_rgb(lc_rgb got, double r, double g, double b)
{
    ck_assert_msg(fabs(got.r - r) < 1e-15 && fabs(got.g - g) < 1e-15 && fabs(got.b - b) < 1e-15,
                  "got (%.17g, %.17g, %.17g), expected (%g, %g, %g)", got.r, got.g, got.b, r, g, b);
}

/* One rectangle at z = 0, normal +z, of the material `m`. */
static lc_scene *sheet(const lc_material_desc *m, int flip)
{
    lc_scene_desc desc;
    lc_scene_desc_init(&desc);
    *lc_scene_desc_add_material(&desc) = *m;
    add_lamp(&desc, LC_RECTANGLE, lc_affine_identity(), lc_color(7, 8, 9))->flip_normals = flip;
    return build_scene(&desc);
}

static lc_material_desc material(void)
{
    lc_material_desc m;
    memset(&m, 0, sizeof m);
    m.side[0].diffuse = m.side[1].diffuse = lc_texture_constant(lc_black());
    m.int_ior = m.ext_ior = 1;
    return m;
}

static lc_hit from_above(const lc_scene *scene) { return see(scene, lc_vec(0.1, 0.2, 3), down); }
static lc_hit from_below(const lc_scene *scene) { return see(scene, lc_vec(0.1, 0.2, -3), up); }

START_TEST(diffuse_is_one_sided)
{
    lc_material_desc m = material();
    m.side[0].diffuse = lc_texture_constant(lc_color(0.2, 0.4, 0.6));
    for (int flip = 0; flip < 2; ++flip) {
        lc_scene *scene = sheet(&m, flip);
        lc_hit front = flip ? from_below(scene) : from_above(scene),
               back = flip ? from_above(scene) : from_below(scene);
        lc_vec3 n = flip ? down : up, slant = lc_normalize(lc_vec(1, 2, n.z * 0.1));
        ck_assert(front.n.z == n.z && back.n.z == n.z); /* not turned to the viewer */
        ck_rgb(lc_material_at(scene, &front).diffuse, 0.2, 0.4, 0.6);
        ck_rgb(lc_material_at(scene, &back).diffuse, 0, 0, 0);
        ck_rgb(lc_bsdf_eval(scene, &front, slant), 0.2 / LC_PI, 0.4 / LC_PI, 0.6 / LC_PI);
        ck_rgb(lc_bsdf_eval(scene, &front, n), 0.2 / LC_PI, 0.4 / LC_PI, 0.6 / LC_PI);
        ck_rgb(lc_bsdf_eval(scene, &front, lc_neg(slant)), 0, 0, 0); /* nothing goes through */
        ck_rgb(lc_bsdf_eval(scene, &front, lc_vec(1, 0, 0)), 0, 0, 0);
        ck_rgb(lc_bsdf_eval(scene, &back, n), 0, 0, 0);
        ck_rgb(lc_bsdf_eval(scene, &back, lc_neg(n)), 0, 0, 0);
        ck_assert_uint_eq(lc_scene_lobes(scene), LC_DIFFUSE);
        lc_scene_free(scene);
    }
}
END_TEST

START_TEST(twosided_has_two_fronts)
{
    lc_material_desc m = material();
    m.side[0].diffuse = lc_texture_constant(lc_color(0.2, 0.4, 0.6));
    m.side[1].diffuse = lc_texture_constant(lc_color(0.1, 0.3, 0.5));
    lc_scene *scene = sheet(&m, 0);
    lc_hit front = from_above(scene), back = from_below(scene);
    ck_rgb(lc_bsdf_eval(scene, &front, up), 0.2 / LC_PI, 0.4 / LC_PI, 0.6 / LC_PI);
    ck_rgb(lc_bsdf_eval(scene, &front, down), 0, 0, 0);
    ck_rgb(lc_bsdf_eval(scene, &back, down), 0.1 / LC_PI, 0.3 / LC_PI, 0.5 / LC_PI);
    ck_rgb(lc_bsdf_eval(scene, &back, up), 0, 0, 0);
    /* Its emission stays one-sided. */
    ck_rgb(lc_emission(scene, &front), 7, 8, 9);
    ck_rgb(lc_emission(scene, &back), 0, 0, 0);
    lc_scene_free(scene);
}
END_TEST

/* A mirror has a weight, and no value. */
START_TEST(mirrors_have_no_value)
{
    lc_material_desc m = material();
    m.side[0].mirror = lc_color(0.9, 0.8, 0.7);
    lc_scene *scene = sheet(&m, 0);
    lc_hit front = from_above(scene), back = from_below(scene);
    ck_rgb(lc_material_at(scene, &front).mirror, 0.9, 0.8, 0.7);
    ck_rgb(lc_material_at(scene, &back).mirror, 0, 0, 0);
    ck_rgb(lc_bsdf_eval(scene, &front, up), 0, 0, 0);
    ck_assert_uint_eq(lc_scene_lobes(scene), LC_MIRROR);
    lc_scene_free(scene);
}
END_TEST

START_TEST(glass_has_an_index_from_either_side)
{
    lc_material_desc m = material();
    m.side[0].glass = m.side[1].glass = 1;
    m.int_ior = 1.5;
    m.ext_ior = 1.25;
    for (int flip = 0; flip < 2; ++flip) {
        lc_scene *scene = sheet(&m, flip);
        lc_hit out = flip ? from_below(scene) : from_above(scene), in = flip ? from_above(scene) : from_below(scene);
        ck_assert_double_eq_tol(lc_material_at(scene, &out).ior, 1.2, 1e-15);
        ck_assert_double_eq_tol(lc_material_at(scene, &in).ior, 1 / 1.2, 1e-15);
        ck_assert(lc_material_at(scene, &out).glass == 1 && lc_material_at(scene, &in).glass == 1);
        ck_rgb(lc_bsdf_eval(scene, &out, up), 0, 0, 0);
        ck_assert_uint_eq(lc_scene_lobes(scene), LC_GLASS);
        lc_scene_free(scene);
    }
}
END_TEST

START_TEST(lobes_of_a_blend_add_up)
{
    lc_material_desc m = material();
    m.side[0].diffuse = lc_texture_constant(lc_color(0.1, 0.2, 0.3));
    m.side[0].mirror = lc_color(0.5, 0.25, 0.125);
    m.side[0].glass = 0.25;
    m.int_ior = 1.5;
    lc_scene *scene = sheet(&m, 0);
    lc_hit front = from_above(scene);
    lc_material seen = lc_material_at(scene, &front);
    ck_rgb(seen.diffuse, 0.1, 0.2, 0.3);
    ck_rgb(seen.mirror, 0.5, 0.25, 0.125);
    ck_assert(seen.glass == 0.25 && seen.ior == 1.5);
    ck_rgb(lc_bsdf_eval(scene, &front, up), 0.1 / LC_PI, 0.2 / LC_PI, 0.3 / LC_PI);
    ck_assert_uint_eq(lc_scene_lobes(scene), LC_DIFFUSE | LC_MIRROR | LC_GLASS);
    lc_scene_free(scene);
}
END_TEST

/* Each shape shines to where its normals point, and nowhere else. */
START_TEST(emission_is_on_the_side_of_the_normal)
{
    static const lc_shape_kind kinds[] = {LC_RECTANGLE, LC_DISK, LC_CUBE, LC_SPHERE};
    for (int i = 0; i < 8; ++i) {
        lc_scene_desc desc;
        lc_shape_kind kind = kinds[i / 2];
        int flip = i % 2, is_closed = kind == LC_CUBE || kind == LC_SPHERE;
        lc_scene_desc_init(&desc);
        add_lamp(&desc, kind, lc_affine_identity(), lc_color(7, 8, 9))->flip_normals = flip;
        lc_scene *scene = build_scene(&desc);
        lc_hit front = from_above(scene);
        lc_hit back = is_closed ? see(scene, lc_vec(0.1, 0.2, 0.3), lc_vec(0.3, 0.1, 1)) : from_below(scene);
        ck_assert(front.valid && back.valid);
        ck_rgb(lc_emission(scene, flip ? &back : &front), 7, 8, 9);
        ck_rgb(lc_emission(scene, flip ? &front : &back), 0, 0, 0);
        ck_assert_uint_eq(lc_scene_emitters(scene), LC_AREA);
        lc_scene_free(scene);
    }
}
END_TEST

/* A mirrored pose turns nothing inside out: in x, the front of a flat shape stays where it was; in z, it goes along. */
START_TEST(mirrored_shapes_keep_their_front)
{
    static const lc_shape_kind kinds[] = {LC_RECTANGLE, LC_DISK, LC_CUBE};
    for (int i = 0; i < 6; ++i) {
        lc_scene_desc desc;
        lc_shape_kind kind = kinds[i / 2];
        int in_z = i % 2;
        lc_scene_desc_init(&desc);
        add_lamp(&desc, kind, in_z ? pose_scale(1, 1, -1) : pose_scale(-1, 1, 1), lc_color(7, 8, 9));
        lc_scene *scene = build_scene(&desc);
        lc_hit above = from_above(scene), below = from_below(scene);
        ck_assert(above.valid && below.valid);
        ck_assert_double_eq(above.n.z, kind == LC_CUBE ? 1 : in_z ? -1 : 1);
        ck_assert_double_eq(below.n.z, kind == LC_CUBE ? -1 : above.n.z);
        ck_assert(lc_emission(scene, &above).r == (above.n.z > 0 ? 7 : 0));
        lc_scene_free(scene);
    }
}
END_TEST

START_TEST(a_miss_sees_the_sky)
{
    lc_scene_desc desc;
    lc_scene_desc_init(&desc);
    add_shape(&desc, LC_RECTANGLE, lc_affine_identity());
    desc.sky = lc_color(1, 2, 3);
    for (int has_sky = 0; has_sky < 2; ++has_sky) {
        lc_scene *scene;
        lc_error err;
        desc.has_sky = has_sky;
        ck_assert_int_eq(lc_scene_build(&scene, &desc, &err), LC_OK);
        lc_hit miss = see(scene, lc_vec(0, 0, 3), up), hit = from_above(scene);
        ck_rgb(lc_emission(scene, &miss), has_sky, 2 * has_sky, 3 * has_sky);
        ck_rgb(lc_emission(scene, &hit), 0, 0, 0);
        ck_rgb(lc_bsdf_eval(scene, &miss, up), 0, 0, 0);
        ck_rgb(lc_material_at(scene, &miss).diffuse, 0, 0, 0);
        ck_assert_uint_eq(lc_scene_emitters(scene), has_sky ? LC_SKY : 0);
        lc_scene_free(scene);
    }
    lc_scene_desc_release(&desc);
}
END_TEST

/* A lamp of radiance 0 is a light that may be sampled, but no emitter that must be reached. */
START_TEST(black_lamps_emit_nothing)
{
    lc_scene_desc desc;
    lc_scene_desc_init(&desc);
    add_lamp(&desc, LC_RECTANGLE, lc_affine_identity(), lc_black());
    lc_scene *scene = build_scene(&desc);
    ck_assert_uint_eq(lc_scene_emitters(scene), 0);
    ck_assert_int_eq(lc_light_count(scene), 1);
    lc_scene_free(scene);
}
END_TEST

/* ---- checkerboards -------------------------------------------------------------------------------------------- */

/* The colour (1 or 2: color0, color1) that the local point of a shape shows, straight and posed. */
static void ck_cell(lc_shape_kind kind, const double to_uv[4], lc_vec3 local, int color)
{
    lc_texture board = {1, {{0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}}, {to_uv[0], to_uv[1]}, {to_uv[2], to_uv[3]}};
    for (int i = 0; i < 2; ++i) {
        lc_scene_desc desc;
        lc_scene_desc_init(&desc);
        lc_affine pose = lc_affine_identity();
        if (i == 1) {
            lc_affine scale = kind == LC_RECTANGLE ? pose_scale(3, 0.5, 1) : pose_scale(3, 3, 3);
            lc_affine turn = pose_rotate(lc_normalize(lc_vec(1, 2, -2)), 0.7), shift = pose_translate(5, -6, 7);
            pose = lc_affine_multiply(&turn, &scale);
            pose = lc_affine_multiply(&shift, &pose);
        }
        lc_shape_desc *shape = add_lamp(&desc, kind, pose, lc_black());
        shape->radiance = board;
        desc.materials[0].side[0].diffuse = board;
        lc_scene *scene = build_scene(&desc);
        /* From outside, along the normal at that point. */
        lc_vec3 n = kind == LC_SPHERE ? local : up;
        lc_vec3 o = lc_affine_point(&pose, lc_add(local, n)), d = lc_affine_vector(&pose, lc_neg(n));
        lc_hit hit = see(scene, o, d);
        ck_assert(hit.valid);
        ck_assert_msg(fabs(lc_material_at(scene, &hit).diffuse.g - 0.1 * color) < 1e-15,
                      "shape %d, pose %d, (%g, %g, %g): not color%d", (int)kind, i, local.x, local.y, local.z,
                      color - 1);
        ck_rgb(lc_emission(scene, &hit), 0.1 * color, 0.1 * color, 0.1 * color);
        ck_assert_double_eq_tol(lc_bsdf_eval(scene, &hit, hit.n).r, 0.1 * color / LC_PI, 1e-15);
        lc_scene_free(scene);
    }
}

static const double whole[4] = {1, 1, 0, 0}, finer[4] = {2, 1, 0, 0}, moved[4] = {1, 1, 0.5, 0};

/* u = (x + 1) / 2, v = (y + 1) / 2; color0 where both fractions lie on the same side of 1/2. */
START_TEST(checkerboard_on_a_rectangle)
{
    ck_cell(LC_RECTANGLE, whole, lc_vec(-0.3, -0.6, 0), 1);
    ck_cell(LC_RECTANGLE, whole, lc_vec(0.3, -0.6, 0), 2);
    ck_cell(LC_RECTANGLE, whole, lc_vec(-0.3, 0.6, 0), 2);
    ck_cell(LC_RECTANGLE, whole, lc_vec(0.3, 0.6, 0), 1);
    ck_cell(LC_RECTANGLE, finer, lc_vec(-0.7, -0.6, 0), 1); /* 2 u = 0.3 */
    ck_cell(LC_RECTANGLE, finer, lc_vec(-0.3, -0.6, 0), 2); /* 2 u = 0.7 */
    ck_cell(LC_RECTANGLE, finer, lc_vec(0.3, -0.6, 0), 1);  /* 2 u = 1.3 */
    ck_cell(LC_RECTANGLE, moved, lc_vec(-0.3, -0.6, 0), 2); /* u + 1/2 = 0.85 */
}
END_TEST

/* u is the radius, v the angle from +x over 2 pi. */
START_TEST(checkerboard_on_a_disk)
{
    ck_cell(LC_DISK, whole, lc_vec(0.2, 0.3, 0), 1);   /* r .36, v < 1/2 */
    ck_cell(LC_DISK, whole, lc_vec(0.5, 0.6, 0), 2);   /* r .78, v < 1/2 */
    ck_cell(LC_DISK, whole, lc_vec(0.2, -0.3, 0), 2);  /* r .36, v > 1/2 */
    ck_cell(LC_DISK, whole, lc_vec(-0.5, -0.6, 0), 1); /* r .78, v > 1/2 */
    ck_cell(LC_DISK, finer, lc_vec(0.2, 0.3, 0), 2);   /* 2 r = .72 */
}
END_TEST

/* u is the angle from +x about z over 2 pi, v the angle from +z over pi. */
START_TEST(checkerboard_on_a_sphere)
{
    static const double finer_v[4] = {1, 2, 0, 0};
    ck_cell(LC_SPHERE, whole, lc_normalize(lc_vec(1, 2, 1)), 1);   /* u < 1/2, v < 1/2 */
    ck_cell(LC_SPHERE, whole, lc_normalize(lc_vec(1, -2, 1)), 2);  /* u > 1/2 */
    ck_cell(LC_SPHERE, whole, lc_normalize(lc_vec(-1, 2, -1)), 2); /* v > 1/2 */
    ck_cell(LC_SPHERE, whole, lc_normalize(lc_vec(-1, -2, -1)), 1);
    ck_cell(LC_SPHERE, finer, lc_normalize(lc_vec(-1, 2, 1)), 2);    /* 2 u = .65 */
    ck_cell(LC_SPHERE, finer_v, lc_normalize(lc_vec(1, 2, 0.5)), 2); /* v = .43 */
    ck_cell(LC_SPHERE, finer_v, lc_normalize(lc_vec(1, 2, 5)), 1);   /* v = .13 */
}
END_TEST

Suite *lc_suite_surface(void)
{
    Suite *suite = suite_create("surface");
    TCase *tc = tcase_create("core");
    tcase_add_test(tc, diffuse_is_one_sided);
    tcase_add_test(tc, twosided_has_two_fronts);
    tcase_add_test(tc, mirrors_have_no_value);
    tcase_add_test(tc, glass_has_an_index_from_either_side);
    tcase_add_test(tc, lobes_of_a_blend_add_up);
    tcase_add_test(tc, emission_is_on_the_side_of_the_normal);
    tcase_add_test(tc, mirrored_shapes_keep_their_front);
    tcase_add_test(tc, a_miss_sees_the_sky);
    tcase_add_test(tc, black_lamps_emit_nothing);
    tcase_add_test(tc, checkerboard_on_a_rectangle);
    tcase_add_test(tc, checkerboard_on_a_disk);
    tcase_add_test(tc, checkerboard_on_a_sphere);
    suite_add_tcase(suite, tc);
    return suite;
}
