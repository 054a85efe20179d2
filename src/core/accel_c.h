/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Private to accel.c and accel_build.c: the scene in Embree's hands.
 */
#ifndef LC_ACCEL_C_H
#define LC_ACCEL_C_H

#if LC_EMBREE == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "core/scene_c.h"

enum { FACES = 0, ROUNDS = 1 }; /* Embree's geometry IDs */

/* Where a ray that leaves a face may start. */
typedef struct face_start {
    double offset; /* along the normal, in unit space */
    double u,
        v; /* |u|, |v| at most: in a corner, a start rounded to beyond the neighbouring face would leave a closed room */
} face_start;

struct lc_accel {
    RTCDevice device;
    RTCScene scene;
    lc_vec3 center; /* unit space = (world - center) * scale */
    double scale;
    int has_packets;      /* whether this CPU traces packets of LC_PACKET faster than one ray by one */
    float (*vertices)[3]; /* four a face, in Embree's hands */
    unsigned (*quads)[4];
    face_start *starts; /* of each face */
    lc_round *rounds;   /* in unit space */
    int face_count, round_count;
    int moves; /* 1: geometry has two time steps, and a query its time */
};

/* What the callbacks for round parts need besides Embree's ray: the ray in double, in unit space. Of a packet's, the ray with id i has
 * the i-th in an array. */
typedef struct query {
#if LC_EMBREE == 4
    RTCRayQueryContext base; /* first, so that Embree's pointer is ours */
#else
    struct RTCIntersectContext base;
#endif
    const lc_accel *accel;
    lc_vec3 o, d; /* d unit */
    double t_max; /* of a segment */
    int from, to; /* round parts at its ends, or -1 */
    double time;
    int hit; /* round part hit, */
    double t; /* and where */
} query;

static inline lc_vec3 to_unit(const lc_accel *accel, lc_vec3 p) { return lc_scale(accel->scale, lc_sub(p, accel->center)); }

/* Embree's callbacks for round parts. */
void lc_accel_round_intersect(const struct RTCIntersectFunctionNArguments *args);
void lc_accel_round_occluded(const struct RTCOccludedFunctionNArguments *args);

#endif
