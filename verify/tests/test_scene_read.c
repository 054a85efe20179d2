/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scene reader: what it accepts means what it means in Mitsuba 3, all else is refused with a reason. */
#include "verify/tests/tests.h"

#include <dirent.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/scene_read.h"

#define FILM \
    "<film type='hdrfilm'><integer name='width' value='8'/><integer name='height' value='4'/><rfilter " \
    "type='box'/></film>"
#define SENSOR "<sensor type='perspective'>" FILM "</sensor>"
#define SCENE(body) "<scene version='3.0.0'>\n" SENSOR "\n" body "</scene>"
#define RECTANGLE(bsdf) SCENE("<shape type='rectangle'>" bsdf "</shape>")
#define DIFFUSE(property) RECTANGLE("<bsdf type='diffuse'>" property "</bsdf>")
#define MOVED(shape, steps) SCENE("<shape type='" shape "'><transform name='to_world'>" steps "</transform></shape>")

static lc_scene_desc d;
static lc_error err;

static lc_status parse(const char *text)
{
    return lc_scene_read_memory(&d, text, strlen(text), "t.xml", NULL, 0, &err);
}

static void accept(const char *text)
{
    strcpy(err.text, "");
    ck_assert_msg(parse(text) == LC_OK, "%s for %s", err.text, text);
}

/* The message names the place, and says `part`. */
static void refuse(const char *text, const char *part)
{
    strcpy(err.text, "");
    ck_assert_msg(parse(text) == LC_BAD_INPUT, "accepted: %s", text);
    ck_assert_msg(strncmp(err.text, "t.xml:", 6) == 0 && strstr(err.text, part), "'%s' is not in: %s", part, err.text);
    ck_assert_ptr_null(d.shapes);
}

static void color_is(lc_rgb c, double r, double g, double b)
{
    ck_assert_double_eq_tol(c.r, r, 1e-12);
    ck_assert_double_eq_tol(c.g, g, 1e-12);
    ck_assert_double_eq_tol(c.b, b, 1e-12);
}

static void vec_is(lc_vec3 a, double x, double y, double z)
{
    ck_assert_double_eq_tol(a.x, x, 1e-9);
    ck_assert_double_eq_tol(a.y, y, 1e-9);
    ck_assert_double_eq_tol(a.z, z, 1e-9);
}

/* ---- what is accepted ---- */

START_TEST(whole_scene)
{
    accept(
        "<?xml version='1.0'?>\n<scene version='3.0.0'><!-- comment -->"
        "<default name='k' value='0.25'/><default name='depth' value='3'/>"
        "<integrator type='path'><integer name='max_depth' value='$depth'/><integer name='rr_depth' "
        "value='99'/></integrator>"
        "<sensor type='perspective'><float name='fov' value='40'/><string name='fov_axis' value='y'/>"
        "<transform name='to_world'><lookat origin='1 2 3' target='4 5 7' up='0 0 1'/></transform>"
        "<sampler type='independent'><integer name='sample_count' value='7'/></sampler>" FILM "</sensor>"
        "<shape type='rectangle'><ref id='late'/><transform name='to_world'><scale value='2'/><translate "
        "x='1'/></transform>"
        "<emitter type='area'><rgb name='radiance' value='1, 2, 3'/></emitter></shape>"
        "<bsdf type='diffuse' id='late'><rgb name='reflectance' value='$k 0.5 0.$depth'/></bsdf>"
        "<emitter type='point'><point name='position' x='1' y='2' z='3'/><float name='intensity' value='4'/></emitter>"
        "<emitter type='directional'><vector name='direction' value='0 0 -2'/></emitter>"
        "<emitter type='constant'><rgb name='radiance' value='.1 .2 .3'/></emitter></scene>");
    ck_assert_str_eq(d.name, "t");
    ck_assert_int_eq(d.max_bounces, 2);
    ck_assert_int_eq(d.samples, 7);
    ck_assert_int_eq(d.width * 100 + d.height, 804);
    ck_assert_int_eq(d.camera.fov_axis, LC_FOV_Y);
    ck_assert_double_eq(d.camera.near_clip, 0);
    ck_assert(isinf(d.camera.far_clip));
    ck_assert_int_eq(d.shape_count, 1);
    color_is(d.shapes[0].radiance.color[0], 1, 2, 3);
    color_is(d.materials[d.shapes[0].material].side[0].diffuse.color[0], .25, .5, .3);
    color_is(d.materials[d.shapes[0].material].side[1].diffuse.color[0], 0, 0, 0);
    ck_assert_str_eq(d.materials[d.shapes[0].material].id, "late");
    vec_is(lc_affine_point(&d.shapes[0].to_world, lc_vec(1, 1, 0)), 3, 2, 0);
    vec_is(d.points[0].position, 1, 2, 3);
    color_is(d.points[0].intensity, 4, 4, 4);
    vec_is(d.directionals[0].direction, 0, 0, -1);
    color_is(d.directionals[0].irradiance, 1, 1, 1);
    ck_assert_int_eq(d.has_sky, 1);
    color_is(d.sky, .1, .2, .3);
    lc_scene_desc_release(&d);
}
END_TEST

/* Matrices printed by Mitsuba 3.9.1 (four decimals). */
START_TEST(transforms_are_mitsubas)
{
    static const struct {
        const char *steps;
        double x, y, z; /* where (1, 2, 3) goes */
    } cases[] = {
        {"<rotate x='1' angle='90'/>", 1, -3, 2},
        {"<rotate value='0 0 1' angle='90'/>", -2, 1, 3},
        {"<scale value='2'/><translate x='1'/>", 3, 4, 6},
        {"<translate x='1'/><scale value='2'/>", 4, 4, 6},
        {"<translate value='4'/>", 5, 6, 7},
        {"<scale x='2' y='3'/>", 2, 6, 3},
        {"<matrix value='1 0 0 5 0 1 0 6 0 0 1 7 0 0 0 1'/>", 6, 8, 10},
        {"<matrix value='1 2 0 0 1 0 0 0 2'/>", 5, 2, 6},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char text[600];
        snprintf(text, sizeof text, MOVED("rectangle", "%s"), cases[i].steps);
        accept(text);
        vec_is(lc_affine_point(&d.shapes[0].to_world, lc_vec(1, 2, 3)), cases[i].x, cases[i].y, cases[i].z);
        lc_scene_desc_release(&d);
    }
    accept(MOVED("cube", "<lookat origin='1 2 3' target='4 5 7' up='0 0 1'/>"));
    static const double m[3][4] = {{-.7071, -.4851, .5145, 1}, {.7071, -.4851, .5145, 2}, {0, .7276, .6860, 3}};
    for (int i = 0; i < 12; ++i)
        ck_assert_double_eq_tol(d.shapes[0].to_world.m[i / 4][i % 4], m[i / 4][i % 4], 1e-4);
    lc_scene_desc_release(&d);
}
END_TEST

/* Mitsuba: to_world * translate(center) * scale(radius); its print of center and radius for this file: [10, 20,
 * 30], 20. */
START_TEST(sphere_center_and_radius_come_before_to_world)
{
    accept(SCENE("<shape type='sphere'><point name='center' value='1 2 3'/><float name='radius' value='2'/>"
                 "<transform name='to_world'><scale value='10'/></transform></shape>"));
    vec_is(lc_affine_point(&d.shapes[0].to_world, lc_vec(0, 0, 0)), 10, 20, 30);
    vec_is(lc_affine_vector(&d.shapes[0].to_world, lc_vec(1, 0, 0)), 20, 0, 0);
    lc_scene_desc_release(&d);
}
END_TEST

START_TEST(default_materials_are_mitsubas)
{
    accept(SCENE("<shape type='rectangle'/><shape type='disk'><emitter type='area'/></shape><shape type='cube'/>"));
    ck_assert_int_eq(d.material_count, 2);
    ck_assert_int_eq(d.shapes[0].material, d.shapes[2].material);
    color_is(d.materials[d.shapes[0].material].side[0].diffuse.color[0], .5, .5, .5);
    color_is(d.materials[d.shapes[1].material].side[0].diffuse.color[0], 0, 0, 0); /* an emitter's is black */
    color_is(d.shapes[1].radiance.color[0], 1, 1, 1);
    lc_scene_desc_release(&d);
}
END_TEST

#define LENS(properties) \
    "<scene version='3.0.0'><sensor type='thinlens'>" properties FILM "</sensor></scene>"
#define APERTURE "<float name='aperture_radius' value='0.25'/>"
#define FOCUS "<float name='focus_distance' value='3'/>"

START_TEST(motion_of_shapes)
{
    accept(SCENE("<shape type='sphere'><vector name='motion' value='1 -2 .5'/></shape><shape type='disk'/>"));
    vec_is(d.shapes[0].motion, 1, -2, .5);
    vec_is(d.shapes[1].motion, 0, 0, 0);
    lc_scene_desc_release(&d);
    refuse(SCENE("<shape type='disk'><float name='motion' value='1'/></shape>"), "expected point, vector");
    refuse(SCENE("<shape type='disk'><vector name='motion' x='1'/></shape>"), "all of x, y and z");
}
END_TEST

START_TEST(thin_lens)
{
    accept(LENS(APERTURE FOCUS "<float name='fov' value='40'/><float name='near_clip' value='0.5'/>"));
    ck_assert_double_eq(d.camera.aperture_radius, .25);
    ck_assert_double_eq(d.camera.focus_distance, 3);
    ck_assert_double_eq(d.camera.fov, 40);
    ck_assert_double_eq(d.camera.near_clip, .5);
    lc_scene_desc_release(&d);
    accept(SCENE(""));
    ck_assert_double_eq(d.camera.aperture_radius, 0);
    lc_scene_desc_release(&d);
}
END_TEST

#define ROUGH(properties) \
    "<bsdf type='roughconductor'><string name='distribution' value='ggx'/>" properties "</bsdf>"

START_TEST(rough_conductors)
{
    accept(RECTANGLE(ROUGH("<float name='alpha' value='.3'/><boolean name='sample_visible' value='false'/>"
                           "<rgb name='specular_reflectance' value='.9 .5 0'/><string name='material' value='none'/>")));
    color_is(d.materials[0].side[0].glossy, .9, .5, 0);
    ck_assert_double_eq(d.materials[0].side[0].alpha, .3);
    color_is(d.materials[0].side[1].glossy, 0, 0, 0);
    ck_assert_double_eq(d.materials[0].side[1].alpha, 0);
    color_is(d.materials[0].side[0].mirror, 0, 0, 0);
    lc_scene_desc_release(&d);
    /* .25 diffuse + .75 (.4 rough on the front, the same on the back, + .6 rough of the same alpha, on the front) */
    accept(RECTANGLE(
        "<bsdf type='blendbsdf'><float name='weight' value='.75'/><bsdf type='diffuse'/><bsdf type='blendbsdf'><float "
        "name='weight' value='.6'/><bsdf type='twosided'>" ROUGH("") "</bsdf>" ROUGH("") "</bsdf></bsdf>"));
    color_is(d.materials[0].side[0].glossy, .75, .75, .75);
    color_is(d.materials[0].side[1].glossy, .3, .3, .3);
    ck_assert_double_eq(d.materials[0].side[0].alpha, .1);
    ck_assert_double_eq(d.materials[0].side[1].alpha, .1);
    lc_scene_desc_release(&d);
    /* A share of 0 has no roughness to differ in. */
    accept(RECTANGLE("<bsdf type='blendbsdf'><float name='weight' value='0'/>" ROUGH("") ROUGH(
        "<float name='alpha' value='.2'/>") "</bsdf>"));
    ck_assert_double_eq(d.materials[0].side[0].alpha, .1);
    lc_scene_desc_release(&d);
}
END_TEST

#define GRAY(v) "<bsdf type='diffuse'><float name='reflectance' value='" v "'/></bsdf>"

START_TEST(blend_gives_the_weight_to_the_second)
{
    accept(RECTANGLE("<bsdf type='blendbsdf'><float name='weight' value='0.25'/>" GRAY(
        ".4") "<bsdf type='conductor'><rgb name='specular_reflectance' value='1 .5 0'/></bsdf></bsdf>"));
    color_is(d.materials[0].side[0].diffuse.color[0], .3, .3, .3);
    color_is(d.materials[0].side[0].mirror, .25, .125, 0);
    color_is(d.materials[0].side[1].mirror, 0, 0, 0);
    lc_scene_desc_release(&d);
    /* nested: .5 glass + .5 (.25 grey + .75 twosided) */
    accept(RECTANGLE("<bsdf type='blendbsdf'><float name='weight' value='0.5'/><bsdf type='dielectric'/>"
                     "<bsdf type='blendbsdf'><float name='weight' value='0.75'/>" GRAY(
                         ".4") "<bsdf type='twosided'>" GRAY(".8") "</bsdf></bsdf></bsdf>"));
    ck_assert_double_eq(d.materials[0].side[0].glass, .5);
    ck_assert_double_eq(d.materials[0].side[1].glass, .5);
    color_is(d.materials[0].side[0].diffuse.color[0], .35, .35, .35);
    color_is(d.materials[0].side[1].diffuse.color[0], .3, .3, .3);
    ck_assert_double_eq(d.materials[0].int_ior, 1.5046);
    ck_assert_double_eq(d.materials[0].ext_ior, 1.000277);
    lc_scene_desc_release(&d);
}
END_TEST

START_TEST(twosided_has_a_back)
{
    accept(RECTANGLE("<bsdf type='twosided'>" GRAY(".4") "</bsdf>"));
    color_is(d.materials[0].side[1].diffuse.color[0], .4, .4, .4);
    lc_scene_desc_release(&d);
    accept(RECTANGLE("<bsdf type='twosided'>" GRAY(".4") GRAY(".8") "</bsdf>"));
    color_is(d.materials[0].side[0].diffuse.color[0], .4, .4, .4);
    color_is(d.materials[0].side[1].diffuse.color[0], .8, .8, .8);
    lc_scene_desc_release(&d);
}
END_TEST

#define CHECKER(name, more) \
    "<texture type='checkerboard' name='" name "'><rgb name='color0' value='.2 .4 .6'/>" more "</texture>"

START_TEST(checkerboards)
{
    accept(
        DIFFUSE(CHECKER("reflectance", "<transform name='to_uv'><scale x='4' y='2'/><translate x='.5'/></transform>")));
    const lc_texture *t = &d.materials[0].side[0].diffuse;
    ck_assert_int_eq(t->is_checkerboard, 1);
    color_is(t->color[0], .2, .4, .6);
    color_is(t->color[1], .2, .2, .2);
    ck_assert_double_eq(t->scale[0] * 100 + t->scale[1] * 10 + t->offset[0], 420.5);
    lc_scene_desc_release(&d);
    /* half of it and half of a plain grey is again a checkerboard */
    accept(
        SCENE("<texture type='checkerboard' id='t'/><shape type='sphere'><bsdf type='blendbsdf'><float name='weight' "
              "value='.5'/>" GRAY(".2") "<bsdf type='diffuse'><ref id='t' name='reflectance'/></bsdf></bsdf></shape>"));
    color_is(d.materials[0].side[0].diffuse.color[0], .3, .3, .3);
    color_is(d.materials[0].side[0].diffuse.color[1], .2, .2, .2);
    lc_scene_desc_release(&d);
    refuse(SCENE("<shape type='cube'><emitter type='area'>" CHECKER("radiance", "") "</emitter></shape>"), "on a cube");
    refuse(DIFFUSE(CHECKER("reflectance", "<rgb name='color1' value='2'/>")), "outside [0, 1]");
    refuse(DIFFUSE(CHECKER("reflectance", "<transform name='to_uv'><rotate z='1' angle='45'/></transform>")), "to_uv");
    refuse(DIFFUSE(CHECKER("color", "")), "unknown property 'color'");
    refuse(DIFFUSE("<texture type='checkerboard'/>"), "without a name");
}
END_TEST

START_TEST(integrators)
{
    static const struct {
        const char *text;
        int bounces;
    } cases[] = {
        {"", -1},
        {"<integrator type='path'/>", -1},
        {"<integrator type='direct'><boolean name='hide_emitters' value='False'/></integrator>", 1},
        {"<integrator type='path'><integer name='max_depth' value='1'/></integrator>", 0},
        {"<integrator type='path'><integer name='max_depth' value='-1'/></integrator>", LC_UNBOUNDED},
        {"<integrator type='path'><integer name='max_depth' value='2147483647'/></integrator>", LC_UNBOUNDED},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char text[600];
        snprintf(text, sizeof text, SCENE("%s"), cases[i].text);
        accept(text);
        ck_assert_int_eq(d.max_bounces, cases[i].bounces);
        lc_scene_desc_release(&d);
    }
    refuse(SCENE("<integrator type='path'><integer name='max_depth' value='0'/></integrator>"), "max_depth 0");
    refuse(SCENE("<integrator type='path'><boolean name='hide_emitters' value='true'/></integrator>"), "hide_emitters");
    refuse(SCENE("<integrator type='direct'><integer name='max_depth' value='2'/></integrator>"),
           "unknown property 'max_depth'");
    refuse(SCENE("<integrator type='path'/><integrator type='direct'/>"), "second <integrator>");
    refuse(SCENE("<integrator type='volpath'/>"), "supported: path, direct");
}
END_TEST

/* ---- parameters ---- */

START_TEST(overrides_win)
{
    const char *text = "<scene version='3.0.0'><default name='k' value='1'/><default name='kk' value='2'/>"
                       "<emitter type='constant'><rgb name='radiance' value='$k $kk \\$'/></emitter>" SENSOR "</scene>";
    lc_parameter p[2] = {{"k", "7"}, {"nope", "1"}};
    char good[600];
    snprintf(good, sizeof good, "%s", text);
    memcpy(strstr(good, "\\$"), " 3", 2);
    ck_assert_int_eq(lc_scene_read_memory(&d, good, strlen(good), "t.xml", p, 1, &err), LC_OK);
    color_is(d.sky, 7, 2, 3); /* the longest name first, as in Mitsuba */
    lc_scene_desc_release(&d);
    ck_assert_int_eq(lc_scene_read_memory(&d, good, strlen(good), "t.xml", p, 2, &err), LC_BAD_INPUT);
    ck_assert_str_eq(err.text, "t.xml:1: no <default> for parameter 'nope'; the file has: k, kk");
    refuse(text, "'1 2 $'"); /* \$ is a dollar */
    refuse(DIFFUSE("<float name='reflectance' value='$zz'/>"), "undefined parameter '$zz'");
    refuse(DIFFUSE("<float name='reflectance' value='$k'/>") "", "undefined");
    refuse(SCENE("<default name='a' value='1'/><default name='a' value='1'/>"), "second <default>");
    refuse(SCENE("<shape type='disk'><default name='a' value='1'/></shape>"), "<default> inside");
}
END_TEST

/* ---- what is refused ---- */

START_TEST(messages_name_place_and_choices)
{
    refuse(SCENE("<shape type='torus'/>"), "unknown shape 'torus'; supported: rectangle, disk, cube, sphere");
    ck_assert_msg(strncmp(err.text, "t.xml:3: ", 9) == 0, "%s", err.text);
    refuse(SCENE("<shape type='disk'><float name='radius' value='2'/></shape>"),
           "unknown property 'radius' of shape 'disk'; supported: to_world, flip_normals");
    refuse(DIFFUSE("<string name='reflectance' value='red'/>"),
           "property 'reflectance' of bsdf 'diffuse' is a <string>; expected float, integer, rgb, spectrum, texture");
    refuse("<scene version='3.0.0'>" SENSOR "\n\n<shape", "t.xml:3: not well-formed XML");
}
END_TEST

START_TEST(numbers_are_strict)
{
    static const char *const bad[] = {"1.0x",    "nan",   "inf", "-inf", "0x1p-1", "1e999", "",     "1 2",
                                      "1,2,3,4", "1;2;3", ".",   "e5",   "--1",    "1e",    "0.5.5"};
    static const char *const good[] = {"0.5",         " .5 ",          "+0.5",    "5e-1",
                                       "0.5,0.5,0.5", "0.5, 0.5, 0.5", "5.0E-01", "0.5\t0.5\n0.5"};
    char text[600];
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        snprintf(text, sizeof text, DIFFUSE("<rgb name='reflectance' value='%s'/>"), bad[i]);
        refuse(text, "number");
    }
    for (size_t i = 0; i < sizeof good / sizeof good[0]; ++i) {
        snprintf(text, sizeof text, DIFFUSE("<rgb name='reflectance' value='%s'/>"), good[i]);
        accept(text);
        color_is(d.materials[0].side[0].diffuse.color[0], .5, .5, .5);
        lc_scene_desc_release(&d);
    }
    refuse(SCENE("<integrator type='path'><integer name='max_depth' value='3.5'/></integrator>"), "no integer");
    refuse(SCENE("<integrator type='path'><integer name='max_depth' value='99999999999'/></integrator>"), "no integer");
    refuse(SCENE("<shape type='disk'><boolean name='flip_normals' value='1'/></shape>"), "no boolean");
}
END_TEST

/* A program that embeds us may have set one with a decimal comma. */
START_TEST(numbers_do_not_follow_the_locale)
{
    static const char *const names[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE.utf8", "nl_NL.UTF-8"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i)
        if (setlocale(LC_ALL, names[i]))
            break;
    accept(DIFFUSE("<float name='reflectance' value='0.5'/>"));
    setlocale(LC_ALL, "C");
    color_is(d.materials[0].side[0].diffuse.color[0], .5, .5, .5);
    lc_scene_desc_release(&d);
}
END_TEST

#define BLEND(weight, a, b) RECTANGLE("<bsdf type='blendbsdf'>" weight a b "</bsdf>")
#define W "<float name='weight' value='.5'/>"
#define GLASS(n) "<bsdf type='dielectric'><float name='int_ior' value='" n "'/></bsdf>"
#define CAMERA(properties, film) \
    "<scene version='3.0.0'><sensor type='perspective'>" properties film "</sensor></scene>"
#define SIZE(w) "<film type='hdrfilm'><integer name='width' value='" w "'/><rfilter type='box'/></film>"

START_TEST(bad_scenes)
{
    static const struct {
        const char *text, *part;
    } cases[] = {
        {"", "not well-formed"},
        {"<scene/>", "version"},
        {"<scene version='2.0.0'/>", "expected 3.x.y"},
        {"<scene version='3.0.0'/>", "no <sensor"},
        {"<scene version='3.0.0' size='1'/>", "unknown attribute 'size'"},
        {"<shape type='disk'/>", "outermost element"},
        {SCENE(SENSOR), "second <sensor>"},
        {SCENE("<include filename='x.xml'/>"), "unknown element <include>"},
        {SCENE("<alias id='a' as='b'/>"), "unknown element <alias>"},
        {SCENE("<path value='x'/>"), "unknown element <path>"},
        {SCENE("<medium type='homogeneous'/>"), "unknown element <medium>"},
        {SCENE("<float name='x' value='1'/>"), "directly in <scene>"},
        {SCENE("<film type='hdrfilm'/>"), "cannot stand in <scene>"},
        {SCENE("text"), "text between elements"},
        {SCENE("<shape/>"), "without a type"},
        {SCENE("<shape type='disk' name='a'/>"), "with a name directly in <scene>"},
        {SCENE("<shape type='disk'><float value='1'/></shape>"), "without a name"},
        {SCENE("<bsdf type='diffuse' id='a'/><shape type='disk' id='a'/>"), "already taken by line 3"},
        {SCENE("<shape type='disk'><ref id='a'/></shape>"), "nothing has the id 'a'"},
        {SCENE("<bsdf type='diffuse' id='a'/><ref id='a'/>"), "cannot stand in <scene>"},
        {SCENE("<bsdf type='twosided' id='a'><ref id='a'/></bsdf>"), "circle"},
        {DIFFUSE("<rgb name='reflectance' value='1.5'/>"), "outside [0, 1]"},
        {DIFFUSE("<float name='reflectance' value='-0.1'/>"), "outside [0, 1]"},
        {DIFFUSE("<float name='reflectance' value='.1'/><rgb name='reflectance' value='.1'/>"), "given twice"},
        {DIFFUSE("<float name='reflectance' value='.1'><float/></float>"), "<float> inside <float>"},
        {RECTANGLE(GRAY(".1") GRAY(".2")), "second <bsdf>"},
        {RECTANGLE("<emitter type='area'><rgb name='radiance' value='1 -2 3'/></emitter>"), "negative"},
        {RECTANGLE("<emitter type='area'><spectrum name='radiance' value='1'/></emitter>"), "daylight"},
        {RECTANGLE("<emitter type='point'/>"), "expected area"},
        {SCENE("<emitter type='area'/>"), "outside a shape"},
        {SCENE("<emitter type='constant'/><emitter type='constant'/>"), "second constant"},
        {SCENE("<emitter type='directional'><vector name='direction' value='0'/></emitter>"), "length 0"},
        {SCENE("<emitter type='directional'><transform name='to_world'><scale value='2'/></transform></emitter>"),
         "scale"},
        {SCENE("<emitter type='point'><point name='position' value='0'/><transform name='to_world'/></emitter>"),
         "both"},
        {SCENE("<emitter type='point'><point name='position' x='0' y='1'/></emitter>"), "all of x, y and z"},
        {RECTANGLE("<bsdf type='conductor'><string name='material' value='Au'/></bsdf>"), "supported: none"},
        {LENS(FOCUS), "thinlens without aperture_radius"},
        {LENS(APERTURE), "thinlens without focus_distance"},
        {LENS("<float name='aperture_radius' value='0'/>" FOCUS), "aperture_radius 0 is not positive"},
        {LENS(APERTURE "<float name='focus_distance' value='-1'/>"), "focus_distance -1 is not positive"},
        {CAMERA(APERTURE, SIZE("8")), "unknown property 'aperture_radius'"},
        {RECTANGLE("<bsdf type='roughconductor'/>"), "Mitsuba's default is beckmann"},
        {RECTANGLE(ROUGH("<string name='material' value='Cu'/>")), "supported: none"},
        {RECTANGLE(ROUGH("<float name='alpha' value='0.005'/>")), "expected 0.01 to 1"},
        {RECTANGLE(ROUGH("<float name='alpha' value='1.5'/>")), "expected 0.01 to 1"},
        {RECTANGLE(ROUGH("<float name='alpha_u' value='.1'/>")), "unknown property 'alpha_u'"},
        {BLEND(W, ROUGH("<float name='alpha' value='.2'/>"), ROUGH("")), "different alpha"},
        {RECTANGLE("<bsdf type='dielectric'><string name='int_ior' value='ice'/></bsdf>"), "unknown material 'ice'"},
        {RECTANGLE(GLASS("0")), "not positive"},
        {BLEND("", GRAY(".1"), GRAY(".1")), "weight"},
        {BLEND("<float name='weight' value='1.5'/>", GRAY(".1"), GRAY(".1")), "weight"},
        {BLEND(W, GRAY(".1"), ""), "expected 2"},
        {BLEND(W, GLASS("1.5"), GLASS("1.6")), "different indices"},
        {RECTANGLE("<bsdf type='twosided'>" GLASS("1.5") "</bsdf>"), "lets no light through"},
        {RECTANGLE("<bsdf type='twosided'/>"), "without a <bsdf>"},
        {MOVED("disk", "<scale x='0'/>"), "scale by zero"},
        {MOVED("disk", "<matrix value='1 2 3 2 4 6 0 0 1'/>"), "singular"},
        {MOVED("disk", "<matrix value='1 0 0'/>"), "expected 9 or 16"},
        {MOVED("disk", "<matrix value='1 0 0 0 0 1 0 0 0 0 1 0 1 0 0 1'/>"), "projective"},
        {MOVED("disk", "<rotate x='1' y='1' angle='3'/>"), "expected 1"},
        {MOVED("disk", "<rotate x='1'/>"), "without an angle"},
        {MOVED("disk", "<translate x='1' value='2'/>"), "both"},
        {MOVED("disk", "<skew x='1'/>"), "unknown <skew>"},
        {MOVED("disk", "<scale z='-1'/>"), "mirroring"},
        {MOVED("disk", "<matrix value='1 .5 0 0 1 0 0 0 1'/>"), "sheared disk"},
        {MOVED("sphere", "<scale x='2'/>"), "unequal scales"},
        {MOVED("disk", "<lookat origin='0 0 0' target='0 0 1' up='0 0 1'/>"), "up points along"},
        {MOVED("disk", "<lookat origin='0 0 0' target='0 0 1'/>"), "without 'up'"},
        {SCENE("<shape type='sphere'><float name='radius' value='0'/></shape>"), "not positive"},
        {CAMERA("", ""), "without a <film>"},
        {CAMERA("", "<film type='hdrfilm'/>"), "no <rfilter"},
        {CAMERA("", "<film type='hdrfilm'><rfilter type='gaussian'/></film>"), "expected box"},
        {CAMERA("", "<film type='hdrfilm'><integer name='crop_width' value='3'/><rfilter type='box'/></film>"),
         "crop_width"},
        {CAMERA("", "<film type='hdrfilm'><string name='pixel_format' value='xyz'/><rfilter type='box'/></film>"),
         "supported: rgb"},
        {CAMERA("", SIZE("0")), "pixels"},
        {CAMERA("", SIZE("16385")), "pixels"},
        {CAMERA("<float name='fov' value='0'/>", FILM), "fov 0"},
        {CAMERA("<float name='fov' value='180'/>", FILM), "fov 180"},
        {CAMERA("<string name='fov_axis' value='x'/>", FILM), "without fov"},
        {CAMERA("<float name='fov' value='9'/><string name='fov_axis' value='z'/>", FILM), "supported: x, y"},
        {CAMERA("<float name='near_clip' value='0'/>", FILM), "near_clip"},
        {CAMERA("<float name='near_clip' value='2'/><float name='far_clip' value='1'/>", FILM), "not below"},
        {CAMERA("<transform name='to_world'><scale value='2'/></transform>", FILM), "camera"},
        {CAMERA("<transform name='to_world'><scale x='-1'/></transform>", FILM), "camera"},
        {CAMERA("<sampler type='independent'><integer name='sample_count' value='0'/></sampler>", FILM),
         "sample_count"},
        {"<!DOCTYPE scene [<!ENTITY a 'b'>]>" SCENE(""), "document type"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i)
        refuse(cases[i].text, cases[i].part);
}
END_TEST

/* Small files that would become large, and large ones. */
START_TEST(bombs)
{
    char *text = calloc(1, LC_SCENE_MAX_BYTES + 100), *t = text;
    t += sprintf(t, "<scene version='3.0.0'>");
    for (int i = 0; i < 100; ++i)
        t += sprintf(t, "<bsdf type='twosided'>");
    refuse(text, "nested more than");
    t = text + sprintf(text, "<scene version='3.0.0'><default name='a0' value='0123456789'/>");
    for (int i = 1; i < 40; ++i)
        t += sprintf(t, "<default name='a%d' value='$a%d$a%d'/>", i, i - 1, i - 1);
    refuse(text, "longer than");
    t = text + sprintf(text, "<scene version='3.0.0'>");
    for (int i = 0; i < 300000; ++i)
        t += sprintf(t, "<a/>");
    refuse(text, "elements");
    /* 2^40 ways through a chain of blends, each read once */
    t = text + sprintf(text, "<scene version='3.0.0'>" SENSOR "<bsdf type='diffuse' id='b0'/>");
    for (int i = 1; i < 200; ++i)
        t += sprintf(t, "<bsdf type='blendbsdf' id='b%d'>" W "<ref id='b%d'/><ref id='b%d'/></bsdf>", i, i - 1, i - 1);
    sprintf(t, "</scene>");
    accept(text);
    lc_scene_desc_release(&d);
    t = text + sprintf(text, "<scene version='3.0.0'>" SENSOR "<bsdf type='diffuse' id='b200'/>");
    for (int i = 0; i < 200; ++i)
        t += sprintf(t, "<bsdf type='twosided' id='b%d'><ref id='b%d'/></bsdf>", i, i + 1);
    sprintf(t, "</scene>");
    refuse(text, "references nested");
    memset(text, ' ', LC_SCENE_MAX_BYTES + 1);
    refuse(text, "more than");
    free(text);
}
END_TEST

START_TEST(bytes_that_are_no_xml)
{
    static const char *const bad[] = {"\xff\xfe\x00", "\xc3\x28<scene/>", "<scene>\x01</scene>",
                                      "<scene version='3.0.0'></scen>", "<scene version='3.0.0'>&lol;</scene>"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i)
        refuse(bad[i], "not well-formed");
    ck_assert_int_eq(lc_scene_read_memory(&d, "<scene\0/>", 9, "t.xml", NULL, 0, &err), LC_BAD_INPUT);
    ck_assert_int_eq(lc_scene_read(&d, "no/such.xml", NULL, 0, &err), LC_BAD_INPUT);
    ck_assert_str_eq(err.text, "no/such.xml: cannot open it; expected a scene (.xml)");
}
END_TEST

/* Every truncation of a good file is refused, and none crashes or leaks (asan). */
START_TEST(truncations)
{
    const char *text =
        SCENE("<default name='a' value='1'/><shape type='sphere'><bsdf type='blendbsdf'><float name='weight' "
              "value='$a'/>" GRAY(".1") GRAY(".2") "</bsdf></shape><emitter type='point'/>");
    for (size_t n = 0; n < strlen(text); ++n)
        ck_assert_int_eq(lc_scene_read_memory(&d, text, n, "t.xml", NULL, 0, &err), LC_BAD_INPUT);
}
END_TEST

/* ---- our own files ---- */

START_TEST(every_scene_reads)
{
    DIR *folder = opendir("scenes");
    int count = 0;
    ck_assert_msg(folder != NULL, "run the tests from the project's folder");
    for (struct dirent *entry; (entry = readdir(folder));) {
        char path[300];
        const char *dot = strrchr(entry->d_name, '.');
        if (!dot || strcmp(dot, ".xml") != 0)
            continue;
        snprintf(path, sizeof path, "scenes/%s", entry->d_name);
        ck_assert_msg(lc_scene_read(&d, path, NULL, 0, &err) == LC_OK, "%s", err.text);
        ck_assert_uint_eq(strlen(d.name), (size_t)(dot - entry->d_name));
        ck_assert_int_ge(d.shape_count, 1);
        ck_assert_int_ge(d.max_bounces, 0);
        lc_scene_desc_release(&d);
        ++count;
    }
    closedir(folder);
    ck_assert_int_ge(count, 18);
}
END_TEST

static void in_docs(void *user, const char *line)
{
    ck_assert_msg(strstr(user, line) != NULL, "docs/scenes.md lacks: %s", line);
}

START_TEST(docs_list_what_the_reader_knows)
{
    static char docs[1 << 16];
    FILE *file = fopen("docs/scenes.md", "r");
    ck_assert_ptr_nonnull(file);
    docs[fread(docs, 1, sizeof docs - 1, file)] = 0;
    fclose(file);
    lc_scene_read_describe(in_docs, docs);
    /* and its example is a scene */
    char *begin = strstr(docs, "```xml\n"), *end = begin ? strstr(begin + 7, "```") : NULL;
    ck_assert_ptr_nonnull(end);
    *end = 0;
    accept(begin + 7);
    lc_scene_desc_release(&d);
}
END_TEST

Suite *lc_suite_scene_read(void)
{
    Suite *suite = suite_create("scene_read");
    TCase *tc = tcase_create("scene_read");
    tcase_add_test(tc, whole_scene);
    tcase_add_test(tc, transforms_are_mitsubas);
    tcase_add_test(tc, sphere_center_and_radius_come_before_to_world);
    tcase_add_test(tc, default_materials_are_mitsubas);
    tcase_add_test(tc, blend_gives_the_weight_to_the_second);
    tcase_add_test(tc, rough_conductors);
    tcase_add_test(tc, thin_lens);
    tcase_add_test(tc, motion_of_shapes);
    tcase_add_test(tc, twosided_has_a_back);
    tcase_add_test(tc, checkerboards);
    tcase_add_test(tc, integrators);
    tcase_add_test(tc, overrides_win);
    tcase_add_test(tc, messages_name_place_and_choices);
    tcase_add_test(tc, numbers_are_strict);
    tcase_add_test(tc, numbers_do_not_follow_the_locale);
    tcase_add_test(tc, bad_scenes);
    tcase_add_test(tc, bombs);
    tcase_add_test(tc, bytes_that_are_no_xml);
    tcase_add_test(tc, truncations);
    tcase_add_test(tc, every_scene_reads);
    tcase_add_test(tc, docs_list_what_the_reader_knows);
    suite_add_tcase(suite, tc);
    return suite;
}
