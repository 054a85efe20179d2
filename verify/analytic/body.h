/* SPDX-License-Identifier: GPL-3.0-or-later */
/* body.h: private to verify/analytic: shapes as one receiver sees them, which hides what, and the integrals over
 * them.
 *
 * A body lives in the receiver's frame: the receiver is the origin, its normal +z. Bodies are convex and opaque. */
#ifndef LC_ANALYTIC_BODY_H
#define LC_ANALYTIC_BODY_H

#include "verify/analytic/analytic.h"

/* Nearer than this share of its distance, a point lies ON a surface: a thousand times what doubles lose between scene
 * and point, far less than anything a scene means. */
#define LC_TOUCH 1e-9

enum { LC_BODY_CORNERS = 8, LC_BODY_AZIMUTHS = 8, LC_BODY_CROSSINGS = 16 };

/* SKY: the hemisphere itself, infinitely far. */
typedef enum lc_body_kind { LC_BODY_POLYGON, LC_BODY_ELLIPSE, LC_BODY_BALL, LC_BODY_SKY } lc_body_kind;

typedef struct lc_body {
    lc_body_kind kind;
    int shape;                  /* in the description; bodies of one shape do not hide each other */
    int count;                  /* polygon: corners above the horizon; 0 when nothing is */
    lc_vec3 v[LC_BODY_CORNERS]; /* polygon: those corners. Ellipse: centre, two semi-axes. Ball: centre */
    double radius;              /* ball */
    lc_vec3 normal;             /* flat: unit, on the side that emits */
    double offset;              /* flat: normal . x = offset; < 0 where the receiver sees that side */
    lc_vec3 middle;             /* bounding sphere */
    double reach;
} lc_body;

/* The receiver's frame. */
typedef struct lc_receiver {
    lc_vec3 p, x, y, n;
} lc_receiver;

lc_receiver lc_receiver_at(lc_vec3 p, lc_vec3 n);
lc_vec3 lc_receiver_vector(const lc_receiver *receiver, lc_vec3 v); /* world to frame */
lc_vec3 lc_receiver_point(const lc_receiver *receiver, lc_vec3 p);

/* Bodies from world coordinates. Corners (3 or 4) counter-clockwise seen from the side that emits; so are axis1,
 * axis2. */
lc_body lc_body_polygon(const lc_receiver *receiver, const lc_vec3 *corners, int count, int shape);
lc_body lc_body_ellipse(const lc_receiver *receiver, lc_vec3 centre, lc_vec3 axis1, lc_vec3 axis2, int shape);
lc_body lc_body_ball(const lc_receiver *receiver, lc_vec3 centre, double radius, int shape);
lc_body lc_body_sky(void);

/* Distance of the receiver to the plane of a flat body, counted from the side that emits; 0 when it lies in the
 * plane. */
double lc_body_height(const lc_body *body);
/* -1, 0, 1: the receiver is inside, on, outside a ball. */
int lc_body_side(const lc_body *ball);
/* 1 when some of the body stands above the horizon and can hide something from the receiver. */
int lc_body_is_above(const lc_body *body);
/* 0 when bounding spheres tell that `body` hides nothing of `lamp`. */
int lc_body_may_hide(const lc_body *body, const lc_body *lamp);
/* Distance to the body along unit d, which is known to meet it (flat: to its plane). */
double lc_body_depth(const lc_body *body, lc_vec3 d);
/* 1 when the segment from the receiver to `target` above the horizon meets the body before its end. */
int lc_body_hides_point(const lc_body *body, lc_vec3 target);
/* Where the half-plane at an azimuth meets the body: q = sin^2 of the angle to the normal, q[0] < q[1]; returns 0
 * when nowhere. */
int lc_body_interval(const lc_body *body, double cos_phi, double sin_phi, double q[2]);
/* Azimuths in any period between which the interval's ends are smooth; returns their number <= LC_BODY_AZIMUTHS. */
int lc_body_azimuths(const lc_body *body, double *phi);
/* Azimuths where the outlines of two bodies cross; returns their number <= LC_BODY_CROSSINGS. GSL must be silent. */
int lc_body_crossings(const lc_body *first, const lc_body *second, double *phi);
/* Keeps GSL from aborting the process where it also returns a status. */
void lc_gsl_silence(void);

/* The part of a polygon with x . plane >= offset; `out` needs room for twice `count` (a convex polygon: count + 1).
 * Returns its corners. */
int lc_polygon_clip(lc_vec3 *out, const lc_vec3 *in, int count, lc_vec3 plane, double offset);
/* Area times unit normal [m^2]. */
lc_vec3 lc_polygon_area(const lc_vec3 *corners, int count);
/* lc_polygon_factor for corners relative to the receiver that lie above its horizon, seen from the emitting side. */
double lc_polygon_factor_above(const lc_vec3 *corners, int count, lc_vec3 n);

/* F of the visible part of a polygon behind polygons: exact, by clipping. LC_FAULT when a piece gets too many
 * corners. */
lc_status lc_clip_factor(double *factor, const lc_body *lamp, const lc_body *const *hiders, int count, lc_error *err);
/* F of the visible part of any body behind any bodies: quadrature over the azimuth. */
lc_status lc_scan_factor(double *factor, const lc_body *lamp, const lc_body *const *hiders, int count, lc_error *err);

/* Cells along one axis of a checkerboard over [0, 1]; the `index`-th is [from, to]; returns 1 in the upper halves. */
double lc_checker_cells(double scale, double offset);
int lc_checker_cell(double scale, double offset, double index, double *from, double *to);

#endif
