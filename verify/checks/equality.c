/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * equality: for N = infinity these yield the same result. Each estimator against one low-noise hub a scene, where both estimate the same
 * integral: same lobes and same emitters among those that occur.
 */
#include <string.h>

#include "estimators/registry.h"
#include "verify/checks/checks.h"
#include "verify/checks/family.h"

/* The hubs, first choice first: of direct light, and of all bounces. */
static const char *const direct_hubs[] = {"light_direct"};
static const char *const deep_hubs[] = {"path_mis", "path_full", "path", "mirror", "dielectric"};

static const lc_estimator *find_hub(const lc_scene *scene, const lc_estimator *estimator, const char *const *hubs,
                                    size_t count, int bounces)
{
    for (size_t i = 0; i < count; ++i)
        for (const lc_estimator *const *e = lc_estimators; *e; ++e)
            if (strcmp((*e)->name, hubs[i]) == 0 && (*e)->max_bounces >= bounces &&
                lc_language(scene, *e) == lc_language(scene, estimator))
                return *e;
    return NULL;
}

static lc_status add(const lc_check *self, lc_claims *claims, const lc_scene *scene, const lc_estimator *estimator,
                     const lc_estimator *hub, int bounces, int full_only, lc_error *err)
{
    if (!hub || hub == estimator)
        return LC_OK;
    lc_claim *claim = lc_claims_add(claims, self, scene, estimator);
    if (!claim)
        return lc_fail(err, LC_FAULT, "out of memory for the claims");
    claim->max_bounces = bounces;
    claim->other = hub;
    claim->full_only = full_only;
    claim->source = bounces == 1 ? "light_direct, the low-noise hub of direct light, itself held against closed forms"
                                 : "another estimator of the same integral, itself held against furnaces";
    return LC_OK;
}

static lc_status plan(const lc_check *self, lc_claims *claims, const lc_scene *scene, const lc_estimator *estimator,
                      lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    unsigned emitters = estimator->emitters & lc_scene_emitters(scene);
    /* Black by both, or without variance: analytic and furnace hold these exactly; effects holds each estimator. Where emitters touch, sampling them by area has infinite
     * variance. */
    static const char *const never[] = {"light_behind", "light_below", "furnace_sphere", "thermal_furnace",
                                        "mirror_corridor", "glossy_sky", "glossy_lamp", "lens_edge", "motion_flight",
                                        "motion_shadow", "motion_lamp", "parallel_plates", "enclosure",
                                        "two_patches", "two_surfaces", "sky_wall", "mirror_wall", "lamp_100w"};
    for (size_t i = 0; i < sizeof never / sizeof never[0]; ++i)
        if (strcmp(desc->name, never[i]) == 0)
            return LC_OK;
    if (lc_family_find(desc->name)) /* each has a closed form */
        return LC_OK;
    /* So have these, in which analytic and furnace hold both sides of each equality, within the same margin. */
    static const char *const told[] = {"plane_rectangle", "plane_disk",       "plane_sphere",   "plane_cube",
                                       "textured_lamp",   "flipped_twosided", "furnace_checker"};
    for (size_t i = 0; i < sizeof told / sizeof told[0]; ++i)
        if (strcmp(desc->name, told[i]) == 0)
            return LC_OK;
    if (emitters == 0 || (estimator->lobes & lc_scene_lobes(scene)) == 0 || estimator->max_bounces < 1)
        return LC_OK;
    /* The quick suite: direct light of one tilted lamp, of several, past an occluder, in two rooms; path tracers where lamps are so
     * large that uniform directions find them. The full suite has it all. */
    static const char *const quick_direct[] = {"plane_tilted", "two_lights", "five_lights",
                                               "occluder",     "cornell",    "bright_room"};
    int is_deep = estimator->max_bounces > 1, is_quick = 0;
    /* In a Cornell box a direction rarely meets the lamp: 20 M paths a row, and a closed form holds the estimator there already. */
    int is_blind = estimator->emitters & LC_SKY && !(estimator->emitters & LC_POINT) && strncmp(desc->name, "cornell", 7) == 0;
    for (size_t i = 0; i < sizeof quick_direct / sizeof quick_direct[0]; ++i)
        is_quick |= strcmp(desc->name, quick_direct[i]) == 0 && !is_deep && !is_blind;
    lc_status status = LC_OK;
    int bounces = desc->max_bounces < estimator->max_bounces ? desc->max_bounces : estimator->max_bounces;
    /* Of mirror and dielectric the deep row tells what the direct one would, and where nothing is specular path's does; of the scale, path's
     * and three_point's do. */
    int is_scaled = strcmp(desc->name, "cornell_small") == 0 || strcmp(desc->name, "cornell_large") == 0;
    int is_plain = !(lc_scene_lobes(scene) & (LC_MIRROR | LC_GLASS));
    int is_told = (!is_quick && estimator->lobes & LC_MIRROR && (bounces > 1 || is_plain)) || (is_scaled && is_blind);
    if (estimator->lobes & lc_scene_lobes(scene) & LC_DIFFUSE && !is_told)
        status = add(self, claims, scene, estimator, find_hub(scene, estimator, direct_hubs, 1, 1), 1, !is_quick, err);
    int is_quick_deep = strcmp(desc->name, estimator->lobes & LC_MIRROR ? "bright_mirrors" : "bright_room") == 0 ||
                        (estimator->emitters & LC_POINT && strncmp(desc->name, "cornell", 7) == 0);
    if (status == LC_OK && bounces > 1 && !(is_scaled && estimator->lobes & LC_MIRROR)) /* path tells of the scale */
        status = add(self, claims, scene, estimator, find_hub(scene, estimator, deep_hubs, sizeof deep_hubs / sizeof deep_hubs[0], bounces), bounces,
                     !is_quick_deep, err);
    return status;
}

const lc_check lc_check_equality = {
    "equality",
    "estimators of the same integral agree",
    "Path Tracing (Bikker 2021-22): \"for N = infinity these yield the same result\"",
    plan,
    NULL,
};
