/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * energy.h: the parts of the energy check that a test hands a broken BSDF to.
 */
#ifndef LC_ENERGY_H
#define LC_ENERGY_H

#include "verify/checks/checks.h"
#include "verify/report/report.h"

/* The three functions of lightcheck.h that are judged. */
typedef struct lc_bsdf_functions {
    lc_rgb (*eval)(const lc_scene *scene, const lc_hit *hit, lc_vec3 wi);
    double (*pdf)(const lc_scene *scene, const lc_hit *hit, lc_vec3 wi);
    int (*sample)(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out);
} lc_bsdf_functions;

extern const lc_bsdf_functions lc_bsdf_host;

/* The materials, 0 <= i < lc_energy_count(); the name is NULL beyond. */
int lc_energy_count(void);
const char *lc_energy_name(int i);

/* Judges these functions on material i and fills the row, names included. LC_FAULT without memory. */
lc_status lc_energy_judge(lc_row *row, int i, const lc_bsdf_functions *bsdf, const lc_share *share, lc_error *err);

#endif
