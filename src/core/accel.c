/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The only file that knows Embree (3.13 or 4).
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
#include <float.h>
#include <stdlib.h>
#include <string.h>

#if LC_EMBREE == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "core/round_c.h"

enum { FACES = 0, ROUNDS = 1 }; /* Embree's geometry IDs */

/* Rounding errors in float units (2^-24) that a face's offset covers: vertex, origin and about six operations of the test. */
#define SAFETY (8 * 0x1p-24)
#define LEAST_OFFSET 0x1p-40

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
    float (*vertices)[3]; /* four a face, in Embree's hands */
    unsigned (*quads)[4];
    face_start *starts; /* of each face */
    lc_round *rounds;   /* in unit space */
    int face_count, round_count;
    int moves; /* 1: geometry has two time steps, and a query its time */
};

/* What the callbacks for round parts need besides Embree's ray: the ray in double, in unit space. */
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

static void round_bounds(const struct RTCBoundsFunctionArguments *args)
{
    const lc_round *round = &((const lc_accel *)args->geometryUserPtr)->rounds[args->primID];
    double lower[3], upper[3];
    lc_vec3 at = lc_add(round->o, lc_scale(args->timeStep, round->motion));
    const double o[3] = {at.x, at.y, at.z};
    const double eu[3] = {round->eu.x, round->eu.y, round->eu.z}, ev[3] = {round->ev.x, round->ev.y, round->ev.z};
    for (int i = 0; i < 3; ++i) {
        double extent = round->is_sphere ? round->radius : hypot(eu[i], ev[i]);
        extent += 4 * 0x1p-24 * (fabs(o[i]) + extent) + LEAST_OFFSET; /* outwards, also after rounding */
        lower[i] = o[i] - extent;
        upper[i] = o[i] + extent;
    }
    struct RTCBounds *bounds = args->bounds_o;
    bounds->lower_x = (float)lower[0];
    bounds->lower_y = (float)lower[1];
    bounds->lower_z = (float)lower[2];
    bounds->upper_x = (float)upper[0];
    bounds->upper_y = (float)upper[1];
    bounds->upper_z = (float)upper[2];
}

static void round_intersect(const struct RTCIntersectFunctionNArguments *args)
{
    query *q = (query *)args->context;
    if (args->valid[0] == 0)
        return;
    struct RTCRayHit *rayhit = (struct RTCRayHit *)args->rayhit; /* N is 1: rtcIntersect1 */
    double t = meet(q, (int)args->primID);
    if (t < 0 || (float)t >= rayhit->ray.tfar)
        return;
    rayhit->ray.tfar = (float)t;
    rayhit->hit.geomID = ROUNDS;
    rayhit->hit.primID = args->primID;
    q->t_max = t;
    q->hit = (int)args->primID;
    q->t = t;
}

static void round_occluded(const struct RTCOccludedFunctionNArguments *args)
{
    const query *q = (const query *)args->context;
    if (args->valid[0] != 0 && meet(q, (int)args->primID) >= 0)
        ((struct RTCRay *)args->ray)->tfar = -INFINITY;
}

/* ---- building ---------------------------------------------------------------------------------------- */

static lc_vec3 to_unit(const lc_accel *accel, lc_vec3 p) { return lc_scale(accel->scale, lc_sub(p, accel->center)); }

static void grow(double lower[3], double upper[3], lc_vec3 p)
{
    const double x[3] = {p.x, p.y, p.z};
    for (int i = 0; i < 3; ++i) {
        lower[i] = fmin(lower[i], x[i]);
        upper[i] = fmax(upper[i], x[i]);
    }
}

static lc_vec3 corner(const lc_face *face, int i)
{
    double u = i == 1 || i == 2 ? 1.0 : -1.0, v = i >= 2 ? 1.0 : -1.0;
    return lc_add(face->o, lc_add(lc_scale(u, face->eu), lc_scale(v, face->ev)));
}

static void find_unit_space(lc_accel *accel, const lc_scene *scene)
{
    double lower[3] = {DBL_MAX, DBL_MAX, DBL_MAX}, upper[3] = {-DBL_MAX, -DBL_MAX, -DBL_MAX};
    for (int f = 0; f < scene->face_count; ++f)
        for (int i = 0; i < 4; ++i) {
            lc_vec3 p = corner(&scene->faces[f], i);
            grow(lower, upper, p);
            grow(lower, upper, lc_add(p, lc_shape_shift(scene, scene->faces[f].shape, 1)));
        }
    for (int r = 0; r < scene->round_count; ++r) {
        const lc_round *round = &scene->rounds[r];
        lc_vec3 e = round->is_sphere ? lc_vec(round->radius, round->radius, round->radius)
                                     : lc_vec(hypot(round->eu.x, round->ev.x), hypot(round->eu.y, round->ev.y),
                                              hypot(round->eu.z, round->ev.z));
        grow(lower, upper, lc_sub(round->o, e));
        grow(lower, upper, lc_add(round->o, e));
        grow(lower, upper, lc_add(lc_sub(round->o, e), round->motion));
        grow(lower, upper, lc_add(lc_add(round->o, e), round->motion));
    }
    accel->center = lc_vec(0, 0, 0);
    accel->scale = 1.0;
    double half = 0.0;
    for (int i = 0; i < 3; ++i)
        half = fmax(half, (upper[i] - lower[i]) / 2);
    if (!(half > 0))
        return; /* no shapes */
    int exponent;
    frexp(half, &exponent); /* half <= 2^exponent */
    accel->scale = ldexp(1.0, -exponent);
    accel->center = lc_vec((lower[0] + upper[0]) / 2, (lower[1] + upper[1]) / 2, (lower[2] + upper[2]) / 2);
}

/* Bound of what rounding does to a point of the face across a plane whose normal has components of these sizes, in unit space. */
static double rounding_across(const lc_accel *accel, const lc_face *face, lc_vec3 motion, double x, double y, double z)
{
    lc_vec3 o = to_unit(accel, face->o);
    const double weight[3] = {x, y, z}, at[3] = {fabs(o.x), fabs(o.y), fabs(o.z)};
    const double extent[3] = {fabs(face->eu.x) + fabs(face->ev.x), fabs(face->eu.y) + fabs(face->ev.y),
                              fabs(face->eu.z) + fabs(face->ev.z)};
    const double moved[3] = {fabs(motion.x), fabs(motion.y), fabs(motion.z)}; /* adds to |o|; two roundings more */
    double sum = 0.0;
    for (int i = 0; i < 3; ++i)
        sum += weight[i] * (at[i] + 3 * accel->scale * (extent[i] + moved[i]));
    return SAFETY * sum + LEAST_OFFSET;
}

static face_start find_start(const lc_accel *accel, const lc_face *face, lc_vec3 motion)
{
    lc_vec3 n = face->n;
    double edge = 4 * rounding_across(accel, face, motion, 1, 1, 1) / accel->scale; /* the neighbour may stand at any angle */
    face_start start;
    start.offset = rounding_across(accel, face, motion, fabs(n.x), fabs(n.y), fabs(n.z));
    start.u = fmax(0.0, 1.0 - edge * lc_length(face->du));
    start.v = fmax(0.0, 1.0 - edge * lc_length(face->dv));
    return start;
}

/* The faces at time 1; Embree moves them straight and evenly. */
static void add_last_step(const lc_accel *accel, const lc_scene *scene, RTCGeometry geometry)
{
    size_t count = (size_t)scene->face_count;
    float(*vertices)[3] =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 1, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 4 * count);
    for (size_t v = 0; vertices && v < 4 * count; ++v) {
        const lc_face *face = &scene->faces[v / 4];
        lc_vec3 p = lc_add(corner(face, (int)(v % 4)), lc_shape_shift(scene, face->shape, 1));
        p = to_unit(accel, p);
        vertices[v][0] = (float)p.x;
        vertices[v][1] = (float)p.y;
        vertices[v][2] = (float)p.z;
    }
}

static void add_faces(lc_accel *accel, const lc_scene *scene)
{
    RTCGeometry geometry = rtcNewGeometry(accel->device, RTC_GEOMETRY_TYPE_QUAD);
    size_t count = (size_t)scene->face_count;
    rtcSetGeometryTimeStepCount(geometry, scene->moves ? 2 : 1);
    accel->vertices =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 4 * count);
    accel->quads =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 4 * sizeof(unsigned), count);
    for (size_t f = 0; accel->vertices && accel->quads && f < count; ++f) {
        lc_vec3 motion = lc_shape_shift(scene, scene->faces[f].shape, 1);
        accel->starts[f] = find_start(accel, &scene->faces[f], motion);
        for (unsigned i = 0; i < 4; ++i) {
            lc_vec3 p = to_unit(accel, corner(&scene->faces[f], (int)i));
            float *vertex = accel->vertices[4 * f + i];
            vertex[0] = (float)p.x;
            vertex[1] = (float)p.y;
            vertex[2] = (float)p.z;
            accel->quads[f][i] = (unsigned)(4 * f + i);
        }
    }
    if (scene->moves)
        add_last_step(accel, scene, geometry);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(accel->scene, geometry, FACES);
    rtcReleaseGeometry(geometry);
}

static void add_rounds(lc_accel *accel, const lc_scene *scene)
{
    for (int r = 0; r < scene->round_count; ++r) {
        lc_round *round = &accel->rounds[r];
        *round = scene->rounds[r];
        round->o = to_unit(accel, round->o);
        round->radius *= accel->scale;
        round->motion = lc_scale(accel->scale, round->motion);
        round->eu = lc_scale(accel->scale, round->eu);
        round->ev = lc_scale(accel->scale, round->ev);
        round->du = lc_scale(1.0 / accel->scale, round->du);
        round->dv = lc_scale(1.0 / accel->scale, round->dv);
    }
    RTCGeometry geometry = rtcNewGeometry(accel->device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryTimeStepCount(geometry, scene->moves ? 2 : 1);
    rtcSetGeometryUserPrimitiveCount(geometry, (unsigned)scene->round_count);
    rtcSetGeometryUserData(geometry, accel);
    rtcSetGeometryBoundsFunction(geometry, round_bounds, NULL);
    rtcSetGeometryIntersectFunction(geometry, round_intersect);
    rtcSetGeometryOccludedFunction(geometry, round_occluded);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(accel->scene, geometry, ROUNDS);
    rtcReleaseGeometry(geometry);
}

lc_status lc_accel_build(lc_accel **out, const lc_scene *scene, lc_error *err)
{
    lc_accel *accel = calloc(1, sizeof *accel);
    *out = NULL;
    if (!accel)
        return lc_fail(err, LC_FAULT, "out of memory for the accelerator");
    accel->face_count = scene->face_count;
    accel->round_count = scene->round_count;
    accel->moves = scene->moves;
    accel->starts = calloc((size_t)scene->face_count + 1, sizeof *accel->starts);
    accel->rounds = calloc((size_t)scene->round_count + 1, sizeof *accel->rounds);
    /* One thread: the tree must not depend on who built which branch first. */
    accel->device = rtcNewDevice("threads=1,set_affinity=0");
    if (!accel->starts || !accel->rounds || !accel->device) {
        lc_accel_free(accel);
        return lc_fail(err, LC_FAULT, "cannot make an Embree device");
    }
    find_unit_space(accel, scene);
    accel->scene = rtcNewScene(accel->device);
    rtcSetSceneFlags(accel->scene, RTC_SCENE_FLAG_ROBUST);
    if (scene->face_count)
        add_faces(accel, scene);
    if (scene->round_count)
        add_rounds(accel, scene);
    rtcCommitScene(accel->scene);
    enum RTCError error = rtcGetDeviceError(accel->device);
    if (error != RTC_ERROR_NONE) {
        lc_accel_free(accel);
        return lc_fail(err, LC_FAULT, "embree cannot build the scene (error %d)", (int)error);
    }
    *out = accel;
    return LC_OK;
}

void lc_accel_free(lc_accel *accel)
{
    if (!accel)
        return;
    if (accel->scene)
        rtcReleaseScene(accel->scene);
    if (accel->device)
        rtcReleaseDevice(accel->device);
    free(accel->starts);
    free(accel->rounds);
    free(accel);
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
    t = fmax(t, 0.0); /* in a corner, rounding may put `o` a hair behind the neighbour */
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

int lc_accel_intersect(const lc_accel *accel, const lc_scene *scene, lc_vec3 o, lc_vec3 d, double time, int from_part,
                       lc_hit *hit)
{
    lc_vec3 start = to_unit(accel, o);
    double skipped = 0.0, reach = lc_dot(start, start);
    if (reach > 16.0 &&
        from_part < 0) { /* a far camera: enter the ball of radius 4 in double, or float rounding would show */
        double b = lc_dot(start, d), discriminant = b * b - reach + 16.0;
        if (b >= 0 || discriminant < 0)
            return 0;
        skipped = -b - sqrt(discriminant);
        start = lc_add(start, lc_scale(skipped, d));
    }
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
    int is_face = rayhit.hit.geomID == FACES;
    if (!is_face && rayhit.hit.geomID != ROUNDS)
        return 0;
    lc_vec3 rest = o, shift = lc_vec(0, 0, 0); /* where the ray is when the shape is moved back to time 0 */
    hit->part = is_face ? (int)rayhit.hit.primID : accel->face_count + q.hit;
    if (scene->moves) {
        shift = lc_shape_shift(scene, is_face ? scene->faces[hit->part].shape : scene->rounds[q.hit].shape, time);
        rest = lc_sub(o, shift);
    }
    if (is_face)
        finish_face(&scene->faces[hit->part], rest, d, hit);
    else
        finish_round(&scene->rounds[q.hit], rest, d, (q.t + skipped) / accel->scale, hit);
    if (scene->moves)
        hit->p = lc_add(hit->p, shift);
    return 1;
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
        double length = lc_length(along);
        if (!(length > 0))
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
