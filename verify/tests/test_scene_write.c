/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * What is written is read back as the same scene, for every scene there is.
 */
#include "verify/tests/tests.h"

#include <stdlib.h>
#include <string.h>

#include "io/scene_path.h"
#include "io/scene_read.h"
#include "io/scene_write.h"
#include "verify/checks/family.h"

static lc_error err;

static void write_and_read(lc_scene_desc *back, const lc_scene_desc *desc)
{
    char *text = NULL;
    size_t length = 0;
    FILE *memory = open_memstream(&text, &length);
    ck_assert_ptr_nonnull(memory);
    ck_assert_msg(lc_scene_write(memory, desc, &err) == LC_OK, "%s", err.text);
    fclose(memory);
    ck_assert_msg(lc_scene_read_memory(back, text, length, "back.xml", NULL, 0, &err) == LC_OK, "%s\n%s", err.text, text);
    free(text);
}

static void compare_colors(lc_rgb a, lc_rgb b)
{
    ck_assert_double_eq_tol(a.r, b.r, 1e-14);
    ck_assert_double_eq_tol(a.g, b.g, 1e-14);
    ck_assert_double_eq_tol(a.b, b.b, 1e-14);
}

static void compare_textures(const lc_texture *a, const lc_texture *b)
{
    ck_assert_int_eq(a->is_checkerboard, b->is_checkerboard);
    for (int i = 0; i <= a->is_checkerboard; ++i)
        compare_colors(a->color[i], b->color[i]);
    for (int i = 0; i < 2 && a->is_checkerboard; ++i) {
        ck_assert_double_eq(a->scale[i], b->scale[i]);
        ck_assert_double_eq(a->offset[i], b->offset[i]);
    }
}

static void compare_shapes(const lc_scene_desc *d, const lc_scene_desc *e, int i)
{
    const lc_shape_desc *a = &d->shapes[i], *b = &e->shapes[i];
    const lc_material_desc *m = &d->materials[a->material], *n = &e->materials[b->material];
    ck_assert_int_eq(a->kind, b->kind);
    ck_assert_int_eq(a->flip_normals != 0, b->flip_normals != 0);
    ck_assert_int_eq(a->emits, b->emits);
    ck_assert_int_eq(memcmp(&a->to_world, &b->to_world, sizeof a->to_world), 0);
    ck_assert_double_eq(lc_length(lc_sub(a->motion, b->motion)), 0); /* 0 may be -0 */
    if (a->emits)
        compare_textures(&a->radiance, &b->radiance);
    for (int s = 0; s < 2; ++s) {
        compare_textures(&m->side[s].diffuse, &n->side[s].diffuse);
        compare_colors(m->side[s].mirror, n->side[s].mirror);
        compare_colors(m->side[s].glossy, n->side[s].glossy);
        ck_assert_double_eq(m->side[s].alpha, n->side[s].alpha);
        ck_assert_double_eq_tol(m->side[s].glass, n->side[s].glass, 1e-14);
    }
    if (m->side[0].glass > 0) {
        ck_assert_double_eq(m->int_ior, n->int_ior);
        ck_assert_double_eq(m->ext_ior, n->ext_ior);
    }
}

static void compare_lights(const lc_scene_desc *d, const lc_scene_desc *e)
{
    ck_assert_int_eq(d->point_count, e->point_count);
    ck_assert_int_eq(d->directional_count, e->directional_count);
    ck_assert_int_eq(d->has_sky, e->has_sky);
    compare_colors(d->sky, e->sky);
    for (int i = 0; i < d->point_count; ++i) {
        compare_colors(d->points[i].intensity, e->points[i].intensity);
        ck_assert_int_eq(memcmp(&d->points[i].position, &e->points[i].position, sizeof(lc_vec3)), 0);
    }
    for (int i = 0; i < d->directional_count; ++i) {
        compare_colors(d->directionals[i].irradiance, e->directionals[i].irradiance);
        ck_assert_double_le(lc_length(lc_sub(d->directionals[i].direction, e->directionals[i].direction)), 1e-15);
    }
}

static void write_read_and_compare(const lc_scene_desc *d)
{
    lc_scene_desc e;
    write_and_read(&e, d);
    ck_assert_int_eq(d->shape_count, e.shape_count);
    for (int i = 0; i < d->shape_count; ++i)
        compare_shapes(d, &e, i);
    compare_lights(d, &e);
    ck_assert_int_eq(d->width, e.width);
    ck_assert_int_eq(d->height, e.height);
    ck_assert_int_eq(d->samples, e.samples);
    ck_assert_int_eq(d->max_bounces, e.max_bounces);
    ck_assert_int_eq(memcmp(&d->camera.to_world, &e.camera.to_world, sizeof d->camera.to_world), 0);
    ck_assert_double_eq(d->camera.fov, e.camera.fov);
    ck_assert_double_eq(d->camera.aperture_radius, e.camera.aperture_radius);
    ck_assert_double_eq(d->camera.focus_distance, e.camera.focus_distance);
    ck_assert_int_eq(d->camera.fov_axis, e.camera.fov_axis);
    ck_assert_double_eq(d->camera.near_clip, e.camera.near_clip);
    ck_assert(d->camera.far_clip == e.camera.far_clip);
    lc_scene_desc_release(&e);
}

START_TEST(what_is_written_is_read_back)
{
    char **names, path[LC_PATH_SIZE];
    int count;
    ck_assert_int_eq(lc_scene_names(&names, &count, &err), LC_OK);
    ck_assert_int_ge(count, 20);
    for (int k = 0; k < count; ++k) {
        lc_scene_desc d;
        ck_assert_int_eq(lc_scene_locate(path, names[k], &err), LC_OK);
        ck_assert_int_eq(lc_scene_read(&d, path, NULL, 0, &err), LC_OK);
        write_read_and_compare(&d);
        lc_scene_desc_release(&d);
    }
    lc_scene_names_free(names, count);
}
END_TEST

/* Scenes that were drawn have no file but this. */
START_TEST(families_are_read_back)
{
    for (const lc_family *f = lc_families; f->name; ++f)
        for (uint64_t seed = 1; seed <= 10; ++seed) {
            lc_scene_desc d;
            ck_assert_int_eq(lc_family_describe(&d, f, seed, &err), LC_OK);
            write_read_and_compare(&d);
            lc_scene_desc_release(&d);
        }
}
END_TEST

#define HEAD \
    "<scene version=\"3.0.0\"><sensor type=\"perspective\"><film type=\"hdrfilm\"><rfilter type=\"box\"/></film></sensor>"
#define SHAPE(bsdf) "<shape type=\"sphere\">" bsdf "</shape>"
#define MIRROR "<bsdf type=\"conductor\"><rgb name=\"specular_reflectance\" value=\"0.9 0.4 1\"/></bsdf>"
#define DIFFUSE "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.3 1 0.2\"/></bsdf>"
#define BLEND(w, a, b) "<bsdf type=\"blendbsdf\"><float name=\"weight\" value=\"" w "\"/>" a b "</bsdf>"

/* No scene has these. */
static const char *const materials[] = {
    SHAPE(BLEND("0.5", BLEND("0.25", DIFFUSE, MIRROR), "<bsdf type=\"dielectric\"/>")),
    SHAPE("<bsdf type=\"twosided\">" BLEND("0.3", DIFFUSE, MIRROR) DIFFUSE "</bsdf>"),
    SHAPE("<bsdf type=\"twosided\"><bsdf type=\"diffuse\"><float name=\"reflectance\" value=\"0\"/></bsdf>" MIRROR "</bsdf>"),
};

START_TEST(blends_keep_what_they_reflect)
{
    char text[2048];
    lc_scene_desc d, e;
    snprintf(text, sizeof text, "%s%s</scene>", HEAD, materials[_i]);
    ck_assert_msg(lc_scene_read_memory(&d, text, strlen(text), "x.xml", NULL, 0, &err) == LC_OK, "%s", err.text);
    write_and_read(&e, &d);
    compare_shapes(&d, &e, 0);
    lc_scene_desc_release(&d);
    lc_scene_desc_release(&e);
}
END_TEST

Suite *lc_suite_scene_write(void)
{
    Suite *suite = suite_create("scene_write");
    TCase *tc = tcase_create("scene_write");
    tcase_add_test(tc, what_is_written_is_read_back);
    tcase_add_test(tc, families_are_read_back);
    tcase_add_loop_test(tc, blends_keep_what_they_reflect, 0, sizeof materials / sizeof materials[0]);
    suite_add_tcase(suite, tc);
    return suite;
}
