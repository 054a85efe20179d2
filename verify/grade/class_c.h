/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Private to verify/grade/class*: a hand-in of a class and what is known of it.
 */
#ifndef LC_CLASS_C_H
#define LC_CLASS_C_H

#include "verify/grade/class.h"

enum { LC_CLASS_LABEL = 224, LC_CLASS_PATH = 4096 };

/* A hand-in, or a student of the roster who has handed in nothing. */
typedef struct lc_class_row {
    char label[LC_CLASS_LABEL];
    const lc_handin *handin;   /* NULL: nothing was handed in */
    const lc_student *student; /* NULL: nobody of the roster, or no roster */
    char id[LC_CLASS_LABEL];   /* in the gradebook */
    time_t submitted;
    uint64_t digest;           /* of what its result depends on */
    int is_graded;             /* 1: there is a complete result, and no fault of ours; then, and with `is_fault`, */
    int is_fault, is_ungradable;
    char code[8];
    double points, most_points, penalty, score, seconds;
    /* The most similar solution and classmate; "" where none is, or there is nothing to compare with. */
    char solution[64], classmate[LC_CLASS_LABEL];
    double solution_share, classmate_share;
} lc_class_row;

typedef struct lc_class {
    const lc_class_options *options;
    uint64_t seed, assignment_digest;
    lc_class_row *rows;
    int count;
    int pending, done; /* of this run */
} lc_class;

/* class_rows.c. A row for each hand-in and for each student without one. LC_BAD_INPUT: somebody has two. */
lc_status lc_class_make_rows(lc_class *c, lc_error *err);

/* FOLDER/kind/LABEL.suffix, or FOLDER/kind where the label is NULL; LC_BAD_INPUT where that is too long. */
lc_status lc_class_path(char path[LC_CLASS_PATH], const lc_class *c, const char *kind, const char *label,
                        const char *suffix, lc_error *err);

/* Fills the row from its result; leaves it ungraded where there is none, or one that is damaged, of another seed, or not complete. */
lc_status lc_class_read_row(lc_class_row *row, const lc_class *c, lc_error *err);
/* class.json. `read` finds none: *found = 0. It forgets results whose file has changed. */
lc_status lc_class_write_index(const lc_class *c, lc_error *err);
lc_status lc_class_read_index(int *found, lc_class *c, lc_error *err);

/* Finds what is most similar to each. */
lc_status lc_class_compare(lc_class *c, lc_error *err);
/* gradebook.csv, class.csv, class.txt. */
lc_status lc_class_write_tables(const lc_class *c, lc_error *err);
/* A line of class.txt, without newline. */
void lc_class_line(char *text, size_t size, const lc_class_row *row);

#endif
