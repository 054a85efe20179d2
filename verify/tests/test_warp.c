/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From the unit square to directions and to surfaces: Pearson's test of what comes out against the density. */
#include "verify/tests/tests.h"

#include <stdio.h>

#include "core/scene_c.h"
#include "verify/stats/stats.h"
#include "verify/tests/scene_help.h"

/* Some hundred tests a run, and a false alarm a million runs: ln(1e-6 / 100). The seeds are fixed besides. */
#define LEAST_LOG_P (-18.4)

enum { SAMPLES = 40000, RINGS = 8, SECTORS = 8 };

typedef lc_vec3 warp_fn(lc_vec3 n, double u, double v);

static const lc_vec3 normals[] = {
    {0, 0, 1},     {0, 0, -1},     {1, 0, 0},      {-1, 0, 0},     {0, 1, 0},       {0, -1, 0},
    {0.6, 0, 0.8}, {0, 0.6, -0.8}, {1e-9, 0, -1},  {0, -1e-9, -1}, {1e-4, 1e-4, 1}, {-1e-4, 1e-4, -1},
    {1e-5, 0, -1}, {3, -4, 1e-12}, {3, 4, -1e-12}, {-1, -1, -1},   {1, 2, 3},       {-3, 1, -0.01},
};
enum { NORMALS = sizeof normals / sizeof normals[0] };

/* A frame of the test's own, not that of the code. */
static void frame(lc_vec3 n, lc_vec3 *s, lc_vec3 *t)
{
    lc_affine turn = pose_rotate(n, 0.3);
    *s = lc_affine_vector(&turn, lc_vec(1, 0, 0));
    *t = lc_affine_vector(&turn, lc_vec(0, 1, 0));
}

/* power 1: cos_theta is uniform. power 2: cos^2 theta is. */
static double chi_square_of(warp_fn *warp, lc_vec3 n, int power, uint64_t seed)
{
    double seen[RINGS * SECTORS] = {0}, expected[RINGS * SECTORS];
    lc_vec3 s, t;
    lc_chi_square chi;
    lc_error err;
    frame(n, &s, &t);
    for (int i = 0; i < RINGS * SECTORS; ++i)
        expected[i] = (double)SAMPLES / (RINGS * SECTORS);
    for (int i = 0; i < SAMPLES; ++i) {
        double u = next_uniform(&seed), v = next_uniform(&seed);
        lc_vec3 w = warp(n, u, v);
        ck_assert_msg(fabs(lc_length(w) - 1) < 1e-12, "length 1 %+.3g", lc_length(w) - 1);
        double cos_theta = lc_dot(w, n), phi = atan2(lc_dot(w, t), lc_dot(w, s)) * (0.5 * LC_INV_PI) + 0.5;
        ck_assert_msg(cos_theta > 0, "cosine %.17g", cos_theta);
        int ring = (int)fmin(RINGS * pow(cos_theta, power), RINGS - 1), sector = (int)fmin(SECTORS * phi, SECTORS - 1);
        ++seen[ring * SECTORS + sector];
    }
    ck_assert_int_eq(lc_chi_square_test(&chi, seen, expected, RINGS * SECTORS, 5, 0, &err), LC_OK);
    return chi.log_p;
}

static void try_all_normals(warp_fn *warp, int power)
{
    for (uint64_t i = 0; i < NORMALS; ++i) {
        double log_p = chi_square_of(warp, lc_normalize(normals[i]), power, i);
        ck_assert_msg(log_p > LEAST_LOG_P, "normal (%g, %g, %g): p = exp(%g)", normals[i].x, normals[i].y, normals[i].z,
                      log_p);
    }
}

START_TEST(uniform_hemisphere_is_uniform) { try_all_normals(lc_uniform_hemisphere, 1); }
END_TEST

START_TEST(cosine_hemisphere_is_cosine) { try_all_normals(lc_cosine_hemisphere, 2); }
END_TEST

/* A test that cannot tell the one from the other would be none. */
START_TEST(the_two_are_told_apart)
{
    ck_assert(chi_square_of(lc_uniform_hemisphere, lc_vec(0, 0, 1), 2, 1) < -1000);
    ck_assert(chi_square_of(lc_cosine_hemisphere, lc_vec(0, 0, 1), 1, 1) < -1000);
}
END_TEST

/* Mean of the cosine: 1/2 and 2/3; each component across the normal: 0. Ten standard errors. */
START_TEST(means_of_the_cosine)
{
    uint64_t seed = 4;
    double uniform_mean = 0, cosine_mean = 0;
    lc_vec3 n = lc_normalize(lc_vec(1, -2, 0.5));
    for (int i = 0; i < SAMPLES; ++i) {
        double u = next_uniform(&seed), v = next_uniform(&seed);
        uniform_mean += lc_dot(n, lc_uniform_hemisphere(n, u, v)) / SAMPLES;
        cosine_mean += lc_dot(n, lc_cosine_hemisphere(n, u, v)) / SAMPLES;
    }
    ck_assert_double_eq_tol(uniform_mean, 0.5, 10 * sqrt(1 / 12.0 / SAMPLES));
    ck_assert_double_eq_tol(cosine_mean, 2.0 / 3, 10 * sqrt(1 / 18.0 / SAMPLES));
}
END_TEST

/* The corners of what a sampler can give: no NaN, unit length, never below the horizon. */
START_TEST(extremes_of_the_unit_square)
{
    static const double extreme[] = {0, 0x1p-32, 0.5, 1 - 0x1p-32};
    warp_fn *const warps[] = {lc_uniform_hemisphere, lc_cosine_hemisphere};
    for (int i = 0; i < NORMALS; ++i)
        for (int k = 0; k < 32; ++k) {
            lc_vec3 n = lc_normalize(normals[i]);
            lc_vec3 w = warps[k / 16](n, extreme[k % 4], extreme[k / 4 % 4]);
            ck_assert_msg(fabs(lc_length(w) - 1) < 1e-12, "u = %g: length %g", extreme[k % 4], lc_length(w));
            ck_assert_msg(lc_dot(w, n) > 0, "u = %g: cosine %g", extreme[k % 4], lc_dot(w, n));
            if (extreme[k % 4] == 0)
                ck_assert(lc_dot(w, n) > 1 - 1e-12);
        }
}
END_TEST

/* The circle, all the way round, against the library's cosine and sine. */
START_TEST(azimuth_goes_round_once)
{
    for (int i = 0; i <= 1 << 12; ++i) {
        double v = fmin(i * 0x1p-12, 1 - 0x1p-32);
        lc_vec3 w = lc_uniform_sphere(0.5, v);
        ck_assert_double_eq_tol(w.x, cos(2 * LC_PI * v), 4e-15);
        ck_assert_double_eq_tol(w.y, sin(2 * LC_PI * v), 4e-15);
    }
}
END_TEST

/* ---- points on lights -------------------------------------------------------------------------------------- */

/* Which of `bins` equal areas of the standard shape the local point lies in, or -1 off the shape. */
typedef int bin_fn(lc_vec3 local);

static int bin_square(double x, double y)
{
    if (fabs(x) > 1 + 1e-12 || fabs(y) > 1 + 1e-12)
        return -1;
    int i = (int)fmin(fmax(4 * (x + 1) / 2, 0), 3), k = (int)fmin(fmax(4 * (y + 1) / 2, 0), 3);
    return 4 * i + k;
}

static int bin_rectangle(lc_vec3 p) { return fabs(p.z) < 1e-12 ? bin_square(p.x, p.y) : -1; }

static int bin_ring(double area_below, double x, double y)
{
    double phi = atan2(y, x) * (0.5 * LC_INV_PI) + 0.5;
    return 4 * (int)fmin(fmax(4 * area_below, 0), 3) + (int)fmin(4 * phi, 3);
}

static int bin_disk(lc_vec3 p)
{
    double r2 = p.x * p.x + p.y * p.y;
    return fabs(p.z) < 1e-12 && r2 < 1 + 1e-12 ? bin_ring(r2, p.x, p.y) : -1;
}

static int bin_sphere(lc_vec3 p) { return fabs(lc_length(p) - 1) < 1e-12 ? bin_ring((p.z + 1) / 2, p.x, p.y) : -1; }

/* 16 bins a side of the cube, sides in the order +x -x +y -y +z -z. */
static int bin_cube(lc_vec3 p)
{
    const double c[3] = {p.x, p.y, p.z};
    for (int i = 0; i < 3; ++i) {
        int bin = bin_square(c[(i + 1) % 3], c[(i + 2) % 3]);
        if (fabs(fabs(c[i]) - 1) < 1e-12 && bin >= 0)
            return 16 * (2 * i + (c[i] < 0)) + bin;
    }
    return -1;
}

typedef struct shape_case {
    lc_shape_kind kind;
    lc_vec3 size;
    bin_fn *bin;
    int bins;
    double area;
} shape_case;

/* A cube's side is chosen by its area: 2 x 3, 1 x 3 and 1 x 2, twice each, times 4. */
static double cube_share(lc_vec3 s, int bin)
{
    const double side[3] = {s.y * s.z, s.z * s.x, s.x * s.y};
    return side[bin / 32] / (2 * (side[0] + side[1] + side[2])) / 16;
}

/* A strip that is never reached would hardly show in the bins: u and v of the standard shape go from end to end. */
typedef struct extent {
    double least[3], most[3];
} extent;

static void extend(extent *e, lc_shape_kind kind, lc_vec3 p)
{
    double c[3] = {p.x, p.y, p.z};
    if (kind == LC_DISK || kind == LC_SPHERE) {
        c[0] = atan2(p.y, p.x) / LC_PI;
        c[1] = kind == LC_DISK ? 2 * (p.x * p.x + p.y * p.y) - 1 : p.z;
    }
    for (int i = 0; i < 3; ++i) {
        e->least[i] = fmin(e->least[i], c[i]);
        e->most[i] = fmax(e->most[i], c[i]);
    }
}

/* P(a strip of 1e-3 stays empty) = exp(-20) at most. */
static void ck_extent(const extent *e, lc_shape_kind kind)
{
    for (int i = 0; i < (kind == LC_CUBE ? 3 : 2); ++i)
        ck_assert_msg(e->least[i] < -0.998 && e->most[i] > 0.998, "shape %d, axis %d: only [%g, %g]", (int)kind, i,
                      e->least[i], e->most[i]);
}

static void try_shape(const shape_case *c, int flip, uint64_t seed)
{
    double seen[96] = {0}, expected[96];
    lc_chi_square chi;
    lc_error err;
    lc_scene_desc desc;
    lc_scene_desc_init(&desc);
    lc_affine scale = pose_scale(c->size.x, c->size.y, c->size.z);
    lc_affine turn = pose_rotate(lc_normalize(lc_vec(1, -2, 0.7)), 0.9), inverse;
    lc_affine pose = lc_affine_multiply(&turn, &scale);
    pose.m[0][3] = 5, pose.m[1][3] = -3, pose.m[2][3] = 2;
    ck_assert(lc_affine_invert(&inverse, &pose));
    add_lamp(&desc, c->kind, pose, lc_color(1, 2, 3))->flip_normals = flip;
    lc_scene *scene = build_scene(&desc);
    ck_assert_double_eq_tol(lc_scene_emitting_area(scene), c->area, 1e-12 * c->area);
    lc_hit from = {.valid = 1, .p = {1, 1, 1}, .n = {0, 0, 1}, .wo = {0, 0, 1}};
    extent reached = {{1, 1, 1}, {-1, -1, -1}};
    for (int i = 0; i < SAMPLES; ++i) {
        lc_sampler sampler;
        lc_light_sample light;
        lc_sampler_start(&sampler, seed, 0, 0, (uint32_t)i);
        lc_light_sample_one(scene, 0, &from, &sampler, &light);
        lc_vec3 local = lc_affine_point(&inverse, light.p);
        int bin = c->bin(local);
        extend(&reached, c->kind, local);
        ck_assert_int_ge(bin, 0);
        ++seen[bin];
        /* What comes with the point. */
        lc_vec3 to = lc_sub(light.p, from.p), out = lc_sub(light.p, lc_vec(5, -3, 2));
        ck_assert(!light.is_delta && light.radiance.r == 1 && light.radiance.g == 2 && light.radiance.b == 3);
        ck_assert_double_eq_tol(light.pdf_area, 1 / c->area, 1e-12 / c->area);
        ck_assert_double_eq_tol(light.distance, lc_length(to), 1e-12);
        ck_assert(lc_length(lc_sub(lc_scale(light.distance, light.wi), to)) < 1e-12);
        ck_assert_double_eq_tol(lc_length(light.n), 1, 1e-12);
        if (c->kind == LC_CUBE || c->kind == LC_SPHERE)
            ck_assert((lc_dot(light.n, out) > 0) == !flip);
        else
            ck_assert_double_eq_tol(lc_dot(light.n, lc_affine_vector(&turn, lc_vec(0, 0, flip ? -1 : 1))), 1, 1e-12);
    }
    ck_extent(&reached, c->kind);
    for (int i = 0; i < c->bins; ++i)
        expected[i] = SAMPLES * (c->kind == LC_CUBE ? cube_share(c->size, i) : 1.0 / c->bins);
    ck_assert_int_eq(lc_chi_square_test(&chi, seen, expected, (size_t)c->bins, 5, 0, &err), LC_OK);
    ck_assert_msg(chi.log_p > LEAST_LOG_P, "shape %d: p = exp(%g)", (int)c->kind, chi.log_p);
    lc_scene_free(scene);
}

START_TEST(points_on_lights_are_uniform)
{
    static const shape_case cases[] = {
        {LC_RECTANGLE, {2, 0.5, 1}, bin_rectangle, 16, 4},
        {LC_DISK, {2, 0.5, 1}, bin_disk, 16, LC_PI},
        {LC_SPHERE, {1.5, 1.5, 1.5}, bin_sphere, 16, 9 * LC_PI},
        {LC_CUBE, {1, 2, 3}, bin_cube, 96, 88},
    };
    for (uint64_t i = 0; i < 8; ++i)
        try_shape(&cases[i / 2], (int)(i % 2), i);
}
END_TEST

/* lc_light_sample_union: each light by its area, whatever its kind; delta lights never. */
START_TEST(union_chooses_by_area)
{
    double seen[3] = {0}, expected[3];
    lc_chi_square chi;
    lc_error err;
    lc_scene_desc desc;
    lc_scene_desc_init(&desc);
    add_lamp(&desc, LC_RECTANGLE, pose_scale(1, 1, 1), lc_color(1, 1, 1));
    add_lamp(&desc, LC_SPHERE, pose_translate(0, 0, 5), lc_color(2, 2, 2));
    add_lamp(&desc, LC_DISK, pose_translate(0, 0, 9), lc_color(3, 3, 3));
    lc_scene_desc_add_point(&desc)->intensity = lc_color(1, 1, 1);
    double total = 4 + 5 * LC_PI;
    lc_scene *scene = build_scene(&desc);
    ck_assert_int_eq(lc_light_count(scene), 4);
    ck_assert_double_eq_tol(lc_scene_emitting_area(scene), total, 1e-12 * total);
    lc_hit from = {.valid = 1, .p = {3, 1, 1}, .n = {0, 0, 1}, .wo = {0, 0, 1}};
    for (int i = 0; i < SAMPLES; ++i) {
        lc_sampler sampler;
        lc_light_sample light;
        lc_sampler_start(&sampler, 3, 0, 0, (uint32_t)i);
        ck_assert_int_eq(lc_light_sample_union(scene, &from, &sampler, &light), 1);
        ck_assert_double_eq_tol(light.pdf_area, 1 / total, 1e-12);
        ck_assert_double_eq_tol(light.radiance.g, light.shape + 1, 1e-15);
        ++seen[light.shape];
    }
    expected[0] = SAMPLES * 4 / total;
    expected[1] = SAMPLES * 4 * LC_PI / total;
    expected[2] = SAMPLES * LC_PI / total;
    ck_assert_int_eq(lc_chi_square_test(&chi, seen, expected, 3, 5, 0, &err), LC_OK);
    ck_assert_msg(chi.log_p > LEAST_LOG_P, "p = exp(%g)", chi.log_p);
    lc_scene_free(scene);

    lc_sampler sampler;
    lc_light_sample light;
    lc_sampler_start(&sampler, 3, 0, 0, 0);
    lc_scene_desc_init(&desc);
    lc_scene_desc_add_point(&desc)->intensity = lc_color(1, 1, 1);
    scene = build_scene(&desc);
    ck_assert_int_eq(lc_light_sample_union(scene, &from, &sampler, &light), 0);
    lc_scene_free(scene);
}
END_TEST

/* A point of 2 W/sr at distance 2 gives 0.5 W m^-2; a directional light its own irradiance, from infinity. */
START_TEST(delta_lights_by_hand)
{
    lc_scene_desc desc;
    lc_sampler sampler;
    lc_light_sample light;
    lc_scene_desc_init(&desc);
    lc_point_desc *point = lc_scene_desc_add_point(&desc);
    point->position = lc_vec(0, 0, 2);
    point->intensity = lc_color(2, 4, 6);
    lc_directional_desc *directional = lc_scene_desc_add_directional(&desc);
    directional->direction = lc_vec(0, -0.6, -0.8);
    directional->irradiance = lc_color(7, 8, 9);
    lc_scene *scene = build_scene(&desc);
    lc_hit from = {.valid = 1, .n = {0, 0, 1}, .wo = {0, 0, 1}};
    lc_sampler_start(&sampler, 1, 1, 1, 1);
    lc_light_sample_one(scene, 0, &from, &sampler, &light);
    ck_assert(light.is_delta && light.distance == 2 && light.wi.z == 1);
    ck_assert_double_eq_tol(light.irradiance.r, 0.5, 1e-15);
    ck_assert_double_eq_tol(light.irradiance.b, 1.5, 1e-15);
    lc_light_sample_one(scene, 1, &from, &sampler, &light);
    ck_assert(light.is_delta && isinf(light.distance) && light.wi.y == 0.6 && light.wi.z == 0.8);
    ck_assert(light.irradiance.r == 7 && light.irradiance.b == 9);
    ck_assert_uint_eq(sampler.dimension, 0); /* a delta light needs no numbers */
    lc_scene_free(scene);
}
END_TEST

Suite *lc_suite_warp(void)
{
    Suite *suite = suite_create("warp");
    TCase *tc = tcase_create("core");
    tcase_set_timeout(tc, 60);
    tcase_add_test(tc, uniform_hemisphere_is_uniform);
    tcase_add_test(tc, cosine_hemisphere_is_cosine);
    tcase_add_test(tc, the_two_are_told_apart);
    tcase_add_test(tc, means_of_the_cosine);
    tcase_add_test(tc, extremes_of_the_unit_square);
    tcase_add_test(tc, azimuth_goes_round_once);
    tcase_add_test(tc, points_on_lights_are_uniform);
    tcase_add_test(tc, union_chooses_by_area);
    tcase_add_test(tc, delta_lights_by_hand);
    suite_add_tcase(suite, tc);
    return suite;
}
