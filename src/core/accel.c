/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * With accel_build.c the only file that knows Embree (3.13 or 4).
 *
 * Embree works in single precision. Three measures keep that out of the results:
 *  - It sees the scene moved to the origin and scaled by a power of two into [-1, 1]^3: absolute tolerances anywhere in it
 *    mean the same at every scale, and a scene scaled by 2^k gives the same bits.
 *  - It only finds WHICH flat face is hit; the point is then computed in double. Spheres and disks are user geometry, decided in double.
 *  - A ray that leaves a round part knows it, and the root at its origin is divided out. A ray that leaves a face starts a distance
 *    along the normal that bounds the rounding of the vertices, of the origin and of the intersection test: with |n_i| as weights, so
 *    that a floor of 1 km lifts a point by no more than its own height's rounding; and as far from the face's edges, or rounding would
 *    let rays out of the corners of a closed room. Tests count self-hits and leaks.
 */
#include "core/accel_c.h"
#include "core/round_c.h"

/* A packet of n rays, as Embree lays it out: field k of ray i is element k n + i (a single ray is a packet of one). */
typedef union field {
    float f;
    unsigned u;
} field;
enum { T_FAR = 8, ID = 10, PRIM_ID = 17, GEOM_ID = 18 }; /* of an RTCRayHitN */

/* Nearest t in (0, t_max) where the ray meets the round part, or -1. */
static double meet(const query *q, int part)
{
    const lc_round *round = &q->accel->rounds[part];
    lc_round moved;
    if (q->accel->moves) {
        moved = *round;
        moved.o = lc_add(round->o, lc_scale(q->time, round->motion));
        round = &moved;
    }
    return meet_round(round, q->o, q->d, q->t_max, part == q->from, part == q->to);
}

void lc_accel_round_intersect(const struct RTCIntersectFunctionNArguments *args)
{
    unsigned n = args->N;
    field *ray = (field *)args->rayhit;
    for (unsigned i = 0; i < n; ++i) {
        if (args->valid[i] == 0)
            continue;
        query *q = (query *)args->context + ray[ID * n + i].u;
        double t = meet(q, (int)args->primID);
        if (t < 0 || (float)t >= ray[T_FAR * n + i].f)
            continue;
        ray[T_FAR * n + i].f = (float)t;
        ray[GEOM_ID * n + i].u = ROUNDS;
        ray[PRIM_ID * n + i].u = args->primID;
        q->t_max = t;
        q->hit = (int)args->primID;
        q->t = t;
    }
}

void lc_accel_round_occluded(const struct RTCOccludedFunctionNArguments *args)
{
    const query *q = (const query *)args->context; /* N is 1: rtcOccluded1 */
    if (args->valid[0] != 0 && meet(q, (int)args->primID) >= 0)
        ((struct RTCRay *)args->ray)->tfar = -INFINITY;
}

/* ---- queries -------------------------------------------------------------------------------------------- */

static void start_query(query *q, const lc_accel *accel, lc_vec3 o, lc_vec3 d, double t_max, double time, int from_part,
                        int to_part)
{
#if LC_EMBREE == 4
    rtcInitRayQueryContext(&q->base);
#else
    rtcInitIntersectContext(&q->base);
#endif
    if (accel->round_count == 0)
        return; /* nobody will ask */
    q->accel = accel;
    q->o = o;
    q->d = d;
    q->t_max = t_max;
    q->time = time;
    q->from = from_part >= accel->face_count ? from_part - accel->face_count : -1;
    q->to = to_part >= accel->face_count ? to_part - accel->face_count : -1;
    q->hit = -1;
    q->t = 0.0;
}

/* Where Embree's ray starts (or ends) instead of at `p` [unit space] on the part: off a face, towards `to`, and not at its very edge. */
static lc_vec3 off_face(const lc_accel *accel, const lc_scene *scene, lc_vec3 p, double time, int part, lc_vec3 to,
                        double extra)
{
    if (part < 0 || part >= accel->face_count)
        return p;
    const face_start *start = &accel->starts[part];
    const lc_face *face = &scene->faces[part];
    lc_vec3 r = lc_sub(p, to_unit(accel, face->o)); /* du, dv and eu, ev are in world space: the scales cancel */
    if (scene->moves)
        r = lc_sub(r, lc_scale(accel->scale, lc_shape_shift(scene, face->shape, time)));
    double u = lc_dot(face->du, r), v = lc_dot(face->dv, r), most_u = start->u * accel->scale,
           most_v = start->v * accel->scale;
    if (fabs(u) > most_u)
        p = lc_add(p, lc_scale(copysign(most_u, u) - u, face->eu));
    if (fabs(v) > most_v)
        p = lc_add(p, lc_scale(copysign(most_v, v) - v, face->ev));
    double offset = start->offset + extra;
    return lc_add(p, lc_scale(lc_dot(face->n, to) < 0 ? -offset : offset, face->n));
}

static void fill_ray(struct RTCRay *ray, lc_vec3 o, lc_vec3 d, double t_far, double time)
{
    ray->org_x = (float)o.x;
    ray->org_y = (float)o.y;
    ray->org_z = (float)o.z;
    ray->dir_x = (float)d.x;
    ray->dir_y = (float)d.y;
    ray->dir_z = (float)d.z;
    ray->tnear = 0.0f;
    ray->tfar = (float)t_far;
    ray->time = (float)time;
    ray->mask = ~0u;
    ray->id = 0;
    ray->flags = 0;
}

/* The point where the ray meets the plane of the face, in double. Embree's ray was a little another one, so that along an edge the point
 * may lie off the face, and far off at grazing angles: then the nearest one on it. */
static void finish_face(const lc_face *face, lc_vec3 o, lc_vec3 d, lc_hit *hit)
{
    double t = lc_dot(face->n, lc_sub(face->o, o)) / lc_dot(face->n, d);
    t = t > 0 ? t : 0.0; /* in a corner, rounding may put `o` a hair behind the neighbour */
    hit->p = lc_add(o, lc_scale(t, d));
    lc_vec3 r = lc_sub(hit->p, face->o);
    double u = lc_dot(face->du, r), v = lc_dot(face->dv, r);
    if (fabs(u) > 1.0 || fabs(v) > 1.0) {
        u = fmax(-1.0, fmin(u, 1.0));
        v = fmax(-1.0, fmin(v, 1.0));
        hit->p = lc_add(face->o, lc_add(lc_scale(u, face->eu), lc_scale(v, face->ev)));
        t = lc_length(lc_sub(hit->p, o));
    }
    hit->n = face->n;
    hit->distance = t;
    hit->shape = face->shape;
}

static void finish_round(const lc_round *round, lc_vec3 o, lc_vec3 d, double t, lc_hit *hit)
{
    hit->p = lc_add(o, lc_scale(t, d));
    hit->n = round->n;
    if (round->is_sphere) {
        lc_vec3 r = lc_normalize(lc_sub(hit->p, round->o));
        hit->p = lc_add(round->o, lc_scale(round->radius, r)); /* no drift over bounces */
        hit->n = lc_scale(round->sign, r);
    }
    hit->distance = t;
    hit->shape = round->shape;
}

/* A far camera enters the ball of radius 4 in double, or float rounding would show: moves `start` there along d, says how far that was.
 * Returns 0 where the ray passes by. */
static int enter(lc_vec3 *start, double *skipped, lc_vec3 d)
{
    double reach = lc_dot(*start, *start);
    *skipped = 0.0;
    if (!(reach > 16.0))
        return 1;
    double b = lc_dot(*start, d), discriminant = b * b - reach + 16.0;
    if (b >= 0 || discriminant < 0)
        return 0;
    *skipped = -b - sqrt(discriminant);
    *start = lc_add(*start, lc_scale(*skipped, d));
    return 1;
}

/* From Embree's answer to the hit; q is not looked at unless a round part was hit. */
static int finish(const lc_accel *accel, const lc_scene *scene, lc_vec3 o, lc_vec3 d, double time, unsigned geometry,
                  unsigned primitive, const query *q, double skipped, lc_hit *hit)
{
    int is_face = geometry == FACES;
    if (!is_face && geometry != ROUNDS)
        return 0;
    lc_vec3 rest = o, shift = lc_vec(0, 0, 0); /* where the ray is when the shape is moved back to time 0 */
    hit->part = is_face ? (int)primitive : accel->face_count + q->hit;
    if (scene->moves) {
        shift = lc_shape_shift(scene, is_face ? scene->faces[hit->part].shape : scene->rounds[q->hit].shape, time);
        rest = lc_sub(o, shift);
    }
    if (is_face)
        finish_face(&scene->faces[hit->part], rest, d, hit);
    else
        finish_round(&scene->rounds[q->hit], rest, d, (q->t + skipped) / accel->scale, hit);
    if (scene->moves)
        hit->p = lc_add(hit->p, shift);
    return 1;
}

int lc_accel_intersect(const lc_accel *accel, const lc_scene *scene, lc_vec3 o, lc_vec3 d, double time, int from_part,
                       lc_hit *hit)
{
    lc_vec3 start = to_unit(accel, o);
    double skipped = 0.0;
    if (from_part < 0 && !enter(&start, &skipped, d))
        return 0;
    query q;
    start_query(&q, accel, start, d, INFINITY, time, from_part, -1);
    struct RTCRayHit rayhit;
    fill_ray(&rayhit.ray, off_face(accel, scene, start, time, from_part, d, 0.0), d, INFINITY, time);
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if LC_EMBREE == 4
    struct RTCIntersectArguments args;
    rtcInitIntersectArguments(&args);
    args.context = &q.base;
    rtcIntersect1(accel->scene, &rayhit, &args);
#else
    rtcIntersect1(accel->scene, &q.base, &rayhit);
#endif
    return finish(accel, scene, o, d, time, rayhit.hit.geomID, rayhit.hit.primID, &q, skipped, hit);
}

/* The rays of one pixel meet the same few faces: told so, Embree walks its tree once for all of them. */
static void trace_packet(const lc_accel *accel, const int *valid, struct RTCRayHit8 *rayhit, query *q)
{
#if LC_EMBREE == 4
    struct RTCIntersectArguments args;
    rtcInitIntersectArguments(&args);
    args.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    args.context = &q->base;
    rtcIntersect8(valid, accel->scene, rayhit, &args);
#else
    q->base.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect8(valid, accel->scene, &q->base, rayhit);
#endif
}

static void fill_packet(struct RTCRayHit8 *rayhit, int i, lc_vec3 o, lc_vec3 d, double time)
{
    struct RTCRay8 *ray = &rayhit->ray;
    ray->org_x[i] = (float)o.x;
    ray->org_y[i] = (float)o.y;
    ray->org_z[i] = (float)o.z;
    ray->dir_x[i] = (float)d.x;
    ray->dir_y[i] = (float)d.y;
    ray->dir_z[i] = (float)d.z;
    ray->tnear[i] = 0.0f;
    ray->tfar[i] = INFINITY;
    ray->time[i] = (float)time;
    ray->mask[i] = ~0u;
    ray->id[i] = (unsigned)i;
    ray->flags[i] = 0;
    rayhit->hit.geomID[i] = rayhit->hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
}

void lc_accel_intersect_packet(const lc_accel *accel, const lc_scene *scene, const lc_ray rays[LC_PACKET],
                               lc_hit hits[LC_PACKET])
{
    query q[LC_PACKET];
    double skipped[LC_PACKET];
    RTC_ALIGN(32) int valid[LC_PACKET];
    struct RTCRayHit8 rayhit;
    for (int i = 0; i < LC_PACKET; ++i) {
        const lc_ray *ray = &rays[i];
        if (!accel->has_packets) {
            hits[i].valid = lc_accel_intersect(accel, scene, ray->o, ray->d, ray->time, -1, &hits[i]);
            continue;
        }
        lc_vec3 start = to_unit(accel, ray->o);
        valid[i] = enter(&start, &skipped[i], ray->d) ? -1 : 0;
        fill_packet(&rayhit, i, start, ray->d, ray->time);
        start_query(&q[i], accel, start, ray->d, INFINITY, ray->time, -1, -1);
    }
    if (!accel->has_packets)
        return;
    trace_packet(accel, valid, &rayhit, q);
    for (int i = 0; i < LC_PACKET; ++i)
        hits[i].valid = finish(accel, scene, rays[i].o, rays[i].d, rays[i].time, rayhit.hit.geomID[i], rayhit.hit.primID[i], &q[i],
                               skipped[i], &hits[i]);
}

int lc_accel_occluded(const lc_accel *accel, const lc_scene *scene, lc_vec3 o, int from_part, lc_vec3 target,
                      int to_part, lc_vec3 to_n, int to_infinity, double time)
{
    query q;
    struct RTCRay ray;
    lc_vec3 a = to_unit(accel, o);
    if (to_infinity) {
        start_query(&q, accel, a, target, INFINITY, time, from_part, -1);
        fill_ray(&ray, off_face(accel, scene, a, time, from_part, target, 0.0), target, INFINITY, time);
    } else {
        lc_vec3 b = to_unit(accel, target), along = lc_sub(b, a);
        double length = accel->round_count ? lc_length(along) : 1.0;
        if (!(lc_dot(along, along) > 0))
            return 0;
        start_query(&q, accel, a, lc_scale(1.0 / length, along), length, time, from_part, to_part);
        /* Embree reaches the end as o + d, each rounded: that, too, must stay on the near side of the light. */
        double rounding = 2 * 0x1p-24 *
                          (fabs(to_n.x) * (fabs(a.x) + fabs(along.x)) + fabs(to_n.y) * (fabs(a.y) + fabs(along.y)) +
                           fabs(to_n.z) * (fabs(a.z) + fabs(along.z)));
        lc_vec3 start = off_face(accel, scene, a, time, from_part, along, 0.0);
        lc_vec3 end = off_face(accel, scene, b, time, to_part, lc_neg(along), rounding);
        fill_ray(&ray, start, lc_sub(end, start), 1.0, time);
    }
#if LC_EMBREE == 4
    struct RTCOccludedArguments args;
    rtcInitOccludedArguments(&args);
    args.context = &q.base;
    rtcOccluded1(accel->scene, &ray, &args);
#else
    rtcOccluded1(accel->scene, &q.base, &ray);
#endif
    return ray.tfar < 0;
}
