/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * symbols.h: what an estimator may take from elsewhere. A courtesy, not a wall: it tells an honest author in time what the worker would
 * refuse; who wants to hide a call can.
 */
#ifndef LC_SYMBOLS_H
#define LC_SYMBOLS_H

#include "core/host.h"

/* LC_BAD_INPUT for the first name (one a line) that is neither lightcheck.h's, nor of math.h, string.h or ctype.h, nor a
 * harmless one of stdlib.h and stdio.h, nor the compiler's own. */
lc_status lc_symbols_check(const char *symbols, const char *path, lc_error *err);

#endif
