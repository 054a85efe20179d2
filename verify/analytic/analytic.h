/* SPDX-License-Identifier: GPL-3.0-or-later */
/* analytic.h: what light does where pen and paper can say so. Nothing here has seen a ray, a sampler or Embree.
 *
 * A form factor F is the share of the cosine-weighted hemisphere of a receiver at p with unit normal n that an
 * emitter fills: E = pi L F [W m^-2] for an emitter of constant radiance L [W sr^-1 m^-2], F in [0, 1]. Emission is
 * one-sided. All functions are pure, may be called from any thread, and are good to about 1e-10 relative unless they
 * say else (of the unclipped value, where a horizon leaves only a sliver). Lengths in metres. */
#ifndef LC_ANALYTIC_H
#define LC_ANALYTIC_H

#include "core/host.h"

/* ---- emitters and receivers -------------------------------------------------------------------------- */

/* Radiance [W sr^-1 m^-2] of a Lambertian emitter of `flux` [W] and one-sided `area` [m^2], > 0: L = Phi / (pi A).
 * Source: Nicodemus et al., Geometrical Considerations and Nomenclature for Reflectance, NBS 160, 1977. */
double lc_lambert_radiance(double flux, double area);

/* Radiance [W sr^-1 m^-2] that a Lambertian receiver of albedo `rho` in [0, 1] sends back under `irradiance` [W
 * m^-2]: rho E / pi. Source: Nicodemus et al. 1977. */
double lc_lambert_reflected(double rho, double irradiance);

/* Irradiance [W m^-2] at p, normal n, by a point light of `intensity` [W/sr] at `light` != p: E = I cos / d^2, 0 from
 * below. Source: Lambert, Photometria, 1760 (inverse-square and cosine laws). */
double lc_point_irradiance(double intensity, lc_vec3 light, lc_vec3 p, lc_vec3 n);

/* Irradiance [W m^-2] by parallel light that travels along unit `direction` and gives `facing` [W m^-2] to a surface
 * that faces it: E = E0 cos, 0 from behind. Source: Lambert 1760. */
double lc_directional_irradiance(double facing, lc_vec3 direction, lc_vec3 n);

/* F of a planar polygon of `count` corners, 3 <= count <= LC_POLYGON_MAX (else NAN), counter-clockwise seen from the
 * side that emits, clipped to the horizon of (p, n): F = 1/(2 pi) sum_i angle_i (gamma_i . n), gamma_i the unit
 * normal of the plane through p and edge i. 0 from behind and from the polygon's own plane (to 1e-9 of the distance
 * to its farthest corner). Source: Lambert 1760; Arvo, Analytic Methods for Simulated Light Transport, PhD thesis,
 * Yale 1995. */
enum { LC_POLYGON_MAX = 64 };
double lc_polygon_factor(const lc_vec3 *corners, int count, lc_vec3 p, lc_vec3 n);

/* F of a rectangle a x b parallel to the receiver at height h, one corner right above p; a, b in [0, INFINITY]; 0 for
 * h <= 0. F = 1/(2 pi) [X/sqrt(1+X^2) atan(Y/sqrt(1+X^2)) + Y/sqrt(1+Y^2) atan(X/sqrt(1+Y^2))], X = a/h, Y = b/h.
 * Source: Hamilton and Morgan, Radiant-Interchange Configuration Factors, NACA TN 2836, 1952. */
double lc_rectangle_factor(double a, double b, double h);

/* F of a disk of `radius` > 0 parallel to the receiver at height h, its axis passing p at distance `offset` >= 0; 0
 * for h <= 0. F = (1 - (h^2+a^2-R^2) / sqrt((h^2+a^2+R^2)^2 - 4 a^2 R^2)) / 2. Source: Hamilton and
 * Morgan 1952. */
double lc_disk_factor(double radius, double offset, double h);

/* F of the ellipse centre + x axis1 + y axis2, x^2 + y^2 <= 1, which emits on the side of axis1 x axis2; the axes are
 * orthogonal or not, of any length [m]. No elementary form with the horizon: adaptive quadrature over the azimuth to
 * 1e-9. LC_FAULT without memory or when the quadrature does not converge. Source: F = 1/(2 pi) int (sin^2 t1 - sin^2
 * t0) dphi, the integral of cos over solid angle in polar coordinates about n, t0 and t1 where the ellipse begins and
 * ends. */
lc_status lc_ellipse_factor(double *factor, lc_vec3 centre, lc_vec3 axis1, lc_vec3 axis2, lc_vec3 p, lc_vec3 n,
                            lc_error *err);

/* F of a sphere of `radius` >= 0, receiver outside (on the sphere: its tangent plane's half-space; inside: 0, the
 * sphere emits outward). H = d/R, t the angle between n and the centre. F = cos t / H^2 for cos t >= 1/H; 0 for cos t
 * <= -1/H; between, with x = sqrt(H^2-1), y = -x cot t, s = sin t sqrt(1-y^2): F = [cos t acos y - x s]/(pi H^2) +
 * atan(s/x)/pi. Source: Martinez, Radiative View Factors, Universidad Politecnica
 * de Madrid (patch to a sphere, tilted). */
double lc_sphere_factor(lc_vec3 centre, double radius, lc_vec3 p, lc_vec3 n);

/* F of the lune between the horizon and a half-plane of directions at `elevation` b in [0, pi] [rad] above it, such
 * as an infinite wall whose top edge stands at elevation b: F = (1 - cos b) / 2. Source: Nusselt 1928
 * (projection on the unit disk). */
double lc_wall_factor(double elevation);

/* Irradiance [W m^-2] by a sky of constant `radiance` above a receiver whose hemisphere is free: pi L. */
double lc_sky_irradiance(double radiance);

/* F_21 of area2 to area1 from F_12 of area1 to area2 [m^2]: A1 F12 = A2 F21. Source: Lambert 1760 (reciprocity). */
double lc_reciprocal_factor(double factor12, double area1, double area2);

/* ---- closed scenes -------------------------------------------------------------------------------------- */

/* As a number of reflections: light that was reflected any number of times. */
enum { LC_ALL_REFLECTIONS = -1 };

/* Irradiance [W m^-2], the same everywhere, on the inside of a Lambertian sphere with any emission Le(x) and albedo
 * rho(x), of area means `mean_le` [W sr^-1 m^-2] and `mean_rho` in [0, 1]: E = pi <Le> sum_{j<K} <rho>^j, the light
 * that was reflected fewer than K times before; K >= 0, or all: pi <Le> / (1 - <rho>). So L(x) = Le(x) + rho(x) E /
 * pi holds up to K reflections. Source: Jacquez and Kuppenheim, Theory of the integrating sphere, JOSA 45, 1955: the
 * kernel is 1/(4 pi R^2) everywhere. */
double lc_inside_sphere_irradiance(double mean_le, double mean_rho, int reflections);

/* Area mean of a texture over a sphere with Mitsuba's (u, v) = (phi / 2 pi, theta / pi), theta from +z: exact, by
 * intervals of u and of cos(pi v). Any scale and offset of at most 1e6 cells an axis. */
lc_rgb lc_texture_sphere_mean(const lc_texture *texture);

/* Radiance in a closed room where every surface has emission `le` [W sr^-1 m^-2] and albedo `rho` in [0, 1],
 * Lambertian or mirror, after up to K reflections: Le (1 - rho^(K+1)) / (1 - rho); all: Le / (1 - rho). */
double lc_furnace_radiance(double le, double rho, int reflections);

/* Bounds of the radiance in a closed thermal furnace, where every surface emits L0 (1 - rho_hd(x, w)), after K
 * reflections: L0 (1 - rho_max^(K+1)) <= L <= L0; with all reflections both are L0. `rho_max` in [0, 1): the largest
 * directional albedo. Source: Kirchhoff 1860; the second law. */
void lc_thermal_bounds(double *low, double *high, double l0, double rho_max, int reflections);

/* Radiance leaving plate 1 of two infinite parallel Lambertian plates, after up to K reflections:
 * Le1 + rho1 Le2 + rho1 rho2 Le1 + ..., all: (Le1 + rho1 Le2) / (1 - rho1 rho2). rho in [0, 1], not both 1. */
double lc_parallel_plates_radiance(double le1, double rho1, double le2, double rho2, int reflections);

/* Radiance of an emitter `le` seen after k >= 0 reflections between two facing mirrors of reflectance r1 (hit first),
 * r2 in [0, 1]: r1^ceil(k/2) r2^floor(k/2) Le. */
double lc_mirror_corridor_radiance(double le, double r1, double r2, int reflections);

/* Area mean of the irradiance [W m^-2] in a closed Lambertian scene of surface `area` [m^2] and uniform albedo `rho`,
 * fed with `flux` [W], counting light reflected fewer than K times: Phi/S sum_{j<K} rho^j; all: Phi / (S (1 - rho)).
 * Source: flux balance, int (1 - rho) E dA = int pi Le dA; CIE 171:2006, case 5.8. */
double lc_closed_mean_irradiance(double flux, double area, double rho, int reflections);

/* ---- smooth dielectrics ------------------------------------------------------------------------------- */

/* Unpolarised reflectance in [0, 1] of a smooth interface, cos_i in [0, 1] on the side of incidence, eta > 0 the
 * index beyond over the index of incidence; 1 beyond the critical angle. Source: Fresnel 1823; Born and Wolf,
 * Principles of Optics, 1.5.2. */
double lc_fresnel_dielectric(double cos_i, double eta);

/* Share transmitted and reflected by a plane slab without absorption whose faces both reflect `face` in [0, 1]
 * (unpolarised at each face, as renderers do it), after at most m >= 0 internal reflections: T = (1-R)^2 sum_{2j <=
 * m} R^(2j), R_slab = R + R (1-R)^2 sum_{2j+1 <= m} R^(2j); all: (1-R)/(1+R) and 2R/(1+R). Source: Stokes, Proc. R.
 * Soc. 11, 1862. */
double lc_slab_transmittance(double face, int internal);
double lc_slab_reflectance(double face, int internal);

/* ---- any scene ------------------------------------------------------------------------------------------ */

/* Exact irradiance [W m^-2] at p with unit normal n by all emitters of a description, each seen directly: areas,
 * points, directional lights, sky. Shapes hide each other exactly, and may touch but not cut through each other;
 * every shape hides, glass as well. Where nothing hides, and where flat shapes hide flat lamps, closed forms (1e-10);
 * where a disk, a sphere or the sky takes part, quadrature over the azimuth (1e-10). A shape never hides itself; p
 * may lie on a shape, to 1e-9 of its distance. Lo = rho E / pi. LC_BAD_INPUT where no form applies: a checkerboard
 * lamp that is neither a rectangle, nor a sphere seen from its own inner wall; a "sphere" that is none. LC_FAULT
 * without memory or when the quadrature does not converge. Uses the description's numbers only. */
lc_status lc_direct_irradiance(lc_rgb *out, const lc_scene_desc *desc, lc_vec3 p, lc_vec3 n, lc_error *err);

/* The same as if nothing hid anything: what a tracer without shadow rays would compute (the sky fills the
 * hemisphere). */
lc_status lc_direct_unoccluded(lc_rgb *out, const lc_scene_desc *desc, lc_vec3 p, lc_vec3 n, lc_error *err);

/* Irradiance [W m^-2] at p with unit normal n of the front of shape `own_shape` by light that was scattered once, on another
 * surface: int rho E(q) / pi cos cos' / d^2 dA(q), E(q) by lc_direct_irradiance(). Gauss and Legendre's product rule of
 * LC_SECOND_NODES^2 nodes a surface, prepared once a scene. Holds where surfaces that reflect are one-sided rectangles of one colour,
 * apart from each other by about their size or more, whole above each other's horizons, and nothing stands between them:
 * LC_BAD_INPUT for other surfaces, the rest is up to the caller. Any thread once prepared. Source: Kajiya 1986, eq. 1,
 * twice. */
enum { LC_SECOND_NODES = 24 };
typedef struct lc_second_node {
    lc_vec3 p, n;
    lc_rgb radiance; /* times the node's area [W sr^-1] */
    int shape;
} lc_second_node;
typedef struct lc_second {
    lc_second_node *nodes;
    int count;
} lc_second;
lc_status lc_second_prepare(lc_second *out, const lc_scene_desc *desc, lc_error *err); /* empty after a failure */
void lc_second_release(lc_second *second);
lc_rgb lc_second_irradiance(const lc_second *second, int own_shape, lc_vec3 p, lc_vec3 n);

/* ---- quadrature ------------------------------------------------------------------------------------------- */

/* Integral of f over [a, b], a <= b, to max(absolute, relative |result|): GSL's doubly adaptive Clenshaw-Curtis rule
 * after x = a + (b - a) t^2 (3 - 2 t), which makes square-root ends smooth; kinks inside cost samples but no
 * accuracy. LC_FAULT without memory, or when the estimated error stays above 100 times what was asked. Source:
 * Gonnet, Increasing the reliability of adaptive quadrature using explicit interpolants, ACM TOMS 37(3), 2010. */
typedef double lc_integrand(double x, void *user);
lc_status lc_quadrature(double *out, lc_integrand *f, void *user, double a, double b, double absolute, double relative,
                        lc_error *err);

#endif
