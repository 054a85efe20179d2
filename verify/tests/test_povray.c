/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * POV-Ray: what is written for it, what it makes of that, and that a wrong scene is found by its images. Tests that
 * need the program pass where there is none; the kept images are tested everywhere.
 */
#include "verify/tests/tests.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "estimators/registry.h"
#include "io/exr.h"
#include "io/scene_path.h"
#include "io/scene_read.h"
#include "verify/judge/judge.h"
#include "verify/renderers/pov_reference.h"

static lc_error err;

static int has_povray(void)
{
    char version[128];
    return lc_pov_version(version, sizeof version, NULL) == LC_OK;
}

#define HEAD \
    "<scene version=\"3.0.0\"><sensor type=\"perspective\"><float name=\"fov\" value=\"20\"/><transform " \
    "name=\"to_world\"><lookat origin=\"0 0 3\" target=\"0 0 0\" up=\"0 1 0\"/></transform><film type=\"hdrfilm\">" \
    "<integer name=\"width\" value=\"8\"/><integer name=\"height\" value=\"8\"/><rfilter type=\"box\"/></film>" \
    "</sensor>"
#define LAMP "<emitter type=\"area\"><rgb name=\"radiance\" value=\"1 2 3\"/></emitter>"
#define GLASS \
    "<bsdf type=\"dielectric\"><float name=\"int_ior\" value=\"1.5\"/><float name=\"ext_ior\" value=\"1\"/></bsdf>"
#define MIRROR(a) "<bsdf type=\"conductor\"><rgb name=\"specular_reflectance\" value=\"" a "\"/></bsdf>"
#define SHAPE(type, transform, rest) \
    "<shape type=\"" type "\"><transform name=\"to_world\">" transform "</transform>" rest "</shape>"
#define CHECKER(name) \
    "<texture type=\"checkerboard\" name=\"" name "\"><rgb name=\"color0\" value=\"0.9\"/><rgb name=\"color1\" " \
    "value=\"0.1\"/></texture>"

static void read_text(lc_scene_desc *desc, const char *text)
{
    ck_assert_msg(lc_scene_read_memory(desc, text, strlen(text), "test.xml", NULL, 0, &err) == LC_OK, "%s", err.text);
}

static lc_status export_text(char **text, const lc_scene_desc *desc, const lc_pov_options *options)
{
    size_t length;
    FILE *file = open_memstream(text, &length);
    lc_status status = lc_pov_export(file, desc, options, &err);
    fclose(file);
    return status;
}

/* ---- text -------------------------------------------------------------------------------------------------------- */

START_TEST(export_says_what_each_part_is)
{
    lc_scene_desc desc;
    lc_pov_options options;
    char *text, *again;
    lc_pov_options_init(&options);
    options.area_samples = 3;
    read_text(&desc, HEAD "<shape type=\"rectangle\">\n<bsdf type=\"diffuse\" id=\"w\"/></shape>\n<shape "
                          "type=\"sphere\">" LAMP "</shape></scene>");
    ck_assert_int_eq(export_text(&text, &desc, &options), LC_OK);
    ck_assert_int_eq(export_text(&again, &desc, &options), LC_OK);
    ck_assert_str_eq(text, again);
    ck_assert_ptr_nonnull(strstr(text, "// rectangle of line 1, material w\n"));
    ck_assert_ptr_nonnull(strstr(text, "// sphere of line 3, a lamp\n"));
    ck_assert_ptr_nonnull(strstr(text, "// the light of the sphere of line 3\n"));
    ck_assert_ptr_nonnull(strstr(text, "assumed_gamma 1.0"));
    ck_assert_ptr_null(strstr(text, "#include"));
    ck_assert_ptr_null(strstr(text, "emission rgb")); /* not asked for: the lamp is dark */
    free(text);
    options.emission = 1;
    ck_assert_int_eq(export_text(&text, &desc, &options), LC_OK);
    ck_assert_ptr_nonnull(strstr(text, "emission rgb <1, 2, 3>"));
    free(text);
    free(again);
    desc.camera.aperture_radius = desc.camera.focus_distance = 1;
    ck_assert_int_eq(export_text(&text, &desc, &options), LC_BAD_INPUT);
    ck_assert_ptr_nonnull(strstr(err.text, "a lens"));
    free(text);
    lc_scene_desc_release(&desc);
}
END_TEST

static const struct {
    const char *scene;
    lc_pov_mode mode;
    const char *reason;
} refused[] = {
    {HEAD "<emitter type=\"constant\"/></scene>", LC_POV_DIRECT, "sky"},
    {HEAD "<emitter type=\"constant\"/><emitter type=\"point\"/></scene>", LC_POV_RADIOSITY, "not both"},
    {HEAD "<shape type=\"sphere\">" GLASS "</shape></scene>", LC_POV_DIRECT, "through glass"},
    {HEAD "<shape type=\"sphere\">" MIRROR("1") "</shape></scene>", LC_POV_RADIOSITY, "off a mirror"},
    {HEAD "<shape type=\"sphere\"/></scene>", LC_POV_SPECULAR, "diffuse"},
    {HEAD "<shape type=\"sphere\"><vector name=\"motion\" value=\"1 0 0\"/></shape></scene>", LC_POV_DIRECT, "moves"},
    {HEAD "<shape type=\"sphere\"><bsdf type=\"roughconductor\"><string name=\"distribution\" value=\"ggx\"/></bsdf>"
          "</shape></scene>",
     LC_POV_SPECULAR, "no rough mirror"},
    {HEAD "<shape type=\"rectangle\">" GLASS "</shape></scene>", LC_POV_SPECULAR, "volume"},
    {HEAD "<shape type=\"sphere\">" GLASS "</shape><shape type=\"cube\">" GLASS "</shape></scene>", LC_POV_SPECULAR,
     "other glass"},
    {HEAD "<shape type=\"sphere\"><bsdf type=\"blendbsdf\"><float name=\"weight\" value=\"0.5\"/>" GLASS MIRROR(
         "1") "</bsdf>"
              "</shape></scene>",
     LC_POV_SPECULAR, "blend"},
    {HEAD "<shape type=\"sphere\"><bsdf type=\"diffuse\">" CHECKER("reflectance") "</bsdf></shape></scene>",
     LC_POV_DIRECT, "rectangles only"},
    {HEAD "<shape type=\"rectangle\"><emitter type=\"area\">" CHECKER("radiance") "</emitter></shape></scene>",
     LC_POV_DIRECT, "many lamps"},
    {HEAD "<emitter type=\"point\"/></scene>", LC_POV_GATHERED, "no ray meets"},
    {HEAD "<shape type=\"sphere\">" GLASS "</shape></scene>", LC_POV_GATHERED, "through glass"},
};

START_TEST(what_cannot_be_expressed_is_refused_with_the_reason)
{
    lc_scene_desc desc;
    lc_pov_options options;
    char *text;
    lc_pov_options_init(&options);
    options.mode = refused[_i].mode;
    options.emission = 1;
    read_text(&desc, refused[_i].scene);
    ck_assert_int_eq(export_text(&text, &desc, &options), LC_BAD_INPUT);
    ck_assert_msg(strstr(err.text, refused[_i].reason) != NULL, "%s", err.text);
    free(text);
    lc_scene_desc_release(&desc);
}
END_TEST

START_TEST(clips_are_refused_only_where_they_cut)
{
    lc_scene_desc desc;
    lc_pov_options options;
    char *text;
    lc_pov_options_init(&options);
    read_text(&desc, HEAD "<shape type=\"sphere\"/></scene>"); /* depths 2 to 4 */
    desc.camera.near_clip = 1.9;
    desc.camera.far_clip = 4.1;
    ck_assert_int_eq(export_text(&text, &desc, &options), LC_OK);
    free(text);
    desc.camera.near_clip = 2.1;
    ck_assert_int_eq(export_text(&text, &desc, &options), LC_BAD_INPUT);
    free(text);
    desc.camera.near_clip = 0;
    desc.camera.far_clip = 3.9;
    ck_assert_int_eq(export_text(&text, &desc, &options), LC_BAD_INPUT);
    free(text);
    lc_scene_desc_release(&desc);
}
END_TEST

/* ---- what POV-Ray sees, against what we see, at the centres of the pixels ---------------------------------------- */

static lc_affine map(double sx, double sy, double sz, double angle, lc_vec3 axis, lc_vec3 at)
{
    double c = cos(angle), s = sin(angle), k = 1 - c, scale[3] = {sx, sy, sz};
    lc_vec3 a = lc_normalize(axis);
    double r[3][3] = {{c + k * a.x * a.x, k * a.x * a.y - s * a.z, k * a.x * a.z + s * a.y},
                      {k * a.x * a.y + s * a.z, c + k * a.y * a.y, k * a.y * a.z - s * a.x},
                      {k * a.x * a.z - s * a.y, k * a.y * a.z + s * a.x, c + k * a.z * a.z}};
    lc_affine m = {{{0, 0, 0, at.x}, {0, 0, 0, at.y}, {0, 0, 0, at.z}}};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            m.m[i][j] = r[i][j] * scale[j];
    return m;
}

/* All kinds of shapes, seen from front and back, flipped and not; a small ball near each corner of the image. */
static void add_shapes(lc_scene_desc *desc)
{
    const lc_camera_desc *camera = &desc->camera;
    ck_assert_ptr_nonnull(lc_scene_desc_add_material(desc));
    for (int i = 0; i < 20; ++i) {
        lc_shape_desc *shape = lc_scene_desc_add_shape(desc);
        ck_assert_ptr_nonnull(shape);
        double x = desc->width * (0.1 + 0.2 * (i % 5)), y = desc->height * (0.15 + 0.23 * (i / 5)), size = 0.12;
        if (i >= 16) {
            x = i & 1 ? desc->width - 1.5 : 1.5;
            y = i & 2 ? desc->height - 1.5 : 1.5;
            size = 0.02;
        }
        lc_ray ray = lc_camera_ray(camera, desc->width, desc->height, x, y);
        lc_vec3 at = lc_add(ray.o, lc_scale(2.0 + 0.1 * i, ray.d));
        shape->kind = i >= 16 ? LC_SPHERE : (lc_shape_kind)(i % 4);
        int round = shape->kind == LC_SPHERE;
        shape->to_world =
            map(size, round ? size : 0.8 * size, round ? size : 0.6 * size, 1.3 * i, lc_vec(1, 0.3 * i - 2, 0.5), at);
        shape->flip_normals = (i / 3) % 2;
        shape->emits = 1;
        shape->radiance = lc_texture_constant(lc_color(0.25 + 0.03 * i, 1 - 0.04 * i, 0.5 + 0.1 * (i % 3)));
    }
}

/* Number of pixels whose centre POV-Ray sees otherwise. */
static int count_differences(const lc_scene_desc *desc, const lc_pov_options *options,
                             lc_rgb (*see)(const lc_scene *, const lc_hit *))
{
    lc_scene *scene;
    lc_pov_run run;
    int different = 0, lit = 0, pixels = desc->width * desc->height;
    double *rgb = calloc(3 * (size_t)pixels, sizeof *rgb);
    lc_pov_run_init(&run);
    run.supersampling = 1;
    ck_assert_msg(lc_pov_render(rgb, desc, options, &run, &err) == LC_OK, "%s", err.text);
    ck_assert_msg(lc_scene_build(&scene, desc, &err) == LC_OK, "%s", err.text);
    for (int i = 0; i < pixels; ++i) {
        lc_hit hit;
        lc_ray ray =
            lc_camera_ray(&desc->camera, desc->width, desc->height, i % desc->width + 0.5, i / desc->width + 0.5);
        lc_intersect(scene, &ray, &hit);
        lc_rgb is = see(scene, &hit);
        different += !(fabs(is.r - rgb[3 * i]) <= 0x1p-10 * is.r && fabs(is.g - rgb[3 * i + 1]) <= 0x1p-10 * is.g &&
                       fabs(is.b - rgb[3 * i + 2]) <= 0x1p-10 * is.b);
        lit += lc_rgb_max(is) > 0;
    }
    lc_scene_free(scene);
    free(rgb);
    ck_assert_int_gt(lit, pixels / 50);
    return different;
}

START_TEST(camera_and_shapes_are_seen_pixel_by_pixel)
{
    lc_scene_desc desc;
    lc_pov_options options;
    if (!has_povray())
        return;
    lc_scene_desc_init(&desc);
    desc.width = 160;
    desc.height = 100;
    desc.camera.to_world = map(1, 1, 1, 2.1, lc_vec(0.2, 1, -0.4), lc_vec(0.3, -0.7, 1.1));
    desc.camera.fov = 41;
    desc.camera.fov_axis = LC_FOV_Y;
    add_shapes(&desc);
    lc_pov_options_init(&options);
    options.area_samples = 2;
    options.emission = 1;
    ck_assert_int_eq(count_differences(&desc, &options, lc_emission), 0);
    lc_scene_desc_release(&desc);
}
END_TEST

static lc_rgb lit_from_above(const lc_scene *scene, const lc_hit *hit)
{
    if (!hit->valid)
        return lc_black();
    const lc_directional_desc *light = &lc_scene_description(scene)->directionals[0];
    double cosine = -lc_dot(lc_facing(hit->n, hit->wo), light->direction);
    lc_rgb albedo = lc_material_at(scene, hit).diffuse;
    return lc_rgb_scale(fmax(cosine, 0) * LC_INV_PI, lc_rgb_mul(albedo, light->irradiance));
}

START_TEST(checkerboards_lie_where_ours_do)
{
    lc_scene_desc desc;
    lc_pov_options options;
    if (!has_povray())
        return;
    read_text(&desc, HEAD "<shape type=\"rectangle\"><bsdf type=\"diffuse\">" CHECKER(
                         "reflectance") "</bsdf></shape>"
                                        "<emitter type=\"directional\"><vector name=\"direction\" value=\"0.36 0.48 "
                                        "-0.8\"/></emitter></scene>");
    desc.width = 100;
    desc.height = 70;
    lc_texture *texture = &desc.materials[desc.shapes[0].material].side[0].diffuse;
    texture->scale[0] = 3.1;
    texture->scale[1] = -4.7;
    texture->offset[0] = 0.3;
    texture->offset[1] = -1.6;
    desc.shapes[0].to_world = map(0.7, 0.5, 1, 0.4, lc_vec(1, 0.5, 2), lc_vec(0.05, 0.02, 0));
    lc_pov_options_init(&options);
    ck_assert_int_eq(count_differences(&desc, &options, lit_from_above), 0);
    lc_scene_desc_release(&desc);
}
END_TEST

/* ---- specular chains, in closed form ----------------------------------------------------------------------------- */

/* T_m = (1 - R)^2 sum_{j <= m/2} R^(2 j) with R = .04; and a L + a b a L when the second mirror glows. */
static const struct {
    const char *scene;
    int bounces;
    double red;
} chains[] = {
    {HEAD SHAPE("cube", "<scale value=\"2 2 0.1\"/>", GLASS)
         SHAPE("rectangle", "<scale value=\"5\"/><translate z=\"-1\"/>", LAMP) "</scene>",
     2, 0.9216},
    {HEAD SHAPE("rectangle", "<scale value=\"5\"/>", MIRROR("0.8 0.5 0.3"))
         SHAPE("rectangle", "<scale value=\"9\"/><rotate x=\"1\" angle=\"180\"/><translate z=\"4\"/>",
               MIRROR("0.9") LAMP) "</scene>",
     4, 0.8 + 0.8 * 0.9 * 0.8},
};

START_TEST(specular_chains_end_at_the_bounces_asked_for)
{
    lc_scene_desc desc;
    lc_pov_options options;
    lc_pov_run run;
    double rgb[3 * 64];
    if (!has_povray())
        return;
    read_text(&desc, chains[_i].scene);
    lc_pov_options_init(&options);
    lc_pov_run_init(&run);
    options.mode = LC_POV_SPECULAR;
    options.emission = 1;
    options.bounces = chains[_i].bounces;
    run.supersampling = 1;
    ck_assert_msg(lc_pov_render(rgb, &desc, &options, &run, &err) == LC_OK, "%s", err.text);
    for (int i = 0; i < 64; ++i)
        ck_assert_double_eq_tol(rgb[3 * i], chains[_i].red, 0x1p-10 * chains[_i].red);
    lc_scene_desc_release(&desc);
}
END_TEST

/* ---- the program ------------------------------------------------------------------------------------------------- */

START_TEST(a_scene_that_povray_refuses_is_a_fault_in_its_words)
{
    lc_pov_run run;
    double rgb[3];
    static const char text[] = "#version 3.7;\nsphere { 0 }\n";
    lc_pov_run_init(&run);
    if (!has_povray())
        return;
    ck_assert_int_eq(lc_pov_render_text(rgb, text, sizeof text - 1, 1, 1, &run, &err), LC_FAULT);
    ck_assert_msg(strstr(err.text, "Parse Error") != NULL, "%s", err.text);
}
END_TEST

START_TEST(a_scene_that_never_ends_is_stopped)
{
    lc_pov_run run;
    double rgb[3];
    static const char text[] = "#version 3.7;\n#declare I = 0; #while (I < 1) #declare I = I / 2; #end\n";
    lc_pov_run_init(&run);
    run.seconds = 0.2;
    if (!has_povray())
        return;
    ck_assert_int_eq(lc_pov_render_text(rgb, text, sizeof text - 1, 1, 1, &run, &err), LC_FAULT);
    ck_assert_msg(strstr(err.text, "stopped after") != NULL, "%s", err.text);
}
END_TEST

START_TEST(without_povray_there_is_no_version)
{
    char version[64], path[4096];
    const char *before = getenv("PATH");
    snprintf(path, sizeof path, "%s", before ? before : "");
    setenv("PATH", "/nonexistent:/", 1);
    lc_status status = lc_pov_version(version, sizeof version, &err);
    setenv("PATH", path, 1);
    ck_assert_int_eq(status, LC_BAD_INPUT);
}
END_TEST

/* ---- kept images ------------------------------------------------------------------------------------------------- */

START_TEST(hash_is_fnv_1a)
{
    ck_assert_uint_eq(lc_hash(LC_HASH, "", 0), 0xcbf29ce484222325u);
    ck_assert_uint_eq(lc_hash(LC_HASH, "foobar", 6), 0x85944171f73967e8u); /* the authors' test vector */
}
END_TEST

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");
    ck_assert_ptr_nonnull(file);
    fputs(text, file);
    fclose(file);
}

START_TEST(references_of_another_scene_or_case_are_refused)
{
    char folder[] = "/tmp/lightcheck-test-XXXXXX", scene[64], path[96];
    double rgb[12] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, error[4] = {0.25, 0.5, 1, 0.125};
    const lc_pov_image image = {2, 2, rgb, error, 0.01, 3};
    lc_pov_image back;
    lc_pov_case c = lc_pov_cases[0];
    if (!has_povray())
        return;
    c.supersampling = 1;
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(scene, sizeof scene, "%s/scene.xml", folder);
    write_file(scene, "one scene");
    ck_assert_int_eq(lc_pov_reference_read(&back, folder, scene, &c, &err), LC_WRONG);
    ck_assert_msg(strstr(err.text, "missing") != NULL, "%s", err.text);
    ck_assert_msg(lc_pov_reference_write(folder, scene, &c, &image, &err) == LC_OK, "%s", err.text);
    ck_assert_msg(lc_pov_reference_read(&back, folder, scene, &c, &err) == LC_OK, "%s", err.text);
    ck_assert_int_eq(back.width * 10 + back.height, 22);
    for (int i = 0; i < 12; ++i)
        ck_assert_double_eq(back.rgb[i], rgb[i]);
    for (int i = 0; i < 4; ++i)
        ck_assert_double_eq_tol(back.error[i], error[i], 1e-6);
    lc_pov_image_release(&back);
    c.area_samples += 1;
    ck_assert_int_eq(lc_pov_reference_read(&back, folder, scene, &c, &err), LC_WRONG);
    c.area_samples -= 1;
    write_file(scene, "another scene");
    ck_assert_int_eq(lc_pov_reference_read(&back, folder, scene, &c, &err), LC_WRONG);
    ck_assert_msg(strstr(err.text, "changed") != NULL, "%s", err.text);
    lc_film *film;
    snprintf(path, sizeof path, "%s/%s.pov.exr", folder, c.scene);
    ck_assert_int_eq(lc_exr_read(&film, path, NULL), LC_OK);
    ck_assert_int_eq(film->has_third, 0); /* an error it has; of its skewness nobody knows */
    lc_film_free(film);
    static const char *const ends[] = {".pov.exr", ".pov.json"};
    for (int i = 0; i < 2; ++i) {
        snprintf(path, sizeof path, "%s/%s%s", folder, c.scene, ends[i]);
        ck_assert_int_eq(unlink(path), 0);
    }
    unlink(scene);
    rmdir(folder);
}
END_TEST

/* ---- altered scenes are found ------------------------------------------------------------------------------------ */

static const char *altered_scene;
static void (*alter)(lc_scene_desc *desc);

static lc_status load_altered(lc_scene **out, const char *name, lc_error *e)
{
    lc_scene_desc desc;
    lc_status status = lc_scene_describe(&desc, name, e);
    if (status != LC_OK)
        return status;
    if (alter && strcmp(name, altered_scene) == 0)
        alter(&desc);
    status = lc_scene_build(out, &desc, e);
    lc_scene_desc_release(&desc);
    return status;
}

static void brighten_lamp(lc_scene_desc *desc)
{
    for (int i = 0; i < desc->shape_count; ++i)
        desc->shapes[i].radiance.color[0] = lc_rgb_scale(1.01, desc->shapes[i].radiance.color[0]);
}

static void brighten_point(lc_scene_desc *desc)
{
    desc->points[0].intensity = lc_rgb_scale(1.01, desc->points[0].intensity);
}

static void brighten_sun(lc_scene_desc *desc)
{
    desc->directionals[0].irradiance = lc_rgb_scale(1.01, desc->directionals[0].irradiance);
}

static void brighten_sky(lc_scene_desc *desc) { desc->sky = lc_rgb_scale(1.01, desc->sky); }

/* By 2% of the Cornell box's 2 m. */
static void move_box(lc_scene_desc *desc)
{
    for (int i = 0; i < desc->shape_count; ++i)
        if (desc->shapes[i].kind == LC_CUBE) {
            desc->shapes[i].to_world.m[0][3] += 0.04;
            return;
        }
}

/* Beyond the margin of gathered light, which is 3%. */
static void brighten_room(lc_scene_desc *desc)
{
    for (int i = 0; i < desc->shape_count; ++i)
        desc->shapes[i].radiance.color[0] = lc_rgb_scale(1.05, desc->shapes[i].radiance.color[0]);
}

/* Beyond the margin of lamps that are gathered, which is 10%. */
static void brighten_gathered(lc_scene_desc *desc)
{
    for (int i = 0; i < desc->shape_count; ++i)
        desc->shapes[i].radiance.color[0] = lc_rgb_scale(1.15, desc->shapes[i].radiance.color[0]);
}

static const struct {
    const char *scene, *estimator;
    void (*alter)(lc_scene_desc *desc);
    lc_row_verdict verdict;
} alterations[] = {
    {"plane_rectangle", "light_direct", NULL, LC_ROW_PASS},
    {"plane_rectangle", "light_direct", brighten_lamp, LC_ROW_FAIL},
    {"cornell", "light_direct", NULL, LC_ROW_PASS},
    {"cornell", "light_direct", brighten_lamp, LC_ROW_FAIL},
    {"cornell", "light_direct", move_box, LC_ROW_FAIL},
    {"plane_point", "light_direct", brighten_point, LC_ROW_FAIL},
    {"plane_directional", "light_direct", NULL, LC_ROW_PASS},
    {"plane_directional", "light_direct", brighten_sun, LC_ROW_FAIL},
    {"mirror_corridor", "mirror", NULL, LC_ROW_PASS},
    {"mirror_corridor", "mirror", brighten_lamp, LC_ROW_FAIL},
    {"glass_slab", "dielectric", brighten_lamp, LC_ROW_FAIL},
    {"textured_lamp", "light_direct", NULL, LC_ROW_PASS},
    {"textured_lamp", "light_direct", brighten_lamp, LC_ROW_FAIL},
    {"sky", "hemisphere_direct", brighten_sky, LC_ROW_FAIL},
    {"bright_room", "path", brighten_room, LC_ROW_FAIL},
    {"mirror_wall", "dielectric", NULL, LC_ROW_PASS},
    {"mirror_wall", "dielectric", brighten_gathered, LC_ROW_FAIL},
};

static const lc_estimator *find_estimator(const char *name)
{
    for (const lc_estimator *const *e = lc_estimators; *e; ++e)
        if (strcmp((*e)->name, name) == 0)
            return *e;
    ck_abort_msg("no estimator %s", name);
    return NULL;
}

/* A right estimator under another name is held against the kept images. */
START_TEST(altered_scenes_fail)
{
    lc_estimator copy = *find_estimator(alterations[_i].estimator);
    lc_verify_options options;
    lc_report report;
    copy.name = "copy";
    altered_scene = alterations[_i].scene;
    alter = alterations[_i].alter;
    lc_verify_options_init(&options);
    options.estimator = &copy;
    options.check = "povray";
    options.scene = altered_scene;
    ck_assert_msg(lc_verify(&report, &options, load_altered, &err) == LC_OK, "%s", err.text);
    ck_assert_int_eq(report.count, 1);
    ck_assert_msg(report.rows[0].verdict == alterations[_i].verdict, "%s", report.rows[0].reason);
    lc_report_release(&report);
}
END_TEST

/* In the full suite our standard error is below a fifth of the band; the interval is some six of them. */
START_TEST(our_noise_is_a_fifth_of_the_band)
{
    lc_verify_options options;
    lc_report report;
    alter = NULL;
    lc_verify_options_init(&options);
    options.suite = lc_suite_find("full");
    options.check = "povray";
    options.scene = "plane_disk";
    ck_assert_msg(lc_verify(&report, &options, load_altered, &err) == LC_OK, "%s", err.text);
    ck_assert_int_eq(report.count, 1);
    ck_assert_int_eq(report.rows[0].verdict, LC_ROW_PASS);
    ck_assert_double_lt(report.rows[0].high - report.rows[0].low, 2 * 6.5 * 0.002 / 5);
    lc_report_release(&report);
}
END_TEST

START_TEST(pixels_beyond_the_band_are_left_out)
{
    char path[LC_PATH_SIZE];
    lc_scene *scene;
    lc_claims claims = {.count = 0};
    lc_pov_image image;
    lc_estimator copy = *find_estimator("light_direct");
    const lc_check *const *check = lc_checks;
    const lc_pov_case *c = lc_pov_cases;
    int beyond = 0, outlines = 0;
    while (strcmp((*check)->name, "povray") != 0)
        ++check;
    while (strcmp(c->scene, "cornell") != 0)
        ++c;
    alter = NULL;
    ck_assert_int_eq(load_altered(&scene, "cornell", &err), LC_OK);
    ck_assert_int_eq((*check)->plan(*check, &claims, scene, &copy, &err), LC_OK);
    ck_assert_int_eq(claims.count, 1);
    ck_assert_int_eq(lc_scene_locate(path, "cornell", &err), LC_OK);
    ck_assert_int_eq(lc_pov_reference_read(&image, "results/reference", path, c, &err), LC_OK);
    size_t count = (size_t)image.width * (size_t)image.height;
    lc_expected expected = {image.width, image.height, calloc(3 * count, sizeof(double)), calloc(count, 1)};
    ck_assert_int_eq(claims.items[0].expect(&expected, &claims.items[0], scene, 2, &err), LC_OK);
    double mean = 0;
    for (size_t i = 0; i < 3 * count; ++i)
        mean += image.rgb[i] / (3.0 * (double)count);
    for (size_t i = 0; i < count; ++i) {
        int is_beyond = image.error[i] > c->band * mean;
        ck_assert(expected.skip[i] || !is_beyond);
        ck_assert(expected.skip[i] || expected.rgb[3 * i] == image.rgb[3 * i]);
        beyond += is_beyond;
        outlines += expected.skip[i] && !is_beyond;
    }
    ck_assert_int_gt(beyond, 0);
    ck_assert_int_gt(outlines, 0);
    ck_assert_double_eq(lc_pov_share_left_out(&image, c->band), beyond / (double)count);
    free(expected.rgb);
    free(expected.skip);
    lc_pov_image_release(&image);
    lc_claims_release(&claims);
    lc_scene_free(scene);
}
END_TEST

/* The exporter still writes what the kept images were made from. */
static const char *const rendered_again[] = {"plane_point", "plane_rectangle"};

START_TEST(kept_images_are_what_povray_makes_today)
{
    char path[LC_PATH_SIZE];
    lc_scene_desc desc;
    lc_pov_image now, kept;
    const lc_pov_case *c = lc_pov_cases;
    if (!has_povray())
        return;
    while (strcmp(c->scene, rendered_again[_i]) != 0)
        ++c;
    ck_assert_int_eq(lc_scene_locate(path, c->scene, &err), LC_OK);
    ck_assert_int_eq(lc_scene_read(&desc, path, NULL, 0, &err), LC_OK);
    ck_assert_msg(lc_pov_reference_read(&kept, "results/reference", path, c, &err) == LC_OK, "%s", err.text);
    ck_assert_msg(lc_pov_measure(&now, c, &desc, 2, &err) == LC_OK, "%s", err.text);
    ck_assert_int_eq(now.width * now.height, kept.width * kept.height);
    for (int i = 0; i < 3 * now.width * now.height; ++i) /* another machine may round a half the other way */
        ck_assert_double_le(fabs(now.rgb[i] - kept.rgb[i]), 0x1p-11 * kept.rgb[i]);
    lc_pov_image_release(&now);
    lc_pov_image_release(&kept);
    lc_scene_desc_release(&desc);
}
END_TEST

Suite *lc_suite_povray(void)
{
    Suite *suite = suite_create("povray");
    TCase *tc = tcase_create("export");
    tcase_add_test(tc, export_says_what_each_part_is);
    tcase_add_loop_test(tc, what_cannot_be_expressed_is_refused_with_the_reason, 0, sizeof refused / sizeof refused[0]);
    tcase_add_test(tc, clips_are_refused_only_where_they_cut);
    suite_add_tcase(suite, tc);
    tc = tcase_create("render");
    tcase_set_timeout(tc, 60);
    tcase_add_test(tc, camera_and_shapes_are_seen_pixel_by_pixel);
    tcase_add_test(tc, checkerboards_lie_where_ours_do);
    tcase_add_loop_test(tc, specular_chains_end_at_the_bounces_asked_for, 0, sizeof chains / sizeof chains[0]);
    tcase_add_test(tc, a_scene_that_povray_refuses_is_a_fault_in_its_words);
    tcase_add_test(tc, a_scene_that_never_ends_is_stopped);
    tcase_add_test(tc, without_povray_there_is_no_version);
    suite_add_tcase(suite, tc);
    tc = tcase_create("reference");
    tcase_set_timeout(tc, 120);
    tcase_add_test(tc, hash_is_fnv_1a);
    tcase_add_test(tc, references_of_another_scene_or_case_are_refused);
    tcase_add_loop_test(tc, altered_scenes_fail, 0, sizeof alterations / sizeof alterations[0]);
    tcase_add_test(tc, our_noise_is_a_fifth_of_the_band);
    tcase_add_test(tc, pixels_beyond_the_band_are_left_out);
    tcase_add_loop_test(tc, kept_images_are_what_povray_makes_today, 0,
                        sizeof rendered_again / sizeof rendered_again[0]);
    suite_add_tcase(suite, tc);
    return suite;
}
