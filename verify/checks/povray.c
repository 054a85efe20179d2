/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * povray: against another program, which shares nothing with ours: no ray, no sampling, no formula. POV-Ray's image has
 * an error, which is measured by its convergence; where a pixel's is larger than the scene's band, the pixel is left
 * out, and a difference within the band is none.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "estimators/registry.h"
#include "io/scene_path.h"
#include "verify/checks/checks.h"
#include "verify/checks/family.h"
#include "verify/renderers/pov_reference.h"

/* A reference of which more is beyond the band says too little. */
#define MOST_LEFT_OUT 0.6

static const lc_pov_case *find_case(const char *scene, lc_pov_mode mode)
{
    for (const lc_pov_case *c = lc_pov_cases; c->scene; ++c)
        if (strcmp(c->scene, scene) == 0 && c->mode == mode)
            return c;
    return NULL;
}

/* The scene's file, and results/reference beside the folder of the scenes. */
static lc_status locate(char scene_file[LC_PATH_SIZE], char folder[LC_PATH_SIZE + 32], const char *name, lc_error *err)
{
    lc_status status = lc_scene_locate(scene_file, name, err);
    if (status != LC_OK)
        return status;
    const char *slash = strrchr(scene_file, '/');
    snprintf(folder, LC_PATH_SIZE + 32, "%.*s../results/reference", slash ? (int)(slash - scene_file) + 1 : 0,
             scene_file);
    return LC_OK;
}

/* Only asked where edges are: of what is seen, and of what is seen in mirrors. */
static lc_status outline_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                              lc_error *err)
{
    lc_hit at = *hit;
    unsigned chain = 0;
    (void)user;
    (void)err;
    for (int k = 0; k < 16; ++k) {
        lc_material material = lc_material_at(scene, &at);
        chain = 31 * chain + (at.valid ? 2 * (unsigned)at.part + (lc_dot(at.n, at.wo) > 0) + 1 : 0);
        if (!at.valid || lc_rgb_max(material.mirror) == 0)
            break;
        lc_trace(scene, &at, lc_sub(lc_scale(2 * lc_dot(at.n, at.wo), at.n), at.wo), &at);
    }
    *kind = (int)(chain & 0x7fffffff);
    if (value)
        *value = lc_black();
    return LC_OK;
}

/* An outline that runs along a row of pixels deceives two grids alike, all along: it is left out in any case. */
static lc_status take(lc_expected *out, const lc_pov_image *image, const lc_pov_case *c, const lc_scene *scene,
                      int threads, lc_error *err)
{
    size_t count = (size_t)out->width * (size_t)out->height, left_out = 0;
    double mean = 0;
    if (image->width != out->width || image->height != out->height)
        return lc_fail(err, LC_WRONG, "the reference of %s has %d x %d pixels, the scene %d x %d", c->scene,
                       image->width, image->height, out->width, out->height);
    lc_status status = lc_expect_view(out, outline_view, NULL, scene, 1, threads, err);
    if (status != LC_OK)
        return status;
    for (size_t i = 0; i < 3 * count; ++i)
        mean += image->rgb[i] / (3.0 * (double)count);
    for (size_t i = 0; i < count; ++i) {
        out->skip[i] |= image->error[i] > c->band * mean;
        left_out += out->skip[i];
        for (size_t k = 3 * i; k < 3 * i + 3; ++k)
            out->rgb[k] = out->skip[i] ? 0 : image->rgb[k];
    }
    if ((double)left_out > MOST_LEFT_OUT * (double)count)
        return lc_fail(err, LC_WRONG, "%s: %zu of %zu pixels of POV-Ray's image are beyond the band of %g%%", c->scene,
                       left_out, count, 100 * c->band);
    return LC_OK;
}

static lc_status expect(lc_expected *out, lc_pov_mode mode, int live, const lc_scene *scene, int threads, lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    const lc_pov_case *c = find_case(desc->name, mode);
    char scene_file[LC_PATH_SIZE], folder[LC_PATH_SIZE + 32], version[128];
    lc_pov_image image = {.rgb = NULL, .error = NULL};
    lc_status status;
    if (live && c->live && lc_pov_version(version, sizeof version, NULL) == LC_OK) {
        status = lc_pov_measure(&image, c, desc, threads, err);
    } else {
        status = locate(scene_file, folder, desc->name, err);
        if (status == LC_OK)
            status = lc_pov_reference_read(&image, folder, scene_file, c, err);
    }
    if (status == LC_OK)
        status = take(out, &image, c, scene, threads, err);
    lc_pov_image_release(&image);
    return status;
}

/* One function for each image of a scene: the judge knows images by their functions. */
#define EXPECT(name, mode, live) \
    static lc_status name(lc_expected *out, const lc_claim *claim, const lc_scene *scene, int threads, lc_error *err) \
    { \
        (void)claim; \
        return expect(out, mode, live, scene, threads, err); \
    }

EXPECT(expect_direct, LC_POV_DIRECT, 0)
EXPECT(expect_radiosity, LC_POV_RADIOSITY, 0)
EXPECT(expect_specular, LC_POV_SPECULAR, 0)
EXPECT(expect_gathered, LC_POV_GATHERED, 0)
EXPECT(expect_direct_live, LC_POV_DIRECT, 1)
EXPECT(expect_radiosity_live, LC_POV_RADIOSITY, 1)
EXPECT(expect_specular_live, LC_POV_SPECULAR, 1)
EXPECT(expect_gathered_live, LC_POV_GATHERED, 1)

/* [live][lc_pov_mode] */
static lc_expect_fn *const expectations[2][4] = {{expect_direct, expect_radiosity, expect_specular, expect_gathered},
                                                 {expect_direct_live, expect_radiosity_live, expect_specular_live, expect_gathered_live}};

static int is_registered(const lc_estimator *estimator)
{
    for (const lc_estimator *const *e = lc_estimators; *e; ++e)
        if (*e == estimator)
            return 1;
    return 0;
}

/* One estimator of ours a scene, and any that is under test. Under test many may follow each other: they meet the kept
 * image. */
static lc_status plan(const lc_check *self, lc_claims *claims, const lc_scene *scene, const lc_estimator *estimator,
                      lc_error *err)
{
    int registered = is_registered(estimator);
    for (const lc_pov_case *c = lc_pov_cases; c->scene; ++c) {
        if (strcmp(c->scene, lc_scene_description(scene)->name) != 0 || !lc_sees_everything(scene, estimator) ||
            estimator->max_bounces < c->max_bounces || (registered && strcmp(c->estimator, estimator->name) != 0))
            continue;
        lc_claim *claim = lc_claims_add(claims, self, scene, estimator);
        if (!claim)
            return lc_fail(err, LC_FAULT, "out of memory for the claims");
        claim->expect = expectations[registered][c->mode];
        claim->min_bounces = c->min_bounces;
        claim->max_bounces = c->max_bounces;
        claim->tolerance = c->band;
        claim->noise = c->band / 5;
        claim->margin = 2 * c->band;
        claim->exact = c->band == 0; /* black */
        claim->source = c->source;
        claim->may_be_still = c->mode == LC_POV_SPECULAR || lc_scene_emitters(scene) == LC_DIRECTIONAL ||
                              strcmp(c->scene, "furnace_sphere") == 0; /* its kernel is constant */
    }
    return LC_OK;
}

/* The exporter's own words, in the mode that suits the scene. */
int lc_povray_excuse(lc_error *why, const lc_scene *scene)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    lc_pov_options options;
    char *text = NULL;
    size_t length = 0;
    for (const lc_pov_case *c = lc_pov_cases; c->scene; ++c)
        if (strcmp(c->scene, desc->name) == 0)
            return 0;
    lc_pov_options_init(&options);
    if (!(lc_scene_lobes(scene) & LC_DIFFUSE))
        options.mode = LC_POV_SPECULAR;
    else if (lc_scene_emitters(scene) == LC_SKY)
        options.mode = LC_POV_RADIOSITY;
    options.emission = options.mode == LC_POV_SPECULAR;
    if (lc_family_find(desc->name)) {
        snprintf(why->text, sizeof why->text, "drawn anew for each seed, so that no image of POV-Ray's can be kept");
        return 1;
    }
    FILE *memory = open_memstream(&text, &length);
    if (!memory || lc_pov_export(memory, desc, &options, why) == LC_OK)
        snprintf(why->text, sizeof why->text, "no image of POV-Ray's is kept of it");
    if (memory)
        fclose(memory);
    free(text);
    return 1;
}

const lc_check lc_check_povray = {
    "povray",
    "images by POV-Ray, within a band that its own convergence gives",
    "POV-Ray 3.7 (povray.org); docs/povray.md",
    plan,
    NULL,
};
