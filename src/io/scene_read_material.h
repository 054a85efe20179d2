/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Properties of a checked object, its textures and materials. A property that is not given leaves *out alone. */
#ifndef LC_SCENE_READ_MATERIAL_H
#define LC_SCENE_READ_MATERIAL_H

#include "io/scene_read_plugins.h"

int scene_type_is(const struct node *node, const char *type);

int scene_get_float(struct reader *r, const struct node *node, const char *name, double *out);
int scene_get_integer(struct reader *r, const struct node *node, const char *name, int *out);
int scene_get_boolean(struct reader *r, const struct node *node, const char *name, int *out);
int scene_get_color(struct reader *r, const struct node *node, const char *name, double limit, lc_rgb *out);
/* The identity when it is not given. */
int scene_get_transform(struct reader *r, const struct node *node, const char *name, lc_affine *out);
/* Index of the property's value among the words, 0 when it is not given, -1 after a failure. */
int scene_get_word(struct reader *r, const struct node *node, const char *name, const char *const *words, int count);
/* A colour up to `limit`, or a texture; `otherwise` when it is not given. */
int scene_get_texture(struct reader *r, const struct node *node, const char *name, double limit, lc_rgb otherwise,
                      lc_texture *out);
int scene_read_checkerboard(struct reader *r, const struct node *node, lc_texture *out);

/* The child with this tag, references followed; NULL in *out when there is none. A second one is an error. */
int scene_only_child(struct reader *r, const struct node *node, const char *tag, struct node **out);

/* The index of the BSDF's material, which is added at its first use. */
int scene_material_of(struct reader *r, struct node *bsdf, int *index);
/* What Mitsuba gives a shape without a BSDF: grey, or black where it emits. */
int scene_default_material(struct reader *r, int emits, int *index);

#endif
