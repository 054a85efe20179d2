/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/checks/family.h"

#include <stdio.h>
#include <string.h>

#include "verify/checks/transform.h"

static double within(lc_sampler *r, double low, double high) { return low + (high - low) * lc_next(r); }

static lc_rgb color_within(lc_sampler *r, double low, double high)
{
    double red = within(r, low, high), green = within(r, low, high), blue = within(r, low, high);
    return lc_color(red, green, blue);
}

static lc_vec3 direction(lc_sampler *r)
{
    double z = within(r, -1, 1), phi = within(r, 0, 2 * LC_PI), s = sqrt(1 - z * z);
    return lc_vec(s * cos(phi), s * sin(phi), z);
}

static lc_affine frame(lc_vec3 x, lc_vec3 y, lc_vec3 z, lc_vec3 o)
{
    lc_affine a = {{{x.x, y.x, z.x, o.x}, {x.y, y.y, z.y, o.y}, {x.z, y.z, z.z, o.z}}};
    return a;
}

/* +z goes to unit `z`, turned about it by `spin`, columns of length sx, sy, sz, then moved to o. */
static lc_affine pose(lc_vec3 z, double spin, double sx, double sy, double sz, lc_vec3 o)
{
    lc_vec3 helper = fabs(z.x) < 0.7 ? lc_vec(1, 0, 0) : lc_vec(0, 1, 0);
    lc_vec3 s = lc_normalize(lc_cross(helper, z)), t = lc_cross(z, s);
    lc_vec3 x = lc_add(lc_scale(cos(spin), s), lc_scale(sin(spin), t));
    return frame(lc_scale(sx, x), lc_scale(sy, lc_cross(z, x)), lc_scale(sz, z), o);
}

static lc_affine look(lc_vec3 eye, lc_vec3 target, lc_vec3 up)
{
    lc_vec3 z = lc_normalize(lc_sub(target, eye)), x = lc_normalize(lc_cross(up, z));
    return frame(x, lc_cross(z, x), z, eye);
}

/* One-sided diffuse, or with a texture; NULL without memory. */
static lc_shape_desc *add(lc_scene_desc *desc, lc_shape_kind kind, lc_affine to_world, lc_texture albedo,
                          lc_texture radiance, lc_error *err)
{
    lc_material_desc *m = lc_scene_desc_add_material(desc);
    lc_shape_desc *shape = lc_scene_desc_add_shape(desc);
    if (!m || !shape) {
        lc_fail(err, LC_FAULT, "out of memory for a scene");
        return NULL;
    }
    m->side[0].diffuse = albedo;
    m->int_ior = m->ext_ior = 1;
    shape->kind = kind;
    shape->to_world = to_world;
    shape->material = desc->material_count - 1;
    shape->radiance = radiance;
    shape->emits = lc_rgb_max(radiance.color[0]) > 0;
    return shape;
}

static lc_texture plain(lc_rgb color) { return lc_texture_constant(color); }

/* ---- lamps over a plane --------------------------------------------------------------------------------------------- */

/* A lamp over the plane z = 0, around `azimuth`, which neither touches the plane nor hides it from above. */
static lc_status add_lamp(lc_scene_desc *desc, lc_shape_kind kind, double azimuth, lc_sampler *r, lc_error *err)
{
    double away = within(r, 0.1, 0.8), height = within(r, 0.9, 1.5), tilt = within(r, 0, 0.9);
    double lean = within(r, 0, 2 * LC_PI), spin = within(r, 0, 2 * LC_PI);
    double a = within(r, 0.25, 0.6), b = within(r, 0.25, 0.6);
    if (kind == LC_SPHERE)
        b = a;
    lc_vec3 down = lc_vec(sin(tilt) * cos(lean), sin(tilt) * sin(lean), -cos(tilt));
    lc_vec3 centre = lc_vec(away * cos(azimuth), away * sin(azimuth), height);
    lc_affine to_world = pose(down, spin, a, b, kind == LC_SPHERE ? a : 1, centre);
    return add(desc, kind, to_world, plain(lc_black()), plain(color_within(r, 1, 8)), err) ? LC_OK : LC_FAULT;
}

/* Somewhere, turned somehow, ten times smaller to ten times as large. */
static void throw(lc_scene_desc *desc, lc_sampler *r)
{
    lc_vec3 axis = direction(r), to = lc_scale(within(r, 0, 3), direction(r));
    lc_affine rigid = lc_transform_rigid(axis, within(r, 0, LC_PI), to);
    lc_transform_move(desc, &rigid);
    lc_transform_scale(desc, pow(10, within(r, -1, 1)));
}

static lc_status over_plane(lc_scene_desc *desc, const lc_shape_kind *kinds, int count, lc_sampler *r, lc_error *err)
{
    double azimuth = within(r, 0, 2 * LC_PI), elevation = within(r, 0.7, 1.2), far = within(r, 2.2, 3);
    lc_vec3 eye = lc_vec(far * cos(elevation) * cos(azimuth), far * cos(elevation) * sin(azimuth),
                         far * sin(elevation));
    lc_vec3 target = lc_vec(within(r, -0.3, 0.3), within(r, -0.3, 0.3), 0);
    desc->camera.to_world = look(eye, target, lc_vec(0, 0, 1));
    desc->camera.fov = within(r, 25, 40);
    if (!add(desc, LC_RECTANGLE, pose(lc_vec(0, 0, 1), within(r, 0, LC_PI), 4, 3, 1, lc_vec(0, 0, 0)),
             plain(color_within(r, 0.2, 0.9)), plain(lc_black()), err))
        return LC_FAULT;
    lc_status status = LC_OK;
    /* One lamp stands where the camera does not; several share the circle, so that none cuts another. */
    for (int i = 0; i < count && status == LC_OK; ++i) {
        double at = azimuth + LC_PI + (count == 1 ? within(r, -1.2, 1.2) : 2 * LC_PI * i / count);
        status = add_lamp(desc, kinds[i], at, r, err);
    }
    throw(desc, r);
    return status;
}

static lc_status make_rectangle(lc_scene_desc *desc, lc_sampler *r, lc_error *err)
{
    static const lc_shape_kind kinds[] = {LC_RECTANGLE};
    return over_plane(desc, kinds, 1, r, err);
}

static lc_status make_disk(lc_scene_desc *desc, lc_sampler *r, lc_error *err)
{
    static const lc_shape_kind kinds[] = {LC_DISK};
    return over_plane(desc, kinds, 1, r, err);
}

static lc_status make_sphere(lc_scene_desc *desc, lc_sampler *r, lc_error *err)
{
    static const lc_shape_kind kinds[] = {LC_SPHERE};
    return over_plane(desc, kinds, 1, r, err);
}

/* A rectangle, a disk and a ball of unequal size and radiance; far enough apart not to touch. */
static lc_status make_lights(lc_scene_desc *desc, lc_sampler *r, lc_error *err)
{
    double azimuth = within(r, 0, 2 * LC_PI);
    static const lc_shape_kind kinds[] = {LC_RECTANGLE, LC_DISK, LC_SPHERE};
    desc->camera.to_world = look(lc_vec(0, 0, within(r, 0.4, 0.6)), lc_vec(0.2 * cos(azimuth), 0.2 * sin(azimuth), 0),
                                 lc_vec(cos(azimuth), sin(azimuth), 0.1));
    desc->camera.fov = within(r, 50, 80);
    if (!add(desc, LC_RECTANGLE, pose(lc_vec(0, 0, 1), within(r, 0, LC_PI), 4, 3, 1, lc_vec(0, 0, 0)),
             plain(color_within(r, 0.2, 0.9)), plain(lc_black()), err))
        return LC_FAULT;
    for (int i = 0; i < 3; ++i) {
        double at = azimuth + 2 * LC_PI * i / 3, size = within(r, 0.15, 0.5), tilt = within(r, 0, 0.9);
        double lean = within(r, 0, 2 * LC_PI);
        lc_vec3 down = lc_vec(sin(tilt) * cos(lean), sin(tilt) * sin(lean), -cos(tilt));
        lc_vec3 centre = lc_vec(cos(at), sin(at), within(r, 0.8, 1.2));
        double longer = kinds[i] == LC_SPHERE ? size : size * within(r, 1, 1.4);
        lc_affine to_world = pose(down, within(r, 0, LC_PI), size, longer, kinds[i] == LC_SPHERE ? size : 1, centre);
        if (!add(desc, kinds[i], to_world, plain(lc_black()), plain(color_within(r, 1, 8)), err))
            return LC_FAULT;
    }
    throw(desc, r);
    return LC_OK;
}

/* A ball, a box, a rectangle or an ellipse of half sizes about `size`, turned anyhow, but what is flat by at most a radian from `lamp`: it
 * reaches no farther than 1.75 times that. */
static lc_status add_blocker(lc_scene_desc *desc, lc_vec3 centre, lc_vec3 lamp, double size, lc_sampler *r, lc_error *err)
{
    static const lc_shape_kind kinds[] = {LC_SPHERE, LC_CUBE, LC_RECTANGLE, LC_DISK};
    lc_shape_kind kind = kinds[(int)(4 * lc_next(r))];
    double a = within(r, 0.6, 1) * size, b = within(r, 0.6, 1) * size, c = within(r, 0.6, 1) * size;
    if (kind == LC_SPHERE)
        a = b = c = 1.4 * a;
    lc_vec3 z = direction(r), towards = lc_normalize(lc_sub(lamp, centre));
    int is_flat = kind == LC_RECTANGLE || kind == LC_DISK;
    if (is_flat) /* 0.84: sine of a radian */
        z = lc_normalize(lc_add(towards, lc_scale(0.84, z)));
    lc_affine to_world = pose(z, within(r, 0, 2 * LC_PI), a, b, is_flat ? 1 : c, centre);
    if (!add(desc, kind, to_world, plain(color_within(r, 0.2, 0.9)), plain(lc_black()), err))
        return LC_FAULT;
    desc->materials[desc->material_count - 1].side[1] = desc->materials[desc->material_count - 1].side[0];
    return LC_OK;
}

/* A lamp of any kind and something between it and the plane, whose shadow falls where the camera looks. */
static lc_status make_occluder(lc_scene_desc *desc, lc_sampler *r, lc_error *err)
{
    static const lc_shape_kind kinds[] = {LC_RECTANGLE, LC_DISK, LC_SPHERE};
    double azimuth = within(r, 0, 2 * LC_PI), elevation = within(r, 0.7, 1.1), far = within(r, 2.2, 3);
    double across = azimuth + LC_PI + within(r, -1.2, 1.2), away = within(r, 0.3, 0.9), tilt = within(r, 0, 0.7);
    lc_shape_kind kind = kinds[(int)(3 * lc_next(r))];
    lc_vec3 eye = lc_vec(far * cos(elevation) * cos(azimuth), far * cos(elevation) * sin(azimuth),
                         far * sin(elevation));
    lc_vec3 target = lc_vec(within(r, -0.3, 0.3), within(r, -0.3, 0.3), 0);
    lc_vec3 lamp = lc_vec(away * cos(across), away * sin(across), within(r, 1.5, 1.9));
    lc_vec3 shadow = lc_add(target, lc_vec(within(r, -0.2, 0.2), within(r, -0.2, 0.2), 0));
    double a = within(r, 0.2, 0.45), b = kind == LC_SPHERE ? a : within(r, 0.2, 0.45), lean = within(r, 0, 2 * LC_PI);
    lc_vec3 down = lc_vec(sin(tilt) * cos(lean), sin(tilt) * sin(lean), -cos(tilt));
    desc->camera.to_world = look(eye, target, lc_vec(0, 0, 1));
    desc->camera.fov = within(r, 25, 40);
    lc_affine plane = pose(lc_vec(0, 0, 1), within(r, 0, LC_PI), 4, 3, 1, lc_vec(0, 0, 0));
    lc_affine to_world = pose(down, within(r, 0, 2 * LC_PI), a, b, kind == LC_SPHERE ? a : 1, lamp);
    if (!add(desc, LC_RECTANGLE, plane, plain(color_within(r, 0.2, 0.9)), plain(lc_black()), err) ||
        !add(desc, kind, to_world, plain(lc_black()), plain(color_within(r, 1, 8)), err))
        return LC_FAULT;
    double height = within(r, 0.35, 0.55) / lamp.z;
    lc_vec3 centre = lc_add(shadow, lc_scale(height, lc_sub(lamp, shadow)));
    lc_status status = add_blocker(desc, centre, lamp, within(r, 0.11, 0.16), r, err);
    throw(desc, r);
    return status;
}

/* ---- inside of a sphere ----------------------------------------------------------------------------------------------- */

static lc_texture checkers(lc_sampler *r, double low, double high)
{
    lc_texture t = {1, {{0, 0, 0}, {0, 0, 0}}, {0, 0}, {0, 0}};
    t.color[0] = color_within(r, low, high);
    t.color[1] = color_within(r, low, high);
    for (int i = 0; i < 2; ++i) {
        t.scale[i] = within(r, 1, 3 - i);
        t.offset[i] = within(r, 0, 1);
    }
    return t;
}

static lc_status make_furnace(lc_scene_desc *desc, lc_sampler *r, lc_error *err)
{
    lc_affine to_world = pose(direction(r), within(r, 0, 2 * LC_PI), 1, 1, 1, lc_vec(0, 0, 0));
    lc_texture albedo = checkers(r, 0.2, 0.8), radiance = checkers(r, 0.1, 1); /* what a file can say */
    lc_shape_desc *sphere = add(desc, LC_SPHERE, to_world, albedo, radiance, err);
    if (!sphere)
        return LC_FAULT;
    sphere->flip_normals = 1; /* emits inwards */
    lc_vec3 eye = lc_scale(within(r, 0, 0.6), direction(r)), towards = direction(r);
    lc_vec3 up = fabs(towards.z) < 0.7 ? lc_vec(0, 0, 1) : lc_vec(1, 0, 0);
    desc->camera.to_world = look(eye, lc_add(eye, towards), up);
    desc->camera.fov = 70;
    throw(desc, r);
    return LC_OK;
}

/* ---- mirrors and glass, in the frames of mirror_corridor and glass_slab ------------------------------------------------- */

static lc_status make_corridor(lc_scene_desc *desc, lc_sampler *r, lc_error *err)
{
    for (int i = 0; i < 2; ++i) {
        lc_affine wall = pose(lc_vec(i ? -1 : 1, 0, 0), 0, 40, 40, 1, lc_vec(i ? 1 : -1, 0, 0));
        if (!add(desc, LC_RECTANGLE, wall, plain(lc_black()), plain(lc_black()), err))
            return LC_FAULT;
        desc->materials[i].side[0].mirror = color_within(r, 0.4, 0.98);
    }
    lc_affine floor = pose(lc_vec(0, 0, 1), 0, 1, 1, 1, lc_vec(0, 0, -3));
    floor.m[0][0] = 1, floor.m[0][1] = 0, floor.m[1][0] = 0, floor.m[1][1] = 40;
    if (!add(desc, LC_RECTANGLE, floor, plain(lc_black()), plain(color_within(r, 1, 4)), err))
        return LC_FAULT;
    double down = within(r, 0.6, 0.75);
    lc_vec3 eye = lc_vec(within(r, -0.3, 0.2), within(r, -0.3, 0.3), within(r, 0, 0.8));
    desc->camera.to_world =
        look(eye, lc_add(eye, lc_vec(-cos(down), within(r, -0.3, 0.3), -sin(down))), lc_vec(0, 0, 1));
    desc->camera.fov = within(r, 20, 30);
    throw(desc, r);
    return LC_OK;
}

static lc_status make_slab(lc_scene_desc *desc, lc_sampler *r, lc_error *err)
{
    lc_affine slab = pose(lc_vec(0, 0, 1), 0, 400, 400, within(r, 0.1, 0.4), lc_vec(0, 0, 0));
    lc_affine lamp = pose(lc_vec(0, 0, 1), 0, 400, 400, 1, lc_vec(0, 0, -1));
    if (!add(desc, LC_CUBE, slab, plain(lc_black()), plain(lc_black()), err) ||
        !add(desc, LC_RECTANGLE, lamp, plain(lc_black()), plain(color_within(r, 1, 4)), err))
        return LC_FAULT;
    desc->materials[0].side[0].glass = desc->materials[0].side[1].glass = 1;
    desc->materials[0].int_ior = within(r, 1.2, 2.2);
    double angle = within(r, 0, 0.7), azimuth = within(r, 0, 2 * LC_PI);
    lc_vec3 towards = lc_vec(sin(angle) * cos(azimuth), sin(angle) * sin(azimuth), -cos(angle)), eye = lc_vec(0, 0, 3);
    desc->camera.to_world = look(eye, lc_add(eye, towards), lc_vec(cos(azimuth), sin(azimuth), 0.2));
    desc->camera.fov = within(r, 20, 60);
    throw(desc, r);
    return LC_OK;
}

const lc_family lc_families[] = {
    {"random_rectangle", "a rectangular lamp of any size and pose over a plane", make_rectangle},
    {"random_disk", "an elliptic lamp of any size and pose over a plane", make_disk},
    {"random_sphere", "a ball that shines over a plane", make_sphere},
    {"random_lights", "a rectangle, an ellipse and a ball, unequal, over a plane", make_lights},
    {"random_occluder", "a lamp over a plane, and a ball, a box, a rectangle or an ellipse before it", make_occluder},
    {"random_furnace", "the inside of a sphere, emission and albedo in checkers", make_furnace},
    {"random_corridor", "two mirrors of any tint and a lamp, in any pose", make_corridor},
    {"random_slab", "a slab of glass of any index, in any pose", make_slab},
    {NULL, NULL, NULL},
};

const lc_family *lc_family_find(const char *name)
{
    for (const lc_family *f = lc_families; f->name; ++f)
        if (strcmp(f->name, name) == 0)
            return f;
    return NULL;
}

lc_status lc_family_describe(lc_scene_desc *out, const lc_family *family, uint64_t seed, lc_error *err)
{
    lc_sampler random;
    lc_scene_desc_init(out);
    lc_sampler_start(&random, seed, lc_arm(family->name), 0, 0);
    snprintf(out->name, sizeof out->name, "%s", family->name);
    out->width = out->height = 32;
    out->camera.fov_axis = LC_FOV_X;
    lc_status status = family->make(out, &random, err);
    if (status != LC_OK)
        lc_scene_desc_release(out);
    return status;
}
