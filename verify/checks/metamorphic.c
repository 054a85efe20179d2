/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * metamorphic: relations that need no reference. A scene is changed in a way whose effect on the light is known, or that has
 * none, and the estimator has to agree with itself. Nothing is known of the estimator but what it declares, so this
 * holds for any, a student's too.
 *
 * Exact: emission, albedo, scale change by powers of two, which are exact in floating point: the same random numbers must
 * give the same paths, and samples that agree to rounding. An estimator whose choices depend on absolute brightness or on
 * the albedo (roulette) takes other paths, and is then held to the mean. Paired: the same numbers, where that makes
 * the differences small or the terms are several. Else the two scenes are rendered from different numbers.
 */
#include <stdio.h>
#include <string.h>

#include "verify/checks/checks.h"
#include "verify/checks/transform.h"

enum { POWER = 10 }; /* emission and scale change by 2^POWER */
static const double TINT = 0.75; /* of a mirror */

/* Turns the copy of a scene into term i of the relation. */
typedef lc_status make_fn(lc_scene_desc *desc, int i, lc_error *err);

static lc_status make_emission(lc_scene_desc *desc, int i, lc_error *err)
{
    (void)i, (void)err;
    lc_transform_emission(desc, ldexp(1, POWER));
    return LC_OK;
}

static lc_status make_albedo(lc_scene_desc *desc, int i, lc_error *err)
{
    (void)i, (void)err;
    lc_transform_albedo(desc, 0.5);
    return LC_OK;
}

static lc_status make_small(lc_scene_desc *desc, int i, lc_error *err)
{
    (void)i, (void)err;
    lc_transform_scale(desc, ldexp(1, -POWER));
    return LC_OK;
}

static lc_status make_large(lc_scene_desc *desc, int i, lc_error *err)
{
    (void)i, (void)err;
    lc_transform_scale(desc, ldexp(1, POWER));
    return LC_OK;
}

/* No axis stays an axis. */
static lc_status make_moved(lc_scene_desc *desc, int i, lc_error *err)
{
    (void)i, (void)err;
    lc_affine rigid =
        lc_transform_rigid(lc_normalize(lc_vec(0.3, -0.8, 0.5)), 0.8, lc_vec(0.7, -1.3, 0.4));
    lc_transform_move(desc, &rigid);
    return LC_OK;
}

static lc_status make_axes(lc_scene_desc *desc, int i, lc_error *err)
{
    (void)i, (void)err;
    lc_affine axes = lc_transform_axes();
    lc_transform_move(desc, &axes);
    return LC_OK;
}

static lc_status make_quarters(lc_scene_desc *desc, int i, lc_error *err)
{
    (void)i;
    return lc_transform_cut(desc, 1, 2, 2, err);
}

static lc_status make_halves(lc_scene_desc *desc, int i, lc_error *err)
{
    (void)i;
    return lc_transform_cut(desc, 0, 2, 1, err);
}

static lc_status make_one_light(lc_scene_desc *desc, int i, lc_error *err)
{
    (void)err;
    lc_transform_only_light(desc, i);
    return LC_OK;
}

static lc_status make_unfolded(lc_scene_desc *desc, int i, lc_error *err)
{
    (void)i;
    for (int s = 0; s < desc->shape_count; ++s)
        if (lc_rgb_max(desc->materials[desc->shapes[s].material].side[0].mirror) > 0) {
            lc_transform_unfold(desc, s);
            return LC_OK;
        }
    return lc_fail(err, LC_BAD_INPUT, "%s: no mirror to unfold", desc->name);
}

static lc_status make_pane(lc_scene_desc *desc, int i, lc_error *err)
{
    (void)i;
    return lc_transform_pane(desc, 0.01, err);
}

static lc_status make_furnace_cube(lc_scene_desc *desc, int i, lc_error *err)
{
    (void)i;
    lc_affine pose = lc_transform_rigid(lc_normalize(lc_vec(1, 2, 0.5)), 0.7, lc_vec(0.3, 0.2, 0.3));
    for (int k = 0; k < 9; ++k)
        pose.m[k / 3][k % 3] *= 0.15;
    return lc_transform_furnace_cube(desc, &pose, 0.45, err);
}

static lc_status make_tinted(lc_scene_desc *desc, int i, lc_error *err)
{
    (void)i, (void)err;
    for (int m = 0; m < desc->material_count; ++m)
        for (int side = 0; side < 2; ++side)
            desc->materials[m].side[side].mirror = lc_rgb_scale(TINT, desc->materials[m].side[side].mirror);
    return LC_OK;
}

/* Diffuse surfaces only, mirrors only, glass only: a surface that has several is each of them, by chance. */
static lc_status make_one_lobe(lc_scene_desc *desc, int i, lc_error *err)
{
    (void)err;
    lc_transform_only_lobe(desc, i == 0 ? LC_DIFFUSE : i == 1 ? LC_MIRROR : LC_GLASS);
    return LC_OK;
}

/* A square lamp and a square receiver. */
static lc_status make_exchanged(lc_scene_desc *desc, int i, lc_error *err)
{
    (void)i;
    if (desc->shape_count != 2 || desc->shapes[0].emits == desc->shapes[1].emits)
        return lc_fail(err, LC_BAD_INPUT, "%s: expected one lamp and one receiver", desc->name);
    lc_transform_exchange(desc, desc->shapes[0].emits ? 0 : 1, desc->shapes[0].emits ? 1 : 0);
    return LC_OK;
}

static const struct relation {
    const char *name;
    make_fn *make;
    int paired;
    int shift;      /* bounces that the terms have less */
    int whole_only; /* about the image's mean */
    int sees_all;   /* only for who follows every lobe and reaches every emitter */
    const char *source;
} relations[] = {
    {"emission", make_emission, 1, 0, 0, 0, "emission x 1024 gives 1024 times the light"},
    {"albedo", make_albedo, 1, 0, 0, 0, "every albedo x 1/2 gives 2^-k times what was scattered k times"},
    {"small", make_small, 1, 0, 0, 0, "the scene 1/1024 times as large: the same image"},
    {"large", make_large, 1, 0, 0, 0, "the scene 1024 times as large: the same image"},
    {"moved", make_moved, 0, 0, 0, 0, "scene and camera rotated and moved: the same image"},
    {"axes", make_axes, 0, 0, 0, 0, "axes x, y, z permuted: the same image"},
    {"quarters", make_quarters, 1, 0, 0, 0, "each rectangular lamp cut in four: the same image"},
    {"halves", make_halves, 1, 0, 0, 0, "each wall cut in two halves: the same image"},
    {"lights", make_one_light, 1, 0, 0, 0, "all lights give the sum of what each gives alone"},
    {"tinted", make_tinted, 1, 0, 0, 1, "a mirror of 3/4 of the albedo returns exactly 3/4 of what it reflects"},
    {"lobes", make_one_lobe, 1, 0, 0, 1, "a surface that is half a mirror has the mean of what its halves give"},
    {"unfolded", make_unfolded, 0, 1, 0, 1, "what a mirror shows stands behind it, one reflection nearer"},
    {"pane", make_pane, 0, -1, 0, 1, "a pane of glass of index 1 is invisible"},
    {"cube", make_furnace_cube, 0, 0, 0, 1, "another object in a thermal furnace changes nothing"},
    {"exchanged", make_exchanged, 0, 0, 1, 0, "A1 F12 = A2 F21: lamp and receiver exchanged"},
};
enum { RELATIONS = sizeof relations / sizeof relations[0] };

/* A row is planned for each estimator to which the scene shows light. `bounces`: the most; 0: the scene's own. */
static const struct row {
    const char *relation, *scene;
    int bounces, full_only;
    double slack; /* relations find gross errors; what is 0.5% off, the closed forms find */
} rows[] = {
    {"emission", "five_lights", 1, 0, 1},
    {"emission", "mixed_lights", 1, 0, 1},
    {"emission", "sky", 1, 0, 1},
    {"emission", "bright_mirrors", 0, 0, 1},
    {"emission", "glossy_lamp", 1, 0, 1},
    {"emission", "cornell_glass", 0, 1, 1},
    {"albedo", "five_lights", 1, 0, 1},
    {"albedo", "mixed_lights", 1, 1, 1},
    {"albedo", "glossy_lamp", 1, 1, 1},
    {"albedo", "bright_mirrors", 2, 0, 3},
    {"albedo", "glass_sphere", 2, 0, 1},
    {"small", "five_lights", 1, 0, 1},
    {"small", "mixed_lights", 1, 1, 1},
    {"small", "bright_mirrors", 0, 0, 1},
    {"large", "five_lights", 1, 1, 1},
    {"large", "bright_mirrors", 0, 1, 1},
    {"large", "glass_sphere", 0, 0, 1},
    {"large", "glossy_lamp", 1, 0, 1},
    {"small", "motion_lamp", 1, 0, 1},
    {"small", "lens_edge", 1, 1, 1},
    {"moved", "motion_lamp", 1, 1, 8},
    {"moved", "five_lights", 1, 0, 8},
    {"moved", "bright_mirrors", 0, 0, 8},
    {"moved", "glass_slab", 0, 1, 8},
    {"axes", "five_lights", 1, 1, 8},
    {"axes", "mixed_lights", 1, 1, 8},
    {"axes", "bright_mirrors", 0, 1, 8},
    {"quarters", "five_lights", 1, 0, 8},
    {"quarters", "bright_room", 0, 1, 8},
    {"quarters", "textured_lamp", 1, 1, 8},
    {"halves", "plane_tilted", 1, 1, 8},
    {"halves", "bright_room", 0, 1, 8},
    {"lights", "five_lights", 1, 0, 8},
    {"lights", "mixed_lights", 1, 1, 8},
    {"tinted", "mirror_wall", 2, 0, 1},
    {"lobes", "bright_mirrors", 1, 0, 8},
    {"lobes", "glass_blend", 1, 0, 8},
    {"unfolded", "mirror_wall", 2, 0, 4},
    {"pane", "plane_tilted", 2, 0, 8},
    {"cube", "thermal_furnace", 24, 1, 8},
    {"exchanged", "two_patches", 1, 0, 8},
};
enum { ROWS = sizeof rows / sizeof rows[0] };

static const struct relation *relation_of(const struct row *row)
{
    for (int i = 0; i < RELATIONS; ++i)
        if (strcmp(relations[i].name, row->relation) == 0)
            return &relations[i];
    return NULL;
}

static int applies(const struct relation *relation, const lc_scene *scene, const lc_estimator *estimator)
{
    if (relation->sees_all)
        return lc_sees_everything(scene, estimator);
    return (estimator->lobes & lc_scene_lobes(scene)) != 0 && (estimator->emitters & lc_scene_emitters(scene)) != 0;
}

static void name_term(char name[64], const struct relation *relation, const lc_scene_desc *from, int i)
{
    snprintf(name, 64, "%.39s/%.18s:%d", from->name, relation->name, i % 1000);
}

/* Term i of a relation; released by the caller. */
static lc_status describe_term(lc_scene_desc *out, const struct relation *relation, const lc_scene_desc *from, int i, lc_error *err)
{
    lc_status status = lc_scene_desc_copy(out, from, err);
    if (status != LC_OK)
        return status;
    name_term(out->name, relation, from, i);
    status = relation->make(out, i, err);
    if (status != LC_OK)
        lc_scene_desc_release(out);
    return status;
}

/* Its scene: built once, for all estimators. */
static lc_status term_scene(const lc_scene **out, lc_claims *claims, const struct relation *relation,
                            const lc_scene *scene, int i, lc_error *err)
{
    const lc_scene_desc *from = lc_scene_description(scene);
    lc_scene_desc desc;
    char name[64];
    name_term(name, relation, from, i);
    *out = lc_claims_scene(claims, name);
    if (*out)
        return LC_OK;
    lc_status status = describe_term(&desc, relation, from, i, err);
    if (status != LC_OK)
        return status;
    status = lc_claims_build(out, claims, &desc, err);
    lc_scene_desc_release(&desc);
    return status;
}

lc_status lc_relation_scene(lc_scene_desc *out, const lc_scene_desc *from, const char *relation, int term, lc_error *err)
{
    char names[RELATIONS * 20] = "";
    size_t used = 0;
    for (int i = 0; i < RELATIONS; ++i) {
        if (strcmp(relations[i].name, relation) == 0)
            return describe_term(out, &relations[i], from, term, err);
        used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", i ? ", " : "", relations[i].name);
    }
    return lc_fail(err, LC_BAD_INPUT, "there is no relation '%s' between scenes: %s", relation, names);
}

/* Which reflections are summed. */
static void choose_bounces(lc_claim *claim, const struct row *row, const struct relation *relation)
{
    const lc_scene_desc *desc = lc_scene_description(claim->scene);
    int most = row->bounces > 0 ? row->bounces : desc->max_bounces;
    if (most > claim->estimator->max_bounces)
        most = claim->estimator->max_bounces;
    claim->min_bounces = 1;
    claim->max_bounces = most;
    if (relation->make == make_albedo || relation->make == make_unfolded || relation->make == make_tinted)
        claim->min_bounces = most;
    if (relation->make == make_pane)
        claim->min_bounces = claim->max_bounces = 1;
    if (relation->make == make_furnace_cube)
        claim->min_bounces = 0;
}

static double factor_of(const lc_claim *claim, const struct relation *relation)
{
    if (relation->make == make_emission)
        return ldexp(1, -POWER);
    if (relation->make == make_tinted) /* one mirror is met, once */
        return 1 / TINT;
    return relation->make == make_albedo ? ldexp(1, claim->max_bounces) : 1;
}

static lc_status add(const lc_check *self, lc_claims *claims, const struct row *row, const lc_scene *scene,
                     const lc_estimator *estimator, lc_error *err)
{
    const struct relation *relation = relation_of(row);
    lc_claim claim;
    memset(&claim, 0, sizeof claim);
    claim.check = self;
    claim.scene = scene;
    claim.estimator = estimator;
    choose_bounces(&claim, row, relation);
    if (claim.max_bounces < 1 || (relation->shift > 0 && claim.max_bounces <= relation->shift) ||
        claim.max_bounces - relation->shift > estimator->max_bounces)
        return LC_OK;
    claim.relation = relation->name;
    claim.paired = relation->paired;
    claim.whole_only = relation->whole_only;
    claim.slack = row->slack;
    /* Where there is one reflection, for who knows no more: of more, a path tracer has a scene of its own. */
    int is_apt = relation->sees_all || (row->bounces == 1) == (estimator->max_bounces == 1);
    if (!is_apt && !lc_relation_is_sharp(&claim))
        return LC_OK;
    claim.full_only = row->full_only || !is_apt;
    claim.tolerance = 1e-9;
    claim.source = relation->source;
    claim.term_count = relation->make == make_one_light  ? lc_transform_lights(lc_scene_description(scene))
                       : relation->make == make_one_lobe ? 3
                                                         : 1;
    if (claim.term_count > LC_MAX_TERMS)
        return lc_fail(err, LC_FAULT, "%s: %d lights, expected at most %d", lc_scene_description(scene)->name,
                       claim.term_count, LC_MAX_TERMS);
    for (int i = 0; i < claim.term_count; ++i) {
        lc_term *term = &claim.term[i];
        lc_status status = term_scene(&term->scene, claims, relation, scene, i, err);
        if (status != LC_OK)
            return status;
        if (relation->sees_all && !lc_sees_everything(term->scene, estimator))
            return LC_OK; /* the pane is of glass */
        term->factor = factor_of(&claim, relation);
        term->shift = relation->shift;
    }
    lc_claim *added = lc_claims_add(claims, self, scene, estimator);
    if (!added)
        return lc_fail(err, LC_FAULT, "out of memory for the claims");
    *added = claim;
    return LC_OK;
}

static lc_status plan(const lc_check *self, lc_claims *claims, const lc_scene *scene, const lc_estimator *estimator,
                      lc_error *err)
{
    for (int i = 0; i < ROWS; ++i) {
        if (strcmp(rows[i].scene, lc_scene_description(scene)->name) != 0 ||
            !applies(relation_of(&rows[i]), scene, estimator))
            continue;
        lc_status status = add(self, claims, &rows[i], scene, estimator, err);
        if (status != LC_OK)
            return status;
    }
    return LC_OK;
}

const lc_check lc_check_metamorphic = {
    "metamorphic",
    "an estimator agrees with itself over a scene that was changed",
    "linearity, similarity and reciprocity of the rendering equation (Kajiya 1986); Chen, Cheung, Yiu, Metamorphic "
    "testing, HKUST-CS98-01, 1998",
    plan,
    NULL,
};
