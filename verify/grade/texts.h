/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Files that the program carries in itself, so that it needs no source tree where it runs, and an estimator is always
 * compiled with the header of the very program that loads it. The Makefile makes them; each ends with a 0.
 */
#ifndef LC_TEXTS_H
#define LC_TEXTS_H

extern const unsigned char lc_text_lightcheck_h[]; /* src/core/lightcheck.h */
extern const unsigned char lc_text_template_c[];   /* estimators/template.c */

#endif
