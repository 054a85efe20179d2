/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The suites as a table: scenes, and the noise of each estimator there (measured by `lightcheck verify --measure`).
 */
#include <math.h>
#include <string.h>

#include "verify/judge/judge.h"

const lc_suite lc_suites[] = {
    {"quick", 0.005, 6e8},
    {"full", 0.0025, 3.6e9},
    {NULL, 0, 0},
};

const char *const lc_suite_scenes[] = {
    "plane_point",
    "plane_directional",
    "plane_rectangle",
    "plane_tilted",
    "plane_disk",
    "plane_sphere",
    "plane_cube",
    "lamp_100w",
    "two_lights",
    "five_lights",
    "occluder",
    "cornell",
    "cornell_small",
    "cornell_large",
    "light_behind",
    "light_below",
    "no_lights",
    "sky",
    "flipped_twosided",
    "furnace_sphere",
    "furnace_checker",
    "mixed_lights",
    "textured_lamp",
    "mirror_sky",
    "mirror_corridor",
    "glass_slab",
    "glass_sphere",
    "critical_angle",
    "glass_blend",
    "thermal_furnace",
    "cornell_mirror",
    "cornell_glass",
    "bright_room",
    "bright_mirrors",
    NULL,
};

const lc_cell lc_cells[] = {
    {"plane_point", "light_direct", 1, 0.00751},
    {"plane_directional", "light_direct", 1, 0},
    {"plane_rectangle", "hemisphere_direct", 1, 1.33},
    {"plane_rectangle", "light_direct", 1, 0.768},
    {"plane_rectangle", "three_point", 1, 0.768},
    {"plane_rectangle", "path", 1, 1.33},
    {"plane_rectangle", "mirror", 1, 1.33},
    {"plane_rectangle", "dielectric", 1, 1.32},
    {"plane_rectangle", "path_cosine", 1, 0.832},
    {"plane_tilted", "hemisphere_direct", 1, 3.41},
    {"plane_tilted", "light_direct", 1, 0.616},
    {"plane_tilted", "three_point", 1, 0.615},
    {"plane_tilted", "path", 1, 3.4},
    {"plane_tilted", "mirror", 1, 3.41},
    {"plane_tilted", "dielectric", 1, 3.41},
    {"plane_tilted", "path_nee", 1, 0.616},
    {"plane_tilted", "path_mis", 1, 0.671},
    {"plane_disk", "hemisphere_direct", 1, 1.38},
    {"plane_disk", "light_direct", 1, 0.729},
    {"plane_disk", "three_point", 1, 0.73},
    {"plane_disk", "path", 1, 1.38},
    {"plane_disk", "mirror", 1, 1.38},
    {"plane_disk", "dielectric", 1, 1.38},
    {"plane_sphere", "hemisphere_direct", 1, 3.97},
    {"plane_sphere", "light_direct", 1, 4.68},
    {"plane_sphere", "three_point", 1, 4.69},
    {"plane_sphere", "path", 1, 3.96},
    {"plane_sphere", "mirror", 1, 3.97},
    {"plane_sphere", "dielectric", 1, 3.98},
    {"plane_cube", "hemisphere_direct", 1, 2.32},
    {"plane_cube", "light_direct", 1, 2.78},
    {"plane_cube", "three_point", 1, 2.78},
    {"plane_cube", "path", 1, 2.32},
    {"plane_cube", "mirror", 1, 2.32},
    {"plane_cube", "dielectric", 1, 2.31},
    {"lamp_100w", "hemisphere_direct", 1, 2.82},
    {"lamp_100w", "light_direct", 1, 0.457},
    {"lamp_100w", "three_point", 1, 0.457},
    {"lamp_100w", "path", 1, 2.82},
    {"lamp_100w", "mirror", 1, 2.81},
    {"lamp_100w", "dielectric", 1, 2.8},
    {"two_lights", "hemisphere_direct", 1, 4.97},
    {"two_lights", "light_direct", 1, 1.32},
    {"two_lights", "three_point", 1, 1.53},
    {"two_lights", "path", 1, 4.97},
    {"two_lights", "mirror", 1, 4.98},
    {"two_lights", "dielectric", 1, 4.97},
    {"five_lights", "hemisphere_direct", 1, 4.29},
    {"five_lights", "light_direct", 1, 2.06},
    {"five_lights", "three_point", 1, 2.12},
    {"five_lights", "path", 1, 4.3},
    {"five_lights", "mirror", 1, 4.29},
    {"five_lights", "dielectric", 1, 4.32},
    {"five_lights", "path_mis", 1, 1.55},
    {"occluder", "hemisphere_direct", 1, 6.19},
    {"occluder", "light_direct", 1, 1.19},
    {"occluder", "three_point", 1, 1.4},
    {"occluder", "path", 1, 6.23},
    {"occluder", "mirror", 1, 6.26},
    {"occluder", "dielectric", 1, 6.27},
    {"cornell", "hemisphere_direct", 1, 14.7},
    {"cornell", "light_direct", 1, 0.636},
    {"cornell", "three_point", 1, 0.637},
    {"cornell", "path", 1, 14.6},
    {"cornell", "mirror", 1, 14.7},
    {"cornell", "mirror", 5, 11.7},
    {"cornell", "dielectric", 1, 14.6},
    {"cornell", "dielectric", 5, 11.5},
    {"cornell", "path_cosine", 5, 8.71},
    {"cornell", "path_nee", 5, 0.976},
    {"cornell", "path_mis", 5, 1.01},
    {"cornell_small", "hemisphere_direct", 1, 14.7},
    {"cornell_small", "three_point", 1, 0.637},
    {"cornell_small", "path", 1, 14.6},
    {"cornell_small", "mirror", 1, 14.7},
    {"cornell_small", "mirror", 5, 11.7},
    {"cornell_small", "dielectric", 1, 14.6},
    {"cornell_small", "dielectric", 5, 11.5},
    {"cornell_large", "hemisphere_direct", 1, 14.7},
    {"cornell_large", "three_point", 1, 0.637},
    {"cornell_large", "path", 1, 14.6},
    {"cornell_large", "mirror", 1, 14.7},
    {"cornell_large", "mirror", 5, 11.7},
    {"cornell_large", "dielectric", 1, 14.6},
    {"cornell_large", "dielectric", 5, 11.5},
    {"sky", "hemisphere_direct", 1, 0.645},
    {"sky", "path", 1, 0.645},
    {"sky", "mirror", 1, 0.645},
    {"sky", "dielectric", 1, 0.645},
    {"sky", "path_cosine", 1, 0.0563},
    {"sky", "path_mis", 1, 0.0562},
    {"flipped_twosided", "hemisphere_direct", 1, 2.33},
    {"flipped_twosided", "light_direct", 1, 0.453},
    {"flipped_twosided", "three_point", 1, 0.452},
    {"flipped_twosided", "path", 1, 2.33},
    {"flipped_twosided", "mirror", 1, 2.33},
    {"flipped_twosided", "dielectric", 1, 2.33},
    {"furnace_sphere", "hemisphere_direct", 1, 0.576},
    {"furnace_sphere", "path", 1, 0.577},
    {"furnace_sphere", "path", 2, 0.649},
    {"furnace_sphere", "path", 3, 0.727},
    {"furnace_sphere", "path", 4, 0.801},
    {"furnace_sphere", "path", 5, 0.87},
    {"furnace_sphere", "path", 6, 0.932},
    {"furnace_sphere", "path", 7, 0.99},
    {"furnace_sphere", "path", 8, 1.04},
    {"furnace_sphere", "mirror", 1, 0.578},
    {"furnace_sphere", "mirror", 2, 0.649},
    {"furnace_sphere", "mirror", 4, 0.802},
    {"furnace_sphere", "mirror", 5, 0.87},
    {"furnace_sphere", "mirror", 8, 1.04},
    {"furnace_sphere", "dielectric", 1, 0.577},
    {"furnace_sphere", "dielectric", 2, 0.648},
    {"furnace_sphere", "dielectric", 4, 0.8},
    {"furnace_sphere", "dielectric", 5, 0.867},
    {"furnace_sphere", "dielectric", 8, 1.04},
    {"furnace_sphere", "path_cosine", 5, 0},
    {"furnace_sphere", "path_cosine", 8, 0},
    {"furnace_sphere", "path_nee", 5, 0},
    {"furnace_sphere", "path_nee", 8, 0},
    {"furnace_sphere", "path_mis", 5, 0},
    {"furnace_sphere", "path_mis", 8, 0},
    {"furnace_checker", "hemisphere_direct", 1, 1.62},
    {"furnace_checker", "light_direct", 1, 1.26},
    {"furnace_checker", "three_point", 1, 1.26},
    {"furnace_checker", "path", 1, 1.62},
    {"furnace_checker", "path", 2, 1.49},
    {"furnace_checker", "path", 3, 1.52},
    {"furnace_checker", "path", 4, 1.58},
    {"furnace_checker", "path", 5, 1.63},
    {"furnace_checker", "path", 6, 1.66},
    {"furnace_checker", "path", 7, 1.69},
    {"furnace_checker", "path", 8, 1.71},
    {"furnace_checker", "mirror", 1, 1.62},
    {"furnace_checker", "mirror", 2, 1.49},
    {"furnace_checker", "mirror", 4, 1.58},
    {"furnace_checker", "mirror", 5, 1.63},
    {"furnace_checker", "mirror", 8, 1.71},
    {"furnace_checker", "dielectric", 1, 1.62},
    {"furnace_checker", "dielectric", 2, 1.49},
    {"furnace_checker", "dielectric", 4, 1.58},
    {"furnace_checker", "dielectric", 5, 1.63},
    {"furnace_checker", "dielectric", 8, 1.7},
    {"furnace_checker", "path_cosine", 8, 1.05},
    {"furnace_checker", "path_nee", 4, 1.03},
    {"furnace_checker", "path_mis", 8, 0.879},
    {"mixed_lights", "light_direct", 1, 1.02},
    {"mixed_lights", "path_nee", 1, 1.02},
    {"mixed_lights", "path_mis", 1, 0.786},
    {"textured_lamp", "hemisphere_direct", 1, 2.75},
    {"textured_lamp", "light_direct", 1, 1.39},
    {"textured_lamp", "three_point", 1, 1.39},
    {"textured_lamp", "path", 1, 2.75},
    {"textured_lamp", "mirror", 1, 2.75},
    {"textured_lamp", "dielectric", 1, 2.75},
    {"mirror_sky", "mirror", 1, 0.51},
    {"mirror_sky", "dielectric", 1, 0.509},
    {"mirror_corridor", "mirror", 12, 0.0425},
    {"mirror_corridor", "dielectric", 12, 0.0425},
    {"glass_slab", "dielectric", 8, 0.318},
    {"glass_sphere", "dielectric", 6, 0.234},
    {"critical_angle", "dielectric", 1, 0.0912},
    {"glass_blend", "dielectric", 1, 0.696},
    {"thermal_furnace", "dielectric", 24, 0.586},
    {"cornell_mirror", "hemisphere_direct", 1, 16},
    {"cornell_mirror", "three_point", 1, 0.649},
    {"cornell_mirror", "path", 1, 16},
    {"cornell_mirror", "dielectric", 5, 11.4},
    {"cornell_glass", "hemisphere_direct", 1, 15.4},
    {"cornell_glass", "three_point", 1, 0.679},
    {"cornell_glass", "path", 1, 15.3},
    {"cornell_glass", "mirror", 1, 15.4},
    {"cornell_glass", "mirror", 5, 12.6},
    {"bright_room", "hemisphere_direct", 1, 3.28},
    {"bright_room", "three_point", 1, 1.17},
    {"bright_room", "path", 1, 3.3},
    {"bright_room", "mirror", 1, 3.3},
    {"bright_room", "mirror", 3, 2.61},
    {"bright_room", "dielectric", 1, 3.32},
    {"bright_room", "dielectric", 3, 2.62},
    {"bright_room", "path_cosine", 3, 2.08},
    {"bright_room", "path_mis", 3, 0.708},
    {"bright_room", "path_nee", 3, 0.899},
    {"bright_mirrors", "hemisphere_direct", 1, 3.84},
    {"bright_mirrors", "three_point", 1, 1.47},
    {"bright_mirrors", "path", 1, 3.87},
    {"bright_mirrors", "dielectric", 3, 2.71},
    {NULL, NULL, 0, 0},
};

const lc_suite *lc_suite_find(const char *name)
{
    for (const lc_suite *s = lc_suites; s->name; ++s)
        if (strcmp(s->name, name) == 0)
            return s;
    return NULL;
}

/* Estimators that vary another one have these rows, and the exact ones; in the quick suite those marked so. Any other estimator, a
 * student's too, has every row that is not full_only. */
static const struct {
    const char *estimator, *check, *scene;
    int max_bounces, is_quick;
} chosen_rows[] = {
    {"path_cosine", "analytic", "sky", 1, 1},
    {"path_cosine", "analytic", "plane_rectangle", 1, 0},
    {"path_cosine", "furnace", "furnace_sphere", 5, 1},
    {"path_cosine", "furnace", "furnace_sphere", 8, 0},
    {"path_cosine", "furnace", "furnace_checker", 8, 1},
    {"path_cosine", "equality", "bright_room", 3, 0},
    {"path_cosine", "equality", "cornell", 5, 0},
    {"path_nee", "analytic", "mixed_lights", 1, 1},
    {"path_nee", "analytic", "plane_tilted", 1, 0},
    {"path_nee", "furnace", "furnace_sphere", 5, 1},
    {"path_nee", "furnace", "furnace_sphere", 8, 0},
    {"path_nee", "furnace", "furnace_checker", 4, 1},
    {"path_nee", "equality", "cornell", 5, 1},
    {"path_nee", "equality", "bright_room", 3, 0},
    {"path_mis", "analytic", "five_lights", 1, 1},
    {"path_mis", "analytic", "mixed_lights", 1, 1},
    {"path_mis", "analytic", "plane_tilted", 1, 0},
    {"path_mis", "analytic", "sky", 1, 0},
    {"path_mis", "furnace", "furnace_sphere", 5, 1},
    {"path_mis", "furnace", "furnace_sphere", 8, 0},
    {"path_mis", "furnace", "furnace_checker", 8, 1},
};

int lc_suite_has(const lc_suite *suite, const lc_claim *claim)
{
    int is_quick = strcmp(suite->name, "quick") == 0, varies = 0;
    for (size_t i = 0; i < sizeof chosen_rows / sizeof chosen_rows[0] && claim->estimator && !claim->exact; ++i) {
        if (strcmp(chosen_rows[i].estimator, claim->estimator->name) != 0)
            continue;
        varies = 1;
        if (chosen_rows[i].max_bounces == claim->max_bounces && strcmp(chosen_rows[i].check, claim->check->name) == 0 &&
            strcmp(chosen_rows[i].scene, lc_scene_description(claim->scene)->name) == 0)
            return !is_quick || chosen_rows[i].is_quick;
    }
    return !varies && !(is_quick && claim->full_only);
}

double lc_cell_noise(const char *scene, const char *estimator, int max_bounces)
{
    for (const lc_cell *cell = lc_cells; cell->scene; ++cell)
        if (cell->max_bounces == max_bounces && strcmp(cell->scene, scene) == 0 &&
            strcmp(cell->estimator, estimator) == 0)
            return cell->c;
    return NAN;
}

uint64_t lc_planned_samples(double c, double margin, int pixels)
{
    double ratio = 11.0 * c / margin;
    double samples = ceil(ratio * ratio / pixels);
    return samples < 1 ? 1 : samples < 0x1p62 ? (uint64_t)samples : (uint64_t)1 << 62;
}
