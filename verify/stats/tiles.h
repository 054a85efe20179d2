/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * tiles.h: the pyramid of images whose pixels may move together, as those of other programs may: a tile's variance is then not the sum
 * of its pixels'. What it is, n images show: the tile's sums are n independent samples.
 *
 * A tile is judged by the larger of both variances, with no more than n - 1 degrees of freedom: so whichever is true, its interval is
 * at least as wide as that of Student's t. The third cumulant of n images is noise for the most part (a skewness of sqrt(6 / n) in
 * images that have none), and would close nearly all tests at the levels of a run, where the sum of the pixels' is well known. So a tile's
 * own counts where it is larger, once its images show that pixels move together, by more than three standard errors: by variance
 * (that of the ratio to the pixels' is at most sqrt(2 / n), whatever the samples' law, since squares of single pixels cancel), or by the third
 * cumulant itself. What is left unseen is a common part of less than 3 sqrt(2 / n) of the variance, a quarter of it at 256 images.
 */
#ifndef LC_TILES_H
#define LC_TILES_H

#include "verify/stats/pyramid.h"

/* As lc_pyramid_judge(). tiles[l], from l = 1 on, has a pixel for each tile of that level, row by row, whose samples are the sums of the tile's
 * pixels over each image; they are of arm a. Pixels that a field leaves out may stay in the sums, which makes them vary more, not less, unless
 * they move against the others. LC_FAULT without memory. */
lc_status lc_pyramid_judge_tiles(lc_pyramid *out, const lc_estimate *field, int width, int height, lc_pixel *const tiles[LC_LEVELS],
                                 int channel, const lc_pyramid_plan *plan, lc_error *err);

/* Tiles of a level along a side of that many pixels. */
int lc_pyramid_tiles(int pixels, int level);
/* Room for the tiles, zeroed; LC_FAULT without memory. */
lc_status lc_tiles_create(lc_pixel *tiles[LC_LEVELS], int width, int height, lc_error *err);
void lc_tiles_free(lc_pixel *tiles[LC_LEVELS]);
/* Adds the sums of 1..LC_BLOCK images, each R G B of its pixels, row by row. */
void lc_tiles_add(lc_pixel *const tiles[LC_LEVELS], int width, int height, const float *images, int count);

#endif
