/* SPDX-License-Identifier: GPL-3.0-or-later */
/* png.c: see png.h. */
#include "io/png.h"

#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>

#include "io/outfile.h"

/* What a row of a picture is made from; each kind uses what it needs. */
struct picture {
    int width, height;
    const double (*rgb)[3];
    const lc_film *film;
    const double *values;
    double scale; /* factor of the colours; or of the value that is full red */
    void (*row)(const struct picture *picture, int y, unsigned char *out);
};

struct writer {
    const char *path;
    lc_outfile *file;
    lc_error *err;
    lc_status status; /* of the first failure */
};

/* ---- colours ------------------------------------------------------------------------------------ */

static void put_magenta(unsigned char out[3])
{
    out[0] = out[2] = 255;
    out[1] = 0;
}

/* IEC 61966-2-1, to the nearest code. */
static unsigned char srgb_code(double x)
{
    if (x <= 0)
        return 0;
    if (x >= 1)
        return 255;
    double y = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
    return (unsigned char)(255 * y + 0.5);
}

static void put_color(const double rgb[3], double scale, unsigned char out[3])
{
    if (isnan(rgb[0]) || isnan(rgb[1]) || isnan(rgb[2])) {
        put_magenta(out);
        return;
    }
    for (int c = 0; c < 3; ++c)
        out[c] = rgb[c] <= 0 ? 0 : srgb_code(rgb[c] * scale); /* 0 * infinity is no NaN here */
}

static void put_signed(double value, double scale, unsigned char out[3])
{
    static const double red[3] = {190, 10, 30}, blue[3] = {20, 50, 190};
    if (isnan(value)) {
        put_magenta(out);
        return;
    }
    const double *end = value < 0 ? blue : red;
    double t = fmin(fabs(value) / scale, 1);
    for (int c = 0; c < 3; ++c)
        out[c] = (unsigned char)(255 - t * (255 - end[c]) + 0.5);
}

static void row_of_colors(const struct picture *picture, int y, unsigned char *out)
{
    const double(*rgb)[3] = picture->rgb + (size_t)y * (size_t)picture->width;
    for (int x = 0; x < picture->width; ++x)
        put_color(rgb[x], picture->scale, out + 3 * x);
}

static void row_of_film(const struct picture *picture, int y, unsigned char *out)
{
    const lc_pixel *pixels = picture->film->pixels + (size_t)y * (size_t)picture->width;
    for (int x = 0; x < picture->width; ++x) {
        double rgb[3] = {pixels[x].c[0].mean, pixels[x].c[1].mean, pixels[x].c[2].mean};
        put_color(rgb, picture->scale, out + 3 * x);
    }
}

static void row_of_signs(const struct picture *picture, int y, unsigned char *out)
{
    const double *values = picture->values + (size_t)y * (size_t)picture->width;
    for (int x = 0; x < picture->width; ++x)
        put_signed(values[x], picture->scale, out + 3 * x);
}

/* ---- libpng ------------------------------------------------------------------------------------- */

static void on_error(png_structp png, png_const_charp text)
{
    struct writer *writer = png_get_error_ptr(png);
    if (writer->status == LC_OK)
        writer->status = lc_fail(writer->err, LC_FAULT, "%s: cannot write: %s", writer->path, text);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp text)
{
    (void)png;
    (void)text;
}

static void on_write(png_structp png, png_bytep data, size_t size)
{
    struct writer *writer = png_get_io_ptr(png);
    writer->status = lc_outfile_write(writer->file, data, size, writer->err);
    if (writer->status != LC_OK)
        png_error(png, "write error");
}

static void on_flush(png_structp png) { (void)png; }

/* What libpng may leave by longjmp: nothing here lives on the stack across it. */
static void write_rows(png_structp png, png_infop info, const struct picture *picture, unsigned char *row)
{
    if (setjmp(png_jmpbuf(png)))
        return;
    png_set_IHDR(png, info, (png_uint_32)picture->width, (png_uint_32)picture->height, 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_RELATIVE);
    png_write_info(png, info);
    for (int y = 0; y < picture->height; ++y) {
        picture->row(picture, y, row);
        png_write_row(png, row);
    }
    png_write_end(png, NULL);
}

static lc_status write_picture(const char *path, const struct picture *picture, lc_error *err)
{
    struct writer writer = {path, NULL, err, LC_OK};
    png_structp png = NULL;
    png_infop info = NULL;
    unsigned char *row = NULL;
    if (picture->width < 1 || picture->height < 1 || picture->width > LC_MAX_SIZE || picture->height > LC_MAX_SIZE)
        return lc_fail(err, LC_BAD_INPUT, "%s: an image of %dx%d pixels, expected 1x1 to %dx%d", path, picture->width,
                       picture->height, LC_MAX_SIZE, LC_MAX_SIZE);
    writer.status = lc_outfile_open(&writer.file, path, err);
    if (writer.status != LC_OK)
        return writer.status;
    row = malloc(3 * (size_t)picture->width);
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer, on_error, on_warning);
    info = png ? png_create_info_struct(png) : NULL;
    if (!row || !info) {
        writer.status = lc_fail(err, LC_FAULT, "%s: out of memory", path);
        goto cleanup;
    }
    png_set_write_fn(png, &writer, on_write, on_flush);
    write_rows(png, info, picture, row);
cleanup:
    png_destroy_write_struct(&png, &info);
    free(row);
    if (writer.status == LC_OK)
        return lc_outfile_commit(writer.file, err);
    lc_outfile_abort(writer.file);
    return writer.status;
}

/* ---- public ------------------------------------------------------------------------------------- */

lc_status lc_png_write(const char *path, int width, int height, const double (*rgb)[3], double exposure, lc_error *err)
{
    struct picture picture = {width, height, rgb, NULL, NULL, exp2(exposure), row_of_colors};
    return write_picture(path, &picture, err);
}

lc_status lc_png_write_film(const char *path, const lc_film *film, double exposure, lc_error *err)
{
    struct picture picture = {film->width, film->height, NULL, film, NULL, exp2(exposure), row_of_film};
    return write_picture(path, &picture, err);
}

lc_status lc_png_write_signed(const char *path, int width, int height, const double *values, double scale,
                              lc_error *err)
{
    struct picture picture = {width, height, NULL, NULL, values, scale, row_of_signs};
    if (!(scale > 0) || isinf(scale))
        return lc_fail(err, LC_BAD_INPUT, "%s: a colour scale of %g, expected a positive number", path, scale);
    return write_picture(path, &picture, err);
}
