/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Private to verify/renderers/pov_export*: a scene being written.
 */
#ifndef LC_POV_EXPORT_C_H
#define LC_POV_EXPORT_C_H

#include "verify/renderers/pov_export.h"

typedef struct lc_pov_writer {
    FILE *out;
    const lc_scene_desc *desc;
    const lc_pov_options *options;
    double unit;    /* POV-Ray's units a metre: a power of two */
    lc_vec3 center; /* of the scene, */
    double radius;  /* and of a ball around it that holds everything [m] */
} lc_pov_writer;

/* Distances in POV-Ray's units, whose tolerances are absolute and about 1e-3. */
#define LC_POV_EXTENT 512.0 /* the scene's radius comes to lie in (1/2, 1] of it */
#define LC_POV_LIFT 4e-3    /* of a point light above the lamp it belongs to, so that the lamp does not shadow it */
#define LC_POV_FADE 1e-2    /* fade_distance: far below any distance that matters */

int lc_pov_is_black(lc_rgb c);
/* Names of shape kinds, in the order of lc_shape_kind. */
extern const char *const lc_pov_kind_names[];

/* pov_export_shapes.c: shapes with what they are made of. */
lc_status lc_pov_check_shapes(const lc_pov_writer *w, lc_error *err);
void lc_pov_write_shapes(const lc_pov_writer *w);

/* pov_export_lights.c: point and directional lights, and the points that stand for lamps. */
lc_status lc_pov_check_lights(const lc_pov_writer *w, lc_error *err);
lc_status lc_pov_write_lights(const lc_pov_writer *w, lc_error *err);

#endif
