/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A scene as POV-Ray's: frame, camera, global settings. POV-Ray's world is called left-handed, but only its camera,
 * rotations and cross products know; here every vector of the camera is given and every transformation is a matrix, so
 * our coordinates are its coordinates.
 */
#include "verify/renderers/pov_export.h"

#include "verify/renderers/pov_export_c.h"

const char *const lc_pov_kind_names[] = {"rectangle", "disk", "cube", "sphere"};
static const char *const mode_names[] = {"direct", "radiosity", "specular", "gathered"}; /* in the order of lc_pov_mode */

int lc_pov_is_black(lc_rgb c) { return c.r == 0 && c.g == 0 && c.b == 0; }

void lc_pov_options_init(lc_pov_options *options)
{
    const lc_pov_options defaults = {LC_POV_DIRECT, 16, 0, 1, 400, {0, 0}, 0};
    *options = defaults;
}

/* ---- extent ---------------------------------------------------------------------------------------------------- */

typedef struct bounds {
    double lower[3], upper[3];
} bounds;

static void grow(bounds *b, lc_vec3 p)
{
    const double x[3] = {p.x, p.y, p.z};
    for (int i = 0; i < 3; ++i) {
        b->lower[i] = fmin(b->lower[i], x[i]);
        b->upper[i] = fmax(b->upper[i], x[i]);
    }
}

/* Corner i of the box around a standard shape, which is flat in z for rectangles and disks. */
static lc_vec3 corner_of(const lc_shape_desc *shape, int i)
{
    int flat = shape->kind == LC_RECTANGLE || shape->kind == LC_DISK;
    return lc_affine_point(&shape->to_world, lc_vec(i & 1 ? 1 : -1, i & 2 ? 1 : -1, flat ? 0 : (i & 4 ? 1 : -1)));
}

static void find_extent(lc_pov_writer *w)
{
    bounds b = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    grow(&b, lc_affine_point(&w->desc->camera.to_world, lc_vec(0, 0, 0)));
    for (int i = 0; i < w->desc->point_count; ++i)
        grow(&b, w->desc->points[i].position);
    for (int i = 0; i < w->desc->shape_count; ++i)
        for (int j = 0; j < 8; ++j)
            grow(&b, corner_of(&w->desc->shapes[i], j));
    lc_vec3 lower = lc_vec(b.lower[0], b.lower[1], b.lower[2]), upper = lc_vec(b.upper[0], b.upper[1], b.upper[2]);
    w->center = lc_scale(0.5, lc_add(lower, upper));
    w->radius = 0.5 * lc_length(lc_sub(upper, lower));
    if (!(w->radius > 0))
        w->radius = 1;
    int exponent;
    frexp(w->radius, &exponent);
    w->unit = ldexp(LC_POV_EXTENT, -exponent);
}

/* ---- what cannot be said ----------------------------------------------------------------------------------------- */

/* POV-Ray's camera clips nothing: fine where nothing lies in what would be cut. */
static lc_status check_clips(const lc_scene_desc *desc, lc_error *err)
{
    const lc_camera_desc *camera = &desc->camera;
    lc_vec3 eye = lc_affine_point(&camera->to_world, lc_vec(0, 0, 0));
    lc_vec3 axis = lc_affine_vector(&camera->to_world, lc_vec(0, 0, 1));
    for (int i = 0; i < desc->shape_count; ++i) {
        double least = INFINITY, most = -INFINITY;
        for (int j = 0; j < 8; ++j) {
            double depth = lc_dot(axis, lc_sub(corner_of(&desc->shapes[i], j), eye));
            least = fmin(least, depth);
            most = fmax(most, depth);
        }
        if ((least < camera->near_clip && most > 0 && camera->near_clip > 0) || most > camera->far_clip)
            return lc_fail(err, LC_BAD_INPUT,
                           "%s:%d: the %s may be cut by near_clip or far_clip, which POV-Ray's camera does not have",
                           desc->name, desc->shapes[i].line, lc_pov_kind_names[desc->shapes[i].kind]);
    }
    return LC_OK;
}

static lc_status check_lens(const lc_scene_desc *desc, lc_error *err)
{
    if (!(desc->camera.aperture_radius > 0))
        return LC_OK;
    return lc_fail(err, LC_BAD_INPUT,
                   "%s: a lens: POV-Ray's focal blur takes few samples of a fixed pattern, and no more where it trusts them",
                   desc->name);
}

static lc_status check_options(const lc_pov_options *o, lc_error *err)
{
    if (o->area_samples < 2 || o->area_samples > 256)
        return lc_fail(err, LC_BAD_INPUT, "%d points along a lamp's side, expected 2 to 256", o->area_samples);
    int least = o->mode == LC_POV_SPECULAR || o->mode == LC_POV_DIRECT ? 0 : 1, most = o->mode == LC_POV_SPECULAR    ? 250
                                                           : o->mode == LC_POV_RADIOSITY ? 20
                                                           : o->mode == LC_POV_GATHERED  ? 2
                                                                                         : 1;
    if (o->bounces < least || o->bounces > most)
        return lc_fail(err, LC_BAD_INPUT, "%d bounces, expected %d to %d with mode %s", o->bounces, least, most,
                       mode_names[o->mode]);
    if ((o->mode == LC_POV_RADIOSITY || o->mode == LC_POV_GATHERED) && (o->count < 1 || o->count > 1600))
        return lc_fail(err, LC_BAD_INPUT, "%d rays of a gathering, expected 1 to 1600", o->count);
    return LC_OK;
}

static lc_status check_sky(const lc_pov_writer *w, lc_error *err)
{
    if (!w->desc->has_sky || lc_pov_is_black(w->desc->sky))
        return LC_OK;
    if (w->options->mode == LC_POV_DIRECT)
        return lc_fail(err, LC_BAD_INPUT,
                       "%s: a sky lights surfaces only through POV-Ray's radiosity: mode radiosity, 1 bounce or more",
                       w->desc->name);
    return LC_OK;
}

/* ---- writing ----------------------------------------------------------------------------------------------------- */

static void write_head(const lc_pov_writer *w)
{
    const lc_pov_options *o = w->options;
    fprintf(w->out,
            "// %s: written by lightcheck %s for POV-Ray 3.7 from the scene of that name.\n"
            "// Mode %s, bounces at most %d; %s.\n",
            w->desc->name, LC_VERSION, mode_names[o->mode], o->bounces,
            o->emission ? "with what the camera sees glow"
                        : "reflected light only: lamps that the camera sees are dark");
    fprintf(
        w->out,
        "//   povray +I%s.pov +O%s.exr +FE +W%d +H%d -A -D\n"
        "// gives linear radiance [W sr^-1 m^-2] at pixel centres: render larger and average blocks for pixel means.\n"
        "// 1 m is %g units: POV-Ray's tolerances are absolute, about 1e-3 units.\n\n",
        w->desc->name, w->desc->name, 8 * w->desc->width, 8 * w->desc->height, w->unit);
}

/* Lamps stand for light sources; elsewhere they glow. */
static int lights_are_sources(const lc_pov_options *o)
{
    return (o->mode == LC_POV_DIRECT && o->bounces > 0) || o->mode == LC_POV_RADIOSITY;
}

static void write_global(const lc_pov_writer *w)
{
    const lc_pov_options *o = w->options;
    fprintf(w->out, "#version 3.7;\n");
    fprintf(w->out,
            "global_settings {\n"
            "    assumed_gamma 1.0\n"
            "    ambient_light rgb 0\n"
            "    max_trace_level %d\n"
            "    adc_bailout 1e-6 // a path's weight below which it ends\n",
            o->mode == LC_POV_SPECULAR ? o->bounces + 1 : 5);
    /* Light gathered by a ray is what the surface there reflects: one bounce is gathered with the sky alone. */
    int depth = o->mode == LC_POV_GATHERED    ? 1
                : o->mode != LC_POV_RADIOSITY ? 0
                : w->desc->has_sky            ? o->bounces
                                              : o->bounces - 1;
    if (depth > 0)
        fprintf(w->out,
                "    radiosity {\n"
                "        recursion_limit %d // diffuse bounces %s\n"
                "        count %d\n"
                "        error_bound 0.1 low_error_factor 0.5 nearest_count 10 minimum_reuse 0.002\n"
                "        pretrace_start 0.08 pretrace_end 0.005\n"
                "        gray_threshold 0 brightness 1 adc_bailout 1e-4 always_sample on normal off\n"
                "    }\n",
                depth, lights_are_sources(o) ? "on top of the light sources'" : "in all: nothing but what glows gives light", o->count);
    fprintf(w->out, "}\n#default { finish { ambient 0 diffuse 0 emission 0 } }\n\n");
}

static void write_vector(const lc_pov_writer *w, const char *name, lc_vec3 v)
{
    fprintf(w->out, "    %s <%.15g, %.15g, %.15g>\n", name, v.x, v.y, v.z);
}

/* A ray of POV-Ray is direction + x right + y up, x and y in [-1/2, 1/2]: the three corners of our image say what these
 * are. */
static void write_camera(const lc_pov_writer *w)
{
    const lc_scene_desc *d = w->desc;
    lc_camera_desc camera = d->camera;
    lc_vec3 axis = lc_affine_vector(&camera.to_world, lc_vec(0, 0, 1));
    lc_vec3 left = lc_affine_vector(&camera.to_world, lc_vec(1, 0, 0));
    lc_vec3 up = lc_affine_vector(&camera.to_world, lc_vec(0, 1, 0));
    lc_ray corner = lc_camera_ray(&camera, d->width, d->height, 0, 0); /* upper left */
    double depth = lc_dot(corner.d, axis);
    double x = lc_dot(corner.d, left) / lc_dot(left, left) / depth, y = lc_dot(corner.d, up) / lc_dot(up, up) / depth;
    fprintf(w->out,
            "// %.9g degrees across, %.9g high; right points to the image's right, so no mirroring whatever the "
            "handedness\ncamera {\n    perspective\n",
            atan(x) * 360 / LC_PI, atan(y) * 360 / LC_PI);
    write_vector(w, "location", lc_scale(w->unit, lc_affine_point(&camera.to_world, lc_vec(0, 0, 0))));
    lc_vec3 across = lc_scale(-2 * x, left), high = lc_scale(2 * y, up);
    write_vector(w, "right", across);
    write_vector(w, "up", high);
    write_vector(w, "direction", lc_add(axis, lc_sub(lc_scale(w->options->shift[0] / d->width, across),
                                                     lc_scale(w->options->shift[1] / d->height, high))));
    fprintf(w->out, "}\n\n");
}

/* Seen by the camera as a background; by gathering rays only, where L_0 is not wanted, as a ball around everything. */
static void write_sky(const lc_pov_writer *w)
{
    lc_rgb sky = w->desc->sky;
    if (!w->desc->has_sky || lc_pov_is_black(sky))
        return;
    fprintf(w->out, "// constant sky\n");
    if (w->options->emission) {
        fprintf(w->out, "background { rgb <%.15g, %.15g, %.15g> }\n\n", sky.r, sky.g, sky.b);
        return;
    }
    lc_vec3 c = lc_scale(w->unit, w->center);
    fprintf(w->out,
            "sphere {\n    <%.15g, %.15g, %.15g>, %.15g\n"
            "    texture { pigment { rgb 1 } finish { emission rgb <%.15g, %.15g, %.15g> } }\n"
            "    no_image no_shadow\n}\n\n",
            c.x, c.y, c.z, 16 * LC_POV_EXTENT, sky.r, sky.g, sky.b);
}

lc_status lc_pov_export(FILE *out, const lc_scene_desc *desc, const lc_pov_options *options, lc_error *err)
{
    lc_pov_writer w = {out, desc, options, 1, {0, 0, 0}, 1};
    find_extent(&w);
    lc_status status = check_options(options, err);
    if (status == LC_OK)
        status = check_clips(desc, err);
    if (status == LC_OK)
        status = check_lens(desc, err);
    if (status == LC_OK)
        status = check_sky(&w, err);
    if (status == LC_OK)
        status = lc_pov_check_shapes(&w, err);
    if (status == LC_OK)
        status = lc_pov_check_lights(&w, err);
    if (status != LC_OK)
        return status;
    write_head(&w);
    write_global(&w);
    write_camera(&w);
    write_sky(&w);
    lc_pov_write_shapes(&w);
    if (lights_are_sources(options))
        status = lc_pov_write_lights(&w, err);
    if (status != LC_OK)
        return status;
    if (fflush(out) != 0 || ferror(out))
        return lc_fail(err, LC_FAULT, "%s: cannot write the scene for POV-Ray", desc->name);
    return LC_OK;
}
