/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * replicates.h: images that somebody rendered before, in place of a program that renders: FOLDER/SCENE.BOUNCES/ANY.exr, each image of a
 * seed of its own. Nothing of it is run; no link is followed. How many samples a pixel an image has is not known, nor asked.
 */
#ifndef LC_REPLICATES_H
#define LC_REPLICATES_H

#include <time.h>

#include "verify/renderers/adapter.h"

/* 1 when some folder SCENE.BOUNCES with an image lies in it. */
int lc_replicates_are_in(const char *folder);
/* Fills an adapter that stands for these images; it claims all lobes and emitters. LC_BAD_INPUT where there are none. */
lc_status lc_replicates_open(lc_adapter *out, const char *folder, lc_error *err);

/* 1 when there are images of the scene, of any number of bounces; and of any other adapter. */
int lc_replicates_show(const lc_adapter *adapter, const char *scene);
/* How many there are; 0 also where the folder cannot be read. */
int lc_replicates_count(const lc_adapter *adapter, const lc_scene_desc *scene, int bounces);
/* Reads all of them: LC_BAD_INPUT when two are the same, byte for byte, and others are not. */
lc_status lc_replicates_differ(const lc_adapter *adapter, const lc_scene_desc *scene, int bounces, lc_error *err);
/* Those numbered job->seed, job->seed + 1, ... from 0 on in the order of their names, as lc_adapter_render() gives them; job->samples is of no
 * account. LC_BAD_INPUT where there are fewer; LC_FAULT for a file that is no such image. */
lc_status lc_replicates_read(float *rgb, const lc_adapter *adapter, const lc_adapter_job *job, lc_error *err);

/* lc_hash() of the names and bytes of all images in the folder. */
uint64_t lc_replicates_digest(const char *folder);
/* When the newest of them was changed. */
time_t lc_replicates_time(const char *folder);

#endif
