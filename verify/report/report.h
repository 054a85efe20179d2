/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * report.h: the one result model. The judge fills rows; each format is a function of the rows.
 */
#ifndef LC_REPORT_H
#define LC_REPORT_H

#include <stdio.h>

#include "core/host.h"

enum { LC_MOST_PATH = 1024, LC_MOST_COMMAND = 20 * 1024 }; /* the latter: a path of 4096 bytes in quotes, and options */

typedef enum lc_row_verdict { LC_ROW_PASS, LC_ROW_FAIL, LC_ROW_UNDECIDED } lc_row_verdict;

/* One claim, decided. Relative numbers are in units of the expected mean of reflected light. */
typedef struct lc_row {
    char check[32], scene[64], estimator[64];
    int min_bounces, max_bounces; /* the terms L_k that were summed */
    lc_row_verdict verdict;
    int exact;        /* a deterministic claim: no statistics; ratio and interval mean nothing */
    int channel;      /* 0 1 2: the one that was hardest; the numbers below are its */
    int dependent;    /* 1: FAIL, because its samples depend on each other: no interval can be believed */
    double ratio;     /* mean / expected mean */
    double low, high; /* the interval of the ratio at the error the row was given; may be infinite */
    double margin;    /* relative; the ratio was to be shown within 1 +- margin */
    double expected;  /* mean radiance [W sr^-1 m^-2] */
    char source[160]; /* of what was expected */
    uint64_t samples; /* a pixel */
    uint64_t paths;   /* in all, of the estimator under test */
    int tile_x, tile_y, tile_width, tile_height; /* the worst tile, width 0: none */
    double tile_ratio;                           /* there: mean / expected mean of the tile; NaN where that is 0 */
    double tile_log10_p;                         /* of it, corrected for all tiles and levels */
    double
        missed; /* PASS: the largest contribution that could have been missed, in units of the mean of a sample; else 0, as in rows about
                   the host, and about black, of which no contribution has a size */
    char reason[512];    /* in words, for FAIL and UNDECIDED */
    char reproduce[LC_MOST_COMMAND]; /* a command line, each word quoted for a shell */
    char pictures[LC_MOST_PATH]; /* FAIL: how the names of its pictures begin, with their folder (pictures.h); empty: none */
} lc_row;

/* What there is no row about, and why. */
typedef struct lc_note {
    char check[32], scene[64], reason[256];
    int is_fault; /* there should be one: the renderer under test crashed, hung or wrote no image */
} lc_note;

/* What the wrong estimator behaves like, in words. */
typedef struct lc_behaviour {
    char estimator[64], of[64]; /* and what it should have been */
    int is_certain;             /* it was shown different from everything but `names` */
    int name_count, line_count;
    char names[8][64], summaries[8][160];
    char lines[8][240]; /* what was measured */
} lc_behaviour;

typedef struct lc_report {
    lc_row *rows;
    int count;
    uint64_t seed;
    char suite[16];
    double false_fail, false_pass; /* of the whole run */
    char budget[1024];             /* how they were split, in words */
    lc_note *notes;
    int note_count;
    int not_applicable;            /* pairs of estimator and scene that no check applies to */
    uint64_t paths;                /* rendered in all */
    lc_behaviour *behaviour;       /* NULL: nobody asked. Released with the report */
} lc_report;

/* Appends a zeroed row, or NULL without memory. */
lc_row *lc_report_add(lc_report *report);
void lc_report_release(lc_report *report);
/* Appends a note, unless the same is there; LC_FAULT without memory. */
lc_status lc_report_note(lc_report *report, const char *check, const char *scene, int is_fault, const char *reason, lc_error *err);
int lc_report_faults(const lc_report *report); /* how many notes are faults */

const char *lc_row_verdict_name(lc_row_verdict verdict); /* "PASS" ... */
/* The exit status: WRONG if any row failed, else FAULT if one is missing by a fault, else UNDECIDED if any is, else OK. No rows at all
 * is BAD_INPUT. */
lc_status lc_report_status(const lc_report *report);

/* Each writes the whole report to `out`; errors stay in the stream. */
void lc_report_text(FILE *out, const lc_report *report);
lc_status lc_report_json(FILE *out, const lc_report *report, lc_error *err);
void lc_report_junit(FILE *out, const lc_report *report);

/* One row as a line of the text table (no newline), for progress as well. */
void lc_report_text_header(FILE *out);
void lc_report_text_row(FILE *out, const lc_row *row);

#endif
