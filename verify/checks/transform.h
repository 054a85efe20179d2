/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * transform.h: scenes made of scenes, in memory: what must leave the light as it was, or change it in a known way. Each
 * changes a description in place; those that append need memory and return LC_FAULT without.
 */
#ifndef LC_TRANSFORM_H
#define LC_TRANSFORM_H

#include "core/host.h"

/* All that shines, times `factor`: lamps, points, directional lights, sky. L becomes factor L. */
void lc_transform_emission(lc_scene_desc *desc, double factor);

/* All that reflects, times `factor` in (0, 1]: albedo, mirrors, the share of glass. L_k becomes factor^k L_k. */
void lc_transform_albedo(lc_scene_desc *desc, double factor);

/* The scene `factor` times as large about the origin, camera included. Intensities of point lights grow by the square:
 * the image stays. */
void lc_transform_scale(lc_scene_desc *desc, double factor);

/* Every thing and the camera moved by a rotation with translation: the image stays. */
void lc_transform_move(lc_scene_desc *desc, const lc_affine *rigid);

/* x goes to y, y to z, z to x: exact, without rounding. */
lc_affine lc_transform_axes(void);
/* A rotation by `angle` [rad] about unit `axis`, then a translation. */
lc_affine lc_transform_rigid(lc_vec3 axis, double angle, lc_vec3 translation);

/* Each rectangle that emits (`lamps` = 1), or that does not (0), cut into columns x rows along its parameters, textures as
 * they were: the light stays. A cut lamp is several lamps. There are no triangles here; a quad is cut in two halves. */
lc_status lc_transform_cut(lc_scene_desc *desc, int lamps, int columns, int rows, lc_error *err);

/* How many lights there are, the sky included; and what is left when only light `index` shines. */
int lc_transform_lights(const lc_scene_desc *desc);
void lc_transform_only_light(lc_scene_desc *desc, int index);

/* All surfaces keep only this lobe: LC_DIFFUSE, LC_MIRROR or LC_GLASS. L_1 is the sum of what each alone gives. */
void lc_transform_only_lobe(lc_scene_desc *desc, int lobe);

/* The world behind the flat mirror `shape`, in its place: all other things reflected, the mirror gone, the camera as it
 * was. What was seen in the mirror is seen where it appears to be, by one reflection less. Normals keep their sides. */
void lc_transform_unfold(lc_scene_desc *desc, int shape);

/* A pane of glass of index 1 before the camera, at `distance` and a little larger than the view: invisible. */
lc_status lc_transform_pane(lc_scene_desc *desc, double distance, lc_error *err);

/* One more grey cube [-1, 1]^3 under `pose`, which reflects `rho` and emits 1 - rho: what a thermal furnace of L = 1 cannot
 * tell from nothing. */
lc_status lc_transform_furnace_cube(lc_scene_desc *desc, const lc_affine *pose, double rho, lc_error *err);

/* The emission of square `lamp` moved to square `receiver`, and the camera, which saw all of the receiver upright from its
 * front, moved to see the lamp that way. The radiance becomes Le A_lamp / A_receiver, so that the image's mean stays:
 * A1 F12 = A2 F21. */
void lc_transform_exchange(lc_scene_desc *desc, int lamp, int receiver);
/* The camera sees all of a square `shape`, and nothing else, from the side of its normal, at half its width. */
void lc_transform_face(lc_scene_desc *desc, int shape);

#endif
