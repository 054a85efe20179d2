/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * energy: the host's materials. A BSDF is nowhere negative, reciprocal, and sends back exactly the light that it should: a loss is found as
 * well as a gain. Its density integrates to 1 and is the one that its samples follow. Every estimator stands on these, so that
 * without this check an error here would look like an error of all.
 */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "verify/checks/energy_c.h"

const lc_bsdf_functions lc_bsdf_host = {lc_bsdf_eval, lc_bsdf_pdf, lc_bsdf_sample};

/* ---- materials -------------------------------------------------------------------------------------------------- */

#define BLACK \
    { \
        0, 0, 0 \
    }
#define WHITE \
    { \
        1, 1, 1 \
    }
#define GREY(x) \
    { \
        x, x, x \
    }
/* Texture of one colour, and a checkerboard of two. */
#define PLAIN(...) \
    { \
        0, {__VA_ARGS__, BLACK}, {1, 1}, { 0, 0 } \
    }
#define CHECKS(...) \
    { \
        1, {__VA_ARGS__}, {1, 1}, { 0, 0 } \
    }
#define DARK \
    { \
        PLAIN(BLACK), BLACK, 0 \
    }
#define DIFFUSE(...) \
    { \
        PLAIN(__VA_ARGS__), BLACK, 0 \
    }
#define MIRROR(...) \
    { \
        PLAIN(BLACK), __VA_ARGS__, 0 \
    }
#define GLASS \
    { \
        PLAIN(BLACK), BLACK, 1 \
    }
#define RED \
    { \
        0.8, 0.1, 0.02 \
    }

static const lc_material_desc materials[] = {
    {"diffuse_black", 0, {DARK, DARK}, 1, 1},
    {"diffuse_dark", 0, {DIFFUSE(GREY(0.02)), DARK}, 1, 1},
    {"diffuse_half", 0, {DIFFUSE(GREY(0.5)), DARK}, 1, 1},
    {"diffuse_red", 0, {DIFFUSE(RED), DARK}, 1, 1},
    {"diffuse_white", 0, {DIFFUSE(WHITE), DIFFUSE(WHITE)}, 1, 1},
    {"diffuse_two_sides", 0, {DIFFUSE(GREY(0.9)), DIFFUSE(RED)}, 1, 1},
    {"checkerboard", 0, {{CHECKS(GREY(0.7), RED), BLACK, 0}, DARK}, 1, 1},
    {"mirror", 0, {MIRROR(WHITE), MIRROR(WHITE)}, 1, 1},
    {"mirror_tinted", 0, {MIRROR({0.95, 0.6, 0.2}), DARK}, 1, 1},
    {"mirror_half", 0, {{PLAIN({0.4, 0.3, 0.2}), {0.5, 0.45, 0.4}, 0}, DARK}, 1, 1},
    {"glass_1.0", 0, {GLASS, GLASS}, 1, 1},
    {"glass_1.33", 0, {GLASS, GLASS}, 1.33, 1},
    {"glass_1.5", 0, {GLASS, GLASS}, 1.5, 1},
    {"glass_2.4", 0, {GLASS, GLASS}, 2.4, 1},
    {"glass_in_water", 0, {GLASS, GLASS}, 1.5, 1.33},
    {"blend",
     0,
     {{PLAIN({0.25, 0.2, 0.1}), {0.3, 0.28, 0.25}, 0.4}, {CHECKS(GREY(0.3), GREY(0.1)), {0.2, 0.2, 0.3}, 0.4}},
     1.5,
     1},
};
enum { MATERIALS = sizeof materials / sizeof materials[0] };

int lc_energy_count(void) { return MATERIALS; }
const char *lc_energy_name(int i) { return i >= 0 && i < MATERIALS ? materials[i].id : NULL; }

/* ---- stages ----------------------------------------------------------------------------------------------------- */

/* A place in either cell of a checkerboard, (u, v) = (0.65, 0.65) and (0.35, 0.65). */
static const lc_vec3 places[2] = {{0.3, 0.3, 0}, {-0.3, 0.3, 0}};

/* One rectangle of the material, in a pose that has no axis in common with the world. */
static lc_status build(lc_scene **out, const lc_material_desc *material, lc_error *err)
{
    lc_scene_desc desc;
    lc_scene_desc_init(&desc);
    lc_status status = LC_FAULT;
    lc_material_desc *m = lc_scene_desc_add_material(&desc);
    lc_shape_desc *shape = lc_scene_desc_add_shape(&desc);
    if (!m || !shape) {
        lc_fail(err, LC_FAULT, "out of memory for the material %s", material->id);
        goto cleanup;
    }
    lc_vec3 n = lc_normalize(lc_vec(1, -2, 3)), s = lc_normalize(lc_cross(lc_vec(2, 1, 1), n)), t = lc_cross(n, s);
    lc_affine pose = {{{s.x, t.x, n.x, 0.1}, {s.y, t.y, n.y, 0.2}, {s.z, t.z, n.z, -0.3}}};
    *m = *material;
    shape->kind = LC_RECTANGLE;
    shape->to_world = pose;
    shape->material = 0;
    status = lc_scene_build(out, &desc, err);
cleanup:
    lc_scene_desc_release(&desc);
    return status;
}

/* What the description says, read without the host's own lc_material_at(). */
static lc_status set_stage(lc_stage *stage, const lc_material_desc *m, int back, int cell, lc_error *err)
{
    const lc_affine *pose = &lc_scene_description(stage->scene)->shapes[0].to_world;
    lc_vec3 n = lc_affine_vector(pose, lc_vec(0, 0, back ? -1 : 1));
    lc_ray ray = {lc_add(lc_affine_point(pose, places[cell]), n), lc_neg(n), 0};
    lc_intersect(stage->scene, &ray, &stage->hit);
    if (!stage->hit.valid)
        return lc_fail(err, LC_FAULT, "energy: the ray missed the rectangle of %s", m->id);
    stage->n = back ? lc_neg(stage->hit.n) : stage->hit.n;
    stage->s = lc_affine_vector(pose, lc_vec(1, 0, 0));
    stage->t = lc_cross(stage->n, stage->s);
    stage->side = back ? "back" : "front";
    stage->diffuse = m->side[back].diffuse.color[m->side[back].diffuse.is_checkerboard ? cell : 0];
    stage->mirror = m->side[back].mirror;
    stage->glass = m->side[back].glass;
    stage->ior = back ? m->ext_ior / m->int_ior : m->int_ior / m->ext_ior;
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
    const lc_material_desc *m = &materials[i];
    lc_stage stage[4]; /* two sides, two cells */
    lc_scene *scene;
    lc_status status = build(&scene, m, err);
    if (status != LC_OK)
        return status;
    snprintf(row->check, sizeof row->check, "energy");
    snprintf(row->scene, sizeof row->scene, "%s", m->id);
    snprintf(row->estimator, sizeof row->estimator, "host");
    snprintf(row->source, sizeof row->source, "%s", source);
    row->margin = share->margin;
    int cells = m->side[0].diffuse.is_checkerboard || m->side[1].diffuse.is_checkerboard ? 2 : 1, stages = 2 * cells;
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
            right = lc_energy_exact(&stage[k]);
        for (int k = 0; k < stages && right; ++k)
            right = lc_energy_sample(&stage[k], k, stages, share);
    }
    lc_scene_free(scene);
    return status;
}

static lc_status decide(lc_row *row, const lc_claim *claim, const lc_share *share, lc_error *err)
{
    for (int i = 0; i < MATERIALS; ++i)
        if (strcmp(materials[i].id, claim->subject) == 0)
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
        claim->subject = materials[i].id;
        claim->source = source;
    }
    return LC_OK;
}

const lc_check lc_check_energy = {
    "energy",
    "the host's materials: positive, reciprocal, no light lost or gained, sampled as they say",
    "Veach, thesis 1997, ch. 5; Fresnel 1823; Pearson 1900; docs/checks.md",
    NULL,
    plan_host,
};
