/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The description of a scene: plain data that owns four growing arrays. */
#include <stdlib.h>
#include <string.h>

#include "core/host.h"

void lc_scene_desc_init(lc_scene_desc *desc)
{
    memset(desc, 0, sizeof *desc);
    desc->camera.to_world = lc_affine_identity();
    /* Mitsuba's default: a 50 mm lens on 36 mm x 24 mm film, measured along the diagonal. */
    desc->camera.fov = 2 * atan(sqrt(36. * 36. + 24. * 24.) / (2 * 50.)) * 180 / LC_PI;
    desc->camera.fov_axis = LC_FOV_DIAGONAL;
    desc->camera.far_clip = INFINITY;
    desc->width = desc->height = 64;
    desc->samples = 16;
    desc->max_bounces = -1;
}

void lc_scene_desc_release(lc_scene_desc *desc)
{
    free(desc->materials);
    free(desc->shapes);
    free(desc->points);
    free(desc->directionals);
    lc_scene_desc_init(desc);
}

/* An array of `count` elements always has room for the next power of two: no capacity to store. */
static size_t capacity(int count)
{
    size_t c = 1;
    while (c < (size_t)count)
        c *= 2;
    return c;
}

static void *append(void *array, int *count, size_t size)
{
    if (*count == 0 || capacity(*count) == (size_t)*count) {
        array = realloc(array, capacity(*count + 1) * size);
        if (!array)
            return NULL;
    }
    memset((char *)array + (size_t)*count * size, 0, size);
    ++*count;
    return array;
}

lc_material_desc *lc_scene_desc_add_material(lc_scene_desc *desc)
{
    lc_material_desc *array = append(desc->materials, &desc->material_count, sizeof *array);
    if (!array)
        return NULL;
    desc->materials = array;
    return &array[desc->material_count - 1];
}

lc_shape_desc *lc_scene_desc_add_shape(lc_scene_desc *desc)
{
    lc_shape_desc *array = append(desc->shapes, &desc->shape_count, sizeof *array);
    if (!array)
        return NULL;
    desc->shapes = array;
    return &array[desc->shape_count - 1];
}

lc_point_desc *lc_scene_desc_add_point(lc_scene_desc *desc)
{
    lc_point_desc *array = append(desc->points, &desc->point_count, sizeof *array);
    if (!array)
        return NULL;
    desc->points = array;
    return &array[desc->point_count - 1];
}

lc_directional_desc *lc_scene_desc_add_directional(lc_scene_desc *desc)
{
    lc_directional_desc *array = append(desc->directionals, &desc->directional_count, sizeof *array);
    if (!array)
        return NULL;
    desc->directionals = array;
    return &array[desc->directional_count - 1];
}

/* A copy of the array, NULL for an empty one; *ok becomes 0 without memory. */
static void *copy(const void *array, int count, size_t size, int *ok)
{
    if (count == 0)
        return NULL;
    void *out = malloc(capacity(count) * size);
    if (out)
        memcpy(out, array, (size_t)count * size);
    else
        *ok = 0;
    return out;
}

/* `out` may be uninitialised; after a failure it is empty. */
lc_status lc_scene_desc_copy(lc_scene_desc *out, const lc_scene_desc *desc, lc_error *err)
{
    int ok = 1;
    *out = *desc;
    out->materials = copy(desc->materials, desc->material_count, sizeof *desc->materials, &ok);
    out->shapes = copy(desc->shapes, desc->shape_count, sizeof *desc->shapes, &ok);
    out->points = copy(desc->points, desc->point_count, sizeof *desc->points, &ok);
    out->directionals = copy(desc->directionals, desc->directional_count, sizeof *desc->directionals, &ok);
    if (ok)
        return LC_OK;
    lc_scene_desc_release(out);
    return lc_fail(err, LC_FAULT, "scene '%s': out of memory while copying its description", desc->name);
}

lc_texture lc_texture_constant(lc_rgb color)
{
    lc_texture texture = {0, {color, color}, {1, 1}, {0, 0}};
    return texture;
}

/* x - floor(x), without a call; a number so large that it has no fraction gives 0. */
static double fraction(double x)
{
    if (!(fabs(x) < 0x1p52))
        return 0;
    double rest = x - (double)(int64_t)x;
    return rest < 0 ? rest + 1 : rest;
}

lc_rgb lc_texture_at(const lc_texture *texture, double u, double v)
{
    if (!texture->is_checkerboard)
        return texture->color[0];
    u = u * texture->scale[0] + texture->offset[0];
    v = v * texture->scale[1] + texture->offset[1];
    return texture->color[(fraction(u) > 0.5) != (fraction(v) > 0.5)];
}
