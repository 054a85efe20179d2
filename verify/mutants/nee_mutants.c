/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Bugs of paths that sample lights, weigh two techniques, or play roulette, one switch each: the family of path_nee, path_mis, path_rr,
 * path_full and light_solid_angle.
 */
#include "lightcheck.h"
#include "registry.h"

enum {
    MIS = 1, /* no bugs: weighs the two techniques, */
    POWER = 2, /* with squares, */
    FULL = 4, /* follows mirrors and glass, */
    ROULETTE = 8, /* ends paths by chance, */
    COSINE = 16, /* samples no light at all */
    COUNTED_TWICE = 32,
    CAMERA_LOST = 64,
    SKY_LOST = 128,
    ONE_DEEPER = 256,
    ONE_SHORT = 512,
    HIT_WEIGHT_ONE = 1024,
    AREA_DENSITY = 2048,
    DELTA_WEIGHTED = 4096,
    SUM_NOT_ONE = 8192,
    COUNT_IN_ONE = 16384,
    NOT_DIVIDED = 32768,
    DIVIDED_TWICE = 65536,
    LOST_AFTER_DELTA = 131072,
    COSINE_MISSING = 262144,
    CHOICE_FORGOTTEN = 524288,
    DEAD_FIRST = 1048576,
    COSINE_AGAIN = 2097152,
    NO_PI = 4194304,
    OTHER_DENSITY = 8388608
};

static double light_pdf(const lc_scene *scene, double pdf_area, double distance, double cos_light, unsigned bugs)
{
    if (!(pdf_area > 0 && cos_light > 0))
        return 0;
    double jacobian = bugs & AREA_DENSITY ? 1 : distance * distance / cos_light;
    return pdf_area * jacobian / lc_light_count(scene);
}

static double share(double pdf, double other, unsigned bugs)
{
    if (!(bugs & MIS))
        return 1;
    if (bugs & POWER || bugs & SUM_NOT_ONE) { /* the latter squares one of the two only */
        pdf *= pdf;
        other *= other;
    }
    return pdf / (pdf + other);
}

static lc_rgb direct(const lc_scene *scene, const lc_hit *hit, double q, lc_sampler *sampler, unsigned bugs)
{
    lc_light_sample light;
    int count = lc_light_count(scene);
    if (count == 0 || bugs & COSINE)
        return lc_black();
    lc_light_sample_one(scene, (int)(lc_next(sampler) * count), hit, sampler, &light);
    double cos_surface = lc_dot(lc_facing(hit->n, hit->wo), light.wi), cos_light = -lc_dot(light.n, light.wi);
    lc_rgb f = lc_bsdf_eval(scene, hit, light.wi);
    if (!(cos_surface > 0 && cos_light > 0 && lc_rgb_max(f) > 0) || !lc_visible(scene, hit, &light))
        return lc_black();
    double pdf_bsdf = q * (bugs & FULL ? lc_bsdf_pdf(scene, hit, light.wi) : cos_surface * LC_INV_PI);
    if (bugs & OTHER_DENSITY)
        pdf_bsdf = 0.5 * LC_INV_PI;
    if (light.is_delta) {
        double weight = bugs & DELTA_WEIGHTED ? share(1, pdf_bsdf, bugs) : 1;
        return lc_rgb_scale(weight * count * cos_surface, lc_rgb_mul(f, light.irradiance));
    }
    double pdf_light = light_pdf(scene, light.pdf_area, light.distance, cos_light, bugs & ~(unsigned)AREA_DENSITY);
    double weight = share(light_pdf(scene, light.pdf_area, light.distance, cos_light, bugs), pdf_bsdf, bugs);
    double cosine = bugs & COSINE_MISSING ? 1 : cos_surface;
    return lc_rgb_scale(weight * cosine / (pdf_light * (bugs & COUNT_IN_ONE ? count : 1)), lc_rgb_mul(f, light.radiance));
}

/* The next direction, what the throughput is multiplied by, and the density; 0 where the path ends. */
static int scatter(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, unsigned bugs, lc_scatter *way,
                   lc_rgb *factor)
{
    if (bugs & FULL) {
        if (!lc_bsdf_sample(scene, hit, sampler, way))
            return 0;
        double cosine = way->is_delta ? 1 : fabs(lc_dot(hit->n, way->wi));
        *factor = lc_rgb_scale(cosine / way->pdf, way->value);
        return 1;
    }
    lc_vec3 n = lc_facing(hit->n, hit->wo);
    double u = lc_next(sampler), v = lc_next(sampler);
    way->is_delta = 0;
    way->wi = lc_cosine_hemisphere(n, u, v);
    way->pdf = lc_dot(n, way->wi) * LC_INV_PI;
    double cosine = bugs & COSINE_AGAIN ? lc_dot(n, way->wi) : 1;
    *factor = lc_rgb_scale(cosine * (bugs & NO_PI ? 1 : LC_PI), lc_bsdf_eval(scene, hit, way->wi));
    return lc_rgb_max(*factor) > 0;
}

/* What a ray that ends at `hit` after k bounces may add. `pdf` is that of its direction, 0 where no light sample competes. */
static double weight_of(const lc_scene *scene, const lc_hit *hit, int k, double pdf, int was_delta, unsigned bugs)
{
    if (k == 0)
        return bugs & CAMERA_LOST ? 0 : 1;
    if (!hit->valid)
        return bugs & SKY_LOST ? 0 : 1;
    if (bugs & COSINE)
        return 1;
    if (was_delta)
        return bugs & LOST_AFTER_DELTA ? 0 : 1;
    if (!(bugs & MIS))
        return bugs & COUNTED_TWICE ? 1 : 0;
    if (bugs & HIT_WEIGHT_ONE)
        return 1;
    bugs &= ~(unsigned)(SUM_NOT_ONE | AREA_DENSITY); /* twice the same mistake would be none: the weights would sum to 1 */
    double pdf_light = light_pdf(scene, lc_light_pdf_area(scene, hit), hit->distance, lc_dot(hit->n, hit->wo), bugs);
    return share(pdf, pdf_light, bugs);
}

static lc_rgb walk(unsigned bugs, const lc_scene *scene, const lc_hit *first, const lc_options *options,
                   lc_sampler *sampler)
{
    lc_rgb sum = lc_black(), throughput = lc_color(1, 1, 1);
    lc_hit hit = *first;
    double pdf = 0;
    int was_delta = 1, lights = options->max_bounces + (bugs & ONE_DEEPER ? 1 : 0) - (bugs & ONE_SHORT ? 1 : 0);
    for (int k = 0;; ++k) {
        double weight = weight_of(scene, &hit, k, pdf, was_delta, bugs);
        if (k >= options->min_bounces && weight > 0)
            sum = lc_rgb_add(sum, lc_rgb_mul(throughput, lc_rgb_scale(weight, lc_emission(scene, &hit))));
        if (!hit.valid || (k == options->max_bounces && k >= lights))
            return sum;
        double q = bugs & ROULETTE ? fmin(0.9, fmax(0.1, lc_rgb_max(lc_material_at(scene, &hit).diffuse))) : 1;
        lc_rgb next = lc_rgb_mul(throughput, direct(scene, &hit, bugs & CHOICE_FORGOTTEN ? 1 : q, sampler, bugs));
        if (k + 1 >= options->min_bounces && k + 1 <= lights)
            sum = lc_rgb_add(sum, next);
        if (k == options->max_bounces)
            return sum;
        lc_scatter way;
        lc_rgb factor;
        if (!scatter(scene, &hit, sampler, bugs, &way, &factor))
            return sum;
        was_delta = way.is_delta;
        if (was_delta)
            q = 1;
        if (lc_next(sampler) >= (bugs & DEAD_FIRST ? q * q : q))
            return sum;
        pdf = q * way.pdf;
        double survivor = bugs & NOT_DIVIDED ? 1 : bugs & DIVIDED_TWICE ? 1 / (q * q) : 1 / q;
        throughput = lc_rgb_mul(throughput, lc_rgb_scale(survivor, factor));
        lc_trace(scene, &hit, way.wi, &hit);
    }
}

/* Directions over the cone of a sphere, with the density of its area, or the other way round. */
static lc_rgb by_solid_angle(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, int by_area)
{
    lc_light_sample light;
    int count = lc_light_count(scene);
    if (count == 0)
        return lc_black();
    int i = (int)(lc_next(sampler) * count);
    lc_light_sample_solid(scene, i, hit, sampler, &light);
    if (by_area && !light.is_delta) {
        double pdf_solid = light.pdf_solid;
        lc_light_sample_one(scene, i, hit, sampler, &light);
        light.pdf_solid = pdf_solid;
    }
    double cos_surface = lc_dot(lc_facing(hit->n, hit->wo), light.wi), cos_light = -lc_dot(light.n, light.wi);
    if (!(cos_surface > 0 && cos_light > 0 && (light.is_delta || light.pdf_solid > 0)) || !lc_visible(scene, hit, &light))
        return lc_black();
    double jacobian = by_area ? 1 : light.distance * light.distance / cos_light; /* the solid angle has it already */
    lc_rgb incoming = light.is_delta ? light.irradiance : lc_rgb_scale(1 / (jacobian * light.pdf_solid), light.radiance);
    return lc_rgb_scale(count * cos_surface, lc_rgb_mul(lc_bsdf_eval(scene, hit, light.wi), incoming));
}

#define WALK(id, bugs) \
    static lc_rgb radiance_##id(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, \
                                const lc_options *options, lc_sampler *sampler) \
    { \
        (void)ray; \
        return walk(bugs, scene, hit, options, sampler); \
    }

#define NEE_MUTANT(id, bugs, of, lobes, emitters, summary) \
    WALK(id, bugs) \
    LC_ESTIMATOR(id) = {LC_ABI, #id, summary, of ", broken", lobes, emitters, LC_UNBOUNDED, radiance_##id}

#define DIRECT_MUTANT(id, bugs, summary) \
    WALK(id, bugs) \
    LC_ESTIMATOR(id) = {LC_ABI, #id, summary, "direct_mis, broken", LC_DIFFUSE, ALL, 1, radiance_##id}

#define SOLID_MUTANT(id, by_area, summary) \
    static lc_rgb radiance_##id(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, \
                                const lc_options *options, lc_sampler *sampler) \
    { \
        (void)ray; \
        lc_rgb sum = options->min_bounces <= 0 ? lc_emission(scene, hit) : lc_black(); \
        if (options->min_bounces <= 1 && options->max_bounces >= 1 && hit->valid) \
            sum = lc_rgb_add(sum, by_solid_angle(scene, hit, sampler, by_area)); \
        return sum; \
    } \
    LC_ESTIMATOR(id) = {LC_ABI, #id,          summary, "light_solid_angle, broken", LC_DIFFUSE, \
                        LC_AREA | LC_POINT | LC_DIRECTIONAL, 1, radiance_##id}

#define ALL (LC_AREA | LC_POINT | LC_DIRECTIONAL | LC_SKY)
#define LOBES (LC_DIFFUSE | LC_MIRROR | LC_GLASS)

NEE_MUTANT(cosine_again, COSINE | COSINE_AGAIN, "path_cosine", LC_DIFFUSE, LC_AREA | LC_SKY,
           "directions by the cosine, and weighted by the cosine as well");
NEE_MUTANT(cosine_no_pi, COSINE | NO_PI, "path_cosine", LC_DIFFUSE, LC_AREA | LC_SKY,
           "the density's 1 / pi is forgotten");
NEE_MUTANT(nee_counted_twice, COUNTED_TWICE, "path_nee", LC_DIFFUSE, ALL, "a light that the path hits counts once more");
NEE_MUTANT(nee_camera_lost, CAMERA_LOST, "path_nee", LC_DIFFUSE, ALL, "a light that the camera sees is black");
NEE_MUTANT(nee_sky_lost, SKY_LOST, "path_nee", LC_DIFFUSE, ALL, "the sky, which no light sample finds, is lost");
NEE_MUTANT(nee_one_deeper, ONE_DEEPER, "path_nee", LC_DIFFUSE, ALL, "lights are sampled at the last surface, too");
NEE_MUTANT(nee_one_short, ONE_SHORT, "path_nee", LC_DIFFUSE, ALL, "light sampling ends one bounce early");
NEE_MUTANT(nee_no_cosine, COSINE_MISSING, "path_nee", LC_DIFFUSE, ALL, "light sampling forgets the surface's cosine");
NEE_MUTANT(nee_no_count, COUNT_IN_ONE, "path_nee", LC_DIFFUSE, ALL, "the number of lights is missing");
NEE_MUTANT(mis_hit_weight_one, MIS | HIT_WEIGHT_ONE, "path_mis", LC_DIFFUSE, ALL, "a light that the path hits has weight 1");
NEE_MUTANT(mis_area_density, MIS | AREA_DENSITY, "path_mis", LC_DIFFUSE, ALL,
           "one weight by pdf_area, as if it were a density over directions");
NEE_MUTANT(mis_delta_weighted, MIS | DELTA_WEIGHTED, "path_mis", LC_DIFFUSE, ALL,
           "a point light is weighted against the BRDF, which never finds it");
NEE_MUTANT(mis_sum_not_one, MIS | SUM_NOT_ONE, "path_mis", LC_DIFFUSE, ALL,
           "power heuristic for one technique, balance for the other");
NEE_MUTANT(mis_other_density, MIS | OTHER_DENSITY, "path_mis", LC_DIFFUSE, ALL,
           "directions by the cosine, but one of the weights by a uniform density");
NEE_MUTANT(mis_power_hit_weight_one, MIS | POWER | HIT_WEIGHT_ONE, "path_mis_power", LC_DIFFUSE, ALL,
           "power heuristic, and a light that the path hits has weight 1");
NEE_MUTANT(mis_power_area_density, MIS | POWER | AREA_DENSITY, "path_mis_power", LC_DIFFUSE, ALL,
           "power heuristic of densities in different measures");
NEE_MUTANT(rr_not_divided, COSINE | ROULETTE | NOT_DIVIDED, "path_rr", LC_DIFFUSE, LC_AREA | LC_SKY,
           "survivors of the roulette are not divided by q");
NEE_MUTANT(rr_divided_twice, COSINE | ROULETTE | DIVIDED_TWICE, "path_rr", LC_DIFFUSE, LC_AREA | LC_SKY,
           "survivors of the roulette are divided by q twice");
NEE_MUTANT(analog_weighted_again, COSINE | ROULETTE | NOT_DIVIDED, "path_analog", LC_DIFFUSE, LC_AREA | LC_SKY,
           "survives with probability = albedo, and is weighted by the albedo as well");
NEE_MUTANT(analog_dies_twice, COSINE | ROULETTE | DEAD_FIRST, "path_analog", LC_DIFFUSE, LC_AREA | LC_SKY,
           "absorbed with probability 1 - albedo where it comes and where it goes");
NEE_MUTANT(full_lost_after_delta, FULL | MIS | ROULETTE | LOST_AFTER_DELTA, "path_full", LOBES, ALL,
           "a light seen in a mirror or through glass is black");
NEE_MUTANT(full_not_divided, FULL | MIS | ROULETTE | NOT_DIVIDED, "path_full", LOBES, ALL,
           "survivors of the roulette are not divided by q");
NEE_MUTANT(full_hit_weight_one, FULL | MIS | ROULETTE | HIT_WEIGHT_ONE, "path_full", LOBES, ALL,
           "a light that the path hits has weight 1");
NEE_MUTANT(full_survival_forgotten, FULL | MIS | ROULETTE | CHOICE_FORGOTTEN, "path_full", LOBES, ALL,
           "of the two weights one knows the survival probability, one does not");
DIRECT_MUTANT(direct_mis_hit_weight_one, MIS | HIT_WEIGHT_ONE, "the BRDF's sample has weight 1");
DIRECT_MUTANT(direct_mis_area_density, MIS | AREA_DENSITY, "one weight by pdf_area, as if it were a density over directions");
SOLID_MUTANT(solid_area_points, 1, "points by area, density of the solid angle");
SOLID_MUTANT(solid_jacobian_again, 0, "the density over directions is converted from area once more");

/* Each after the estimator that it was. */
const lc_mutant lc_nee_mutants[] = {
    {&lc_estimator_cosine_again, "path_cosine", "cosine",
     "The cosine is left in when directions are drawn by it.",
     "any surface lit at a slant: cos",
     "With which probability is this very direction drawn?"},
    {&lc_estimator_cosine_no_pi, "path_cosine", "density",
     "The cosine cancels, and 1 / pi with it.",
     "bounce k: 1 / pi^k",
     "Over the hemisphere, does your density integrate to 1?"},
    {&lc_estimator_nee_counted_twice, "path_nee", "emission",
     "Light sampling is added, the old emission is left in.",
     "one bounce: 2",
     "In how many ways can your path reach this lamp, and does each count once?"},
    {&lc_estimator_nee_camera_lost, "path_nee", "emission",
     "Emission is switched off everywhere once lights are sampled.",
     "camera on a lamp: 0",
     "Look straight into a lamp."},
    {&lc_estimator_nee_sky_lost, "path_nee", "emission",
     "Emission is switched off for all that a ray can meet, the sky as well.",
     "under a sky: 0",
     "Which of your techniques can find the sky?"},
    {&lc_estimator_nee_one_deeper, "path_nee", "bounces",
     "Lights are sampled before the depth is looked at.",
     "a furnace: the value of one bounce more",
     "Count the surfaces between camera and light."},
    {&lc_estimator_nee_one_short, "path_nee", "bounces",
     "The loop ends before the last surface has asked the lights.",
     "a furnace: the value of one bounce less",
     "Count the surfaces between camera and light."},
    {&lc_estimator_nee_no_cosine, "path_nee", "cosine",
     "The cosine was part of the direction sampling and was not carried over.",
     "a lamp at a slant: 1 / cos",
     "How much of a beam does a tilted surface catch?"},
    {&lc_estimator_nee_no_count, "path_nee", "lights",
     "One lamp in all scenes at hand.",
     "N lamps: 1 / N",
     "How many lamps are there, and how often do you ask each?"},
    {&lc_estimator_mis_hit_weight_one, "path_mis", "weights",
     "Only one of the two techniques got its weight.",
     "near a large lamp: up to 2",
     "For one and the same path, do the weights of the two techniques add up to 1?"},
    {&lc_estimator_mis_area_density, "path_mis", "weights",
     "pdf_area stands where a density over directions belongs.",
     "varies with distance, looks like noise",
     "Are both densities of your weight over the same measure?"},
    {&lc_estimator_mis_delta_weighted, "path_mis", "weights",
     "A point light takes the branch of lamps with area.",
     "a point light: dark",
     "Can a ray that is drawn by the BRDF ever meet a point?"},
    {&lc_estimator_mis_sum_not_one, "path_mis", "weights",
     "The heuristic was changed in one of two places.",
     "local, where the techniques compete",
     "For one and the same path, do the weights of the two techniques add up to 1?"},
    {&lc_estimator_mis_other_density, "path_mis", "weights",
     "The function that draws and the one that knows the density are not of the same distribution.",
     "local, where the techniques compete",
     "Does the density in your weight belong to the directions that you draw?"},
    {&lc_estimator_mis_power_hit_weight_one, "path_mis_power", "weights",
     "Only one of the two techniques got its weight.",
     "near a large lamp: up to 2",
     "For one and the same path, do the weights of the two techniques add up to 1?"},
    {&lc_estimator_mis_power_area_density, "path_mis_power", "weights",
     "pdf_area stands where a density over directions belongs.",
     "varies with distance, looks like noise",
     "Are both densities of your weight over the same measure?"},
    {&lc_estimator_rr_not_divided, "path_rr", "roulette",
     "Roulette as an optimisation only.",
     "bounce k: the product of all q",
     "How often does a path survive, and what are survivors divided by?"},
    {&lc_estimator_rr_divided_twice, "path_rr", "roulette",
     "The division stands before the test and after it.",
     "bounce k: one over the product of all q",
     "How often does a path survive, and what are survivors divided by?"},
    {&lc_estimator_analog_weighted_again, "path_analog", "roulette",
     "The albedo decides about survival and still multiplies.",
     "bounce k: albedo^k",
     "What does a particle lose that was not absorbed?"},
    {&lc_estimator_analog_dies_twice, "path_analog", "roulette",
     "Absorption is played when a path comes and when it goes.",
     "bounce k: albedo^k",
     "How often may one surface absorb one particle?"},
    {&lc_estimator_full_lost_after_delta, "path_full", "emission",
     "Emission is left to light sampling, which cannot see through a mirror.",
     "a lamp in a mirror: 0",
     "Which of your techniques finds a lamp in a mirror?"},
    {&lc_estimator_full_not_divided, "path_full", "roulette",
     "Roulette as an optimisation only.",
     "bounce k: the product of all q",
     "How often does a path survive, and what are survivors divided by?"},
    {&lc_estimator_full_hit_weight_one, "path_full", "weights",
     "Only one of the two techniques got its weight.",
     "near a large lamp: up to 2",
     "For one and the same path, do the weights of the two techniques add up to 1?"},
    {&lc_estimator_full_survival_forgotten, "path_full", "weights",
     "The density of a path that may end lacks the probability that it goes on.",
     "local, where the techniques compete",
     "For one and the same path, do the weights of the two techniques add up to 1?"},
    {&lc_estimator_direct_mis_hit_weight_one, "direct_mis", "weights",
     "Only one of the two techniques got its weight.",
     "near a large lamp: up to 2",
     "For one and the same path, do the weights of the two techniques add up to 1?"},
    {&lc_estimator_direct_mis_area_density, "direct_mis", "weights",
     "pdf_area stands where a density over directions belongs.",
     "varies with distance, looks like noise",
     "Are both densities of your weight over the same measure?"},
    {&lc_estimator_solid_area_points, "light_solid_angle", "density",
     "A better density, without its way to draw.",
     "near a sphere: local",
     "With which probability is this very point drawn?"},
    {&lc_estimator_solid_jacobian_again, "light_solid_angle", "density",
     "The conversion from area was left in.",
     "anywhere: d^2 / cos over and over",
     "Which measure is your density over already?"},
    LC_MUTANT_END,
};
