/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Every mutant, and what it was before: a new one is one line here, and one in test_mutants.c.
 */
#include <stddef.h>

#include "registry.h"

#define MUTANTS(X) \
    X(light_no_cosine, "light_direct") \
    X(light_no_pi, "light_direct") \
    X(light_no_count, "light_direct") \
    X(light_no_light_cosine, "light_direct") \
    X(light_no_visibility, "light_direct") \
    X(light_no_distance, "light_direct") \
    X(light_back_emits, "light_direct") \
    X(light_centre, "light_direct") \
    X(light_below_horizon, "light_direct") \
    X(light_one_percent, "light_direct") \
    X(three_point_jacobian_inverted, "three_point") \
    X(three_point_back_emits, "three_point") \
    X(three_point_no_visibility, "three_point") \
    X(three_point_uniform_pick, "three_point") \
    X(three_point_light_density, "three_point") \
    X(hemisphere_no_cosine, "hemisphere_direct") \
    X(hemisphere_no_pi, "hemisphere_direct") \
    X(hemisphere_cosine_directions, "hemisphere_direct") \
    X(path_no_cosine, "path") \
    X(path_cosine_twice, "path") \
    X(path_no_pi, "path") \
    X(path_cosine_directions, "path") \
    X(path_cosine_density, "path") \
    X(path_normal_not_turned, "path") \
    X(path_albedo_once, "path") \
    X(path_u_reaches_one, "path") \
    X(path_too_deep, "path") \
    X(path_too_short, "path") \
    X(path_emission_last, "path") \
    X(path_ends_at_light, "path") \
    X(path_no_camera_emission, "path") \
    X(path_no_camera_sky, "path") \
    X(mirror_extra_cosine, "mirror") \
    X(mirror_wrong_sign, "mirror") \
    X(mirror_no_albedo, "mirror") \
    X(mirror_not_divided, "mirror") \
    X(mirror_divided_swapped, "mirror") \
    X(mirror_not_counted, "mirror") \
    X(dielectric_schlick, "dielectric") \
    X(dielectric_eta_inverted, "dielectric") \
    X(dielectric_always_enters, "dielectric") \
    X(dielectric_total_is_black, "dielectric") \
    X(dielectric_no_ior_squared, "dielectric") \
    X(dielectric_weighted_again, "dielectric") \
    X(dielectric_never_reflects, "dielectric") \
    X(dielectric_swapped, "dielectric") \
    X(dielectric_straight, "dielectric") \
    X(glossy_no_jacobian, "glossy_direct") \
    X(glossy_no_cosine, "glossy_direct") \
    X(glossy_one_direction, "glossy_direct") \
    X(light_lamp_at_rest, "light_direct") \
    X(light_shadow_at_rest, "light_direct") \
    X(hemisphere_no_time, "hemisphere_direct") \
    X(cosine_again, "path_cosine") \
    X(cosine_no_pi, "path_cosine") \
    X(nee_counted_twice, "path_nee") \
    X(nee_camera_lost, "path_nee") \
    X(nee_sky_lost, "path_nee") \
    X(nee_one_deeper, "path_nee") \
    X(nee_one_short, "path_nee") \
    X(nee_no_cosine, "path_nee") \
    X(nee_no_count, "path_nee") \
    X(mis_hit_weight_one, "path_mis") \
    X(mis_area_density, "path_mis") \
    X(mis_delta_weighted, "path_mis") \
    X(mis_sum_not_one, "path_mis") \
    X(mis_power_hit_weight_one, "path_mis_power") \
    X(mis_power_area_density, "path_mis_power") \
    X(rr_not_divided, "path_rr") \
    X(rr_divided_twice, "path_rr") \
    X(analog_weighted_again, "path_analog") \
    X(analog_dies_twice, "path_analog") \
    X(full_lost_after_delta, "path_full") \
    X(full_not_divided, "path_full") \
    X(full_hit_weight_one, "path_full") \
    X(full_survival_forgotten, "path_full") \
    X(direct_mis_hit_weight_one, "direct_mis") \
    X(direct_mis_area_density, "direct_mis") \
    X(solid_area_points, "light_solid_angle") \
    X(solid_jacobian_again, "light_solid_angle") \
    X(light_clamped, "light_direct") \
    X(light_ignores_dim, "light_direct") \
    X(light_ignores_near, "light_direct") \
    X(light_softened, "light_direct") \
    X(three_point_softened, "three_point") \
    X(hemisphere_world_frame, "hemisphere_direct") \
    X(hemisphere_reseeded, "hemisphere_direct") \
    X(hemisphere_two_sided, "hemisphere_direct") \
    X(path_clamped, "path") \
    X(path_ends_when_dim, "path") \
    X(path_roulette_undivided, "path") \
    X(mirror_world_up, "mirror")

#define DECLARE(id, of) extern const lc_estimator lc_estimator_##id;
#define MEMBER(id, of) {&lc_estimator_##id, of},

MUTANTS(DECLARE)

const lc_mutant lc_mutants[] = {MUTANTS(MEMBER){NULL, NULL}};
