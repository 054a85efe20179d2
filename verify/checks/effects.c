/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * effects: what the lecture wants Monte Carlo for beside soft shadows (those are `analytic`): glossy reflection, depth of field and motion
 * blur. Pixel by pixel against closed forms and quadrature from verify/analytic, which reads the description and has never seen a ray.
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
        *value = lc_rgb_scale(albedo, lc_rgb_mul(side->glossy, lc_scene_description(scene)->sky));
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

/* ---- motion blur -------------------------------------------------------------------------------------------------- */

/* Times at which the line is met by the shape. */
static lc_span span_of(const lc_shape_desc *shape, lc_vec3 p, lc_vec3 d)
{
    const lc_affine *map = &shape->to_world;
    lc_vec3 a = column(map, 0), b = column(map, 1), centre = column(map, 3);
    if (shape->kind == LC_SPHERE)
        return lc_sphere_span(centre, lc_length(a), shape->motion, p, d);
    return shape->kind == LC_DISK ? lc_disk_span(centre, a, b, shape->motion, p, d)
                                  : lc_rectangle_span(centre, a, b, shape->motion, p, d);
}

/* Flat shapes of constant radiance fly past the camera, none before another. */
static lc_status flight_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                             lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    const lc_rgb *radiance = user;
    lc_span spans[MOST_FLAT];
    double sum = 0;
    *kind = 0;
    if (!value)
        return LC_OK;
    *value = lc_black();
    for (int i = 0; i < desc->shape_count; ++i) {
        spans[i] = span_of(&desc->shapes[i], column(&desc->camera.to_world, 3), hit->wo);
        double length = lc_spans_length(&spans[i], 1);
        *value = lc_rgb_add(*value, lc_rgb_scale(length, radiance[i]));
        sum += length;
    }
    if (fabs(sum - lc_spans_length(spans, desc->shape_count)) > 1e-12)
        return lc_fail(err, LC_BAD_INPUT, "%s: one shape flies before another", desc->name);
    return LC_OK;
}

static lc_status expect_flight(lc_expected *out, const lc_claim *claim, const lc_scene *scene, int threads,
                               lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    lc_rgb radiance[MOST_FLAT];
    for (int i = 0; i < desc->shape_count && i < MOST_FLAT; ++i) {
        const lc_shape_desc *shape = &desc->shapes[i];
        lc_vec3 n = lc_normalize(lc_cross(column(&shape->to_world, 0), column(&shape->to_world, 1)));
        const lc_directional_desc *sun = &desc->directionals[0];
        double cosine = fmax(0, -lc_dot(n, sun->direction));
        lc_rgb albedo = desc->materials[shape->material].side[0].diffuse.color[0];
        radiance[i] = lc_rgb_scale(LC_INV_PI * cosine, lc_rgb_mul(sun->irradiance, albedo));
    }
    return lc_expect_view(out, flight_view, radiance, scene, claim->tolerance, threads, err);
}

/* A floor at rest in parallel light, before which shapes pass that the camera does not see. */
static lc_status passing_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                              lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    const lc_directional_desc *sun = &desc->directionals[0];
    lc_span spans[MOST_FLAT];
    int count = 0;
    (void)user;
    *kind = 0;
    if (!value)
        return LC_OK;
    if (!hit->valid || hit->shape != 0)
        return lc_fail(err, LC_BAD_INPUT, "%s: the camera sees something else than the floor", desc->name);
    for (int i = 1; i < desc->shape_count && i < MOST_FLAT; ++i)
        spans[count++] = span_of(&desc->shapes[i], hit->p, lc_neg(sun->direction));
    double lit = 1 - lc_spans_length(spans, count), cosine = -lc_dot(hit->n, sun->direction);
    *value = lc_rgb_scale(LC_INV_PI * lit * cosine, lc_rgb_mul(sun->irradiance, front_of(scene, hit)->diffuse.color[0]));
    return LC_OK;
}

static lc_status expect_passing(lc_expected *out, const lc_claim *claim, const lc_scene *scene, int threads,
                                lc_error *err)
{
    return lc_expect_view(out, passing_view, NULL, scene, claim->tolerance, threads, err);
}

static lc_status moving_lamp_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                                  lc_error *err)
{
    lc_rgb irradiance;
    (void)user;
    *kind = hit->valid ? hit->shape : -1;
    if (!value)
        return LC_OK;
    *value = lc_black();
    if (!hit->valid)
        return LC_OK;
    lc_status status = lc_moving_irradiance(&irradiance, lc_scene_description(scene), hit->p, hit->n, err);
    *value = lc_rgb_scale(LC_INV_PI, lc_rgb_mul(irradiance, front_of(scene, hit)->diffuse.color[0]));
    return status;
}

static lc_status expect_moving_lamp(lc_expected *out, const lc_claim *claim, const lc_scene *scene, int threads,
                                    lc_error *err)
{
    return lc_expect_view(out, moving_lamp_view, NULL, scene, claim->tolerance, threads, err);
}

/* ---- rows -------------------------------------------------------------------------------------------------------- */

/* In the quick suite the estimators named, and any under test; all that see the whole scene in the full one. */
static const struct {
    const char *scene;
    lc_expect_fn *expect;
    const char *quick, *source;
    int deep; /* path tracers, too, those that follow every lobe: elsewhere one bounce of theirs is hemisphere_direct's */
    const char *never; /* too noisy here to show anything */
} rows[] = {
    {"glossy_sky", expect_plates, "glossy_direct", "r a(cos) L, a the directional albedo by quadrature", 1, ""},
    {"glossy_lamp", expect_highlight, "light_direct glossy_direct", "quadrature of f cos cos' / d^2 over the lamp", 1,
     "hemisphere_direct dielectric"},
    {"lens_edge", expect_lens, "light_direct", "the share that a rectangle has of a disk of radius a |1 - z / f|", 0, ""},
    {"motion_flight", expect_flight, "light_direct", "the share of time in which a line meets a flat shape", 0, ""},
    {"motion_shadow", expect_passing, "light_direct", "E0 cos times the share of time without shadow", 0, ""},
    {"motion_lamp", expect_moving_lamp, "light_direct hemisphere_direct light_solid_angle",
     "Lambert's polygon formula, mean over time by quadrature", 0, ""},
};

/* Whether the name is one of the words. */
static int is_named(const lc_estimator *estimator, const char *words)
{
    size_t length = strlen(estimator->name);
    for (const char *at = words; (at = strstr(at, estimator->name)) != NULL; ++at)
        if ((at == words || at[-1] == ' ') && (at[length] == ' ' || at[length] == 0))
            return 1;
    return 0;
}

/* 1: in the quick suite, 0: in the full one, -1: in none. One under test is in both. */
static int place_of(size_t row, const lc_estimator *estimator)
{
    const lc_estimator *const *e = lc_estimators;
    while (*e && *e != estimator)
        ++e;
    if (!*e || is_named(estimator, rows[row].quick))
        return 1;
    int is_deep = estimator->max_bounces > 1, follows_all = rows[row].deep && estimator->lobes & LC_GLASS;
    return (is_deep && !follows_all) || is_named(estimator, rows[row].never) ? -1 : 0;
}

static lc_status plan(const lc_check *self, lc_claims *claims, const lc_scene *scene, const lc_estimator *estimator,
                      lc_error *err)
{
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        if (strcmp(rows[i].scene, lc_scene_description(scene)->name) != 0 || !lc_sees_everything(scene, estimator) ||
            estimator->max_bounces < 1 || place_of(i, estimator) < 0)
            continue;
        lc_claim *claim = lc_claims_add(claims, self, scene, estimator);
        if (!claim)
            return lc_fail(err, LC_FAULT, "out of memory for the claims");
        claim->expect = rows[i].expect;
        claim->tolerance = 1e-5;
        claim->full_only = place_of(i, estimator) == 0;
        claim->source = rows[i].source;
    }
    return LC_OK;
}

const lc_check lc_check_effects = {
    "effects",
    "glossy reflection, depth of field and motion blur against closed forms and quadrature",
    "Path Tracing (Bikker 2021-22); Walter, Marschner, Li, Torrance 2007; docs/checks.md",
    plan,
    NULL,
};
