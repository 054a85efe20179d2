/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/host.h"

uint64_t lc_hash(uint64_t hash, const void *bytes, size_t size)
{
    for (const unsigned char *b = bytes; size-- > 0; ++b)
        hash = (hash ^ *b) * 0x100000001b3u;
    return hash;
}
