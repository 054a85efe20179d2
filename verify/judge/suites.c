/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The suites as a table: scenes, and the noise of each estimator there (measured by `lightcheck verify --measure`).
 */
#include <math.h>
#include <string.h>

#include "verify/judge/judge.h"

const lc_suite lc_suites[] = {
    {"quick", 0.005, 6e8},
    {"full", 0.0025, 3.3e9},
    {NULL, 0, 0},
};

const char *const lc_suite_scenes[] = {
    "plane_point",    "plane_directional", "plane_rectangle", "plane_tilted",  "plane_disk", "plane_sphere",
    "plane_cube",     "lamp_100w",         "two_lights",      "five_lights",   "occluder",   "cornell",
    "cornell_small",  "cornell_large",     "light_behind",    "no_lights",     "sky",        "flipped_twosided",
    "furnace_sphere", "furnace_checker",   "mixed_lights",    "textured_lamp", NULL,
};

const lc_cell lc_cells[] = {
    {NULL, NULL, 0},
};

const lc_suite *lc_suite_find(const char *name)
{
    for (const lc_suite *s = lc_suites; s->name; ++s)
        if (strcmp(s->name, name) == 0)
            return s;
    return NULL;
}

double lc_cell_noise(const char *scene, const char *estimator)
{
    for (const lc_cell *cell = lc_cells; cell->scene; ++cell)
        if (strcmp(cell->scene, scene) == 0 && strcmp(cell->estimator, estimator) == 0)
            return cell->c;
    return NAN;
}

uint64_t lc_planned_samples(double c, double margin, int pixels)
{
    double ratio = 11.0 * c / margin;
    double samples = ceil(ratio * ratio / pixels);
    return samples < 1 ? 1 : (uint64_t)samples;
}
