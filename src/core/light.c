/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Points on lights, and whether they can be seen.
 */
#include "core/scene_c.h"

int lc_light_count(const lc_scene *scene) { return scene->light_count; }

static void sample_face(const lc_face *face, double u, double v, lc_light_sample *out)
{
    out->p = lc_add(face->o, lc_add(lc_scale(2.0 * u - 1.0, face->eu), lc_scale(2.0 * v - 1.0, face->ev)));
    out->n = face->n;
}

static void sample_round(const lc_round *round, double u, double v, lc_light_sample *out)
{
    if (round->is_sphere) {
        lc_vec3 r = lc_uniform_sphere(u, v);
        out->p = lc_add(round->o, lc_scale(round->radius, r));
        out->n = lc_scale(round->sign, r);
    } else {
        double r = sqrt(u), phi = 2.0 * LC_PI * v;
        out->p = lc_add(round->o, lc_add(lc_scale(r * cos(phi), round->eu), lc_scale(r * sin(phi), round->ev)));
        out->n = round->n;
    }
}

/* A point of the shape uniform over its area. Of a cube, u picks the side and is stretched again. */
static void sample_shape(const lc_scene *scene, int index, double u, double v, lc_light_sample *out)
{
    const lc_shape *shape = &scene->shapes[index];
    out->shape = index;
    if (shape->is_round) {
        out->part = scene->face_count + shape->first;
        sample_round(&scene->rounds[shape->first], u, v, out);
        return;
    }
    int part = shape->first, last = shape->first + shape->count - 1;
    double area = u * shape->area;
    while (part < last && area >= scene->faces[part].area)
        area -= scene->faces[part++].area;
    out->part = part;
    sample_face(&scene->faces[part], shape->count > 1 ? fmin(area / scene->faces[part].area, 1.0) : u, v, out);
}

static void log_light(const lc_scene *scene, const lc_light_sample *s)
{
    if (s->is_delta)
        lc_log(scene->log, "light: wi (%.9g, %.9g, %.9g), distance %.9g, irradiance (%.9g, %.9g, %.9g) W m^-2", s->wi.x,
               s->wi.y, s->wi.z, s->distance, s->irradiance.r, s->irradiance.g, s->irradiance.b);
    else
        lc_log(scene->log,
               "light: shape of line %d at (%.9g, %.9g, %.9g), n (%.6g, %.6g, %.6g), distance %.9g, pdf_area %.9g, "
               "radiance (%.9g, %.9g, %.9g)",
               scene->desc.shapes[s->shape].line, s->p.x, s->p.y, s->p.z, s->n.x, s->n.y, s->n.z, s->distance,
               s->pdf_area, s->radiance.r, s->radiance.g, s->radiance.b);
}

static void sample_area(const lc_scene *scene, int shape, double pdf_area, const lc_hit *hit, lc_sampler *sampler,
                        lc_light_sample *out)
{
    double u = lc_next(sampler), v = lc_next(sampler);
    sample_shape(scene, shape, u, v, out);
    out->radiance = lc_shape_radiance(scene, shape, out->part, out->p);
    if (scene->moves)
        out->p = lc_add(out->p, lc_shape_shift(scene, shape, hit->time));
    lc_vec3 to = lc_sub(out->p, hit->p);
    out->is_delta = 0;
    out->distance = lc_length(to);
    out->wi = lc_scale(1.0 / out->distance, to);
    out->irradiance = lc_black();
    out->pdf_area = pdf_area;
    out->pdf_solid = 0.0;
}

static void sample_delta(const lc_scene *scene, const lc_light *light, const lc_hit *hit, lc_light_sample *out)
{
    out->is_delta = 1;
    out->shape = out->part = -1;
    out->radiance = lc_black();
    out->pdf_area = out->pdf_solid = 0.0;
    if (light->kind == LC_LIGHT_POINT) {
        const lc_point_desc *point = &scene->desc.points[light->index];
        lc_vec3 to = lc_sub(point->position, hit->p);
        out->p = point->position;
        out->distance = lc_length(to);
        out->wi = lc_scale(1.0 / out->distance, to);
        out->irradiance = lc_rgb_scale(1.0 / (out->distance * out->distance), point->intensity);
    } else {
        const lc_directional_desc *directional = &scene->desc.directionals[light->index];
        out->p = hit->p;
        out->distance = INFINITY;
        out->wi = lc_neg(directional->direction);
        out->irradiance = directional->irradiance;
    }
    out->n = lc_neg(out->wi);
}

void lc_light_sample_one(const lc_scene *scene, int i, const lc_hit *hit, lc_sampler *sampler, lc_light_sample *out)
{
    const lc_light *light = &scene->lights[i];
    if (light->kind == LC_LIGHT_AREA)
        sample_area(scene, light->index, 1.0 / scene->shapes[light->index].area, hit, sampler, out);
    else
        sample_delta(scene, light, hit, out);
    if (scene->log)
        log_light(scene, out);
}

void lc_light_sample_solid(const lc_scene *scene, int i, const lc_hit *hit, lc_sampler *sampler, lc_light_sample *out)
{
    const lc_light *light = &scene->lights[i];
    if (light->kind != LC_LIGHT_AREA) {
        sample_delta(scene, light, hit, out);
    } else {
        lc_sampler start = *sampler;
        sample_area(scene, light->index, 1.0 / scene->shapes[light->index].area, hit, sampler, out);
        double u = lc_next(&start), v = lc_next(&start), cos_light = -lc_dot(out->n, out->wi);
        out->pdf_solid = cos_light > 0 ? out->pdf_area * out->distance * out->distance / cos_light : 0.0;
        lc_hit seen = *hit; /* a moving light is sampled at rest, from where it is seen so */
        lc_vec3 shift = lc_shape_shift(scene, light->index, hit->time);
        if (scene->moves)
            seen.p = lc_sub(hit->p, shift);
        if (lc_sample_solid(scene, light->index, &seen, u, v, out)) {
            out->radiance = lc_shape_radiance(scene, light->index, out->part, out->p);
            if (scene->moves)
                out->p = lc_add(out->p, shift);
            out->pdf_area = 0.0; /* another density than by area */
        }
    }
    if (scene->log)
        log_light(scene, out);
}

int lc_light_sample_union(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_light_sample *out)
{
    double total = lc_scene_emitting_area(scene);
    if (!(total > 0))
        return 0;
    double area = lc_next(sampler) * total;
    int i = 0;
    while (area >= scene->area_to[i]) /* area < total: ends at a light that has area */
        ++i;
    sample_area(scene, scene->lights[i].index, 1.0 / total, hit, sampler, out);
    if (scene->log)
        log_light(scene, out);
    return 1;
}

double lc_light_pdf_area(const lc_scene *scene, const lc_hit *hit)
{
    double pdf_area = hit->valid && scene->desc.shapes[hit->shape].emits ? 1.0 / scene->shapes[hit->shape].area : 0.0;
    if (scene->log)
        lc_log(scene->log, "light pdf: pdf_area %.9g 1/m^2", pdf_area);
    return pdf_area;
}

int lc_visible(const lc_scene *scene, const lc_hit *hit, const lc_light_sample *light)
{
    lc_count_ray();
    int to_infinity = isinf(light->distance);
    int visible =
        hit->valid && !lc_accel_occluded(scene->accel, scene, hit->p, hit->part, to_infinity ? light->wi : light->p,
                                         light->part, light->n, to_infinity, hit->time);
    if (scene->log)
        lc_log(scene->log, "visible: %s", visible ? "yes" : "no");
    return visible;
}
