/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * equality: for N = infinity these yield the same result. Each estimator against one low-noise hub a scene, where both estimate the same
 * integral: same lobes and same emitters among those that occur.
 */
#include <string.h>

#include "estimators/registry.h"
#include "verify/checks/checks.h"

/* The hubs, first choice first. */
static const char *const hubs[] = {"light_direct"};

static const lc_estimator *find_hub(const lc_scene *scene, const lc_estimator *estimator)
{
    for (size_t i = 0; i < sizeof hubs / sizeof hubs[0]; ++i)
        for (const lc_estimator *const *e = lc_estimators; *e; ++e)
            if (strcmp((*e)->name, hubs[i]) == 0 && lc_language(scene, *e) == lc_language(scene, estimator))
                return *e;
    return NULL;
}

static lc_status plan(const lc_check *self, lc_claims *claims, const lc_scene *scene, const lc_estimator *estimator,
                      lc_error *err)
{
    const lc_estimator *hub = find_hub(scene, estimator);
    unsigned emitters = estimator->emitters & lc_scene_emitters(scene);
    if (!hub || hub == estimator || emitters == 0 || (estimator->lobes & lc_scene_lobes(scene)) == 0 ||
        estimator->max_bounces < 1)
        return LC_OK;
    /* Black by both, or without variance: analytic and furnace hold these exactly. */
    const char *name = lc_scene_description(scene)->name;
    if (strcmp(name, "light_behind") == 0 || strcmp(name, "furnace_sphere") == 0)
        return LC_OK;
    lc_claim *claim = lc_claims_add(claims, self, scene, estimator);
    if (!claim)
        return lc_fail(err, LC_FAULT, "out of memory for the claims");
    claim->other = hub;
    claim->source = "light_direct, the scene's low-noise hub, itself held against closed forms";
    return LC_OK;
}

const lc_check lc_check_equality = {
    "equality",
    "estimators of the same integral agree",
    "Path Tracing (Bikker 2021-22): \"for N = infinity these yield the same result\"",
    plan,
    NULL,
};
