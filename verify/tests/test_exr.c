/* SPDX-License-Identifier: GPL-3.0-or-later */
/* EXR: films there and back, images of other programs (built here byte by byte, from the format's description), and
 * files that are damaged in hundreds of ways. */
#include "verify/tests/tests.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/exr.h"

static char target[64];

static void make_target(void)
{
    strcpy(target, "/tmp/lightcheck-test-XXXXXX");
    int fd = mkstemp(target);
    ck_assert_int_ge(fd, 0);
    close(fd);
}

static void remove_target(void) { unlink(target); }

struct bytes {
    unsigned char *data;
    size_t size;
};

static struct bytes load(const char *path)
{
    struct bytes bytes = {malloc(1 << 20), 0};
    FILE *file = fopen(path, "rb");
    ck_assert_ptr_nonnull(file);
    ck_assert_ptr_nonnull(bytes.data);
    bytes.size = fread(bytes.data, 1, 1 << 20, file);
    fclose(file);
    return bytes;
}

static void save(const unsigned char *data, size_t size)
{
    FILE *file = fopen(target, "wb");
    ck_assert_ptr_nonnull(file);
    ck_assert_uint_eq(fwrite(data, 1, size, file), size);
    ck_assert_int_eq(fclose(file), 0);
}

/* ---- our own films ------------------------------------------------------------------------------ */

/* More lines than two chunks of 16, and no multiple of them. */
static lc_film *make_film(void)
{
    lc_film *film;
    ck_assert_int_eq(lc_film_create(&film, 21, 37, NULL), LC_OK);
    strcpy(film->scene, "cornell_box");
    strcpy(film->estimator, "path");
    film->seed = UINT64_MAX;
    film->arm = 0x80000001u;
    film->first = 1u << 20;
    film->count = (uint64_t)1 << 40;
    film->min_bounces = 1;
    film->max_bounces = 5;
    film->shard = 2;
    film->shards = 7;
    uint32_t state = 1;
    for (int i = 0; i < 21 * 37; ++i)
        for (int k = 0; k < i % 5; ++k) { /* also 0 and 1 samples */
            double x[1][3];
            for (int c = 0; c < 3; ++c)
                x[0][c] = (c + 1) * ((double)(state = state * 1664525u + 1013904223u) / 4294967296.0);
            lc_pixel_add(&film->pixels[i], (const double(*)[3])x, 1);
        }
    return film;
}

static lc_film *read_film(void)
{
    lc_error err;
    lc_film *film;
    lc_status status = lc_exr_read(&film, target, &err);
    ck_assert_msg(status == LC_OK, "%s", err.text);
    return film;
}

static void ck_same_record(const lc_film *a, const lc_film *b)
{
    ck_assert_str_eq(a->scene, b->scene);
    ck_assert_str_eq(a->estimator, b->estimator);
    ck_assert_uint_eq(a->seed, b->seed);
    ck_assert_uint_eq(a->arm, b->arm);
    ck_assert_uint_eq(a->first, b->first);
    ck_assert_uint_eq(a->count, b->count);
    ck_assert_int_eq(a->min_bounces, b->min_bounces);
    ck_assert_int_eq(a->max_bounces, b->max_bounces);
    ck_assert_int_eq(a->shard, b->shard);
    ck_assert_int_eq(a->shards, b->shards);
    ck_assert_uint_eq(a->bad, b->bad);
    ck_assert_int_eq(a->more_count, b->more_count);
    ck_assert_mem_eq(a->pasted, b->pasted, sizeof a->pasted);
}

START_TEST(a_film_there_and_back)
{
    lc_film *film = make_film();
    ck_assert_int_eq(lc_exr_write(target, film, NULL), LC_OK);
    lc_film *back = read_film();
    ck_assert_int_eq(back->width, 21);
    ck_assert_int_eq(back->height, 37);
    ck_assert_int_eq(back->has_third, 1);
    ck_same_record(back, film);
    int skewed = 0;
    for (int i = 0; i < 21 * 37; ++i) {
        const lc_pixel *a = &film->pixels[i], *b = &back->pixels[i];
        ck_assert_uint_eq(a->n, b->n);
        for (int c = 0; c < 3; ++c) {
            ck_assert_double_eq(b->c[c].mean, (float)a->c[c].mean);
            ck_assert_double_le(fabs(b->c[c].m2 - a->c[c].m2), 1e-6 * a->c[c].m2);
            ck_assert_double_le(fabs(b->c[c].m3 - a->c[c].m3), 1e-6 * pow(a->c[c].m2, 1.5));
            skewed += fabs(b->c[c].m3) > 1e-3 * pow(a->c[c].m2, 1.5);
        }
    }
    ck_assert_int_gt(skewed, 21 * 37 / 2);
    lc_film_free(back);
    lc_film_free(film);
}
END_TEST

/* What has no third moments says so; a sum with it has none, the sum of two that have them does. */
START_TEST(third_moments_are_there_or_not)
{
    lc_film *film = make_film(), *memory = make_film(), *sum[2];
    memory->shards = film->shards = 1, memory->shard = film->shard = 0;
    for (int third = 0; third < 2; ++third) {
        film->seed = 2, film->has_third = 1;
        ck_assert_int_eq(lc_exr_write(target, film, NULL), LC_OK);
        sum[third] = read_film();
        film->seed = 3, film->has_third = third;
        ck_assert_int_eq(lc_exr_write(target, film, NULL), LC_OK);
        lc_film *back = read_film();
        ck_assert_int_eq(back->has_third, third);
        ck_assert_int_eq(back->pixels[4].c[1].m3 != 0, third);
        ck_assert_double_gt(back->pixels[4].c[1].m2, 0);
        ck_assert_int_eq(lc_film_merge(sum[third], back, NULL), LC_OK);
        ck_assert_int_eq(sum[third]->has_third, third);
        lc_film_free(back);
    }
    for (int i = 0; i < 21 * 37; ++i) {
        lc_pixel_merge(&memory->pixels[i], &film->pixels[i]);
        const lc_moments *a = memory->pixels[i].c, *b = sum[1]->pixels[i].c;
        for (int c = 0; c < 3; ++c)
            ck_assert_double_le(fabs(b[c].m3 - a[c].m3), 1e-5 * pow(a[c].m2, 1.5));
    }
    lc_film_free(sum[0]), lc_film_free(sum[1]), lc_film_free(memory), lc_film_free(film);
}
END_TEST

START_TEST(rare_attributes_there_and_back)
{
    lc_film *film = make_film();
    lc_range more[2] = {{UINT64_MAX, UINT32_MAX, UINT64_MAX - 1, 1}, {3, 4, 5, 6}};
    film->pasted[0] = 0x25; /* 0 2 5 */
    film->more = malloc(sizeof more);
    ck_assert_ptr_nonnull(film->more);
    memcpy(film->more, more, sizeof more);
    film->more_count = 2;
    film->bad = 9;
    film->bad_x = 20;
    film->bad_y = 36;
    film->bad_sample = 1234567890123;
    film->bad_value[0] = -0.1;
    film->bad_value[1] = INFINITY;
    film->bad_value[2] = NAN;
    ck_assert_int_eq(lc_exr_write(target, film, NULL), LC_OK);
    lc_film *back = read_film();
    ck_same_record(back, film);
    for (int i = 0; i < 2; ++i) {
        ck_assert_uint_eq(back->more[i].seed, more[i].seed);
        ck_assert_uint_eq(back->more[i].arm, more[i].arm);
        ck_assert_uint_eq(back->more[i].first, more[i].first);
        ck_assert_uint_eq(back->more[i].count, more[i].count);
    }
    ck_assert_int_eq(back->bad_x, 20);
    ck_assert_int_eq(back->bad_y, 36);
    ck_assert_uint_eq(back->bad_sample, film->bad_sample);
    ck_assert_double_eq(back->bad_value[0], -0.1);
    ck_assert(isinf(back->bad_value[1]) && isnan(back->bad_value[2]));
    lc_film_free(back);
    lc_film_free(film);
}
END_TEST

START_TEST(same_film_same_bytes)
{
    char other[80];
    lc_film *film = make_film();
    snprintf(other, sizeof other, "%s-of-another-name", target);
    ck_assert_int_eq(lc_exr_write(target, film, NULL), LC_OK);
    ck_assert_int_eq(lc_exr_write(other, film, NULL), LC_OK);
    struct bytes a = load(target), b = load(other);
    unlink(other);
    ck_assert_uint_eq(a.size, b.size);
    ck_assert_mem_eq(a.data, b.data, a.size);
    /* and a file that was read gives itself again: float to double to float */
    lc_film *back = read_film();
    ck_assert_int_eq(lc_exr_write(target, back, NULL), LC_OK);
    struct bytes again = load(target);
    ck_assert_uint_eq(a.size, again.size);
    ck_assert_mem_eq(a.data, again.data, a.size);
    free(a.data), free(b.data), free(again.data);
    lc_film_free(back);
    lc_film_free(film);
}
END_TEST

/* Shards that went through files paste to what the whole gives. */
START_TEST(shards_merge_through_files)
{
    lc_film *film = make_film(), *part[2];
    for (int i = 0; i < 2; ++i) {
        film->shard = i;
        film->shards = 2;
        ck_assert_int_eq(lc_exr_write(target, film, NULL), LC_OK);
        part[i] = read_film();
    }
    ck_assert_int_eq(lc_film_merge(part[1], part[0], NULL), LC_OK);
    ck_assert_int_eq(part[1]->shards, 1);
    ck_assert_mem_eq(part[1]->pixels, part[0]->pixels, 21 * 37 * sizeof *part[0]->pixels);
    lc_film_free(part[0]), lc_film_free(part[1]), lc_film_free(film);
}
END_TEST

START_TEST(writing_fails_with_the_reason)
{
    lc_error err;
    lc_film *film = make_film();
    uid_t us;
    if (lc_test_drop_root(&us)) {
        ck_assert_int_eq(lc_exr_write("/dev/full", film, &err), LC_FAULT);
        ck_assert_str_eq(err.text, "/dev/full: cannot write: No space left on device");
        lc_test_restore_root(us);
    }
    ck_assert_int_eq(lc_exr_write("/nonexistent/x.exr", film, &err), LC_FAULT);
    ck_assert_str_eq(err.text, "/nonexistent/x.exr: cannot write: No such file or directory");
    film->pixels[3].n = (uint64_t)UINT32_MAX + 1;
    ck_assert_int_eq(lc_exr_write(target, film, &err), LC_BAD_INPUT);
    lc_film_free(film);
}
END_TEST

/* ---- files of others ---------------------------------------------------------------------------- */

enum { UINT, HALF, FLOAT }; /* as in the format */

struct spec {
    const char *channels;          /* sorted: "B1 G1 R1": name, type */
    int x, y, width, height, tile; /* tile 0: scan lines */
    int sampling;
};

static void put(struct bytes *out, const void *data, size_t size)
{
    memcpy(out->data + out->size, data, size);
    out->size += size;
}

static void put32(struct bytes *out, uint32_t value)
{
    for (int i = 0; i < 4; ++i)
        out->data[out->size++] = (unsigned char)(value >> 8 * i);
}

static void put_attribute(struct bytes *out, const char *name, const char *type, const struct bytes *value)
{
    put(out, name, strlen(name) + 1);
    put(out, type, strlen(type) + 1);
    put32(out, (uint32_t)value->size);
    put(out, value->data, value->size);
}

/* What pixel (x, y) of the image holds in a channel: exact in a half. */
static float value_at(char channel, int x, int y) { return (float)(channel % 7) + (float)x / 8 + (float)y / 4; }

static uint32_t half_bits(float value)
{
    int exponent;
    float mantissa = frexpf(value, &exponent); /* in [1/2, 1) */
    return value == 0 ? 0 : (uint32_t)(exponent + 14) << 10 | (uint32_t)((mantissa * 2 - 1) * 1024);
}

static void put_sample(struct bytes *out, char channel, int type, int x, int y)
{
    float value = value_at(channel, x, y);
    uint32_t bits = type == UINT ? (uint32_t)(10 * x + y) : half_bits(value);
    if (type == FLOAT)
        memcpy(&bits, &value, 4);
    put32(out, bits);
    if (type == HALF)
        out->size -= 2;
}

static void put_channels(struct bytes *out, const struct spec *spec)
{
    unsigned char buffer[256];
    struct bytes list = {buffer, 0};
    for (const char *c = spec->channels; *c;) {
        size_t name = strcspn(c, "012");
        put(&list, c, name);
        put(&list, "", 1);
        put32(&list, (uint32_t)(c[name] - '0'));
        put32(&list, 0);
        put32(&list, (uint32_t)spec->sampling);
        put32(&list, (uint32_t)spec->sampling);
        c += name + 1;
        c += *c == ' ';
    }
    put(&list, "", 1);
    put_attribute(out, "channels", "chlist", &list);
}

static void put_numbers(struct bytes *out, const char *name, const char *type, int count, const uint32_t *values)
{
    unsigned char buffer[64];
    struct bytes value = {buffer, 0};
    for (int i = 0; i < count; ++i)
        put32(&value, values[i]);
    put_attribute(out, name, type, &value);
}

static void put_block(struct bytes *out, const struct spec *spec, int x, int y, int w, int h)
{
    if (spec->tile) {
        put32(out, (uint32_t)(x / spec->tile)), put32(out, (uint32_t)(y / spec->tile));
        put32(out, 0), put32(out, 0);
    } else
        put32(out, (uint32_t)(spec->y + y));
    size_t size_at = out->size;
    put32(out, 0);
    for (int j = y; j < y + h; ++j)
        for (const char *c = spec->channels; *c; c += strcspn(c, " "), c += *c == ' ')
            for (int i = x; i < x + w; ++i)
                put_sample(out, *c, c[strcspn(c, "012")] - '0', i, j);
    struct bytes patch = {out->data, size_at};
    put32(&patch, (uint32_t)(out->size - size_at - 4));
}

/* An uncompressed image, as "OpenEXR File Layout" describes it. */
static struct bytes build(const struct spec *spec)
{
    struct bytes out = {calloc(1, 1 << 20), 0};
    const uint32_t window[4] = {(uint32_t)spec->x, (uint32_t)spec->y, (uint32_t)(spec->x + spec->width - 1),
                                (uint32_t)(spec->y + spec->height - 1)};
    const uint32_t one = 0x3f800000, zeros[2] = {0, 0};
    struct bytes zero = {(unsigned char *)"\0\0", 1};
    ck_assert_ptr_nonnull(out.data);
    put32(&out, 20000630);
    put32(&out, spec->tile ? 0x202 : 2);
    put_channels(&out, spec);
    put_attribute(&out, "compression", "compression", &zero);
    put_numbers(&out, "dataWindow", "box2i", 4, window);
    put_numbers(&out, "displayWindow", "box2i", 4, window);
    put_attribute(&out, "lineOrder", "lineOrder", &zero);
    put_numbers(&out, "pixelAspectRatio", "float", 1, &one);
    put_numbers(&out, "screenWindowCenter", "v2f", 2, zeros);
    put_numbers(&out, "screenWindowWidth", "float", 1, &one);
    if (spec->tile) {
        const uint32_t size[2] = {(uint32_t)spec->tile, (uint32_t)spec->tile};
        put_numbers(&out, "tiles", "tiledesc", 2, size);
        out.data[out.size - 9] = 0; /* nine bytes: two sizes and a mode */
        struct bytes length = {out.data, out.size - 12};
        put32(&length, 9);
        put(&out, "", 1);
    }
    put(&out, "", 1);
    int w = spec->tile ? spec->tile : spec->width, h = spec->tile ? spec->tile : 1;
    int blocks = ((spec->width + w - 1) / w) * ((spec->height + h - 1) / h), block = 0;
    size_t table = out.size;
    out.size += 8 * (size_t)blocks;
    for (int y = 0; y < spec->height; y += h)
        for (int x = 0; x < spec->width; x += w) {
            struct bytes entry = {out.data, table + 8 * (size_t)block++};
            put32(&entry, (uint32_t)out.size);
            put_block(&out, spec, x, y, w < spec->width - x ? w : spec->width - x,
                      h < spec->height - y ? h : spec->height - y);
        }
    return out;
}

static const struct spec foreign[] = {
    {"B1 G1 R1", 0, 0, 5, 4, 0, 1},          /* half, as POV-Ray writes */
    {"A2 B2 G2 R2 Z2", 0, 0, 5, 4, 0, 1},    /* float, with more channels */
    {"B2 G1 R2", -3, 7, 6, 3, 0, 1},         /* mixed; a data window elsewhere */
    {"B1 G1 R1", 0, 0, 21, 11, 8, 1},        /* tiles, not all of them whole */
    {"B2 G2 R2", 5, -9, 3, 2, 16, 1},        /* a tile larger than the image */
    {"B2 G2 R2 samples2", 0, 0, 3, 2, 0, 1}, /* `samples` that mean something else */
};

START_TEST(images_of_others)
{
    const struct spec *spec = &foreign[_i];
    struct bytes bytes = build(spec);
    save(bytes.data, bytes.size);
    free(bytes.data);
    lc_film *film = read_film();
    ck_assert_int_eq(film->width, spec->width);
    ck_assert_int_eq(film->height, spec->height);
    ck_assert_int_eq(film->has_third, 0);
    ck_assert_uint_eq(film->count, 0);
    ck_assert_int_eq(film->shards, 1);
    ck_assert_str_eq(film->scene, "");
    for (int y = 0; y < spec->height; ++y)
        for (int x = 0; x < spec->width; ++x)
            for (int c = 0; c < 3; ++c) {
                const lc_pixel *pixel = &film->pixels[y * spec->width + x];
                ck_assert_double_eq(pixel->c[c].mean, value_at("RGB"[c], x, y));
                ck_assert_double_eq(lc_pixel_variance(pixel, c), 0);
                ck_assert_uint_eq(pixel->n, 0);
            }
    lc_film_free(film);
}
END_TEST

START_TEST(variance_and_samples_of_others)
{
    const struct spec spec = {"B2 G2 R2 samples0 variance.R2", 0, 0, 4, 3, 0, 1};
    struct bytes bytes = build(&spec);
    save(bytes.data, bytes.size);
    free(bytes.data);
    lc_film *film = read_film();
    const lc_pixel *pixel = &film->pixels[2 * 4 + 3];
    ck_assert_uint_eq(pixel->n, 32);
    ck_assert_double_eq(lc_pixel_variance(pixel, 0), value_at('v', 3, 2));
    ck_assert_double_eq(lc_pixel_variance(pixel, 1), 0);
    lc_film_free(film);
}
END_TEST

/* Samples 0 10 20 30. */
START_TEST(skewness_of_others)
{
    static const struct {
        const char *channels;
        int third;
    } cases[] = {
        {"B2 G2 R2 samples0 skewness.B2 skewness.G1 skewness.R2 variance.B2 variance.G2 variance.R2", 1},
        {"B2 G2 R2 samples0 skewness.B2 skewness.R2 variance.B2 variance.G2 variance.R2", 0},
        {"B2 G2 R2 samples0 skewness.B2 skewness.G2 skewness.R2 variance.B2 variance.R2", 0},
        {"B2 G2 R2 skewness.B2 skewness.G2 skewness.R2 variance.B2 variance.G2 variance.R2", 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        struct spec spec = {cases[i].channels, 0, 0, 4, 1, 0, 1};
        struct bytes bytes = build(&spec);
        save(bytes.data, bytes.size);
        free(bytes.data);
        lc_film *film = read_film();
        ck_assert_int_eq(film->has_third, cases[i].third);
        for (int x = 0; x < 4; ++x)
            for (int c = 0; c < 3; ++c) {
                double n = 10 * x, m2 = value_at('v', x, 0) * n * (n - 1);
                double m3 = x && cases[i].third ? n * value_at('s', x, 0) * pow(m2 / n, 1.5) : 0;
                ck_assert_double_le(fabs(film->pixels[x].c[c].m3 - m3), 1e-12 * m3);
            }
        lc_film_free(film);
    }
}
END_TEST

static void ck_refused(const char *word)
{
    lc_error err;
    lc_film *film;
    ck_assert_int_eq(lc_exr_read(&film, target, &err), LC_BAD_INPUT);
    ck_assert_ptr_null(film);
    ck_assert_msg(strncmp(err.text, target, strlen(target)) == 0, "'%s' does not name the file", err.text);
    ck_assert_msg(strstr(err.text, word) != NULL, "'%s' does not say '%s'", err.text, word);
}

static void ck_spec_refused(struct spec spec, const char *word)
{
    struct bytes bytes = build(&spec);
    save(bytes.data, bytes.size);
    free(bytes.data);
    ck_refused(word);
}

START_TEST(what_is_no_such_image)
{
    ck_spec_refused((struct spec){"B1 G1", 0, 0, 4, 4, 0, 1}, "no channel R, expected R G B");
    ck_spec_refused((struct spec){"Y1", 0, 0, 4, 4, 0, 1}, "no channel R");
    ck_spec_refused((struct spec){"B0 G0 R0", 0, 0, 4, 4, 0, 1}, "half or float");
    ck_spec_refused((struct spec){"B1 G1 R1", 0, 0, 4, 4, 0, 2}, "subsampled");
    ck_spec_refused((struct spec){"B1 G1 R1", 0, 0, LC_MAX_SIZE + 1, 1, 0, 1}, "16385x1");
    save((const unsigned char *)"", 0);
    ck_refused("OpenEXR");
    save((const unsigned char *)"GIF89a and so on", 16);
    ck_refused("OpenEXR");
    unlink(target);
    ck_refused("cannot open: No such file or directory");
    ck_assert_int_eq(mkdir(target, 0700), 0);
    ck_refused("not a file");
    rmdir(target);
    ck_assert_int_eq(mkfifo(target, 0600), 0);
    ck_refused("not a file");
}
END_TEST

/* Sizes that the header claims and the file cannot have. */
START_TEST(absurd_sizes)
{
    static const uint32_t max[][2] = {
        {0x7fffffff, 3},  {4, 0x7fffffff},      {0x7fffffff, 0x7fffffff},          {0xffffffff, 3},
        {LC_MAX_SIZE, 3}, {4, LC_MAX_SIZE - 1}, {LC_MAX_SIZE - 1, LC_MAX_SIZE - 1}};
    struct spec spec = {"B1 G1 R1", 0, 0, 4, 4, 0, 1};
    struct bytes bytes = build(&spec);
    for (size_t i = 0; i < bytes.size; ++i)
        if (memcmp(bytes.data + i, "dataWindow", 10) == 0) {
            struct bytes patch = {bytes.data, i + 11 + 6 + 4 + 8};
            put32(&patch, max[_i][0]);
            put32(&patch, max[_i][1]);
            break;
        }
    save(bytes.data, bytes.size);
    free(bytes.data);
    ck_refused(":");
}
END_TEST

START_TEST(values_that_are_no_numbers)
{
    struct spec spec = {"B2 G2 R2 variance.R2", 0, 0, 2, 1, 0, 1};
    struct bytes bytes = build(&spec);
    struct bytes patch = {bytes.data, bytes.size - 16 - 4}; /* G of pixel 1: the rows are B B G G R R v v */
    put32(&patch, 0x7fc00000);
    save(bytes.data, bytes.size);
    lc_film *film = read_film();
    ck_assert_uint_eq(film->bad, 1);
    ck_assert_int_eq(film->bad_x, 1);
    ck_assert(isnan(film->bad_value[1]));
    lc_film_free(film);
    patch.size = bytes.size - 4;
    put32(&patch, 0xbf800000);
    save(bytes.data, bytes.size);
    free(bytes.data);
    ck_refused("a variance of -1 at pixel 1,0");
}
END_TEST

/* No n numbers have a skewness beyond sqrt(n). */
START_TEST(skewness_that_cannot_be)
{
    struct spec spec = {"B2 G2 R2 samples0 skewness.B2 skewness.G2 skewness.R2 variance.B2 variance.G2 variance.R2",
                        0, 0, 4, 1, 0, 1};
    struct bytes bytes = build(&spec);
    struct bytes patch = {bytes.data, bytes.size - 16 * 3 - 12}; /* R of pixel 1, which has 10 samples */
    static const uint32_t bits[] = {0x404ccccd, 0xc04ccccd, 0x7fc00000, 0x7f800000}; /* 3.2, -3.2, NaN, infinity */
    for (size_t i = 0; i < sizeof bits / sizeof bits[0]; ++i) {
        struct bytes at = patch;
        put32(&at, bits[i]);
        save(bytes.data, bytes.size);
        ck_refused(i == 1 ? "a skewness of -3.2 at pixel 1,0, expected at most 3.16228" : "at pixel 1,0, expected at most");
    }
    free(bytes.data);
}
END_TEST

/* ---- damage ------------------------------------------------------------------------------------- */

/* Replaces the first occurrence of `from` by `to`, of the same length. */
static void replace(struct bytes *bytes, const char *from, const char *to)
{
    size_t size = strlen(from);
    for (size_t i = 0; i + size <= bytes->size; ++i)
        if (memcmp(bytes->data + i, from, size) == 0) {
            memcpy(bytes->data + i, to, size);
            return;
        }
    ck_abort_msg("no '%s' in the file", from);
}

START_TEST(damaged_attributes)
{
    static const struct {
        const char *from, *to, *says;
    } cases[] = {
        {"lightcheck.seed", "lightcheck.sead", "lightcheck.seed"},
        {"18446744073709551615", "18446744073709551616", "lightcheck.seed"},
        {"18446744073709551615", "-1844674407370955161", "lightcheck.seed"},
        {"2147483649", "9147483649", "lightcheck.arm"},
        {"1099511627776", "109951162777x", "lightcheck.count"},
        {"cornell_box", "cornell\nbox", "lightcheck.scene"},
        {"0 2 5", "0 2 7", "lightcheck.pasted"},
        {"0 2 5", "0  25", "lightcheck.pasted"},
        {"3 4 5 6", "3 4 5 0", "lightcheck.more"},
        {"3 4 5 6", "3 4 5  ", "lightcheck.more"},
        {"3 4 5 6", "3 4 556", "lightcheck.more"},
    };
    lc_film *film = make_film();
    film->pasted[0] = 0x25;
    film->more = calloc(1, sizeof *film->more);
    ck_assert_ptr_nonnull(film->more);
    film->more[0] = (lc_range){3, 4, 5, 6};
    film->more_count = 1;
    ck_assert_int_eq(lc_exr_write(target, film, NULL), LC_OK);
    lc_film_free(read_film());
    lc_film_free(film);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        struct bytes bytes = load(target);
        struct bytes whole = load(target);
        replace(&bytes, cases[i].from, cases[i].to);
        save(bytes.data, bytes.size);
        ck_refused(cases[i].says);
        save(whole.data, whole.size);
        free(bytes.data), free(whole.data);
    }
}
END_TEST

/* Whatever is in the file, reading ends with a film or a reason. */
static lc_status read_damaged(const unsigned char *data, size_t size)
{
    lc_error err = {""};
    lc_film *film;
    save(data, size);
    lc_status status = lc_exr_read(&film, target, &err);
    ck_assert(status == LC_OK || status == LC_BAD_INPUT);
    ck_assert_int_eq(status == LC_OK, film != NULL);
    ck_assert_int_eq(status == LC_OK, err.text[0] == 0);
    lc_film_free(film);
    return status;
}

/* The library would print its complaints; they belong in the message instead. */
START_TEST(nothing_goes_to_stderr)
{
    char text[64];
    lc_error err;
    lc_film *film;
    struct bytes bytes = build(&foreign[0]);
    save(bytes.data, bytes.size - 1);
    free(bytes.data);
    FILE *caught = tmpfile();
    ck_assert_ptr_nonnull(caught);
    fflush(stderr);
    int saved = dup(STDERR_FILENO);
    dup2(fileno(caught), STDERR_FILENO);
    lc_status status = lc_exr_read(&film, target, &err);
    fflush(stderr);
    dup2(saved, STDERR_FILENO);
    close(saved);
    rewind(caught);
    ck_assert_uint_eq(fread(text, 1, sizeof text, caught), 0);
    fclose(caught);
    ck_assert_int_eq(status, LC_BAD_INPUT);
}
END_TEST

/* A film of ours, and two of the images above: compressed and not, lines and tiles. */
static struct bytes victim(int which)
{
    if (which)
        return build(&foreign[which == 1 ? 1 : 3]);
    lc_film *film = make_film();
    ck_assert_int_eq(lc_exr_write(target, film, NULL), LC_OK);
    lc_film_free(film);
    return load(target);
}

START_TEST(truncated_anywhere)
{
    struct bytes bytes = victim(_i);
    size_t step = bytes.size / 250 + 1;
    for (size_t size = 0; size < bytes.size; size += step)
        ck_assert_int_eq(read_damaged(bytes.data, size), LC_BAD_INPUT);
    ck_assert_int_eq(read_damaged(bytes.data, bytes.size - 1), LC_BAD_INPUT);
    ck_assert_int_eq(read_damaged(bytes.data, bytes.size), LC_OK);
    free(bytes.data);
}
END_TEST

START_TEST(bytes_flipped_anywhere)
{
    struct bytes bytes = victim(_i);
    uint32_t state = 7;
    int refused = 0;
    for (int round = 0; round < 600; ++round) {
        unsigned char old[3];
        size_t at[3];
        for (int i = 0; i < 3; ++i) { /* two of three in the header, where it hurts */
            state = state * 1664525u + 1013904223u;
            at[i] = (state >> 4) % (i < 2 && bytes.size > 800 ? 800 : bytes.size);
            old[i] = bytes.data[at[i]];
            bytes.data[at[i]] = (unsigned char)(round % 3 ? old[i] ^ 1u << (state >> 29) : state >> 24);
        }
        refused += read_damaged(bytes.data, bytes.size) == LC_BAD_INPUT;
        for (int i = 2; i >= 0; --i)
            bytes.data[at[i]] = old[i];
    }
    ck_assert_int_gt(refused, 100); /* the damage is real */
    free(bytes.data);
}
END_TEST

Suite *lc_suite_exr(void)
{
    Suite *suite = suite_create("exr");
    TCase *tc = tcase_create("films");
    tcase_add_checked_fixture(tc, make_target, remove_target);
    tcase_add_test(tc, a_film_there_and_back);
    tcase_add_test(tc, third_moments_are_there_or_not);
    tcase_add_test(tc, rare_attributes_there_and_back);
    tcase_add_test(tc, same_film_same_bytes);
    tcase_add_test(tc, shards_merge_through_files);
    tcase_add_test(tc, writing_fails_with_the_reason);
    suite_add_tcase(suite, tc);
    tc = tcase_create("images of others");
    tcase_add_checked_fixture(tc, make_target, remove_target);
    tcase_add_loop_test(tc, images_of_others, 0, sizeof foreign / sizeof foreign[0]);
    tcase_add_test(tc, variance_and_samples_of_others);
    tcase_add_test(tc, skewness_of_others);
    tcase_add_test(tc, what_is_no_such_image);
    tcase_add_loop_test(tc, absurd_sizes, 0, 7);
    tcase_add_test(tc, values_that_are_no_numbers);
    tcase_add_test(tc, skewness_that_cannot_be);
    suite_add_tcase(suite, tc);
    tc = tcase_create("damage");
    tcase_set_timeout(tc, 30);
    tcase_add_checked_fixture(tc, make_target, remove_target);
    tcase_add_test(tc, damaged_attributes);
    tcase_add_test(tc, nothing_goes_to_stderr);
    tcase_add_loop_test(tc, truncated_anywhere, 0, 3);
    tcase_add_loop_test(tc, bytes_flipped_anywhere, 0, 3);
    suite_add_tcase(suite, tc);
    return suite;
}
