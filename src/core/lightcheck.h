/* SPDX-License-Identifier: MIT
 *
 * lightcheck.h: all that an estimator may know.
 *
 * An estimator answers one question: how much radiance comes back along this ray? It gives ONE unbiased
 * random sample of the answer; the host takes the mean of many. A file of yours holds one function and one
 * descriptor; estimators/template.c is the place to start, `lightcheck sample` shows what a sample did.
 *
 * Conventions. Directions are unit vectors. `wo` points to the viewer, `wi` to where the light comes from:
 * both away from the surface. Lengths in metres, radiance in W sr^-1 m^-2, a BSDF in 1/sr, a density
 * over area (`pdf_area`) in 1/m^2, over directions (`pdf_solid`) in 1/sr. Colours are linear, three channels.
 *
 * The host owns self-intersection: rays start from a hit, not from a point, and no epsilon is ever needed.
 * Every function here may be called from any thread, allocates nothing and has no side effects,
 * except that lc_next() moves its sampler on.
 */
#ifndef LIGHTCHECK_H
#define LIGHTCHECK_H

#include <math.h>

#ifdef __cplusplus
extern "C" {
#endif

#define LC_ABI 1 /* version of this interface; a descriptor says which one it was written for */

#define LC_PI 3.14159265358979323846
#define LC_INV_PI 0.31830988618379067154

/* ---- vectors and colours ------------------------------------------------------------------------- */

typedef struct lc_vec3 {
    double x, y, z;
} lc_vec3;

typedef struct lc_rgb {
    double r, g, b;
} lc_rgb;

static inline lc_vec3 lc_vec(double x, double y, double z)
{
    lc_vec3 v;
    v.x = x;
    v.y = y;
    v.z = z;
    return v;
}
static inline lc_vec3 lc_add(lc_vec3 a, lc_vec3 b) { return lc_vec(a.x + b.x, a.y + b.y, a.z + b.z); }
static inline lc_vec3 lc_sub(lc_vec3 a, lc_vec3 b) { return lc_vec(a.x - b.x, a.y - b.y, a.z - b.z); }
static inline lc_vec3 lc_scale(double s, lc_vec3 a) { return lc_vec(s * a.x, s * a.y, s * a.z); }
static inline lc_vec3 lc_neg(lc_vec3 a) { return lc_vec(-a.x, -a.y, -a.z); }
static inline double lc_dot(lc_vec3 a, lc_vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline lc_vec3 lc_cross(lc_vec3 a, lc_vec3 b)
{
    return lc_vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static inline double lc_length(lc_vec3 a) { return sqrt(lc_dot(a, a)); }
static inline lc_vec3 lc_normalize(lc_vec3 a) { return lc_scale(1.0 / lc_length(a), a); }

static inline lc_rgb lc_color(double r, double g, double b)
{
    lc_rgb c;
    c.r = r;
    c.g = g;
    c.b = b;
    return c;
}
static inline lc_rgb lc_black(void) { return lc_color(0, 0, 0); }
static inline lc_rgb lc_rgb_add(lc_rgb a, lc_rgb b) { return lc_color(a.r + b.r, a.g + b.g, a.b + b.b); }
static inline lc_rgb lc_rgb_mul(lc_rgb a, lc_rgb b) { return lc_color(a.r * b.r, a.g * b.g, a.b * b.b); }
static inline lc_rgb lc_rgb_scale(double s, lc_rgb a) { return lc_color(s * a.r, s * a.g, s * a.b); }
static inline double lc_rgb_max(lc_rgb a)
{
    double most = a.g > a.b ? a.g : a.b;
    return a.r > most ? a.r : most;
}

/* ---- the scene: rays, hits and what a surface does ------------------------------------------------ */

typedef struct lc_scene lc_scene;     /* shapes, lights, camera; only read */
typedef struct lc_sampler lc_sampler; /* the random numbers of this one sample */

typedef struct lc_ray {
    lc_vec3 o, d; /* origin [m], unit direction */
    double time;  /* in [0, 1) */
} lc_ray;

typedef struct lc_hit {
    int valid;       /* 0: the ray left the scene, and only `wo` and `time` mean anything */
    lc_vec3 p;       /* the point [m] */
    lc_vec3 n;       /* unit normal of the surface as modelled; it emits on this side. NOT turned to the viewer */
    lc_vec3 wo;      /* unit direction back to where the ray came from */
    double distance; /* from there [m] */
    double time;     /* the ray's: when this is looked at, and all that is seen from here */
    int shape, part; /* the host's own: which surface this is */
} lc_hit;

/* What the surface is made of, as seen from the side of `wo`. The lobes add up (a blend has several).
 * The diffuse lobe of a one-sided surface is black from behind; so are its mirrors, smooth and rough. */
typedef struct lc_material {
    lc_rgb diffuse; /* albedo of the Lambertian lobe, each channel in [0, 1] */
    lc_rgb mirror;  /* reflectance of the mirror lobe, each channel in [0, 1] */
    double glass;   /* share of the smooth dielectric lobe, in [0, 1] */
    double ior;     /* refractive index beyond the surface / index on the side of `wo`; > 0 */
    lc_rgb glossy;  /* reflectance of the facets of the rough mirror lobe (GGX), each channel in [0, 1] */
    double alpha;   /* their roughness, in (0, 1]; 0 where there are none */
} lc_material;

lc_material lc_material_at(const lc_scene *scene, const lc_hit *hit);

/* The value of the BSDF between hit->wo and `wi` [1/sr], WITHOUT the cosine: its finite lobes only, since a
 * mirror or glass has no value anywhere, only a weight. On the side of wo albedo / pi (Lambert) + glossy D G / (4 cos_o
 * cos_i) (GGX with Smith's masking: Walter et al. 2007), else black. */
lc_rgb lc_bsdf_eval(const lc_scene *scene, const lc_hit *hit, lc_vec3 wi);

/* One way on for a path. The quotient is left to you: throughput *= value cos_surface / pdf, or, where is_delta,
 * value / pdf. */
typedef struct lc_scatter {
    lc_vec3 wi;   /* where to look next: either side of the surface */
    int lobe;     /* LC_DIFFUSE, LC_GLOSSY, LC_MIRROR or LC_GLASS: the one that was chosen */
    int is_delta; /* 1: mirror or glass, which know one direction and no density */
    lc_rgb value; /* finite: lc_bsdf_eval() [1/sr]. delta: radiance along wo / radiance from wi; through glass
                   * share (1 - F) / ior^2, for a lossless interface keeps L / n^2 (Veach, thesis 1997, 5.2) */
    double pdf;   /* finite: lc_bsdf_pdf() [1/sr]. delta: the probability of this choice */
} lc_scatter;

/* Picks wi: a lobe in proportion to its reflectance (its largest channel; glass reflects with F and transmits with
 * 1 - F), then within the diffuse lobe in proportion to the cosine, within the glossy one in proportion to the facets
 * that wo sees: of those some lead below the horizon, where the value is black. Draws three numbers. The quotient never
 * exceeds 1, but for glass's 1 / ior^2. Returns 0, *out untouched, where nothing is reflected: absorbed. */
int lc_bsdf_sample(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out);

/* Density with which lc_bsdf_sample() picks `wi` by its finite lobes, the choice among all lobes included [1/sr];
 * delta lobes add 0. */
double lc_bsdf_pdf(const lc_scene *scene, const lc_hit *hit, lc_vec3 wi);

/* Mirror and glass. `wo` and unit `n` may lie on either side of the surface; `ior` as in lc_material: index beyond /
 * index on the side of wo. lc_fresnel: reflectance for unpolarised light, cos_i in [0, 1] the cosine of wo with the
 * normal; 1 at total reflection (Born and Wolf, Principles of Optics, 1.5.2). lc_refract: where light comes from to
 * leave along wo, by Snell; returns 0 at total reflection. */
double lc_fresnel(double cos_i, double ior);
lc_vec3 lc_reflect(lc_vec3 wo, lc_vec3 n);
int lc_refract(lc_vec3 wo, lc_vec3 n, double ior, lc_vec3 *wi);

/* Radiance that the surface itself emits from `hit` towards hit->wo [W sr^-1 m^-2]: front side only.
 * On a miss, that of the environment: black unless the scene has a sky. */
lc_rgb lc_emission(const lc_scene *scene, const lc_hit *hit);

/* Follows the ray from `from` along `wi` (either side of the surface); returns next->valid. `next` may be `from`. */
int lc_trace(const lc_scene *scene, const lc_hit *from, lc_vec3 wi, lc_hit *next);

/* ---- lights ---------------------------------------------------------------------------------------- */

/* A place on a light, as seen from a hit. */
typedef struct lc_light_sample {
    int is_delta;      /* 1: a point or directional light; it has no area: use `irradiance`, not what is below */
    lc_vec3 wi;        /* unit direction from the hit to the light */
    double distance;   /* [m]; INFINITY for a directional light */
    lc_rgb irradiance; /* delta: received by a surface that faces wi [W m^-2]: I / d^2, or E0 */
    lc_vec3 p;         /* area: the point [m] */
    lc_vec3 n;         /* area: unit normal there, on the side that emits */
    lc_rgb radiance;   /* area: emitted from p on the side of n, whatever side wi sees [W sr^-1 m^-2] */
    double pdf_area;   /* area: density of p with respect to area [1/m^2] */
    double pdf_solid;  /* area, by lc_light_sample_solid() only: density of wi over directions [1/sr] */
    int shape, part;   /* the host's own */
} lc_light_sample;

/* Number of lights: each emitting shape, point light and directional light is one. The sky is none. */
int lc_light_count(const lc_scene *scene);

/* Picks a point on light `i`, 0 <= i < lc_light_count(), uniformly over its area; a moving light is where it is at hit->time. */
void lc_light_sample_one(const lc_scene *scene, int i, const lc_hit *hit, lc_sampler *sampler, lc_light_sample *out);

/* The same for a direction: uniform over the solid angle in which the hit sees light `i`, if that is a sphere or a rectangle (Urena,
 * Fajardo, King 2013); other shapes by area. Its density is pdf_solid; 0 where wi sees the back of a shape picked by area. */
void lc_light_sample_solid(const lc_scene *scene, int i, const lc_hit *hit, lc_sampler *sampler, lc_light_sample *out);

/* Picks a point uniformly over the union of ALL emitting area (then pdf_area = 1 / total area); returns 0 where nothing has area. */
int lc_light_sample_union(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_light_sample *out);

/* The pdf_area that lc_light_sample_one() gives a point of the light which a ray has found at `hit` [1/m^2]: what its
 * density would have been, had the light been sampled instead. 0 on a miss, and where nothing emits. */
double lc_light_pdf_area(const lc_scene *scene, const lc_hit *hit);

/* 1 when nothing stands between the hit and the light's point, else 0. */
int lc_visible(const lc_scene *scene, const lc_hit *hit, const lc_light_sample *light);

/* ---- random numbers -------------------------------------------------------------------------------- */

/* The next uniform number in [0, 1). */
double lc_next(lc_sampler *sampler);

/* A unit direction uniform over the hemisphere around unit `n` (density 1/(2 pi) 1/sr), or proportional
 * to the cosine with `n` (density cos/pi); u, v in [0, 1). */
lc_vec3 lc_uniform_hemisphere(lc_vec3 n, double u, double v);
lc_vec3 lc_cosine_hemisphere(lc_vec3 n, double u, double v);

/* `n` or -n, whichever lies on the side of `w`. */
static inline lc_vec3 lc_facing(lc_vec3 n, lc_vec3 w) { return lc_dot(n, w) < 0 ? lc_neg(n) : n; }

/* ---- the estimator --------------------------------------------------------------------------------- */

typedef struct lc_options {
    int min_bounces, max_bounces; /* sum the terms L_k for min_bounces <= k <= max_bounces; see below */
} lc_options;

/* One unbiased sample of the radiance along `ray`, towards its origin [W sr^-1 m^-2, each channel >= 0]:
 *     sum of L_k for k = options->min_bounces .. options->max_bounces,
 * L_k being the light that was scattered k times on its way; each mirror hit and each glass interface counts. L_0 is
 * lc_emission() of the first hit. `hit` is where the ray ends; it may be a miss. */
typedef lc_rgb lc_radiance_fn(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                              lc_sampler *sampler);

enum { LC_DIFFUSE = 1, LC_MIRROR = 2, LC_GLASS = 4, LC_GLOSSY = 8 }; /* lobes an estimator follows */
enum { LC_AREA = 1, LC_POINT = 2, LC_DIRECTIONAL = 4, LC_SKY = 8 };  /* emitters it can reach */
enum { LC_UNBOUNDED = 1 << 20 };                                     /* max_bounces of an estimator without a limit */

typedef struct lc_estimator {
    int abi;                  /* LC_ABI */
    const char *name;         /* on the command line; letters, digits, _ */
    const char *summary;      /* one line */
    const char *source;       /* where the formula stands: paper or lecture, and equation */
    unsigned lobes;           /* LC_DIFFUSE | ...; other lobes contribute 0 */
    unsigned emitters;        /* LC_AREA | ...; others contribute 0 */
    int max_bounces;          /* the largest options->max_bounces it can do */
    lc_radiance_fn *radiance; /* any thread */
} lc_estimator;

/* Defines the descriptor:  LC_ESTIMATOR(path) = { LC_ABI, "path", ... };
 * The same file is a member of the registry, or with -DLC_PLUGIN a library of its own. */
#ifdef LC_PLUGIN
#define LC_ESTIMATOR(id) \
    extern const lc_estimator lc_plugin; \
    const lc_estimator lc_plugin
#else
#define LC_ESTIMATOR(id) \
    extern const lc_estimator lc_estimator_##id; \
    const lc_estimator lc_estimator_##id
#endif

#ifdef __cplusplus
}
#endif
#endif
