/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Counter-based random numbers: the k-th number of a sample is a pure function of (seed, arm, pixel, sample, k), so that nothing depends
 * on the order in which samples are made.
 */
#include <Random123/philox.h>
#include <stdio.h>

#include "core/scene_c.h"

static void load_block(lc_sampler *sampler, uint32_t index)
{
    philox4x32_ctr_t counter = {{index, sampler->pixel, sampler->sample, sampler->arm}};
    philox4x32_key_t key = {{(uint32_t)sampler->seed, (uint32_t)(sampler->seed >> 32)}};
    philox4x32_ctr_t out = philox4x32(counter, key);
    for (int i = 0; i < 4; ++i)
        sampler->block[i] = out.v[i];
    sampler->loaded = index;
}

void lc_sampler_start(lc_sampler *sampler, uint64_t seed, uint32_t arm, uint32_t pixel, uint32_t sample)
{
    sampler->seed = seed;
    sampler->arm = arm;
    sampler->pixel = pixel;
    sampler->sample = sample;
    sampler->dimension = 0;
    sampler->loaded = UINT32_MAX;
    sampler->log = NULL;
}

/* The block is made here and not when it is asked for: of several samplers, their rounds overlap in the CPU. */
void lc_sampler_seek(lc_sampler *sampler, uint32_t dimension)
{
    sampler->dimension = dimension;
    load_block(sampler, dimension >> 2);
}

double lc_next(lc_sampler *sampler)
{
    uint32_t index = sampler->dimension >> 2, lane = sampler->dimension & 3;
    if (index != sampler->loaded)
        load_block(sampler, index);
    double u = sampler->block[lane] * 0x1p-32;
    if (sampler->log)
        lc_log(sampler->log, "draw %u: %.9g", (unsigned)sampler->dimension, u);
    ++sampler->dimension;
    return u;
}

/* FNV-1a, 32 bits (Fowler, Noll, Vo). */
uint32_t lc_arm(const char *name)
{
    uint32_t hash = 2166136261u;
    for (const unsigned char *c = (const unsigned char *)name; *c; ++c)
        hash = (hash ^ *c) * 16777619u;
    return hash;
}
