/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * sentences.h: every sentence that a grading says, in one table, with words in braces that are replaced. A course translates it:
 * `lightcheck assignment sentences > mine.json`, and "sentences": "mine.json" in the assignment.
 */
#ifndef LC_SENTENCES_H
#define LC_SENTENCES_H

#include <stdio.h>

#include "core/host.h"

typedef struct lc_sentence {
    const char *id;
    const char *text; /* "{word}" is replaced */
} lc_sentence;

/* A word and what it stands for. */
typedef struct lc_word {
    const char *name;
    char text[192];
} lc_word;

enum { LC_MOST_WORDS = 24 };
typedef struct lc_words {
    lc_word items[LC_MOST_WORDS];
    int count;
} lc_words;

/* Sets a word, anew if it is there. */
void lc_words_set(lc_words *words, const char *name, const char *format, ...)
#ifdef __GNUC__
    __attribute__((format(printf, 3, 4)))
#endif
    ;

typedef struct lc_sentences lc_sentences; /* a table: the program's own, some of it replaced */

/* The program's own table where `path` is NULL, else with the sentences of that JSON file, an object of ids and texts, in their place.
 * LC_BAD_INPUT, with file:line, for an id that there is not, and for a word in braces that this sentence does not know. */
lc_status lc_sentences_open(lc_sentences **out, const char *path, lc_error *err);
void lc_sentences_close(lc_sentences *sentences); /* NULL is fine */
/* The text of an id, "" if there is none. */
const char *lc_sentence_text(const lc_sentences *sentences, const char *id);
/* Writes the sentence with its words; one that is not set stays as it is. Returns `out`. */
const char *lc_say(char *out, size_t size, const lc_sentences *sentences, const char *id, const lc_words *words);
/* The program's own table as JSON. */
void lc_sentences_print(FILE *out);

#endif
