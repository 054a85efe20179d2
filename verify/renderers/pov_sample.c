/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * One image of POV-Ray's, of one seed.
 */
#include "verify/renderers/pov_sample.h"

#include <stdlib.h>

/* Cells along a lamp's longest side: two points in each, opposite each other, leave an error of the second order only. */
enum { CELLS = 4, MOST_ALONG = 8, ARM = 0x706f76 };

static int has_diffuse(const lc_scene_desc *desc)
{
    for (int i = 0; i < desc->shape_count; ++i)
        for (int j = 0; j < 2; ++j) {
            const lc_texture *t = &desc->materials[desc->shapes[i].material].side[j].diffuse;
            if (lc_rgb_max(t->color[0]) > 0 || (t->is_checkerboard && lc_rgb_max(t->color[1]) > 0))
                return 1;
        }
    return 0;
}

static void expose(lc_scene_desc *desc, double by)
{
    for (int i = 0; i < desc->shape_count; ++i)
        for (int k = 0; k < 2; ++k)
            desc->shapes[i].radiance.color[k] = lc_rgb_scale(by, desc->shapes[i].radiance.color[k]);
    for (int i = 0; i < desc->point_count; ++i)
        desc->points[i].intensity = lc_rgb_scale(by, desc->points[i].intensity);
    for (int i = 0; i < desc->directional_count; ++i)
        desc->directionals[i].irradiance = lc_rgb_scale(by, desc->directionals[i].irradiance);
    desc->sky = lc_rgb_scale(by, desc->sky);
}

static lc_status choose_mode(lc_pov_options *options, const lc_scene_desc *desc, int bounces, lc_error *err)
{
    lc_pov_options_init(options);
    options->emission = 1;
    options->bounces = bounces;
    options->mode = has_diffuse(desc) ? LC_POV_DIRECT : LC_POV_SPECULAR;
    if (options->mode == LC_POV_DIRECT && bounces > 1)
        return lc_fail(err, LC_BAD_INPUT,
                       "%s: POV-Ray gathers the light of several diffuse reflections along directions that no seed changes",
                       desc->name);
    return LC_OK;
}

lc_status lc_pov_sample(double *rgb, const lc_scene_desc *desc, int bounces, int samples, uint64_t seed, lc_error *err)
{
    lc_pov_options options;
    lc_pov_run run;
    lc_sampler random;
    lc_scene_desc scene;
    lc_status status = choose_mode(&options, desc, bounces, err);
    if (status == LC_OK)
        status = lc_scene_desc_copy(&scene, desc, err);
    if (status != LC_OK)
        return status;
    lc_pov_run_init(&run);
    run.supersampling = (int)fmin(MOST_ALONG, ceil(sqrt(samples)));
    run.threads = 1; /* whoever wants many images runs many */
    run.seconds = 3600;
    lc_sampler_start(&random, seed, ARM, 0, 0);
    options.area_samples = CELLS;
    for (int i = 0; i < 2; ++i)
        options.shift[i] = (lc_next(&random) - 0.5) / run.supersampling;
    options.jitter = 1 + (uint32_t)(lc_next(&random) * 0x7ffffffe);
    double exposure = exp2(lc_next(&random));
    expose(&scene, exposure);
    status = lc_pov_render(rgb, &scene, &options, &run, err);
    for (size_t i = 0; status == LC_OK && i < 3 * (size_t)desc->width * (size_t)desc->height; ++i)
        rgb[i] /= exposure;
    lc_scene_desc_release(&scene);
    return status;
}
