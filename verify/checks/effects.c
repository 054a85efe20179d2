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

/* ---- depth of field ---------------------------------------------------------------------------------------------- */

/* Corners of a rectangle in the camera's coordinates, at one depth. */
static lc_status rectangle_across(double corners[4][2], double *depth, const lc_scene_desc *desc, int shape,
                                  lc_error *err)
{
    const lc_affine *map = &desc->shapes[shape].to_world, *camera = &desc->camera.to_world;
    for (int i = 0; i < 4; ++i) {
        lc_vec3 a = lc_scale(i == 1 || i == 2 ? 1 : -1, column(map, 0)), b = lc_scale(i >= 2 ? 1 : -1, column(map, 1));
        lc_vec3 p = lc_sub(lc_add(column(map, 3), lc_add(a, b)), column(camera, 3));
        double z = lc_dot(p, column(camera, 2));
        corners[i][0] = lc_dot(p, column(camera, 0));
        corners[i][1] = lc_dot(p, column(camera, 1));
        if (desc->shapes[shape].kind != LC_RECTANGLE || (i && fabs(z - *depth) > 1e-9 * z))
            return lc_fail(err, LC_BAD_INPUT, "%s:%d: expected rectangles across the camera's axis", desc->name,
                           desc->shapes[shape].line);
        *depth = z;
    }
    return LC_OK;
}

/* What leaves a diffuse rectangle of constant irradiance. */
static lc_status flat_radiance(lc_rgb *out, const lc_scene_desc *desc, int shape, lc_error *err)
{
    const lc_affine *map = &desc->shapes[shape].to_world;
    lc_vec3 n = lc_normalize(lc_cross(column(map, 0), column(map, 1)));
    lc_status status = lc_direct_irradiance(out, desc, column(map, 3), n, err);
    *out = lc_rgb_scale(LC_INV_PI,
                        lc_rgb_mul(*out, desc->materials[desc->shapes[shape].material].side[0].diffuse.color[0]));
    return status;
}

/* The point of the image, one metre along the axis, that the ray through the lens's centre passes. */
static void image_point(double *x, double *y, const lc_scene_desc *desc, const lc_hit *hit)
{
    const lc_affine *camera = &desc->camera.to_world;
    double z = lc_dot(hit->wo, column(camera, 2));
    *x = lc_dot(hit->wo, column(camera, 0)) / z;
    *y = lc_dot(hit->wo, column(camera, 1)) / z;
}

/* Where the ray through the lens's centre ends does not matter, only its direction does. */
static lc_status lens_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                           lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    const lc_rgb *radiance = user;
    double x, y;
    int seen = 0;
    *kind = 0;
    if (!value)
        return LC_OK;
    *value = lc_black();
    image_point(&x, &y, desc, hit);
    for (int i = 0; i < desc->shape_count; ++i) {
        double corners[4][2], z = 0;
        lc_status status = rectangle_across(corners, &z, desc, i, err);
        if (status != LC_OK)
            return status;
        double radius = desc->camera.aperture_radius * fabs(1 - z / desc->camera.focus_distance);
        double share = lc_disk_polygon_share((const double(*)[2])corners, 4, x * z, y * z, radius);
        *value = lc_rgb_add(*value, lc_rgb_scale(share, radiance[i]));
        seen += share > 1e-12; /* a sum of angles */
    }
    if (seen > 1) /* one would hide a part of the other */
        return lc_fail(err, LC_BAD_INPUT, "%s: the images of two rectangles overlap", desc->name);
    return LC_OK;
}

enum { MOST_FLAT = 8 };

static lc_status expect_lens(lc_expected *out, const lc_claim *claim, const lc_scene *scene, int threads, lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    lc_rgb radiance[MOST_FLAT];
    for (int i = 0; i < desc->shape_count && i < MOST_FLAT; ++i) {
        lc_status status = flat_radiance(&radiance[i], desc, i, err);
        if (status != LC_OK)
            return status;
    }
    return lc_expect_view(out, lens_view, radiance, scene, claim->tolerance, threads, err);
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
    {"lens_edge", expect_lens, "light_direct", "the share that a rectangle has of a disk of radius a |1 - z / f|"},
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
