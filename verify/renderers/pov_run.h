/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * pov_run.h: POV-Ray, the program, as a renderer of our scenes. It is run in a folder of its own under $TMPDIR or /tmp,
 * without a shell, with an empty HOME and no display, so that no configuration of the user's changes the image.
 */
#ifndef LC_POV_RUN_H
#define LC_POV_RUN_H

#include "verify/renderers/pov_export.h"

typedef struct lc_pov_run {
    int supersampling; /* pixels a side that POV-Ray renders for one of ours, in [1, 16] */
    int threads;       /* 0: one a core; radiosity depends on it, direct light does not */
    double seconds;    /* of wall time, after which POV-Ray is killed: LC_FAULT */
} lc_pov_run;

/* 8 a side, one thread a core, 600 s. */
void lc_pov_run_init(lc_pov_run *run);

/* The version of the `povray` on PATH, as it calls itself ("3.7.0.10.unofficial"); LC_BAD_INPUT when there is none,
 * LC_FAULT when it does not run. */
lc_status lc_pov_version(char *version, size_t size, lc_error *err);

/* Exports, renders and averages: `rgb` receives 3 numbers a pixel of desc->width x desc->height, row by row: mean
 * radiance. POV-Ray's EXR holds halves, so each of the supersampling^2 values that are averaged is off by up to 2^-11
 * of itself; where they vary over a pixel it averages out, in a flat image it stays. LC_BAD_INPUT where the scene
 * cannot be exported or POV-Ray is missing; LC_FAULT with POV-Ray's own words where it fails. Forks: nothing else of
 * the process is touched. */
lc_status lc_pov_render(double *rgb, const lc_scene_desc *desc, const lc_pov_options *options, const lc_pov_run *run,
                        lc_error *err);
/* The same for a scene that is written already. */
lc_status lc_pov_render_text(double *rgb, const char *text, size_t length, int width, int height, const lc_pov_run *run,
                             lc_error *err);

#endif
