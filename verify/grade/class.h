/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * class.h: the hand-ins of a class. Each is graded by a process of its own, and what is known of it stands in the folder at once:
 *
 *     FOLDER/class.json              what is graded: assignment, seed, a number that tells each file's content
 *     FOLDER/results/LABEL.json      one result (formats.h), also while it is being graded
 *     FOLDER/feedback/LABEL.txt      for the student
 *     FOLDER/logs/LABEL.txt          what our own process had to say, if anything
 *     FOLDER/gradebook.csv           as nbgrader writes it
 *     FOLDER/class.csv, class.txt    a line a hand-in: code, score, similarity
 *
 * LABEL is the hand-in's name, or with a roster its student's pseudonym. So a run that was killed is resumed by grading what has no complete
 * result, and shards of one class, from several machines, are merged by copying results/ and feedback/ together and resuming.
 */
#ifndef LC_CLASS_H
#define LC_CLASS_H

#include "verify/grade/grade.h"
#include "verify/grade/handins.h"
#include "verify/grade/roster.h"

typedef struct lc_class_options {
    const lc_assignment *assignment;
    const lc_handins *handins;
    const lc_roster *roster; /* NULL: none */
    const char *folder;      /* made if need be */
    const char *solutions;   /* folder of published solutions, for similarity; NULL: none */
    lc_grade_options grade;  /* of each hand-in; `on_test`, `student`, `submitted` and `report_below` are ours */
    int at_once;             /* processes */
    int resume;              /* 1: goes on in a folder that has results; the seed is that one's */
    int shard, shards;       /* only hand-ins shard, shard + shards, ... by name; shards 1: all */
    double seconds;          /* of the clock for one hand-in, after which it is a fault of ours (IE) */
    /* Called after each, with the line of class.txt; may be NULL. */
    void (*on_handin)(void *user, const char *line, int done, int count);
    void *user;
} lc_class_options;

typedef struct lc_class_counts {
    int left;       /* hand-ins of other shards, without a result */
    int faults;     /* of ours: the next run with `resume` grades them again */
    int ungradable; /* no score, for a person to decide */
    int nobodys;    /* hand-ins of nobody in the roster */
    int missing;    /* students of the roster without a hand-in: 0 */
} lc_class_counts;

/* Grades what is not graded yet, then writes the tables (unless other shards' results are not there). LC_OK: each hand-in has a result, or its
 * shard has not run. LC_BAD_INPUT: the folder has results and `resume` is not set, or they are of another assignment, of other tests of
 * it, or of another seed; or somebody has handed in twice. `counts` may be NULL. */
lc_status lc_class_grade(const lc_class_options *options, lc_class_counts *counts, lc_error *err);

/* The seed of the class that is in the folder; untouched where none is. */
void lc_class_read_seed(uint64_t *seed, const char *folder);

#endif
