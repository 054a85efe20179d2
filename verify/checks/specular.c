/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * specular: chains of mirrors and glass whose radiance has a closed form, pixel by pixel. What the camera sees first decides all: a
 * scene is built such that every path from there is known.
 */
#include <string.h>

#include "verify/analytic/analytic.h"
#include "verify/checks/checks.h"
#include "verify/checks/family.h"

static lc_rgb gray(double x) { return lc_color(x, x, x); }

/* The emission of the scene's only lamp. */
static lc_rgb lamp(const lc_scene *scene)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    for (int i = 0; i < desc->shape_count; ++i)
        if (desc->shapes[i].emits)
            return desc->shapes[i].radiance.color[0];
    return lc_black();
}

static double fresnel_at(const lc_hit *hit, double ior) { return lc_fresnel_dielectric(lc_dot(hit->n, hit->wo), ior); }

/* A rectangle's place and unit normal, whatever its side. */
static void plane_of(lc_vec3 *centre, lc_vec3 *normal, const lc_shape_desc *shape)
{
    const lc_affine *a = &shape->to_world;
    *centre = lc_vec(a->m[0][3], a->m[1][3], a->m[2][3]);
    *normal = lc_normalize(lc_cross(lc_vec(a->m[0][0], a->m[1][0], a->m[2][0]), lc_vec(a->m[0][1], a->m[1][1], a->m[2][1])));
}

/* Two facing mirrors, shapes 0 (seen first) and 1, and across them a lamp, shape 2. Unfolded, the path is a straight line that crosses
 * planes as far apart as the mirrors. */
static lc_status corridor_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                               lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    lc_vec3 first, across, second, lamp_at, down, unused;
    (void)user;
    if (!hit->valid || hit->shape != 0)
        return lc_fail(err, LC_FAULT, "%s: a camera ray misses the first mirror", desc->name);
    plane_of(&first, &across, &desc->shapes[0]);
    plane_of(&second, &unused, &desc->shapes[1]);
    plane_of(&lamp_at, &down, &desc->shapes[2]);
    double width = fabs(lc_dot(lc_sub(second, first), across));
    double fall = lc_dot(lc_sub(hit->p, lamp_at), down) / lc_dot(hit->wo, down); /* length of the path from the first mirror to the lamp */
    int k = 1 + (int)floor(fall * fabs(lc_dot(hit->wo, across)) / width);
    *kind = k;
    if (value) {
        lc_rgb le = lamp(scene), r1 = desc->materials[desc->shapes[0].material].side[0].mirror;
        lc_rgb r2 = desc->materials[desc->shapes[1].material].side[0].mirror;
        *value =
            lc_color(lc_mirror_corridor_radiance(le.r, r1.r, r2.r, k), lc_mirror_corridor_radiance(le.g, r1.g, r2.g, k),
                     lc_mirror_corridor_radiance(le.b, r1.b, r2.b, k));
    }
    return LC_OK;
}

enum { SLAB_BOUNCES = 8, BALL_BOUNCES = 2 };

static lc_status slab_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                           lc_error *err)
{
    (void)user;
    if (!hit->valid || hit->shape != 0)
        return lc_fail(err, LC_FAULT, "%s: a camera ray misses the slab", lc_scene_description(scene)->name);
    *kind = 0;
    double ior = lc_scene_description(scene)->materials[lc_scene_description(scene)->shapes[0].material].int_ior;
    if (value)
        *value = lc_rgb_scale(lc_slab_transmittance(fresnel_at(hit, ior), SLAB_BOUNCES - 2), lamp(scene));
    return LC_OK;
}

static lc_status ball_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                           lc_error *err)
{
    (void)scene;
    (void)user;
    (void)err;
    *kind = hit->valid;
    if (value) {
        double f = hit->valid ? fresnel_at(hit, 1.5) : 0;
        *value = gray(hit->valid ? f + (1 - f) * (1 - pow(f, BALL_BOUNCES - 1)) : 0);
    }
    return LC_OK;
}

/* From below: the normal is on the other side. */
static lc_status water_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                            lc_error *err)
{
    (void)user;
    if (!hit->valid)
        return lc_fail(err, LC_FAULT, "%s: a camera ray misses the water", lc_scene_description(scene)->name);
    double f = lc_fresnel_dielectric(-lc_dot(hit->n, hit->wo), 1 / 1.33);
    *kind = f < 1;
    if (value)
        *value = lc_rgb_scale(f + (1 - f) * 1.33 * 1.33, lc_scene_description(scene)->sky);
    return LC_OK;
}

/* Glass and mirror in one surface, seen from its front, which is in the water; a reflection of either kind shows the floor. */
static lc_status blend_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                            lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    (void)user;
    if (!hit->valid || hit->shape != 0)
        return lc_fail(err, LC_FAULT, "%s: a camera ray misses the water", desc->name);
    double f = fresnel_at(hit, 1 / 1.33);
    *kind = f < 1;
    if (value) {
        const lc_side *side = &desc->materials[desc->shapes[0].material].side[0];
        lc_rgb reflected = lc_rgb_mul(lc_rgb_add(gray(side->glass * f), side->mirror), lamp(scene));
        *value = lc_rgb_add(reflected, lc_rgb_scale(side->glass * (1 - f) * 1.33 * 1.33, desc->sky));
    }
    return LC_OK;
}

static lc_status plates_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                             lc_error *err)
{
    (void)user;
    (void)err;
    *kind = hit->valid ? hit->shape : -1;
    if (value) {
        lc_material material = lc_material_at(scene, hit);
        *value = lc_rgb_mul(lc_rgb_add(material.mirror, material.diffuse), lc_scene_description(scene)->sky);
    }
    return LC_OK;
}

static const struct row {
    const char *scene;
    lc_view_fn *view;
    int bounces;
    const char *source;
} rows[] = {
    {"mirror_corridor", corridor_view, 12, "L = r1^ceil(k/2) r2^floor(k/2) Le after k mirrors"},
    {"random_corridor", corridor_view, 12, "L = r1^ceil(k/2) r2^floor(k/2) Le after k mirrors that were drawn"},
    {"random_slab", slab_view, SLAB_BOUNCES, "T = (1-R)^2 sum of R^2j, an index that was drawn"},
    {"glass_slab", slab_view, SLAB_BOUNCES, "T = (1-R)^2 sum of R^2j, R by Fresnel at each face"},
    {"glass_sphere", ball_view, BALL_BOUNCES, "L = F + (1-F)(1 - F^(B-1)) through a ball in a white sky"},
    {"critical_angle", water_view, 1, "F L + (1-F) n^2 L, total reflection beyond the critical angle"},
    {"glass_blend", blend_view, 1, "g (F Lf + (1-F) n^2 Ls) + r Lf: glass and mirror in one surface"},
    {"mirror_sky", plates_view, 1, "a convex reflector in a sky L returns its reflectance times L"},
};
enum { ROWS = sizeof rows / sizeof rows[0] };

static const struct row *row_of(const lc_scene *scene)
{
    for (int i = 0; i < ROWS; ++i)
        if (strcmp(rows[i].scene, lc_scene_description(scene)->name) == 0)
            return &rows[i];
    return NULL;
}

static lc_status expect_chain(lc_expected *out, const lc_claim *claim, const lc_scene *scene, int threads,
                              lc_error *err)
{
    return lc_expect_view(out, row_of(scene)->view, NULL, scene, claim->tolerance, threads, err);
}

static lc_status plan(const lc_check *self, lc_claims *claims, const lc_scene *scene, const lc_estimator *estimator,
                      lc_error *err)
{
    const struct row *row = row_of(scene);
    if (!row || !lc_sees_everything(scene, estimator) || estimator->max_bounces < row->bounces)
        return LC_OK;
    lc_claim *claim = lc_claims_add(claims, self, scene, estimator);
    if (!claim)
        return lc_fail(err, LC_FAULT, "out of memory for the claims");
    claim->max_bounces = row->bounces;
    claim->expect = expect_chain;
    claim->tolerance = 1e-6;
    claim->may_be_still = row->view == corridor_view;
    claim->slack = lc_family_find(row->scene) ? 2 : 1; /* the fixed scenes have narrower margins */
    claim->source = row->source;
    return LC_OK;
}

const lc_check lc_check_specular = {
    "specular",
    "chains of mirrors and glass against closed forms, pixel by pixel",
    "Fresnel 1823; Stokes, Proc. R. Soc. 11, 1862; Veach 1997, section 5.2; docs/checks.md",
    plan,
    NULL,
};
