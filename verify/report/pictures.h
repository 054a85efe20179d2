/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * pictures.h: what a FAIL looks like. Where the colour is, the estimator is wrong: red gives too much light, blue too little.
 */
#ifndef LC_REPORT_PICTURES_H
#define LC_REPORT_PICTURES_H

#include "verify/report/report.h"

/* The images that a verdict rests on; all belong to somebody else. */
typedef struct lc_exhibit {
    const lc_film *is;         /* of the estimator under test */
    const lc_film *other;      /* what it is held against: this film, or */
    const double *expected;    /* these values, R G B a pixel, or */
    const lc_film *difference; /* that from which this differs, sample by sample */
    const unsigned char *skip; /* 1: a pixel that was left out, and differs by 0 in the pictures; may be NULL */
} lc_exhibit;

/* The files of a row: lc_row.pictures, then one of these. Ends with NULL. */
typedef struct lc_picture_kind {
    const char *name, *ending;
} lc_picture_kind;
extern const lc_picture_kind lc_picture_kinds[];

enum { LC_PICTURES = 6 }; /* of an exhibit: is, expected and difference as EXR, then as PNG */

/* Writes those of the pictures whose path is not NULL, each whole or not at all; the difference is that of `channel` in the PNG. LC_FAULT on I/O
 * or without memory. */
lc_status lc_pictures_write(const char *const paths[LC_PICTURES], const lc_exhibit *evidence, int channel, lc_error *err);

/* Writes the pictures of a row into `folder`, which is there, as NUMBER_CHECK_SCENE_ESTIMATOR_K..., and says so in row->pictures:
 *     .is.exr .expected.exr .difference.exr   linear, with the variance of each pixel's mean
 *     .is.png .expected.png                   to look at, equally exposed
 *     .difference.png                         is - expected in the row's channel: red too much, blue too little, white equal; full
 *                                             colour where it is three times a pixel's noise, or as large as in the 1% that
 *                                             differ most. Small images are enlarged, each pixel to a square.
 * Each file is whole or absent. LC_FAULT on I/O or without memory; row->pictures is then empty. */
lc_status lc_report_pictures(lc_row *row, const char *folder, int number, const lc_exhibit *evidence, lc_error *err);

#endif
