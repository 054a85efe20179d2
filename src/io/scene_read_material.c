/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fourth part of the scene reader: properties by name, textures and materials. Nested BSDFs become lobes that add up.
 */
#include <stdio.h>
#include <string.h>

#include "io/scene_read_material.h"

/* A BSDF without its nesting. The index pair means something only where there is glass. */
struct flat_material {
    lc_side side[2];
    double int_ior, ext_ior;
};

int scene_type_is(const struct node *node, const char *type) { return strcmp(node->plugin->type, type) == 0; }

/* ---- properties with a default ---- */

int scene_get_float(struct reader *r, const struct node *node, const char *name, double *out)
{
    const struct node *value = scene_property(node, name);
    return !value || scene_float(r, value, out);
}

int scene_get_integer(struct reader *r, const struct node *node, const char *name, int *out)
{
    const struct node *value = scene_property(node, name);
    return !value || scene_integer(r, value, out);
}

int scene_get_boolean(struct reader *r, const struct node *node, const char *name, int *out)
{
    const struct node *value = scene_property(node, name);
    return !value || scene_boolean(r, value, out);
}

int scene_get_color(struct reader *r, const struct node *node, const char *name, double limit, lc_rgb *out)
{
    const struct node *value = scene_property(node, name);
    return !value || scene_color(r, value, limit, out);
}

int scene_get_transform(struct reader *r, const struct node *node, const char *name, lc_affine *out)
{
    const struct node *value = scene_property(node, name);
    *out = lc_affine_identity();
    return !value || scene_transform(r, value, out);
}

/* Index of the property's value among the words, 0 when it is not given, -1 after a failure. */
int scene_get_word(struct reader *r, const struct node *node, const char *name, const char *const *words, int count)
{
    const struct node *value = scene_property(node, name);
    char known[200] = "";
    if (!value)
        return 0;
    for (int i = 0; i < count; ++i) {
        if (strcmp(scene_attribute(value, "value"), words[i]) == 0)
            return i;
        snprintf(known + strlen(known), sizeof known - strlen(known), "%s%s", i ? ", " : "", words[i]);
    }
    scene_fail(r, value, "unsupported %s '%.60s'; supported: %s", name, scene_attribute(value, "value"), known);
    return -1;
}

/* The child with this tag, references followed; NULL in *out when there is none. A second one is an error. */
int scene_only_child(struct reader *r, const struct node *node, const char *tag, struct node **out)
{
    *out = NULL;
    for (struct node *n = node->first; n; n = n->next) {
        struct node *target = scene_target(r, n);
        if (!target)
            return 0;
        if (strcmp(target->tag, tag) != 0)
            continue;
        if (*out)
            return scene_fail(r, n, "a second <%s> in <%s>", tag, node->tag);
        *out = target;
    }
    return 1;
}

/* ---- textures ---- */

int scene_read_checkerboard(struct reader *r, const struct node *node, lc_texture *out)
{
    lc_affine a;
    out->is_checkerboard = 1;
    out->color[0] = lc_color(.4, .4, .4), out->color[1] = lc_color(.2, .2, .2); /* Mitsuba's defaults */
    if (!scene_get_color(r, node, "color0", 1, &out->color[0]) ||
        !scene_get_color(r, node, "color1", 1, &out->color[1]) || !scene_get_transform(r, node, "to_uv", &a))
        return 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (i != j && a.m[i][j] != 0)
                return scene_fail(r, scene_property(node, "to_uv"),
                                  "to_uv that rotates or shears; supported: scale, translate");
    for (int i = 0; i < 2; ++i)
        out->scale[i] = a.m[i][i], out->offset[i] = a.m[i][3];
    return 1;
}

/* A colour or a texture; `limit` for a plain colour. */
int scene_get_texture(struct reader *r, const struct node *node, const char *name, double limit, lc_rgb otherwise,
                      lc_texture *out)
{
    struct node *value = scene_property(node, name);
    *out = lc_texture_constant(otherwise);
    if (!value)
        return 1;
    if (strcmp(value->tag, "texture") == 0 || strcmp(value->tag, "ref") == 0)
        return (value = scene_target(r, value)) && scene_read_checkerboard(r, value, out);
    if (!scene_color(r, value, limit, &otherwise))
        return 0;
    *out = lc_texture_constant(otherwise);
    return 1;
}

static void scale_texture(lc_texture *t, double s)
{
    t->color[0] = lc_rgb_scale(s, t->color[0]), t->color[1] = lc_rgb_scale(s, t->color[1]);
}

static int is_black(const lc_texture *t) { return lc_rgb_max(t->color[0]) == 0 && lc_rgb_max(t->color[1]) == 0; }

/* a += b, where the sum is again one texture; returns 0 where it is not. */
static int add_texture(lc_texture *a, const lc_texture *b)
{
    if (is_black(b))
        return 1;
    if (is_black(a)) {
        *a = *b;
        return 1;
    }
    if (a->is_checkerboard && b->is_checkerboard &&
        (memcmp(a->scale, b->scale, sizeof a->scale) != 0 || memcmp(a->offset, b->offset, sizeof a->offset) != 0))
        return 0;
    lc_texture sum = a->is_checkerboard ? *a : *b;
    for (int i = 0; i < 2; ++i)
        sum.color[i] = lc_rgb_add(a->color[i], b->color[i]);
    *a = sum;
    return 1;
}

/* ---- materials ---- */

static int read_bsdf(struct reader *r, struct node *node, struct flat_material *out);

static int read_diffuse(struct reader *r, const struct node *node, struct flat_material *out)
{
    return scene_get_texture(r, node, "reflectance", 1, lc_color(.5, .5, .5), &out->side[0].diffuse);
}

static int read_conductor(struct reader *r, const struct node *node, struct flat_material *out)
{
    static const char *const none[] = {"none"};
    out->side[0].mirror = lc_color(1, 1, 1);
    return scene_get_word(r, node, "material", none, 1) == 0 &&
           scene_get_color(r, node, "specular_reflectance", 1, &out->side[0].mirror);
}

/* Only GGX, while Mitsuba's default is Beckmann. `sample_visible` is how Mitsuba draws, not what. Smoother than 0.01 a
 * surface is better a conductor: the energy check would have to look very closely. */
static int read_roughconductor(struct reader *r, const struct node *node, struct flat_material *out)
{
    static const char *const none[] = {"none"}, *const ggx[] = {"ggx"};
    double alpha = .1;
    int sample_visible = 1;
    if (!scene_property(node, "distribution"))
        return scene_fail(r, node, "roughconductor without distribution \"ggx\"; Mitsuba's default is beckmann");
    out->side[0].glossy = lc_color(1, 1, 1);
    if (scene_get_word(r, node, "material", none, 1) != 0 || scene_get_word(r, node, "distribution", ggx, 1) != 0 ||
        !scene_get_color(r, node, "specular_reflectance", 1, &out->side[0].glossy) ||
        !scene_get_float(r, node, "alpha", &alpha) || !scene_get_boolean(r, node, "sample_visible", &sample_visible))
        return 0;
    if (!(alpha >= .01 && alpha <= 1))
        return scene_fail(r, node, "alpha %g; expected 0.01 to 1", alpha);
    out->side[0].alpha = lc_rgb_max(out->side[0].glossy) > 0 ? alpha : 0;
    return 1;
}

/* Mitsuba's own numbers. */
static const struct {
    const char *name;
    double ior;
} indices[] = {{"vacuum", 1.0}, {"air", 1.000277}, {"water", 1.3330}, {"bk7", 1.5046}, {"diamond", 2.419}};

static int get_ior(struct reader *r, const struct node *node, const char *name, const char *otherwise, double *out)
{
    const struct node *value = scene_property(node, name);
    const char *word = value ? scene_attribute(value, "value") : otherwise;
    if (value && strcmp(value->tag, "float") == 0) {
        if (!scene_float(r, value, out))
            return 0;
        return *out > 0 || scene_fail(r, value, "%s %g is not positive", name, *out);
    }
    for (size_t i = 0; i < sizeof indices / sizeof indices[0]; ++i)
        if (strcmp(indices[i].name, word) == 0) {
            *out = indices[i].ior;
            return 1;
        }
    return scene_fail(r, value,
                      "unknown material '%.40s' of %s; supported: vacuum, air, water, bk7, diamond, or a <float>", word,
                      name);
}

static int read_dielectric(struct reader *r, const struct node *node, struct flat_material *out)
{
    out->side[0].glass = out->side[1].glass = 1;
    return get_ior(r, node, "int_ior", "bk7", &out->int_ior) && get_ior(r, node, "ext_ior", "air", &out->ext_ior);
}

/* The nested BSDFs, at most `max`; their number, or -1 after a failure. */
static int nested(struct reader *r, const struct node *node, struct flat_material *out, int max)
{
    int count = 0;
    for (struct node *n = node->first; n; n = n->next) {
        struct node *target = scene_target(r, n);
        if (!target)
            return -1;
        if (strcmp(target->tag, "bsdf") != 0)
            continue;
        if (count == max) {
            scene_fail(r, n, "more than %d <bsdf> in %s", max, node->plugin->type);
            return -1;
        }
        if (!read_bsdf(r, target, &out[count++]))
            return -1;
    }
    return count;
}

static int has_glass(const struct flat_material *m) { return m->side[0].glass > 0 || m->side[1].glass > 0; }

/* The rough lobe of `side` += share times that of `other`; returns 0 where the two are not one lobe. */
static int add_glossy(lc_side *side, const lc_side *other, double share)
{
    if (!(share * lc_rgb_max(other->glossy) > 0))
        return 1;
    if (lc_rgb_max(side->glossy) > 0 && side->alpha != other->alpha)
        return 0;
    side->glossy = lc_rgb_add(side->glossy, lc_rgb_scale(share, other->glossy));
    side->alpha = other->alpha;
    return 1;
}

/* The second BSDF has the weight, the first the rest. */
static int read_blend(struct reader *r, const struct node *node, struct flat_material *out)
{
    struct flat_material child[2];
    double weight = -1;
    if (!scene_get_float(r, node, "weight", &weight))
        return 0;
    if (!(weight >= 0 && weight <= 1))
        return scene_fail(r, node, "blendbsdf without a weight in [0, 1]");
    int count = nested(r, node, child, 2);
    if (count != 2)
        return count < 0 ? 0 : scene_fail(r, node, "blendbsdf of %d <bsdf>; expected 2", count);
    int glass = has_glass(&child[1]);
    if (glass && has_glass(&child[0]) && (child[0].int_ior != child[1].int_ior || child[0].ext_ior != child[1].ext_ior))
        return scene_fail(r, node, "a blend of two dielectrics with different indices; a surface has one pair here");
    out->int_ior = child[glass].int_ior, out->ext_ior = child[glass].ext_ior;
    for (int s = 0; s < 2; ++s)
        for (int i = 0; i < 2; ++i) {
            double share = i ? weight : 1 - weight;
            scale_texture(&child[i].side[s].diffuse, share);
            if (!add_texture(&out->side[s].diffuse, &child[i].side[s].diffuse))
                return scene_fail(r, node, "a blend of two checkerboards with different to_uv; a surface has one here");
            out->side[s].mirror = lc_rgb_add(out->side[s].mirror, lc_rgb_scale(share, child[i].side[s].mirror));
            out->side[s].glass += share * child[i].side[s].glass;
            if (!add_glossy(&out->side[s], &child[i].side[s], share))
                return scene_fail(r, node, "a blend of two roughconductors of different alpha; a surface has one here");
        }
    return 1;
}

static int read_twosided(struct reader *r, const struct node *node, struct flat_material *out)
{
    struct flat_material child[2];
    int count = nested(r, node, child, 2);
    if (count < 1)
        return count < 0 ? 0 : scene_fail(r, node, "twosided without a <bsdf>");
    for (int i = 0; i < count; ++i)
        if (has_glass(&child[i]))
            return scene_fail(r, node, "twosided around a dielectric; expected what lets no light through");
    out->side[0] = child[0].side[0];
    out->side[1] = child[count - 1].side[0];
    return 1;
}

static const struct {
    const char *type;
    int (*read)(struct reader *r, const struct node *node, struct flat_material *out);
} bsdfs[] = {
    {"diffuse", read_diffuse},       {"conductor", read_conductor}, {"roughconductor", read_roughconductor},
    {"dielectric", read_dielectric}, {"blendbsdf", read_blend},     {"twosided", read_twosided},
};

/* Each is read once, however often it is referred to: else a chain of blends would take exponential time. */
static int read_bsdf(struct reader *r, struct node *node, struct flat_material *out)
{
    if (node->being_read)
        return scene_fail(r, node, "a circle of references");
    if (node->flat) {
        *out = *node->flat;
        return 1;
    }
    if (r->reference_depth > MAX_DEPTH)
        return scene_fail(r, node, "references nested more than %d deep", MAX_DEPTH);
    memset(out, 0, sizeof *out);
    out->int_ior = out->ext_ior = 1;
    for (int s = 0; s < 2; ++s)
        out->side[s].diffuse = lc_texture_constant(lc_black());
    ++r->reference_depth, node->being_read = 1;
    int ok = 0;
    for (size_t i = 0; i < sizeof bsdfs / sizeof bsdfs[0]; ++i)
        if (scene_type_is(node, bsdfs[i].type))
            ok = bsdfs[i].read(r, node, out);
    --r->reference_depth, node->being_read = 0;
    if (!ok || !(node->flat = scene_alloc(r, sizeof *node->flat)))
        return 0;
    *node->flat = *out;
    return 1;
}

static int add_material(struct reader *r, const struct flat_material *flat, const char *id, int line, int *index)
{
    lc_material_desc *m = lc_scene_desc_add_material(r->desc);
    if (!m)
        return scene_no_memory(r);
    snprintf(m->id, sizeof m->id, "%s", id);
    m->line = line;
    m->side[0] = flat->side[0], m->side[1] = flat->side[1];
    m->int_ior = flat->int_ior, m->ext_ior = flat->ext_ior;
    *index = r->desc->material_count - 1;
    return 1;
}

int scene_material_of(struct reader *r, struct node *bsdf, int *index)
{
    struct flat_material flat;
    const char *id = scene_attribute(bsdf, "id");
    if (id && strlen(id) >= sizeof r->desc->materials->id)
        return scene_fail(r, bsdf, "an id of more than %d bytes", (int)sizeof r->desc->materials->id - 1);
    if (bsdf->material < 0 &&
        (!read_bsdf(r, bsdf, &flat) || !add_material(r, &flat, id ? id : "", bsdf->line, &bsdf->material)))
        return 0;
    *index = bsdf->material;
    return 1;
}

/* What Mitsuba gives a shape without a BSDF: grey, or black where it emits. One material for each. */
int scene_default_material(struct reader *r, int emits, int *index)
{
    struct flat_material flat;
    double albedo = emits ? 0 : .5;
    for (int i = 0; i < r->desc->material_count; ++i)
        if (r->desc->materials[i].line == 0 && r->desc->materials[i].side[0].diffuse.color[0].r == albedo) {
            *index = i;
            return 1;
        }
    memset(&flat, 0, sizeof flat);
    flat.side[0].diffuse = lc_texture_constant(lc_color(albedo, albedo, albedo));
    flat.side[1].diffuse = lc_texture_constant(lc_black());
    flat.int_ior = flat.ext_ior = 1;
    return add_material(r, &flat, "", 0, index);
}
