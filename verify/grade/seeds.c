/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/grade/seeds.h"

#include <Random123/threefry.h>

#include "core/host.h"

uint64_t lc_seed_for(uint64_t secret, const char *purpose)
{
    threefry2x64_key_t key = {{secret, 0x6c69676874636865u}}; /* "lightche" */
    threefry2x64_ctr_t out = {{0, 0}};
    for (const char *c = purpose; *c; ++c) {
        out.v[1] ^= (unsigned char)*c;
        out = threefry2x64(out, key);
    }
    return out.v[0];
}

uint64_t lc_seed_of(uint64_t seed, int is_secret, lc_visibility visibility)
{
    return is_secret ? lc_seed_for(seed, lc_visibility_name(visibility)) : seed;
}

/* Another for each test, so that two of them never draw the same scene or the same numbers (SplitMix64's mixing, Steele, Lea, Flood: Fast
 * splittable pseudorandom number generators, OOPSLA 2014). */
uint64_t lc_test_seed(uint64_t seed, const char *test)
{
    uint64_t z = seed + 0x9e3779b97f4a7c15u * (1 + (uint64_t)lc_arm(test));
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}
