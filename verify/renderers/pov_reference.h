/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * pov_reference.h: images by POV-Ray with the error of each pixel, rendered now or read from results/reference/.
 * docs/povray.md tells where the bands come from.
 */
#ifndef LC_POV_REFERENCE_H
#define LC_POV_REFERENCE_H

#include "verify/renderers/pov_run.h"

/* What is rendered of a scene, how finely, and how far it is to be trusted. */
typedef struct lc_pov_case {
    const char *scene;
    lc_pov_mode mode;
    int area_samples, supersampling, count; /* as in lc_pov_options and lc_pov_run; count: rays of a gathering */
    int min_bounces, max_bounces;           /* 0: what the camera sees glow is in it */
    double band;           /* relative to the image's mean: pixels whose error may be larger are left out */
    int live;              /* 1: cheap enough to be rendered in each run where POV-Ray is installed */
    const char *estimator; /* that has to meet it; the others are tied to that one by the equality check */
    const char *source;    /* in words */
} lc_pov_case;

extern const lc_pov_case lc_pov_cases[]; /* ends with scene = NULL */

/* The mean of each pixel, 3 numbers each, and a bound of its error by convergence, one each. */
typedef struct lc_pov_image {
    int width, height;
    double *rgb, *error;
    double change;  /* mean of the image rendered half as finely over this one's, less 1 */
    double seconds; /* of processors, for both; 0 for an image that was read */
} lc_pov_image;

void lc_pov_image_release(lc_pov_image *image);

/* Renders the case twice, as finely as it says and half as finely in every respect at once (points of a lamp,
 * supersampling, rays of a gathering). The error of a pixel is the largest difference of the two within one pixel
 * around it, plus the rounding of half floats, 2^-11 of its value: both errors fall at least as fast as the spacing, so
 * that the finer image is nearer to the truth than to the coarser one. Where light is gathered: the difference of the means over
 * the pixel's tile of 8 x 8, since gathering is noisy from pixel to pixel. */
lc_status lc_pov_measure(lc_pov_image *out, const lc_pov_case *c, const lc_scene_desc *desc, int threads,
                         lc_error *err);

/* Writes FOLDER/NAME.exr (R G B; the error as standard deviation, squared, in variance.*) and NAME.json (version,
 * options, hash of the scene's file, convergence, time). NAME is "SCENE.pov", with ".radiosity" or another mode's name before
 * ".pov" unless that is direct. `scene_file` is hashed. */
lc_status lc_pov_reference_write(const char *folder, const char *scene_file, const lc_pov_case *c,
                                 const lc_pov_image *image, lc_error *err);
/* Reads it back. LC_WRONG, with the reason, when it is missing, was rendered from another scene's file, or as another
 * case: a missing reference is a failure. */
lc_status lc_pov_reference_read(lc_pov_image *out, const char *folder, const char *scene_file, const lc_pov_case *c,
                                lc_error *err);

/* Share of pixels, in [0, 1], whose error exceeds the band. */
double lc_pov_share_left_out(const lc_pov_image *image, double band);

#endif
