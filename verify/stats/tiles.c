/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A level at a time, each as an image of its own whose pixels are the tiles; see tiles.h. */
#include "verify/stats/tiles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double SHOWN = 3; /* standard errors */

int lc_pyramid_tiles(int pixels, int level) { return (pixels - 1) / (1 << level) + 1; }

/* ---- sums over each image -------------------------------------------------------------------------------------------- */

lc_status lc_tiles_create(lc_pixel *tiles[LC_LEVELS], int width, int height, lc_error *err)
{
    for (int l = 0; l < LC_LEVELS; ++l)
        tiles[l] = NULL;
    for (int l = 1; l < lc_pyramid_levels(width, height); ++l) {
        tiles[l] = calloc((size_t)lc_pyramid_tiles(width, l) * (size_t)lc_pyramid_tiles(height, l), sizeof *tiles[l]);
        if (!tiles[l])
            return lc_fail(err, LC_FAULT, "out of memory for the tiles");
    }
    return LC_OK;
}

void lc_tiles_free(lc_pixel *tiles[LC_LEVELS])
{
    for (int l = 0; l < LC_LEVELS; ++l)
        free(tiles[l]);
}

static void add_to_tile(lc_pixel *tile, int level, int x, int y, int width, int height, const float *images, int count)
{
    double sums[LC_BLOCK][3];
    int right = (x + 1) << level < width ? (x + 1) << level : width, bottom = (y + 1) << level < height ? (y + 1) << level : height;
    memset(sums, 0, sizeof sums);
    for (int k = 0; k < count; ++k)
        for (int row = y << level; row < bottom; ++row) {
            const float *at = images + 3 * (((size_t)k * (size_t)height + (size_t)row) * (size_t)width);
            for (int column = x << level; column < right; ++column)
                for (int c = 0; c < 3; ++c)
                    sums[k][c] += at[3 * column + c];
        }
    lc_pixel_add(tile, (const double(*)[3])sums, count);
}

void lc_tiles_add(lc_pixel *const tiles[LC_LEVELS], int width, int height, const float *images, int count)
{
    for (int l = 1; l < lc_pyramid_levels(width, height); ++l) {
        int across = lc_pyramid_tiles(width, l);
        for (int i = 0; i < across * lc_pyramid_tiles(height, l); ++i)
            add_to_tile(&tiles[l][i], l, i % across, i / across, width, height, images, count);
    }
}

/* ---- decisions -------------------------------------------------------------------------------------------------------- */

/* 1 where n images show more than the pixels' sums say. */
static int is_together(const lc_arm_sums *sum, const lc_arm_sums *own, double n)
{
    double wide = fmax(sum->variance, own->variance);
    return own->variance > (1 + SHOWN * sqrt(2 / n)) * sum->variance ||
           fabs(own->third) > fabs(sum->third) + SHOWN * sqrt(6 / n) / sqrt(n) * wide * sqrt(wide);
}

/* What the tile's own sums say, where that is worse. A tile that has shown no noise stays as it is: it is not tested. */
static void widen(lc_arm_sums *arm, const lc_pixel *tile, int channel)
{
    double n = (double)tile->n;
    const lc_estimate alone = lc_estimate_one(tile, 1, channel, 0, 0);
    const lc_arm_sums *own = &alone.arm[0];
    if (!(arm->variance > 0 && n >= 2))
        return;
    if (is_together(arm, own, n) && fabs(own->third) > fabs(arm->third))
        arm->third = own->third;
    arm->variance = fmax(arm->variance, own->variance);
    arm->variance2 = fmax(arm->variance2, arm->variance * arm->variance / (n - 1));
}

/* The sums of a tile as the means of one pixel, as which it is judged. */
static void scale(lc_estimate *e, double by)
{
    e->difference *= by;
    e->expected *= by;
    e->tolerance *= by;
    for (int i = 0; i < 2; ++i) {
        e->arm[i].variance *= by * by;
        e->arm[i].variance2 *= by * by * by * by;
        e->arm[i].third *= by * by * by;
        e->arm[i].doubt *= by * by * by;
    }
    e->pixels = 1;
}

/* The tiles of the next level. */
static void halve(lc_estimate *out, const lc_estimate *in, int width, int height)
{
    int across = lc_pyramid_tiles(width, 1), down = lc_pyramid_tiles(height, 1);
    for (int i = 0; i < across * down; ++i)
        out[i] = lc_estimate_zero();
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            lc_estimate_add(&out[(y / 2) * across + x / 2], &in[y * width + x]);
}

/* The share of one level in the plan: its tiles are the pixels of `width` x `height`, whose coarser levels are not asked. */
static lc_pyramid_plan plan_of_level(const lc_pyramid_plan *plan, int level, int levels)
{
    lc_pyramid_plan one = *plan;
    one.alpha_fail = plan->alpha_fail * (levels - level) / levels;
    for (int l = 0; l < LC_LEVELS; ++l) {
        one.margin[l] = l == 0 ? plan->margin[level] : INFINITY;
        one.least[l] = l == 0 ? plan->least[level] : UINT64_MAX;
    }
    return one;
}

/* A pixel of a level's image as the tile that it is. */
static lc_tile tile_of(const lc_tile *pixel, int level, int width, int height, int levels)
{
    lc_tile tile = *pixel;
    if (pixel->level < 0)
        return tile;
    tile.level = level;
    tile.x = pixel->x << level;
    tile.y = pixel->y << level;
    tile.width = width - tile.x < 1 << level ? width - tile.x : 1 << level;
    tile.height = height - tile.y < 1 << level ? height - tile.y : 1 << level;
    tile.log_p = fmin(0, pixel->log_p + log((double)levels / (levels - level)));
    return tile;
}

/* Takes over what one level says. */
static void take(lc_pyramid *out, const lc_pyramid *one, int level, int width, int height)
{
    lc_tile worst = tile_of(&one->worst, level, width, height, out->levels);
    out->level[level] = one->level[0];
    if (one->verdict == LC_FAIL)
        out->verdict = LC_FAIL;
    if (worst.level >= 0 && (out->worst.level < 0 || worst.log_p < out->worst.log_p))
        out->worst = worst;
    if (one->blocking.level >= 0)
        out->blocking = tile_of(&one->blocking, level, width, height, out->levels);
    if (level == out->levels - 1)
        out->whole = tile_of(&one->whole, level, width, height, out->levels);
}

static lc_status judge_level(lc_pyramid *out, lc_estimate *wide, const lc_estimate *field, int level, int width, int height,
                             const lc_pixel *tiles, int channel, const lc_pyramid_plan *plan, lc_error *err)
{
    int across = lc_pyramid_tiles(width, level), down = lc_pyramid_tiles(height, level);
    lc_pyramid_plan share = plan_of_level(plan, level, out->levels);
    lc_pyramid one;
    for (int i = 0; i < across * down; ++i) {
        wide[i] = field[i];
        if (level > 0)
            widen(&wide[i].arm[0], &tiles[i], channel);
        if (wide[i].pixels > 0)
            scale(&wide[i], 1.0 / wide[i].pixels);
    }
    lc_status status = lc_pyramid_judge(&one, wide, across, down, &share, err);
    if (status == LC_OK)
        take(out, &one, level, width, height);
    return status;
}

/* PASS, where nothing fails: each level that is declared is within its margin. */
static void conclude(lc_pyramid *out, const lc_pyramid_plan *plan)
{
    int declared = 0, within = 0;
    for (int l = 0; l < out->levels; ++l)
        if (plan->margin[l] < INFINITY) {
            ++declared;
            within += out->level[l].within;
        }
    if (out->verdict != LC_FAIL && declared > 0 && within == declared)
        out->verdict = LC_PASS;
}

lc_status lc_pyramid_judge_tiles(lc_pyramid *out, const lc_estimate *field, int width, int height, lc_pixel *const tiles[LC_LEVELS],
                                 int channel, const lc_pyramid_plan *plan, lc_error *err)
{
    size_t count = (size_t)width * (size_t)height;
    lc_estimate *work = malloc(3 * count * sizeof *work), *level[2] = {work, work ? work + count : NULL}, *wide = work ? work + 2 * count : NULL;
    lc_status status = LC_OK;
    memset(out, 0, sizeof *out);
    out->verdict = LC_GO_ON;
    out->levels = lc_pyramid_levels(width, height);
    out->whole.level = out->worst.level = out->blocking.level = -1;
    if (!work)
        return lc_fail(err, LC_FAULT, "out of memory for the tiles");
    memcpy(level[0], field, count * sizeof *field);
    for (int l = 0; l < out->levels && status == LC_OK; ++l) {
        if (l > 0)
            halve(level[l % 2], level[(l + 1) % 2], lc_pyramid_tiles(width, l - 1), lc_pyramid_tiles(height, l - 1));
        status = judge_level(out, wide, level[l % 2], l, width, height, tiles[l], channel, plan, err);
    }
    if (status == LC_OK)
        conclude(out, plan);
    free(work);
    return status;
}
