/* SPDX-License-Identifier: GPL-3.0-or-later */
/* film.c: moments of pixels, and films that are merged from shards or from several streams. */
#include <stdlib.h>
#include <string.h>

#include "core/host.h"

/* ---- pixels ------------------------------------------------------------------------------------- */

/* A block is walked as one flat row of doubles, LANES at a time: a multiple of three channels, so a lane never changes
 * its channel, and of four, so a compiler may use vectors without reordering any sum. */
enum { LANES = 12 };

struct lanes {
    double v[LANES];
};

static double lanes_sum(const struct lanes *lanes, int channel)
{
    const double *v = lanes->v + channel;
    return (v[0] + v[3]) + (v[6] + v[9]);
}

static double lanes_max(const struct lanes *lanes, int channel)
{
    const double *v = lanes->v + channel;
    double a = v[0] > v[3] ? v[0] : v[3], b = v[6] > v[9] ? v[6] : v[9];
    return a > b ? a : b;
}

static void lanes_set(struct lanes *lanes, const double channel[3])
{
    for (int j = 0; j < LANES; ++j)
        lanes->v[j] = channel[j % 3];
}

/* Sums of x - origin over the block, and the largest x. */
static void block_first_pass(struct lanes *sum, struct lanes *max, const struct lanes *origin, const double *x,
                             int size)
{
    struct lanes s = {{0}}, m = *origin;
    int i = 0;
    for (; i + LANES <= size; i += LANES) {
        for (int j = 0; j < LANES; ++j)
            s.v[j] += x[i + j] - origin->v[j];
        for (int j = 0; j < LANES; ++j)
            m.v[j] = x[i + j] > m.v[j] ? x[i + j] : m.v[j];
    }
    for (int j = 0; i + j < size; ++j) {
        s.v[j] += x[i + j] - origin->v[j];
        m.v[j] = x[i + j] > m.v[j] ? x[i + j] : m.v[j];
    }
    *sum = s;
    *max = m;
}

/* Sums of the second and third powers of x - mean. */
static void block_second_pass(struct lanes *m2, struct lanes *m3, const struct lanes *mean, const double *x, int size)
{
    struct lanes s2 = {{0}}, s3 = {{0}};
    int i = 0;
    for (; i + LANES <= size; i += LANES)
        for (int j = 0; j < LANES; ++j) {
            double d = x[i + j] - mean->v[j];
            double d2 = d * d;
            s2.v[j] += d2;
            s3.v[j] += d2 * d;
        }
    for (int j = 0; i + j < size; ++j) {
        double d = x[i + j] - mean->v[j];
        double d2 = d * d;
        s2.v[j] += d2;
        s3.v[j] += d2 * d;
    }
    *m2 = s2;
    *m3 = s3;
}

void lc_pixel_add(lc_pixel *pixel, const double (*samples)[3], int count)
{
    /* Sums start from the first sample: a constant estimator then has its exact mean and no variance at all. */
    struct lanes origin, sum, max, mean, m2, m3;
    const double *x = (const double *)samples;
    double average[3], inverse = 1.0 / count;
    if (count < 1)
        return;
    lanes_set(&origin, samples[0]);
    block_first_pass(&sum, &max, &origin, x, 3 * count);
    for (int c = 0; c < 3; ++c)
        average[c] = samples[0][c] + lanes_sum(&sum, c) * inverse;
    lanes_set(&mean, average);
    block_second_pass(&m2, &m3, &mean, x, 3 * count);

    lc_pixel block = {(uint64_t)count, count == LC_BLOCK, {{0, 0, 0, 0, 0, 0}}};
    for (int c = 0; c < 3; ++c) {
        lc_moments *m = &block.c[c];
        m->mean = average[c];
        m->m2 = lanes_sum(&m2, c);
        m->m3 = lanes_sum(&m3, c);
        m->max = lanes_max(&max, c);
        m->batch_mean = block.batches ? average[c] : 0;
    }
    lc_pixel_merge(pixel, &block);
}

/* Chan's formula for the batches: with one batch on the right, Welford's update. */
static void merge_batches(lc_pixel *into, const lc_pixel *from)
{
    if (from->batches == 0)
        return;
    double a = (double)into->batches, b = (double)from->batches, share = b / (a + b);
    for (int c = 0; c < 3; ++c) {
        lc_moments *m = &into->c[c];
        double delta = from->c[c].batch_mean - m->batch_mean;
        m->batch_mean += delta * share;
        m->batch_m2 += from->c[c].batch_m2 + delta * delta * (a * share);
    }
    into->batches += from->batches;
}

void lc_pixel_merge(lc_pixel *into, const lc_pixel *from)
{
    if (from->n == 0)
        return;
    if (into->n == 0) {
        *into = *from;
        return;
    }
    double a = (double)into->n, b = (double)from->n, inverse = 1.0 / (a + b);
    double share_a = a * inverse, share_b = b * inverse;
    for (int c = 0; c < 3; ++c) {
        lc_moments *m = &into->c[c];
        const lc_moments *o = &from->c[c];
        double delta = o->mean - m->mean, square = delta * delta * (a * share_b);
        m->m3 += o->m3 + square * delta * (share_a - share_b) + 3 * delta * (share_a * o->m2 - share_b * m->m2);
        m->m2 += o->m2 + square;
        m->mean += delta * share_b;
        m->max = o->max > m->max ? o->max : m->max;
    }
    merge_batches(into, from);
    into->n += from->n;
}

double lc_pixel_variance(const lc_pixel *pixel, int channel)
{
    double n = (double)pixel->n;
    return pixel->n < 2 ? 0 : pixel->c[channel].m2 / (n * (n - 1));
}

/* ---- films -------------------------------------------------------------------------------------- */

lc_status lc_film_create(lc_film **out, int width, int height, lc_error *err)
{
    *out = NULL;
    if (width < 1 || height < 1 || width > LC_MAX_SIZE || height > LC_MAX_SIZE)
        return lc_fail(err, LC_BAD_INPUT, "an image of %dx%d pixels, expected 1x1 to %dx%d", width, height, LC_MAX_SIZE,
                       LC_MAX_SIZE);
    lc_film *film = calloc(1, sizeof *film);
    if (film)
        film->pixels = calloc((size_t)width * (size_t)height, sizeof *film->pixels);
    if (!film || !film->pixels) {
        free(film);
        return lc_fail(err, LC_FAULT, "out of memory for an image of %dx%d pixels", width, height);
    }
    film->width = width;
    film->height = height;
    film->has_third = 1;
    film->shards = 1;
    *out = film;
    return LC_OK;
}

void lc_film_free(lc_film *film)
{
    if (!film)
        return;
    free(film->more);
    free(film->pixels);
    free(film);
}

static size_t pixel_count(const lc_film *film) { return (size_t)film->width * (size_t)film->height; }

static lc_status check_same_image(const lc_film *a, const lc_film *b, lc_error *err)
{
    if (a->width != b->width || a->height != b->height)
        return lc_fail(err, LC_BAD_INPUT, "cannot merge images of %dx%d and %dx%d pixels", a->width, a->height,
                       b->width, b->height);
    if (strcmp(a->scene, b->scene) != 0)
        return lc_fail(err, LC_BAD_INPUT, "cannot merge renders of different scenes, '%s' and '%s'", a->scene,
                       b->scene);
    if (strcmp(a->estimator, b->estimator) != 0)
        return lc_fail(err, LC_BAD_INPUT, "cannot merge renders by different estimators, '%s' and '%s'", a->estimator,
                       b->estimator);
    if (a->min_bounces != b->min_bounces || a->max_bounces != b->max_bounces)
        return lc_fail(err, LC_BAD_INPUT, "cannot merge renders of bounces %d to %d and %d to %d", a->min_bounces,
                       a->max_bounces, b->min_bounces, b->max_bounces);
    if (a->count == 0 || b->count == 0)
        return lc_fail(err, LC_BAD_INPUT, "cannot merge an image whose samples are unknown");
    return LC_OK;
}

static lc_range film_range(const lc_film *film)
{
    lc_range range = {film->seed, film->arm, film->first, film->count};
    return range;
}

static int is_earlier(const lc_film *a, const lc_film *b)
{
    if (a->bad_y != b->bad_y)
        return a->bad_y < b->bad_y;
    if (a->bad_x != b->bad_x)
        return a->bad_x < b->bad_x;
    return a->bad_sample < b->bad_sample;
}

static void merge_bad(lc_film *into, const lc_film *from)
{
    if (from->bad && (!into->bad || is_earlier(from, into))) {
        into->bad_x = from->bad_x;
        into->bad_y = from->bad_y;
        into->bad_sample = from->bad_sample;
        memcpy(into->bad_value, from->bad_value, sizeof into->bad_value);
        into->bad_term = from->bad_term;
    }
    into->bad += from->bad;
}

static void forget_third(lc_film *film)
{
    film->has_third = 0;
    for (size_t i = 0; i < pixel_count(film); ++i) {
        film->pixels[i].batches = 0;
        for (int c = 0; c < 3; ++c) {
            lc_moments *m = &film->pixels[i].c[c];
            m->m3 = m->max = m->batch_mean = m->batch_m2 = 0;
        }
    }
}

static void merge_rest(lc_film *into, const lc_film *from)
{
    merge_bad(into, from);
    if (!into->has_third || !from->has_third)
        forget_third(into);
}

/* ---- shards ------------------------------------------------------------------------------------- */

static int has_shard(const lc_film *film, int shard)
{
    return shard == film->shard || (film->pasted[shard / 64] >> (shard % 64) & 1) != 0;
}

static void add_shard(lc_film *film, int shard) { film->pasted[shard / 64] |= (uint64_t)1 << (shard % 64); }

static lc_status check_same_render(const lc_film *a, const lc_film *b, lc_error *err)
{
    lc_range ra = film_range(a), rb = film_range(b);
    if (a->shards != b->shards)
        return lc_fail(err, LC_BAD_INPUT, "cannot merge a shard of %d with one of %d", a->shards, b->shards);
    if (a->shards > LC_MAX_SHARDS || a->shard < 0 || a->shard >= a->shards || b->shard < 0 || b->shard >= b->shards)
        return lc_fail(err, LC_BAD_INPUT, "shards %d and %d of %d, expected 0 <= shard < shards <= %d", a->shard,
                       b->shard, a->shards, LC_MAX_SHARDS);
    if (ra.seed != rb.seed || ra.arm != rb.arm || ra.first != rb.first || ra.count != rb.count || a->more_count ||
        b->more_count)
        return lc_fail(err, LC_BAD_INPUT,
                       "cannot merge shards of renders with different seeds or samples; "
                       "merge the shards of each render first");
    for (int i = 0; i < a->shards; ++i)
        if (has_shard(a, i) && has_shard(b, i))
            return lc_fail(err, LC_BAD_INPUT, "cannot merge: shard %d of %d is in both", i, a->shards);
    return LC_OK;
}

static void paste_pixels(lc_film *into, const lc_film *from)
{
    int tiles = (from->width + LC_TILE - 1) / LC_TILE;
    for (int y = 0; y < from->height; ++y)
        for (int x = 0; x < from->width; ++x) {
            int tile = y / LC_TILE * tiles + x / LC_TILE;
            size_t i = (size_t)y * (size_t)from->width + (size_t)x;
            if (has_shard(from, tile % from->shards))
                into->pixels[i] = from->pixels[i];
        }
}

static lc_status paste(lc_film *into, const lc_film *from, lc_error *err)
{
    lc_status status = check_same_render(into, from, err);
    if (status != LC_OK)
        return status;
    paste_pixels(into, from);
    int have = 0, lowest = into->shards;
    for (int i = into->shards - 1; i >= 0; --i)
        if (has_shard(into, i) || has_shard(from, i)) {
            add_shard(into, i);
            lowest = i;
            ++have;
        }
    into->shard = lowest;
    if (have == into->shards) {
        into->shard = 0;
        into->shards = 1;
        memset(into->pasted, 0, sizeof into->pasted);
    }
    merge_rest(into, from);
    return LC_OK;
}

/* ---- streams ------------------------------------------------------------------------------------ */

static int compare_ranges(const void *left, const void *right)
{
    const lc_range *a = left, *b = right;
    if (a->seed != b->seed)
        return a->seed < b->seed ? -1 : 1;
    if (a->arm != b->arm)
        return a->arm < b->arm ? -1 : 1;
    return (a->first > b->first) - (a->first < b->first);
}

/* Sorts the ranges and joins neighbours; *size shrinks. */
static lc_status join_ranges(lc_range *ranges, int *size, lc_error *err)
{
    int kept = 1;
    qsort(ranges, (size_t)*size, sizeof *ranges, compare_ranges);
    for (int i = 1; i < *size; ++i) {
        lc_range *a = &ranges[kept - 1], *b = &ranges[i];
        uint64_t gap = b->first - a->first;
        int same = a->seed == b->seed && a->arm == b->arm;
        if (same && gap < a->count)
            return lc_fail(err, LC_BAD_INPUT,
                           "cannot merge: both have sample %llu of seed %llu; render the second with another seed or "
                           "later samples",
                           (unsigned long long)b->first, (unsigned long long)b->seed);
        if (same && gap == a->count)
            a->count += b->count;
        else
            ranges[kept++] = *b;
    }
    *size = kept;
    return LC_OK;
}

static lc_status unite(lc_film *into, const lc_film *from, lc_error *err)
{
    int size = 0;
    size_t room = 2 + (size_t)into->more_count + (size_t)from->more_count;
    lc_range *ranges = malloc(room * sizeof *ranges);
    if (!ranges)
        return lc_fail(err, LC_FAULT, "out of memory for %zu sample ranges", room);
    ranges[size++] = film_range(into);
    ranges[size++] = film_range(from);
    for (int i = 0; i < into->more_count; ++i)
        ranges[size++] = into->more[i];
    for (int i = 0; i < from->more_count; ++i)
        ranges[size++] = from->more[i];
    lc_status status = join_ranges(ranges, &size, err);
    if (status != LC_OK) {
        free(ranges);
        return status;
    }
    for (size_t i = 0; i < pixel_count(into); ++i)
        lc_pixel_merge(&into->pixels[i], &from->pixels[i]);
    merge_rest(into, from);
    into->seed = ranges[0].seed;
    into->arm = ranges[0].arm;
    into->first = ranges[0].first;
    into->count = ranges[0].count;
    into->more_count = size - 1;
    free(into->more);
    into->more = NULL;
    if (size > 1) {
        memmove(ranges, ranges + 1, (size_t)(size - 1) * sizeof *ranges);
        into->more = ranges;
        ranges = NULL;
    }
    free(ranges);
    return LC_OK;
}

lc_status lc_film_merge(lc_film *into, const lc_film *from, lc_error *err)
{
    lc_status status = check_same_image(into, from, err);
    if (status != LC_OK)
        return status;
    return into->shards > 1 || from->shards > 1 ? paste(into, from, err) : unite(into, from, err);
}
