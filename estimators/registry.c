/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Every estimator that the program ships: a new one is a file and one line here.
 */
#include "registry.h"

#include <stddef.h>

#define ESTIMATORS(X) \
    X(hemisphere_direct) \
    X(light_direct) \
    X(three_point)       \
    X(path)              \
    X(path_cosine) \
    X(path_nee) \
    X(path_mis) \
    X(path_mis_power) \
    X(path_rr) \
    X(path_analog) \
    X(mirror)            \
    X(dielectric)        \
    X(glossy_direct) \
    X(path_full) \
    X(direct_mis) \
    X(light_solid_angle)

#define DECLARE(id) extern const lc_estimator lc_estimator_##id;
#define MEMBER(id) &lc_estimator_##id,

ESTIMATORS(DECLARE)

const lc_estimator *const lc_estimators[] = {ESTIMATORS(MEMBER) NULL};
