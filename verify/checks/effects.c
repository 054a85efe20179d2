/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * effects: what the lecture wants Monte Carlo for beside soft shadows (those are `analytic`): glossy reflection. Pixel by pixel against
 * quadrature from verify/analytic, which reads the description and has never seen a ray.
 */
#include <string.h>

#include "estimators/registry.h"
#include "verify/analytic/effects.h"
#include "verify/checks/checks.h"

/* Error of what is integrated at a point, relative to the lamp's or the sky's radiance. */
#define AT_A_POINT 1e-6

static const lc_side *front_of(const lc_scene *scene, const lc_hit *hit)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    return &desc->materials[desc->shapes[hit->shape].material].side[0];
}

/* ---- glossy reflection ------------------------------------------------------------------------------------------- */

/* Coplanar plates under a sky, by shape: the albedo of the rough lobe over the cosines seen. */
enum { MOST_PLATES = 8 };
typedef struct plates {
    lc_ggx_series albedo[MOST_PLATES];
} plates;

static lc_status plate_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                            lc_error *err)
{
    const plates *p = user;
    (void)err;
    *kind = hit->valid ? hit->shape : -1;
    if (!value)
        return LC_OK;
    *value = lc_black();
    if (hit->valid) {
        double albedo = lc_ggx_series_at(&p->albedo[hit->shape], lc_dot(hit->n, hit->wo));
        const lc_side *side = front_of(scene, hit);
        lc_rgb sum = lc_rgb_add(lc_rgb_scale(albedo, side->glossy), side->diffuse.color[0]);
        *value = lc_rgb_mul(sum, lc_scene_description(scene)->sky);
    }
    return LC_OK;
}

static lc_status expect_plates(lc_expected *out, const lc_claim *claim, const lc_scene *scene, int threads,
                               lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    plates p;
    for (int i = 0; i < desc->shape_count && i < MOST_PLATES; ++i) {
        const lc_side *side = &desc->materials[desc->shapes[i].material].side[0];
        lc_status status = lc_ggx_series_fit(&p.albedo[i], 0.05, 1, side->alpha, err);
        if (status != LC_OK)
            return status;
    }
    return lc_expect_view(out, plate_view, &p, scene, claim->tolerance, threads, err);
}

/* Column k of a map: 0 to 2 the images of the axes, 3 of the origin. */
static lc_vec3 column(const lc_affine *a, int k) { return lc_vec(a->m[0][k], a->m[1][k], a->m[2][k]); }

static lc_status highlight_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                                lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    (void)user;
    *kind = hit->valid ? hit->shape : -1;
    if (!value)
        return LC_OK;
    *value = lc_black();
    for (int i = 0; i < desc->shape_count && hit->valid; ++i) {
        const lc_affine *map = &desc->shapes[i].to_world;
        const lc_side *side = front_of(scene, hit);
        double light;
        if (!desc->shapes[i].emits)
            continue;
        lc_status status = lc_ggx_rectangle(&light, column(map, 3), column(map, 0), column(map, 1), hit->p, hit->n,
                                            hit->wo, side->alpha, AT_A_POINT, err);
        if (status != LC_OK)
            return status;
        *value = lc_rgb_add(*value, lc_rgb_scale(light, lc_rgb_mul(side->glossy, desc->shapes[i].radiance.color[0])));
    }
    return LC_OK;
}

static lc_status expect_highlight(lc_expected *out, const lc_claim *claim, const lc_scene *scene, int threads,
                                  lc_error *err)
{
    return lc_expect_view(out, highlight_view, NULL, scene, claim->tolerance, threads, err);
}

/* ---- rows -------------------------------------------------------------------------------------------------------- */

/* In the quick suite the estimators named, and any under test; all that see the whole scene in the full one. */
static const struct {
    const char *scene;
    lc_expect_fn *expect;
    const char *quick, *source;
} rows[] = {
    {"glossy_sky", expect_plates, "path", "(r a(cos) + rho) L, a the directional albedo by quadrature"},
    {"glossy_lamp", expect_highlight, "light_direct glossy_direct", "quadrature of f cos cos' / d^2 over the lamp"},
};

/* A registered estimator whose name is not one of the words. */
static int is_unnamed(const lc_estimator *estimator, const char *words)
{
    const char *name = estimator->name;
    const lc_estimator *const *e = lc_estimators;
    size_t length = strlen(name);
    while (*e && *e != estimator)
        ++e;
    if (!*e)
        return 0;
    for (const char *at = words; (at = strstr(at, name)) != NULL; ++at)
        if ((at == words || at[-1] == ' ') && (at[length] == ' ' || at[length] == 0))
            return 0;
    return 1;
}

static lc_status plan(const lc_check *self, lc_claims *claims, const lc_scene *scene, const lc_estimator *estimator,
                      lc_error *err)
{
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        if (strcmp(rows[i].scene, lc_scene_description(scene)->name) != 0 || !lc_sees_everything(scene, estimator) ||
            estimator->max_bounces < 1)
            continue;
        lc_claim *claim = lc_claims_add(claims, self, scene, estimator);
        if (!claim)
            return lc_fail(err, LC_FAULT, "out of memory for the claims");
        claim->expect = rows[i].expect;
        claim->tolerance = 1e-5;
        claim->full_only = is_unnamed(estimator, rows[i].quick);
        claim->source = rows[i].source;
    }
    return LC_OK;
}

const lc_check lc_check_effects = {
    "effects",
    "glossy reflection against quadrature, pixel by pixel",
    "Path Tracing (Bikker 2021-22); Walter, Marschner, Li, Torrance 2007; docs/checks.md",
    plan,
    NULL,
};
