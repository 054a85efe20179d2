/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Private to src/core: what a built scene is made of.
 */
#ifndef LC_SCENE_C_H
#define LC_SCENE_C_H

#include "core/host.h"

/* A parallelogram o + u eu + v ev, |u|, |v| <= 1: a rectangle, or one side of a cube. */
typedef struct lc_face {
    lc_vec3 o, eu, ev;
    lc_vec3 n;      /* unit, flips applied */
    lc_vec3 du, dv; /* dual of eu, ev: u = du . (p - o) */
    double area;    /* m^2 */
    int shape;
} lc_face;

/* A disk o + u eu + v ev, u^2 + v^2 <= 1, or a sphere of this radius around o. */
typedef struct lc_round {
    int is_sphere;
    lc_vec3 o, eu, ev, n, du, dv; /* as above (disk); the columns of a sphere's rotation in eu, ev, n */
    double radius, sign;          /* sphere; sign = -1 when its normals are flipped inwards */
    double area;
    lc_vec3 motion; /* to time 1 */
    int shape;
} lc_round;

/* How a shape is stored: `count` faces from `first`, or the round one `first`. A part is numbered as in the accelerator:
 * faces from 0, then the round ones. */
typedef struct lc_shape {
    int is_round, first, count;
    double area;
} lc_shape;

typedef enum lc_light_kind { LC_LIGHT_AREA, LC_LIGHT_POINT, LC_LIGHT_DIRECTIONAL } lc_light_kind;

typedef struct lc_light {
    lc_light_kind kind;
    int index; /* into shapes, points or directionals of the description */
} lc_light;

struct lc_scene {
    lc_scene_desc desc;
    lc_shape *shapes;
    lc_face *faces;
    lc_round *rounds;
    int face_count, round_count;
    lc_light *lights;
    int light_count;
    double *area_to; /* emitting area of lights 0..i: area_to[light_count - 1] is the total */
    struct lc_accel *accel;
    unsigned lobes, emitters;
    int moves; /* 1: some shape does; all that asks for the time stands behind this */
    const lc_trace_log *log; /* NULL but in a replay */
};

/* How far a shape has moved at `time`. Faces and round parts are stored as at time 0: what is done with a point of one, or with a ray that
 * meets it, is done there, after moving the point back. */
static inline lc_vec3 lc_shape_shift(const lc_scene *scene, int shape, double time)
{
    return lc_scale(time, scene->desc.shapes[shape].motion);
}
static inline lc_vec3 lc_rest_point(const lc_scene *scene, const lc_hit *hit)
{
    return scene->moves ? lc_sub(hit->p, lc_shape_shift(scene, hit->shape, hit->time)) : hit->p;
}

/* accel.c, the only file that knows Embree. */
typedef struct lc_accel lc_accel;
lc_status lc_accel_build(lc_accel **out, const lc_scene *scene, lc_error *err);
void lc_accel_free(lc_accel *accel);
/* The first hit from `o` along unit `d`; `from_part` is the part it starts on, or -1. Fills p, n, distance, shape, part. */
int lc_accel_intersect(const lc_accel *accel, const lc_scene *scene, lc_vec3 o, lc_vec3 d, double time, int from_part,
                       lc_hit *hit);
/* The same for rays of a camera through one pixel, at a third of the cost; sets valid, too. In doubt, at an edge, a ray may fall otherwise
 * than alone, but never otherwise than in this packet. */
enum { LC_PACKET = 8 };
void lc_accel_intersect_packet(const lc_accel *accel, const lc_scene *scene, const lc_ray rays[LC_PACKET],
                               lc_hit hits[LC_PACKET]);
/* Whether something lies strictly between `o` and `q` (q on part `to_part` with normal to_n, or -1), or along unit `q` to infinity. */
int lc_accel_occluded(const lc_accel *accel, const lc_scene *scene, lc_vec3 o, int from_part, lc_vec3 q, int to_part,
                      lc_vec3 to_n, int to_infinity, double time);

/* camera.c: the image plane at distance 1, so that a ray is two multiplications away. */
typedef struct lc_camera_frame {
    lc_vec3 eye, corner, right, down; /* the upper left corner, and one pixel's steps, as seen from the eye */
    double near_clip;
    lc_vec3 lens_x, lens_y; /* two radii of the lens, across the axis; 0 of a pinhole */
    double focus;           /* depth of the plane that is sharp; 0 of a pinhole */
    int moves;              /* of the scene: rays need a time */
} lc_camera_frame;
void lc_camera_prepare(lc_camera_frame *frame, const lc_camera_desc *camera, int width, int height);
lc_ray lc_camera_frame_ray(const lc_camera_frame *frame, double x, double y);
/* A ray through pixel (x, y), uniform over its square, over the lens and over time. Draws from the camera's dimensions. */
lc_ray lc_camera_sample(const lc_camera_frame *frame, lc_sampler *sampler, int x, int y);

/* glossy.c: a rough mirror of reflectance 1. Unit n on the side of wo, alpha in (0, 1]; value and density in 1/sr. The density also
 * covers what falls below the horizon, where the value is 0, and so integrates to 1. */
double lc_glossy_value(lc_vec3 n, lc_vec3 wo, lc_vec3 wi, double alpha);
double lc_glossy_pdf(lc_vec3 n, lc_vec3 wo, lc_vec3 wi, double alpha);
lc_vec3 lc_glossy_sample(lc_vec3 n, lc_vec3 wo, double alpha, double u, double v);
/* lc_camera_see() for rays through one pixel. */
void lc_camera_see_packet(const lc_scene *scene, const lc_ray rays[LC_PACKET], lc_hit hits[LC_PACKET]);

/* warp.c */
void lc_tangents(lc_vec3 n, lc_vec3 *s, lc_vec3 *t);
lc_vec3 lc_uniform_sphere(double u, double v);

/* solid_angle.c: fills wi, distance, p, n, pdf_solid, shape and part of a place on the shape, uniform over the directions in which the
 * hit sees it; 0 where that is not known of such a shape. */
int lc_sample_solid(const lc_scene *scene, int index, const lc_hit *hit, double u, double v, lc_light_sample *out);

/* lc_material_at() without a word in the log. */
lc_material lc_surface_material(const lc_scene *scene, const lc_hit *hit);
/* What the front of a shape emits at p, where p is at time 0 [W sr^-1 m^-2]. */
lc_rgb lc_shape_radiance(const lc_scene *scene, int shape, int part, lc_vec3 p);
/* Texture coordinates of a point on a shape at time 0, as Mitsuba 3 has them. */
void lc_shape_uv(const lc_scene *scene, int shape, int part, lc_vec3 p, double *u, double *v);

/* surface.c: this thread's sample begins, and has one ray more. */
void lc_cost_start(void);
void lc_count_ray(void);

void lc_replay_begin(lc_radiance_fn *radiance);
void lc_log_hit(const lc_scene *scene, const char *what, const lc_hit *hit);

void lc_log(const lc_trace_log *log, const char *format, ...)
#ifdef __GNUC__
    __attribute__((format(printf, 2, 3)))
#endif
    ;

#endif
