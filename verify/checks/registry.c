/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Every kind of check, in the order of the report.
 */
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "verify/checks/checks.h"

#define CHECKS(X) \
    X(energy) \
    X(emission) \
    X(analytic) \
    X(specular) \
    X(effects) \
    X(furnace) \
    X(equality) \
    X(metamorphic) \
    X(convergence) \
    X(povray)

#define DECLARE(id) extern const lc_check lc_check_##id;
#define MEMBER(id) &lc_check_##id,

CHECKS(DECLARE)

const lc_check *const lc_checks[] = {CHECKS(MEMBER) NULL};

lc_claim *lc_claims_add(lc_claims *claims, const lc_check *check, const lc_scene *scene, const lc_estimator *estimator)
{
    lc_claim *items = realloc(claims->items, ((size_t)claims->count + 1) * sizeof *items);
    if (!items)
        return NULL;
    claims->items = items;
    lc_claim *claim = &items[claims->count++];
    memset(claim, 0, sizeof *claim);
    claim->check = check;
    claim->scene = scene;
    claim->estimator = estimator;
    claim->min_bounces = claim->max_bounces = 1;
    return claim;
}

void lc_claims_release(lc_claims *claims)
{
    for (int i = 0; i < claims->scene_count; ++i)
        lc_scene_free(claims->scenes[i]);
    free(claims->scenes);
    free(claims->items);
    memset(claims, 0, sizeof *claims);
}

int lc_relation_is_sharp(const lc_claim *claim) { return claim->relation && claim->slack <= 3; }

const lc_scene *lc_claims_scene(const lc_claims *claims, const char *name)
{
    for (int i = 0; i < claims->scene_count; ++i)
        if (strcmp(lc_scene_description(claims->scenes[i])->name, name) == 0)
            return claims->scenes[i];
    return NULL;
}

lc_status lc_claims_build(const lc_scene **out, lc_claims *claims, const lc_scene_desc *desc, lc_error *err)
{
    lc_scene **scenes = realloc(claims->scenes, ((size_t)claims->scene_count + 1) * sizeof(lc_scene *)), *scene;
    if (!scenes)
        return lc_fail(err, LC_FAULT, "out of memory for the scene of a claim");
    claims->scenes = scenes;
    lc_status status = lc_scene_build(&scene, desc, err);
    if (status != LC_OK)
        return status;
    *out = scenes[claims->scene_count++] = scene;
    return LC_OK;
}

unsigned lc_language(const lc_scene *scene, const lc_estimator *estimator)
{
    return (estimator->lobes & lc_scene_lobes(scene)) | (estimator->emitters & lc_scene_emitters(scene)) << 8;
}

int lc_sees_everything(const lc_scene *scene, const lc_estimator *estimator)
{
    return (lc_scene_lobes(scene) & ~estimator->lobes) == 0 && (lc_scene_emitters(scene) & ~estimator->emitters) == 0;
}
