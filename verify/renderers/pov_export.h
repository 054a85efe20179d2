/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * pov_export.h: a scene description as a scene of POV-Ray 3.7, in SI-like radiance: what POV-Ray writes with +FE is
 * radiance. docs/povray.md tells the recipes and what they are good for.
 */
#ifndef LC_POV_EXPORT_H
#define LC_POV_EXPORT_H

#include <stdio.h>

#include "core/host.h"

/* What is asked of POV-Ray, and thereby what it can be asked. */
typedef enum lc_pov_mode {
    LC_POV_DIRECT,    /* light of one diffuse reflection: lamps become quadratures of points */
    LC_POV_RADIOSITY, /* and that of up to `bounces` diffuse reflections, gathered: a noisy reference */
    LC_POV_SPECULAR,  /* lamps and sky seen by way of mirrors and glass only */
    LC_POV_GATHERED   /* one diffuse reflection whose light is gathered from lamps that glow, off mirrors too: noisier */
} lc_pov_mode;

typedef struct lc_pov_options {
    lc_pov_mode mode;
    int area_samples; /* points along the longest side of any lamp, in [2, 256]; the other sides in proportion */
    int emission;     /* 1: the camera sees lamps and sky glow (L_0); 0: reflected light only */
    int bounces;      /* scattering events at most: radiosity in [1, 20], specular in [0, 250], gathered in [1, 2], direct in [0, 1] */
    int count;        /* radiosity, gathered: rays of a gathering, in [1, 1600] */
    double shift[2];  /* of the points where POV-Ray looks through the image, right and down [pixels of ours] */
    uint32_t jitter;  /* 0: lamps are quadratures; else points drawn from this seed, two in each cell, whose mean is right */
} lc_pov_options;

/* direct, 16 points along a side, reflected light only, 1 bounce, 400 rays. */
void lc_pov_options_init(lc_pov_options *options);

/* Writes the scene, readable and with comments; the same description gives the same bytes. LC_BAD_INPUT, with the
 * reason, for what POV-Ray cannot express or cannot do right, and for options out of range; LC_FAULT when writing
 * fails. Any thread. */
lc_status lc_pov_export(FILE *out, const lc_scene_desc *desc, const lc_pov_options *options, lc_error *err);

#endif
