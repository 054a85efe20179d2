/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Lights for POV-Ray. Its diffuse surface of pigment rho under a light_source of colour C shows rho C cos: C is irradiance over pi.
 *
 * A light_source fades as 2 / (1 + (d / FD)^2), which is 2 FD^2 / d^2 where FD << d. A piece A of a Lambertian lamp of radiance L irradiates
 * L A cos_light cos_surface / d^2, so it is a light_source of colour L A / (2 pi FD^2) times cos_light: a spotlight along the normal of
 * tightness 1, whose edge `radius 90 falloff 90` puts at the horizon. A lamp is cut into pieces of equal area with a light_source in the middle of
 * each: the midpoint rule, whose error falls as the square of the spacing. For rectangles POV-Ray's area_light does the cutting; its outer
 * points lie ON the edge of the lamp, so it is told a lamp smaller by (N - 1) / N.
 */
#include "verify/renderers/pov_export_c.h"

typedef struct patch {
    lc_vec3 p, n; /* in metres, n unit */
    lc_rgb color;
} patch;

static lc_rgb lamp_color(const lc_pov_writer *w, const lc_shape_desc *shape, double area)
{
    double fade = LC_POV_FADE / w->unit;
    return lc_rgb_scale(area / (2 * LC_PI * fade * fade), shape->radiance.color[0]);
}

static int is_lamp(const lc_shape_desc *shape) { return shape->emits && !lc_pov_is_black(shape->radiance.color[0]); }

static lc_vec3 column(const lc_shape_desc *shape, int j)
{
    return lc_vec(shape->to_world.m[0][j], shape->to_world.m[1][j], shape->to_world.m[2][j]);
}

/* Longest side or diameter of any lamp: what is cut into area_samples. */
static double longest_side(const lc_pov_writer *w)
{
    double most = 0;
    for (int i = 0; i < w->desc->shape_count; ++i)
        for (int j = 0; j < 3 && is_lamp(&w->desc->shapes[i]); ++j)
            if (j < 2 || w->desc->shapes[i].kind == LC_CUBE)
                most = fmax(most, 2 * lc_length(column(&w->desc->shapes[i], j)));
    return most;
}

static int pieces(const lc_pov_writer *w, double length, int least)
{
    int n = (int)ceil(w->options->area_samples * length / longest_side(w) - 1e-9);
    return n < least ? least : n;
}

/* ---- writing ------------------------------------------------------------------------------------------------------ */

/* Location, lifted off the lamp, and colour of a light_source that fades as the square of the distance. */
static void write_source(const lc_pov_writer *w, const patch *s)
{
    lc_vec3 p = lc_add(lc_scale(w->unit, s->p), lc_scale(LC_POV_LIFT, s->n));
    fprintf(w->out,
            "light_source {\n    <%.15g, %.15g, %.15g> rgb <%.15g, %.15g, %.15g>\n"
            "    fade_distance %g fade_power 2\n",
            p.x, p.y, p.z, s->color.r, s->color.g, s->color.b, LC_POV_FADE);
}

/* Emits as the cosine to s->n. */
static void write_cosine(const lc_pov_writer *w, const patch *s)
{
    lc_vec3 to = lc_add(lc_scale(w->unit, s->p), s->n);
    fprintf(w->out, "    spotlight point_at <%.15g, %.15g, %.15g> radius 90 falloff 90 tightness 1\n", to.x, to.y,
            to.z);
}

static void write_patch(const lc_pov_writer *w, const patch *s)
{
    write_source(w, s);
    write_cosine(w, s);
    fprintf(w->out, "}\n");
}

/* One rectangle o + [-1, 1] u + [-1, 1] v. */
static void write_face(const lc_pov_writer *w, const lc_shape_desc *shape, lc_vec3 o, lc_vec3 u, lc_vec3 v, lc_vec3 out)
{
    lc_vec3 cross = lc_cross(u, v);
    double area = 4 * lc_length(cross);
    lc_vec3 n = lc_normalize(cross);
    if ((lc_dot(n, out) < 0) != (shape->flip_normals != 0))
        n = lc_neg(n);
    patch s = {o, n, lamp_color(w, shape, area)};
    int nu = pieces(w, 2 * lc_length(u), 4), nv = pieces(w, 2 * lc_length(v), 4);
    lc_vec3 eu = lc_scale(2 * w->unit * (nu - 1) / nu, u), ev = lc_scale(2 * w->unit * (nv - 1) / nv, v);
    write_source(w, &s);
    write_cosine(w, &s);
    fprintf(w->out,
            "    area_light <%.15g, %.15g, %.15g>, <%.15g, %.15g, %.15g>, %d, %d\n    area_illumination on\n}\n", eu.x,
            eu.y, eu.z, ev.x, ev.y, ev.z, nu, nv);
}

/* A normal goes by the inverse transpose; this one lies on the right side at least, which is all that is asked. */
static void write_rectangle(const lc_pov_writer *w, const lc_shape_desc *shape)
{
    write_face(w, shape, column(shape, 3), column(shape, 0), column(shape, 1), column(shape, 2));
}

static void write_cube(const lc_pov_writer *w, const lc_shape_desc *shape)
{
    for (int i = 0; i < 6; ++i) {
        lc_vec3 out = lc_scale(i % 2 ? -1 : 1, column(shape, i / 2));
        write_face(w, shape, lc_add(column(shape, 3), out), column(shape, (i / 2 + 1) % 3),
                   column(shape, (i / 2 + 2) % 3), out);
    }
}

/* n rings of equal width; ring i is cut into 4 (2 i + 1) pieces, all of the same area, and its points lie where half of it is within. */
static void write_disk(const lc_pov_writer *w, const lc_shape_desc *shape)
{
    lc_vec3 u = column(shape, 0), v = column(shape, 1), cross = lc_cross(u, v), n = lc_normalize(cross);
    int rings = (pieces(w, 2 * fmax(lc_length(u), lc_length(v)), 4) + 1) / 2;
    if ((lc_dot(n, column(shape, 2)) < 0) != (shape->flip_normals != 0))
        n = lc_neg(n);
    patch s = {{0, 0, 0}, n, lamp_color(w, shape, LC_PI * lc_length(cross) / (4.0 * rings * rings))};
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < 4 * (2 * i + 1); ++j) {
            double r = sqrt(i * i + i + 0.5) / rings, phi = 2 * LC_PI * (j + 0.5) / (4 * (2 * i + 1));
            s.p = lc_add(column(shape, 3), lc_add(lc_scale(r * cos(phi), u), lc_scale(r * sin(phi), v)));
            write_patch(w, &s);
        }
}

/* A spiral of equal steps in height and the golden angle in longitude. */
static void write_sphere(const lc_pov_writer *w, const lc_shape_desc *shape)
{
    double radius = cbrt(fabs(lc_affine_determinant(&shape->to_world))), golden = LC_PI * (3 - sqrt(5.0));
    int across = pieces(w, 2 * radius, 4), count = (int)ceil(LC_PI * across * across);
    patch s = {{0, 0, 0}, {0, 0, 0}, lamp_color(w, shape, 4 * LC_PI * radius * radius / count)};
    for (int i = 0; i < count; ++i) {
        double z = 1 - (2 * i + 1.0) / count, r = sqrt(1 - z * z), phi = golden * i;
        lc_vec3 n = lc_vec(r * cos(phi), r * sin(phi), z);
        s.p = lc_add(column(shape, 3), lc_scale(radius, n));
        s.n = shape->flip_normals ? lc_neg(n) : n;
        write_patch(w, &s);
    }
}

static void write_lamp(const lc_pov_writer *w, const lc_shape_desc *shape)
{
    static void (*const writers[])(const lc_pov_writer *, const lc_shape_desc *) = {
        write_rectangle, write_disk, write_cube, write_sphere}; /* in the order of lc_shape_kind */
    fprintf(w->out, "// the light of the %s of line %d\n", lc_pov_kind_names[shape->kind], shape->line);
    writers[shape->kind](w, shape);
    fprintf(w->out, "\n");
}

static void write_point(const lc_pov_writer *w, const lc_point_desc *point)
{
    double fade = LC_POV_FADE / w->unit;
    patch s = {point->position, {0, 0, 0}, lc_rgb_scale(1 / (2 * LC_PI * fade * fade), point->intensity)};
    fprintf(w->out, "// point light of line %d\n", point->line);
    write_source(w, &s);
    fprintf(w->out, "}\n\n");
}

static void write_directional(const lc_pov_writer *w, const lc_directional_desc *light)
{
    lc_vec3 at = lc_scale(w->unit, w->center), from = lc_sub(at, lc_scale(4 * LC_POV_EXTENT, light->direction));
    lc_rgb c = lc_rgb_scale(LC_INV_PI, light->irradiance);
    fprintf(w->out,
            "// directional light of line %d\n"
            "light_source {\n    <%.15g, %.15g, %.15g> rgb <%.15g, %.15g, %.15g>\n"
            "    parallel point_at <%.15g, %.15g, %.15g>\n}\n\n",
            light->line, from.x, from.y, from.z, c.r, c.g, c.b, at.x, at.y, at.z);
}

/* ---- all of them ---------------------------------------------------------------------------------------------------- */

lc_status lc_pov_check_lights(const lc_pov_writer *w, lc_error *err)
{
    const lc_scene_desc *d = w->desc;
    int lights = d->point_count + d->directional_count;
    if (w->options->mode == LC_POV_SPECULAR)
        return LC_OK; /* there they light nothing */
    for (int i = 0; i < d->shape_count; ++i)
        lights += is_lamp(&d->shapes[i]);
    if (lights && d->has_sky && !lc_pov_is_black(d->sky))
        return lc_fail(err, LC_BAD_INPUT,
                       "%s: POV-Ray counts the bounces of a sky's light and of a lamp's differently: not both",
                       d->name);
    return LC_OK;
}

void lc_pov_write_lights(const lc_pov_writer *w)
{
    for (int i = 0; i < w->desc->shape_count; ++i)
        if (is_lamp(&w->desc->shapes[i]))
            write_lamp(w, &w->desc->shapes[i]);
    for (int i = 0; i < w->desc->point_count; ++i)
        write_point(w, &w->desc->points[i]);
    for (int i = 0; i < w->desc->directional_count; ++i)
        write_directional(w, &w->desc->directionals[i]);
}
