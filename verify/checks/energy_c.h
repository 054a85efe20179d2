/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Private to verify/checks/energy*: one place on one material, seen from one side.
 */
#ifndef LC_ENERGY_C_H
#define LC_ENERGY_C_H

#include "verify/checks/energy.h"

typedef struct lc_stage {
    const lc_bsdf_functions *bsdf;
    const lc_scene *scene;
    lc_row *row;
    lc_hit hit;             /* all but wo */
    lc_vec3 s, t, n;        /* right-handed; n on the viewer's side */
    const char *side;       /* "front", "back" */
    lc_rgb diffuse, mirror; /* what the table says: albedo and reflectance seen from here, */
    double glass, ior;      /* share of the glass lobe, index beyond / index here, */
    lc_rgb glossy;          /* reflectance of the rough lobe's facets */
    double alpha;           /* and their roughness, 0 where there are none */
} lc_stage;

/* Ways on from a hit: diffuse and glossy are one. All samples of a delta way are alike. */
enum { LC_WAY_FINITE, LC_WAY_MIRROR, LC_WAY_REFLECTED, LC_WAY_TRANSMITTED, LC_WAYS };

typedef struct lc_ways {
    lc_scatter way[LC_WAYS];
    int seen[LC_WAYS];
    int absorbed;  /* 1: sample() returned 0 */
    double finite; /* integral of pdf() over the sphere, */
    lc_rgb albedo; /* and of f |cos| */
} lc_ways;

/* What an error is blamed on, before the numbers. */
#define LC_SAY_SUM "the integral of pdf() over the sphere, plus the probabilities of mirror and glass,"

/* The hit seen from the direction of this cosine (> 0) and azimuth [rad] about n. */
lc_hit lc_stage_seen(const lc_stage *stage, double cosine, double azimuth);
/* Which way a sample is, or -1 when lobe and is_delta contradict each other. */
int lc_way_of(const lc_scatter *sample, const lc_hit *hit);
double lc_channel(lc_rgb color, int channel);

/* 1 when `is` equals `should` within tolerance * max(1, |should|); else writes FAIL and the reason and returns 0. */
int lc_stage_expect(const lc_stage *stage, const lc_hit *hit, const char *what, double is, double should,
                    double tolerance);
/* Writes FAIL with this reason after the material's name and the direction; returns 0. */
int lc_stage_fail(const lc_stage *stage, const lc_hit *hit, const char *format, ...)
#ifdef __GNUC__
    __attribute__((format(printf, 3, 4)))
#endif
    ;

/* Tolerance of integrals, relative to the largest. */
double lc_stage_rounding(const lc_stage *stage);
/* Reflected by the rough lobe of what comes along wo, by its closed form. Returns 0 after a FAIL. */
int lc_stage_glossy_albedo(double *albedo, const lc_stage *stage, const lc_hit *hit);

/* Integrals over the sphere of pdf() and of f |cos| in each channel, where there is a rough lobe; 0 after a FAIL. */
int lc_glossy_integrals(double out[4], const lc_stage *stage, const lc_hit *hit);
/* Cells of directions by the facet that leads there, the last one where none does: the cell of wi, the probability of
 * each by pdf(); 0 after a FAIL. */
enum { LC_GLOSSY_CELLS = 65 };
int lc_glossy_cell_of(const lc_stage *stage, const lc_hit *hit, lc_vec3 wi);
int lc_glossy_cells(double probability[LC_GLOSSY_CELLS], const lc_stage *stage, const lc_hit *hit);

/* All ways on from the hit, by numbers that cover [0, 1) evenly; each sample is compared with pdf() and eval().
 * Returns 0 after a FAIL. */
int lc_stage_ways(lc_ways *out, const lc_stage *stage, const lc_hit *hit);
/* Integral of pdf() over mu0 < cos <= mu1 (both >= 0 or both <= 0) and phi0 < azimuth <= phi1. */
double lc_stage_pdf_integral(const lc_stage *stage, const lc_hit *hit, double mu0, double mu1, double phi0,
                             double phi1);

/* The part without chance: closed forms from one side, then whether delta lobes lead back to it; each returns 0
 * after a FAIL. */
int lc_energy_forms(const lc_stage *stage);
int lc_energy_way_back(const lc_stage *stage);

/* The part by chance. Its levels are split over `stages` of the row; adds to the row's numbers; returns 0 after a
 * FAIL. */
int lc_energy_sample(const lc_stage *stage, int index, int stages, const lc_share *share);

#endif
