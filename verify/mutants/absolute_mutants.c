/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Bugs that a scene of usual size, brightness and orientation hides: absolute thresholds, axes of the world. Close to right
 * where they were tried, they show when the scene is changed and the estimator has to agree with itself; or with more
 * samples, which do not help a generator that repeats. And a trap of the lecture: its method 1 sees lights from behind.
 */
#include "lightcheck.h"
#include "registry.h"

enum {
    CLAMP = 1,
    DIM = 2,
    NEAR = 4,
    SOFT = 8,
    WORLD_FRAME = 16,
    ENDS_DIM = 32,
    UNDIVIDED = 64,
    WORLD_UP = 128,
    RESEEDED = 256,
    TWO_SIDED = 512
};

#define BRIGHTEST 200.0 /* no sample of the suite's scenes is brighter */

static lc_rgb clamped(lc_rgb c, unsigned bugs)
{
    if (bugs & CLAMP)
        c = lc_color(fmin(c.r, BRIGHTEST), fmin(c.g, BRIGHTEST), fmin(c.b, BRIGHTEST));
    return bugs & DIM && lc_rgb_max(c) < 0.01 ? lc_black() : c;
}

/* 1 / (d^2 + a little), against division by zero. */
static double inverse_square(double distance, unsigned bugs)
{
    return 1 / (distance * distance + (bugs & SOFT ? 1e-4 : 0.0));
}

static lc_rgb direct(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, int by_union, unsigned bugs)
{
    int count = by_union ? 1 : lc_light_count(scene);
    lc_light_sample light;
    if (count == 0 || (by_union && !lc_light_sample_union(scene, hit, sampler, &light)))
        return lc_black();
    if (!by_union)
        lc_light_sample_one(scene, (int)(lc_next(sampler) * count), hit, sampler, &light);
    double cos_surface = lc_dot(lc_facing(hit->n, hit->wo), light.wi);
    lc_rgb incoming = light.irradiance;
    if (!light.is_delta)
        incoming = lc_rgb_scale(fmax(-lc_dot(light.n, light.wi), 0) * inverse_square(light.distance, bugs) /
                                    light.pdf_area,
                                light.radiance);
    if (!(cos_surface > 0) || !lc_visible(scene, hit, &light) || (bugs & NEAR && light.distance < 0.01))
        return lc_black();
    return lc_rgb_scale(count * cos_surface, lc_rgb_mul(lc_bsdf_eval(scene, hit, light.wi), incoming));
}

/* A frame around n from the world's up, not normalised: right for floors. */
static lc_vec3 world_frame_hemisphere(lc_vec3 n, double u, double v)
{
    lc_vec3 s = fabs(n.z) > 0.999 ? lc_vec(1, 0, 0) : lc_cross(lc_vec(0, 0, 1), n), t = lc_cross(n, s);
    double sin_theta = sqrt(u * (2 - u)), phi = 2 * LC_PI * v;
    return lc_normalize(lc_add(lc_scale(1 - u, n), lc_add(lc_scale(sin_theta * cos(phi), s),
                                                          lc_scale(sin_theta * sin(phi), t))));
}

/* Flips the component along the axis that is nearest to n: right for mirrors along the axes. */
static lc_vec3 reflect_along_axis(lc_vec3 wo, lc_vec3 n)
{
    lc_vec3 wi = lc_neg(wo);
    if (fabs(n.x) >= fabs(n.y) && fabs(n.x) >= fabs(n.z))
        wi.x = -wi.x;
    else if (fabs(n.y) >= fabs(n.z))
        wi.y = -wi.y;
    else
        wi.z = -wi.z;
    return wi;
}

/* A generator of its own, seeded by the direction to the viewer: it is nearly the same for all samples of a pixel. */
static void reseeded(lc_vec3 wo, double *u, double *v)
{
    unsigned long seed = (unsigned long)(16 * (wo.x + 2)) * 73856093u ^ (unsigned long)(16 * (wo.y + 2)) * 19349663u ^
                         (unsigned long)(16 * (wo.z + 2)) * 83492791u;
    seed = (seed * 1103515245u + 12345u) & 0xffffffffu;
    *u = (double)(seed >> 8) * 0x1p-24;
    seed = (seed * 1103515245u + 12345u) & 0xffffffffu;
    *v = (double)(seed >> 8) * 0x1p-24;
}

/* What the throughput is multiplied by; black ends the path. */
static lc_rgb scatter(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, int mirrors, unsigned bugs,
                      lc_vec3 *wi)
{
    lc_material material = lc_material_at(scene, hit);
    double mirror = mirrors ? lc_rgb_max(material.mirror) : 0, diffuse = lc_rgb_max(material.diffuse);
    if (mirror + diffuse == 0 || (bugs & UNDIVIDED && lc_next(sampler) >= mirror + diffuse))
        return lc_black();
    double q = mirror / (mirror + diffuse);
    if (mirrors && lc_next(sampler) < q) {
        *wi = bugs & WORLD_UP ? reflect_along_axis(hit->wo, hit->n) : lc_reflect(hit->wo, hit->n);
        return lc_rgb_scale(1 / q, material.mirror);
    }
    lc_vec3 n = lc_facing(hit->n, hit->wo);
    double u = lc_next(sampler), v = lc_next(sampler);
    if (bugs & RESEEDED)
        reseeded(hit->wo, &u, &v);
    *wi = bugs & WORLD_FRAME ? world_frame_hemisphere(n, u, v) : lc_uniform_hemisphere(n, u, v);
    return lc_rgb_scale(2 * LC_PI * lc_dot(n, *wi) / (1 - q), lc_bsdf_eval(scene, hit, *wi));
}

static lc_rgb walk(const lc_scene *scene, const lc_hit *first, const lc_options *options, lc_sampler *sampler,
                   int mirrors, unsigned bugs)
{
    lc_rgb sum = lc_black(), throughput = lc_color(1, 1, 1);
    lc_hit hit = *first;
    for (int k = 0;; ++k) {
        if (bugs & TWO_SIDED)
            hit.n = lc_facing(hit.n, hit.wo);
        if (k >= options->min_bounces)
            sum = lc_rgb_add(sum, lc_rgb_mul(throughput, lc_emission(scene, &hit)));
        if (k == options->max_bounces || !hit.valid)
            return clamped(sum, bugs);
        lc_vec3 wi;
        throughput = lc_rgb_mul(throughput, scatter(scene, &hit, sampler, mirrors, bugs, &wi));
        if (lc_rgb_max(throughput) <= (bugs & ENDS_DIM ? 0.05 : 0.0))
            return clamped(sum, bugs);
        lc_trace(scene, &hit, wi, &hit);
    }
}

static lc_rgb by_light(const lc_scene *scene, const lc_hit *hit, const lc_options *options, lc_sampler *sampler,
                       int by_union, unsigned bugs)
{
    lc_rgb total = options->min_bounces <= 0 ? lc_emission(scene, hit) : lc_black();
    if (options->min_bounces <= 1 && options->max_bounces >= 1 && hit->valid)
        total = lc_rgb_add(total, clamped(direct(scene, hit, sampler, by_union, bugs), bugs));
    return total;
}

/* `function` with its one argument before the bugs; then what the descriptor says. */
#define MUTANT(id, function, argument, bugs, summary, of, lobes, emitters, most) \
    static lc_rgb radiance_##id(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, \
                                const lc_options *options, lc_sampler *sampler) \
    { \
        (void)ray; \
        return function(scene, hit, options, sampler, argument, bugs); \
    } \
    LC_ESTIMATOR(id) = {LC_ABI, #id, summary, of ", broken", lobes, emitters, most, radiance_##id}

#define ALL_LIGHTS (LC_AREA | LC_POINT | LC_DIRECTIONAL)

MUTANT(light_clamped, by_light, 0, CLAMP, "fireflies are clamped to 200", "light_direct", LC_DIFFUSE, ALL_LIGHTS, 1);
MUTANT(light_ignores_dim, by_light, 0, DIM, "samples below 0.01 are left out", "light_direct", LC_DIFFUSE, ALL_LIGHTS,
       1);
MUTANT(light_ignores_near, by_light, 0, NEAR, "lights nearer than 1 cm are left out", "light_direct", LC_DIFFUSE,
       ALL_LIGHTS, 1);
MUTANT(light_softened, by_light, 0, SOFT, "1 / (d^2 + 0.0001) against division by zero", "light_direct", LC_DIFFUSE,
       ALL_LIGHTS, 1);
MUTANT(three_point_softened, by_light, 1, SOFT, "1 / (d^2 + 0.0001) against division by zero", "three_point",
       LC_DIFFUSE, LC_AREA, 1);
MUTANT(hemisphere_world_frame, walk, 0, WORLD_FRAME, "a frame from the world's up, right for floors only",
       "hemisphere_direct", LC_DIFFUSE, LC_AREA | LC_SKY, 1);
MUTANT(hemisphere_reseeded, walk, 0, RESEEDED, "a generator of its own, seeded for each pixel", "hemisphere_direct",
       LC_DIFFUSE, LC_AREA | LC_SKY, 1);
MUTANT(hemisphere_two_sided, walk, 0, TWO_SIDED, "lights shine from both sides, as in method 1 of the lecture",
       "hemisphere_direct", LC_DIFFUSE, LC_AREA | LC_SKY, 1);
MUTANT(path_clamped, walk, 0, CLAMP, "fireflies are clamped to 200", "path", LC_DIFFUSE, LC_AREA | LC_SKY,
       LC_UNBOUNDED);
MUTANT(path_ends_when_dim, walk, 0, ENDS_DIM, "paths of less than 5% throughput end", "path", LC_DIFFUSE,
       LC_AREA | LC_SKY, LC_UNBOUNDED);
MUTANT(path_roulette_undivided, walk, 0, UNDIVIDED, "roulette by the albedo, survivors not divided by it", "path",
       LC_DIFFUSE, LC_AREA | LC_SKY, LC_UNBOUNDED);
MUTANT(mirror_world_up, walk, 1, WORLD_UP, "reflection along the nearest axis of the world", "mirror",
       LC_DIFFUSE | LC_MIRROR, LC_AREA | LC_SKY, LC_UNBOUNDED);

/* Each after the estimator that it was. */
const lc_mutant lc_absolute_mutants[] = {
    {&lc_estimator_light_clamped, "light_direct", "thresholds",
     "Fireflies are clamped.",
     "emission x 1024: less than 1024 times",
     "Make every lamp brighter by one factor."},
    {&lc_estimator_light_ignores_dim, "light_direct", "thresholds",
     "Samples that nobody would see are left out.",
     "emission x 1024: more than 1024 times",
     "Make every lamp brighter by one factor."},
    {&lc_estimator_light_ignores_near, "light_direct", "thresholds",
     "An epsilon in metres against division by zero.",
     "the scene at 1/1024: dark",
     "Make the whole scene smaller."},
    {&lc_estimator_light_softened, "light_direct", "thresholds",
     "A constant in metres against division by zero.",
     "the scene at 1/1024: dark",
     "Make the whole scene smaller."},
    {&lc_estimator_three_point_softened, "three_point", "thresholds",
     "A constant in metres against division by zero.",
     "the scene at 1/1024: dark",
     "Make the whole scene smaller."},
    {&lc_estimator_hemisphere_world_frame, "hemisphere_direct", "directions",
     "A frame from the up axis of the world, tried on a floor.",
     "the scene rotated: local",
     "Rotate the scene, and the camera with it."},
    {&lc_estimator_hemisphere_reseeded, "hemisphere_direct", "numbers",
     "A generator of its own, with the same seed for each sample.",
     "the error does not fall with N",
     "Does your error halve with four times the samples?"},
    {&lc_estimator_hemisphere_two_sided, "hemisphere_direct", "sides",
     "Method 1 of the lecture: what a ray meets shines.",
     "a lamp seen from its back: not 0",
     "Which side of a lamp is lit?"},
    {&lc_estimator_path_clamped, "path", "thresholds",
     "Fireflies are clamped.",
     "emission x 1024: less than 1024 times",
     "Make every lamp brighter by one factor."},
    {&lc_estimator_path_ends_when_dim, "path", "thresholds",
     "Dim paths end without roulette.",
     "albedo x 1/2: less than 2^-k",
     "Make every surface darker by one factor."},
    {&lc_estimator_path_roulette_undivided, "path", "roulette",
     "Roulette as an optimisation only.",
     "bounce k: the product of all q",
     "How often does a path survive, and what are survivors divided by?"},
    {&lc_estimator_mirror_world_up, "mirror", "directions",
     "A mirror tried on a floor.",
     "the scene rotated: misplaced",
     "Rotate the scene, and the camera with it."},
    LC_MUTANT_END,
};
