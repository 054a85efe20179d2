/* SPDX-License-Identifier: GPL-3.0-or-later */
/* exr.c: pixels of films to and from OpenEXR images; see exr.h for the format, exr_attr.c for the attributes. */
#include "io/exr.h"

#include <OpenEXR/openexr.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/exr_attr.h"
#include "io/outfile.h"

/* Our channels; 0..2 mean, 3..5 variance, 7..9 skewness: last, because films without third moments leave it out. */
enum { MEAN = 0, VARIANCE = 3, SAMPLES = 6, SKEWNESS = 7, CHANNELS = 10 };
static const char *const channel_names[CHANNELS] = {"R",          "G",       "B",          "variance.R", "variance.G",
                                                    "variance.B", "samples", "skewness.R", "skewness.G", "skewness.B"};

/* A file that is being read or written; the library's callbacks find it as their user data. */
struct stream {
    const char *path;
    int fd;           /* reading */
    int64_t size;     /* reading: of the file [bytes] */
    lc_outfile *file; /* writing */
    lc_error *err;
    lc_status status; /* of our own I/O; when it failed, err is filled */
    char text[512];   /* the library's first complaint */
};

/* ---- what the library calls ------------------------------------------------------------------------- */

/* Keeps the first message: later ones are its consequences. Without a handler they would go to stderr. */
static void on_error(exr_const_context_t exr, exr_result_t code, const char *text)
{
    void *user = NULL;
    (void)code;
    if (!exr || exr_get_user_data(exr, &user) != EXR_ERR_SUCCESS || !user)
        return;
    struct stream *stream = user;
    if (!stream->text[0] && text)
        snprintf(stream->text, sizeof stream->text, "%s", text);
}

static int64_t on_size(exr_const_context_t exr, void *user)
{
    const struct stream *stream = user;
    (void)exr;
    return stream->size;
}

static int64_t on_read(exr_const_context_t exr, void *user, void *buffer, uint64_t size, uint64_t offset,
                       exr_stream_error_func_ptr_t error)
{
    struct stream *stream = user;
    uint64_t done = 0;
    if (offset > (uint64_t)stream->size)
        return error(exr, EXR_ERR_READ_IO, "offset behind the end of the file"), -1;
    while (done < size) {
        ssize_t got = pread(stream->fd, (char *)buffer + done, (size_t)(size - done), (off_t)(offset + done));
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0) {
            stream->status = lc_fail(stream->err, LC_FAULT, "%s: cannot read: %s", stream->path, strerror(errno));
            return -1;
        }
        if (got == 0) /* what is missing is reported by the library, which knows what it was */
            break;
        done += (uint64_t)got;
    }
    return (int64_t)done;
}

static int64_t on_write(exr_const_context_t exr, void *user, const void *buffer, uint64_t size, uint64_t offset,
                        exr_stream_error_func_ptr_t error)
{
    struct stream *stream = user;
    (void)exr;
    (void)error;
    stream->status = lc_outfile_write_at(stream->file, offset, buffer, (size_t)size, stream->err);
    return stream->status == LC_OK ? (int64_t)size : -1;
}

/* Zeroed, because the library decodes some damaged blocks only in part: they must read alike every time. */
static void *allocate(size_t size) { return calloc(1, size); }

/* The failure of a library call: our own I/O error when that was the cause, else its message. */
static lc_status fail_exr(struct stream *stream, lc_status status, exr_result_t result)
{
    if (stream->status != LC_OK)
        return stream->status;
    const char *text = stream->text[0] ? stream->text : exr_get_default_error_message(result);
    size_t path = strlen(stream->path);
    if (text[0] == '\'' && strncmp(text + 1, stream->path, path) == 0 && strncmp(text + 1 + path, "': ", 3) == 0)
        text += path + 4; /* the library names the file as well */
    return lc_fail(stream->err, status, "%s: %s: %s", stream->path,
                   stream->file ? "cannot write" : "no valid OpenEXR image", text);
}

/* ---- writing ---------------------------------------------------------------------------------------- */

static exr_result_t put_header(exr_context_t exr, const lc_film *film)
{
    int part;
    exr_result_t result = exr_add_part(exr, NULL, EXR_STORAGE_SCANLINE, &part);
    if (!result)
        result = exr_initialize_required_attr_simple(exr, 0, film->width, film->height, EXR_COMPRESSION_ZIP);
    for (int i = 0; i < (film->has_third ? CHANNELS : SKEWNESS) && !result; ++i)
        result = exr_add_channel(exr, 0, channel_names[i], i == SAMPLES ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT,
                                 EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    if (!result)
        result = lc_exr_put_attributes(exr, film);
    return result ? result : exr_write_header(exr);
}

union sample {
    float f;
    uint32_t u;
};

/* Index of a channel of ours, or -1. */
static int channel_index(const char *name)
{
    for (int i = 0; i < CHANNELS; ++i)
        if (strcmp(name, channel_names[i]) == 0)
            return i;
    return -1;
}

/* Of the samples: (m3 / n) / (m2 / n)^(3/2), in [-sqrt(n), sqrt(n)]. 0 where the file's variance is 0 or infinite: what is
 * read must be written alike again. */
static float skewness_of(const lc_pixel *pixel, int channel)
{
    const lc_moments *m = &pixel->c[channel];
    float variance = (float)lc_pixel_variance(pixel, channel);
    return variance > 0 && isfinite(variance) ? (float)(m->m3 * sqrt((double)pixel->n) / (m->m2 * sqrt(m->m2))) : 0;
}

/* One pixel into the plane of each channel, `plane` samples apart. */
static void put_pixel(const lc_pixel *pixel, union sample *out, size_t plane)
{
    for (int c = 0; c < 3; ++c) {
        out[(size_t)(MEAN + c) * plane].f = (float)pixel->c[c].mean;
        out[(size_t)(VARIANCE + c) * plane].f = (float)lc_pixel_variance(pixel, c);
        out[(size_t)(SKEWNESS + c) * plane].f = skewness_of(pixel, c);
    }
    out[SAMPLES * plane].u = (uint32_t)pixel->n;
}

static exr_result_t put_pixels(exr_context_t exr, const lc_film *film, union sample *buffer, int lines)
{
    exr_encode_pipeline_t pipe = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_chunk_info_t info;
    size_t width = (size_t)film->width, plane = width * (size_t)lines;
    exr_result_t result = EXR_ERR_SUCCESS;
    for (int y = 0; y < film->height && !result; y += lines) {
        int rows = lines < film->height - y ? lines : film->height - y;
        const lc_pixel *pixels = film->pixels + (size_t)y * width;
        for (size_t i = 0; i < width * (size_t)rows; ++i)
            put_pixel(&pixels[i], buffer + i, plane);
        result = exr_write_scanline_chunk_info(exr, 0, y, &info);
        if (!result)
            result = y == 0 ? exr_encoding_initialize(exr, 0, &info, &pipe) : exr_encoding_update(exr, 0, &info, &pipe);
        for (int i = 0; i < pipe.channel_count && !result; ++i) {
            exr_coding_channel_info_t *channel = &pipe.channels[i];
            channel->user_pixel_stride = sizeof *buffer;
            channel->user_line_stride = (int32_t)(width * sizeof *buffer);
            channel->encode_from_ptr = (const uint8_t *)(buffer + (size_t)channel_index(channel->channel_name) * plane);
        }
        if (!result && y == 0)
            result = exr_encoding_choose_default_routines(exr, 0, &pipe);
        if (!result)
            result = exr_encoding_run(exr, 0, &pipe);
    }
    exr_encoding_destroy(exr, &pipe);
    return result;
}

static lc_status write_image(struct stream *stream, const lc_film *film)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t exr = NULL;
    union sample *buffer = NULL;
    int32_t lines = 0;
    init.error_handler_fn = on_error;
    init.user_data = stream;
    init.write_fn = on_write;
    exr_result_t result = exr_start_write(&exr, stream->path, EXR_WRITE_FILE_DIRECTLY, &init);
    if (!result)
        result = put_header(exr, film);
    if (!result)
        result = exr_get_scanlines_per_chunk(exr, 0, &lines);
    if (!result)
        buffer = malloc(CHANNELS * (size_t)film->width * (size_t)lines * sizeof *buffer);
    if (!result)
        result = buffer ? put_pixels(exr, film, buffer, lines) : EXR_ERR_OUT_OF_MEMORY;
    exr_result_t finished = exr_finish(&exr); /* writes the table of chunks */
    free(buffer);
    result = result ? result : finished;
    return result || stream->status != LC_OK ? fail_exr(stream, LC_FAULT, result) : LC_OK;
}

lc_status lc_exr_write(const char *path, const lc_film *film, lc_error *err)
{
    struct stream stream = {path, -1, -1, NULL, err, LC_OK, ""};
    for (size_t i = 0; i < (size_t)film->width * (size_t)film->height; ++i)
        if (film->pixels[i].n > UINT32_MAX)
            return lc_fail(err, LC_BAD_INPUT, "%s: %llu samples in a pixel, at most 4294967295 fit the format", path,
                           (unsigned long long)film->pixels[i].n);
    lc_status status = lc_outfile_open(&stream.file, path, err);
    if (status != LC_OK)
        return status;
    status = write_image(&stream, film);
    if (status == LC_OK)
        return lc_outfile_commit(stream.file, err);
    lc_outfile_abort(stream.file);
    return status;
}

/* ---- reading ---------------------------------------------------------------------------------------- */

/* The image as its header describes it. */
struct image {
    int width, height;
    int left, top; /* of the data window */
    int tiled;
    int block_w, block_h; /* largest part that is decoded at once */
    int has[CHANNELS], has_third;
    union sample *buffer; /* one block, a plane for each channel */
    int samples_type;     /* EXR_PIXEL_UINT or _FLOAT */
    size_t plane;         /* samples of a plane */
};

static lc_status fail_input(const struct stream *stream, const char *text)
{
    return lc_fail(stream->err, LC_BAD_INPUT, "%s: %s", stream->path, text);
}

static lc_status open_stream(struct stream *stream)
{
    struct stat st;
    stream->fd = open(stream->path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); /* a FIFO must not hang us */
    if (stream->fd < 0 || fstat(stream->fd, &st) != 0)
        return lc_fail(stream->err, LC_BAD_INPUT, "%s: cannot open: %s", stream->path, strerror(errno));
    if (!S_ISREG(st.st_mode))
        return fail_input(stream, "not a file, expected an OpenEXR image");
    stream->size = st.st_size;
    return LC_OK;
}

static lc_status find_channels(struct image *image, exr_const_context_t exr, struct stream *stream)
{
    const exr_attr_chlist_t *list = NULL;
    exr_result_t result = exr_get_channels(exr, 0, &list);
    if (result)
        return fail_exr(stream, LC_BAD_INPUT, result);
    for (int i = 0; i < list->num_channels; ++i) {
        const exr_attr_chlist_entry_t *entry = &list->entries[i];
        int c = channel_index(entry->name.str);
        if (c < 0 || (c != SAMPLES && entry->pixel_type == EXR_PIXEL_UINT))
            continue;
        if (entry->x_sampling != 1 || entry->y_sampling != 1)
            return lc_fail(stream->err, LC_BAD_INPUT, "%s: channel %s is subsampled, expected all pixels", stream->path,
                           channel_names[c]);
        image->has[c] = 1;
        if (c == SAMPLES) /* programs that write one type only have it as a float */
            image->samples_type = entry->pixel_type == EXR_PIXEL_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
    }
    /* Without variances, another program's `samples` may be anything. */
    image->has[SAMPLES] = image->has[SAMPLES] && image->has[VARIANCE];
    image->has_third = image->has[SAMPLES];
    for (int c = 0; c < 3; ++c)
        image->has_third = image->has_third && image->has[VARIANCE + c] && image->has[SKEWNESS + c];
    for (int c = MEAN; c < MEAN + 3; ++c)
        if (!image->has[c])
            return lc_fail(stream->err, LC_BAD_INPUT, "%s: no channel %s, expected R G B as half or float",
                           stream->path, channel_names[c]);
    return LC_OK;
}

static lc_status read_header(struct image *image, exr_const_context_t exr, struct stream *stream)
{
    exr_storage_t storage;
    exr_attr_box2i_t window;
    int32_t w = 0, h = 0;
    exr_result_t result = exr_get_storage(exr, 0, &storage);
    if (!result)
        result = exr_get_data_window(exr, 0, &window);
    if (result)
        return fail_exr(stream, LC_BAD_INPUT, result);
    int64_t width = (int64_t)window.max.x - window.min.x + 1, height = (int64_t)window.max.y - window.min.y + 1;
    if (width < 1 || height < 1 || width > LC_MAX_SIZE || height > LC_MAX_SIZE)
        return lc_fail(stream->err, LC_BAD_INPUT, "%s: an image of %lldx%lld pixels, expected 1x1 to %dx%d",
                       stream->path, (long long)width, (long long)height, LC_MAX_SIZE, LC_MAX_SIZE);
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED)
        return fail_input(stream, "a deep image, expected one colour a pixel");
    image->width = (int)width;
    image->height = (int)height;
    image->left = window.min.x;
    image->top = window.min.y;
    image->tiled = storage == EXR_STORAGE_TILED;
    w = image->width;
    result = image->tiled ? exr_get_tile_sizes(exr, 0, 0, 0, &w, &h) : exr_get_scanlines_per_chunk(exr, 0, &h);
    if (result || w < 1 || h < 1)
        return fail_exr(stream, LC_BAD_INPUT, result ? result : EXR_ERR_INVALID_ATTR);
    image->block_w = w;
    image->block_h = h;
    return find_channels(image, exr, stream);
}

static void aim_channels(exr_decode_pipeline_t *pipe, const struct image *image, int row)
{
    for (int i = 0; i < pipe->channel_count; ++i) {
        exr_coding_channel_info_t *channel = &pipe->channels[i];
        int c = channel_index(channel->channel_name);
        if (c < 0 || !image->has[c])
            continue; /* without a place to go it is skipped */
        channel->user_data_type = c == SAMPLES ? (uint16_t)image->samples_type : EXR_PIXEL_FLOAT;
        channel->user_bytes_per_element = sizeof *image->buffer;
        channel->user_pixel_stride = sizeof *image->buffer;
        channel->user_line_stride = (int32_t)((size_t)row * sizeof *image->buffer);
        channel->decode_to_ptr = (uint8_t *)(image->buffer + (size_t)c * image->plane);
    }
}

/* A number of samples, stored as an integer or as a float; 0 (unknown) for a float that is none. */
static uint64_t count_of(const union sample *in, int type)
{
    if (type == EXR_PIXEL_UINT)
        return in->u;
    return in->f >= 1 && in->f <= 4294967040.0f ? (uint64_t)in->f : 0;
}

/* The third moment from the skewness, once n and m2 are there. With fewer than two samples there is none. */
static lc_status take_skewness(lc_pixel *pixel, int channel, double skewness, int x, int y, const struct stream *stream)
{
    lc_moments *m = &pixel->c[channel];
    double n = (double)pixel->n;
    if (n < 2)
        return LC_OK;
    if (!(fabs(skewness) <= sqrt(n) * (1 + 1e-6))) /* rounded to float */
        return lc_fail(stream->err, LC_BAD_INPUT,
                       "%s: a skewness of %g at pixel %d,%d, expected at most %g, the root of %.0f samples", stream->path,
                       skewness, x, y, sqrt(n), n);
    m->m3 = skewness * m->m2 * sqrt(m->m2 / n);
    return LC_OK;
}

static lc_status take_pixel(lc_film *film, const struct image *image, int x, int y, const union sample *in,
                            const struct stream *stream)
{
    lc_pixel *pixel = &film->pixels[(size_t)y * (size_t)film->width + (size_t)x];
    lc_status status = LC_OK;
    int finite = 1;
    pixel->n = image->has[SAMPLES] ? count_of(&in[SAMPLES * image->plane], image->samples_type) : 0;
    double n = (double)pixel->n;
    for (int c = 0; c < 3 && status == LC_OK; ++c) {
        double mean = in[(size_t)(MEAN + c) * image->plane].f;
        double variance = image->has[VARIANCE + c] ? in[(size_t)(VARIANCE + c) * image->plane].f : 0;
        if (!(variance >= 0))
            return lc_fail(stream->err, LC_BAD_INPUT, "%s: a variance of %g at pixel %d,%d, expected 0 or more",
                           stream->path, variance, x, y);
        pixel->c[c].mean = mean;
        pixel->c[c].m2 = pixel->n < 2 ? 0 : variance * n * (n - 1);
        finite = finite && isfinite(mean);
        if (image->has_third)
            status = take_skewness(pixel, c, in[(size_t)(SKEWNESS + c) * image->plane].f, x, y, stream);
    }
    if (!finite && film->bad++ == 0) {
        film->bad_x = x;
        film->bad_y = y;
        for (int c = 0; c < 3; ++c)
            film->bad_value[c] = pixel->c[c].mean;
    }
    return status;
}

/* Decodes the block whose upper left corner is (x, y) of the image into image->buffer. */
static exr_result_t decode_block(exr_decode_pipeline_t *pipe, exr_const_context_t exr, const struct image *image, int x,
                                 int y, int w, int h)
{
    exr_chunk_info_t info;
    int first = x == 0 && y == 0;
    exr_result_t result = image->tiled
                              ? exr_read_tile_chunk_info(exr, 0, x / image->block_w, y / image->block_h, 0, 0, &info)
                              : exr_read_scanline_chunk_info(exr, 0, image->top + y, &info);
    if (!result && (info.width != w || info.height != h)) /* then it would not fit the buffer as planned */
        result = EXR_ERR_BAD_CHUNK_LEADER;
    if (!result)
        result = first ? exr_decoding_initialize(exr, 0, &info, pipe) : exr_decoding_update(exr, 0, &info, pipe);
    if (!result) {
        aim_channels(pipe, image, w);
        result = exr_decoding_choose_default_routines(exr, 0, pipe);
    }
    return result ? result : exr_decoding_run(exr, 0, pipe);
}

static lc_status start_film(lc_film **out, exr_const_context_t exr, const struct image *image, struct stream *stream)
{
    lc_status status = lc_film_create(out, image->width, image->height, stream->err);
    if (status != LC_OK)
        return status;
    (*out)->has_third = image->has_third;
    return lc_exr_take_attributes(*out, exr, stream->path, stream->err);
}

/* Decodes all blocks. The film is made after the first: a few hostile bytes shall not ask for gigabytes. */
static lc_status read_pixels(lc_film **out, exr_const_context_t exr, struct image *image, struct stream *stream)
{
    exr_decode_pipeline_t pipe = EXR_DECODE_PIPELINE_INITIALIZER;
    lc_status status = LC_OK;
    for (int y = 0; y < image->height && status == LC_OK; y += image->block_h)
        for (int x = 0; x < image->width && status == LC_OK; x += image->block_w) {
            int w = image->block_w < image->width - x ? image->block_w : image->width - x;
            int h = image->block_h < image->height - y ? image->block_h : image->height - y;
            exr_result_t result = decode_block(&pipe, exr, image, x, y, w, h);
            if (result)
                status = fail_exr(stream, LC_BAD_INPUT, result);
            if (status == LC_OK && !*out)
                status = start_film(out, exr, image, stream);
            for (int i = 0; i < w * h && status == LC_OK; ++i)
                status = take_pixel(*out, image, x + i % w, y + i / w, image->buffer + i, stream);
        }
    exr_decoding_destroy(exr, &pipe);
    return status;
}

static lc_status read_image(lc_film **out, struct stream *stream)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t exr = NULL;
    struct image image;
    memset(&image, 0, sizeof image);
    init.error_handler_fn = on_error;
    init.alloc_fn = allocate;
    init.free_fn = free;
    init.user_data = stream;
    init.read_fn = on_read;
    init.size_fn = on_size;
    init.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION; /* a damaged file is refused, not guessed at */
    exr_result_t result = exr_start_read(&exr, stream->path, &init);
    lc_status status = result ? fail_exr(stream, LC_BAD_INPUT, result) : read_header(&image, exr, stream);
    if (status == LC_OK) {
        int w = image.block_w < image.width ? image.block_w : image.width;
        int h = image.block_h < image.height ? image.block_h : image.height;
        image.plane = (size_t)w * (size_t)h;
        image.buffer = calloc(CHANNELS * image.plane, sizeof *image.buffer);
        if (!image.buffer)
            status = lc_fail(stream->err, LC_FAULT, "%s: out of memory", stream->path);
    }
    if (status == LC_OK)
        status = read_pixels(out, exr, &image, stream);
    exr_finish(&exr);
    free(image.buffer);
    return status;
}

lc_status lc_exr_read(lc_film **out, const char *path, lc_error *err)
{
    struct stream stream = {path, -1, -1, NULL, err, LC_OK, ""};
    *out = NULL;
    lc_status status = open_stream(&stream);
    if (status == LC_OK)
        status = read_image(out, &stream);
    if (stream.fd >= 0)
        close(stream.fd);
    if (status != LC_OK) {
        lc_film_free(*out);
        *out = NULL;
    }
    return status;
}
