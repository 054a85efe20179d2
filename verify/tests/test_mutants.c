/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every mutant is shown wrong by the quick suite, here by one check on one scene, so that it stays fast; what it was
 * before is not. */
#include "verify/tests/tests.h"

#include <stdio.h>
#include <string.h>

#include "io/scene_read.h"
#include "estimators/registry.h"
#include "verify/judge/judge.h"
#include "verify/mutants/registry.h"

/* Which check catches it, and where. A scene blind to the bug would leave it UNDECIDED or, worse, let it PASS. */
static const struct row {
    const char *mutant, *check, *scene;
} rows[] = {
    {"light_no_cosine", "analytic", "plane_point"},
    {"light_no_pi", "analytic", "plane_point"},
    {"light_no_count", "analytic", "two_lights"},
    {"light_no_light_cosine", "analytic", "plane_rectangle"},
    {"light_no_visibility", "equality", "occluder"},
    {"light_no_distance", "analytic", "plane_rectangle"},
    {"light_back_emits", "analytic", "light_behind"},
    {"light_centre", "analytic", "plane_rectangle"},
    {"light_below_horizon", "analytic", "light_below"},
    {"light_one_percent", "analytic", "plane_point"},
    /* On plane_rectangle, parallel to its lamp, cos cos d^2 = h^2: no variance, which proves nothing. */
    {"three_point_jacobian_inverted", "analytic", "plane_tilted"},
    {"three_point_back_emits", "analytic", "light_behind"},
    {"three_point_no_visibility", "equality", "occluder"},
    {"three_point_uniform_pick", "analytic", "two_lights"},
    {"three_point_light_density", "analytic", "two_lights"},
    {"hemisphere_no_cosine", "analytic", "plane_rectangle"}, /* under a constant sky it has no variance */
    {"hemisphere_no_pi", "analytic", "sky"},
    {"hemisphere_cosine_directions", "analytic", "sky"},
    {"path_no_cosine", "equality", "bright_room"},
    {"path_cosine_twice", "analytic", "sky"},
    {"path_no_pi", "analytic", "sky"},
    {"path_cosine_directions", "analytic", "sky"},
    {"path_cosine_density", "equality", "bright_room"}, /* a constant sky is blind to it */
    {"path_normal_not_turned", "equality", "bright_room"},
    {"path_albedo_once", "furnace", "furnace_sphere"},
    {"path_u_reaches_one", "analytic", "sky"},
    {"path_too_deep", "furnace", "furnace_sphere"},
    {"path_too_short", "furnace", "furnace_sphere"},
    {"path_emission_last", "furnace", "furnace_sphere"},
    {"path_ends_at_light", "furnace", "furnace_checker"}, /* in furnace_sphere it is black without variance */
    {"path_no_camera_emission", "emission", "cornell"},
    {"path_no_camera_sky", "emission", "glass_sphere"},
    {"mirror_extra_cosine", "specular", "mirror_corridor"},
    {"mirror_wrong_sign", "specular", "mirror_corridor"},
    {"mirror_no_albedo", "specular", "mirror_corridor"},
    {"mirror_not_divided", "specular", "mirror_sky"},
    {"mirror_divided_swapped", "specular", "mirror_sky"},
    {"mirror_not_counted", "specular", "mirror_corridor"},
    {"dielectric_schlick", "specular", "glass_slab"},
    {"dielectric_eta_inverted", "specular", "critical_angle"},
    {"dielectric_always_enters", "specular", "glass_slab"},
    {"dielectric_total_is_black", "specular", "critical_angle"},
    {"dielectric_no_ior_squared", "specular", "glass_blend"},
    {"dielectric_weighted_again", "specular", "glass_sphere"},
    {"dielectric_never_reflects", "specular", "glass_blend"},
    {"dielectric_swapped", "specular", "glass_blend"},
    {"dielectric_straight", "specular", "glass_slab"},
    {"glossy_no_jacobian", "effects", "glossy_lamp"},
    {"glossy_no_cosine", "effects", "glossy_lamp"},
    {"glossy_one_direction", "effects", "glossy_lamp"},
    {"light_lamp_at_rest", "effects", "motion_lamp"},
    {"light_shadow_at_rest", "effects", "motion_shadow"},
    {"hemisphere_no_time", "effects", "motion_lamp"},
    {"cosine_again", "furnace", "furnace_sphere"},
    {"cosine_no_pi", "furnace", "furnace_sphere"},
    {"nee_counted_twice", "furnace", "furnace_sphere"},
    {"nee_camera_lost", "emission", "cornell"},
    {"nee_sky_lost", "analytic", "sky"},
    {"nee_one_deeper", "furnace", "furnace_sphere"},
    {"nee_one_short", "furnace", "furnace_sphere"},
    {"nee_no_cosine", "analytic", "mixed_lights"},
    {"nee_no_count", "analytic", "mixed_lights"},
    {"mis_hit_weight_one", "furnace", "furnace_sphere"},
    {"mis_area_density", "analytic", "mixed_lights"},
    {"mis_delta_weighted", "analytic", "mixed_lights"},
    {"mis_sum_not_one", "analytic", "mixed_lights"},
    {"mis_power_hit_weight_one", "furnace", "furnace_sphere"},
    {"mis_power_area_density", "analytic", "mixed_lights"},
    {"rr_not_divided", "furnace", "furnace_sphere"},
    {"rr_divided_twice", "furnace", "furnace_sphere"},
    {"analog_weighted_again", "furnace", "furnace_sphere"},
    {"analog_dies_twice", "furnace", "furnace_sphere"},
    {"full_lost_after_delta", "specular", "mirror_corridor"},
    {"full_not_divided", "furnace", "furnace_sphere"},
    {"full_hit_weight_one", "analytic", "mixed_lights"},
    {"full_survival_forgotten", "furnace", "furnace_sphere"},
    {"direct_mis_hit_weight_one", "furnace", "furnace_sphere"},
    {"direct_mis_area_density", "analytic", "mixed_lights"},
    {"solid_area_points", "analytic", "plane_sphere"},
    {"solid_jacobian_again", "analytic", "plane_rectangle"},
    {"light_clamped", "metamorphic", "five_lights"},
    {"light_ignores_dim", "metamorphic", "five_lights"},
    {"light_ignores_near", "metamorphic", "five_lights"},
    {"light_softened", "metamorphic", "five_lights"},
    {"three_point_softened", "metamorphic", "five_lights"},
    {"hemisphere_world_frame", "metamorphic", "five_lights"},
    {"hemisphere_reseeded", "convergence", "two_patches"},
    {"hemisphere_two_sided", "analytic", "light_behind"},
    {"path_clamped", "metamorphic", "bright_mirrors"},
    {"path_ends_when_dim", "metamorphic", "bright_mirrors"},
    {"path_roulette_undivided", "metamorphic", "bright_mirrors"},
    {"mirror_world_up", "metamorphic", "bright_mirrors"},
    {"light_first_only", "analytic", "two_lights"},
    {"light_last_never", "analytic", "two_lights"},
    {"light_light_cosine_twice", "analytic", "plane_rectangle"},
    {"light_cosine_of_viewer", "analytic", "plane_rectangle"},
    {"light_distance_once", "analytic", "plane_rectangle"},
    {"light_normal_not_turned", "equality", "bright_room"},
    {"light_double_area", "analytic", "plane_rectangle"},
    {"light_red_only", "analytic", "two_lights"},
    {"three_point_no_cosine", "analytic", "plane_tilted"},
    {"three_point_no_light_cosine", "analytic", "plane_tilted"},
    {"three_point_no_pi", "analytic", "plane_tilted"},
    {"three_point_count_again", "analytic", "two_lights"},
    {"three_point_normal_not_turned", "equality", "bright_room"},
    {"hemisphere_cosine_density", "analytic", "plane_rectangle"},
    {"hemisphere_angle_uniform", "analytic", "plane_rectangle"},
    {"hemisphere_cube", "analytic", "plane_rectangle"},
    {"hemisphere_whole_sphere", "analytic", "sky"},
    {"hemisphere_normal_not_turned", "equality", "bright_room"},
    {"hemisphere_cosine_of_viewer", "analytic", "plane_rectangle"},
    {"path_half_density", "analytic", "sky"},
    {"path_gamma", "analytic", "sky"},
    {"path_reuses_numbers", "equality", "bright_room"},
    {"path_same_number", "equality", "bright_room"},
    {"path_emission_unweighted", "furnace", "furnace_checker"},
    {"path_roulette_inverted", "furnace", "furnace_checker"},
    {"path_roulette_capped", "furnace", "furnace_checker"},
    {"mirror_albedo_twice", "specular", "mirror_corridor"},
    {"mirror_light_not_seen", "specular", "mirror_corridor"},
    {"dielectric_one_polarisation", "specular", "glass_slab"},
    {"dielectric_ior_once", "specular", "glass_blend"},
    {"dielectric_ior_squared_inverted", "specular", "glass_blend"},
    {"dielectric_half_and_half", "specular", "glass_slab"},
    {"light_shadow_hits_light", "analytic", "mixed_lights"},
    {"three_point_shadow_compares", "analytic", "plane_tilted"},
    {"light_normal_leaks", "equality", "bright_room"},
    {"three_point_normal_leaks", "equality", "bright_room"},
    {"mis_other_density", "analytic", "mixed_lights"},
    {"path_roulette_dimmest", "furnace", "furnace_sphere"},
};
enum { ROWS = sizeof rows / sizeof rows[0] };

static const lc_estimator *find_estimator(const char *name)
{
    for (const lc_estimator *const *e = lc_estimators; *e; ++e)
        if (strcmp((*e)->name, name) == 0)
            return *e;
    return NULL;
}

static void run(lc_report *report, const lc_estimator *estimator, const struct row *row, double margin)
{
    lc_verify_options options;
    lc_error err = {""};
    lc_verify_options_init(&options);
    options.estimator = estimator;
    options.check = row->check;
    options.scene = row->scene;
    options.margin = margin;
    lc_status status = lc_verify(report, &options, lc_scene_open, &err);
    ck_assert_msg(status == LC_OK, "%s, %s on %s: %s", estimator->name, row->check, row->scene, err.text);
}

START_TEST(test_each_mutant_has_a_row)
{
    int count = 0;
    const lc_mutant *m;
    for (; (m = lc_mutant_at(count)) != NULL; ++count) {
        int found = 0;
        for (int i = 0; i < ROWS; ++i)
            found += strcmp(rows[i].mutant, m->estimator->name) == 0;
        ck_assert_msg(found == 1, "%s has %d rows here, not 1", m->estimator->name, found);
        int known = 0;
        for (const lc_mutant_category *c = lc_mutant_categories; c->name; ++c)
            known |= strcmp(c->name, m->category) == 0;
        ck_assert_msg(known, "%s: no category '%s'", m->estimator->name, m->category);
        ck_assert_msg(m->story[0] && m->shows[0] && m->hint[0], "%s: a text is empty", m->estimator->name);
        ck_assert_msg(find_estimator(m->of) != NULL, "%s: no estimator '%s'", m->estimator->name, m->of);
    }
    ck_assert_int_eq(count, ROWS);
}
END_TEST

/* As in `lightcheck verify -e MUTANT`: a row has the same share of the budget, alone or in the whole suite. */
START_TEST(test_mutant_is_wrong)
{
    const struct row *row = &rows[_i];
    const lc_mutant *mutant = lc_mutant_find(row->mutant);
    lc_report report;
    ck_assert_msg(mutant != NULL, "no mutant '%s'", row->mutant);
    run(&report, mutant->estimator, row, 0);
    ck_assert_msg(report.count > 0, "%s: %s says nothing about it on %s", row->mutant, row->check, row->scene);
    lc_status status = lc_report_status(&report);
    ck_assert_msg(status == LC_WRONG, "%s (%s) survives %s on %s: %s", row->mutant, mutant->estimator->summary,
                  row->check, row->scene, status == LC_OK ? "PASS" : report.rows[0].reason);
    lc_report_release(&report);
}
END_TEST

/* At four times the margin, which spares 15 of 16 samples and no right estimator. */
START_TEST(test_origin_is_not_wrong)
{
    const struct row *row = &rows[_i];
    const lc_mutant *mutant = lc_mutant_find(row->mutant);
    lc_report report;
    ck_assert_msg(mutant != NULL, "no mutant '%s'", row->mutant);
    for (int i = 0; i < _i; ++i)
        if (strcmp(rows[i].check, row->check) == 0 && strcmp(rows[i].scene, row->scene) == 0 &&
            strcmp(lc_mutant_find(rows[i].mutant)->of, mutant->of) == 0)
            return; /* was here already */
    run(&report, find_estimator(mutant->of), row, 0.02);
    /* The hub of an equality is not held against itself. */
    ck_assert_msg(report.count > 0 || strcmp(row->check, "equality") == 0, "%s says nothing about %s on %s", row->check,
                  mutant->of, row->scene);
    for (int i = 0; i < report.count; ++i)
        ck_assert_msg(report.rows[i].verdict == LC_ROW_PASS, "%s, %s: %s", mutant->of, row->check,
                      report.rows[i].reason);
    lc_report_release(&report);
}
END_TEST

/* Right in another way than ours: where several lights, tilted ones and several bounces would show a wrong density. */
static const struct row variant_rows[] = {
    {"light_uneven_choice", "analytic", "five_lights"},
    {"light_all", "analytic", "mixed_lights"},
    {"light_two_samples", "analytic", "two_lights"},
    {"light_antithetic", "analytic", "five_lights"},
    {"light_single", "analytic", "two_lights"},
    {"three_point_by_light", "analytic", "two_lights"},
    {"three_point_all", "analytic", "five_lights"},
    {"three_point_uneven_choice", "analytic", "two_lights"},
    {"hemisphere_cosine", "analytic", "plane_rectangle"},
    {"hemisphere_sphere", "analytic", "plane_rectangle"},
    {"hemisphere_strata", "analytic", "plane_rectangle"},
    {"hemisphere_mixture", "analytic", "plane_rectangle"},
    {"path_by_cosine", "furnace", "furnace_checker"},
    {"path_by_mixture", "furnace", "furnace_checker"},
    {"path_host_samples", "furnace", "furnace_checker"},
    {"path_absorbed", "furnace", "furnace_checker"},
    {"path_never_ends", "furnace", "furnace_checker"},
    {"path_half_survive", "furnace", "furnace_sphere"},
    {"path_by_throughput", "furnace", "furnace_checker"},
    {"specular_even", "specular", "glass_blend"},
};
enum { VARIANT_ROWS = sizeof variant_rows / sizeof variant_rows[0] };

START_TEST(test_each_variant_has_a_row)
{
    int count = 0;
    for (; lc_variants[count]; ++count)
        ck_assert_str_eq(lc_variants[count]->name, variant_rows[count].mutant);
    ck_assert_int_eq(count, VARIANT_ROWS);
}
END_TEST

/* At four times the margin, as for the origins above; twice, where rare long paths want more samples than those of that margin. */
START_TEST(test_variant_passes)
{
    lc_report report;
    run(&report, lc_variants[_i], &variant_rows[_i], strcmp(variant_rows[_i].mutant, "path_half_survive") ? 0.02 : 0.01);
    ck_assert_int_gt(report.count, 0);
    for (int i = 0; i < report.count; ++i)
        ck_assert_msg(report.rows[i].verdict == LC_ROW_PASS, "%s is accused: %s", lc_variants[_i]->name,
                      report.rows[i].reason);
    lc_report_release(&report);
}
END_TEST

Suite *lc_suite_mutants(void)
{
    Suite *suite = suite_create("mutants");
    TCase *c = tcase_create("mutants");
    tcase_set_tags(c, "long"); /* many samples, no code that other tests do not run */
    tcase_set_timeout(c, 120);
    tcase_add_test(c, test_each_mutant_has_a_row);
    tcase_add_loop_test(c, test_mutant_is_wrong, 0, ROWS);
    tcase_add_loop_test(c, test_origin_is_not_wrong, 0, ROWS);
    tcase_add_test(c, test_each_variant_has_a_row);
    tcase_add_loop_test(c, test_variant_passes, 0, VARIANT_ROWS);
    suite_add_tcase(suite, c);
    return suite;
}
