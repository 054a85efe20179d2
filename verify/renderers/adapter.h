/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * adapter.h: any program as a renderer of our scenes. An adapter is an executable that is called as
 *
 *     ADAPTER scene.xml WIDTH HEIGHT SPP SEED BOUNCES OUT.exr
 *
 * and writes an image of box-filtered radiance, R G B, of light scattered at most BOUNCES times. Two calls of different
 * seeds must be independent; from them comes the variance. docs/verify-your-renderer.md is for those who write one.
 */
#ifndef LC_ADAPTER_H
#define LC_ADAPTER_H

#include "verify/renderers/program.h"

enum { LC_ADAPTER_SECONDS = 600 }; /* for one call, unless somebody says otherwise */

typedef struct lc_adapter {
    char path[LC_PROGRAM_PATH]; /* absolute; of the executable or folder */
    char name[64];              /* its own, else the file's stem */
    lc_estimator estimator;     /* what it says that it handles; it has no radiance() and cannot be rendered by lc_render() */
    double rounding;            /* relative error of its arithmetic, in [0, 0.01] */
    int batch;                  /* images of one call, in [1, 256] */
    int is_exact;               /* 1: the image depends on no seed: its error is that of a quadrature, which falls with SPP */
    double seconds;             /* for one call */
    int is_folder;              /* 1: no program, but images that were rendered before: replicates.h */
} lc_adapter;

/* Looks the executable up and asks it `ADAPTER --describe`, which prints lines KEY=VALUE and exits with 0: name, lobes
 * (diffuse,mirror,glass), emitters (area,point,directional,sky), max_bounces, rounding (1e-6), batch (1), noise (seed or
 * none). With another exit status it is taken to know no --describe: all lobes and emitters, no limit of bounces.
 * Or a folder of images that were rendered before (replicates.h), which says nothing.
 * LC_BAD_INPUT for neither of these, and for lines that are not understood. `out` must not be moved: it points into itself. */
lc_status lc_adapter_open(lc_adapter *out, const char *path, double seconds, lc_error *err);

/* What is to be rendered. */
typedef struct lc_adapter_job {
    const lc_scene_desc *scene;
    int bounces; /* the terms 0 .. bounces are added */
    int samples; /* a pixel, of each image */
    uint32_t seed;
    int count; /* of images, whose seeds are seed, seed + 1, ... */
} lc_adapter_job;

/* Renders `count` images of scene->width x height pixels: rgb receives 3 numbers a pixel, row by row, image after image.
 * LC_BAD_INPUT, with its last words, when it ends with status 2: it refuses the scene. LC_FAULT when it fails otherwise,
 * hangs, or writes no image, one of another size, or one with NaN, infinite or negative values. Nothing stays on the disk. */
lc_status lc_adapter_render(float *rgb, const lc_adapter *adapter, const lc_adapter_job *job, lc_error *err);

#endif
