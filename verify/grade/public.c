/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/grade/public.h"

#include <jansson.h>
#include <string.h>

static int is_visible(const json_t *test)
{
    const char *visibility = json_string_value(json_object_get(test, "visibility"));
    return !visibility || strcmp(visibility, "visible") == 0;
}

static int has_name(const json_t *tests, const char *name)
{
    for (size_t i = 0; i < json_array_size(tests); ++i) {
        const char *other = json_string_value(json_object_get(json_array_get(tests, i), "name"));
        if (name && other && strcmp(name, other) == 0)
            return 1;
    }
    return 0;
}

lc_status lc_assignment_write_public(FILE *out, const char *path, lc_error *err)
{
    json_error_t why;
    json_t *o = json_load_file(path, JSON_REJECT_DUPLICATES, &why), *tests = json_object_get(o, "tests");
    if (!json_is_object(o) || !json_is_array(tests)) {
        json_decref(o);
        return o ? lc_fail(err, LC_BAD_INPUT, "%s:1: expected an object with an array `tests`", path)
                 : lc_fail(err, LC_BAD_INPUT, "%s:%d: %s", path, why.line, why.text);
    }
    json_object_del(o, "solutions");
    json_object_del(o, "mutants_of");
    json_object_del(o, "beyond");
    for (size_t i = json_array_size(tests); i-- > 0;)
        if (!is_visible(json_array_get(tests, i)))
            json_array_remove(tests, i);
    for (size_t i = 0; i < json_array_size(tests); ++i) {
        json_t *required = json_object_get(json_array_get(tests, i), "requires");
        for (size_t k = json_array_size(required); k-- > 0;)
            if (!has_name(tests, json_string_value(json_array_get(required, k))))
                json_array_remove(required, k);
    }
    json_dumpf(o, out, JSON_INDENT(2) | JSON_REAL_PRECISION(12));
    fputc('\n', out);
    json_decref(o);
    return LC_OK;
}
