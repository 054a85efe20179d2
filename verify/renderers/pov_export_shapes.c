/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Shapes for POV-Ray, each the standard one under a matrix, as ours. `texture` is what the front shows and
 * `interior_texture` the back: for flat shapes, too, POV-Ray calls inside what lies behind the normal.
 */
#include "verify/renderers/pov_export_c.h"

/* A surface that emits and reflects needs a pigment that can be divided by; this is black enough. */
#define LEAST_PIGMENT 1e-6

static int texture_is_black(const lc_texture *t)
{
    return lc_pov_is_black(t->color[0]) && (!t->is_checkerboard || lc_pov_is_black(t->color[1]));
}

static int same_color(lc_rgb a, lc_rgb b) { return a.r == b.r && a.g == b.g && a.b == b.b; }

static int same_side(const lc_side *a, const lc_side *b)
{
    const lc_texture *s = &a->diffuse, *t = &b->diffuse;
    return s->is_checkerboard == t->is_checkerboard && same_color(s->color[0], t->color[0]) &&
           (!s->is_checkerboard ||
            (same_color(s->color[1], t->color[1]) && s->scale[0] == t->scale[0] && s->scale[1] == t->scale[1] &&
             s->offset[0] == t->offset[0] && s->offset[1] == t->offset[1])) &&
           same_color(a->mirror, b->mirror) && a->glass == b->glass && same_color(a->glossy, b->glossy) &&
           a->alpha == b->alpha;
}

static const lc_material_desc *material_of(const lc_pov_writer *w, const lc_shape_desc *shape)
{
    return &w->desc->materials[shape->material];
}

/* ---- what cannot be said ----------------------------------------------------------------------------------------- */

static lc_status refuse(const lc_pov_writer *w, const lc_shape_desc *shape, const char *reason, lc_error *err)
{
    return lc_fail(err, LC_BAD_INPUT, "%s:%d: %s: %s", w->desc->name, shape->line, lc_pov_kind_names[shape->kind],
                   reason);
}

static lc_status check_glass(const lc_pov_writer *w, const lc_shape_desc *shape, lc_error *err)
{
    const lc_material_desc *m = material_of(w, shape);
    int whole = same_side(&m->side[0], &m->side[1]) && m->side[0].glass == 1 && lc_pov_is_black(m->side[0].mirror) &&
                texture_is_black(&m->side[0].diffuse);
    if (!whole)
        return refuse(w, shape, "POV-Ray has Fresnel's share for a pure dielectric only, not for a blend", err);
    if (shape->kind == LC_RECTANGLE || shape->kind == LC_DISK)
        return refuse(w, shape, "glass must enclose a volume: POV-Ray counts which interiors a ray has entered", err);
    return LC_OK;
}

static int is_lit_by_sky_alone(const lc_scene_desc *desc)
{
    int lamps = desc->point_count + desc->directional_count;
    for (int i = 0; i < desc->shape_count; ++i)
        lamps += desc->shapes[i].emits && !texture_is_black(&desc->shapes[i].radiance);
    return desc->has_sky && lamps == 0;
}

static lc_status check_shape(const lc_pov_writer *w, const lc_shape_desc *shape, lc_error *err)
{
    const lc_material_desc *m = material_of(w, shape);
    int specular = 0, diffuse = 0, glass = 0, checkered = 0, glossy = 0;
    for (int i = 0; i < 2; ++i) {
        specular |= !lc_pov_is_black(m->side[i].mirror);
        glass |= m->side[i].glass > 0;
        diffuse |= !texture_is_black(&m->side[i].diffuse);
        checkered |= m->side[i].diffuse.is_checkerboard;
        glossy |= !lc_pov_is_black(m->side[i].glossy);
    }
    if (lc_length(shape->motion) > 0)
        return refuse(w, shape, "it moves: POV-Ray knows motion from frame to frame only", err);
    if (glossy)
        return refuse(w, shape, "POV-Ray's reflections are sharp: it has no rough mirror", err);
    /* Rays that gather the light of a sky are reflected like any others; one bounce leaves nothing to count. */
    int gathers_all = w->options->mode == LC_POV_RADIOSITY && w->options->bounces == 1 && is_lit_by_sky_alone(w->desc);
    gathers_all |= w->options->mode == LC_POV_GATHERED;
    if ((glass || (specular && !gathers_all)) && w->options->mode != LC_POV_SPECULAR)
        return refuse(w, shape,
                      "POV-Ray's lights reach no surface off a mirror or through glass: mode specular, for scenes "
                      "without diffuse surfaces",
                      err);
    if (diffuse && w->options->mode == LC_POV_SPECULAR)
        return refuse(w, shape, "a diffuse surface in mode specular would miss the light off mirrors and through glass",
                      err);
    if (checkered && shape->kind != LC_RECTANGLE)
        return refuse(w, shape, "a checkerboard has POV-Ray's pigment on rectangles only", err);
    if (shape->emits && shape->radiance.is_checkerboard &&
        (shape->kind != LC_RECTANGLE || w->options->emission || w->options->mode == LC_POV_GATHERED))
        return refuse(w, shape, "a glowing checkerboard is many lamps: on rectangles only, and not seen by the camera", err);
    return glass ? check_glass(w, shape, err) : LC_OK;
}

/* Box around a shape, along the axes. */
static void find_box(const lc_shape_desc *shape, double lower[3], double upper[3])
{
    for (int i = 0; i < 3; ++i) {
        double reach = 0;
        for (int j = 0; j < 3; ++j)
            reach += fabs(shape->to_world.m[i][j]);
        lower[i] = shape->to_world.m[i][3] - reach;
        upper[i] = shape->to_world.m[i][3] + reach;
    }
}

/* Index on the far side of an interface is the index of the world for POV-Ray: no glass in glass. */
static lc_status check_nesting(const lc_pov_writer *w, lc_error *err)
{
    const lc_scene_desc *d = w->desc;
    for (int i = 0; i < d->shape_count; ++i)
        for (int j = 0; j < i; ++j) {
            double l[2][3], u[2][3];
            if (!(material_of(w, &d->shapes[i])->side[0].glass > 0) ||
                !(material_of(w, &d->shapes[j])->side[0].glass > 0))
                continue;
            find_box(&d->shapes[i], l[0], u[0]);
            find_box(&d->shapes[j], l[1], u[1]);
            int apart = 0;
            for (int k = 0; k < 3; ++k)
                apart |= u[0][k] < l[1][k] || u[1][k] < l[0][k];
            if (!apart)
                return refuse(w, &d->shapes[i], "may lie in or touch other glass, whose index POV-Ray would not see",
                              err);
        }
    return LC_OK;
}

lc_status lc_pov_check_shapes(const lc_pov_writer *w, lc_error *err)
{
    if (w->options->mode == LC_POV_SPECULAR && !w->options->emission)
        return lc_fail(err, LC_BAD_INPUT,
                       "%s: mode specular shows what glows, also what the camera sees directly: ask for emission",
                       w->desc->name);
    for (int i = 0; i < w->desc->shape_count; ++i) {
        lc_status status = check_shape(w, &w->desc->shapes[i], err);
        if (status != LC_OK)
            return status;
    }
    return check_nesting(w, err);
}

/* ---- writing ----------------------------------------------------------------------------------------------------- */

static void write_color(FILE *out, lc_rgb c) { fprintf(out, "rgb <%.15g, %.15g, %.15g>", c.r, c.g, c.b); }

/* POV-Ray's checker shows its first colour where floor(x) + floor(y) + floor(z) is even. */
static void write_checker(FILE *out, const lc_texture *t)
{
    fprintf(out, "checker ");
    write_color(out, t->color[0]);
    fprintf(out, ", ");
    write_color(out, t->color[1]);
    fprintf(out, " scale <%.15g, %.15g, 1> translate <%.15g, %.15g, -0.5>", 1 / t->scale[0], 1 / t->scale[1],
            -(t->scale[0] + 2 * t->offset[0]) / t->scale[0], -(t->scale[1] + 2 * t->offset[1]) / t->scale[1]);
}

static double ratio(double radiance, double pigment) { return radiance / fmax(pigment, LEAST_PIGMENT); }

/* What one side shows: its lobes, and `glow` on top. The finish's emission is multiplied by the pigment. */
static void write_texture(FILE *out, const char *keyword, const lc_side *side, lc_rgb glow)
{
    const lc_texture *albedo = &side->diffuse;
    int reflects = !texture_is_black(albedo);
    fprintf(out, "    %s { pigment { ", keyword);
    if (side->glass > 0)
        fprintf(out, "rgbt <1, 1, 1, 1>");
    else if (albedo->is_checkerboard)
        write_checker(out, albedo);
    else if (reflects && !lc_pov_is_black(glow))
        write_color(out, lc_color(fmax(albedo->color[0].r, LEAST_PIGMENT), fmax(albedo->color[0].g, LEAST_PIGMENT),
                                  fmax(albedo->color[0].b, LEAST_PIGMENT)));
    else
        write_color(out, reflects ? albedo->color[0] : lc_color(1, 1, 1));
    fprintf(out, " } finish { diffuse %d", reflects);
    if (!lc_pov_is_black(glow)) {
        lc_rgb p = reflects ? albedo->color[0] : lc_color(1, 1, 1);
        fprintf(out, " emission ");
        write_color(out, lc_color(ratio(glow.r, p.r), ratio(glow.g, p.g), ratio(glow.b, p.b)));
    }
    if (side->glass > 0)
        fprintf(out, " reflection { 0, 1 fresnel on } conserve_energy");
    else if (!lc_pov_is_black(side->mirror)) {
        fprintf(out, " reflection { ");
        write_color(out, side->mirror);
        fprintf(out, " }");
    }
    fprintf(out, " } }\n");
}

static void write_body(const lc_pov_writer *w, const lc_shape_desc *shape, lc_rgb glow, const char *flags)
{
    static const char *const bodies[] = {
        "polygon {\n    5, <-1, -1, 0>, <1, -1, 0>, <1, 1, 0>, <-1, 1, 0>, <-1, -1, 0>\n",
        "disc {\n    <0, 0, 0>, <0, 0, 1>, 1\n", "box {\n    <-1, -1, -1>, <1, 1, 1>\n",
        "sphere {\n    <0, 0, 0>, 1\n"}; /* in the order of lc_shape_kind */
    const lc_material_desc *m = material_of(w, shape);
    int front = shape->flip_normals ? 1 : 0;
    lc_rgb glows[2] = {lc_black(), lc_black()}; /* of POV-Ray's front and back */
    glows[front] = glow;
    fprintf(w->out, "%s", bodies[shape->kind]);
    write_texture(w->out, "texture", &m->side[front], glows[0]);
    if (!lc_pov_is_black(glow) || !same_side(&m->side[0], &m->side[1]))
        write_texture(w->out, "interior_texture", &m->side[1 - front], glows[1]);
    if (m->side[0].glass > 0)
        fprintf(w->out, "    interior { ior %.15g }\n", front ? m->ext_ior / m->int_ior : m->int_ior / m->ext_ior);
    if (flags)
        fprintf(w->out, "    %s\n", flags);
    fprintf(w->out, "    matrix <");
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 3; ++i)
            fprintf(w->out, "%.15g%s", w->unit * shape->to_world.m[i][j], i == 2 && j == 3 ? ">\n}\n" : ", ");
}

static void write_shape(const lc_pov_writer *w, const lc_shape_desc *shape)
{
    const lc_material_desc *m = material_of(w, shape);
    int glows = shape->emits && !texture_is_black(&shape->radiance);
    fprintf(w->out, "// %s of line %d%s%s%s%s\n", lc_pov_kind_names[shape->kind], shape->line,
            m->id[0] ? ", material " : "", m->id, shape->flip_normals ? ", normals flipped" : "",
            glows ? ", a lamp" : "");
    if (glows && w->options->mode == LC_POV_GATHERED && !w->options->emission) { /* the camera meets a dark twin */
        write_body(w, shape, shape->radiance.color[0], "no_image");
        write_body(w, shape, lc_black(), "no_reflection no_radiosity no_shadow");
    } else if (!glows || !w->options->emission) {
        write_body(w, shape, lc_black(), NULL);
    } else if (w->options->mode != LC_POV_RADIOSITY) {
        write_body(w, shape, shape->radiance.color[0], NULL);
    } else { /* its light is in the light sources already: gathering rays meet a dark twin */
        write_body(w, shape, shape->radiance.color[0], "no_radiosity");
        write_body(w, shape, lc_black(), "no_image no_reflection no_shadow");
    }
    fprintf(w->out, "\n");
}

void lc_pov_write_shapes(const lc_pov_writer *w)
{
    for (int i = 0; i < w->desc->shape_count; ++i)
        write_shape(w, &w->desc->shapes[i]);
}
