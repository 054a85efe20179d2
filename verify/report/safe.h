/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * safe.h: numbers and texts of any origin as JSON and XML. jansson returns NULL for NaN, for infinities and for what is not
 * UTF-8, and drops a key whose value is NULL without a word; a compiler's messages quote a student's file byte by byte.
 */
#ifndef LC_SAFE_H
#define LC_SAFE_H

#include <jansson.h>
#include <stdio.h>

/* Bytes of the UTF-8 character at `c`, 0 where it is none: cut off, overlong, a surrogate, beyond U+10FFFF (RFC 3629). */
size_t lc_utf8_length(const unsigned char *c);

/* null for NaN and infinities. */
json_t *lc_json_number(double value);
/* Bytes that are no UTF-8 become '?'. NULL only without memory. */
json_t *lc_json_text(const char *text);
/* For an attribute in double quotes, or between tags; what XML 1.0 cannot hold becomes a space, what is no UTF-8 '?'. */
void lc_xml_text(FILE *out, const char *text);

/* Bytes that lc_shell_word() may need for a text of this length, the 0 included. */
#define LC_SHELL_WORD(length) (4 * (length) + 3)
/* A text as one word of a POSIX shell: in quotes unless it needs none. Returns `out`, of LC_SHELL_WORD(strlen(text)) bytes. */
char *lc_shell_word(char *out, const char *text);
/* Appends `before` and a word to a command line of `room` bytes, as far as there is room; of a text of LC_SHELL_LONGEST bytes at most, which
 * is longer than any path that can be opened. */
enum { LC_SHELL_LONGEST = 4096 };
void lc_shell_add(char *line, size_t room, const char *before, const char *text);

#endif
