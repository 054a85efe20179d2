/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * plain.h: texts that somebody else wrote, for a terminal or a text file. What a student's file is called, prints, or has the compiler
 * say must not clear the screen, turn the line around, or look like a line of ours.
 */
#ifndef LC_PLAIN_H
#define LC_PLAIN_H

#include <stdio.h>

/* On one line: control characters (newline and tab, too), what changes the direction of writing, and bytes that are no UTF-8 are written
 * as \x1b or \u202e. */
void lc_plain(FILE *out, const char *text);
/* The same into memory, cut before what does not fit. Returns `out`. */
char *lc_plain_copy(char *out, size_t size, const char *text);
/* Lines stay lines, and tabs tabs; each line begins with `prefix`, and the last one ends. Of an empty text nothing. */
void lc_plain_lines(FILE *out, const char *text, const char *prefix);

#endif
