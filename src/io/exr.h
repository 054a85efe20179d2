/* SPDX-License-Identifier: GPL-3.0-or-later */
/* exr.h: films as OpenEXR images, to keep, to merge and to compare.
 *
 * Channels, 32-bit float unless said otherwise: R G B (mean), variance.R/G/B (of the mean), samples (UINT), and where third
 * moments are known, skewness.R/G/B (of the samples, dimensionless: (m3 / n) / (m2 / n)^(3/2); 0 without variance).
 * Attributes lightcheck.*: version, scene, estimator, seed, arm, first, count, minBounces, maxBounces, shard, shards, bad,
 * and where they apply pasted, more, badPixel, badSample, badValue (exr_attr.c says how each is written). Nothing else
 * about how the file came to be is in it: the same film gives the same bytes. */
#ifndef LC_EXR_H
#define LC_EXR_H

#include "core/host.h"

/* Writes the film; means, variances and skewness are rounded to float. LC_FAULT on I/O; LC_BAD_INPUT for more than 2^32 - 1
 * samples in a pixel. */
lc_status lc_exr_write(const char *path, const lc_film *film, lc_error *err);

/* Reads a film, or any image (scan lines or tiles, its first part) that has R G B as half or float.
 * Without variance.R/G/B the variance is 0; without `samples` n = 0, which means unknown; without skewness.R/G/B, or either
 * of these, has_third = 0; without lightcheck.* attributes scene and estimator are "" and count = 0.
 * Pixels that are not finite are counted in `bad`. LC_BAD_INPUT for a file that is missing, no such image, damaged,
 * or larger than LC_MAX_SIZE, for a variance below 0 and a skewness beyond sqrt(n); LC_FAULT when reading fails or memory
 * runs out. */
lc_status lc_exr_read(lc_film **out, const char *path, lc_error *err);

#endif
