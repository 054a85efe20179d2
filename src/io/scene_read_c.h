/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the parts of the scene reader share: scene_read_xml.c turns bytes into a tree, scene_read_values.c reads
 * numbers, colours and transforms, scene_read.c knows the plugins. Every function returns 1, or 0 after scene_fail().
 */
#ifndef LC_SCENE_READ_C_H
#define LC_SCENE_READ_C_H

#include "io/scene_read.h"

struct attribute {
    const char *name, *value; /* value: with its $parameters replaced */
};

struct flat_material;

/* An element. */
struct node {
    const char *tag;
    int line, depth;
    struct attribute *attributes;
    int attribute_count;
    struct node *parent, *first, *last, *next; /* children in the file's order */
    const struct plugin *plugin;               /* of an object, once it was checked */
    int being_read;                            /* a reference back to it would be a circle */
    int material;                              /* of a shape's bsdf: index, -1 before */
    struct flat_material *flat;                /* of any bsdf, once read */
};

struct parameter {
    const char *name, *value;
    size_t length; /* of the name */
};

enum { MAX_DEPTH = 32, MAX_NODES = 200000, MAX_PARAMETERS = 256 };

struct reader {
    const char *name;
    lc_status status;
    lc_error *err;
    struct chunk *chunks; /* memory of the tree, freed as one */
    struct node *root;
    int node_count;
    size_t expanded; /* bytes that $parameters have become */
    struct parameter parameters[MAX_PARAMETERS];
    int parameter_count;
    const lc_parameter *overrides;
    int override_count;
    struct node **by_id; /* sorted by id, then line */
    int id_count;
    lc_scene_desc *desc;
    int reference_depth;
};

/* Records "name:line: ..." unless something failed before; returns 0. */
int scene_fail(struct reader *r, const struct node *node, const char *format, ...)
#ifdef __GNUC__
    __attribute__((format(printf, 3, 4)))
#endif
    ;
int scene_no_memory(struct reader *r);

/* Zeroed memory that lives as long as the tree; NULL after scene_no_memory(). */
void *scene_alloc(struct reader *r, size_t size);
void scene_free(struct reader *r);

/* Parses the text into r->root and r->by_id. */
int scene_parse(struct reader *r, const char *text, size_t length);
/* The attribute's value, or NULL. */
const char *scene_attribute(const struct node *node, const char *name);
/* Fails where the node has an attribute that is not among the space-separated names. */
int scene_attributes_only(struct reader *r, const struct node *node, const char *names);
/* Is `word` one of the space-separated words? */
int scene_word_in(const char *words, const char *word);
/* The element with this id, or NULL. */
struct node *scene_find(const struct reader *r, const char *id);

/* Values. The node is the element that holds it; finite numbers only. */
int scene_number(struct reader *r, const struct node *node, const char *text, double *out);
int scene_float(struct reader *r, const struct node *node, double *out); /* <float> or <integer> */
int scene_integer(struct reader *r, const struct node *node, int *out);
int scene_boolean(struct reader *r, const struct node *node, int *out);
int scene_vector(struct reader *r, const struct node *node, lc_vec3 *out);
/* <rgb>, <float>, <integer> or a uniform <spectrum>; 0 <= every channel <= limit. */
int scene_color(struct reader *r, const struct node *node, double limit, lc_rgb *out);
/* <transform>; not singular. */
int scene_transform(struct reader *r, const struct node *node, lc_affine *out);
/* Longest deviation of A^T A from scale^2 times the identity, relative to scale^2 = |first column|^2. */
double scene_dissimilarity(const lc_affine *a);

#endif
