/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/report/safe.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

size_t lc_utf8_length(const unsigned char *c)
{
    size_t length = c[0] < 0x80 ? 1 : c[0] >= 0xc2 && c[0] < 0xe0 ? 2 : c[0] >= 0xe0 && c[0] < 0xf0 ? 3 : c[0] >= 0xf0 && c[0] < 0xf5 ? 4 : 0;
    for (size_t i = 1; i < length; ++i)
        if ((c[i] & 0xc0) != 0x80)
            return 0;
    if ((c[0] == 0xe0 && c[1] < 0xa0) || (c[0] == 0xed && c[1] >= 0xa0) || (c[0] == 0xf0 && c[1] < 0x90) ||
        (c[0] == 0xf4 && c[1] >= 0x90))
        return 0;
    return length;
}

json_t *lc_json_number(double value) { return isfinite(value) ? json_real(value) : json_null(); }

json_t *lc_json_text(const char *text)
{
    size_t size = strlen(text) + 1;
    char *copy = malloc(size);
    if (!copy)
        return NULL;
    memcpy(copy, text, size);
    for (unsigned char *c = (unsigned char *)copy; *c;) {
        size_t length = lc_utf8_length(c);
        if (!length)
            *c = '?';
        c += length ? length : 1;
    }
    json_t *out = json_string(copy);
    free(copy);
    return out;
}

void lc_xml_text(FILE *out, const char *text)
{
    for (const unsigned char *c = (const unsigned char *)text; *c;) {
        size_t length = lc_utf8_length(c);
        int not_xml = (length == 1 && (*c < 0x20 || *c == 0x7f)) || (length == 3 && c[0] == 0xef && c[1] == 0xbf && c[2] >= 0xbe);
        const char *name = *c == '&' ? "&amp;" : *c == '<' ? "&lt;" : *c == '>' ? "&gt;" : *c == '"' ? "&quot;" : NULL;
        if (name)
            fputs(name, out);
        else if (!length || not_xml)
            fputc(length ? ' ' : '?', out);
        else
            fwrite(c, 1, length, out);
        c += length ? length : 1;
    }
}

char *lc_shell_word(char *out, const char *text)
{
    char *at = out;
    size_t plain = strspn(text, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-");
    if (plain > 0 && !text[plain])
        return strcpy(out, text);
    *at++ = '\'';
    for (; *text; ++text) {
        if (*text == '\'')
            memcpy(at, "'\\''", 4), at += 4;
        else
            *at++ = *text;
    }
    *at++ = '\'';
    *at = 0;
    return out;
}

void lc_shell_add(char *line, size_t room, const char *before, const char *text)
{
    char word[LC_SHELL_WORD(LC_SHELL_LONGEST)], whole[LC_SHELL_LONGEST + 1];
    size_t length = strlen(line);
    snprintf(whole, sizeof whole, "%s", text);
    snprintf(line + length, room - length, "%s%s", before, lc_shell_word(word, whole));
}
