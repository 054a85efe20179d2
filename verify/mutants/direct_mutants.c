/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Bugs of direct light, one switch each: the family of light_direct, three_point and hemisphere_direct.
 */
#include "lightcheck.h"

enum {
    NO_COSINE = 1,
    NO_PI = 2,
    NO_LIGHT_COUNT = 4,
    NO_LIGHT_COSINE = 8,
    NO_VISIBILITY = 16,
    NO_DISTANCE = 32,
    BACK_EMITS = 64,
    COSINE_DIRECTIONS = 128,
    ONE_PERCENT = 256,
    LIGHT_CENTRE = 512,
    BELOW_HORIZON = 1024,
    JACOBIAN_INVERTED = 2048,
    UNIFORM_PICK = 4096,
    LIGHT_DENSITY = 8192
};

static double surface_factor(unsigned bugs, double cos_surface)
{
    return (bugs & NO_COSINE ? 1.0 : cos_surface) * (bugs & NO_PI ? LC_PI : 1.0) * (bugs & ONE_PERCENT ? 1.01 : 1.0);
}

/* Moves the point to the light's centre, roughly: distance and cosines are then those of the centre. */
static void move_to_centre(const lc_scene *scene, int light, const lc_hit *hit, lc_sampler *sampler,
                           lc_light_sample *out)
{
    lc_vec3 sum = lc_vec(0, 0, 0);
    if (out->is_delta)
        return;
    for (int i = 0; i < 32; ++i) {
        lc_light_sample point;
        lc_light_sample_one(scene, light, hit, sampler, &point);
        sum = lc_add(sum, point.p);
    }
    lc_vec3 to = lc_sub(lc_scale(1.0 / 32, sum), hit->p);
    out->distance = lc_length(to);
    out->wi = lc_scale(1.0 / out->distance, to);
}

/* Lambert's BRDF by hand where the bug needs it: lc_bsdf_eval() is black below the horizon and would hide it. */
static lc_rgb reflectance(const lc_scene *scene, const lc_hit *hit, lc_vec3 wi, unsigned bugs)
{
    if (bugs & BELOW_HORIZON)
        return lc_rgb_scale(LC_INV_PI, lc_material_at(scene, hit).diffuse);
    return lc_bsdf_eval(scene, hit, wi);
}

static lc_rgb by_light(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, unsigned bugs)
{
    int count = lc_light_count(scene);
    lc_light_sample light;
    if (count == 0)
        return lc_black();
    int chosen = (int)(lc_next(sampler) * count);
    lc_light_sample_one(scene, chosen, hit, sampler, &light);
    lc_light_sample seen = light; /* whose visibility is tested */
    if (bugs & LIGHT_CENTRE)
        move_to_centre(scene, chosen, hit, sampler, &light);
    double cos_surface = lc_dot(lc_facing(hit->n, hit->wo), light.wi);
    if (bugs & BELOW_HORIZON)
        cos_surface = fabs(cos_surface);
    if (!(cos_surface > 0))
        return lc_black();
    lc_rgb incoming = light.irradiance;
    if (!light.is_delta) {
        double cos_light = -lc_dot(light.n, light.wi);
        if (bugs & BACK_EMITS)
            cos_light = fabs(cos_light);
        if (!(cos_light > 0))
            return lc_black();
        double d2 = bugs & NO_DISTANCE ? 1.0 : light.distance * light.distance;
        incoming = lc_rgb_scale((bugs & NO_LIGHT_COSINE ? 1.0 : cos_light) / (light.pdf_area * d2), light.radiance);
    }
    if (!(bugs & NO_VISIBILITY) && !lc_visible(scene, hit, &seen))
        return lc_black();
    double lights = bugs & NO_LIGHT_COUNT ? 1.0 : count;
    return lc_rgb_scale(lights * surface_factor(bugs, cos_surface),
                        lc_rgb_mul(reflectance(scene, hit, light.wi, bugs), incoming));
}

/* A point with a wrong density: a light chosen uniformly with the density of the union, or a point of the union with
 * the density within its light. Returns 0 where nothing has area. */
static int pick_badly(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, unsigned bugs,
                      lc_light_sample *out)
{
    int count = lc_light_count(scene);
    if (!lc_light_sample_union(scene, hit, sampler, out))
        return 0;
    double pdf_union = out->pdf_area;
    if (bugs & UNIFORM_PICK) {
        lc_light_sample_one(scene, (int)(lc_next(sampler) * count), hit, sampler, out);
        out->pdf_area = pdf_union;
        return !out->is_delta;
    }
    for (int i = 0; i < count; ++i) {
        lc_light_sample other;
        lc_light_sample_one(scene, i, hit, sampler, &other);
        if (!other.is_delta && other.shape == out->shape)
            out->pdf_area = other.pdf_area;
    }
    return 1;
}

static lc_rgb by_area(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, unsigned bugs)
{
    lc_light_sample light;
    int found = bugs & (UNIFORM_PICK | LIGHT_DENSITY) ? pick_badly(scene, hit, sampler, bugs, &light)
                                                      : lc_light_sample_union(scene, hit, sampler, &light);
    if (!found)
        return lc_black();
    double cos_surface = lc_dot(lc_facing(hit->n, hit->wo), light.wi), cos_light = -lc_dot(light.n, light.wi);
    if (bugs & BACK_EMITS)
        cos_light = fabs(cos_light);
    if (!(cos_surface > 0 && cos_light > 0) || (!(bugs & NO_VISIBILITY) && !lc_visible(scene, hit, &light)))
        return lc_black();
    double d2 = light.distance * light.distance;
    double g = cos_surface * cos_light * (bugs & JACOBIAN_INVERTED ? d2 : 1 / d2);
    return lc_rgb_scale(g / light.pdf_area, lc_rgb_mul(lc_bsdf_eval(scene, hit, light.wi), light.radiance));
}

static lc_rgb by_hemisphere(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, unsigned bugs)
{
    lc_vec3 n = lc_facing(hit->n, hit->wo);
    double u = lc_next(sampler), v = lc_next(sampler);
    lc_vec3 wi = bugs & COSINE_DIRECTIONS ? lc_cosine_hemisphere(n, u, v) : lc_uniform_hemisphere(n, u, v);
    lc_hit next;
    lc_trace(scene, hit, wi, &next);
    lc_rgb f = lc_bsdf_eval(scene, hit, wi);
    return lc_rgb_scale(2.0 * LC_PI * surface_factor(bugs, lc_dot(n, wi)), lc_rgb_mul(f, lc_emission(scene, &next)));
}

typedef lc_rgb direct_fn(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, unsigned bugs);

static lc_rgb sum(direct_fn *direct, unsigned bugs, const lc_scene *scene, const lc_hit *hit, const lc_options *options,
                  lc_sampler *sampler)
{
    lc_rgb total = options->min_bounces <= 0 ? lc_emission(scene, hit) : lc_black();
    if (options->min_bounces <= 1 && options->max_bounces >= 1 && hit->valid)
        total = lc_rgb_add(total, direct(scene, hit, sampler, bugs));
    return total;
}

#define LIGHT_MUTANT(id, bugs, summary) \
    static lc_rgb radiance_##id(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, \
                                const lc_options *options, lc_sampler *sampler) \
    { \
        (void)ray; \
        return sum(by_light, bugs, scene, hit, options, sampler); \
    } \
    LC_ESTIMATOR( \
        id) = {LC_ABI, #id,          summary, "light_direct, broken", LC_DIFFUSE, LC_AREA | LC_POINT | LC_DIRECTIONAL, \
               1,      radiance_##id}

#define HEMISPHERE_MUTANT(id, bugs, summary) \
    static lc_rgb radiance_##id(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, \
                                const lc_options *options, lc_sampler *sampler) \
    { \
        (void)ray; \
        return sum(by_hemisphere, bugs, scene, hit, options, sampler); \
    } \
    LC_ESTIMATOR(id) = {LC_ABI,           #id, summary,      "hemisphere_direct, broken", LC_DIFFUSE, \
                        LC_AREA | LC_SKY, 1,   radiance_##id}

#define AREA_MUTANT(id, bugs, summary) \
    static lc_rgb radiance_##id(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, \
                                const lc_options *options, lc_sampler *sampler) \
    { \
        (void)ray; \
        return sum(by_area, bugs, scene, hit, options, sampler); \
    } \
    LC_ESTIMATOR(id) = {LC_ABI, #id, summary, "three_point, broken", LC_DIFFUSE, LC_AREA, 1, radiance_##id}

LIGHT_MUTANT(light_no_cosine, NO_COSINE, "the cosine at the surface is missing");
LIGHT_MUTANT(light_no_pi, NO_PI, "the BRDF is albedo instead of albedo / pi");
LIGHT_MUTANT(light_no_count, NO_LIGHT_COUNT, "the number of lights is missing");
LIGHT_MUTANT(light_no_light_cosine, NO_LIGHT_COSINE, "the cosine at the light is missing");
LIGHT_MUTANT(light_no_visibility, NO_VISIBILITY, "no shadow ray");
LIGHT_MUTANT(light_no_distance, NO_DISTANCE, "1 / d^2 is missing");
LIGHT_MUTANT(light_back_emits, BACK_EMITS, "lights shine from their backs, too");
LIGHT_MUTANT(light_centre, LIGHT_CENTRE, "distance and cosines are those of the light's centre");
LIGHT_MUTANT(light_below_horizon, BELOW_HORIZON, "the surface's cosine without its sign: light from behind");
LIGHT_MUTANT(light_one_percent, ONE_PERCENT, "everything is 1% too bright");
AREA_MUTANT(three_point_jacobian_inverted, JACOBIAN_INVERTED, "d^2 instead of 1 / d^2");
AREA_MUTANT(three_point_back_emits, BACK_EMITS, "lights shine from their backs, too");
AREA_MUTANT(three_point_no_visibility, NO_VISIBILITY, "no shadow ray");
AREA_MUTANT(three_point_uniform_pick, UNIFORM_PICK, "lights chosen uniformly, density of the union of their areas");
AREA_MUTANT(three_point_light_density, LIGHT_DENSITY, "points of the union, density within the one light");
HEMISPHERE_MUTANT(hemisphere_no_cosine, NO_COSINE, "the cosine at the surface is missing");
HEMISPHERE_MUTANT(hemisphere_no_pi, NO_PI, "the BRDF is albedo instead of albedo / pi");
HEMISPHERE_MUTANT(hemisphere_cosine_directions, COSINE_DIRECTIONS, "directions by the cosine, weight of uniform ones");
