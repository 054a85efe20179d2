/* SPDX-License-Identifier: GPL-3.0-or-later */
/* exr_attr.c: see exr_attr.h. What a file says is checked here, since others trust the film. */
#include "io/exr_attr.h"

#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NAME_VERSION "lightcheck.version"
#define NAME_PASTED "lightcheck.pasted"      /* shards: "0 2 5" */
#define NAME_MORE "lightcheck.more"          /* ranges: "seed arm first count seed arm ..." */
#define NAME_BAD_PIXEL "lightcheck.badPixel" /* these three only where bad > 0 */
#define NAME_BAD_SAMPLE "lightcheck.badSample"
#define NAME_BAD_VALUE "lightcheck.badValue"

enum kind { TEXT, U64, U32, INT };
enum { TEXT_SIZE = 64 };

/* What every file of ours has. EXR's int is 32 bits and signed, hence decimal strings for the unsigned. */
static const struct field {
    const char *name;
    enum kind kind;
    size_t offset;
} fields[] = {
    {"lightcheck.scene", TEXT, offsetof(lc_film, scene)},
    {"lightcheck.estimator", TEXT, offsetof(lc_film, estimator)},
    {"lightcheck.seed", U64, offsetof(lc_film, seed)},
    {"lightcheck.arm", U32, offsetof(lc_film, arm)},
    {"lightcheck.first", U64, offsetof(lc_film, first)},
    {"lightcheck.count", U64, offsetof(lc_film, count)},
    {"lightcheck.minBounces", INT, offsetof(lc_film, min_bounces)},
    {"lightcheck.maxBounces", INT, offsetof(lc_film, max_bounces)},
    {"lightcheck.shard", INT, offsetof(lc_film, shard)},
    {"lightcheck.shards", INT, offsetof(lc_film, shards)},
    {"lightcheck.bad", U64, offsetof(lc_film, bad)},
};
enum { FIELDS = sizeof fields / sizeof fields[0] };

/* ---- writing ---------------------------------------------------------------------------------------- */

static exr_result_t put_number(exr_context_t exr, const char *name, uint64_t value)
{
    char text[24];
    snprintf(text, sizeof text, "%" PRIu64, value);
    return exr_attr_set_string(exr, 0, name, text);
}

static exr_result_t put_field(exr_context_t exr, const struct field *field, const lc_film *film)
{
    const void *value = (const char *)film + field->offset;
    switch (field->kind) {
    case TEXT:
        return exr_attr_set_string(exr, 0, field->name, value);
    case U64:
        return put_number(exr, field->name, *(const uint64_t *)value);
    case U32:
        return put_number(exr, field->name, *(const uint32_t *)value);
    case INT:
        break;
    }
    return exr_attr_set_int(exr, 0, field->name, *(const int *)value);
}

static exr_result_t put_pasted(exr_context_t exr, const lc_film *film)
{
    char text[LC_MAX_SHARDS * 5 + 1]; /* up to "1023 " each */
    size_t size = 0;
    text[0] = 0;
    for (int i = 0; i < LC_MAX_SHARDS; ++i)
        if (film->pasted[i / 64] >> (i % 64) & 1)
            size += (size_t)snprintf(text + size, sizeof text - size, "%s%d", size ? " " : "", i);
    return size ? exr_attr_set_string(exr, 0, NAME_PASTED, text) : EXR_ERR_SUCCESS;
}

static exr_result_t put_more(exr_context_t exr, const lc_film *film)
{
    enum { LONGEST = 20 + 10 + 20 + 20 + 4 }; /* digits of one range, and spaces */
    size_t room = (size_t)film->more_count * LONGEST + 1, size = 0;
    if (film->more_count == 0)
        return EXR_ERR_SUCCESS;
    char *text = malloc(room);
    if (!text)
        return EXR_ERR_OUT_OF_MEMORY;
    for (int i = 0; i < film->more_count; ++i) {
        const lc_range *r = &film->more[i];
        size += (size_t)snprintf(text + size, room - size, "%s%" PRIu64 " %" PRIu32 " %" PRIu64 " %" PRIu64,
                                 i ? " " : "", r->seed, r->arm, r->first, r->count);
    }
    exr_result_t result = exr_attr_set_string(exr, 0, NAME_MORE, text);
    free(text);
    return result;
}

static exr_result_t put_bad(exr_context_t exr, const lc_film *film)
{
    if (film->bad == 0)
        return EXR_ERR_SUCCESS;
    exr_attr_v2i_t at;
    exr_attr_v3d_t value;
    for (int i = 0; i < 3; ++i)
        value.arr[i] = film->bad_value[i];
    at.x = film->bad_x;
    at.y = film->bad_y;
    exr_result_t result = exr_attr_set_v2i(exr, 0, NAME_BAD_PIXEL, &at);
    if (!result)
        result = put_number(exr, NAME_BAD_SAMPLE, film->bad_sample);
    return result ? result : exr_attr_set_v3d(exr, 0, NAME_BAD_VALUE, &value);
}

exr_result_t lc_exr_put_attributes(exr_context_t exr, const lc_film *film)
{
    exr_result_t result = exr_attr_set_string(exr, 0, NAME_VERSION, LC_VERSION);
    for (int i = 0; i < FIELDS && !result; ++i)
        result = put_field(exr, &fields[i], film);
    if (!result)
        result = put_pasted(exr, film);
    if (!result)
        result = put_more(exr, film);
    return result ? result : put_bad(exr, film);
}

/* ---- reading ---------------------------------------------------------------------------------------- */

/* A copy of a string attribute, ended by a NUL, for the caller to free; NULL when it is absent or no plain text. */
static char *take_text(exr_const_context_t exr, const char *name)
{
    int32_t size = 0;
    const char *text = NULL;
    if (exr_attr_get_string(exr, 0, name, &size, &text) != EXR_ERR_SUCCESS || !text || size < 0)
        return NULL;
    for (int32_t i = 0; i < size; ++i) /* it will stand in messages on a terminal */
        if (iscntrl((unsigned char)text[i]))
            return NULL;
    char *copy = malloc((size_t)size + 1);
    if (copy) {
        memcpy(copy, text, (size_t)size);
        copy[size] = 0;
    }
    return copy;
}

/* Reads a decimal number of at most `max` and moves *text behind it and one space; 0 when there is none. */
static int take_digits(const char **text, uint64_t max, uint64_t *out)
{
    char *end;
    if (!isdigit((unsigned char)**text))
        return 0;
    errno = 0;
    unsigned long long value = strtoull(*text, &end, 10);
    if (errno || value > max || (*end != 0 && *end != ' '))
        return 0;
    *text = *end ? end + 1 : end;
    *out = value;
    return 1;
}

static int take_number(exr_const_context_t exr, const char *name, uint64_t max, uint64_t *out)
{
    char *text = take_text(exr, name);
    const char *at = text;
    int ok = text && take_digits(&at, max, out) && *at == 0;
    free(text);
    return ok;
}

static int take_field(exr_const_context_t exr, const struct field *field, lc_film *film)
{
    void *value = (char *)film + field->offset;
    uint64_t number = 0;
    int32_t integer = 0;
    char *text;
    int ok = 0;
    switch (field->kind) {
    case TEXT:
        text = take_text(exr, field->name);
        ok = text && strlen(text) < TEXT_SIZE;
        if (ok)
            strcpy(value, text);
        free(text);
        break;
    case U64:
        ok = take_number(exr, field->name, UINT64_MAX, &number);
        *(uint64_t *)value = number;
        break;
    case U32:
        ok = take_number(exr, field->name, UINT32_MAX, &number);
        *(uint32_t *)value = (uint32_t)number;
        break;
    case INT:
        ok = exr_attr_get_int(exr, 0, field->name, &integer) == EXR_ERR_SUCCESS && integer >= 0;
        *(int *)value = integer;
        break;
    }
    return ok;
}

static int has_attribute(exr_const_context_t exr, const char *name)
{
    const exr_attribute_t *attribute = NULL;
    return exr_get_attribute_by_name(exr, 0, name, &attribute) == EXR_ERR_SUCCESS;
}

static int take_pasted(exr_const_context_t exr, lc_film *film)
{
    char *text = take_text(exr, NAME_PASTED);
    const char *at = text;
    uint64_t shard;
    int ok = text != NULL;
    while (ok && *at) {
        ok = take_digits(&at, (uint64_t)film->shards - 1, &shard);
        if (ok)
            film->pasted[shard / 64] |= (uint64_t)1 << (shard % 64);
    }
    free(text);
    return ok;
}

static int is_range(const lc_range *range) { return range->count > 0 && range->first <= UINT64_MAX - range->count; }

static int take_more(exr_const_context_t exr, lc_film *film)
{
    char *text = take_text(exr, NAME_MORE);
    const char *at = text;
    size_t room = text ? strlen(text) / 8 + 1 : 0; /* a range is "0 0 0 1 " or longer */
    int ok = text != NULL;
    if (ok)
        ok = (film->more = calloc(room, sizeof *film->more)) != NULL;
    while (ok && *at) {
        lc_range range;
        uint64_t arm;
        ok = take_digits(&at, UINT64_MAX, &range.seed) && take_digits(&at, UINT32_MAX, &arm) &&
             take_digits(&at, UINT64_MAX, &range.first) && take_digits(&at, UINT64_MAX, &range.count) &&
             is_range(&range) && (size_t)film->more_count < room;
        if (ok) {
            range.arm = (uint32_t)arm;
            film->more[film->more_count++] = range;
        }
    }
    free(text);
    return ok;
}

static int take_bad(exr_const_context_t exr, lc_film *film)
{
    exr_attr_v2i_t at;
    exr_attr_v3d_t value;
    if (exr_attr_get_v2i(exr, 0, NAME_BAD_PIXEL, &at) != EXR_ERR_SUCCESS || at.x < 0 || at.x >= film->width ||
        at.y < 0 || at.y >= film->height)
        return 0;
    if (!take_number(exr, NAME_BAD_SAMPLE, UINT64_MAX, &film->bad_sample) ||
        exr_attr_get_v3d(exr, 0, NAME_BAD_VALUE, &value) != EXR_ERR_SUCCESS)
        return 0;
    film->bad_x = at.x;
    film->bad_y = at.y;
    for (int i = 0; i < 3; ++i)
        film->bad_value[i] = value.arr[i];
    return 1;
}

static int is_sensible(const lc_film *film)
{
    lc_range range = {film->seed, film->arm, film->first, film->count};
    return (film->count == 0 || is_range(&range)) && film->min_bounces <= film->max_bounces && film->shards >= 1 &&
           film->shards <= LC_MAX_SHARDS && film->shard < film->shards;
}

lc_status lc_exr_take_attributes(lc_film *film, exr_const_context_t exr, const char *path, lc_error *err)
{
    static const char damaged[] = "%s: attribute %s is missing or damaged, expected what lightcheck writes";
    if (!has_attribute(exr, NAME_VERSION))
        return LC_OK;
    for (int i = 0; i < FIELDS; ++i)
        if (!take_field(exr, &fields[i], film))
            return lc_fail(err, LC_BAD_INPUT, damaged, path, fields[i].name);
    if (!is_sensible(film))
        return lc_fail(err, LC_BAD_INPUT,
                       "%s: bounces %d to %d, shard %d of %d, samples %" PRIu64 " from %" PRIu64
                       ": expected ranges that make sense",
                       path, film->min_bounces, film->max_bounces, film->shard, film->shards, film->count, film->first);
    if (has_attribute(exr, NAME_PASTED) && !take_pasted(exr, film))
        return lc_fail(err, LC_BAD_INPUT, damaged, path, NAME_PASTED);
    if (has_attribute(exr, NAME_MORE) && !take_more(exr, film))
        return lc_fail(err, LC_BAD_INPUT, damaged, path, NAME_MORE);
    if (film->bad && !take_bad(exr, film))
        return lc_fail(err, LC_BAD_INPUT, damaged, path, NAME_BAD_PIXEL);
    return LC_OK;
}
