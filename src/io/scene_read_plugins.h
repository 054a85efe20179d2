/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of plugins that a scene may use, and the checks that follow from it. */
#ifndef LC_SCENE_READ_PLUGINS_H
#define LC_SCENE_READ_PLUGINS_H

#include "io/scene_read_c.h"

/* Types of properties: the tags that may hold them. */
enum {
    FLOAT = 1,
    INTEGER = 2,
    BOOLEAN = 4,
    STRING = 8,
    RGB = 16,
    SPECTRUM = 32,
    POINT = 64,
    VECTOR = 128,
    TRANSFORM = 256,
    TEXTURE = 512,
    NUMBER = FLOAT | INTEGER,
    COLOR = RGB | NUMBER | SPECTRUM, /* of a surface */
    LIGHT = RGB | NUMBER             /* of an emitter */
};

enum { MAX_PROPERTIES = 8 };

struct property {
    const char *name;
    unsigned types;
    const char *note; /* why other types are refused; may be NULL */
};

struct plugin {
    const char *tag, *type;
    struct property properties[MAX_PROPERTIES]; /* up to the first without a name */
    const char *children;                       /* tags of objects inside it, apart by spaces */
};

/* Checks the object and all in it against the table, and sets node->plugin. */
int scene_check(struct reader *r, struct node *node);
/* What a <ref> refers to (a bsdf or a texture), or the node itself; NULL after a failure. */
struct node *scene_target(struct reader *r, struct node *node);
/* The element that holds the property of a checked object, or NULL. */
struct node *scene_property(const struct node *node, const char *name);

#endif
