/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * compile.h: one file of C (or of C++: .cc, .cpp, .cxx) becomes a shared object whose symbol lc_plugin is an estimator.
 *
 * The compiler is the program `cc` (`c++`) on PATH. It works in a temporary folder, with the program's own copy of
 * lightcheck.h on its include path. A helper process owns that folder and removes it, also when the caller dies.
 */
#ifndef LC_COMPILE_H
#define LC_COMPILE_H

#include "core/host.h"
#include "verify/grade/confine.h"

typedef struct lc_compile_options {
    int debug;                       /* 1: without optimisation, for a debugger */
    const lc_confinement *confined;  /* what the compiler of a file that nobody vouches for may do; NULL: all that the caller may */
} lc_compile_options;

typedef struct lc_compiled {
    int image;           /* descriptor of a sealed file in memory, closed on exec; -1 where there is none. The caller's to close */
    char symbols[8192];  /* of a confined file: what it takes from elsewhere, one name a line */
    char messages[8192]; /* what the compiler said, cut at that length; "" when it was content */
} lc_compiled;

/* A confined compiler sees a copy of the file, which must be a regular one and no link, and besides that only what the system's
 * programs and libraries consist of: no other hand-in, no secret.
 * LC_OK: `image` holds the object. LC_BAD_INPUT: the file cannot be read or does not compile; `err` has the first
 * error, `messages` all. LC_FAULT: no compiler, no folder, or the like. `options` may be NULL. */
lc_status lc_compile(lc_compiled *out, const char *path, const lc_compile_options *options, lc_error *err);

/* 1 for a name that ends as source code does: .c is C; .C, and .cc .cpp .cxx in any case, are C++. */
int lc_is_source(const char *path);

#endif
