/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Diagnoses: a mutant from another stream is named, what no mutant does is not, and a hint tells no more than it may. */
#include "verify/tests/tests.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/scene_read.h"
#include "estimators/registry.h"
#include "verify/report/diagnosis.h"

static void diagnose(lc_diagnosis *out, const lc_estimator *estimator)
{
    lc_diagnose_options options = {1, 0};
    lc_error err = {""};
    lc_status status = lc_diagnose(out, estimator, &options, lc_scene_open, &err);
    ck_assert_msg(status == LC_OK, "%s: %s", estimator->name, err.text);
}

static const lc_estimator *right(const char *name)
{
    for (const lc_estimator *const *e = lc_estimators; *e; ++e)
        if (strcmp((*e)->name, name) == 0)
            return *e;
    ck_abort_msg("no estimator %s", name);
    return NULL;
}

static const char *const named[] = {"light_no_count", "light_no_distance", "three_point_uniform_pick", "three_point_back_emits",
                                    "hemisphere_angle_uniform"};

/* From its own stream, without knowing whose film it is. */
START_TEST(test_mutant_is_named)
{
    lc_diagnosis d;
    diagnose(&d, lc_mutant_find(named[_i])->estimator);
    ck_assert(d.is_wrong);
    ck_assert_msg(d.name_count == 1 && d.is_certain, "%s: %d names", named[_i], d.name_count);
    ck_assert_str_eq(d.names[0]->estimator->name, named[_i]);
}
END_TEST

START_TEST(test_right_one_is_not_named)
{
    static const char *const names[] = {"light_direct", "three_point"};
    lc_diagnosis d;
    diagnose(&d, right(names[_i]));
    ck_assert(!d.is_wrong);
    ck_assert_int_eq(d.name_count, 0);
    ck_assert_int_eq(d.line_count, 0);
}
END_TEST

/* Bugs that the catalogue does not have. */
static lc_rgb twice_and_a_half(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                               lc_sampler *sampler)
{
    lc_rgb c = right("light_direct")->radiance(scene, ray, hit, options, sampler);
    return options->max_bounces == 0 ? c : lc_rgb_scale(2.5, c);
}

static lc_rgb no_green(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    lc_rgb c = right("light_direct")->radiance(scene, ray, hit, options, sampler);
    return lc_color(c.r, 0.5 * c.g, c.b);
}

static lc_rgb nan_at_times(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                           lc_sampler *sampler)
{
    lc_rgb c = right("light_direct")->radiance(scene, ray, hit, options, sampler);
    return lc_next(sampler) < 1e-3 ? lc_color(NAN, 0, 0) : c;
}

static lc_rgb darker_left(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                          lc_sampler *sampler)
{
    lc_rgb c = right("light_direct")->radiance(scene, ray, hit, options, sampler);
    return hit->valid && hit->p.x < 0 ? lc_rgb_scale(0.8, c) : c;
}

/* light_direct, scaled by a power of something that it knows. */
static lc_rgb light_count_again(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                                lc_sampler *sampler)
{
    lc_rgb c = right("light_direct")->radiance(scene, ray, hit, options, sampler);
    return options->max_bounces == 0 ? c : lc_rgb_scale(lc_light_count(scene), c);
}

static lc_rgb albedo_again(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                           lc_sampler *sampler)
{
    lc_rgb c = right("light_direct")->radiance(scene, ray, hit, options, sampler);
    return options->max_bounces == 0 || !hit->valid ? c : lc_rgb_mul(lc_material_at(scene, hit).diffuse, c);
}

static lc_rgb cosines_squared(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                              lc_sampler *sampler)
{
    lc_light_sample light;
    (void)ray;
    if (options->max_bounces == 0 || !hit->valid || lc_light_count(scene) == 0)
        return options->min_bounces <= 0 ? lc_emission(scene, hit) : lc_black();
    int count = lc_light_count(scene);
    lc_light_sample_one(scene, (int)(lc_next(sampler) * count), hit, sampler, &light);
    double here = lc_dot(lc_facing(hit->n, hit->wo), light.wi), there = -lc_dot(light.n, light.wi);
    if (light.is_delta || here <= 0 || there <= 0 || !lc_visible(scene, hit, &light))
        return lc_black();
    double g = count * here * here * here * there * there / (light.distance * light.distance * light.pdf_area);
    return lc_rgb_scale(g, lc_rgb_mul(lc_bsdf_eval(scene, hit, light.wi), light.radiance));
}

static const struct unknown {
    lc_radiance_fn *radiance;
    const char *line; /* that the fingerprint has, as a part */
} unknown[] = {
    {twice_and_a_half, "by one factor in the mean, in [2.4"},
    {no_green, "channels are wrong by different factors"},
    {nan_at_times, "NaN"},
    {darker_left, "on "},
    {light_count_again, "estimate / truth is N"},
    {albedo_again, "a power of the albedo: albedo^["},
    {cosines_squared, "(cosine at the surface)^[1.9"},
};
enum { UNKNOWN = sizeof unknown / sizeof unknown[0] };

START_TEST(test_unknown_bug_gets_no_name)
{
    lc_estimator e = *right("light_direct");
    lc_diagnosis d;
    int found = 0;
    e.name = "unknown";
    e.radiance = unknown[_i].radiance;
    diagnose(&d, &e);
    ck_assert(d.is_wrong);
    ck_assert_msg(d.name_count == 0, "named %s", d.names[0] ? d.names[0]->estimator->name : "");
    for (int i = 0; i < d.line_count; ++i)
        found |= strstr(d.lines[i], unknown[_i].line) != NULL;
    ck_assert_msg(found, "no line has '%s'; the first of %d is '%s'", unknown[_i].line, d.line_count, d.lines[0]);
}
END_TEST

static char *words(const lc_diagnosis *d, lc_hint hint)
{
    char *text;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    lc_report_diagnosis(out, d, "mine", hint);
    fclose(out);
    return text;
}

START_TEST(test_hint_tells_no_more_than_it_may)
{
    static lc_diagnosis d = {.is_wrong = 1, .is_certain = 1, .name_count = 1, .candidates = 9};
    d.truth = right("light_direct");
    d.names[0] = lc_mutant_find("light_no_count");
    char *none = words(&d, LC_HINT_NONE), *category = words(&d, LC_HINT_CATEGORY), *name = words(&d, LC_HINT_NAME);
    ck_assert_str_eq(none, "mine is wrong\n");
    ck_assert(strstr(category, "what is wrong has to do with how many lights there are") != NULL);
    ck_assert(strstr(category, d.names[0]->hint) != NULL);
    ck_assert(strstr(category, d.names[0]->estimator->summary) == NULL && strstr(category, "light_no_count") == NULL);
    ck_assert(strstr(name, d.names[0]->estimator->summary) != NULL && strstr(name, "light_no_count") != NULL);
    d.name_count = 2;
    d.names[1] = lc_mutant_find("light_no_pi");
    free(category);
    category = words(&d, LC_HINT_CATEGORY);
    ck_assert_str_eq(category, none); /* two categories: none is told */
    free(name);
    name = words(&d, LC_HINT_NAME);
    ck_assert(strstr(name, "no view tells apart") != NULL && strstr(name, "light_no_pi") != NULL);
    d.is_certain = 0;
    free(name);
    name = words(&d, LC_HINT_NAME);
    ck_assert(strstr(name, "exactly") == NULL && strstr(name, "light_no_pi") != NULL);
    free(none);
    free(category);
    free(name);
}
END_TEST

Suite *lc_suite_diagnose(void)
{
    Suite *suite = suite_create("diagnose");
    TCase *c = tcase_create("diagnose");
    tcase_set_tags(c, "long"); /* many samples, no code that other tests do not run */
    tcase_set_timeout(c, 120);
    tcase_add_loop_test(c, test_mutant_is_named, 0, (int)(sizeof named / sizeof named[0]));
    tcase_add_loop_test(c, test_right_one_is_not_named, 0, 2);
    tcase_add_loop_test(c, test_unknown_bug_gets_no_name, 0, UNKNOWN);
    tcase_add_test(c, test_hint_tells_no_more_than_it_may);
    suite_add_tcase(suite, c);
    return suite;
}
