/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Numbers are written with 17 digits, so that the same doubles come back. A transformation is always its matrix.
 */
#include "io/scene_write.h"

static int is_black(const lc_texture *t)
{
    return lc_rgb_max(t->color[0]) == 0 && (!t->is_checkerboard || lc_rgb_max(t->color[1]) == 0);
}

static int is_black_side(const lc_side *s)
{
    return is_black(&s->diffuse) && lc_rgb_max(s->mirror) == 0 && lc_rgb_max(s->glossy) == 0 && s->glass == 0;
}

static int is_glossy_blend(const lc_side *s)
{
    return lc_rgb_max(s->glossy) > 0 && !(is_black(&s->diffuse) && lc_rgb_max(s->mirror) == 0 && s->glass == 0);
}

static int same_color(lc_rgb a, lc_rgb b) { return a.r == b.r && a.g == b.g && a.b == b.b; }

static int same_texture(const lc_texture *a, const lc_texture *b)
{
    if (a->is_checkerboard != b->is_checkerboard || !same_color(a->color[0], b->color[0]))
        return 0;
    return !a->is_checkerboard || (same_color(a->color[1], b->color[1]) && a->scale[0] == b->scale[0] &&
                                   a->scale[1] == b->scale[1] && a->offset[0] == b->offset[0] &&
                                   a->offset[1] == b->offset[1]);
}

static int same_side(const lc_side *a, const lc_side *b)
{
    return same_texture(&a->diffuse, &b->diffuse) && same_color(a->mirror, b->mirror) && a->glass == b->glass &&
           same_color(a->glossy, b->glossy) && a->alpha == b->alpha;
}

static double largest(const lc_texture *t)
{
    double most = lc_rgb_max(t->color[0]);
    return t->is_checkerboard ? fmax(most, lc_rgb_max(t->color[1])) : most;
}

/* ---- values ------------------------------------------------------------------------------------------------------ */

static void write_rgb(FILE *out, const char *name, lc_rgb c)
{
    fprintf(out, "<rgb name=\"%s\" value=\"%.17g %.17g %.17g\"/>", name, c.r, c.g, c.b);
}

/* A texture times a factor. */
static void write_texture(FILE *out, const char *name, const lc_texture *t, double factor)
{
    if (!t->is_checkerboard) {
        write_rgb(out, name, lc_rgb_scale(factor, t->color[0]));
        return;
    }
    fprintf(out, "<texture type=\"checkerboard\" name=\"%s\">", name);
    write_rgb(out, "color0", lc_rgb_scale(factor, t->color[0]));
    write_rgb(out, "color1", lc_rgb_scale(factor, t->color[1]));
    fprintf(out,
            "<transform name=\"to_uv\"><scale x=\"%.17g\" y=\"%.17g\"/><translate x=\"%.17g\" y=\"%.17g\"/></transform>"
            "</texture>",
            t->scale[0], t->scale[1], t->offset[0], t->offset[1]);
}

static void write_matrix(FILE *out, const lc_affine *a)
{
    fprintf(out, "<transform name=\"to_world\"><matrix value=\"");
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 4; ++j)
            fprintf(out, "%.17g ", a->m[i][j]);
    fprintf(out, "0 0 0 1\"/></transform>");
}

/* ---- materials --------------------------------------------------------------------------------------------------- */

static void write_diffuse(FILE *out, const lc_texture *t, double share)
{
    fprintf(out, "<bsdf type=\"diffuse\">");
    write_texture(out, "reflectance", t, 1 / share);
    fprintf(out, "</bsdf>");
}

static void write_mirror(FILE *out, lc_rgb reflectance, double share)
{
    fprintf(out, "<bsdf type=\"conductor\"><string name=\"material\" value=\"none\"/>");
    write_rgb(out, "specular_reflectance", lc_rgb_scale(1 / share, reflectance));
    fprintf(out, "</bsdf>");
}

static void write_glossy(FILE *out, const lc_side *side)
{
    fprintf(out,
            "<bsdf type=\"roughconductor\"><string name=\"material\" value=\"none\"/><string name=\"distribution\" "
            "value=\"ggx\"/><float name=\"alpha\" value=\"%.17g\"/>",
            side->alpha);
    write_rgb(out, "specular_reflectance", side->glossy);
    fprintf(out, "</bsdf>");
}

/* What a side reflects, divided by `share`. A blend's shares are free as far as no reflectance exceeds 1: each gets what its
 * largest channel asks for. */
static void write_reflection(FILE *out, const lc_side *side, double share)
{
    double diffuse = largest(&side->diffuse), mirror = lc_rgb_max(side->mirror);
    if (lc_rgb_max(side->glossy) > 0) {
        write_glossy(out, side);
    } else if (mirror == 0) {
        write_diffuse(out, &side->diffuse, share);
    } else if (diffuse == 0) {
        write_mirror(out, side->mirror, share);
    } else {
        double weight = mirror / (mirror + diffuse);
        fprintf(out, "<bsdf type=\"blendbsdf\"><float name=\"weight\" value=\"%.17g\"/>", weight);
        write_diffuse(out, &side->diffuse, share * (1 - weight));
        write_mirror(out, side->mirror, share * weight);
        fprintf(out, "</bsdf>");
    }
}

static void write_glass(FILE *out, const lc_material_desc *m)
{
    const lc_side *side = &m->side[0];
    if (side->glass < 1)
        fprintf(out, "<bsdf type=\"blendbsdf\"><float name=\"weight\" value=\"%.17g\"/>", side->glass);
    if (side->glass < 1)
        write_reflection(out, side, 1 - side->glass);
    fprintf(out,
            "<bsdf type=\"dielectric\"><float name=\"int_ior\" value=\"%.17g\"/><float name=\"ext_ior\" value=\"%.17g\"/>"
            "</bsdf>",
            m->int_ior, m->ext_ior);
    if (side->glass < 1)
        fprintf(out, "</bsdf>");
}

static lc_status write_material(FILE *out, const lc_scene_desc *desc, const lc_material_desc *m, lc_error *err)
{
    const lc_side *front = &m->side[0], *back = &m->side[1];
    if (is_glossy_blend(front) || is_glossy_blend(back))
        return lc_fail(err, LC_BAD_INPUT, "%s:%d: a rough mirror in a blend", desc->name, m->line);
    if (front->glass > 0 || back->glass > 0) {
        if (front->glass != back->glass || !is_black(&back->diffuse) || lc_rgb_max(back->mirror) > 0)
            return lc_fail(err, LC_BAD_INPUT, "%s:%d: a material that lets light through and reflects on its back",
                           desc->name, m->line);
        write_glass(out, m);
    } else if (is_black_side(back)) {
        write_reflection(out, front, 1);
    } else {
        fprintf(out, "<bsdf type=\"twosided\">");
        write_reflection(out, front, 1);
        if (!same_side(front, back))
            write_reflection(out, back, 1);
        fprintf(out, "</bsdf>");
    }
    return LC_OK;
}

/* ---- the scene --------------------------------------------------------------------------------------------------- */

static void write_camera(FILE *out, const lc_scene_desc *d)
{
    static const char *const axes[] = {"x", "y", "diagonal", "smaller", "larger"}; /* in the order of lc_fov_axis */
    const lc_camera_desc *c = &d->camera;
    fprintf(out, "<sensor type=\"%s\">\n<float name=\"fov\" value=\"%.17g\"/><string name=\"fov_axis\" value=\"%s\"/>\n",
            c->aperture_radius > 0 ? "thinlens" : "perspective", c->fov, axes[c->fov_axis]);
    if (c->aperture_radius > 0)
        fprintf(out, "<float name=\"aperture_radius\" value=\"%.17g\"/><float name=\"focus_distance\" value=\"%.17g\"/>\n",
                c->aperture_radius, c->focus_distance);
    if (c->near_clip > 0)
        fprintf(out, "<float name=\"near_clip\" value=\"%.17g\"/>\n", c->near_clip);
    if (c->far_clip < INFINITY)
        fprintf(out, "<float name=\"far_clip\" value=\"%.17g\"/>\n", c->far_clip);
    write_matrix(out, &c->to_world);
    fprintf(out, "\n<sampler type=\"independent\"><integer name=\"sample_count\" value=\"%d\"/></sampler>\n", d->samples);
    fprintf(out,
            "<film type=\"hdrfilm\"><integer name=\"width\" value=\"%d\"/><integer name=\"height\" value=\"%d\"/>"
            "<rfilter type=\"box\"/></film>\n</sensor>\n",
            d->width, d->height);
}

static lc_status write_shape(FILE *out, const lc_scene_desc *d, const lc_shape_desc *shape, lc_error *err)
{
    static const char *const kinds[] = {"rectangle", "disk", "cube", "sphere"}; /* in the order of lc_shape_kind */
    fprintf(out, "<shape type=\"%s\">\n", kinds[shape->kind]);
    write_matrix(out, &shape->to_world);
    if (lc_length(shape->motion) > 0)
        fprintf(out, "<vector name=\"motion\" x=\"%.17g\" y=\"%.17g\" z=\"%.17g\"/>", shape->motion.x, shape->motion.y,
                shape->motion.z);
    if (shape->flip_normals)
        fprintf(out, "<boolean name=\"flip_normals\" value=\"true\"/>");
    fprintf(out, "\n");
    lc_status status = write_material(out, d, &d->materials[shape->material], err);
    fprintf(out, "\n");
    if (shape->emits) {
        fprintf(out, "<emitter type=\"area\">");
        write_texture(out, "radiance", &shape->radiance, 1);
        fprintf(out, "</emitter>\n");
    }
    fprintf(out, "</shape>\n");
    return status;
}

static void write_lights(FILE *out, const lc_scene_desc *d)
{
    for (int i = 0; i < d->point_count; ++i) {
        const lc_point_desc *p = &d->points[i];
        fprintf(out, "<emitter type=\"point\"><point name=\"position\" x=\"%.17g\" y=\"%.17g\" z=\"%.17g\"/>",
                p->position.x, p->position.y, p->position.z);
        write_rgb(out, "intensity", p->intensity);
        fprintf(out, "</emitter>\n");
    }
    for (int i = 0; i < d->directional_count; ++i) {
        const lc_directional_desc *l = &d->directionals[i];
        fprintf(out, "<emitter type=\"directional\"><vector name=\"direction\" x=\"%.17g\" y=\"%.17g\" z=\"%.17g\"/>",
                l->direction.x, l->direction.y, l->direction.z);
        write_rgb(out, "irradiance", l->irradiance);
        fprintf(out, "</emitter>\n");
    }
    if (d->has_sky) {
        fprintf(out, "<emitter type=\"constant\">");
        write_rgb(out, "radiance", d->sky);
        fprintf(out, "</emitter>\n");
    }
}

lc_status lc_scene_write(FILE *out, const lc_scene_desc *d, lc_error *err)
{
    lc_status status = LC_OK;
    fprintf(out, "<scene version=\"3.0.0\">\n<integrator type=\"path\">");
    if (d->max_bounces >= 0)
        fprintf(out, "<integer name=\"max_depth\" value=\"%d\"/>", d->max_bounces >= LC_UNBOUNDED ? -1 : d->max_bounces + 1);
    fprintf(out, "</integrator>\n");
    write_camera(out, d);
    for (int i = 0; i < d->shape_count && status == LC_OK; ++i)
        status = write_shape(out, d, &d->shapes[i], err);
    write_lights(out, d);
    fprintf(out, "</scene>\n");
    if (status == LC_OK && (fflush(out) != 0 || ferror(out)))
        status = lc_fail(err, LC_FAULT, "%s: cannot write the scene", d->name);
    return status;
}
