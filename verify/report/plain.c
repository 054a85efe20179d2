/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/report/plain.h"

#include <string.h>

#include "verify/report/safe.h"

enum { MOST = 8 }; /* "\u202e" and its 0 */

/* Embeddings, overrides and isolates of bidirectional text, and separators of lines: they change how what follows is read. Plain marks of
 * direction, which a course's own sentences may need, do not. */
static int turns_text(unsigned point)
{
    return (point >= 0x2028 && point <= 0x202e) || (point >= 0x2066 && point <= 0x2069);
}

/* What stands for the character at `c`, ended by 0; returns its bytes. */
static size_t escape(char out[MOST], const unsigned char *c)
{
    size_t length = lc_utf8_length(c);
    unsigned point = length == 3 ? (c[0] & 15U) << 12 | (c[1] & 63U) << 6 | (c[2] & 63U) : 0;
    int is_c1 = length == 2 && c[0] == 0xc2 && c[1] < 0xa0; /* U+0080 to U+009F: one of them begins sequences as ESC [ does */
    if (length == 0 || (length == 1 && (*c < 0x20 || *c == 0x7f))) {
        snprintf(out, MOST, "\\x%02x", *c);
        return 1;
    }
    if (is_c1 || turns_text(point)) {
        snprintf(out, MOST, "\\u%04x", is_c1 ? c[1] : point);
        return length;
    }
    memcpy(out, c, length);
    out[length] = 0;
    return length;
}

void lc_plain(FILE *out, const char *text)
{
    char piece[MOST];
    for (const unsigned char *c = (const unsigned char *)text; *c;) {
        c += escape(piece, c);
        fputs(piece, out);
    }
}

char *lc_plain_copy(char *out, size_t size, const char *text)
{
    char piece[MOST];
    size_t used = 0;
    for (const unsigned char *c = (const unsigned char *)text; *c;) {
        c += escape(piece, c);
        if (used + strlen(piece) >= size)
            break;
        memcpy(out + used, piece, strlen(piece));
        used += strlen(piece);
    }
    out[used] = 0;
    return out;
}

void lc_plain_lines(FILE *out, const char *text, const char *prefix)
{
    char piece[MOST];
    int is_start = 1;
    for (const unsigned char *c = (const unsigned char *)text; *c;) {
        int is_end = *c == '\n' || (*c == '\r' && c[1] == '\n'); /* a file from Windows is quoted with its CR */
        if (is_start)
            fputs(prefix, out);
        is_start = is_end;
        if (is_end || *c == '\t') {
            fputc(is_end ? '\n' : '\t', out);
            c += is_end && *c == '\r' ? 2 : 1;
        } else {
            c += escape(piece, c);
            fputs(piece, out);
        }
    }
    if (!is_start)
        fputc('\n', out);
}
