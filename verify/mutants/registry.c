/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Every family of mutants. A new family is one line here; a new mutant is one in its family's file, and one in test_mutants.c.
 */
#include <stddef.h>
#include <string.h>

#include "registry.h"

#define FAMILIES(X) \
    X(light) \
    X(three_point) \
    X(hemisphere) \
    X(path) \
    X(mirror) \
    X(dielectric) \
    X(nee) \
    X(absolute) \
    X(effects)

#define DECLARE(name) extern const lc_mutant lc_##name##_mutants[];
#define MEMBER(name) {#name, lc_##name##_mutants},

FAMILIES(DECLARE)

const lc_mutant_family lc_mutant_families[] = {FAMILIES(MEMBER){NULL, NULL}};

const lc_mutant_category lc_mutant_categories[] = {
    {"cosine", "a cosine"},
    {"density", "how likely a direction or a point was"},
    {"directions", "how directions are chosen"},
    {"brdf", "the BRDF"},
    {"lights", "how many lights there are, and which was chosen"},
    {"distance", "distances"},
    {"visibility", "what stands in the way"},
    {"sides", "front and back of a surface or a light"},
    {"emission", "where emitted light counts"},
    {"bounces", "how many bounces are counted"},
    {"roulette", "where paths end by chance"},
    {"weights", "how two techniques share the work"},
    {"mirror", "mirrors"},
    {"glass", "glass"},
    {"numbers", "random numbers"},
    {"thresholds", "a constant that depends on the scene's size or brightness"},
    {"time", "the moment at which a ray travels"},
    {"scale", "the brightness as a whole"},
    {NULL, NULL},
};

const lc_mutant *lc_mutant_at(int i)
{
    for (const lc_mutant_family *f = lc_mutant_families; f->name; ++f)
        for (const lc_mutant *m = f->mutants; m->estimator; ++m)
            if (i-- == 0)
                return m;
    return NULL;
}

const lc_mutant *lc_mutant_find(const char *name)
{
    const lc_mutant *m = NULL;
    for (int i = 0; (m = lc_mutant_at(i)) != NULL; ++i)
        if (strcmp(m->estimator->name, name) == 0)
            return m;
    return NULL;
}
