/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/hash_file.h"

#include <stdio.h>

uint64_t lc_hash_file(uint64_t hash, const char *path)
{
    unsigned char buffer[1 << 14];
    FILE *file = fopen(path, "rb");
    if (!file)
        return 0;
    for (size_t n = fread(buffer, 1, sizeof buffer, file); n > 0; n = fread(buffer, 1, sizeof buffer, file))
        hash = lc_hash(hash, buffer, n);
    int is_broken = ferror(file);
    fclose(file);
    return is_broken ? 0 : hash;
}
