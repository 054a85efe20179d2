/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes made by hand, for the suites of the tracer. */
#ifndef LC_SCENE_HELP_H
#define LC_SCENE_HELP_H

#include <check.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "core/host.h"

/* In [0, 1), 53 bits; any generator will do here (L'Ecuyer's 64-bit multiplicative one, high bits). */
static inline double next_uniform(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

static inline double next_within(uint64_t *state, double low, double high)
{
    return low + (high - low) * next_uniform(state);
}

static inline lc_vec3 next_direction(uint64_t *state)
{
    double z = next_within(state, -1, 1), phi = next_within(state, 0, 2 * LC_PI), r = sqrt(1 - z * z);
    return lc_normalize(lc_vec(r * cos(phi), r * sin(phi), z));
}

static inline lc_affine pose_of_columns(lc_vec3 x, lc_vec3 y, lc_vec3 z, lc_vec3 t)
{
    lc_affine a = {{{x.x, y.x, z.x, t.x}, {x.y, y.y, z.y, t.y}, {x.z, y.z, z.z, t.z}}};
    return a;
}

static inline lc_affine pose_scale(double x, double y, double z)
{
    return pose_of_columns(lc_vec(x, 0, 0), lc_vec(0, y, 0), lc_vec(0, 0, z), lc_vec(0, 0, 0));
}

static inline lc_affine pose_translate(double x, double y, double z)
{
    return pose_of_columns(lc_vec(1, 0, 0), lc_vec(0, 1, 0), lc_vec(0, 0, 1), lc_vec(x, y, z));
}

/* A rotation that takes +z to `z` and turns about it by `angle`. */
static inline lc_affine pose_rotate(lc_vec3 z, double angle)
{
    lc_vec3 helper = fabs(z.x) < 0.7 ? lc_vec(1, 0, 0) : lc_vec(0, 1, 0);
    lc_vec3 s = lc_normalize(lc_cross(helper, z)), t = lc_cross(z, s);
    lc_vec3 x = lc_add(lc_scale(cos(angle), s), lc_scale(sin(angle), t));
    return pose_of_columns(x, lc_cross(z, x), z, lc_vec(0, 0, 0));
}

/* Sizes in [least, most] along three axes (all three alike for a sphere), any rotation, the centre anywhere in [-spread, spread]^3. */
static inline lc_affine next_pose(uint64_t *state, lc_shape_kind kind, double least, double most, double spread)
{
    double size[3];
    for (int i = 0; i < 3; ++i)
        size[i] = kind == LC_SPHERE && i ? size[0] : next_within(state, least, most);
    lc_affine scale = pose_scale(size[0], size[1], size[2]);
    lc_vec3 z = next_direction(state);
    lc_affine turn = pose_rotate(z, next_within(state, 0, 2 * LC_PI));
    lc_affine pose = lc_affine_multiply(&turn, &scale);
    for (int i = 0; i < 3; ++i)
        pose.m[i][3] = next_within(state, -spread, spread);
    return pose;
}

/* A one-sided diffuse material; returns its index. */
static inline int add_diffuse(lc_scene_desc *desc, double albedo)
{
    lc_material_desc *m = lc_scene_desc_add_material(desc);
    ck_assert_ptr_nonnull(m);
    m->side[0].diffuse = lc_texture_constant(lc_color(albedo, albedo, albedo));
    m->side[1].diffuse = lc_texture_constant(lc_black());
    m->int_ior = m->ext_ior = 1;
    return desc->material_count - 1;
}

static inline lc_shape_desc *add_shape(lc_scene_desc *desc, lc_shape_kind kind, lc_affine pose)
{
    if (desc->material_count == 0)
        add_diffuse(desc, 0.5);
    lc_shape_desc *shape = lc_scene_desc_add_shape(desc);
    ck_assert_ptr_nonnull(shape);
    shape->kind = kind;
    shape->to_world = pose;
    return shape;
}

static inline lc_shape_desc *add_lamp(lc_scene_desc *desc, lc_shape_kind kind, lc_affine pose, lc_rgb radiance)
{
    lc_shape_desc *shape = add_shape(desc, kind, pose);
    shape->emits = 1;
    shape->radiance = lc_texture_constant(radiance);
    return shape;
}

/* Builds the scene and releases the description. */
static inline lc_scene *build_scene(lc_scene_desc *desc)
{
    lc_scene *scene;
    lc_error err = {""};
    lc_status status = lc_scene_build(&scene, desc, &err);
    ck_assert_msg(status == LC_OK, "%s", err.text);
    lc_scene_desc_release(desc);
    return scene;
}

static inline lc_hit see(const lc_scene *scene, lc_vec3 o, lc_vec3 d)
{
    lc_ray ray = {o, lc_normalize(d), 0};
    lc_hit hit;
    memset(&hit, 0, sizeof hit);
    lc_intersect(scene, &ray, &hit);
    return hit;
}

/* The same scene, `scale` times as large about the origin, with the same radiances. Irradiance of directional lights stays, intensity of
 * points grows by the square. */
static inline void scale_desc(lc_scene_desc *desc, double scale)
{
    lc_affine s = pose_scale(scale, scale, scale);
    for (int i = 0; i < desc->shape_count; ++i)
        desc->shapes[i].to_world = lc_affine_multiply(&s, &desc->shapes[i].to_world);
    for (int i = 0; i < desc->shape_count; ++i)
        desc->shapes[i].motion = lc_scale(scale, desc->shapes[i].motion);
    for (int i = 0; i < desc->point_count; ++i) {
        desc->points[i].position = lc_scale(scale, desc->points[i].position);
        desc->points[i].intensity = lc_rgb_scale(scale * scale, desc->points[i].intensity);
    }
    for (int i = 0; i < 3; ++i)
        desc->camera.to_world.m[i][3] *= scale; /* it stays rigid */
    desc->camera.near_clip *= scale;
    desc->camera.far_clip *= scale;
    desc->camera.aperture_radius *= scale;
    desc->camera.focus_distance *= scale;
}

#endif
