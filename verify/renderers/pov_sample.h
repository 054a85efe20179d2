/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * pov_sample.h: POV-Ray as a renderer under test. It draws no random numbers, so a seed decides what is done around it, and
 * each thing so decided makes the mean over all seeds right: where in its cell each grid of camera rays stands, where in
 * its cell each point of a lamp stands, and how bright the scene is exposed, which rounds halves differently. What remains
 * is the variance of these three, so that no error is left that the spread of the images would not show.
 */
#ifndef LC_POV_SAMPLE_H
#define LC_POV_SAMPLE_H

#include "verify/renderers/pov_run.h"

/* Radiance scattered at most `bounces` times, L_0 included, of `samples` rays a pixel, rounded up to a square and at most
 * 64: 3 numbers a pixel of desc->width x desc->height. LC_BAD_INPUT, with the reason, for what POV-Ray cannot say or
 * cannot do right; LC_FAULT where it fails. */
lc_status lc_pov_sample(double *rgb, const lc_scene_desc *desc, int bounces, int samples, uint64_t seed, lc_error *err);

#endif
