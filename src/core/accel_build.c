/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Building what accel.c asks: its head says why all is as it is.
 */
#include <float.h>
#include <stdlib.h>

#include "core/accel_c.h"

/* Rounding errors in float units (2^-24) that a face's offset covers: vertex, origin and about six operations of the test. */
#define SAFETY (8 * 0x1p-24)
#define LEAST_OFFSET 0x1p-40

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
    rtcSetGeometryIntersectFunction(geometry, lc_accel_round_intersect);
    rtcSetGeometryOccludedFunction(geometry, lc_accel_round_occluded);
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
    /* Not 16: vectors of 512 bits slow down what comes after them by more than they save. */
    accel->has_packets = rtcGetDeviceProperty(accel->device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0;
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
