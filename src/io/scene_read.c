/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Last part of the scene reader: checked elements -> lc_scene_desc. */
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/scene_path.h"
#include "io/scene_read.h"
#include "io/scene_read_material.h"

/* ---- shapes ---- */

static const struct {
    const char *type;
    lc_shape_kind kind;
} kinds[] = {{"rectangle", LC_RECTANGLE}, {"disk", LC_DISK}, {"cube", LC_CUBE}, {"sphere", LC_SPHERE}};

static int read_geometry(struct reader *r, const struct node *node, lc_shape_desc *shape)
{
    lc_affine *a = &shape->to_world;
    if (!scene_get_transform(r, node, "to_world", a) ||
        !scene_get_boolean(r, node, "flip_normals", &shape->flip_normals))
        return 0;
    if (lc_affine_determinant(a) < 0)
        return scene_fail(
            r, node,
            "a mirroring to_world, where Mitsuba's normals contradict each other; expected rotations, or flip_normals");
    if (shape->kind == LC_DISK && fabs(a->m[0][0] * a->m[0][1] + a->m[1][0] * a->m[1][1] + a->m[2][0] * a->m[2][1]) >
                                      1e-6 * fabs(lc_affine_determinant(a)))
        return scene_fail(r, node, "a sheared disk; supported: scale, rotate, translate");
    if (shape->kind != LC_SPHERE)
        return 1;
    if (scene_dissimilarity(a) > 1e-6)
        return scene_fail(r, node, "a sphere with shear or unequal scales; expected one scale in all directions");
    const struct node *center = scene_property(node, "center");
    lc_vec3 c = lc_vec(0, 0, 0);
    double radius = 1;
    if ((center && !scene_vector(r, center, &c)) || !scene_get_float(r, node, "radius", &radius))
        return 0;
    if (!(radius > 0))
        return scene_fail(r, node, "radius %g is not positive", radius);
    lc_affine local = {{{radius, 0, 0, c.x}, {0, radius, 0, c.y}, {0, 0, radius, c.z}}};
    *a = lc_affine_multiply(a, &local);
    return 1;
}

static int read_shape(struct reader *r, struct node *node)
{
    struct node *bsdf, *emitter;
    lc_shape_desc *shape = lc_scene_desc_add_shape(r->desc);
    if (!shape)
        return scene_no_memory(r);
    shape->line = node->line;
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; ++i)
        if (scene_type_is(node, kinds[i].type))
            shape->kind = kinds[i].kind;
    shape->radiance = lc_texture_constant(lc_black());
    const struct node *motion = scene_property(node, "motion");
    if (!read_geometry(r, node, shape) || (motion && !scene_vector(r, motion, &shape->motion)) || !scene_only_child(r, node, "bsdf", &bsdf) ||
        !scene_only_child(r, node, "emitter", &emitter))
        return 0;
    if (emitter) {
        if (!scene_type_is(emitter, "area"))
            return scene_fail(r, emitter, "emitter '%s' in a shape; expected area", emitter->plugin->type);
        shape->emits = 1;
        if (!scene_get_texture(r, emitter, "radiance", HUGE_VAL, lc_color(1, 1, 1), &shape->radiance))
            return 0;
    }
    if (!(bsdf ? scene_material_of(r, bsdf, &shape->material)
               : scene_default_material(r, shape->emits, &shape->material)))
        return 0;
    const lc_side *side = r->desc->materials[shape->material].side;
    if (shape->kind == LC_CUBE &&
        (side[0].diffuse.is_checkerboard || side[1].diffuse.is_checkerboard || shape->radiance.is_checkerboard))
        return scene_fail(r, node,
                          "a checkerboard on a cube, whose u and v are those of Mitsuba's mesh; supported on "
                          "rectangle, disk, sphere");
    return 1;
}

/* ---- emitters outside shapes ---- */

/* The vector `name`, or what to_world makes of `local`; Mitsuba wants at most one of them. */
static int place(struct reader *r, const struct node *node, const char *name, int is_point, lc_vec3 local, lc_vec3 *out)
{
    const struct node *value = scene_property(node, name);
    lc_affine a;
    if (value && scene_property(node, "to_world"))
        return scene_fail(r, node, "both %s and to_world; expected one of them", name);
    if (value)
        return scene_vector(r, value, out);
    if (!scene_get_transform(r, node, "to_world", &a))
        return 0;
    if (!is_point && (scene_dissimilarity(&a) > 1e-6 || fabs(lc_length(lc_affine_vector(&a, local)) - 1) > 1e-6))
        return scene_fail(r, node,
                          "to_world of a directional emitter with a scale, which would change Mitsuba's irradiance");
    *out = is_point ? lc_affine_point(&a, local) : lc_affine_vector(&a, local);
    return 1;
}

static int read_emitter(struct reader *r, const struct node *node)
{
    lc_rgb color = lc_color(1, 1, 1);
    lc_vec3 v;
    if (scene_type_is(node, "area"))
        return scene_fail(r, node, "an area emitter outside a shape; expected it in a <shape>");
    if (scene_type_is(node, "constant")) {
        if (r->desc->has_sky)
            return scene_fail(r, node, "a second constant emitter");
        r->desc->has_sky = 1;
        r->desc->sky = color;
        return scene_get_color(r, node, "radiance", HUGE_VAL, &r->desc->sky);
    }
    if (scene_type_is(node, "point")) {
        if (!place(r, node, "position", 1, lc_vec(0, 0, 0), &v) ||
            !scene_get_color(r, node, "intensity", HUGE_VAL, &color))
            return 0;
        lc_point_desc *point = lc_scene_desc_add_point(r->desc);
        if (!point)
            return scene_no_memory(r);
        point->position = v, point->intensity = color, point->line = node->line;
        return 1;
    }
    if (!place(r, node, "direction", 0, lc_vec(0, 0, 1), &v) ||
        !scene_get_color(r, node, "irradiance", HUGE_VAL, &color))
        return 0;
    if (!(lc_length(v) > 0 && isfinite(lc_length(v))))
        return scene_fail(r, node, "a direction of length 0");
    lc_directional_desc *directional = lc_scene_desc_add_directional(r->desc);
    if (!directional)
        return scene_no_memory(r);
    directional->direction = lc_normalize(v), directional->irradiance = color, directional->line = node->line;
    return 1;
}

/* ---- camera, film, integrator ---- */

static int read_integrator(struct reader *r, const struct node *node)
{
    int depth = -2, rr_depth = 5, hide = 0;
    if (!scene_get_integer(r, node, "max_depth", &depth) || !scene_get_integer(r, node, "rr_depth", &rr_depth) ||
        !scene_get_boolean(r, node, "hide_emitters", &hide))
        return 0;
    if (hide)
        return scene_fail(r, node, "hide_emitters is true; supported: false");
    if (rr_depth < 1)
        return scene_fail(r, node, "rr_depth %d; expected 1 or more", rr_depth);
    const struct node *given = scene_property(node, "max_depth");
    if (given && depth != -1 && depth < 1)
        return scene_fail(r, given, "max_depth %d; expected -1 (no limit) or at least 1 (emission only)", depth);
    if (scene_type_is(node, "direct"))
        r->desc->max_bounces = 1;
    else if (given)
        r->desc->max_bounces = depth == -1 || depth > LC_UNBOUNDED ? LC_UNBOUNDED : depth - 1;
    return 1;
}

static int read_film(struct reader *r, const struct node *node)
{
    static const char *const pixels[] = {"rgb", "rgba"}, *const numbers[] = {"float16", "float32"},
                             *const files[] = {"openexr"};
    lc_scene_desc *d = r->desc;
    struct node *filter;
    d->width = 768, d->height = 576; /* Mitsuba's defaults */
    if (!scene_get_integer(r, node, "width", &d->width) || !scene_get_integer(r, node, "height", &d->height) ||
        scene_get_word(r, node, "pixel_format", pixels, 2) < 0 ||
        scene_get_word(r, node, "component_format", numbers, 2) < 0 ||
        scene_get_word(r, node, "file_format", files, 1) < 0 || !scene_only_child(r, node, "rfilter", &filter))
        return 0;
    if (d->width < 1 || d->height < 1 || d->width > LC_MAX_SIZE || d->height > LC_MAX_SIZE)
        return scene_fail(r, node, "an image of %d x %d pixels; expected 1 to %d each way", d->width, d->height,
                          LC_MAX_SIZE);
    return filter ||
           scene_fail(r, node,
                      "no <rfilter type=\"box\"/>; Mitsuba's default is gaussian, while pixels here are means "
                      "over their squares");
}

static int read_view(struct reader *r, const struct node *node, lc_camera_desc *camera)
{
    static const char *const axes[] = {"x", "y", "diagonal", "smaller", "larger"}; /* in lc_fov_axis's order */
    const struct node *near_clip = scene_property(node, "near_clip");
    if (scene_property(node, "fov")) {
        int axis = scene_get_word(r, node, "fov_axis", axes, 5);
        if (axis < 0 || !scene_get_float(r, node, "fov", &camera->fov))
            return 0;
        camera->fov_axis = (lc_fov_axis)axis;
    } else if (scene_property(node, "fov_axis"))
        return scene_fail(r, node, "fov_axis without fov");
    if (!(camera->fov > 0 && camera->fov < 180))
        return scene_fail(r, node, "fov %g; expected degrees in (0, 180)", camera->fov);
    if (!scene_get_float(r, node, "near_clip", &camera->near_clip) ||
        !scene_get_float(r, node, "far_clip", &camera->far_clip))
        return 0;
    if (near_clip && !(camera->near_clip > 0))
        return scene_fail(r, near_clip, "near_clip %g is not positive", camera->near_clip);
    return camera->near_clip < camera->far_clip ||
           scene_fail(r, node, "near_clip %g is not below far_clip %g", camera->near_clip, camera->far_clip);
}

/* Mitsuba replaces an aperture of 0, and focuses at its far clip unless told where. */
static int read_lens(struct reader *r, const struct node *node, lc_camera_desc *camera)
{
    static const char *const names[] = {"aperture_radius", "focus_distance"};
    double *const values[] = {&camera->aperture_radius, &camera->focus_distance};
    for (int i = 0; i < 2 && scene_type_is(node, "thinlens"); ++i) {
        if (!scene_property(node, names[i]))
            return scene_fail(r, node, "thinlens without %s", names[i]);
        if (!scene_get_float(r, node, names[i], values[i]))
            return 0;
        if (!(*values[i] > 0))
            return scene_fail(r, scene_property(node, names[i]), "%s %g is not positive", names[i], *values[i]);
    }
    return 1;
}

static int read_sensor(struct reader *r, const struct node *node)
{
    lc_camera_desc *camera = &r->desc->camera;
    struct node *film, *sampler;
    int seed = 0;
    if (!read_view(r, node, camera) || !read_lens(r, node, camera) ||
        !scene_get_transform(r, node, "to_world", &camera->to_world))
        return 0;
    lc_vec3 x = lc_affine_vector(&camera->to_world, lc_vec(1, 0, 0));
    if (scene_dissimilarity(&camera->to_world) > 1e-6 || fabs(lc_length(x) - 1) > 1e-6 ||
        lc_affine_determinant(&camera->to_world) < 0)
        return scene_fail(r, node,
                          "a camera whose to_world scales, shears or mirrors; expected rotations and translations");
    if (!scene_only_child(r, node, "film", &film) || !scene_only_child(r, node, "sampler", &sampler))
        return 0;
    if (!film)
        return scene_fail(r, node, "a sensor without a <film>");
    r->desc->samples = 4; /* Mitsuba's default */
    if (sampler && (!scene_get_integer(r, sampler, "sample_count", &r->desc->samples) ||
                    !scene_get_integer(r, sampler, "seed", &seed)))
        return 0;
    if (r->desc->samples < 1)
        return scene_fail(r, sampler, "sample_count %d; expected 1 or more", r->desc->samples);
    return read_film(r, film);
}

/* ---- the whole ---- */

static int read_version(struct reader *r)
{
    const char *version = scene_attribute(r->root, "version");
    int part[3], end = 0;
    if (strcmp(r->root->tag, "scene") != 0)
        return scene_fail(r, r->root, "the outermost element is <%.40s>; expected <scene version=\"3.0.0\">",
                          r->root->tag);
    if (!scene_attributes_only(r, r->root, "version"))
        return 0;
    if (!version || sscanf(version, "%3d.%3d.%3d%n", &part[0], &part[1], &part[2], &end) != 3 || version[end] ||
        part[0] != 3)
        return scene_fail(r, r->root, "scene version '%.20s'; expected 3.x.y", version ? version : "");
    return 1;
}

static int read_object(struct reader *r, struct node *node)
{
    int index;
    lc_texture texture;
    if (strcmp(node->tag, "integrator") == 0)
        return read_integrator(r, node);
    if (strcmp(node->tag, "sensor") == 0)
        return read_sensor(r, node);
    if (strcmp(node->tag, "shape") == 0)
        return read_shape(r, node);
    if (strcmp(node->tag, "bsdf") == 0)
        return scene_material_of(r, node, &index);
    if (strcmp(node->tag, "texture") == 0)
        return scene_read_checkerboard(r, node, &texture);
    return read_emitter(r, node);
}

static int read_scene(struct reader *r)
{
    struct node *sensor, *integrator;
    if (!read_version(r) || !scene_check(r, r->root) || !scene_only_child(r, r->root, "sensor", &sensor) ||
        !scene_only_child(r, r->root, "integrator", &integrator))
        return 0;
    for (struct node *n = r->root->first; n; n = n->next)
        if (!read_object(r, n))
            return 0;
    return sensor || scene_fail(r, r->root, "no <sensor type=\"perspective\">");
}

/* "scenes/sky.xml" -> "sky". */
static int name_scene(struct reader *r)
{
    const char *slash = strrchr(r->name, '/'), *stem = slash ? slash + 1 : r->name, *dot = strrchr(stem, '.');
    size_t length = dot && dot > stem ? (size_t)(dot - stem) : strlen(stem);
    if (length >= sizeof r->desc->name)
        return scene_fail(r, NULL, "a file name of more than %d bytes", (int)sizeof r->desc->name - 1);
    memcpy(r->desc->name, stem, length);
    r->desc->name[length] = 0;
    return 1;
}

lc_status lc_scene_read_memory(lc_scene_desc *out, const char *text, size_t length, const char *name,
                               const lc_parameter *overrides, int override_count, lc_error *err)
{
    lc_scene_desc_init(out);
    struct reader *r = calloc(1, sizeof *r);
    /* strtod() follows the thread's locale, and a program that embeds us may have set one with a decimal comma. */
    locale_t c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (!r || !c_locale) {
        free(r);
        if (c_locale)
            freelocale(c_locale);
        return lc_fail(err, LC_FAULT, "%s: out of memory while reading it", name);
    }
    locale_t before = uselocale(c_locale);
    r->name = name, r->err = err, r->desc = out;
    r->overrides = overrides, r->override_count = override_count;
    if (name_scene(r) && scene_parse(r, text, length))
        read_scene(r);
    lc_status status = r->status;
    uselocale(before);
    freelocale(c_locale);
    scene_free(r);
    free(r);
    if (status != LC_OK)
        lc_scene_desc_release(out);
    return status;
}

lc_status lc_scene_read(lc_scene_desc *out, const char *path, const lc_parameter *overrides, int override_count,
                        lc_error *err)
{
    lc_status status;
    size_t length = 0, room = 1 << 16;
    char *text = NULL;
    lc_scene_desc_init(out);
    FILE *file = fopen(path, "rb");
    if (!file)
        return lc_fail(err, LC_BAD_INPUT, "%s: cannot open it; expected a scene (.xml)", path);
    while (!feof(file) && length <= LC_SCENE_MAX_BYTES) {
        char *more = realloc(text, room *= 2);
        if (!more) {
            status = lc_fail(err, LC_FAULT, "%s: out of memory while reading it", path);
            goto cleanup;
        }
        text = more;
        length += fread(text + length, 1, room - length, file);
        if (ferror(file)) {
            status = lc_fail(err, LC_FAULT, "%s: cannot read it", path);
            goto cleanup;
        }
    }
    status = lc_scene_read_memory(out, text, length, path, overrides, override_count, err);
cleanup:
    free(text);
    fclose(file);
    return status;
}

lc_status lc_scene_describe(lc_scene_desc *out, const char *name, lc_error *err)
{
    char path[LC_PATH_SIZE];
    lc_status status = lc_scene_locate(path, name, err);
    return status == LC_OK ? lc_scene_read(out, path, NULL, 0, err) : status;
}

lc_status lc_scene_open(lc_scene **out, const char *name, lc_error *err)
{
    lc_scene_desc desc;
    lc_status status = lc_scene_describe(&desc, name, err);
    if (status != LC_OK)
        return status;
    status = lc_scene_build(out, &desc, err);
    lc_scene_desc_release(&desc);
    return status;
}
