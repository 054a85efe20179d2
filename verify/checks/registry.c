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
    free(claims->items);
    claims->items = NULL;
    claims->count = 0;
}

unsigned lc_language(const lc_scene *scene, const lc_estimator *estimator)
{
    return (estimator->lobes & lc_scene_lobes(scene)) | (estimator->emitters & lc_scene_emitters(scene)) << 8;
}

int lc_sees_everything(const lc_scene *scene, const lc_estimator *estimator)
{
    return (lc_scene_lobes(scene) & ~estimator->lobes) == 0 && (lc_scene_emitters(scene) & ~estimator->emitters) == 0;
}
