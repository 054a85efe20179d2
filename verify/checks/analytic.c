/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * analytic: reflected direct light, pixel by pixel, against closed forms: Lo = rho E / pi with E from verify/analytic, which reads the
 * description and has never seen a ray. Occluders are handled there exactly, by clipping, or by quadrature.
 */
#include <string.h>

#include "verify/analytic/analytic.h"
#include "verify/checks/checks.h"
#include "verify/checks/family.h"

/* Light that arrives directly at the hit and leaves towards the viewer. */
static lc_status direct_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                             lc_error *err)
{
    (void)user;
    *kind = -1;
    if (value)
        *value = lc_black();
    if (!hit->valid)
        return LC_OK;
    lc_material material = lc_material_at(scene, hit);
    *kind = 8 * hit->part + (lc_dot(hit->n, hit->wo) > 0); /* a part: light jumps at the edges of a cube, too */
    /* A checkerboard's cell, told by its colour. */
    const lc_texture *front = &lc_scene_description(scene)
                                   ->materials[lc_scene_description(scene)->shapes[hit->shape].material]
                                   .side[0]
                                   .diffuse;
    if (front->is_checkerboard && material.diffuse.r == front->color[0].r && material.diffuse.g == front->color[0].g)
        *kind += 2;
    if (!value || lc_rgb_max(material.diffuse) == 0)
        return LC_OK;
    lc_rgb irradiance;
    lc_status status =
        lc_direct_irradiance(&irradiance, lc_scene_description(scene), hit->p, lc_facing(hit->n, hit->wo), err);
    if (status == LC_OK)
        *value = lc_rgb_scale(LC_INV_PI, lc_rgb_mul(material.diffuse, irradiance));
    return status;
}

lc_status lc_expect_direct(lc_expected *out, const lc_claim *claim, const lc_scene *scene, int threads,
                               lc_error *err)
{
    return lc_expect_view(out, direct_view, NULL, scene, claim->tolerance, threads, err);
}

/* Light that arrives by way of one other surface. */
static lc_status second_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                             lc_error *err)
{
    (void)err;
    *kind = hit->valid ? 2 * hit->part + (lc_dot(hit->n, hit->wo) > 0) : -1;
    if (value && hit->valid)
        *value = lc_rgb_scale(LC_INV_PI, lc_rgb_mul(lc_material_at(scene, hit).diffuse,
                                                    lc_second_irradiance(user, hit->shape, hit->p, hit->n)));
    else if (value)
        *value = lc_black();
    return LC_OK;
}

static lc_status expect_second(lc_expected *out, const lc_claim *claim, const lc_scene *scene, int threads,
                               lc_error *err)
{
    lc_second second;
    lc_status status = lc_second_prepare(&second, lc_scene_description(scene), err);
    if (status != LC_OK)
        return status;
    status = lc_expect_view(out, second_view, &second, scene, claim->tolerance, threads, err);
    lc_second_release(&second);
    return status;
}

/* Beside a wall at x = 0 of height 1 and any length, under the sky. */
static lc_status wall_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                           lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    (void)user;
    if (!hit->valid || hit->shape != 0)
        return lc_fail(err, LC_FAULT, "%s: a camera ray misses the floor", desc->name);
    *kind = 0;
    if (value) {
        double free = 1 - lc_wall_factor(atan2(1, hit->p.x));
        *value = lc_rgb_scale(free, lc_rgb_mul(lc_material_at(scene, hit).diffuse, desc->sky));
    }
    return LC_OK;
}

static lc_status expect_wall(lc_expected *out, const lc_claim *claim, const lc_scene *scene, int threads, lc_error *err)
{
    return lc_expect_view(out, wall_view, NULL, scene, claim->tolerance, threads, err);
}

/* The arrays are zero already. */
static lc_status expect_black(lc_expected *out, const lc_claim *claim, const lc_scene *scene, int threads,
                              lc_error *err)
{
    (void)out;
    (void)claim;
    (void)scene;
    (void)threads;
    (void)err;
    return LC_OK;
}

/* Scenes with a closed form. tolerance: of a pixel's mean, where a kink (a horizon, a penumbra's edge) runs through it. */
static const struct {
    const char *scene;
    lc_expect_fn *expect;
    double tolerance;
    const char *source;
} rows[] = {
    {"plane_point", lc_expect_direct, 1e-5, "E = I cos / d^2"},
    {"plane_directional", lc_expect_direct, 1e-5, "E = E0 cos, Lo = rho E / pi"},
    {"plane_rectangle", lc_expect_direct, 1e-5, "Lambert's polygon formula"},
    {"plane_tilted", lc_expect_direct, 1e-5, "Lambert's polygon formula, clipped to the horizon"},
    {"plane_disk", lc_expect_direct, 1e-5, "disk to a point, quadrature to 1e-9 (Howell B-13 when parallel)"},
    {"plane_sphere", lc_expect_direct, 1e-5, "sphere to a point, Howell B-43"},
    {"plane_cube", lc_expect_direct, 1e-5, "Lambert's polygon formula for six faces"},
    {"lamp_100w", lc_expect_direct, 1e-5, "L = Phi / (pi A), then Lambert's polygon formula"},
    {"two_lights", lc_expect_direct, 1e-5, "Lambert's polygon formula, two lamps"},
    {"five_lights", lc_expect_direct, 1e-5, "closed forms of five lamps, added"},
    {"occluder", lc_expect_direct, 1e-5, "quadrature over the visible part of the lamps"},
    {"cornell", lc_expect_direct, 1e-5,
     "Lambert's polygon formula over the visible part of the lamp, clipped by the boxes"},
    {"mixed_lights", lc_expect_direct, 1e-5, "area, point and directional light, added"},
    {"textured_lamp", lc_expect_direct, 1e-5, "Lambert's polygon formula for each cell of the checkerboard"},
    {"flipped_twosided", lc_expect_direct, 1e-5, "Lambert's polygon formula"},
    {"sky", lc_expect_direct, 1e-5, "Lo = rho L under a constant sky"},
    {"two_patches", lc_expect_direct, 1e-5, "Lambert's polygon formula"},
    {"random_rectangle", lc_expect_direct, 1e-5, "Lambert's polygon formula, a lamp that was drawn"},
    {"random_disk", lc_expect_direct, 1e-5, "ellipse to a point, quadrature to 1e-9, a lamp that was drawn"},
    {"random_sphere", lc_expect_direct, 1e-5, "sphere to a point, Howell B-43, a lamp that was drawn"},
    {"random_lights", lc_expect_direct, 1e-5, "closed forms of three lamps that were drawn, added"},
    {"random_occluder", lc_expect_direct, 1e-6, "quadrature over the visible part of a lamp, both drawn"},
    {"two_surfaces", expect_second, 1e-5, "via two surfaces: quadrature over the wall, polygon formula at each node"},
    {"sky_wall", expect_wall, 1e-5, "E = pi L (1 + cos b) / 2 beside an infinite wall of elevation b"},
    {"light_behind", expect_black, 0, "a lamp seen from its back gives nothing"},
    {"light_below", expect_black, 0, "a lamp below the horizon gives nothing"},
    {"no_lights", expect_black, 0, "no light, no light"},
};

static lc_status plan(const lc_check *self, lc_claims *claims, const lc_scene *scene, const lc_estimator *estimator,
                      lc_error *err)
{
    const char *name = lc_scene_description(scene)->name;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        if (strcmp(rows[i].scene, name) != 0 || !lc_sees_everything(scene, estimator) || estimator->max_bounces < 1)
            continue;
        /* At one bounce a path tracer is its own direct estimator: one scene tells as much. */
        int is_drawn = lc_family_find(name) != NULL, is_deep = estimator->max_bounces > 1;
        int is_second = rows[i].expect == expect_second;
        if ((is_drawn && is_deep) || (is_second && !is_deep))
            continue;
        /* Among diffuse surfaces mirror and dielectric are path once more. Another renderer, of which there are images only, has nothing
         * beside it. */
        int is_specular = (estimator->lobes & (LC_MIRROR | LC_GLASS)) != 0, is_black = rows[i].expect == expect_black;
        if (is_deep && is_specular && estimator->radiance && !is_black && !is_second && strcmp(name, "sky") != 0 &&
            strcmp(name, "mixed_lights") != 0 && strcmp(name, "plane_rectangle") != 0)
            continue;
        lc_claim *claim = lc_claims_add(claims, self, scene, estimator);
        if (!claim)
            return lc_fail(err, LC_FAULT, "out of memory for the claims");
        claim->expect = rows[i].expect;
        claim->tolerance = rows[i].tolerance;
        claim->exact = is_black;
        claim->source = rows[i].source;
        /* At one bounce a path tracer is its own direct estimator: one scene tells as much, or one more where there are lights that
         * only a light sample finds. */
        claim->full_only = is_deep && !claim->exact && strcmp(name, "sky") != 0 && strcmp(name, "mixed_lights") != 0;
        if (strcmp(name, "random_occluder") == 0) /* seconds of quadrature, by the seed */
            claim->full_only = 1;
        if (is_second) {
            claim->min_bounces = claim->max_bounces = 2;
            claim->full_only = is_specular;
        }
        claim->slack = is_drawn || is_second ? 2 : 1; /* the fixed scenes have narrower margins */
        /* Nothing varies: one direction, or a constant sky by cosine weights. */
        claim->may_be_still = lc_scene_emitters(scene) == LC_DIRECTIONAL || strcmp(name, "sky") == 0;
    }
    return LC_OK;
}

const lc_check lc_check_analytic = {
    "analytic",
    "direct light against closed forms, pixel by pixel",
    "Lambert 1760; Howell, A Catalog of Radiation Heat Transfer Configuration Factors; docs/checks.md",
    plan,
    NULL,
};
