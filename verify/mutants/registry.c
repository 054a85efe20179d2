/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Every mutant, and what it was before: a new one is one line here.
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
    X(light_one_percent, "light_direct") \
    X(hemisphere_no_cosine, "hemisphere_direct") \
    X(hemisphere_no_pi, "hemisphere_direct") \
    X(hemisphere_cosine_directions, "hemisphere_direct")

#define DECLARE(id, of) extern const lc_estimator lc_estimator_##id;
#define MEMBER(id, of) {&lc_estimator_##id, of},

MUTANTS(DECLARE)

const lc_mutant lc_mutants[] = {MUTANTS(MEMBER){NULL, NULL}};
