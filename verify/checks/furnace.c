/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * furnace: the inside of a Lambertian sphere, whose irradiance is the same everywhere for any emission and albedo: after one reflection
 * L_1(x) = rho(x) <Le>, <Le> the area mean of the emission. Not uniform, so it sees what uniform furnaces are blind to.
 */
#include <string.h>

#include "verify/analytic/analytic.h"
#include "verify/checks/checks.h"

typedef struct furnace_view {
    lc_rgb irradiance;
} furnace_view;

static lc_status inside_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                             lc_error *err)
{
    const furnace_view *furnace = user;
    if (!hit->valid)
        return lc_fail(err, LC_FAULT, "%s: a camera ray left the closed sphere", lc_scene_description(scene)->name);
    lc_rgb rho = lc_material_at(scene, hit).diffuse;
    if (value)
        *value = lc_rgb_scale(LC_INV_PI, lc_rgb_mul(rho, furnace->irradiance));
    *kind = (int)(1e6 * (rho.r + 2 * rho.g + 4 * rho.b)); /* the cell of the checkerboard */
    return LC_OK;
}

static lc_status expect_inside(lc_expected *out, const lc_claim *claim, const lc_scene *scene, int threads,
                               lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    if (desc->shape_count != 1 || desc->shapes[0].kind != LC_SPHERE || !desc->shapes[0].emits)
        return lc_fail(err, LC_BAD_INPUT, "%s: a furnace of this kind is one emitting sphere", desc->name);
    lc_rgb le = lc_texture_sphere_mean(&desc->shapes[0].radiance);
    furnace_view furnace = {lc_color(lc_inside_sphere_irradiance(le.r, 0, 1), lc_inside_sphere_irradiance(le.g, 0, 1),
                                     lc_inside_sphere_irradiance(le.b, 0, 1))};
    return lc_expect_view(out, inside_view, &furnace, scene, claim->tolerance, threads, err);
}

static lc_status plan(const lc_check *self, lc_claims *claims, const lc_scene *scene, const lc_estimator *estimator,
                      lc_error *err)
{
    static const char *const scenes[] = {"furnace_sphere", "furnace_checker"};
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; ++i) {
        if (strcmp(scenes[i], lc_scene_description(scene)->name) != 0 || !lc_sees_everything(scene, estimator) ||
            estimator->max_bounces < 1)
            continue;
        lc_claim *claim = lc_claims_add(claims, self, scene, estimator);
        if (!claim)
            return lc_fail(err, LC_FAULT, "out of memory for the claims");
        claim->expect = expect_inside;
        claim->tolerance = 1e-9;
        claim->may_be_still =
            !lc_scene_description(scene)->shapes[0].radiance.is_checkerboard; /* the kernel is constant */
        claim->source = "inside of a sphere: E = pi <Le>, L_1 = rho(x) <Le>";
    }
    return LC_OK;
}

const lc_check lc_check_furnace = {
    "furnace",
    "one reflection inside a Lambertian sphere of any emission and albedo",
    "Jacquez and Kuppenheim, Theory of the integrating sphere, JOSA 45, 1955",
    plan,
    NULL,
};
