/* SPDX-License-Identifier: GPL-3.0-or-later */
/* effects.h: what glossy surfaces, lenses and moving shapes do to light, where pen and paper or quadrature can say so. As in analytic.h:
 * nothing here has seen a ray, all functions are pure and may be called from any thread. */
#ifndef LC_EFFECTS_H
#define LC_EFFECTS_H

#include "verify/analytic/analytic.h"

/* ---- rough mirrors ---------------------------------------------------------------------------------------- */

/* The BRDF [1/sr] of mirror facets that reflect everything, with GGX slopes of roughness alpha in (0, 1] about unit n and Smith's separable
 * masking: D(h) G1(wo) G1(wi) / (4 cos_o cos_i); 0 unless both unit directions lie on the side of n. Source: Walter, Marschner, Li and
 * Torrance, Microfacet models for refraction through rough surfaces, EGSR 2007, eq. 20, 33, 34. */
double lc_ggx_value(lc_vec3 n, lc_vec3 wo, lc_vec3 wi, double alpha);

/* Its directional albedo, the integral of f cos_i over the hemisphere, seen at `cosine` in (0, 1]; below 1, since light that facets reflect
 * onto each other is lost in the model. No elementary form: over facets, where the density is uniform in 1 / (1 + tan^2 / alpha^2) and in
 * the azimuth, which for each facet angle ends where the light would come from below the horizon. Adaptive quadrature (GSL) to 1e-8.
 * LC_FAULT when it does not converge. */
lc_status lc_ggx_albedo(double *albedo, double cosine, double alpha, lc_error *err);

/* The same over cosines in [low, high], 0 < low < high <= 1, as a Chebyshev series: thousands of times faster, to 1e-7 for low >= alpha / 4. */
enum { LC_GGX_TERMS = 32 };
typedef struct lc_ggx_series {
    double low, high, term[LC_GGX_TERMS];
} lc_ggx_series;
lc_status lc_ggx_series_fit(lc_ggx_series *out, double low, double high, double alpha, lc_error *err);
double lc_ggx_series_at(const lc_ggx_series *series, double cosine);

/* Light of radiance 1 that such a facet surface at p, unit normal n, sends along unit wo from a rectangle centre + x a + y b, |x|, |y| <= 1,
 * which emits on the side of a x b and which nothing hides: the integral of f cos cos' / d^2 over it, adaptive, to `absolute`. */
lc_status lc_ggx_rectangle(double *out, lc_vec3 centre, lc_vec3 a, lc_vec3 b, lc_vec3 p, lc_vec3 n, lc_vec3 wo,
                           double alpha, double absolute, lc_error *err);

/* ---- lenses -------------------------------------------------------------------------------------------------- */

/* Share in [0, 1] of the disk of `radius` > 0 around (x, y) that a simple polygon covers: the sum over its edges of triangles and sectors
 * about the centre, exact. What a thin lens of aperture radius a focused at f sees, through one point of the image, of a plane
 * across its axis at depth z is such a disk, of radius a |1 - z / f|. */
double lc_disk_polygon_share(const double (*corners)[2], int count, double x, double y, double radius);

/* ---- motion -------------------------------------------------------------------------------------------------- */

/* Times from..to in [0, 1] at which a line meets a convex shape that moves straight by `motion` until time 1; from > to where it never does.
 * The line p + s d has no ends; unit d is not parallel to a flat shape. Rectangle: centre + x a + y b, |x|, |y| <= 1; disk: x^2 + y^2 <= 1.
 * Closed forms: in the shape's own coordinates a point that moves evenly enters and leaves it once. */
typedef struct lc_span {
    double from, to;
} lc_span;
lc_span lc_rectangle_span(lc_vec3 centre, lc_vec3 a, lc_vec3 b, lc_vec3 motion, lc_vec3 p, lc_vec3 d);
lc_span lc_disk_span(lc_vec3 centre, lc_vec3 a, lc_vec3 b, lc_vec3 motion, lc_vec3 p, lc_vec3 d);
lc_span lc_sphere_span(lc_vec3 centre, double radius, lc_vec3 motion, lc_vec3 p, lc_vec3 d);
/* Length of the union. */
double lc_spans_length(const lc_span *spans, int count);

/* lc_direct_irradiance() averaged over time, at a point at rest: eight Gauss-Legendre nodes, to about 1e-9 where no lamp comes close or crosses a
 * horizon and no shadow passes. */
lc_status lc_moving_irradiance(lc_rgb *out, const lc_scene_desc *desc, lc_vec3 p, lc_vec3 n, lc_error *err);

/* ---- quadrature in two dimensions --------------------------------------------------------------------------- */

/* Integrals of `count` <= LC_CUBATURE_MOST functions over [x0, x1] x [y0, y1] at once, each to about `absolute`: 4 x 4 Gauss-Legendre nodes a
 * box (exact to degree 7), a box cut in four until that changes nothing. Singularities in points and kinks along lines are found; a peak
 * narrower than the first nodes' distance belongs on a corner of the box. LC_FAULT beyond a million boxes. */
enum { LC_CUBATURE_MOST = 4 };
typedef void lc_integrand2(double *values, double x, double y, void *user);
lc_status lc_cubature(double *out, int count, lc_integrand2 *f, void *user, double x0, double x1, double y0, double y1,
                      double absolute, lc_error *err);

#endif
