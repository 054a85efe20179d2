/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * plugin.h: estimators from a file, in the open: the file runs in this process, with all its rights. For one's own code;
 * for anybody else's see jail.h.
 */
#ifndef LC_PLUGIN_H
#define LC_PLUGIN_H

#include "verify/grade/compile.h"

/* 1 for what names a file rather than an estimator: it ends as source code or as a shared object (.so) does. */
int lc_is_plugin(const char *name);

/* Compiles the file, unless it is a shared object already, and loads it. The estimator lives as long as the process.
 * LC_BAD_INPUT: it does not compile, is no plug-in, was written for another interface, or its descriptor is not in
 * order. `messages` (`size` bytes, may be NULL) is what the compiler said, warnings included. One thread. */
lc_status lc_plugin_load(const lc_estimator **out, const char *path, char *messages, size_t size, lc_error *err);

/* What every descriptor must have: interface, name, texts, a function, sensible masks. `path` is for the message. */
lc_status lc_descriptor_check(const lc_estimator *estimator, const char *path, lc_error *err);

#endif
