/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Mirrors, glass, and the three parts of the BSDF: closed forms first. */
#include <math.h>
#include <string.h>

#include "verify/analytic/analytic.h"
#include "verify/tests/tests.h"

static const double indices[] = {1.0, 1.0003, 1.33, 1.5, 2.4, 1 / 1.33, 1 / 1.5, 1 / 2.4};
enum { INDICES = sizeof indices / sizeof indices[0] };

static void check_close(double got, double expected, double tolerance)
{
    ck_assert_msg(fabs(got - expected) <= tolerance, "%.17g, expected %.17g", got, expected);
}

static void check_same_direction(lc_vec3 got, lc_vec3 expected)
{
    ck_assert_msg(lc_length(lc_sub(got, expected)) <= 1e-14, "(%g, %g, %g), expected (%g, %g, %g)", got.x, got.y, got.z,
                  expected.x, expected.y, expected.z);
}

/* ---- laws --------------------------------------------------------------------------------------------------- */

START_TEST(fresnel_has_its_closed_forms)
{
    check_close(lc_fresnel(1, 1.5), 0.04, 1e-16); /* upright: ((n - 1) / (n + 1))^2 */
    check_close(lc_fresnel(1, 1 / 1.5), 0.04, 1e-16);
    check_close(lc_fresnel(1, 2.4), 49 / 289.0, 1e-15);
    /* Brewster, tan t = n: only s is reflected, ((n^2 - 1) / (n^2 + 1))^2 of it. */
    check_close(lc_fresnel(1 / sqrt(3.25), 1.5), 0.5 * 25 / 169, 1e-15);
    check_close(lc_fresnel(0.5, 1.0), 0, 0); /* nothing there */
    check_close(lc_fresnel(1e-6, 1.0), 0, 0);
    check_close(lc_fresnel(1e-9, 1.5), 1, 1e-7); /* grazing */
    double critical = sqrt(1 - 1 / 2.25);
    ck_assert(lc_fresnel(critical * (1 - 1e-12), 1 / 1.5) == 1);
    ck_assert(lc_fresnel(critical * (1 + 1e-12), 1 / 1.5) < 1);
    check_close(lc_fresnel(0.5, 1.33), 0.05912, 1e-5); /* 60 degrees, water; Schlick would say 0.05068 */
}
END_TEST

START_TEST(fresnel_agrees_with_the_independent_one)
{
    for (int i = 0; i < INDICES; ++i)
        for (int k = 1; k <= 1000; ++k)
            check_close(lc_fresnel(k / 1000.0, indices[i]), lc_fresnel_dielectric(k / 1000.0, indices[i]), 1e-12);
}
END_TEST

/* 30 degrees into n = 1.5: sin t = 1/3. */
START_TEST(refraction_of_a_known_angle)
{
    lc_vec3 wi, wo = lc_vec(0.5, 0, sqrt(0.75)), n = lc_vec(0, 0, 1);
    ck_assert_int_eq(lc_refract(wo, n, 1.5, &wi), 1);
    check_same_direction(wi, lc_vec(-1 / 3.0, 0, -sqrt(8) / 3));
    ck_assert_int_eq(lc_refract(wo, lc_neg(n), 1.5, &wi), 1); /* n on the other side: the same */
    check_same_direction(wi, lc_vec(-1 / 3.0, 0, -sqrt(8) / 3));
    check_same_direction(lc_reflect(wo, n), lc_vec(-0.5, 0, sqrt(0.75)));
    check_same_direction(lc_reflect(wo, lc_neg(n)), lc_vec(-0.5, 0, sqrt(0.75)));
    ck_assert_int_eq(lc_refract(lc_vec(0.8, 0, 0.6), n, 1 / 1.5, &wi), 0); /* 0.8 * 1.5 > 1 */
}
END_TEST

/* In any pose: Snell, one plane, unit length, the way back; and total exactly where Fresnel says 1. */
START_TEST(refraction_obeys_snell_everywhere)
{
    lc_vec3 n = lc_normalize(lc_vec(1, -2, 0.5)), side = lc_normalize(lc_cross(n, lc_vec(0, 0, 1)));
    int total = 0;
    for (int i = 0; i < INDICES; ++i) {
        for (int k = 1; k < 200; ++k) {
            double cosine = k / 200.0, sine = sqrt(1 - cosine * cosine), ior = indices[i];
            lc_vec3 wi, back, wo = lc_add(lc_scale(cosine, n), lc_scale(sine, side));
            int goes = lc_refract(wo, n, ior, &wi);
            ck_assert_int_eq(goes, lc_fresnel(lc_dot(n, wo), ior) < 1);
            total += !goes;
            if (!goes)
                continue;
            check_close(lc_length(wi), 1, 1e-14);
            check_close(lc_dot(wi, side) * ior, -sine, 1e-13);
            ck_assert(lc_dot(wi, n) < 0);
            check_close(lc_dot(wi, lc_cross(n, side)), 0, 1e-14);
            ck_assert_int_eq(lc_refract(wi, n, 1 / ior, &back), 1);
            ck_assert(lc_length(lc_sub(back, wo)) < 1e-12);
            check_close(lc_fresnel(-lc_dot(n, wi), 1 / ior), lc_fresnel(lc_dot(n, wo), ior), 1e-12); /* reversible */
        }
    }
    ck_assert_int_gt(total, 200);
}
END_TEST

/* ---- BSDF --------------------------------------------------------------------------------------------------- */

/* The z = 0 plane of one material, and a hit on it seen from its front or back at this cosine. */
static lc_scene *make_scene(const lc_material_desc *material)
{
    lc_scene_desc desc;
    lc_scene *scene = NULL;
    lc_scene_desc_init(&desc);
    *lc_scene_desc_add_material(&desc) = *material;
    lc_shape_desc *shape = lc_scene_desc_add_shape(&desc);
    shape->kind = LC_RECTANGLE;
    shape->to_world = lc_affine_identity();
    ck_assert_int_eq(lc_scene_build(&scene, &desc, NULL), LC_OK);
    lc_scene_desc_release(&desc);
    return scene;
}

static lc_hit make_hit(const lc_scene *scene, double cosine, int back)
{
    lc_hit hit;
    lc_vec3 wo = lc_vec(sqrt(1 - cosine * cosine), 0, back ? -cosine : cosine);
    lc_ray ray = {wo, lc_neg(wo), 0};
    lc_intersect(scene, &ray, &hit);
    ck_assert_int_eq(hit.valid, 1);
    return hit;
}

static const lc_material_desc blend = {"blend",
                                       0,
                                       {{{0, {{0.25, 0.2, 0.1}, {0, 0, 0}}, {1, 1}, {0, 0}}, {0.3, 0.2, 0.1}, 0.4, {0, 0, 0}, 0},
                                        {{0, {{0, 0, 0}, {0, 0, 0}}, {1, 1}, {0, 0}}, {0, 0, 0}, 0.4, {0, 0, 0}, 0}},
                                       1.5,
                                       1};

static lc_sampler make_sampler(uint32_t sample)
{
    lc_sampler sampler;
    lc_sampler_start(&sampler, 7, 1, 0, sample);
    lc_sampler_seek(&sampler, LC_DIMENSION_ESTIMATOR);
    return sampler;
}

/* Upright on a blend: diffuse .25, mirror .3, glass .4 of which F = .04 is reflected; in all .95. */
START_TEST(sample_of_a_blend)
{
    lc_scene *scene = make_scene(&blend);
    lc_hit hit = make_hit(scene, 1, 0);
    enum { N = 100000 };
    int count[4] = {0, 0, 0, 0};
    for (uint32_t k = 0; k < N; ++k) {
        lc_sampler sampler = make_sampler(k);
        lc_scatter s;
        ck_assert_int_eq(lc_bsdf_sample(scene, &hit, &sampler, &s), 1);
        ck_assert_uint_eq(sampler.dimension, LC_DIMENSION_ESTIMATOR + 3);
        ck_assert_int_eq(s.is_delta, s.lobe != LC_DIFFUSE);
        int way = s.lobe == LC_DIFFUSE ? 0 : s.lobe == LC_MIRROR ? 1 : s.wi.z > 0 ? 2 : 3;
        ++count[way];
        switch (way) {
        case 0:
            ck_assert(s.wi.z > 0);
            check_close(s.value.g, 0.2 / LC_PI, 1e-16);
            check_close(s.pdf, 0.25 / 0.95 * s.wi.z / LC_PI, 1e-15);
            check_close(s.pdf, lc_bsdf_pdf(scene, &hit, s.wi), 0);
            check_close(s.value.b, lc_bsdf_eval(scene, &hit, s.wi).b, 0);
            break;
        case 1:
            check_close(s.value.g, 0.2, 0);
            check_close(s.pdf, 0.3 / 0.95, 1e-15);
            break;
        case 2:
            check_close(s.value.r, 0.4 * 0.04, 1e-16);
            check_close(s.pdf, 0.4 * 0.04 / 0.95, 1e-15);
            break;
        default:
            check_close(s.value.r, 0.4 * 0.96 / 2.25, 1e-15); /* radiance from glass into air is divided by n^2 */
            check_close(s.pdf, 0.4 * 0.96 / 0.95, 1e-15);
            check_same_direction(s.wi, lc_vec(0, 0, -1));
        }
    }
    static const double share[4] = {0.25, 0.3, 0.016, 0.384};
    for (int w = 0; w < 4; ++w) { /* six sigma */
        double p = share[w] / 0.95;
        check_close(count[w] / (double)N, p, 6 * sqrt(p * (1 - p) / N));
    }
    lc_scene_free(scene);
}
END_TEST

/* Through a pane and out again n^2 cancels: what is left is (1 - F)^2. */
START_TEST(radiance_through_two_interfaces)
{
    lc_material_desc glass = blend;
    memset(glass.side, 0, sizeof glass.side);
    glass.side[0].glass = glass.side[1].glass = 1;
    lc_scene *scene = make_scene(&glass);
    lc_hit hit = make_hit(scene, 0.6, 0);
    double product = 1, fresnel = lc_fresnel_dielectric(0.6, 1.5);
    for (int interface = 0; interface < 2; ++interface) {
        lc_scatter s = {.wi = {0, 0, 0}};
        for (uint32_t k = 0; k == 0 || s.wi.z * hit.wo.z > 0; ++k) {
            lc_sampler sampler = make_sampler(k);
            ck_assert_int_eq(lc_bsdf_sample(scene, &hit, &sampler, &s), 1);
        }
        check_close(s.value.r, (1 - fresnel) * (interface ? 2.25 : 1 / 2.25), 1e-14);
        product *= s.value.r;
        hit.wo = s.wi;
    }
    check_close(product, (1 - fresnel) * (1 - fresnel), 1e-14);
    hit = make_hit(scene, 0.5, 1); /* from inside, beyond the critical angle: all is reflected */
    for (uint32_t k = 0; k < 100; ++k) {
        lc_scatter s;
        lc_sampler sampler = make_sampler(k);
        ck_assert_int_eq(lc_bsdf_sample(scene, &hit, &sampler, &s), 1);
        ck_assert(s.wi.z < 0 && s.value.r == 1 && s.pdf == 1);
    }
    lc_scene_free(scene);
}
END_TEST

/* The back of this blend has glass only; a miss has nothing. */
START_TEST(nothing_is_nothing)
{
    lc_material_desc one_sided = blend;
    one_sided.side[1].glass = 0;
    lc_scene *scene = make_scene(&one_sided);
    lc_hit hit = make_hit(scene, 0.7, 1), miss = hit, edge = make_hit(scene, 0.7, 0);
    lc_scatter s = {.lobe = 99};
    miss.valid = 0;
    edge.wo = lc_vec(1, 0, 0);
    const lc_hit *const hits[] = {&hit, &miss, &edge};
    for (int i = 0; i < 3; ++i) {
        lc_sampler sampler = make_sampler((uint32_t)i);
        ck_assert_int_eq(lc_bsdf_sample(scene, hits[i], &sampler, &s), 0);
        ck_assert_int_eq(s.lobe, 99);
        ck_assert_uint_eq(sampler.dimension, LC_DIMENSION_ESTIMATOR + 3);
        for (int side = -1; side <= 1; side += 2) {
            ck_assert(lc_bsdf_pdf(scene, hits[i], lc_vec(0, 0, side)) == 0);
            ck_assert(lc_rgb_max(lc_bsdf_eval(scene, hits[i], lc_vec(0, 0, side))) == 0);
        }
    }
    lc_scene_free(scene);
}
END_TEST

START_TEST(value_is_reciprocal_and_one_sided)
{
    lc_scene *scene = make_scene(&blend);
    for (int i = 1; i < 20; ++i) {
        for (int k = 1; k < 20; ++k) {
            lc_hit hit = make_hit(scene, i / 20.0, 0), back = make_hit(scene, k / 20.0, 0);
            ck_assert(lc_bsdf_eval(scene, &hit, back.wo).r == lc_bsdf_eval(scene, &back, hit.wo).r);
            check_close(lc_bsdf_eval(scene, &hit, back.wo).r, 0.25 / LC_PI, 1e-16);
            ck_assert(lc_bsdf_eval(scene, &hit, lc_neg(back.wo)).r == 0);
            ck_assert(lc_bsdf_pdf(scene, &hit, lc_neg(back.wo)) == 0);
        }
    }
    lc_scene_free(scene);
}
END_TEST

Suite *lc_suite_bsdf(void)
{
    Suite *suite = suite_create("bsdf");
    TCase *tc = tcase_create("bsdf");
    tcase_add_test(tc, fresnel_has_its_closed_forms);
    tcase_add_test(tc, fresnel_agrees_with_the_independent_one);
    tcase_add_test(tc, refraction_of_a_known_angle);
    tcase_add_test(tc, refraction_obeys_snell_everywhere);
    tcase_add_test(tc, sample_of_a_blend);
    tcase_add_test(tc, radiance_through_two_interfaces);
    tcase_add_test(tc, nothing_is_nothing);
    tcase_add_test(tc, value_is_reciprocal_and_one_sided);
    suite_add_tcase(suite, tc);
    return suite;
}
