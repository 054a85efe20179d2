/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The pinhole camera and the thin lens, as Mitsuba 3's `perspective` and `thinlens` define them.
 */
#include "core/scene_c.h"

static double tan_half_fov_x(const lc_camera_desc *camera, double aspect)
{
    double t = tan(camera->fov * (LC_PI / 360.0));
    switch (camera->fov_axis) {
    case LC_FOV_X:
        return t;
    case LC_FOV_Y:
        return t * aspect;
    case LC_FOV_DIAGONAL:
        return t * aspect / sqrt(1.0 + aspect * aspect);
    case LC_FOV_SMALLER:
        return aspect > 1.0 ? t * aspect : t;
    case LC_FOV_LARGER:
        return aspect > 1.0 ? t : t * aspect;
    }
    return t;
}

void lc_camera_prepare(lc_camera_frame *frame, const lc_camera_desc *camera, int width, int height)
{
    double aspect = (double)width / height, t = tan_half_fov_x(camera, aspect);
    frame->eye = lc_affine_point(&camera->to_world, lc_vec(0, 0, 0));
    frame->corner = lc_affine_vector(&camera->to_world, lc_vec(t, t / aspect, 1));
    frame->right = lc_affine_vector(&camera->to_world, lc_vec(-2 * t / width, 0, 0));
    frame->down = lc_affine_vector(&camera->to_world, lc_vec(0, -2 * t / aspect / height, 0));
    frame->near_clip = camera->near_clip;
    frame->lens_x = lc_affine_vector(&camera->to_world, lc_vec(camera->aperture_radius, 0, 0));
    frame->lens_y = lc_affine_vector(&camera->to_world, lc_vec(0, camera->aperture_radius, 0));
    frame->focus = camera->aperture_radius > 0 ? camera->focus_distance : 0;
    frame->moves = 0;
}

lc_ray lc_camera_frame_ray(const lc_camera_frame *frame, double x, double y)
{
    lc_vec3 along = lc_add(frame->corner, lc_add(lc_scale(x, frame->right), lc_scale(y, frame->down)));
    lc_ray ray;
    ray.o = lc_add(frame->eye, lc_scale(frame->near_clip, along));
    ray.d = lc_normalize(along);
    ray.time = 0.0;
    return ray;
}

/* From a point of the lens, uniform over its disk, to where the ray through its centre meets the plane that is sharp. */
static lc_ray lens_ray(const lc_camera_frame *frame, double x, double y, double u, double v)
{
    double r = sqrt(u), phi = 2 * LC_PI * v;
    lc_vec3 offset = lc_add(lc_scale(r * cos(phi), frame->lens_x), lc_scale(r * sin(phi), frame->lens_y));
    lc_vec3 along = lc_add(frame->corner, lc_add(lc_scale(x, frame->right), lc_scale(y, frame->down)));
    along = lc_sub(along, lc_scale(1 / frame->focus, offset)); /* still one metre along the axis */
    lc_ray ray;
    ray.o = lc_add(lc_add(frame->eye, offset), lc_scale(frame->near_clip, along));
    ray.d = lc_normalize(along);
    ray.time = 0.0;
    return ray;
}

lc_ray lc_camera_sample(const lc_camera_frame *frame, lc_sampler *sampler, int x, int y)
{
    double dx = lc_next(sampler), dy = lc_next(sampler);
    if (!(frame->focus > 0) && !frame->moves)
        return lc_camera_frame_ray(frame, x + dx, y + dy);
    double u = 0, v = 0;
    if (frame->focus > 0)
        u = lc_next(sampler), v = lc_next(sampler);
    lc_ray ray = frame->focus > 0 ? lens_ray(frame, x + dx, y + dy, u, v) : lc_camera_frame_ray(frame, x + dx, y + dy);
    if (frame->moves) { /* 24 bits: Embree's float then means the same moment */
        lc_sampler_seek(sampler, LC_DIMENSION_TIME);
        ray.time = floor(lc_next(sampler) * 0x1p24) * 0x1p-24;
    }
    return ray;
}

lc_ray lc_camera_ray(const lc_camera_desc *camera, int width, int height, double x, double y)
{
    lc_camera_frame frame;
    lc_camera_prepare(&frame, camera, width, height);
    return lc_camera_frame_ray(&frame, x, y);
}

static void clip_far(const lc_scene *scene, lc_hit *hit)
{
    const lc_camera_desc *camera = &scene->desc.camera;
    if (!hit->valid || isinf(camera->far_clip))
        return;
    lc_vec3 axis = lc_affine_vector(&camera->to_world, lc_vec(0, 0, 1));
    lc_vec3 eye = lc_affine_point(&camera->to_world, lc_vec(0, 0, 0));
    if (lc_dot(axis, lc_sub(hit->p, eye)) > camera->far_clip)
        hit->valid = 0;
}

void lc_camera_see(const lc_scene *scene, const lc_ray *ray, lc_hit *hit)
{
    lc_intersect(scene, ray, hit);
    clip_far(scene, hit);
}

void lc_camera_see_packet(const lc_scene *scene, const lc_ray rays[LC_PACKET], lc_hit hits[LC_PACKET])
{
    lc_accel_intersect_packet(scene->accel, scene, rays, hits);
    for (int i = 0; i < LC_PACKET; ++i) {
        hits[i].wo = lc_neg(rays[i].d);
        hits[i].time = rays[i].time;
        clip_far(scene, &hits[i]);
    }
}
