/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * From a description to a scene that can be traced: shapes become flat faces and round parts, emitters a list of lights.
 */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/scene_c.h"

static int finite_affine(const lc_affine *a)
{
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 4; ++j)
            if (!isfinite(a->m[i][j]))
                return 0;
    return 1;
}

static int is_black(lc_rgb c) { return c.r == 0 && c.g == 0 && c.b == 0; }

static int texture_is_black(const lc_texture *t)
{
    return is_black(t->color[0]) && (!t->is_checkerboard || is_black(t->color[1]));
}

/* A normal goes by the inverse transpose: for det < 0 it points to the other side of eu x ev. */
static lc_vec3 face_normal(const lc_affine *to_world, lc_vec3 eu, lc_vec3 ev, int flip)
{
    double sign = (lc_affine_determinant(to_world) < 0) != (flip != 0) ? -1.0 : 1.0;
    return lc_scale(sign, lc_normalize(lc_cross(eu, ev)));
}

/* du, dv with du.eu = dv.ev = 1, du.ev = dv.eu = 0. */
static void dual(lc_vec3 eu, lc_vec3 ev, lc_vec3 *du, lc_vec3 *dv)
{
    lc_vec3 c = lc_cross(eu, ev);
    double s = 1.0 / lc_dot(c, c);
    *du = lc_scale(s, lc_cross(ev, c));
    *dv = lc_scale(s, lc_cross(c, eu));
}

static void make_face(lc_face *face, const lc_shape_desc *desc, int shape, lc_vec3 o, lc_vec3 u, lc_vec3 v)
{
    face->o = lc_affine_point(&desc->to_world, o);
    face->eu = lc_affine_vector(&desc->to_world, u);
    face->ev = lc_affine_vector(&desc->to_world, v);
    face->n = face_normal(&desc->to_world, face->eu, face->ev, desc->flip_normals);
    dual(face->eu, face->ev, &face->du, &face->dv);
    face->area = 4.0 * lc_length(lc_cross(face->eu, face->ev));
    face->shape = shape;
}

static void make_cube(lc_face faces[6], const lc_shape_desc *desc, int shape)
{
    const lc_vec3 axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < 6; ++i) { /* u x v is the outward side */
        lc_vec3 out = lc_scale(i % 2 ? -1.0 : 1.0, axis[i / 2]), u = axis[(i / 2 + 1) % 3];
        make_face(&faces[i], desc, shape, out, u, lc_cross(out, u));
    }
}

static void make_round(lc_round *round, const lc_shape_desc *desc, int shape)
{
    const lc_affine *m = &desc->to_world;
    round->is_sphere = desc->kind == LC_SPHERE;
    round->o = lc_affine_point(m, lc_vec(0, 0, 0));
    round->eu = lc_affine_vector(m, lc_vec(1, 0, 0));
    round->ev = lc_affine_vector(m, lc_vec(0, 1, 0));
    round->sign = desc->flip_normals ? -1.0 : 1.0;
    round->shape = shape;
    round->motion = desc->motion;
    if (round->is_sphere) {
        round->radius = lc_length(round->eu); /* not cbrt(det), which rounds otherwise at another scale */
        round->n = lc_affine_vector(m, lc_vec(0, 0, 1));
        round->area = 4.0 * LC_PI * round->radius * round->radius;
    } else {
        round->n = face_normal(m, round->eu, round->ev, desc->flip_normals);
        dual(round->eu, round->ev, &round->du, &round->dv);
        round->area = LC_PI * lc_length(lc_cross(round->eu, round->ev));
    }
}

static void make_shapes(lc_scene *scene)
{
    for (int i = 0; i < scene->desc.shape_count; ++i) {
        const lc_shape_desc *desc = &scene->desc.shapes[i];
        lc_shape *shape = &scene->shapes[i];
        scene->moves |= lc_length(desc->motion) > 0;
        shape->is_round = desc->kind == LC_DISK || desc->kind == LC_SPHERE;
        shape->first = shape->is_round ? scene->round_count : scene->face_count;
        shape->count = desc->kind == LC_CUBE ? 6 : 1;
        if (shape->is_round) {
            make_round(&scene->rounds[scene->round_count++], desc, i);
            shape->area = scene->rounds[shape->first].area;
            continue;
        }
        if (desc->kind == LC_CUBE)
            make_cube(&scene->faces[shape->first], desc, i);
        else
            make_face(&scene->faces[shape->first], desc, i, lc_vec(0, 0, 0), lc_vec(1, 0, 0), lc_vec(0, 1, 0));
        scene->face_count += shape->count;
        for (int f = 0; f < shape->count; ++f)
            shape->area += scene->faces[shape->first + f].area;
    }
}

static void make_lights(lc_scene *scene)
{
    const lc_scene_desc *desc = &scene->desc;
    double area = 0.0;
    for (int i = 0; i < desc->shape_count; ++i) {
        if (!desc->shapes[i].emits)
            continue;
        if (!texture_is_black(&desc->shapes[i].radiance))
            scene->emitters |= LC_AREA;
        scene->area_to[scene->light_count] = area += scene->shapes[i].area;
        scene->lights[scene->light_count++] = (lc_light){LC_LIGHT_AREA, i};
    }
    for (int i = 0; i < desc->point_count; ++i) {
        if (!is_black(desc->points[i].intensity))
            scene->emitters |= LC_POINT;
        scene->area_to[scene->light_count] = area;
        scene->lights[scene->light_count++] = (lc_light){LC_LIGHT_POINT, i};
    }
    for (int i = 0; i < desc->directional_count; ++i) {
        if (!is_black(desc->directionals[i].irradiance))
            scene->emitters |= LC_DIRECTIONAL;
        scene->area_to[scene->light_count] = area;
        scene->lights[scene->light_count++] = (lc_light){LC_LIGHT_DIRECTIONAL, i};
    }
    if (desc->has_sky && !is_black(desc->sky))
        scene->emitters |= LC_SKY;
}

static void find_lobes(lc_scene *scene)
{
    for (int i = 0; i < scene->desc.shape_count; ++i) {
        const lc_material_desc *m = &scene->desc.materials[scene->desc.shapes[i].material];
        for (int side = 0; side < 2; ++side) {
            scene->lobes |= texture_is_black(&m->side[side].diffuse) ? 0 : LC_DIFFUSE;
            scene->lobes |= is_black(m->side[side].mirror) ? 0 : LC_MIRROR;
            scene->lobes |= m->side[side].glass > 0 ? LC_GLASS : 0;
            scene->lobes |= is_black(m->side[side].glossy) ? 0 : LC_GLOSSY;
        }
    }
}

static lc_status check_description(const lc_scene_desc *desc, lc_error *err)
{
    if (desc->width < 1 || desc->height < 1 || desc->width > LC_MAX_SIZE || desc->height > LC_MAX_SIZE)
        return lc_fail(err, LC_BAD_INPUT, "%s: image of %d x %d pixels, expected 1 to %d each", desc->name, desc->width,
                       desc->height, LC_MAX_SIZE);
    if (!finite_affine(&desc->camera.to_world) || !(desc->camera.fov > 0 && desc->camera.fov < 180))
        return lc_fail(err, LC_BAD_INPUT, "%s: the camera's to_world must be finite and its fov between 0 and 180",
                       desc->name);
    if (!(desc->camera.aperture_radius >= 0 && isfinite(desc->camera.aperture_radius)) ||
        (desc->camera.aperture_radius > 0 && !(desc->camera.focus_distance > 0 && isfinite(desc->camera.focus_distance))))
        return lc_fail(err, LC_BAD_INPUT,
                       "%s: a lens of aperture_radius %g and focus_distance %g, expected finite and positive numbers",
                       desc->name, desc->camera.aperture_radius, desc->camera.focus_distance);
    for (int i = 0; i < desc->shape_count; ++i) {
        const lc_shape_desc *shape = &desc->shapes[i];
        if (!finite_affine(&shape->to_world) || lc_affine_determinant(&shape->to_world) == 0)
            return lc_fail(err, LC_BAD_INPUT, "%s:%d: to_world is singular or not finite", desc->name, shape->line);
        if (!isfinite(lc_length(shape->motion)))
            return lc_fail(err, LC_BAD_INPUT, "%s:%d: motion is not finite", desc->name, shape->line);
        if (shape->material < 0 || shape->material >= desc->material_count)
            return lc_fail(err, LC_BAD_INPUT, "%s:%d: the shape has no material", desc->name, shape->line);
        for (int side = 0; side < 2; ++side) {
            const lc_side *s = &desc->materials[shape->material].side[side];
            if (!is_black(s->glossy) && !(s->alpha > 0 && s->alpha <= 1))
                return lc_fail(err, LC_BAD_INPUT, "%s:%d: roughness %g of the shape's material, expected (0, 1]",
                               desc->name, shape->line, s->alpha);
        }
    }
    return LC_OK;
}

lc_status lc_scene_build(lc_scene **out, const lc_scene_desc *desc, lc_error *err)
{
    *out = NULL;
    lc_status status = check_description(desc, err);
    if (status != LC_OK)
        return status;
    lc_scene *scene = calloc(1, sizeof *scene);
    if (!scene)
        return lc_fail(err, LC_FAULT, "out of memory for the scene");
    status = lc_scene_desc_copy(&scene->desc, desc, err);
    if (status != LC_OK)
        goto cleanup;
    size_t shapes = (size_t)desc->shape_count + 1;
    size_t lights = shapes + (size_t)desc->point_count + (size_t)desc->directional_count;
    scene->shapes = calloc(shapes, sizeof *scene->shapes);
    scene->faces = calloc(6 * shapes, sizeof *scene->faces);
    scene->rounds = calloc(shapes, sizeof *scene->rounds);
    scene->lights = calloc(lights, sizeof *scene->lights);
    scene->area_to = calloc(lights, sizeof *scene->area_to);
    if (!scene->shapes || !scene->faces || !scene->rounds || !scene->lights || !scene->area_to) {
        status = lc_fail(err, LC_FAULT, "out of memory for the scene");
        goto cleanup;
    }
    make_shapes(scene);
    make_lights(scene);
    find_lobes(scene);
    status = lc_accel_build(&scene->accel, scene, err);
cleanup:
    if (status == LC_OK)
        *out = scene;
    else
        lc_scene_free(scene);
    return status;
}

void lc_scene_free(lc_scene *scene)
{
    if (!scene)
        return;
    lc_accel_free(scene->accel);
    lc_scene_desc_release(&scene->desc);
    free(scene->shapes);
    free(scene->faces);
    free(scene->rounds);
    free(scene->lights);
    free(scene->area_to);
    free(scene);
}

const lc_scene_desc *lc_scene_description(const lc_scene *scene) { return &scene->desc; }
unsigned lc_scene_lobes(const lc_scene *scene) { return scene->lobes; }
unsigned lc_scene_emitters(const lc_scene *scene) { return scene->emitters; }
double lc_scene_emitting_area(const lc_scene *scene)
{
    return scene->light_count ? scene->area_to[scene->light_count - 1] : 0.0;
}
