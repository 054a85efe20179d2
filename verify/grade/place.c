/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/grade/place.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_BYTES = 1 << 20 };

/* ---- the file ------------------------------------------------------------------------------------------------------ */

static lc_status read_text(lc_json_file *out, lc_error *err)
{
    FILE *f = fopen(out->path, "rb");
    if (!f)
        return lc_fail(err, LC_BAD_INPUT, "%s: %s", out->path, strerror(errno));
    out->text = malloc(MOST_BYTES + 1);
    size_t length = out->text ? fread(out->text, 1, MOST_BYTES, f) : 0;
    int failed = ferror(f), is_more = out->text && fgetc(f) != EOF;
    fclose(f);
    if (!out->text)
        return lc_fail(err, LC_FAULT, "out of memory for %s", out->path);
    if (failed)
        return lc_fail(err, LC_BAD_INPUT, "%s: cannot be read", out->path);
    if (is_more)
        return lc_fail(err, LC_BAD_INPUT, "%s: longer than 1 MB", out->path);
    out->text[length] = 0;
    if (strlen(out->text) != length)
        return lc_fail(err, LC_BAD_INPUT, "%s: has a byte 0, which is no text", out->path);
    return LC_OK;
}

lc_status lc_json_open(lc_json_file *out, const char *path, lc_error *err)
{
    memset(out, 0, sizeof *out);
    if (strlen(path) >= sizeof out->path)
        return lc_fail(err, LC_BAD_INPUT, "the path is longer than %zu characters", sizeof out->path - 1);
    memcpy(out->path, path, strlen(path) + 1);
    lc_status status = read_text(out, err);
    json_error_t error;
    if (status == LC_OK) {
        out->root = json_loads(out->text, JSON_REJECT_DUPLICATES, &error);
        if (!out->root)
            status = lc_fail(err, LC_BAD_INPUT, "%s:%d: %s", path, error.line, error.text);
        else if (!json_is_object(out->root))
            status = lc_fail(err, LC_BAD_INPUT, "%s:1: expected an object, { ... }", path);
    }
    if (status != LC_OK)
        lc_json_close(out);
    return status;
}

void lc_json_close(lc_json_file *file)
{
    free(file->text);
    json_decref(file->root);
    file->text = NULL;
    file->root = NULL;
}

/* ---- where a value stands ------------------------------------------------------------------------------------------ */

lc_place lc_place_root(const lc_json_file *file) { return (lc_place){file, NULL, NULL, 0, file->root}; }

lc_place lc_place_key(const lc_place *place, const char *key)
{
    return (lc_place){place->file, place, key, 0, json_object_get(place->value, key)};
}

lc_place lc_place_item(const lc_place *place, size_t index)
{
    return (lc_place){place->file, place, NULL, index, json_array_get(place->value, index)};
}

static const char *skip_space(const char *at) { return at + strspn(at, " \t\r\n"); }

static const char *skip_string(const char *at)
{
    for (++at; *at != '"'; ++at)
        at += *at == '\\';
    return at + 1;
}

/* Past the value that starts at `at`. The text is known to be JSON. */
static const char *skip_value(const char *at)
{
    int depth = 0;
    do {
        at = skip_space(at);
        if (*at == '"') {
            at = skip_string(at);
        } else if (strchr("[]{}", *at)) {
            depth += *at == '[' || *at == '{' ? 1 : -1;
            ++at;
        } else {
            at += *at == ',' || *at == ':' ? 1 : strcspn(at, ",:[]{} \t\r\n\"");
        }
    } while (depth > 0);
    return at;
}

/* Whether the string at `at` is the key; one with escapes is compared after jansson has read it. */
static int is_key(const char *at, const char *key)
{
    json_t *string = json_loadb(at, (size_t)(skip_string(at) - at), JSON_DECODE_ANY, NULL);
    int same = string && strcmp(json_string_value(string), key) == 0;
    json_decref(string);
    return same;
}

static const char *find(const lc_place *place)
{
    if (!place->within)
        return skip_space(place->file->text);
    const char *at = skip_space(find(place->within) + 1);
    if (!place->key) {
        for (size_t i = 0; i < place->index; ++i)
            at = skip_space(skip_space(skip_value(at)) + 1);
        return at;
    }
    while (*at == '"') {
        const char *value = skip_space(skip_space(skip_string(at)) + 1);
        if (is_key(at, place->key))
            return value;
        at = skip_space(skip_value(value));
        at = *at == ',' ? skip_space(at + 1) : at;
    }
    return at;
}

int lc_place_line(const lc_place *place)
{
    while (!place->value && place->within)
        place = place->within;
    int line = 1;
    const char *end = find(place);
    for (const char *at = place->file->text; at < end; ++at)
        line += *at == '\n';
    return line;
}

lc_status lc_place_fail(lc_error *err, const lc_place *place, const char *format, ...)
{
    char message[800], index[32];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    snprintf(index, sizeof index, "number %zu", place->index + 1);
    return lc_fail(err, LC_BAD_INPUT, "%s:%d: %s%s%s", place->file->path, lc_place_line(place),
                   place->key      ? place->key
                   : place->within ? index
                                   : "",
                   place->within ? ": " : "", message);
}

/* ---- values -------------------------------------------------------------------------------------------------------- */

/* 1 when there is something to be read; else *status is LC_OK or the complaint. */
static int is_there(lc_status *status, const lc_place *place, int required, lc_error *err)
{
    *status = place->value || !required ? LC_OK : lc_place_fail(err, place, "is missing");
    return place->value != NULL;
}

lc_status lc_place_string(char *out, size_t size, const lc_place *place, int required, lc_error *err)
{
    lc_status status;
    if (!is_there(&status, place, required, err))
        return status;
    const char *text = json_string_value(place->value);
    if (!text)
        return lc_place_fail(err, place, "expected a text, \"...\"");
    if (required && !text[0])
        return lc_place_fail(err, place, "is empty");
    if (strlen(text) >= size)
        return lc_place_fail(err, place, "longer than %zu bytes", size - 1);
    for (const char *c = text; *c; ++c)
        if ((unsigned char)*c < 32 || *c == 127)
            return lc_place_fail(err, place, "has a control character");
    memcpy(out, text, strlen(text) + 1);
    return LC_OK;
}

lc_status lc_place_number(double *out, const lc_place *place, double least, double most, int required, lc_error *err)
{
    lc_status status;
    if (!is_there(&status, place, required, err))
        return status;
    double value = json_number_value(place->value);
    if (!json_is_number(place->value) || !(value >= least && value <= most))
        return lc_place_fail(err, place, "expected a number from %g to %g", least, most);
    *out = value;
    return LC_OK;
}

lc_status lc_place_int(int *out, const lc_place *place, int least, int most, int required, lc_error *err)
{
    lc_status status;
    if (!is_there(&status, place, required, err))
        return status;
    json_int_t value = json_integer_value(place->value);
    if (!json_is_integer(place->value) || value < least || value > most)
        return lc_place_fail(err, place, "expected a whole number from %d to %d", least, most);
    *out = (int)value;
    return LC_OK;
}

int lc_word_index(const char *word, const char *words)
{
    size_t length = strlen(word);
    for (int i = 0;; ++i) {
        size_t here = strcspn(words, "|");
        if (here == length && strncmp(word, words, length) == 0)
            return i;
        if (!words[here])
            return -1;
        words += here + 1;
    }
}

const char *lc_word_at(char *out, size_t size, int index, const char *words)
{
    for (; index > 0; --index)
        words = strchr(words, '|') + 1;
    snprintf(out, size, "%.*s", (int)strcspn(words, "|"), words);
    return out;
}

/* "a|b|c" as "a, b, c". */
static const char *spelt(char out[512], const char *words)
{
    size_t used = 0;
    for (; *words && used + 3 < 512; ++words) {
        out[used++] = *words == '|' ? ',' : *words;
        if (*words == '|')
            out[used++] = ' ';
    }
    out[used] = 0;
    return out;
}

lc_status lc_place_choice(int *out, const lc_place *place, const char *choices, int required, lc_error *err)
{
    lc_status status;
    char list[512];
    if (!is_there(&status, place, required, err))
        return status;
    const char *text = json_string_value(place->value);
    int index = text ? lc_word_index(text, choices) : -1;
    if (index < 0)
        return lc_place_fail(err, place, "unknown '%.60s'; supported: %s", text ? text : "(no text)", spelt(list, choices));
    *out = index;
    return LC_OK;
}

/* Days since 1970-01-01 of a date of the Gregorian calendar. */
static int64_t days_from_date(int year, int month, int day)
{
    static const int before[] = {0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334};
    int64_t y = year - (month <= 2); /* leap days up to the last February */
    return 365 * (int64_t)(year - 1970) + before[month - 1] + day - 1 + (y / 4 - y / 100 + y / 400) -
           (1969 / 4 - 1969 / 100 + 1969 / 400);
}

static int days_in_month(int year, int month)
{
    static const int days[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    int is_leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
    return days[month - 1] + (month == 2 && is_leap);
}

const char *lc_read_moment(int64_t *out, const char *text)
{
    int year, month, day, hour, minute, second, east_hour = 0, east_minute = 0, end = 0;
    char sign = 'Z';
    int read = sscanf(text, "%4d-%2d-%2dT%2d:%2d:%2d%n", &year, &month, &day, &hour, &minute, &second, &end), more = 0;
    if (read == 6 && strcmp(text + end, "Z") != 0) {
        read = sscanf(text + end, "%c%2d:%2d%n", &sign, &east_hour, &east_minute, &more) == 3 ? 6 : 0;
        end += more;
    } else {
        ++end;
    }
    if (read != 6 || (size_t)end != strlen(text) || !strchr("Z+-", sign) || year < 1970 || year > 9999 || month < 1 ||
        month > 12 || day < 1 || day > 31 || hour < 0 || hour > 23 || minute < 0 || minute > 59 || second < 0 ||
        second > 60 || east_hour < 0 || east_hour > 14 || east_minute < 0 || east_minute > 59)
        return "expected a moment with its zone, as 2026-12-01T23:59:00Z or 2026-12-01T23:59:00+01:00";
    if (day > days_in_month(year, month))
        return "its month has no such day";
    int east = (60 * east_hour + east_minute) * (sign == '-' ? -1 : 1);
    *out = days_from_date(year, month, day) * 86400 + 3600 * hour + 60 * (minute - east) + second;
    return NULL;
}

lc_status lc_place_time(int64_t *out, const lc_place *place, lc_error *err)
{
    char text[40] = "";
    lc_status status = lc_place_string(text, sizeof text, place, 0, err);
    const char *why = status == LC_OK && place->value ? lc_read_moment(out, text) : NULL;
    return why ? lc_place_fail(err, place, "%s", why) : status;
}

lc_status lc_place_array(size_t *count, const lc_place *place, size_t most, int required, lc_error *err)
{
    lc_status status;
    *count = 0;
    if (!is_there(&status, place, required, err))
        return status;
    if (!json_is_array(place->value))
        return lc_place_fail(err, place, "expected a list, [ ... ]");
    *count = json_array_size(place->value);
    if (*count > most || (required && *count == 0))
        return lc_place_fail(err, place, "has %zu elements, expected %d to %zu", *count, required ? 1 : 0, most);
    return LC_OK;
}

lc_status lc_place_object(const lc_place *place, const char *keys, lc_error *err)
{
    char list[512];
    const char *key;
    json_t *value;
    if (!json_is_object(place->value))
        return lc_place_fail(err, place, "expected an object, { ... }");
    json_object_foreach(place->value, key, value)
    {
        lc_place unknown = lc_place_key(place, key);
        if (lc_word_index(key, keys) < 0)
            return lc_place_fail(err, &unknown, "unknown key; supported: %s", spelt(list, keys));
    }
    return LC_OK;
}
