/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Third part of the scene reader: what is supported. One table says which plugins there are, with their properties and
 * children; the checks, their messages and the list in docs/scenes.md all follow it. */
#include <stdio.h>
#include <string.h>

#include "io/scene_read_c.h"
#include "io/scene_read_plugins.h"

static const struct {
    const char *tag;
    unsigned type;
    const char *attributes;
} value_tags[] = {
    {"float", FLOAT, "name value"},       {"integer", INTEGER, "name value"},
    {"boolean", BOOLEAN, "name value"},   {"string", STRING, "name value"},
    {"rgb", RGB, "name value"},           {"spectrum", SPECTRUM, "name value"},
    {"point", POINT, "name value x y z"}, {"vector", VECTOR, "name value x y z"},
    {"transform", TRANSFORM, "name"},     {"texture", TEXTURE, NULL},
};

enum { VALUE_TAGS = sizeof value_tags / sizeof value_tags[0] };

static const char no_spectrum[] = " (Mitsuba tints an emitter's uniform <spectrum> with the colour of daylight)";
static const char no_texture[] = " (a mirror has one colour here)";
static const char no_alpha[] = " (a surface has one roughness here)";
static const char no_weight[] = " (a blend has one weight here)";

/* clang-format off */
#define MOTION {"motion", POINT | VECTOR, NULL}
#define TO_WORLD {"to_world", TRANSFORM, NULL}
#define FLIP {"flip_normals", BOOLEAN, NULL}
#define HIDE {"hide_emitters", BOOLEAN, NULL}
#define SAMPLER {{"sample_count", INTEGER, NULL}, {"seed", INTEGER, NULL}}
/* clang-format on */

static const struct plugin plugins[] = {
    {"integrator", "path", {{"max_depth", INTEGER, NULL}, {"rr_depth", INTEGER, NULL}, HIDE}, ""},
    {"integrator", "direct", {HIDE}, ""},
    {"sensor",
     "perspective",
     {{"fov", NUMBER, NULL},
      {"fov_axis", STRING, NULL},
      {"near_clip", NUMBER, NULL},
      {"far_clip", NUMBER, NULL},
      TO_WORLD},
     "film sampler"},
    {"sensor",
     "thinlens",
     {{"aperture_radius", NUMBER, NULL},
      {"focus_distance", NUMBER, NULL},
      {"fov", NUMBER, NULL},
      {"fov_axis", STRING, NULL},
      {"near_clip", NUMBER, NULL},
      {"far_clip", NUMBER, NULL},
      TO_WORLD},
     "film sampler"},
    {"film",
     "hdrfilm",
     {{"width", INTEGER, NULL},
      {"height", INTEGER, NULL},
      {"pixel_format", STRING, NULL},
      {"component_format", STRING, NULL},
      {"file_format", STRING, NULL}},
     "rfilter"},
    {"rfilter", "box", {{NULL, 0, NULL}}, ""},
    {"sampler", "independent", SAMPLER, ""},
    {"sampler", "stratified", SAMPLER, ""},
    {"sampler", "multijitter", SAMPLER, ""},
    {"sampler", "orthogonal", SAMPLER, ""},
    {"sampler", "ldsampler", SAMPLER, ""},
    {"shape", "rectangle", {TO_WORLD, FLIP, MOTION}, "bsdf emitter"},
    {"shape", "disk", {TO_WORLD, FLIP, MOTION}, "bsdf emitter"},
    {"shape", "cube", {TO_WORLD, FLIP, MOTION}, "bsdf emitter"},
    {"shape",
     "sphere",
     {{"center", POINT | VECTOR, NULL}, {"radius", NUMBER, NULL}, TO_WORLD, FLIP, MOTION},
     "bsdf emitter"},
    {"bsdf", "diffuse", {{"reflectance", COLOR | TEXTURE, NULL}}, ""},
    {"bsdf", "conductor", {{"material", STRING, NULL}, {"specular_reflectance", COLOR, no_texture}}, ""},
    {"bsdf",
     "roughconductor",
     {{"material", STRING, NULL},
      {"specular_reflectance", COLOR, no_texture},
      {"distribution", STRING, NULL},
      {"alpha", NUMBER, no_alpha},
      {"sample_visible", BOOLEAN, NULL}},
     ""},
    {"bsdf", "dielectric", {{"int_ior", FLOAT | STRING, NULL}, {"ext_ior", FLOAT | STRING, NULL}}, ""},
    {"bsdf", "blendbsdf", {{"weight", NUMBER, no_weight}}, "bsdf"},
    {"bsdf", "twosided", {{NULL, 0, NULL}}, "bsdf"},
    {"texture", "checkerboard", {{"color0", COLOR, NULL}, {"color1", COLOR, NULL}, {"to_uv", TRANSFORM, NULL}}, ""},
    {"emitter", "area", {{"radiance", LIGHT | TEXTURE, no_spectrum}}, ""},
    {"emitter", "point", {{"position", POINT | VECTOR, NULL}, {"intensity", LIGHT, no_spectrum}, TO_WORLD}, ""},
    {"emitter", "directional", {{"direction", POINT | VECTOR, NULL}, {"irradiance", LIGHT, no_spectrum}, TO_WORLD}, ""},
    {"emitter", "constant", {{"radiance", LIGHT, no_spectrum}}, ""},
};

enum { PLUGINS = sizeof plugins / sizeof plugins[0] };

/* What stands directly in <scene>. */
static const char scene_children[] = "integrator sensor shape bsdf texture emitter";

/* ---- lists for messages ---- */

enum { LIST = 400 };

static void list(char *text, const char *word)
{
    size_t n = strlen(text);
    snprintf(text + n, LIST - n, "%s%s", n ? ", " : "", word);
}

static void list_properties(char *text, const struct plugin *plugin)
{
    for (int i = 0; i < MAX_PROPERTIES && plugin->properties[i].name; ++i)
        list(text, plugin->properties[i].name);
    if (!*text)
        list(text, "none");
}

void lc_scene_read_describe(void (*line)(void *user, const char *text), void *user)
{
    for (int i = 0; i < PLUGINS; ++i) {
        char properties[LIST] = "", text[2 * LIST];
        list_properties(properties, &plugins[i]);
        snprintf(text, sizeof text, "%s %s: %s", plugins[i].tag, plugins[i].type, properties);
        line(user, text);
    }
}

/* ---- checks ---- */

static int tag_is_known(const char *tag)
{
    for (int i = 0; i < PLUGINS; ++i)
        if (strcmp(plugins[i].tag, tag) == 0)
            return 1;
    return 0;
}

static int find_plugin(struct reader *r, struct node *node)
{
    const char *type = scene_attribute(node, "type");
    char known[LIST] = "";
    if (!type)
        return scene_fail(r, node, "<%s> without a type", node->tag);
    for (int i = 0; i < PLUGINS; ++i) {
        if (strcmp(plugins[i].tag, node->tag) != 0)
            continue;
        if (strcmp(plugins[i].type, type) == 0) {
            node->plugin = &plugins[i];
            return 1;
        }
        list(known, plugins[i].type);
    }
    if (strcmp(node->tag, "rfilter") == 0)
        return scene_fail(r, node,
                          "unsupported rfilter '%.40s'; expected box: pixels here are means over their squares", type);
    return scene_fail(r, node, "unknown %s '%.40s'; supported: %s", node->tag, type, known);
}

/* Index of the property, or -1. */
static int property_index(const struct plugin *plugin, const char *name)
{
    for (int i = 0; i < MAX_PROPERTIES && plugin->properties[i].name; ++i)
        if (strcmp(plugin->properties[i].name, name) == 0)
            return i;
    return -1;
}

/* A property of the node's plugin: known, of a right type (`tag`), given once. */
static int check_property(struct reader *r, const struct node *node, const struct node *value, const char *tag,
                          unsigned *seen)
{
    const struct plugin *plugin = node->plugin;
    const char *name = scene_attribute(value, "name");
    char known[LIST] = "", types[LIST] = "";
    unsigned type = 0;
    if (!name)
        return scene_fail(r, value, "<%s> without a name", value->tag);
    int index = property_index(plugin, name);
    if (index < 0) {
        list_properties(known, plugin);
        return scene_fail(r, value, "unknown property '%.40s' of %s '%s'; supported: %s", name, plugin->tag,
                          plugin->type, known);
    }
    const struct property *property = &plugin->properties[index];
    for (int i = 0; i < VALUE_TAGS; ++i) {
        if (property->types & value_tags[i].type)
            list(types, value_tags[i].tag);
        if (strcmp(value_tags[i].tag, tag) == 0)
            type = value_tags[i].type;
    }
    if (!(property->types & type))
        return scene_fail(r, value, "property '%s' of %s '%s' is a <%s>; expected %s%s", name, plugin->tag,
                          plugin->type, tag, types, property->note ? property->note : "");
    if (*seen & (1u << index))
        return scene_fail(r, value, "property '%s' is given twice", name);
    *seen |= 1u << index;
    return 1;
}

/* The name of a nested object must be free: Mitsuba silently drops the first of two objects with one name. */
static int check_name(struct reader *r, const struct node *node, const struct node *child)
{
    const char *name = scene_attribute(child, "name");
    int count = 0;
    if (!name)
        return 1;
    if (!node->plugin)
        return scene_fail(r, child, "<%s> with a name directly in <scene>; expected an id, if anything", child->tag);
    if (property_index(node->plugin, name) >= 0)
        return scene_fail(r, child, "property '%s' is a <%s>", name, child->tag);
    for (const struct node *n = node->first; n != child; n = n->next) {
        const char *other = scene_attribute(n, "name");
        if (++count > 16)
            return scene_fail(r, child, "too many elements in <%s>", node->tag);
        if (other && strcmp(name, other) == 0)
            return scene_fail(r, child, "the name '%.60s' is already taken by line %d", name, n->line);
    }
    return 1;
}

static int check_value(struct reader *r, const struct node *value, int tag_index)
{
    if (!scene_attributes_only(r, value, value_tags[tag_index].attributes))
        return 0;
    if (value_tags[tag_index].type == TRANSFORM)
        return 1; /* scene_transform() looks at its children */
    if (value->first)
        return scene_fail(r, value->first, "<%.40s> inside <%s>", value->first->tag, value->tag);
    if (value_tags[tag_index].type & (POINT | VECTOR))
        return 1;
    return scene_attribute(value, "value") || scene_fail(r, value, "<%s> without a value", value->tag);
}

struct node *scene_target(struct reader *r, struct node *node)
{
    if (strcmp(node->tag, "ref") != 0)
        return node;
    const char *id = scene_attribute(node, "id");
    if (!scene_attributes_only(r, node, "id name"))
        return NULL;
    struct node *target = id ? scene_find(r, id) : NULL;
    if (!target)
        scene_fail(r, node, "nothing has the id '%.60s'", id ? id : "");
    else if (strcmp(target->tag, "bsdf") != 0 && strcmp(target->tag, "texture") != 0) {
        scene_fail(r, node, "a reference to a <%.40s>; supported: to a bsdf or a texture", target->tag);
        target = NULL;
    }
    return target;
}

/* `node` is an object with a plugin, or the scene (plugin NULL). */
static int check_children(struct reader *r, struct node *node)
{
    const char *allowed = node->plugin ? node->plugin->children : scene_children;
    unsigned seen = 0;
    for (struct node *child = node->first; child; child = child->next) {
        int i = 0;
        while (i < VALUE_TAGS && (!value_tags[i].attributes || strcmp(value_tags[i].tag, child->tag) != 0))
            ++i;
        if (i < VALUE_TAGS) {
            if (!node->plugin)
                return scene_fail(r, child, "<%s> directly in <scene>; supported there: %s default", child->tag,
                                  allowed);
            if (!check_property(r, node, child, child->tag, &seen) || !check_value(r, child, i))
                return 0;
            continue;
        }
        const struct node *target = scene_target(r, child);
        if (!target)
            return 0;
        if (!tag_is_known(target->tag))
            return scene_fail(r, child, "unknown element <%.40s>; supported in <%s>: %s", child->tag, node->tag,
                              *allowed ? allowed : "properties only");
        if (node->plugin && strcmp(target->tag, "texture") == 0) {
            if (!check_property(r, node, child, "texture", &seen))
                return 0;
        } else if (!scene_word_in(allowed, target->tag) || (!node->plugin && target != child))
            return scene_fail(r, child, "<%s> cannot stand in <%s>; supported there: %s", child->tag, node->tag,
                              *allowed ? allowed : "properties only");
        else if (!check_name(r, node, child))
            return 0;
        if (target == child && !scene_check(r, child))
            return 0;
    }
    return 1;
}

int scene_check(struct reader *r, struct node *node)
{
    if (!node->parent)
        return check_children(r, node);
    return scene_attributes_only(r, node, "type id name") && find_plugin(r, node) && check_children(r, node);
}

struct node *scene_property(const struct node *node, const char *name)
{
    for (struct node *n = node->first; n; n = n->next) {
        const char *is = scene_attribute(n, "name");
        if (is && strcmp(is, name) == 0)
            return n;
    }
    return NULL;
}
