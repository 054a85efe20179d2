/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * hash_file.h: tells a file that was edited from the one that was there, not a forged one.
 */
#ifndef LC_HASH_FILE_H
#define LC_HASH_FILE_H

#include "core/host.h"

/* lc_hash() goes on over the bytes of a file; 0 when it cannot be read. */
uint64_t lc_hash_file(uint64_t hash, const char *path);

#endif
