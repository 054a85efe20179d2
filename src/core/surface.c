/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * What happens at a hit: following a ray, the material, what it emits.
 */
#include <stdarg.h>
#include <stdio.h>

#include "core/scene_c.h"

void lc_log(const lc_trace_log *log, const char *format, ...)
{
    char text[512];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    log->line(log->user, text);
}

static const char *shape_kind_name(const lc_scene *scene, int shape)
{
    static const char *const names[] = {"rectangle", "disk", "cube", "sphere"}; /* in the order of lc_shape_kind */
    return names[scene->desc.shapes[shape].kind];
}

void lc_log_hit(const lc_scene *scene, const char *what, const lc_hit *hit)
{
    if (hit->valid)
        lc_log(scene->log, "%s: %s of line %d at (%.9g, %.9g, %.9g), distance %.9g, n (%.6g, %.6g, %.6g)", what,
               shape_kind_name(scene, hit->shape), scene->desc.shapes[hit->shape].line, hit->p.x, hit->p.y, hit->p.z,
               hit->distance, hit->n.x, hit->n.y, hit->n.z);
    else
        lc_log(scene->log, "%s: nothing", what);
}

void lc_intersect(const lc_scene *scene, const lc_ray *ray, lc_hit *hit)
{
    hit->wo = lc_neg(ray->d);
    hit->time = ray->time;
    hit->valid = lc_accel_intersect(scene->accel, scene, ray->o, ray->d, ray->time, -1, hit);
    if (scene->log)
        lc_log_hit(scene, "camera ray hits", hit);
}

/* A scene is read by many threads, and a hit is the estimator's to copy: so a thread counts, one sample at a time. */
static __thread uint32_t ray_count;

void lc_count_ray(void) { ++ray_count; }

void lc_cost_start(void) { ray_count = 0; }

lc_rgb lc_cost_of(const lc_sampler *sampler)
{
    return lc_color(ray_count, sampler->dimension - (double)LC_DIMENSION_ESTIMATOR, 0);
}

int lc_trace(const lc_scene *scene, const lc_hit *from, lc_vec3 wi, lc_hit *next)
{
    lc_count_ray();
    double time = from->time;
    lc_vec3 start = from->p;
    int part = from->part; /* `next` may be `from` */
    next->valid = from->valid && lc_accel_intersect(scene->accel, scene, start, wi, time, part, next);
    next->wo = lc_neg(wi);
    next->time = time;
    if (scene->log)
        lc_log_hit(scene, "ray hits", next);
    return next->valid;
}

/* Only textures ask for these, and few surfaces have one: computed on demand. */
void lc_shape_uv(const lc_scene *scene, int shape, int part, lc_vec3 p, double *u, double *v)
{
    if (!scene->shapes[shape].is_round) {
        const lc_face *face = &scene->faces[part];
        lc_vec3 r = lc_sub(p, face->o);
        *u = 0.5 * (lc_dot(face->du, r) + 1.0);
        *v = 0.5 * (lc_dot(face->dv, r) + 1.0);
        return;
    }
    const lc_round *round = &scene->rounds[scene->shapes[shape].first];
    lc_vec3 r = lc_sub(p, round->o);
    double x, y;
    if (round->is_sphere) {
        double s = 1.0 / (round->radius * round->radius); /* the columns have length radius */
        double z = s * lc_dot(round->n, r);
        x = s * lc_dot(round->eu, r);
        y = s * lc_dot(round->ev, r);
        *v = atan2(sqrt(x * x + y * y), z) * LC_INV_PI;
    } else {
        x = lc_dot(round->du, r);
        y = lc_dot(round->dv, r);
        *v = sqrt(x * x + y * y);
    }
    double phi = atan2(y, x);
    *u = (phi < 0 ? phi + 2.0 * LC_PI : phi) * (0.5 * LC_INV_PI);
    if (!round->is_sphere) { /* Mitsuba's disk: u is the radius */
        double radius = *v;
        *v = *u;
        *u = radius;
    }
}

static lc_rgb texture_on(const lc_scene *scene, const lc_texture *texture, int shape, int part, lc_vec3 p)
{
    if (!texture->is_checkerboard)
        return texture->color[0];
    double u, v;
    lc_shape_uv(scene, shape, part, p, &u, &v);
    return lc_texture_at(texture, u, v);
}

static int is_front(const lc_hit *hit) { return lc_dot(hit->n, hit->wo) > 0; }

lc_material lc_surface_material(const lc_scene *scene, const lc_hit *hit)
{
    lc_material material = {{0, 0, 0}, {0, 0, 0}, 0, 1, {0, 0, 0}, 0};
    if (!hit->valid)
        return material;
    const lc_material_desc *desc = &scene->desc.materials[scene->desc.shapes[hit->shape].material];
    const lc_side *side = &desc->side[is_front(hit) ? 0 : 1];
    material.diffuse = texture_on(scene, &side->diffuse, hit->shape, hit->part, lc_rest_point(scene, hit));
    material.mirror = side->mirror;
    material.glass = side->glass;
    material.glossy = side->glossy;
    material.alpha = side->alpha;
    if (side->glass > 0)
        material.ior = is_front(hit) ? desc->int_ior / desc->ext_ior : desc->ext_ior / desc->int_ior;
    return material;
}

lc_material lc_material_at(const lc_scene *scene, const lc_hit *hit)
{
    lc_material material = lc_surface_material(scene, hit);
    if (scene->log && hit->valid)
        lc_log(scene->log,
               "material: diffuse (%.6g, %.6g, %.6g), mirror (%.6g, %.6g, %.6g), glass %.6g, ior %.6g, glossy (%.6g, "
               "%.6g, %.6g), alpha %.6g",
               material.diffuse.r, material.diffuse.g, material.diffuse.b, material.mirror.r, material.mirror.g,
               material.mirror.b, material.glass, material.ior, material.glossy.r, material.glossy.g,
               material.glossy.b, material.alpha);
    return material;
}

/* Emitted by the front of the shape at p, where p is at time 0. */
lc_rgb lc_shape_radiance(const lc_scene *scene, int shape, int part, lc_vec3 p)
{
    const lc_shape_desc *desc = &scene->desc.shapes[shape];
    return desc->emits ? texture_on(scene, &desc->radiance, shape, part, p) : lc_black();
}

lc_rgb lc_emission(const lc_scene *scene, const lc_hit *hit)
{
    lc_rgb radiance = lc_black();
    if (!hit->valid)
        radiance = scene->desc.has_sky ? scene->desc.sky : lc_black();
    else if (is_front(hit))
        radiance = lc_shape_radiance(scene, hit->shape, hit->part, lc_rest_point(scene, hit));
    if (scene->log)
        lc_log(scene->log, "emission: (%.9g, %.9g, %.9g) W sr^-1 m^-2", radiance.r, radiance.g, radiance.b);
    return radiance;
}
