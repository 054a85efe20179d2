/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/grade/metadata.h"

#include <stdio.h>
#include <string.h>

#include "verify/grade/place.h"

/* Whether an earlier hand-in was graded: our own result is in there (formats_course.c). */
static int was_graded(const json_t *previous)
{
    const json_t *extra = json_object_get(json_object_get(previous, "results"), "extra_data");
    const char *code = json_string_value(json_object_get(extra, "code"));
    if (json_is_true(json_object_get(previous, "autograder_error")))
        return 0;
    return !code || (strcmp(code, "CE") != 0 && strcmp(code, "IE") != 0);
}

/* "2018-07-01T14:22:32.365935-07:00", without the fraction. */
static void copy_moment(char out[64], const char *text)
{
    size_t whole = strcspn(text, "."), fraction = text[whole] ? 1 + strspn(text + whole + 1, "0123456789") : 0;
    snprintf(out, 64, "%.*s%s", (int)(whole < 32 ? whole : 32), text, text + whole + fraction);
}

lc_status lc_metadata_read(int64_t *submitted, int *attempt, char id[32], const char *path, lc_error *err)
{
    static char stand_in[] = "{\"created_at\": 0}"; /* the file may be large: each complaint is about its first line */
    char moment[64];
    json_error_t why;
    json_t *o = json_load_file(path, 0, &why);
    if (!o)
        return lc_fail(err, LC_BAD_INPUT, "%s:%d: %s", path, why.line < 1 ? 1 : why.line, why.text);
    const char *created = json_string_value(json_object_get(o, "created_at"));
    json_t *previous = json_object_get(o, "previous_submissions");
    copy_moment(moment, created ? created : "");
    json_t *value = json_string(moment);
    lc_json_file file = {.text = stand_in, .root = o};
    snprintf(file.path, sizeof file.path, "%s", path);
    lc_place root = lc_place_root(&file), place = lc_place_key(&root, "created_at");
    place.value = value;
    lc_status status = lc_place_time(submitted, &place, err);
    *attempt = 1;
    for (size_t i = 0; i < json_array_size(previous); ++i)
        *attempt += was_graded(json_array_get(previous, i));
    const json_t *number = json_object_get(o, "id");
    id[0] = 0;
    if (json_is_integer(number))
        snprintf(id, 32, "%lld", (long long)json_integer_value(number));
    json_decref(value);
    json_decref(o);
    return status;
}
