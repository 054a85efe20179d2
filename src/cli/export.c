/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "io/exr.h"
#include "io/outfile.h"
#include "io/scene_write.h"
#include "verify/checks/family.h"
#include "verify/renderers/pov_sample.h"

typedef struct export_arguments {
    const char *to, *mode, *size, *out, *image;
    int samples;
    uint64_t seed;
    lc_pov_options pov;
    lc_strings definitions;
} export_arguments;

static lc_pov_mode mode_of(const char *name)
{
    return strcmp(name, "radiosity") == 0  ? LC_POV_RADIOSITY
           : strcmp(name, "gathered") == 0 ? LC_POV_GATHERED
           : strcmp(name, "specular") == 0 ? LC_POV_SPECULAR
                                           : LC_POV_DIRECT;
}

static int is_pov(const export_arguments *a) { return strcmp(a->to, "pov") == 0; }

static lc_status write_file(const export_arguments *a, const lc_scene_desc *desc, lc_error *err)
{
    lc_outfile *out;
    char default_out[128];
    snprintf(default_out, sizeof default_out, "%s.%s", desc->name, a->to);
    lc_status status = lc_outfile_open(&out, a->out ? a->out : default_out, err);
    if (status != LC_OK)
        return status;
    status = is_pov(a) ? lc_pov_export(lc_outfile_stream(out), desc, &a->pov, err)
                       : lc_scene_write(lc_outfile_stream(out), desc, err);
    if (status == LC_OK)
        return lc_outfile_commit(out, err);
    lc_outfile_abort(out);
    return status;
}

/* As POV-Ray renders it. */
static lc_status write_image(const export_arguments *a, const lc_scene_desc *desc, lc_error *err)
{
    size_t count = (size_t)desc->width * (size_t)desc->height;
    double *rgb = malloc(3 * count * sizeof *rgb);
    lc_film *film = NULL;
    lc_status status = rgb ? lc_film_create(&film, desc->width, desc->height, err) : lc_fail(err, LC_FAULT, "out of memory for an image");
    if (status == LC_OK)
        status = lc_pov_sample(rgb, desc, a->pov.bounces, a->samples, a->seed, err);
    for (size_t i = 0; status == LC_OK && i < count; ++i) {
        film->pixels[i].n = 1;
        for (size_t c = 0; c < 3; ++c)
            film->pixels[i].c[c].mean = rgb[3 * i + c];
    }
    if (status == LC_OK) {
        snprintf(film->scene, sizeof film->scene, "%s", desc->name);
        snprintf(film->estimator, sizeof film->estimator, "povray");
        film->count = 1;
        film->has_third = 0;
        film->max_bounces = a->pov.bounces;
        status = lc_exr_write(a->image, film, err);
    }
    lc_film_free(film);
    free(rgb);
    return status;
}

/* A file's description, or a drawn one. */
static lc_status describe(lc_scene_desc *desc, const export_arguments *a, const char *name, lc_error *err)
{
    const lc_family *family = lc_family_find(name);
    lc_scene *scene;
    if (family && a->definitions.count > 0)
        return lc_fail(err, LC_BAD_INPUT, "%s is drawn: it has no <default> to define; expected --seed", name);
    if (family)
        return lc_family_describe(desc, family, a->seed, err);
    lc_status status = lc_cli_load_scene(&scene, name, &a->definitions, err);
    if (status != LC_OK)
        return status;
    status = lc_scene_desc_copy(desc, lc_scene_description(scene), err);
    lc_scene_free(scene);
    return status;
}

static lc_status export_scene(void *user, const lc_strings *rest, lc_error *err)
{
    export_arguments *a = user;
    lc_scene_desc desc;
    if (!a->to)
        return lc_fail(err, LC_BAD_INPUT, "--to pov or --to xml says for which program");
    lc_status status = describe(&desc, a, rest->items[0], err);
    if (status != LC_OK)
        return status;
    a->pov.mode = mode_of(a->mode);
    a->pov.emission |= a->pov.mode == LC_POV_SPECULAR;
    if (a->pov.bounces < 0)
        a->pov.bounces = a->pov.mode == LC_POV_DIRECT     ? 1
                         : a->pov.mode == LC_POV_GATHERED ? 2
                         : desc.max_bounces >= 0          ? desc.max_bounces
                                                          : LC_DEFAULT_BOUNCES;
    if (a->size)
        status = lc_cli_read_pair(&desc.width, &desc.height, a->size, 'x', "--size", err);
    if (status == LC_OK && (desc.width < 1 || desc.height < 1 || desc.width > LC_MAX_SIZE || desc.height > LC_MAX_SIZE))
        status =
            lc_fail(err, LC_BAD_INPUT, "--size %dx%d: expected 1 to %d each", desc.width, desc.height, LC_MAX_SIZE);
    if (status == LC_OK && a->image && !is_pov(a))
        status = lc_fail(err, LC_BAD_INPUT, "--image is rendered by POV-Ray: --to pov");
    if (status == LC_OK)
        status = a->image ? write_image(a, &desc, err) : write_file(a, &desc, err);
    lc_scene_desc_release(&desc);
    return status;
}

static int run(const lc_command *self, int argc, char **argv)
{
    export_arguments a = {.mode = "direct", .samples = 16, .seed = 1};
    lc_pov_options_init(&a.pov);
    a.pov.bounces = -1;
    const lc_option options[] = {
        {0, "to", LC_OPT_CHOICE, &a.to, "pov|xml", "for POV-Ray, or as a scene's file (Mitsuba 3 reads it); needed", 0, 0,
         "pov|xml"},
        {'o', "out", LC_OPT_STRING, &a.out, "FILE", "default SCENE.pov or SCENE.xml", 0, 0, NULL},
        {0, "seed", LC_OPT_UINT64, &a.seed, "N", "which scene of a family; of an image, where rays and points of lamps stand; default 1", 0, 0, NULL},
        {0, "mode", LC_OPT_CHOICE, &a.mode, "MODE",
         "direct (default): one diffuse reflection; radiosity: several; specular: mirrors and glass; gathered: one, off mirrors too",
         0, 0, "direct|radiosity|specular|gathered"},
        {0, "bounces", LC_OPT_INT, &a.pov.bounces, "N",
         "scattering events at most; default: 1 with mode direct, else the scene's, else 5", 0, 250, NULL},
        {0, "points", LC_OPT_INT, &a.pov.area_samples, "N",
         "point lights along the longest side of any lamp; default 16", 2, 256, NULL},
        {0, "count", LC_OPT_INT, &a.pov.count, "N", "rays of a gathering of radiosity; default 400", 1, 1600, NULL},
        {0, "emission", LC_OPT_FLAG, &a.pov.emission, NULL,
         "the camera sees lamps and sky glow, too; always so with mode specular", 0, 0, NULL},
        {0, "size", LC_OPT_STRING, &a.size, "WxH", "pixels whose shape the camera has; default: the scene's", 0, 0,
         NULL},
        {0, "image", LC_OPT_STRING, &a.image, "FILE.exr",
         "runs POV-Ray and writes what it renders, all terms from L_0 on; mode and lamps are chosen for it", 0, 0, NULL},
        {'s', "samples", LC_OPT_INT, &a.samples, "N", "of an image: camera rays a pixel; default 16", 1, 1 << 20, NULL},
        {'D', "define", LC_OPT_LIST, &a.definitions, "NAME=VALUE", "value of a <default> of the scene", 0, 0, NULL},
        {0, NULL, LC_OPT_FLAG, NULL, NULL, NULL, 0, 0, NULL},
    };
    return lc_command_run(self, options, argc, argv, 1, 1,
                          "expected one scene: a name (see `lightcheck list scenes`), a path to an .xml file, or random_...",
                          export_scene, &a);
}

const lc_command lc_command_export = {
    "export",
    "SCENE --to pov|xml [-o FILE] [options]",
    "writes a scene for another renderer, or one that was drawn",
    "What POV-Ray cannot express, or cannot do right, is refused with the reason (exit status 2); docs/povray.md has "
    "the\n"
    "list. Render larger and average blocks for pixel means: POV-Ray samples pixel centres.\n"
    "SCENE may be a family's, random_...: with --to xml a row of `verify --seed N` can be rendered, or replayed by sample.\n",
    run,
};
