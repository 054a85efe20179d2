/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Estimators that are right in another way than ours: no check may accuse them. Other densities, other choices, strata, roulette
 * with any probability, single precision.
 */
#include "lightcheck.h"
#include "registry.h"

enum {
    UNEVEN_CHOICE = 1,
    ALL_LIGHTS = 2,
    TWO_SAMPLES = 4,
    ANTITHETIC = 8,
    SINGLE = 16,
    COSINE = 32,
    SPHERE = 64,
    STRATA = 128,
    MIXTURE = 256,
    ANALOG = 512,
    NEVER_ENDS = 1024,
    HALF = 2048,
    BY_THROUGHPUT = 4096,
    HOST_SAMPLES = 8192
};

/* f L V cos cos / d^2 over the density of the point, or f E V cos. */
static lc_rgb from_light(const lc_scene *scene, const lc_hit *hit, const lc_light_sample *light, unsigned how)
{
    double cos_surface = lc_dot(lc_facing(hit->n, hit->wo), light->wi);
    if (!(cos_surface > 0))
        return lc_black();
    lc_rgb incoming = light->irradiance;
    if (!light->is_delta) {
        double g = fmax(-lc_dot(light->n, light->wi), 0) / (light->distance * light->distance * light->pdf_area);
        incoming = lc_rgb_scale(how & SINGLE ? (double)(float)g : g, light->radiance);
    }
    if (!(lc_rgb_max(incoming) > 0) || !lc_visible(scene, hit, light))
        return lc_black();
    lc_rgb f = lc_bsdf_eval(scene, hit, light->wi);
    return lc_rgb_scale(how & SINGLE ? (double)(float)cos_surface : cos_surface, lc_rgb_mul(f, incoming));
}

/* One light, its number from u in [0, 1): the first half of the time, or all alike. */
static lc_rgb one_light(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, double u, unsigned how)
{
    int count = lc_light_count(scene), chosen = (int)(u * count);
    double probability = 1.0 / count;
    lc_light_sample light;
    if (how & UNEVEN_CHOICE && count > 1) {
        chosen = u < 0.5 ? 0 : 1 + (int)((2 * u - 1) * (count - 1));
        probability = chosen == 0 ? 0.5 : 0.5 / (count - 1);
    }
    lc_light_sample_one(scene, chosen, hit, sampler, &light);
    return lc_rgb_scale(1 / probability, from_light(scene, hit, &light, how));
}

static lc_rgb by_light(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, unsigned how)
{
    lc_rgb sum = lc_black();
    lc_light_sample light;
    if (lc_light_count(scene) == 0)
        return sum;
    for (int i = 0; how & ALL_LIGHTS && i < lc_light_count(scene); ++i) {
        lc_light_sample_one(scene, i, hit, sampler, &light);
        sum = lc_rgb_add(sum, from_light(scene, hit, &light, how));
    }
    if (how & ALL_LIGHTS)
        return sum;
    double u = lc_next(sampler);
    sum = one_light(scene, hit, sampler, u, how);
    if (!(how & (TWO_SAMPLES | ANTITHETIC)))
        return sum;
    double other = how & ANTITHETIC ? fmin(1 - u, 1 - 0x1p-53) : lc_next(sampler);
    return lc_rgb_scale(0.5, lc_rgb_add(sum, one_light(scene, hit, sampler, other, how)));
}

/* A direction and its density [1/sr]. */
static lc_vec3 choose(double *pdf_solid, lc_vec3 n, double u, double v, lc_sampler *sampler, unsigned how)
{
    int cosine = how & COSINE || (how & MIXTURE && lc_next(sampler) < 0.5);
    lc_vec3 wi = cosine ? lc_cosine_hemisphere(n, u, v) : lc_uniform_hemisphere(n, u, v);
    double by_cosine = lc_dot(n, wi) * LC_INV_PI, uniform = 0.5 * LC_INV_PI;
    *pdf_solid = how & MIXTURE ? 0.5 * (by_cosine + uniform) : how & COSINE ? by_cosine : uniform;
    if (how & SPHERE) {
        *pdf_solid = 0.25 * LC_INV_PI;
        return lc_next(sampler) < 0.5 ? lc_neg(wi) : wi;
    }
    return wi;
}

static lc_rgb by_hemisphere(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, unsigned how)
{
    lc_vec3 n = lc_facing(hit->n, hit->wo);
    lc_rgb sum = lc_black();
    int count = how & STRATA ? 4 : 1;
    for (int i = 0; i < count; ++i) {
        double pdf_solid, u = (lc_next(sampler) + i) / count, v = lc_next(sampler);
        lc_vec3 wi = choose(&pdf_solid, n, fmin(u, 1 - 0x1p-53), v, sampler, how);
        lc_hit next;
        lc_trace(scene, hit, wi, &next);
        double weight = fmax(lc_dot(n, wi), 0) / (pdf_solid * count);
        if (weight > 0)
            sum = lc_rgb_add(sum, lc_rgb_scale(weight, lc_rgb_mul(lc_bsdf_eval(scene, hit, wi), lc_emission(scene, &next))));
    }
    return sum;
}

typedef lc_rgb direct_fn(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, unsigned how);

static lc_rgb sum(direct_fn *direct, unsigned how, const lc_scene *scene, const lc_hit *hit, const lc_options *options,
                  lc_sampler *sampler)
{
    lc_rgb total = options->min_bounces <= 0 ? lc_emission(scene, hit) : lc_black();
    if (options->min_bounces <= 1 && options->max_bounces >= 1 && hit->valid)
        total = lc_rgb_add(total, direct(scene, hit, sampler, how));
    return total;
}

/* Probability with which the path goes on. */
static double survival(unsigned how, lc_rgb albedo, lc_rgb throughput)
{
    if (how & ANALOG)
        return lc_rgb_max(albedo);
    if (how & BY_THROUGHPUT)
        return fmin(lc_rgb_max(throughput), 1);
    return how & HALF ? 0.5 : 1;
}

static lc_rgb walk(direct_fn *direct, unsigned how, const lc_scene *scene, const lc_hit *first,
                   const lc_options *options, lc_sampler *sampler)
{
    lc_rgb total = lc_black(), throughput = lc_color(1, 1, 1);
    lc_hit hit = *first;
    (void)direct;
    for (int k = 0;; ++k) {
        if (k >= options->min_bounces)
            total = lc_rgb_add(total, lc_rgb_mul(throughput, lc_emission(scene, &hit)));
        if (k == options->max_bounces || !hit.valid)
            return total;
        lc_vec3 n = lc_facing(hit.n, hit.wo), wi;
        double pdf_solid, u = lc_next(sampler), v = lc_next(sampler);
        wi = choose(&pdf_solid, n, u, v, sampler, how);
        lc_scatter scatter;
        lc_rgb f = lc_bsdf_eval(scene, &hit, wi);
        if (how & HOST_SAMPLES) {
            if (!lc_bsdf_sample(scene, &hit, sampler, &scatter) || scatter.is_delta)
                return total;
            wi = scatter.wi, f = scatter.value, pdf_solid = scatter.pdf;
        }
        throughput = lc_rgb_mul(throughput, lc_rgb_scale(lc_dot(n, wi) / pdf_solid, f));
        double q = survival(how, lc_material_at(scene, &hit).diffuse, throughput);
        if (!(lc_rgb_max(throughput) > 0) || lc_next(sampler) >= q)
            return total;
        throughput = lc_rgb_scale(1 / q, throughput);
        lc_trace(scene, &hit, wi, &hit);
    }
}

/* One of the lobes, all equally likely; light is reflected or refracted by the toss of a coin. Returns what the path is multiplied by. */
static lc_rgb toss(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_vec3 *wi)
{
    lc_material m = lc_material_at(scene, hit);
    int lobes[3], count = 0;
    if (lc_rgb_max(m.diffuse) > 0)
        lobes[count++] = LC_DIFFUSE;
    if (lc_rgb_max(m.mirror) > 0)
        lobes[count++] = LC_MIRROR;
    if (m.glass > 0)
        lobes[count++] = LC_GLASS;
    if (count == 0)
        return lc_black();
    int lobe = lobes[(int)(lc_next(sampler) * count)];
    lc_vec3 n = lc_facing(hit->n, hit->wo);
    if (lobe == LC_DIFFUSE) {
        double u = lc_next(sampler), v = lc_next(sampler);
        *wi = lc_cosine_hemisphere(n, u, v);
        return lc_rgb_scale(count * LC_PI, lc_bsdf_eval(scene, hit, *wi));
    }
    double f = lc_fresnel(fabs(lc_dot(hit->n, hit->wo)), m.ior), weight = 2 * count * m.glass;
    *wi = lc_reflect(hit->wo, hit->n);
    if (lobe == LC_MIRROR)
        return lc_rgb_scale(count, m.mirror);
    if (lc_next(sampler) < 0.5)
        return lc_color(weight * f, weight * f, weight * f);
    if (!lc_refract(hit->wo, hit->n, m.ior, wi))
        return lc_black();
    weight *= (1 - f) / (m.ior * m.ior);
    return lc_color(weight, weight, weight);
}

static lc_rgb tossed(direct_fn *direct, unsigned how, const lc_scene *scene, const lc_hit *first, const lc_options *options,
                     lc_sampler *sampler)
{
    lc_rgb total = lc_black(), throughput = lc_color(1, 1, 1);
    lc_hit hit = *first;
    (void)direct, (void)how;
    for (int k = 0;; ++k) {
        if (k >= options->min_bounces)
            total = lc_rgb_add(total, lc_rgb_mul(throughput, lc_emission(scene, &hit)));
        if (k == options->max_bounces || !hit.valid)
            return total;
        lc_vec3 wi;
        throughput = lc_rgb_mul(throughput, toss(scene, &hit, sampler, &wi));
        if (!(lc_rgb_max(throughput) > 0))
            return total;
        lc_trace(scene, &hit, wi, &hit);
    }
}

#define LIGHT "light_direct", LC_DIFFUSE, LC_AREA | LC_POINT | LC_DIRECTIONAL, 1
#define AREA "three_point", LC_DIFFUSE, LC_AREA, 1
#define HEMISPHERE "hemisphere_direct", LC_DIFFUSE, LC_AREA | LC_SKY, 1
#define PATH "path", LC_DIFFUSE, LC_AREA | LC_SKY, LC_UNBOUNDED
#define GLASS "dielectric", LC_DIFFUSE | LC_MIRROR | LC_GLASS, LC_AREA | LC_SKY, LC_UNBOUNDED

#define VARIANTS(X) \
    X(light_uneven_choice, sum, by_light, UNEVEN_CHOICE, LIGHT, "half of the samples go to the first light") \
    X(light_all, sum, by_light, ALL_LIGHTS, LIGHT, "every light is sampled, none is chosen") \
    X(light_two_samples, sum, by_light, TWO_SAMPLES, LIGHT, "the mean of two samples") \
    X(light_antithetic, sum, by_light, ANTITHETIC, LIGHT, "two samples, lights chosen by u and 1 - u") \
    X(light_single, sum, by_light, SINGLE, LIGHT, "single precision") \
    X(three_point_by_light, sum, by_light, 0, AREA, "a light first, then a point on it") \
    X(three_point_all, sum, by_light, ALL_LIGHTS, AREA, "a point on every light") \
    X(three_point_uneven_choice, sum, by_light, UNEVEN_CHOICE, AREA, "half of the points lie on the first light") \
    X(hemisphere_cosine, sum, by_hemisphere, COSINE, HEMISPHERE, "directions by the cosine, with their density") \
    X(hemisphere_sphere, sum, by_hemisphere, SPHERE, HEMISPHERE, "directions over the sphere, with their density") \
    X(hemisphere_strata, sum, by_hemisphere, STRATA, HEMISPHERE, "four directions, one in each ring") \
    X(hemisphere_mixture, sum, by_hemisphere, MIXTURE, HEMISPHERE, "half uniform, half by the cosine") \
    X(path_by_cosine, walk, by_light, COSINE, PATH, "directions by the cosine, with their density") \
    X(path_by_mixture, walk, by_light, MIXTURE, PATH, "half uniform, half by the cosine") \
    X(path_host_samples, walk, by_light, HOST_SAMPLES, PATH, "directions from lc_bsdf_sample()") \
    X(path_absorbed, walk, by_light, COSINE | ANALOG, PATH, "survives with probability = albedo") \
    X(path_never_ends, walk, by_light, NEVER_ENDS, PATH, "roulette that never acts") \
    X(path_half_survive, walk, by_light, HALF, PATH, "survives with probability 1/2, whatever it carries") \
    X(path_by_throughput, walk, by_light, BY_THROUGHPUT, PATH, "survives with probability = throughput") \
    X(specular_even, tossed, by_light, 0, GLASS, "all lobes equally likely, reflected or refracted by the toss of a coin")

#define DEFINE(id, function, direct, how, language, summary) \
    static lc_rgb radiance_##id(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, \
                                const lc_options *options, lc_sampler *sampler) \
    { \
        (void)ray; \
        return function(direct, how, scene, hit, options, sampler); \
    } \
    DESCRIBE(id, summary, language)
#define DESCRIBE(id, summary, ...) DESCRIBE_AS(id, summary, __VA_ARGS__)
#define DESCRIBE_AS(id, summary, of, lobes, emitters, most) \
    LC_ESTIMATOR(id) = {LC_ABI, #id, summary, of ", in another way", lobes, emitters, most, radiance_##id};

VARIANTS(DEFINE)

#define MEMBER(id, function, direct, how, language, summary) &lc_estimator_##id,

const lc_estimator *const lc_variants[] = {VARIANTS(MEMBER) 0};
