/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Lights for POV-Ray. Its diffuse surface of pigment rho under a light_source of colour C shows rho C cos: C is
 * irradiance over pi.
 *
 * A light_source fades as 2 / (1 + (d / FD)^2), which is 2 FD^2 / d^2 where FD << d. A piece A of a Lambertian lamp of
 * radiance L irradiates L A cos_light cos_surface / d^2, so it is a light_source of colour L A / (2 pi FD^2) times
 * cos_light: a spotlight along the normal of tightness 1, whose edge `radius 90 falloff 90` puts at the horizon.
 *
 * A lamp is a quadrature of such points: Gauss and Legendre's on rectangles; on disks theirs in the square of the
 * radius and equal steps in angle; equal areas on spheres, half of which no point sees. POV-Ray's own area_light will
 * not do: with area_illumination it multiplies the mean of the visibility by the mean of the light without shadows, and
 * what is wanted is the mean of the product (23% too dark for a lamp that the horizon of a surface cuts at a quarter).
 */
#include <gsl/gsl_integration.h>

#include "verify/renderers/pov_export_c.h"

static int is_lamp(const lc_shape_desc *shape)
{
    const lc_texture *t = &shape->radiance;
    return shape->emits && !(lc_pov_is_black(t->color[0]) && (!t->is_checkerboard || lc_pov_is_black(t->color[1])));
}

static lc_vec3 column(const lc_shape_desc *shape, int j)
{
    return lc_vec(shape->to_world.m[0][j], shape->to_world.m[1][j], shape->to_world.m[2][j]);
}

/* Longest side or diameter of any lamp: what gets area_samples. */
static double longest_side(const lc_pov_writer *w)
{
    double most = 0;
    for (int i = 0; i < w->desc->shape_count; ++i)
        for (int j = 0; j < 3 && is_lamp(&w->desc->shapes[i]); ++j)
            if (j < 2 || w->desc->shapes[i].kind == LC_CUBE)
                most = fmax(most, 2 * lc_length(column(&w->desc->shapes[i], j)));
    return most;
}

static int points_along(const lc_pov_writer *w, double length)
{
    int n = (int)ceil(w->options->area_samples * length / longest_side(w) - 1e-9);
    return n < 3 ? 3 : n;
}

/* ---- writing ----------------------------------------------------------------------------------------------------- */

static void print_vector(FILE *out, lc_vec3 v) { fprintf(out, "<%.15g, %.15g, %.15g>", v.x, v.y, v.z); }

static void declare_vector(const lc_pov_writer *w, const char *name, lc_vec3 v)
{
    fprintf(w->out, "#declare %s = ", name);
    print_vector(w->out, v);
    fprintf(w->out, ";\n");
}

/* The light of an area in the middle of which, or for which, a point stands. */
static void declare_color(const lc_pov_writer *w, lc_rgb radiance, double area)
{
    lc_rgb c = lc_rgb_scale(area * w->unit * w->unit / (2 * LC_PI * LC_POV_FADE * LC_POV_FADE), radiance);
    fprintf(w->out, "#declare C = rgb <%.15g, %.15g, %.15g>;\n", c.r, c.g, c.b);
}

/* Nodes in [-1, 1] or [0, 1], and weights that add up to 1. */
static lc_status declare_gauss(const lc_pov_writer *w, const char *nodes, const char *weights, int n, double lower)
{
    gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc((size_t)n);
    double x, weight;
    if (!table)
        return LC_FAULT;
    for (int pass = 0; pass < 2; ++pass) {
        fprintf(w->out, "#declare %s = array[%d] {", pass ? weights : nodes, n);
        for (int i = 0; i < n; ++i) {
            gsl_integration_glfixed_point(lower, 1, (size_t)i, &x, &weight, table);
            fprintf(w->out, "%s%.15g", i ? ", " : " ", pass ? weight / (1 - lower) : x);
        }
        fprintf(w->out, " };\n");
    }
    gsl_integration_glfixed_table_free(table);
    return LC_OK;
}

static void write_macro(const lc_pov_writer *w)
{
    fprintf(w->out,
            "// A piece of a lamp at P with normal N. It stands a little above the lamp, which would shadow it.\n"
            "#macro Piece(P, N, C)\n"
            "    light_source {\n"
            "        P + %g * N color C\n"
            "        fade_distance %g fade_power 2\n"
            "        spotlight point_at P + N radius 90 falloff 90 tightness 1\n"
            "    }\n"
            "#end\n\n",
            LC_POV_LIFT, LC_POV_FADE);
    if (w->options->jitter)
        fprintf(w->out, "#declare Random = seed(%lu);\n\n", (unsigned long)w->options->jitter);
}

/* Points drawn at A and B in [0, 1), two in each of m x n cells, the second opposite the first: each is anywhere in its cell with
 * equal probability, so that no error is the same for all seeds, and what is linear in a cell cancels. */
static void write_cells_of_points(const lc_pov_writer *w, int m, int n, const char *at, const char *normal, const char *colour)
{
    fprintf(w->out,
            "#for (I, 0, %d)\n    #for (J, 0, %d)\n"
            "        #declare U0 = rand(Random);\n        #declare V0 = rand(Random);\n"
            "        #for (K, 0, 1)\n"
            "            #declare A = (I + abs(K - U0)) / %d;\n"
            "            #declare B = (J + abs(K - V0)) / %d;\n"
            "            Piece(%s, %s, %s / %d)\n"
            "        #end\n    #end\n#end\n\n",
            m - 1, n - 1, m, n, at, normal, colour, 2 * m * n);
}

/* One rectangle o + [-1, 1] u + [-1, 1] v; `out` lies on the side of the normal of the shape that is not flipped. */
static lc_status write_face(const lc_pov_writer *w, const lc_shape_desc *shape, lc_rgb radiance, lc_vec3 o, lc_vec3 u,
                            lc_vec3 v, lc_vec3 out)
{
    lc_vec3 cross = lc_cross(u, v), n = lc_normalize(cross);
    if ((lc_dot(n, out) < 0) != (shape->flip_normals != 0))
        n = lc_neg(n);
    int nu = points_along(w, 2 * lc_length(u)), nv = points_along(w, 2 * lc_length(v));
    declare_vector(w, "O", lc_scale(w->unit, o));
    declare_vector(w, "U", lc_scale(w->unit, u));
    declare_vector(w, "V", lc_scale(w->unit, v));
    declare_vector(w, "N", n);
    declare_color(w, radiance, 4 * lc_length(cross));
    if (w->options->jitter) {
        write_cells_of_points(w, nu, nv, "O + (2 * A - 1) * U + (2 * B - 1) * V", "N", "C");
        return LC_OK;
    }
    if (declare_gauss(w, "X", "XW", nu, -1) != LC_OK || declare_gauss(w, "Y", "YW", nv, -1) != LC_OK)
        return LC_FAULT;
    fprintf(w->out,
            "#for (I, 0, %d)\n    #for (J, 0, %d)\n"
            "        Piece(O + X[I] * U + Y[J] * V, N, C * XW[I] * YW[J])\n"
            "    #end\n#end\n\n",
            nu - 1, nv - 1);
    return LC_OK;
}

/* Where an axis of a checkerboard changes colour, in [-1, 1] of the rectangle: at u' = scale u + offset = n / 2, u =
 * (x + 1) / 2. Ends with 1, begins with -1; returns how many, at most `room`, or 0 when they are more. */
static int cuts_of(double *cuts, int room, double scale, double offset)
{
    int count = 0;
    cuts[count++] = -1;
    double low = fmin(offset, scale + offset), high = fmax(offset, scale + offset);
    for (double n = floor(2 * low) + 1; n < 2 * high; ++n) {
        double x = 2 * (n / 2 - offset) / scale - 1;
        if (count + 1 >= room)
            return 0;
        if (x > -1 + 1e-9 && x < 1 - 1e-9)
            cuts[count++] = x;
    }
    cuts[count++] = 1;
    for (int i = 1; i < count; ++i) /* a negative scale counts downwards */
        for (int j = i; j > 0 && cuts[j - 1] > cuts[j]; --j) {
            double swapped = cuts[j];
            cuts[j] = cuts[j - 1];
            cuts[j - 1] = swapped;
        }
    return count;
}

enum { MOST_CUTS = 64 };

/* A checkerboard of radiance: each cell is a lamp. */
static lc_status write_cells(const lc_pov_writer *w, const lc_shape_desc *shape)
{
    double x[MOST_CUTS], y[MOST_CUTS];
    const lc_texture *t = &shape->radiance;
    int nx = cuts_of(x, MOST_CUTS, t->scale[0], t->offset[0]), ny = cuts_of(y, MOST_CUTS, t->scale[1], t->offset[1]);
    for (int i = 0; i + 1 < nx; ++i)
        for (int j = 0; j + 1 < ny; ++j) {
            double u = 0.5 * (x[i] + x[i + 1]), v = 0.5 * (y[j] + y[j + 1]);
            lc_vec3 o = lc_add(column(shape, 3), lc_add(lc_scale(u, column(shape, 0)), lc_scale(v, column(shape, 1))));
            lc_rgb radiance = lc_texture_at(t, 0.5 * (u + 1), 0.5 * (v + 1));
            lc_status status = lc_pov_is_black(radiance)
                                   ? LC_OK
                                   : write_face(w, shape, radiance, o, lc_scale(0.5 * (x[i + 1] - x[i]), column(shape, 0)),
                                                lc_scale(0.5 * (y[j + 1] - y[j]), column(shape, 1)), column(shape, 2));
            if (status != LC_OK)
                return status;
        }
    return LC_OK;
}

/* The third column lies on the side of the normal: a normal goes by the inverse transpose. */
static lc_status write_rectangle(const lc_pov_writer *w, const lc_shape_desc *shape)
{
    if (shape->radiance.is_checkerboard)
        return write_cells(w, shape);
    return write_face(w, shape, shape->radiance.color[0], column(shape, 3), column(shape, 0), column(shape, 1),
                      column(shape, 2));
}

static lc_status write_cube(const lc_pov_writer *w, const lc_shape_desc *shape)
{
    lc_status status = LC_OK;
    for (int i = 0; i < 6 && status == LC_OK; ++i) {
        lc_vec3 out = lc_scale(i % 2 ? -1 : 1, column(shape, i / 2));
        status = write_face(w, shape, shape->radiance.color[0], lc_add(column(shape, 3), out), column(shape, (i / 2 + 1) % 3),
                            column(shape, (i / 2 + 2) % 3), out);
    }
    return status;
}

static lc_status write_disk(const lc_pov_writer *w, const lc_shape_desc *shape)
{
    lc_vec3 u = column(shape, 0), v = column(shape, 1), cross = lc_cross(u, v), n = lc_normalize(cross);
    if ((lc_dot(n, column(shape, 2)) < 0) != (shape->flip_normals != 0))
        n = lc_neg(n);
    int around = 2 * points_along(w, 2 * fmax(lc_length(u), lc_length(v))), rings = (around + 3) / 4;
    declare_vector(w, "O", lc_scale(w->unit, column(shape, 3)));
    declare_vector(w, "U", lc_scale(w->unit, u));
    declare_vector(w, "V", lc_scale(w->unit, v));
    declare_vector(w, "N", n);
    declare_color(w, shape->radiance.color[0], LC_PI * lc_length(cross) / around);
    if (w->options->jitter) {
        char colour[32];
        snprintf(colour, sizeof colour, "C * %d", around);
        write_cells_of_points(w, rings, around, "O + sqrt(A) * (cos(2 * pi * B) * U + sin(2 * pi * B) * V)", "N", colour);
        return LC_OK;
    }
    if (declare_gauss(w, "R", "RW", rings, 0) != LC_OK) /* of the squared radius */
        return LC_FAULT;
    fprintf(w->out,
            "#for (I, 0, %d)\n    #for (J, 0, %d)\n"
            "        #declare Phi = 2 * pi * (J + I / 2) / %d;\n"
            "        Piece(O + sqrt(R[I]) * (cos(Phi) * U + sin(Phi) * V), N, C * RW[I])\n"
            "    #end\n#end\n\n",
            rings - 1, around - 1, around);
    return LC_OK;
}

/* A spiral of equal steps in height and the golden angle in longitude. */
static lc_status write_sphere(const lc_pov_writer *w, const lc_shape_desc *shape)
{
    double radius = cbrt(fabs(lc_affine_determinant(&shape->to_world)));
    int across = points_along(w, 2 * radius), count = 3 * across * across;
    declare_vector(w, "O", lc_scale(w->unit, column(shape, 3)));
    declare_color(w, shape->radiance.color[0], 4 * LC_PI * radius * radius / count);
    if (w->options->jitter) {
        char at[64], colour[32];
        snprintf(at, sizeof at, "O + %.15g * Way(A, B)", w->unit * radius);
        snprintf(colour, sizeof colour, "C * %d", count);
        fprintf(w->out, "#macro Way(A, B) <2 * sqrt(A - A * A) * cos(2 * pi * B), 2 * sqrt(A - A * A) * sin(2 * pi * B), 1 - 2 * A> #end\n");
        write_cells_of_points(w, across, 3 * across, at, shape->flip_normals ? "-Way(A, B)" : "Way(A, B)", colour);
        return LC_OK;
    }
    fprintf(w->out,
            "#for (I, 0, %d)\n"
            "    #declare Z = 1 - (2 * I + 1) / %d;\n"
            "    #declare Phi = pi * (3 - sqrt(5)) * I;\n"
            "    #declare N = <sqrt(1 - Z * Z) * cos(Phi), sqrt(1 - Z * Z) * sin(Phi), Z>;\n"
            "    Piece(O + %.15g * N, %sN, C)\n"
            "#end\n\n",
            count - 1, count, w->unit * radius, shape->flip_normals ? "-" : "");
    return LC_OK;
}

static lc_status write_lamp(const lc_pov_writer *w, const lc_shape_desc *shape)
{
    static lc_status (*const writers[])(const lc_pov_writer *, const lc_shape_desc *) = {
        write_rectangle, write_disk, write_cube, write_sphere}; /* in the order of lc_shape_kind */
    fprintf(w->out, "// the light of the %s of line %d\n", lc_pov_kind_names[shape->kind], shape->line);
    return writers[shape->kind](w, shape);
}

static void write_point(const lc_pov_writer *w, const lc_point_desc *point)
{
    double scale = w->unit * w->unit / (2 * LC_PI * LC_POV_FADE * LC_POV_FADE);
    fprintf(w->out, "// point light of line %d\nlight_source {\n    ", point->line);
    print_vector(w->out, lc_scale(w->unit, point->position));
    fprintf(w->out, " rgb <%.15g, %.15g, %.15g>\n    fade_distance %g fade_power 2\n}\n\n", scale * point->intensity.r,
            scale * point->intensity.g, scale * point->intensity.b, LC_POV_FADE);
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

/* ---- all of them ------------------------------------------------------------------------------------------------- */

lc_status lc_pov_check_lights(const lc_pov_writer *w, lc_error *err)
{
    const lc_scene_desc *d = w->desc;
    int lights = d->point_count + d->directional_count;
    if (w->options->mode == LC_POV_SPECULAR)
        return LC_OK; /* there they light nothing */
    if (w->options->mode == LC_POV_GATHERED && lights)
        return lc_fail(err, LC_BAD_INPUT, "%s: no ray meets a point or directional light: mode gathered is for lamps", d->name);
    for (int i = 0; i < d->shape_count; ++i) {
        const lc_texture *t = &d->shapes[i].radiance;
        lights += is_lamp(&d->shapes[i]);
        if (is_lamp(&d->shapes[i]) && t->is_checkerboard && fabs(t->scale[0]) + fabs(t->scale[1]) > MOST_CUTS / 2 - 4)
            return lc_fail(err, LC_BAD_INPUT, "%s:%d: the checkerboard of this lamp is too fine to be cut into lamps",
                           d->name, d->shapes[i].line);
    }
    if (lights && d->has_sky && !lc_pov_is_black(d->sky))
        return lc_fail(err, LC_BAD_INPUT,
                       "%s: POV-Ray counts the bounces of a sky's light and of a lamp's differently: not both",
                       d->name);
    return LC_OK;
}

lc_status lc_pov_write_lights(const lc_pov_writer *w, lc_error *err)
{
    int lamps = 0;
    for (int i = 0; i < w->desc->shape_count; ++i) {
        if (!is_lamp(&w->desc->shapes[i]))
            continue;
        if (!lamps++)
            write_macro(w);
        if (write_lamp(w, &w->desc->shapes[i]) != LC_OK)
            return lc_fail(err, LC_FAULT, "out of memory for a quadrature");
    }
    for (int i = 0; i < w->desc->point_count; ++i)
        write_point(w, &w->desc->points[i]);
    for (int i = 0; i < w->desc->directional_count; ++i)
        write_directional(w, &w->desc->directionals[i]);
    return LC_OK;
}
