/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Bugs of glossy reflection and of motion blur, one switch each.
 */
#include "lightcheck.h"
#include "registry.h"

enum { NO_JACOBIAN = 1, NO_COSINE = 2, MIRROR_ONLY = 4, LAMP_AT_REST = 8, SHADOW_AT_REST = 16, NO_TIME = 32 };

/* glossy_direct, with the facet's density instead of the direction's, without the cosine, or as if the facet were the surface. */
static lc_rgb by_facet(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, unsigned bugs)
{
    lc_scatter way;
    if (!lc_bsdf_sample(scene, hit, sampler, &way) || way.is_delta)
        return lc_black();
    lc_vec3 n = lc_facing(hit->n, hit->wo);
    if (bugs & MIRROR_ONLY)
        way.wi = lc_reflect(hit->wo, n);
    double cos_surface = lc_dot(n, way.wi), pdf = way.pdf;
    if (!(cos_surface > 0))
        return lc_black();
    if (bugs & NO_JACOBIAN) /* wrong: the density of h, 4 (wo . h) times that of wi */
        pdf *= 4 * lc_dot(hit->wo, lc_normalize(lc_add(hit->wo, way.wi)));
    if (bugs & NO_COSINE)
        cos_surface = 1;
    lc_hit next;
    lc_trace(scene, hit, way.wi, &next);
    return lc_rgb_scale(cos_surface / pdf, lc_rgb_mul(way.value, lc_emission(scene, &next)));
}

/* light_direct, which forgets when it looks. */
static lc_rgb by_light(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, unsigned bugs)
{
    int count = lc_light_count(scene);
    lc_hit rest = *hit;
    lc_light_sample light;
    rest.time = 0;
    if (count == 0)
        return lc_black();
    lc_light_sample_one(scene, (int)(lc_next(sampler) * count), bugs & LAMP_AT_REST ? &rest : hit, sampler, &light);
    double cos_surface = lc_dot(lc_facing(hit->n, hit->wo), light.wi);
    if (!(cos_surface > 0))
        return lc_black();
    lc_rgb incoming = light.irradiance;
    if (!light.is_delta) {
        double cos_light = -lc_dot(light.n, light.wi);
        if (!(cos_light > 0))
            return lc_black();
        incoming = lc_rgb_scale(cos_light / (light.pdf_area * light.distance * light.distance), light.radiance);
    }
    if (!lc_visible(scene, bugs & (LAMP_AT_REST | SHADOW_AT_REST) ? &rest : hit, &light))
        return lc_black();
    return lc_rgb_scale(count * cos_surface, lc_rgb_mul(lc_bsdf_eval(scene, hit, light.wi), incoming));
}

/* hemisphere_direct, whose second ray has no time. */
static lc_rgb by_direction(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, unsigned bugs)
{
    lc_vec3 n = lc_facing(hit->n, hit->wo);
    double u = lc_next(sampler), v = lc_next(sampler);
    lc_vec3 wi = lc_uniform_hemisphere(n, u, v);
    lc_hit from = *hit, next;
    if (bugs & NO_TIME)
        from.time = 0;
    lc_trace(scene, &from, wi, &next);
    return lc_rgb_scale(2 * LC_PI * lc_dot(n, wi),
                        lc_rgb_mul(lc_bsdf_eval(scene, hit, wi), lc_emission(scene, &next)));
}

typedef lc_rgb direct_fn(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, unsigned bugs);

static lc_rgb sum(direct_fn *direct, unsigned bugs, const lc_scene *scene, const lc_hit *hit, const lc_options *options,
                  lc_sampler *sampler)
{
    lc_rgb radiance = options->min_bounces <= 0 ? lc_emission(scene, hit) : lc_black();
    if (options->min_bounces <= 1 && options->max_bounces >= 1 && hit->valid)
        radiance = lc_rgb_add(radiance, direct(scene, hit, sampler, bugs));
    return radiance;
}

#define MUTANT(id, of, direct, lobes, emitters, bugs, summary) \
    static lc_rgb radiance_##id(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, \
                                const lc_options *options, lc_sampler *sampler) \
    { \
        (void)ray; \
        return sum(direct, bugs, scene, hit, options, sampler); \
    } \
    LC_ESTIMATOR(id) = {LC_ABI, #id, summary, of ", broken", lobes, emitters, 1, radiance_##id}

#define GLOSSY_MUTANT(id, bugs, summary) \
    MUTANT(id, "glossy_direct", by_facet, LC_GLOSSY, LC_AREA | LC_SKY, bugs, summary)

GLOSSY_MUTANT(glossy_no_jacobian, NO_JACOBIAN, "the facet's density in place of the direction's: 4 cos is missing");
GLOSSY_MUTANT(glossy_no_cosine, NO_COSINE, "the cosine at the surface is missing");
GLOSSY_MUTANT(glossy_one_direction, MIRROR_ONLY, "the weight of a facet, but the direction of a smooth mirror");

#define LIGHT_MUTANT(id, bugs, summary) \
    MUTANT(id, "light_direct", by_light, LC_DIFFUSE, LC_AREA | LC_POINT | LC_DIRECTIONAL, bugs, summary)

LIGHT_MUTANT(light_lamp_at_rest, LAMP_AT_REST, "moving lamps are sampled, and seen, where they are at time 0");
LIGHT_MUTANT(light_shadow_at_rest, SHADOW_AT_REST, "the shadow ray looks at time 0");
MUTANT(hemisphere_no_time, "hemisphere_direct", by_direction, LC_DIFFUSE, LC_AREA | LC_SKY, NO_TIME,
       "the ray from the surface looks at time 0");

/* Each after the estimator that it was. */
const lc_mutant lc_effects_mutants[] = {
    {&lc_estimator_glossy_no_jacobian, "glossy_direct", "density",
     "The density is the half vector's, the sample is a direction.",
     "a lamp in a rough mirror: 4 cos",
     "Is your density one of facets or one of directions?"},
    {&lc_estimator_glossy_no_cosine, "glossy_direct", "cosine",
     "The mirror, which has none, was the model.",
     "at a slant: 1 / cos",
     "How much of a beam does a tilted surface catch?"},
    {&lc_estimator_glossy_one_direction, "glossy_direct", "directions",
     "The smooth mirror's direction is kept.",
     "a lamp in a rough mirror: sharp",
     "Where does light go that meets a tilted facet?"},
    {&lc_estimator_light_lamp_at_rest, "light_direct", "time",
     "Lamps are sampled where they were loaded.",
     "a lamp that moves: the light of time 0",
     "At which moment is the lamp where?"},
    {&lc_estimator_light_shadow_at_rest, "light_direct", "time",
     "A new ray starts with a new time.",
     "an object that moves: a sharp shadow",
     "At which moment does the shadow ray travel?"},
    {&lc_estimator_hemisphere_no_time, "hemisphere_direct", "time",
     "A new ray starts with a new time.",
     "a lamp that moves: the light of time 0",
     "At which moment does the next ray travel?"},
    LC_MUTANT_END,
};
