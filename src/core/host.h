/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * host.h: the other side of lightcheck.h, for the harness and the command line; an estimator never sees it.
 *
 * A scene is first a description (plain data: readable, transformable, exportable), then built into something that
 * can be traced. An image is a film of moments, which knows its own error.
 */
#ifndef LC_HOST_H
#define LC_HOST_H

#include <stddef.h>
#include <stdint.h>

#include "lightcheck.h"

#define LC_VERSION "0.1.0"

/* ---- status ---------------------------------------------------------------------------------------- */

/* The values are the program's exit codes. */
typedef enum lc_status {
    LC_OK = 0,
    LC_WRONG = 1,     /* something was shown wrong */
    LC_BAD_INPUT = 2, /* usage, scene, file content */
    LC_UNDECIDED = 3, /* the samples ran out */
    LC_FAULT = 4      /* I/O, memory, our own fault */
} lc_status;

/* Why a call failed, for a person: "scenes/x.xml:12: unknown shape 'torus'; supported: ...". No full stop, no newline. */
typedef struct lc_error {
    char text[1024];
} lc_error;

/* Writes the message and returns `status`, so that a caller can `return lc_fail(...)`. `err` may be NULL. */
lc_status lc_fail(lc_error *err, lc_status status, const char *format, ...)
#ifdef __GNUC__
    __attribute__((format(printf, 3, 4)))
#endif
    ;

/* ---- affine maps ------------------------------------------------------------------------------------ */

/* x -> m[i][0..2] x + m[i][3]. */
typedef struct lc_affine {
    double m[3][4];
} lc_affine;

lc_affine lc_affine_identity(void);
lc_affine lc_affine_multiply(const lc_affine *a, const lc_affine *b); /* a after b */
int lc_affine_invert(lc_affine *out, const lc_affine *a);             /* 0 when singular */
double lc_affine_determinant(const lc_affine *a);
lc_vec3 lc_affine_point(const lc_affine *a, lc_vec3 p);
lc_vec3 lc_affine_vector(const lc_affine *a, lc_vec3 v);

/* ---- description of a scene -------------------------------------------------------------------------- */

/* A colour over a surface: constant, or Mitsuba's checkerboard over (u, v), which after scale and offset shows `color[0]` where
 * the fractional parts of u and v lie both above or both at or below 1/2, else `color[1]`. */
typedef struct lc_texture {
    int is_checkerboard;
    lc_rgb color[2]; /* constant: color[0] */
    double scale[2], offset[2];
} lc_texture;

/* What one side of a surface does; the lobes add up. */
typedef struct lc_side {
    lc_texture diffuse; /* albedo, times the lobe's share in a blend */
    lc_rgb mirror;      /* reflectance, times its share */
    double glass;       /* share of the dielectric lobe */
    lc_rgb glossy;      /* reflectance of the rough mirror's facets, times its share */
    double alpha;       /* their roughness, in (0, 1]; 0 where there are none */
} lc_side;

typedef struct lc_material_desc {
    char id[64];             /* "" when it has none */
    int line;                /* in the scene's file */
    lc_side side[2];         /* front (where the normal points), back */
    double int_ior, ext_ior; /* of the glass lobe: behind and before the surface */
} lc_material_desc;

/* Every shape is the image of a standard one (Mitsuba's) under an affine map.
 * RECTANGLE [-1, 1]^2 at z = 0, normal +z.  DISK radius 1 at z = 0, normal +z.  CUBE [-1, 1]^3.  SPHERE radius 1, outward. */
typedef enum lc_shape_kind { LC_RECTANGLE, LC_DISK, LC_CUBE, LC_SPHERE } lc_shape_kind;

typedef struct lc_shape_desc {
    lc_shape_kind kind;
    lc_affine to_world; /* a sphere's: rotation, uniform scale and translation only; of a moving shape, at time 0 */
    lc_vec3 motion;     /* how far it has moved, straight and evenly, at time 1 [m] */
    int flip_normals;
    int material;        /* index into materials */
    int emits;           /* 1: an area light, */
    lc_texture radiance; /* of this radiance [W sr^-1 m^-2], on the side of the normal */
    int line;
} lc_shape_desc;

typedef struct lc_point_desc {
    lc_vec3 position;
    lc_rgb intensity; /* W/sr */
    int line;
} lc_point_desc;

typedef struct lc_directional_desc {
    lc_vec3 direction; /* unit, in which the light travels */
    lc_rgb irradiance; /* of a surface that faces it [W m^-2] */
    int line;
} lc_directional_desc;

typedef enum lc_fov_axis { LC_FOV_X, LC_FOV_Y, LC_FOV_DIAGONAL, LC_FOV_SMALLER, LC_FOV_LARGER } lc_fov_axis;

/* Mitsuba's perspective camera, or with an aperture its thinlens: looks along local +z, up is +y, image right is local -x. */
typedef struct lc_camera_desc {
    lc_affine to_world; /* rigid */
    double fov;         /* whole angle along fov_axis [degrees], in (0, 180) */
    lc_fov_axis fov_axis;
    double near_clip, far_clip; /* along the viewing axis [m]; 0 and INFINITY when not given */
    double aperture_radius;     /* of the lens [m], 0: a pinhole */
    double focus_distance;      /* along the viewing axis, to the plane that is sharp [m]; > 0 where there is a lens */
} lc_camera_desc;

typedef struct lc_scene_desc {
    char name[64]; /* the file's stem */
    lc_material_desc *materials;
    lc_shape_desc *shapes;
    lc_point_desc *points;
    lc_directional_desc *directionals;
    int material_count, shape_count, point_count, directional_count;
    int has_sky;
    lc_rgb sky; /* radiance from every direction [W sr^-1 m^-2] */
    lc_camera_desc camera;
    int width, height; /* pixels */
    int samples;       /* a pixel, by default */
    int max_bounces;   /* by default; -1 when the file does not say */
} lc_scene_desc;

/* An empty description with a default camera (Mitsuba's), 64x64 pixels, 16 samples; owns its arrays. */
void lc_scene_desc_init(lc_scene_desc *desc);
void lc_scene_desc_release(lc_scene_desc *desc);
lc_status lc_scene_desc_copy(lc_scene_desc *out, const lc_scene_desc *desc, lc_error *err);
/* Each appends one zeroed element and returns it (valid until the next append), or NULL without memory. */
lc_material_desc *lc_scene_desc_add_material(lc_scene_desc *desc);
lc_shape_desc *lc_scene_desc_add_shape(lc_scene_desc *desc);
lc_point_desc *lc_scene_desc_add_point(lc_scene_desc *desc);
lc_directional_desc *lc_scene_desc_add_directional(lc_scene_desc *desc);

lc_texture lc_texture_constant(lc_rgb color);
lc_rgb lc_texture_at(const lc_texture *texture, double u, double v);

enum { LC_MAX_SIZE = 16384 }; /* largest width or height */

/* ---- a scene that can be traced ------------------------------------------------------------------------ */

/* Checks the description and builds the scene, which keeps a copy of it. One thread. */
lc_status lc_scene_build(lc_scene **out, const lc_scene_desc *desc, lc_error *err);
void lc_scene_free(lc_scene *scene);
const lc_scene_desc *lc_scene_description(const lc_scene *scene);
unsigned lc_scene_lobes(const lc_scene *scene);       /* LC_DIFFUSE | ... that occur */
unsigned lc_scene_emitters(const lc_scene *scene);    /* LC_AREA | ... that occur and are not black */
double lc_scene_emitting_area(const lc_scene *scene); /* m^2 */

/* The first hit of a ray, or a miss (valid = 0, wo and time set). */
void lc_intersect(const lc_scene *scene, const lc_ray *ray, lc_hit *hit);

/* The ray through (x, y) of an image of width x height pixels, x to the right and y downwards from the upper left corner; it starts
 * at the near clip, at time 0. Of a lens, the ray through its centre. */
lc_ray lc_camera_ray(const lc_camera_desc *camera, int width, int height, double x, double y);
/* What that ray sees first: like lc_intersect, but a hit beyond the far clip is a miss. */
void lc_camera_see(const lc_scene *scene, const lc_ray *ray, lc_hit *hit);

/* ---- sampler --------------------------------------------------------------------------------------------- */

/* Philox4x32-10 (Salmon, Moraes, Dror, Shaw: Parallel random numbers: as easy as 1, 2, 3; SC11), keyed by the seed; the counter is
 * (dimension / 4, pixel, sample, arm). Nothing else enters: the same five numbers give the same bits anywhere. */
struct lc_sampler {
    uint64_t seed;
    uint32_t arm, pixel, sample, dimension;
    uint32_t block[4], loaded;      /* numbers of block `loaded` */
    const struct lc_trace_log *log; /* NULL: nobody listens */
};

enum { LC_DIMENSION_CAMERA = 0, LC_DIMENSION_TIME = 4, LC_DIMENSION_ESTIMATOR = 8 };

void lc_sampler_start(lc_sampler *sampler, uint64_t seed, uint32_t arm, uint32_t pixel, uint32_t sample);
void lc_sampler_seek(lc_sampler *sampler, uint32_t dimension);
/* The stream of an estimator: a 32-bit hash of its name. Two names, two streams. */
uint32_t lc_arm(const char *name);

/* FNV-1a, 64 bits, of bytes (Fowler, Noll, Vo; draft-eastlake-fnv): goes on from `hash`, which begins as LC_HASH. For tables and to tell
 * versions apart, never against an adversary. */
#define LC_HASH 0xcbf29ce484222325u
uint64_t lc_hash(uint64_t hash, const void *bytes, size_t size);

/* ---- film --------------------------------------------------------------------------------------------------- */

enum { LC_BLOCK = 64 }; /* samples of a batch; films grow bit-exactly at multiples of it */

/* A larger sample is bad, like an infinite one: what is made of samples goes up to the square of a variance, and the sum of those over an
 * image must stay finite. */
#define LC_LARGEST_SAMPLE 1e60

typedef struct lc_moments {
    double mean;                 /* of the samples */
    double m2;                   /* sum of (x - mean)^2 */
    double m3;                   /* sum of (x - mean)^3 */
    double max;                  /* largest sample */
    double batch_mean, batch_m2; /* mean and sum of squares of the means of whole batches of LC_BLOCK samples */
} lc_moments;

typedef struct lc_pixel {
    uint64_t n;       /* samples */
    uint64_t batches; /* whole batches among them */
    lc_moments c[3];  /* R G B */
} lc_pixel;

enum { LC_MAX_SHARDS = 1024 };

/* Samples [first, first + count) of one stream. */
typedef struct lc_range {
    uint64_t seed;
    uint32_t arm;
    uint64_t first, count;
} lc_range;

typedef struct lc_film {
    int width, height;
    lc_pixel *pixels; /* row by row from the top */
    int has_third;    /* 0: m3, max and the batches are unknown (0). From a file, max and the batches always are */
    char scene[64], estimator[64];
    uint64_t seed;
    uint32_t arm;
    uint64_t first, count; /* sample indices [first, first + count) */
    int min_bounces, max_bounces;
    lc_range *more; /* further ranges that were merged in, NULL when none; owned by the film */
    int more_count;
    int shard, shards; /* shard of shards, 0 <= shard < shards <= LC_MAX_SHARDS; 0 of 1 is everything */
    uint64_t pasted[LC_MAX_SHARDS / 64]; /* bit i: shard i is here too; all 0 while `shard` is the only one */
    uint64_t bad;                        /* NaN, infinite, negative or huge samples: any is fatal to a check */
    int bad_x, bad_y;                    /* where the first (by pixel, then sample) was seen */
    uint64_t bad_sample;
    double bad_value[3];
    int bad_term;                        /* 0: over the scene itself; i: over term i - 1 of lc_render_options' minus. Not kept in files */
} lc_film;

/* A black film without samples, shard 0 of 1; width and height in [1, LC_MAX_SIZE], else LC_BAD_INPUT. */
lc_status lc_film_create(lc_film **out, int width, int height, lc_error *err);
void lc_film_free(lc_film *film);
/* Adds a block of 1..LC_BLOCK consecutive samples of one pixel; exact merging of central moments (Pebay 2008, SAND2008-6212). */
void lc_pixel_add(lc_pixel *pixel, const double (*samples)[3], int count);
/* Central moments of the union of two disjoint sets; a side with n = 0 adds nothing. */
void lc_pixel_merge(lc_pixel *into, const lc_pixel *from);
/* Variance of the mean, m2 / (n (n - 1)); 0 for n < 2. */
double lc_pixel_variance(const lc_pixel *pixel, int channel);
/* Pastes shards of one render (with the last of them it is 0 of 1), or averages whole renders of different streams or
 * ranges, weighted by n. LC_BAD_INPUT, and `into` untouched, for different sizes, scenes, estimators or bounces, a
 * shard or sample that both have, a film of unknown samples (count = 0). Third moments survive only when both have them; max
 * and batches mean something only when neither came from a file. */
lc_status lc_film_merge(lc_film *into, const lc_film *from, lc_error *err);
/* Tiles of LC_TILE^2 pixels, row by row, are what threads and shards share out. Tile t belongs to shard t mod shards. */
enum { LC_TILE = 8 };

/* ---- render ---------------------------------------------------------------------------------------------------- */

/* What the same estimator gives over another scene, from the same random numbers. */
typedef struct lc_term {
    const lc_scene *scene;
    double factor; /* of it */
    int shift;     /* its bounces are this many fewer */
} lc_term;

enum { LC_MAX_TERMS = 8 };

typedef struct lc_render_options {
    int min_bounces, max_bounces;
    uint64_t seed;
    uint32_t arm;
    uint64_t first, count;                     /* sample indices */
    int threads;                               /* 0: one a core */
    int shard, shards;                         /* shards = 0 or 1: everything */
    const lc_term *minus;                      /* each sample less the sum of these: such a film may be negative */
    int minus_count;                           /* at most LC_MAX_TERMS; 0: nothing is taken off */
    int costs;                                 /* 1: the film has what each sample cost in place of its radiance: see lc_cost_of */
    void (*progress)(void *user, double done); /* may be NULL; 0..1, ends with 1; from one thread */
    void *user;
} lc_render_options;

/* What the sample that lc_render makes in this thread has cost so far, where it asks for costs: (rays, random numbers, 0). Rays are lc_trace()'s
 * and lc_visible()'s, the camera's not among them; numbers those that the estimator drew, by lc_next() or through a function that draws. */
lc_rgb lc_cost_of(const lc_sampler *sampler);

/* Adds samples [first, first + count) of every pixel (of the shard) to the film. The result depends on scene, estimator, options but not on
 * the number of threads. The film's size decides the image's. */
lc_status lc_render(lc_film *film, const lc_scene *scene, const lc_estimator *estimator,
                    const lc_render_options *options, lc_error *err);

/* An estimator whose samples are made elsewhere, by another process. lc_render, that is all of the harness, takes it for any other, as long as
 * it is handed on by pointer: lc_render knows it by its function, and gets the samples from `fill`, which hands over each sample of the
 * options once by lc_film_put, or fails, LC_WRONG where the estimator is at fault. The film is then spoilt. */
typedef struct lc_outside {
    lc_estimator estimator; /* radiance: lc_radiance_outside */
    lc_status (*fill)(void *user, lc_film *film, const lc_scene *scene, const lc_render_options *options, lc_error *err);
    void *user;
} lc_outside;

lc_radiance_fn lc_radiance_outside; /* NAN: nobody can call it */

/* For `fill`: samples first, ... of a pixel (counted row by row): LC_BLOCK of them at once, fewer only at the end of what
 * is asked for, in ascending order; each is that of the scene, then those of the terms. Bad ones are counted. One thread. */
void lc_film_put(lc_film *film, const lc_render_options *options, uint32_t pixel, uint64_t first,
                 const double (*samples)[3], int count);

/* ---- replay: one sample, told step by step ------------------------------------------------------------------------ */

typedef struct lc_trace_log {
    void (*line)(void *user, const char *text); /* one event, no newline */
    void *user;
} lc_trace_log;

/* The radiance of one sample, exactly as lc_render sees it; each draw, hit, light sample and value goes to the log. One thread. */
lc_rgb lc_replay(lc_scene *scene, const lc_estimator *estimator, const lc_render_options *options, int width,
                 int height, int x, int y, uint64_t sample, const lc_trace_log *log);

#endif
