/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/checks/transform.h"

#include <string.h>

static void scale_texture(lc_texture *t, double factor)
{
    t->color[0] = lc_rgb_scale(factor, t->color[0]);
    t->color[1] = lc_rgb_scale(factor, t->color[1]);
}

void lc_transform_emission(lc_scene_desc *desc, double factor)
{
    for (int i = 0; i < desc->shape_count; ++i)
        scale_texture(&desc->shapes[i].radiance, factor);
    for (int i = 0; i < desc->point_count; ++i)
        desc->points[i].intensity = lc_rgb_scale(factor, desc->points[i].intensity);
    for (int i = 0; i < desc->directional_count; ++i)
        desc->directionals[i].irradiance = lc_rgb_scale(factor, desc->directionals[i].irradiance);
    desc->sky = lc_rgb_scale(factor, desc->sky);
}

void lc_transform_albedo(lc_scene_desc *desc, double factor)
{
    for (int i = 0; i < desc->material_count; ++i)
        for (int side = 0; side < 2; ++side) {
            lc_side *s = &desc->materials[i].side[side];
            scale_texture(&s->diffuse, factor);
            s->mirror = lc_rgb_scale(factor, s->mirror);
            s->glossy = lc_rgb_scale(factor, s->glossy);
            s->glass *= factor;
        }
}

void lc_transform_scale(lc_scene_desc *desc, double factor)
{
    for (int i = 0; i < desc->shape_count; ++i) {
        for (int k = 0; k < 12; ++k)
            desc->shapes[i].to_world.m[k / 4][k % 4] *= factor;
        desc->shapes[i].motion = lc_scale(factor, desc->shapes[i].motion);
    }
    for (int i = 0; i < desc->point_count; ++i) {
        desc->points[i].position = lc_scale(factor, desc->points[i].position);
        desc->points[i].intensity = lc_rgb_scale(factor * factor, desc->points[i].intensity);
    }
    for (int k = 0; k < 3; ++k)
        desc->camera.to_world.m[k][3] *= factor; /* it stays rigid */
    desc->camera.near_clip *= factor;
    desc->camera.far_clip *= factor;
    desc->camera.aperture_radius *= factor;
    desc->camera.focus_distance *= factor;
}

/* Shapes, points and directional lights, by any isometry. */
static void move_things(lc_scene_desc *desc, const lc_affine *isometry)
{
    for (int i = 0; i < desc->shape_count; ++i) {
        desc->shapes[i].to_world = lc_affine_multiply(isometry, &desc->shapes[i].to_world);
        desc->shapes[i].motion = lc_affine_vector(isometry, desc->shapes[i].motion);
    }
    for (int i = 0; i < desc->point_count; ++i)
        desc->points[i].position = lc_affine_point(isometry, desc->points[i].position);
    for (int i = 0; i < desc->directional_count; ++i)
        desc->directionals[i].direction =
            lc_normalize(lc_affine_vector(isometry, desc->directionals[i].direction));
}

void lc_transform_move(lc_scene_desc *desc, const lc_affine *rigid)
{
    move_things(desc, rigid);
    desc->camera.to_world = lc_affine_multiply(rigid, &desc->camera.to_world);
}

lc_affine lc_transform_axes(void)
{
    lc_affine a = {{{0, 0, 1, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}}};
    return a;
}

/* Rodrigues. */
lc_affine lc_transform_rigid(lc_vec3 axis, double angle, lc_vec3 translation)
{
    const double k[3] = {axis.x, axis.y, axis.z}, t[3] = {translation.x, translation.y, translation.z};
    const double cross[3][3] = {{0, -k[2], k[1]}, {k[2], 0, -k[0]}, {-k[1], k[0], 0}};
    lc_affine a;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            a.m[i][j] = (i == j ? cos(angle) : 0) + sin(angle) * cross[i][j] + (1 - cos(angle)) * k[i] * k[j];
        a.m[i][3] = t[i];
    }
    return a;
}

/* ---- the same in pieces ------------------------------------------------------------------------------------------ */

/* What a texture over [0, 1] is over its piece [index / count, (index + 1) / count]. */
static void cut_texture(lc_texture *t, int axis, int index, int count)
{
    t->offset[axis] += t->scale[axis] * index / count;
    t->scale[axis] /= count;
}

static int varies(const lc_material_desc *m)
{
    return m->side[0].diffuse.is_checkerboard || m->side[1].diffuse.is_checkerboard;
}

lc_status lc_transform_cut(lc_scene_desc *desc, int lamps, int columns, int rows, lc_error *err)
{
    int count = desc->shape_count;
    for (int i = 0; i < count; ++i) {
        lc_shape_desc whole = desc->shapes[i];
        /* A material belongs to many shapes: one that varies is left whole. */
        if (whole.kind != LC_RECTANGLE || (whole.emits != 0) != lamps || varies(&desc->materials[whole.material]))
            continue;
        for (int piece = 0; piece < columns * rows; ++piece) {
            int c = piece % columns, r = piece / columns;
            lc_affine part = lc_affine_identity();
            part.m[0][0] = 1.0 / columns;
            part.m[1][1] = 1.0 / rows;
            part.m[0][3] = (2.0 * c + 1) / columns - 1;
            part.m[1][3] = (2.0 * r + 1) / rows - 1;
            lc_shape_desc *shape = piece == 0 ? &desc->shapes[i] : lc_scene_desc_add_shape(desc);
            if (!shape)
                return lc_fail(err, LC_FAULT, "out of memory for the pieces of a rectangle");
            *shape = whole;
            shape->to_world = lc_affine_multiply(&whole.to_world, &part);
            cut_texture(&shape->radiance, 0, c, columns);
            cut_texture(&shape->radiance, 1, r, rows);
        }
    }
    return LC_OK;
}

int lc_transform_lights(const lc_scene_desc *desc)
{
    int count = desc->point_count + desc->directional_count + (desc->has_sky ? 1 : 0);
    for (int i = 0; i < desc->shape_count; ++i)
        count += desc->shapes[i].emits ? 1 : 0;
    return count;
}

void lc_transform_only_light(lc_scene_desc *desc, int index)
{
    int light = 0, points = desc->point_count, directionals = desc->directional_count;
    for (int i = 0; i < desc->shape_count; ++i)
        if (desc->shapes[i].emits && light++ != index)
            desc->shapes[i].emits = 0;
    desc->point_count = desc->directional_count = 0;
    for (int i = 0; i < points; ++i)
        if (light++ == index)
            desc->points[desc->point_count++] = desc->points[i];
    for (int i = 0; i < directionals; ++i)
        if (light++ == index)
            desc->directionals[desc->directional_count++] = desc->directionals[i];
    desc->has_sky = desc->has_sky && light == index;
}

void lc_transform_only_lobe(lc_scene_desc *desc, int lobe)
{
    for (int i = 0; i < desc->material_count; ++i)
        for (int side = 0; side < 2; ++side) {
            lc_side *s = &desc->materials[i].side[side];
            if (lobe != LC_DIFFUSE)
                s->diffuse = lc_texture_constant(lc_black());
            if (lobe != LC_MIRROR)
                s->mirror = lc_black();
            if (lobe != LC_GLOSSY)
                s->glossy = lc_black();
            if (lobe != LC_GLASS)
                s->glass = 0;
        }
}

/* ---- mirrors, glass, furnaces, squares ----------------------------------------------------------------------------- */

static lc_vec3 column(const lc_affine *a, int k) { return lc_vec(a->m[0][k], a->m[1][k], a->m[2][k]); }

/* x -> x - 2 n (n . (x - o)). */
static lc_affine reflection(lc_vec3 o, lc_vec3 n)
{
    const double k[3] = {n.x, n.y, n.z};
    lc_affine a;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            a.m[i][j] = (i == j ? 1 : 0) - 2 * k[i] * k[j];
        a.m[i][3] = 2 * k[i] * lc_dot(n, o);
    }
    return a;
}

void lc_transform_unfold(lc_scene_desc *desc, int shape)
{
    const lc_affine *mirror = &desc->shapes[shape].to_world;
    lc_vec3 n = lc_normalize(lc_cross(column(mirror, 0), column(mirror, 1)));
    lc_affine flip = reflection(column(mirror, 3), n);
    --desc->shape_count;
    memmove(&desc->shapes[shape], &desc->shapes[shape + 1],
            (size_t)(desc->shape_count - shape) * sizeof *desc->shapes);
    move_things(desc, &flip);
}

/* Columns x, y, z and origin o. */
static lc_affine frame(lc_vec3 x, lc_vec3 y, lc_vec3 z, lc_vec3 o)
{
    lc_affine a = {{{x.x, y.x, z.x, o.x}, {x.y, y.y, z.y, o.y}, {x.z, y.z, z.z, o.z}}};
    return a;
}

static lc_material_desc *add_material(lc_scene_desc *desc)
{
    lc_material_desc *m = lc_scene_desc_add_material(desc);
    if (m)
        m->int_ior = m->ext_ior = 1;
    return m;
}

static lc_shape_desc *add_shape(lc_scene_desc *desc, lc_shape_kind kind, lc_affine to_world)
{
    lc_shape_desc *shape = lc_scene_desc_add_shape(desc);
    if (shape) {
        shape->kind = kind;
        shape->to_world = to_world;
        shape->material = desc->material_count - 1;
    }
    return shape;
}

lc_status lc_transform_pane(lc_scene_desc *desc, double distance, lc_error *err)
{
    lc_camera_desc *camera = &desc->camera;
    lc_material_desc *glass = add_material(desc);
    if (!glass)
        return lc_fail(err, LC_FAULT, "out of memory for a pane");
    glass->side[0].glass = glass->side[1].glass = 1;
    /* Twice the larger half side, measured along either: covers any fov_axis of a square image. */
    double half = 2 * distance * tan(camera->fov * (LC_PI / 360));
    lc_vec3 x = column(&camera->to_world, 0), y = column(&camera->to_world, 1), z = column(&camera->to_world, 2);
    lc_vec3 centre = lc_add(column(&camera->to_world, 3), lc_scale(distance, z));
    if (!add_shape(desc, LC_RECTANGLE, frame(lc_scale(half, x), lc_scale(half, y), z, centre)))
        return lc_fail(err, LC_FAULT, "out of memory for a pane");
    return LC_OK;
}

lc_status lc_transform_furnace_cube(lc_scene_desc *desc, const lc_affine *pose, double rho, lc_error *err)
{
    lc_material_desc *grey = add_material(desc);
    if (!grey)
        return lc_fail(err, LC_FAULT, "out of memory for a cube");
    grey->side[0].diffuse = lc_texture_constant(lc_color(rho, rho, rho));
    lc_shape_desc *cube = add_shape(desc, LC_CUBE, *pose);
    if (!cube)
        return lc_fail(err, LC_FAULT, "out of memory for a cube");
    cube->emits = 1;
    cube->radiance = lc_texture_constant(lc_color(1 - rho, 1 - rho, 1 - rho));
    return LC_OK;
}

void lc_transform_face(lc_scene_desc *desc, int shape)
{
    const lc_affine *square = &desc->shapes[shape].to_world;
    lc_vec3 u = column(square, 0), v = column(square, 1), n = lc_normalize(lc_cross(u, v));
    if (desc->shapes[shape].flip_normals)
        n = lc_neg(n);
    lc_vec3 z = lc_neg(n), y = lc_normalize(v), x = lc_cross(y, z);
    double half = lc_length(u);
    desc->camera.to_world = frame(x, y, z, lc_add(column(square, 3), lc_scale(half, n)));
    desc->camera.fov = 90;
    desc->camera.fov_axis = LC_FOV_X;
}

void lc_transform_exchange(lc_scene_desc *desc, int lamp, int receiver)
{
    lc_shape_desc *a = &desc->shapes[lamp], *b = &desc->shapes[receiver];
    double side_a = lc_length(column(&a->to_world, 0)), side_b = lc_length(column(&b->to_world, 0));
    b->emits = 1;
    b->radiance = a->radiance;
    a->emits = 0;
    scale_texture(&b->radiance, side_a * side_a / (side_b * side_b));
    lc_transform_face(desc, lamp);
}
