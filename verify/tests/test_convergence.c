/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the lecture says of noise, and what its two traps cost, predicted by closed forms. */
#include "verify/tests/tests.h"

#include <stdlib.h>

#include "estimators/registry.h"
#include "verify/analytic/analytic.h"
#include "verify/judge/judge.h"
#include "verify/mutants/registry.h"
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
    const lc_mutant *mutant = lc_mutant_find(name);
    if (mutant)
        return mutant->estimator;
    ck_abort_msg("no estimator %s", name);
    return NULL;
}

static lc_row verify_one(const lc_estimator *e, const char *scene)
{
    lc_verify_options options;
    lc_report report;
    lc_error err = {""};
    lc_verify_options_init(&options);
    options.estimator = e;
    options.check = "convergence";
    options.scene = scene;
    ck_assert_msg(lc_verify(&report, &options, load_small, &err) == LC_OK, "%s", err.text);
    ck_assert_int_eq(report.count, 1);
    lc_row row = report.rows[0];
    lc_report_release(&report);
    return row;
}

START_TEST(the_error_falls_as_the_root)
{
    lc_row row = verify_one(find("light_direct"), "two_patches");
    ck_assert_int_eq(row.verdict, LC_ROW_PASS);
    ck_assert(row.low < 1 && row.high > 1 && row.low > 0.9 && row.high < 1.1);
    ck_assert_uint_eq(row.paths, 64 * 64 * (4 + 16 + 64 + 256));
    row = verify_one(find("hemisphere_reseeded"), "two_patches"); /* its samples repeat */
    ck_assert_int_eq(row.verdict, LC_ROW_FAIL);
    ck_assert_double_eq_tol(row.ratio, 0, 0.2);
}
END_TEST

/* 5% too bright: the error ends at 5% of the image, whatever N. */
static lc_rgb brighter(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    return lc_rgb_scale(1.05, find("light_direct")->radiance(scene, ray, hit, options, sampler));
}

static lc_rgb negative_once(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                            lc_sampler *sampler)
{
    if (sampler->pixel == 77 && sampler->sample == 9)
        return lc_color(-1, 0, 0);
    return find("light_direct")->radiance(scene, ray, hit, options, sampler);
}

static lc_rgb black(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                    lc_sampler *sampler)
{
    (void)scene, (void)ray, (void)hit, (void)options, (void)sampler;
    return lc_black();
}

START_TEST(a_bias_bends_the_line)
{
    lc_estimator e = *find("light_direct");
    e.name = "mine";
    e.radiance = brighter;
    ck_assert_int_eq(verify_one(&e, "two_patches").verdict, LC_ROW_FAIL);
    e.radiance = negative_once;
    ck_assert_int_eq(verify_one(&e, "two_patches").verdict, LC_ROW_FAIL);
    e.radiance = black; /* the error stays what it is */
    ck_assert_int_eq(verify_one(&e, "two_patches").verdict, LC_ROW_FAIL);
}
END_TEST

/* The measured noise of the suites, c of hemisphere_direct and light_direct, gives the ratio of variances as well. */
START_TEST(light_sampling_is_better_by_so_much)
{
    lc_row row = verify_one(find("light_direct"), "plane_tilted");
    double ratio = lc_cell_noise("plane_tilted", "hemisphere_direct", 1) / lc_cell_noise("plane_tilted", "light_direct", 1);
    ck_assert_int_eq(row.verdict, LC_ROW_PASS);
    ck_assert_msg(fabs(row.ratio / (ratio * ratio) - 1) < 0.25, "%g, by the cells %g", row.ratio, ratio * ratio);
    row = verify_one(find("light_direct"), "plane_cube");
    ck_assert_int_eq(row.verdict, LC_ROW_PASS);
    ck_assert_double_lt(row.high, 1);
}
END_TEST

/* ---- the traps ------------------------------------------------------------------------------------------------------- */

static lc_film *render(const lc_scene *scene, const lc_estimator *e, int bounces)
{
    lc_film *film;
    lc_error err = {""};
    lc_render_options options = {.min_bounces = 1, .max_bounces = bounces, .seed = 11, .arm = 3, .count = 1024};
    ck_assert_int_eq(lc_film_create(&film, SIDE, SIDE, &err), LC_OK);
    ck_assert_msg(lc_render(film, scene, e, &options, &err) == LC_OK, "%s", err.text);
    return film;
}

/* Method 1 with lights that shine from both sides: over a floor that sees the back of a lamp, it returns what the lamp would give were
 * it turned over. Right is black. */
START_TEST(what_a_two_sided_light_costs)
{
    lc_scene_desc desc = read_scene("light_behind"), turned = read_scene("light_behind");
    lc_error err = {""};
    int lamp = 0, used = 0;
    while (!desc.shapes[lamp].emits)
        ++lamp;
    turned.shapes[lamp].flip_normals = !turned.shapes[lamp].flip_normals;
    lc_scene *scene = build_scene(&desc);
    lc_film *film = render(scene, find("hemisphere_two_sided"), 1), *right = render(scene, find("hemisphere_direct"), 1);
    const lc_scene_desc *d = lc_scene_description(scene);
    double is = 0, expected = 0, variance = 0;
    for (int i = 0; i < SIDE * SIDE; ++i) {
        lc_ray ray = lc_camera_ray(&d->camera, SIDE, SIDE, i % SIDE + 0.5, i / SIDE + 0.5);
        lc_hit hit;
        lc_camera_see(scene, &ray, &hit);
        ck_assert_double_eq(right->pixels[i].c[0].mean, 0);
        if (!hit.valid || hit.shape == lamp)
            continue;
        lc_rgb irradiance;
        ck_assert_int_eq(lc_direct_irradiance(&irradiance, &turned, hit.p, lc_facing(hit.n, hit.wo), &err), LC_OK);
        expected += lc_lambert_reflected(lc_material_at(scene, &hit).diffuse.r, irradiance.r);
        is += film->pixels[i].c[0].mean;
        variance += lc_pixel_variance(&film->pixels[i], 0);
        ++used;
    }
    ck_assert_int_gt(used, SIDE * SIDE / 4);
    /* pixel centres, and pixels on edges: some percent */
    ck_assert_msg(fabs(is / expected - 1) < 0.05 + 6 * sqrt(variance) / expected, "%g, predicted %g", is, expected);
    lc_film_free(film);
    lc_film_free(right);
    lc_scene_free(scene);
    lc_scene_desc_release(&turned);
}
END_TEST

/* Means over the sphere: of the albedo, and of the albedo where it is dark, by midpoints. */
static void sphere_means(double *rho, double *dark, const lc_texture *albedo, const lc_texture *radiance)
{
    const int n = 2000;
    double weight = 0, sum = 0, dark_sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            double u = (i + 0.5) / n, v = (j + 0.5) / n, w = sin(LC_PI * v), a = lc_texture_at(albedo, u, v).r;
            weight += w;
            sum += w * a;
            dark_sum += lc_texture_at(radiance, u, v).r > 0 ? 0 : w * a;
        }
    *rho = sum / weight;
    *dark = dark_sum / weight;
}

/* A path that ends at a light: inside a sphere each next point is any point, so that where it is dark K reflections give rho(x) <Le> sum
 * d^j, j < K, d the mean over the sphere of the albedo of what is dark, instead of <rho>^j. */
START_TEST(what_a_path_that_ends_at_a_light_costs)
{
    lc_scene_desc desc = read_scene("furnace_checker");
    lc_texture radiance = desc.shapes[0].radiance, albedo = desc.materials[desc.shapes[0].material].side[0].diffuse;
    double rho, dark, is = 0, full = 0, error = 0;
    enum { K = 4 };
    sphere_means(&rho, &dark, &albedo, &radiance);
    lc_scene *scene = build_scene(&desc);
    lc_film *film = render(scene, find("path_ends_at_light"), K), *right = render(scene, find("path"), K);
    const lc_scene_desc *d = lc_scene_description(scene);
    for (int i = 0; i < SIDE * SIDE; ++i) {
        int is_dark = 1;
        for (int k = 0; k < 25 && is_dark; ++k) {
            lc_ray ray = lc_camera_ray(&d->camera, SIDE, SIDE, i % SIDE + k % 5 / 4.0, i / SIDE + k / 5 / 4.0);
            lc_hit hit;
            lc_camera_see(scene, &ray, &hit);
            is_dark = lc_emission(scene, &hit).r == 0;
        }
        if (!is_dark)
            continue;
        is += film->pixels[i].c[0].mean;
        full += right->pixels[i].c[0].mean;
        error += lc_pixel_variance(&film->pixels[i], 0) + lc_pixel_variance(&right->pixels[i], 0);
    }
    double predicted = (1 - pow(dark, K)) / (1 - dark) / ((1 - pow(rho, K)) / (1 - rho));
    ck_assert_double_gt(full, 0);
    ck_assert_double_lt(predicted, 0.8); /* a trap that is worth the name */
    ck_assert_msg(fabs(is / full - predicted) < 6 * sqrt(error) / full, "%g of it, predicted %g", is / full, predicted);
    lc_film_free(film);
    lc_film_free(right);
    lc_scene_free(scene);
}
END_TEST

/* ---- two surfaces ------------------------------------------------------------------------------------------------------ */

typedef struct patch {
    const lc_scene_desc *desc;
    lc_vec3 p, n, q, u, v, m; /* receiver; centre, half sides and normal of the wall */
    double s;
} patch;

static double along_v(double t, void *user)
{
    const patch *c = user;
    lc_vec3 q = lc_add(c->q, lc_add(lc_scale(c->s, c->u), lc_scale(t, c->v))), to = lc_sub(q, c->p);
    double d2 = lc_dot(to, to);
    lc_rgb e;
    lc_error err = {""};
    ck_assert_int_eq(lc_direct_irradiance(&e, c->desc, q, c->m, &err), LC_OK);
    return e.g * fmax(lc_dot(c->n, to), 0) * fmax(-lc_dot(c->m, to), 0) / (d2 * d2);
}

static double along_u(double s, void *user)
{
    patch *c = user;
    double sum;
    lc_error err = {""};
    c->s = s;
    ck_assert_int_eq(lc_quadrature(&sum, along_v, c, -1, 1, 0, 1e-8, &err), LC_OK);
    return sum;
}

/* The product rule against adaptive quadrature, near the wall and far from it. */
START_TEST(one_particle_via_two_surfaces)
{
    lc_scene_desc desc = read_scene("two_surfaces");
    lc_error err = {""};
    lc_second second;
    ck_assert_msg(lc_second_prepare(&second, &desc, &err) == LC_OK, "%s", err.text);
    const lc_affine *wall = &desc.shapes[1].to_world, *floor = &desc.shapes[0].to_world;
    for (int i = 0; i < 5; ++i) {
        patch c = {.desc = &desc, .n = lc_vec(0, 0, 1), .m = lc_vec(1, 0, 0)};
        c.p = lc_affine_point(floor, lc_vec(-1 + 0.5 * i, 0.4 - 0.3 * i, 0));
        c.q = lc_affine_point(wall, lc_vec(0, 0, 0));
        c.u = lc_affine_vector(wall, lc_vec(1, 0, 0));
        c.v = lc_affine_vector(wall, lc_vec(0, 1, 0));
        double sum, area = lc_length(lc_cross(c.u, c.v));
        ck_assert_int_eq(lc_quadrature(&sum, along_u, &c, -1, 1, 0, 1e-7, &err), LC_OK);
        double rho = desc.materials[desc.shapes[1].material].side[0].diffuse.color[0].g;
        double should = sum * area * rho / LC_PI, is = lc_second_irradiance(&second, 0, c.p, c.n).g;
        ck_assert_msg(fabs(is / should - 1) < 1e-6, "point %d: %.9g, by adaptive quadrature %.9g", i, is, should);
    }
    lc_second_release(&second);
    desc.shapes[1].kind = LC_DISK;
    ck_assert_int_eq(lc_second_prepare(&second, &desc, &err), LC_BAD_INPUT);
    lc_scene_desc_release(&desc);
}
END_TEST

Suite *lc_suite_convergence(void)
{
    Suite *suite = suite_create("convergence");
    TCase *c = tcase_create("convergence");
    tcase_set_timeout(c, 60);
    tcase_add_test(c, the_error_falls_as_the_root);
    tcase_add_test(c, a_bias_bends_the_line);
    tcase_add_test(c, light_sampling_is_better_by_so_much);
    tcase_add_test(c, what_a_two_sided_light_costs);
    tcase_add_test(c, what_a_path_that_ends_at_a_light_costs);
    tcase_add_test(c, one_particle_via_two_surfaces);
    suite_add_tcase(suite, c);
    return suite;
}
