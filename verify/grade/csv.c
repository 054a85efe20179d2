/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/grade/csv.h"

#include <string.h>

/* The text of a quoted field, from behind its first quote; `at` is then behind its last. 0 when it has none. */
static int read_quoted(lc_csv *csv)
{
    char *from = csv->at, *to = from;
    for (; *from; ++from) {
        if (*from == '"' && from[1] != '"') {
            csv->at = from + 1;
            *to = 0;
            return 1;
        }
        csv->line += *from == '\n';
        from += *from == '"';
        *to++ = *from;
    }
    return 0;
}

lc_status lc_csv_record(char **fields, int most, int *count, lc_csv *csv, lc_error *err)
{
    *count = 0;
    for (; *csv->at == '\r' || *csv->at == '\n'; ++csv->at)
        csv->line += *csv->at == '\n';
    csv->first = csv->line;
    if (!*csv->at)
        return LC_OK;
    for (char end = ','; end == ',';) {
        if (*count == most)
            return lc_fail(err, LC_BAD_INPUT, "more than %d fields", most);
        int quoted = *csv->at == '"';
        fields[(*count)++] = csv->at += quoted;
        if (quoted && !read_quoted(csv))
            return lc_fail(err, LC_BAD_INPUT, "a quote that is not closed");
        if (!quoted)
            csv->at += strcspn(csv->at, ",\r\n\"");
        end = *csv->at;
        if (end && !strchr(",\r\n", end))
            return lc_fail(err, LC_BAD_INPUT, "a quote within a field; write \"a \"\"b\"\"\"");
        *csv->at = 0;
        csv->at += end != 0;
        csv->line += end == '\n'; /* a CR's LF is passed over with the next record */
    }
    return LC_OK;
}

void lc_csv_field(FILE *out, const char *text)
{
    int formula = text[0] && strchr("=+-@\t\r", text[0]);
    if (!formula && !strpbrk(text, ",\"\r\n")) {
        fputs(text, out);
        return;
    }
    fputs(formula ? "\"'" : "\"", out);
    for (; *text; ++text) {
        if (*text == '"')
            fputc('"', out);
        fputc(*text, out);
    }
    fputc('"', out);
}
