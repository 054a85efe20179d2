/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Bugs of mirrors and of glass, one switch each: the family of mirror and dielectric.
 */
#include "lightcheck.h"

enum {
    GLASS = 1, /* no bug: follows glass, too */
    EXTRA_COSINE = 2,
    WRONG_SIGN = 4,
    NO_ALBEDO = 8,
    NOT_DIVIDED = 16,
    DIVIDED_SWAPPED = 32,
    NOT_COUNTED = 64,
    SCHLICK = 128,
    ETA_INVERTED = 256,
    ALWAYS_ENTERS = 512,
    TOTAL_IS_BLACK = 1024,
    NO_IOR_SQUARED = 2048,
    WEIGHTED_AGAIN = 4096,
    NEVER_REFLECTS = 8192,
    SWAPPED = 16384,
    STRAIGHT = 32768
};

/* With the cosine on the thinner side, as it has to be. */
static double schlick(double cos_i, double ior)
{
    double r0 = (ior - 1) / (ior + 1);
    double cos2 = ior < 1 ? 1 - (1 - cos_i * cos_i) / (ior * ior) : cos_i * cos_i;
    return cos2 > 0 ? r0 * r0 + (1 - r0 * r0) * pow(1 - sqrt(cos2), 5) : 1;
}

/* Returns what the throughput is multiplied by. */
static double glass(const lc_hit *hit, double ior, lc_sampler *sampler, unsigned bugs, lc_vec3 *wi)
{
    double cos_i = fabs(lc_dot(hit->n, hit->wo));
    if (bugs & ETA_INVERTED || (bugs & ALWAYS_ENTERS && ior < 1))
        ior = 1 / ior;
    double fresnel = bugs & SCHLICK ? schlick(cos_i, ior) : lc_fresnel(cos_i, ior);
    double choice = bugs & NEVER_REFLECTS ? 0 : bugs & SWAPPED ? 1 - fresnel : fresnel;
    int is_total = !lc_refract(hit->wo, hit->n, ior, wi);
    if (is_total && bugs & TOTAL_IS_BLACK)
        return 0;
    if (lc_next(sampler) < choice || is_total) {
        *wi = lc_reflect(hit->wo, hit->n);
        return bugs & WEIGHTED_AGAIN ? fresnel : 1;
    }
    if (bugs & STRAIGHT)
        *wi = lc_neg(hit->wo);
    return (bugs & WEIGHTED_AGAIN ? 1 - fresnel : 1) / (bugs & NO_IOR_SQUARED ? 1 : ior * ior);
}

/* What the quotient leaves of 1 / q for a lobe that is chosen with probability q. */
static double divide(double q, unsigned bugs)
{
    if (bugs & NOT_DIVIDED || (bugs & DIVIDED_SWAPPED && q == 1))
        return 1;
    return bugs & DIVIDED_SWAPPED ? 1 / (1 - q) : 1 / q;
}

static lc_rgb scatter(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, unsigned bugs, lc_vec3 *wi,
                      int *lobe)
{
    lc_material material = lc_material_at(scene, hit);
    double mirror = lc_rgb_max(material.mirror), diffuse = lc_rgb_max(material.diffuse);
    double share = bugs & GLASS ? material.glass : 0, total = mirror + diffuse + share;
    if (total == 0)
        return lc_black();
    double choice = lc_next(sampler) * total;
    if (choice < share) {
        double weight = total * glass(hit, material.ior, sampler, bugs, wi);
        *lobe = LC_GLASS;
        return lc_color(weight, weight, weight);
    }
    lc_vec3 n = lc_facing(hit->n, hit->wo);
    if (choice < share + mirror) {
        double weight = divide(mirror / total, bugs) * (bugs & EXTRA_COSINE ? lc_dot(n, hit->wo) : 1);
        *wi = lc_reflect(hit->wo, n);
        if (bugs & WRONG_SIGN) /* the formula for the incoming direction, put to use on the outgoing one */
            *wi = lc_neg(*wi);
        *lobe = LC_MIRROR;
        return lc_rgb_scale(weight, bugs & NO_ALBEDO ? lc_color(1, 1, 1) : material.mirror);
    }
    double u = lc_next(sampler), v = lc_next(sampler);
    *wi = lc_uniform_hemisphere(n, u, v);
    *lobe = LC_DIFFUSE;
    return lc_rgb_scale(2 * LC_PI * lc_dot(n, *wi) * divide(diffuse / total, bugs), lc_bsdf_eval(scene, hit, *wi));
}

static lc_rgb walk(unsigned bugs, const lc_scene *scene, const lc_hit *first, const lc_options *options,
                   lc_sampler *sampler)
{
    lc_rgb sum = lc_black(), throughput = lc_color(1, 1, 1);
    lc_hit hit = *first;
    int k = 0;
    for (int step = 0; step < 1000; ++step) { /* two mirrors would hold a path that does not count them for ever */
        if (k >= options->min_bounces)
            sum = lc_rgb_add(sum, lc_rgb_mul(throughput, lc_emission(scene, &hit)));
        if (k == options->max_bounces || !hit.valid)
            break;
        lc_vec3 wi;
        int lobe = 0;
        throughput = lc_rgb_mul(throughput, scatter(scene, &hit, sampler, bugs, &wi, &lobe));
        if (lc_rgb_max(throughput) == 0)
            break;
        lc_trace(scene, &hit, wi, &hit);
        k += !(bugs & NOT_COUNTED && lobe == LC_MIRROR);
    }
    return sum;
}

#define RADIANCE(id, bugs) \
    static lc_rgb radiance_##id(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, \
                                const lc_options *options, lc_sampler *sampler) \
    { \
        (void)ray; \
        return walk(bugs, scene, hit, options, sampler); \
    }

#define MIRROR_MUTANT(id, bugs, summary) \
    RADIANCE(id, bugs) \
    LC_ESTIMATOR(id) = {LC_ABI,           #id,          summary,      "mirror, broken", LC_DIFFUSE | LC_MIRROR, \
                        LC_AREA | LC_SKY, LC_UNBOUNDED, radiance_##id}

#define GLASS_MUTANT(id, bugs, summary) \
    RADIANCE(id, GLASS | (bugs)) \
    LC_ESTIMATOR(id) = { \
        LC_ABI,           #id,          summary,      "dielectric, broken", LC_DIFFUSE | LC_MIRROR | LC_GLASS, \
        LC_AREA | LC_SKY, LC_UNBOUNDED, radiance_##id}

MIRROR_MUTANT(mirror_extra_cosine, EXTRA_COSINE, "a mirror's share is multiplied by the cosine");
MIRROR_MUTANT(mirror_wrong_sign, WRONG_SIGN, "the reflected direction has the wrong sign: it goes through");
MIRROR_MUTANT(mirror_no_albedo, NO_ALBEDO, "every mirror is white");
MIRROR_MUTANT(mirror_not_divided, NOT_DIVIDED, "half a mirror is chosen with probability q, nothing is divided by it");
MIRROR_MUTANT(mirror_divided_swapped, DIVIDED_SWAPPED, "half a mirror: q and 1 - q are swapped in the division");
MIRROR_MUTANT(mirror_not_counted, NOT_COUNTED, "a mirror counts no bounce");
GLASS_MUTANT(dielectric_schlick, SCHLICK, "Schlick's approximation instead of Fresnel's formula");
GLASS_MUTANT(dielectric_eta_inverted, ETA_INVERTED, "the index is upside down");
GLASS_MUTANT(dielectric_always_enters, ALWAYS_ENTERS, "light that leaves the glass is treated as if it entered it");
GLASS_MUTANT(dielectric_total_is_black, TOTAL_IS_BLACK, "total reflection returns black");
GLASS_MUTANT(dielectric_no_ior_squared, NO_IOR_SQUARED, "1 / ior^2 is missing");
GLASS_MUTANT(dielectric_weighted_again, WEIGHTED_AGAIN, "chosen with F, and weighted by F as well");
GLASS_MUTANT(dielectric_never_reflects, NEVER_REFLECTS, "F is ignored: light is refracted wherever it can be");
GLASS_MUTANT(dielectric_swapped, SWAPPED, "reflected with 1 - F, refracted with F");
GLASS_MUTANT(dielectric_straight, STRAIGHT, "refraction does not bend");
