/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/report/pictures.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/exr.h"
#include "io/png.h"

enum { LEAST_SIDE = 256 }; /* of a PNG: the longer side of smaller ones is enlarged to about that */

const lc_picture_kind lc_picture_kinds[] = {
    {"is", ".is.exr"},         {"expected", ".expected.exr"},         {"difference", ".difference.exr"},
    {"is_png", ".is.png"},     {"expected_png", ".expected.png"},     {"difference_png", ".difference.png"},
    {NULL, NULL},
};

/* An image in the making: mean and variance of the mean, no more, as a film, since that is what EXR is written from. */
static lc_status create(lc_film **out, const lc_film *like, lc_error *err)
{
    lc_status status = lc_film_create(out, like->width, like->height, err);
    if (status != LC_OK)
        return status;
    (*out)->has_third = 0;
    snprintf((*out)->scene, sizeof (*out)->scene, "%s", like->scene);
    (*out)->min_bounces = like->min_bounces;
    (*out)->max_bounces = like->max_bounces;
    return LC_OK;
}

static void put(lc_pixel *pixel, uint64_t n, int channel, double mean, double variance)
{
    double count = (double)n;
    pixel->n = n;
    pixel->c[channel].mean = mean;
    pixel->c[channel].m2 = n > 1 ? variance * count * (count - 1) : 0;
}

/* What is expected and what differs, pixel by pixel. */
static void fill(lc_film *expected, lc_film *difference, const lc_exhibit *e)
{
    for (size_t i = 0; i < (size_t)e->is->width * (size_t)e->is->height; ++i)
        for (int c = 0; c < 3; ++c) {
            const lc_pixel *is = &e->is->pixels[i];
            double mean = is->c[c].mean, variance = 0;
            if (e->difference) {
                const lc_pixel *d = &e->difference->pixels[i];
                put(&difference->pixels[i], d->n, c, d->c[c].mean, lc_pixel_variance(d, c));
                put(&expected->pixels[i], is->n, c, mean - d->c[c].mean, 0);
                continue;
            }
            double should = e->other ? e->other->pixels[i].c[c].mean : e->expected[3 * i + (size_t)c];
            if (e->other)
                variance = lc_pixel_variance(&e->other->pixels[i], c);
            put(&expected->pixels[i], e->other ? e->other->pixels[i].n : is->n, c, should, variance);
            if (e->skip && e->skip[i])
                put(&difference->pixels[i], is->n, c, 0, 0);
            else
                put(&difference->pixels[i], is->n, c, mean - should, variance + lc_pixel_variance(is, c));
        }
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Number of pixels of the PNG a pixel of the image: as many to either side. */
static int zoom_of(const lc_film *film)
{
    int side = film->width > film->height ? film->width : film->height;
    return side < LEAST_SIDE ? LEAST_SIDE / side : 1;
}

static lc_status write_signed(const char *path, const lc_film *difference, int channel, lc_error *err)
{
    int zoom = zoom_of(difference), width = difference->width * zoom, height = difference->height * zoom;
    size_t count = (size_t)difference->width * (size_t)difference->height;
    double *sizes = malloc(sizeof *sizes * count), *values = malloc(sizeof *values * (size_t)width * (size_t)height);
    lc_status status = LC_OK;
    if (!sizes || !values) {
        status = lc_fail(err, LC_FAULT, "%s: out of memory", path);
        goto cleanup;
    }
    double variance = 0;
    size_t known = 0;
    for (size_t i = 0; i < count; ++i) {
        double d = fabs(difference->pixels[i].c[channel].mean);
        variance += lc_pixel_variance(&difference->pixels[i], channel) / (double)count;
        if (isfinite(d))
            sizes[known++] = d;
    }
    qsort(sizes, known, sizeof *sizes, ascending);
    double scale = fmax(3 * sqrt(variance), known ? sizes[known - 1 - known / 100] : 0);
    if (scale == 0 && known) /* fewer pixels differ than 1%, without any noise */
        scale = sizes[known - 1];
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            values[(size_t)y * (size_t)width + (size_t)x] =
                difference->pixels[(size_t)(y / zoom) * (size_t)difference->width + (size_t)(x / zoom)].c[channel].mean;
    status = lc_png_write_signed(path, width, height, values, scale > 0 && isfinite(scale) ? scale : 1, err);
cleanup:
    free(sizes);
    free(values);
    return status;
}

static lc_status write_enlarged(const char *path, const lc_film *film, double exposure, lc_error *err)
{
    int zoom = zoom_of(film), width = film->width * zoom, height = film->height * zoom;
    double(*rgb)[3] = malloc(sizeof *rgb * (size_t)width * (size_t)height);
    if (!rgb)
        return lc_fail(err, LC_FAULT, "%s: out of memory", path);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c)
                rgb[(size_t)y * (size_t)width + (size_t)x][c] =
                    film->pixels[(size_t)(y / zoom) * (size_t)film->width + (size_t)(x / zoom)].c[c].mean;
    lc_status status = lc_png_write(path, width, height, (const double(*)[3])rgb, exposure, err);
    free(rgb);
    return status;
}

/* Stops that turn a fifth of full brightness into what is expected on average; of what is there, where nothing is expected. */
static double exposure_of(const lc_film *expected, const lc_film *is)
{
    double sum[2] = {0, 0}, count = (double)expected->width * expected->height * 3;
    for (size_t i = 0; i < (size_t)expected->width * (size_t)expected->height; ++i)
        for (int c = 0; c < 3; ++c) {
            sum[0] += expected->pixels[i].c[c].mean / count;
            sum[1] += is->pixels[i].c[c].mean / count;
        }
    double mean = sum[0] > 0 ? sum[0] : sum[1];
    double stops = mean > 0 ? log2(0.2 / mean) : 0;
    return isfinite(stops) ? fmax(-90, fmin(90, stops)) : 0;
}

/* DIR/003_analytic_cornell_light_direct_1; what no file name should have in it becomes `_`. */
static void name_files(char *base, size_t size, const char *folder, int number, const lc_row *row)
{
    char name[200];
    snprintf(name, sizeof name, "%03d_%s_%s_%s_%d-%d", number, row->check, row->scene, row->estimator, row->min_bounces,
             row->max_bounces);
    for (char *c = name; *c; ++c)
        if (!isalnum((unsigned char)*c) && !strchr("_.-", *c))
            *c = '_';
    snprintf(base, size, "%s/%s", folder, name);
}

lc_status lc_pictures_write(const char *const paths[LC_PICTURES], const lc_exhibit *evidence, int channel, lc_error *err)
{
    lc_film *expected = NULL, *difference = NULL;
    lc_status status = create(&expected, evidence->is, err);
    if (status == LC_OK)
        status = create(&difference, evidence->is, err);
    if (status == LC_OK) {
        fill(expected, difference, evidence);
        const lc_film *const films[] = {evidence->is, expected, difference};
        double exposure = exposure_of(expected, evidence->is);
        for (int k = 0; k < LC_PICTURES && status == LC_OK; ++k)
            if (paths[k])
                status = k < 3   ? lc_exr_write(paths[k], films[k], err)
                         : k < 5 ? write_enlarged(paths[k], films[k - 3], exposure, err)
                                 : write_signed(paths[k], difference, channel, err);
    }
    lc_film_free(expected);
    lc_film_free(difference);
    return status;
}

lc_status lc_report_pictures(lc_row *row, const char *folder, int number, const lc_exhibit *evidence, lc_error *err)
{
    char text[LC_PICTURES][LC_MOST_PATH + 32];
    const char *paths[LC_PICTURES];
    row->pictures[0] = 0;
    if (strlen(folder) > LC_MOST_PATH / 2)
        return lc_fail(err, LC_FAULT, "%.100s...: too long a name for pictures", folder);
    name_files(row->pictures, sizeof row->pictures, folder, number, row);
    for (int k = 0; k < LC_PICTURES; ++k) {
        snprintf(text[k], sizeof text[k], "%s%s", row->pictures, lc_picture_kinds[k].ending);
        paths[k] = text[k];
    }
    lc_status status = lc_pictures_write(paths, evidence, row->channel, err);
    if (status != LC_OK)
        row->pictures[0] = 0;
    return status;
}
