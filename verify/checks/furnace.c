/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * furnace: closed rooms whose light is known for any number of reflections.
 *
 * The inside of a Lambertian sphere: irradiance is the same everywhere for any emission and albedo, so after up to K reflections
 * sum of L_k (1 <= k <= K) = rho(x) <Le> (1 + <rho> + ... + <rho>^(K-1)). Not uniform, so it sees what uniform furnaces are blind to.
 * The thermal furnace: every surface emits L0 (1 - rho), so L = L0 for any geometry and material. It proves energy only.
 */
#include <string.h>

#include "verify/analytic/analytic.h"
#include "verify/checks/checks.h"
#include "verify/checks/family.h"

static lc_status inside_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                             lc_error *err)
{
    const lc_rgb *irradiance = user;
    if (!hit->valid)
        return lc_fail(err, LC_FAULT, "%s: a camera ray left the closed sphere", lc_scene_description(scene)->name);
    lc_rgb rho = lc_material_at(scene, hit).diffuse;
    if (value)
        *value = lc_rgb_scale(LC_INV_PI, lc_rgb_mul(rho, *irradiance));
    *kind = (int)(1e6 * (rho.r + 2 * rho.g + 4 * rho.b)); /* the cell of the checkerboard */
    return LC_OK;
}

lc_status lc_expect_inside(lc_expected *out, const lc_claim *claim, const lc_scene *scene, int threads,
                               lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    if (desc->shape_count != 1 || desc->shapes[0].kind != LC_SPHERE || !desc->shapes[0].emits)
        return lc_fail(err, LC_BAD_INPUT, "%s: a furnace of this kind is one emitting sphere", desc->name);
    const lc_side *inner = &desc->materials[desc->shapes[0].material].side[desc->shapes[0].flip_normals ? 0 : 1];
    lc_rgb le = lc_texture_sphere_mean(&desc->shapes[0].radiance), rho = lc_texture_sphere_mean(&inner->diffuse);
    lc_rgb irradiance = lc_color(lc_inside_sphere_irradiance(le.r, rho.r, claim->max_bounces),
                                 lc_inside_sphere_irradiance(le.g, rho.g, claim->max_bounces),
                                 lc_inside_sphere_irradiance(le.b, rho.b, claim->max_bounces));
    return lc_expect_view(out, inside_view, &irradiance, scene, claim->tolerance, threads, err);
}

/* L0 = 1; the reflected part is what the surface does not emit itself. */
static lc_status thermal_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                              lc_error *err)
{
    (void)user;
    if (!hit->valid)
        return lc_fail(err, LC_FAULT, "%s: a camera ray left the closed room", lc_scene_description(scene)->name);
    *kind = hit->shape;
    lc_rgb le = lc_emission(scene, hit);
    if (value)
        *value = lc_color(1 - le.r, 1 - le.g, 1 - le.b);
    return LC_OK;
}

static lc_status expect_thermal(lc_expected *out, const lc_claim *claim, const lc_scene *scene, int threads,
                                lc_error *err)
{
    return lc_expect_view(out, thermal_view, NULL, scene, claim->tolerance, threads, err);
}

static lc_status add(lc_claim **out, lc_claims *claims, const lc_check *self, const lc_scene *scene,
                     const lc_estimator *estimator, int bounces, lc_error *err)
{
    *out = lc_claims_add(claims, self, scene, estimator);
    if (!*out)
        return lc_fail(err, LC_FAULT, "out of memory for the claims");
    (*out)->max_bounces = bounces;
    return LC_OK;
}

static lc_status plan_inside(const lc_check *self, lc_claims *claims, const lc_scene *scene,
                             const lc_estimator *estimator, lc_error *err)
{
    int varies = lc_scene_description(scene)->shapes[0].radiance.is_checkerboard;
    int is_drawn = lc_family_find(lc_scene_description(scene)->name) != NULL;
    for (int k = 1; k <= 8 && k <= estimator->max_bounces; ++k) {
        lc_claim *claim;
        if (is_drawn && k != (estimator->max_bounces > 1 ? 3 : 1) && (k != 6 || estimator->lobes != LC_DIFFUSE))
            continue;
        lc_status status = add(&claim, claims, self, scene, estimator, k, err);
        if (status != LC_OK)
            return status;
        claim->expect = lc_expect_inside;
        claim->tolerance = 1e-9;
        claim->may_be_still = !varies && k == 1; /* the kernel is constant */
        /* Checkerboards are looked up at every bounce: only path tracers of one lobe pay for that in the quick suite. */
        int is_plain = estimator->lobes == LC_DIFFUSE;
        claim->full_only = estimator->max_bounces > 1 && !(is_drawn ? is_plain && k == 3
                                                              : varies   ? is_plain && (k == 4 || k == 8)
                                                                         : k == 2 || k == 5);
        claim->slack = is_drawn ? 2 : 1;
        claim->source = "inside of a sphere: rho(x) <Le> (1 + <rho> + ... + <rho>^(K-1))";
    }
    return LC_OK;
}

static lc_status plan(const lc_check *self, lc_claims *claims, const lc_scene *scene, const lc_estimator *estimator,
                      lc_error *err)
{
    const char *name = lc_scene_description(scene)->name;
    if (!lc_sees_everything(scene, estimator) || estimator->max_bounces < 1)
        return LC_OK;
    if (strcmp(name, "furnace_sphere") == 0 || strcmp(name, "furnace_checker") == 0 ||
        strcmp(name, "random_furnace") == 0)
        return plan_inside(self, claims, scene, estimator, err);
    if (strcmp(name, "thermal_furnace") != 0 || estimator->max_bounces < 24)
        return LC_OK;
    lc_claim *claim;
    lc_status status = add(&claim, claims, self, scene, estimator, 24, err);
    if (status != LC_OK)
        return status;
    claim->expect = expect_thermal;
    claim->tolerance = 1e-5; /* L0 (1 - rho_max^25) <= L <= L0, and a few more bounces spent inside the glass */
    claim->source = "thermal furnace: L = L0 on every surface (second law)";
    return LC_OK;
}

const lc_check lc_check_furnace = {
    "furnace",
    "closed rooms: inside of a sphere of any emission and albedo, thermal furnace",
    "Jacquez and Kuppenheim, Theory of the integrating sphere, JOSA 45, 1955; Kirchhoff 1860",
    plan,
    NULL,
};
