/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * energy: the host's materials. A BSDF is nowhere negative, reciprocal, and sends back exactly the light that it
 * should: a loss is found as well as a gain. Its density integrates to 1 and is the one that its samples follow. Every
 * estimator stands on these, so that without this check an error here would look like an error of all.
 */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "verify/checks/energy_c.h"

const lc_bsdf_functions lc_bsdf_host = {lc_bsdf_eval, lc_bsdf_pdf, lc_bsdf_sample};

/* ---- materials -------------------------------------------------------------------------------------------------- */

/* Albedo [side][cell], of which a plain side has the first only; reflectance [side]; glass has no sides. An index that
 * is not given is 1. A rough lobe of one roughness has both sides, or the front. */
typedef struct material {
    const char *name;
    int is_checkered[2];
    lc_rgb diffuse[2][2], mirror[2];
    double glass, int_ior, ext_ior;
    lc_rgb glossy[2];
    double alpha;
} material;

static const material materials[] = {
    {.name = "diffuse_black"},
    {.name = "diffuse_dark", .diffuse = {{{0.02, 0.02, 0.02}}}},
    {.name = "diffuse_half", .diffuse = {{{0.5, 0.5, 0.5}}}},
    {.name = "diffuse_red", .diffuse = {{{0.8, 0.1, 0.02}}}},
    {.name = "diffuse_white", .diffuse = {{{1, 1, 1}}, {{1, 1, 1}}}},
    {.name = "diffuse_two_sides", .diffuse = {{{0.9, 0.9, 0.9}}, {{0.8, 0.1, 0.02}}}},
    {.name = "checkerboard", .is_checkered = {1, 0}, .diffuse = {{{0.7, 0.7, 0.7}, {0.8, 0.1, 0.02}}}},
    {.name = "mirror", .mirror = {{1, 1, 1}, {1, 1, 1}}},
    {.name = "mirror_tinted", .mirror = {{0.95, 0.6, 0.2}}},
    {.name = "mirror_half", .diffuse = {{{0.4, 0.3, 0.2}}}, .mirror = {{0.5, 0.45, 0.4}}},
    {.name = "glass_1.0", .glass = 1},
    {.name = "glass_1.33", .glass = 1, .int_ior = 1.33},
    {.name = "glass_1.5", .glass = 1, .int_ior = 1.5},
    {.name = "glass_2.4", .glass = 1, .int_ior = 2.4},
    {.name = "glass_in_water", .glass = 1, .int_ior = 1.5, .ext_ior = 1.33},
    {.name = "blend",
     .is_checkered = {0, 1},
     .diffuse = {{{0.25, 0.2, 0.1}}, {{0.3, 0.3, 0.3}, {0.1, 0.1, 0.1}}},
     .mirror = {{0.3, 0.28, 0.25}, {0.2, 0.2, 0.3}},
     .glass = 0.4,
     .int_ior = 1.5},
    {.name = "glossy_0.01", .glossy = {{1, 1, 1}}, .alpha = 0.01},
    {.name = "glossy_0.05", .glossy = {{1, 1, 1}, {1, 1, 1}}, .alpha = 0.05},
    {.name = "glossy_0.3", .glossy = {{0.9, 0.5, 0.2}, {0.2, 0.8, 0.3}}, .alpha = 0.3},
    {.name = "glossy_1.0", .glossy = {{1, 1, 1}}, .alpha = 1},
    {.name = "glossy_blend",
     .diffuse = {{{0.3, 0.2, 0.1}}},
     .mirror = {{0.2, 0.1, 0.1}, {0.2, 0.2, 0.3}},
     .glossy = {{0.4, 0.3, 0.4}},
     .alpha = 0.25},
};
enum { MATERIALS = sizeof materials / sizeof materials[0] };

int lc_energy_count(void) { return MATERIALS; }
const char *lc_energy_name(int i) { return i >= 0 && i < MATERIALS ? materials[i].name : NULL; }

static double index_of(double ior) { return ior > 0 ? ior : 1; }

static void describe(lc_material_desc *out, const material *m)
{
    for (int side = 0; side < 2; ++side) {
        out->side[side].diffuse = lc_texture_constant(m->diffuse[side][0]);
        out->side[side].diffuse.color[1] = m->diffuse[side][1];
        out->side[side].diffuse.is_checkerboard = m->is_checkered[side];
        out->side[side].mirror = m->mirror[side];
        out->side[side].glass = m->glass;
        out->side[side].glossy = m->glossy[side];
        out->side[side].alpha = lc_rgb_max(m->glossy[side]) > 0 ? m->alpha : 0;
    }
    out->int_ior = index_of(m->int_ior);
    out->ext_ior = index_of(m->ext_ior);
}

/* ---- stages ----------------------------------------------------------------------------------------------------- */

/* A place in either cell of a checkerboard, (u, v) = (0.65, 0.65) and (0.35, 0.65). */
static const lc_vec3 places[2] = {{0.3, 0.3, 0}, {-0.3, 0.3, 0}};

/* One rectangle of the material, in a pose that has no axis in common with the world. */
static lc_status build(lc_scene **out, const material *m, lc_error *err)
{
    lc_scene_desc desc;
    lc_scene_desc_init(&desc);
    lc_status status = LC_FAULT;
    lc_material_desc *slot = lc_scene_desc_add_material(&desc);
    lc_shape_desc *shape = lc_scene_desc_add_shape(&desc);
    if (!slot || !shape) {
        lc_fail(err, LC_FAULT, "out of memory for the material %s", m->name);
        goto cleanup;
    }
    lc_vec3 n = lc_normalize(lc_vec(1, -2, 3)), s = lc_normalize(lc_cross(lc_vec(2, 1, 1), n)), t = lc_cross(n, s);
    lc_affine pose = {{{s.x, t.x, n.x, 0.1}, {s.y, t.y, n.y, 0.2}, {s.z, t.z, n.z, -0.3}}};
    describe(slot, m);
    shape->kind = LC_RECTANGLE;
    shape->to_world = pose;
    shape->material = 0;
    status = lc_scene_build(out, &desc, err);
cleanup:
    lc_scene_desc_release(&desc);
    return status;
}

/* What the table says, read without the host's own lc_material_at(). */
static lc_status set_stage(lc_stage *stage, const material *m, int back, int cell, lc_error *err)
{
    const lc_affine *pose = &lc_scene_description(stage->scene)->shapes[0].to_world;
    lc_vec3 n = lc_affine_vector(pose, lc_vec(0, 0, back ? -1 : 1));
    lc_ray ray = {lc_add(lc_affine_point(pose, places[cell]), n), lc_neg(n), 0};
    lc_intersect(stage->scene, &ray, &stage->hit);
    if (!stage->hit.valid)
        return lc_fail(err, LC_FAULT, "energy: the ray missed the rectangle of %s", m->name);
    stage->n = back ? lc_neg(stage->hit.n) : stage->hit.n;
    stage->s = lc_affine_vector(pose, lc_vec(1, 0, 0));
    stage->t = lc_cross(stage->n, stage->s);
    stage->side = back ? "back" : "front";
    stage->diffuse = m->diffuse[back][m->is_checkered[back] ? cell : 0];
    stage->mirror = m->mirror[back];
    stage->glass = m->glass;
    stage->glossy = m->glossy[back];
    stage->alpha = lc_rgb_max(m->glossy[back]) > 0 ? m->alpha : 0;
    stage->ior = index_of(back ? m->ext_ior : m->int_ior) / index_of(back ? m->int_ior : m->ext_ior);
    return LC_OK;
}

lc_hit lc_stage_seen(const lc_stage *stage, double cosine, double azimuth)
{
    double sine = sqrt((1 - cosine) * (1 + cosine));
    lc_vec3 along = lc_add(lc_scale(cos(azimuth), stage->s), lc_scale(sin(azimuth), stage->t));
    lc_hit hit = stage->hit;
    hit.wo = lc_normalize(lc_add(lc_scale(sine, along), lc_scale(cosine, stage->n)));
    return hit;
}

double lc_channel(lc_rgb color, int channel) { return channel == 0 ? color.r : channel == 1 ? color.g : color.b; }

int lc_stage_fail(const lc_stage *stage, const lc_hit *hit, const char *format, ...)
{
    lc_row *row = stage->row;
    va_list args;
    row->verdict = LC_ROW_FAIL;
    int used = snprintf(row->reason, sizeof row->reason, "%s, seen from the %s at cos %.7g: ", row->scene, stage->side,
                        fabs(lc_dot(hit->n, hit->wo)));
    va_start(args, format);
    vsnprintf(row->reason + used, sizeof row->reason - (size_t)used, format, args);
    va_end(args);
    return 0;
}

int lc_stage_expect(const lc_stage *stage, const lc_hit *hit, const char *what, double is, double should,
                    double tolerance)
{
    if (fabs(is - should) <= tolerance * fmax(1, fabs(should))) /* false for NaN */
        return 1;
    if (should == 0)
        return lc_stage_fail(stage, hit, "%s is %.9g, expected 0", what, is);
    return lc_stage_fail(stage, hit, "%s is %.9g, expected %.9g (%+.3g%%)", what, is, should, 100 * (is / should - 1));
}

/* ---- rows ------------------------------------------------------------------------------------------------------- */

static const char source[] = "closed forms: rho, r, Fresnel with R + T = 1; reciprocity; a density integrates to 1";

lc_status lc_energy_judge(lc_row *row, int i, const lc_bsdf_functions *bsdf, const lc_share *share, lc_error *err)
{
    const material *m = &materials[i];
    lc_stage stage[4]; /* two sides, two cells */
    lc_scene *scene;
    lc_status status = build(&scene, m, err);
    if (status != LC_OK)
        return status;
    snprintf(row->check, sizeof row->check, "energy");
    snprintf(row->scene, sizeof row->scene, "%s", m->name);
    snprintf(row->estimator, sizeof row->estimator, "host");
    snprintf(row->source, sizeof row->source, "%s", source);
    row->margin = share->margin;
    int cells = m->is_checkered[0] || m->is_checkered[1] ? 2 : 1, stages = 2 * cells;
    for (int k = 0; k < stages && status == LC_OK; ++k) {
        stage[k].bsdf = bsdf;
        stage[k].scene = scene;
        stage[k].row = row;
        status = set_stage(&stage[k], m, k % 2, k / 2, err);
    }
    if (status == LC_OK) {
        int right = 1;
        row->verdict = LC_ROW_PASS;
        row->exact = 1; /* until something is drawn */
        for (int k = 0; k < stages && right; ++k)
            right = lc_energy_forms(&stage[k]);
        for (int k = 0; k < stages && right; ++k) /* later: "there and back differ" does not say which is wrong */
            right = lc_energy_way_back(&stage[k]);
        for (int k = 0; k < stages && right; ++k)
            right = lc_energy_sample(&stage[k], k, stages, share);
    }
    lc_scene_free(scene);
    return status;
}

static lc_status decide(lc_row *row, const lc_claim *claim, const lc_share *share, lc_error *err)
{
    for (int i = 0; i < MATERIALS; ++i)
        if (strcmp(materials[i].name, claim->subject) == 0)
            return lc_energy_judge(row, i, &lc_bsdf_host, share, err);
    return lc_fail(err, LC_FAULT, "energy: no material %s", claim->subject);
}

static lc_status plan_host(const lc_check *self, lc_claims *claims, lc_error *err)
{
    for (int i = 0; i < MATERIALS; ++i) {
        lc_claim *claim = lc_claims_add(claims, self, NULL, NULL);
        if (!claim)
            return lc_fail(err, LC_FAULT, "out of memory for the claims");
        claim->decide = decide;
        claim->subject = materials[i].name;
        claim->source = source;
    }
    return LC_OK;
}

const lc_check lc_check_energy = {
    "energy",
    "the host's materials: positive, reciprocal, no light lost or gained, sampled as they say",
    "Veach, thesis 1997, ch. 5; Fresnel 1823; Walter, Marschner, Li, Torrance 2007; Pearson 1900; docs/checks.md",
    NULL,
    plan_host,
};
