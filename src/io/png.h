/* SPDX-License-Identifier: GPL-3.0-or-later */
/* png.h: pictures for people; nothing is computed from them. 8 bits a channel, sRGB. */
#ifndef LC_PNG_H
#define LC_PNG_H

#include "core/host.h"

/* Writes linear colours, row by row from the top, times 2^exposure [stops], by the sRGB transfer function of
 * IEC 61966-2-1; clamped to [0, 1], a pixel with a NaN is magenta. Width and height in [1, LC_MAX_SIZE], else
 * LC_BAD_INPUT; LC_FAULT on I/O. */
lc_status lc_png_write(const char *path, int width, int height, const double (*rgb)[3], double exposure, lc_error *err);

/* The same of a film's means. */
lc_status lc_png_write_film(const char *path, const lc_film *film, double exposure, lc_error *err);

/* Writes one signed number a pixel: blue at -scale and below, white at 0, red at scale and above, magenta for NaN;
 * linear in the 8-bit codes between. LC_BAD_INPUT unless 0 < scale < infinity. */
lc_status lc_png_write_signed(const char *path, int width, int height, const double *values, double scale,
                              lc_error *err);

#endif
