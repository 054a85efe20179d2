/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Bugs of mirrors and of glass, one switch each: the family of mirror and dielectric.
 */
#include "lightcheck.h"
#include "registry.h"

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
    STRAIGHT = 32768,
    IOR_ONCE = 1 << 16,
    IOR_SQUARED_INVERTED = 1 << 17,
    ONE_POLARISATION = 1 << 18,
    HALF_AND_HALF = 1 << 19,
    NOT_SEEN_IN_MIRROR = 1 << 20,
    ALBEDO_TWICE = 1 << 21
};

/* With the cosine on the thinner side, as it has to be. */
static double schlick(double cos_i, double ior)
{
    double r0 = (ior - 1) / (ior + 1);
    double cos2 = ior < 1 ? 1 - (1 - cos_i * cos_i) / (ior * ior) : cos_i * cos_i;
    return cos2 > 0 ? r0 * r0 + (1 - r0 * r0) * pow(1 - sqrt(cos2), 5) : 1;
}

/* The reflectance for light that is polarised across the plane of incidence. */
static double fresnel_across(double cos_i, double ior)
{
    double sin2 = (1 - cos_i * cos_i) / (ior * ior);
    if (sin2 >= 1)
        return 1;
    double cos_t = sqrt(1 - sin2), r = (cos_i - ior * cos_t) / (cos_i + ior * cos_t);
    return r * r;
}

/* What refraction multiplies radiance by. */
static double squeeze(double ior, unsigned bugs)
{
    if (bugs & NO_IOR_SQUARED)
        return 1;
    return bugs & IOR_ONCE ? 1 / ior : bugs & IOR_SQUARED_INVERTED ? ior * ior : 1 / (ior * ior);
}

/* Returns what the throughput is multiplied by. */
static double glass(const lc_hit *hit, double ior, lc_sampler *sampler, unsigned bugs, lc_vec3 *wi)
{
    double cos_i = fabs(lc_dot(hit->n, hit->wo));
    if (bugs & ETA_INVERTED || (bugs & ALWAYS_ENTERS && ior < 1))
        ior = 1 / ior;
    double fresnel = bugs & SCHLICK ? schlick(cos_i, ior) : lc_fresnel(cos_i, ior);
    if (bugs & ONE_POLARISATION)
        fresnel = fresnel_across(cos_i, ior);
    double choice = bugs & HALF_AND_HALF ? 0.5 : bugs & NEVER_REFLECTS ? 0 : bugs & SWAPPED ? 1 - fresnel : fresnel;
    int is_total = !lc_refract(hit->wo, hit->n, ior, wi);
    if (is_total && bugs & TOTAL_IS_BLACK)
        return 0;
    if (lc_next(sampler) < choice || is_total) {
        *wi = lc_reflect(hit->wo, hit->n);
        return bugs & WEIGHTED_AGAIN ? fresnel : 1;
    }
    if (bugs & STRAIGHT)
        *wi = lc_neg(hit->wo);
    return (bugs & WEIGHTED_AGAIN ? 1 - fresnel : 1) * squeeze(ior, bugs);
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
        if (bugs & ALBEDO_TWICE)
            return lc_rgb_scale(weight, lc_rgb_mul(material.mirror, material.mirror));
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
    int k = 0, lobe = 0;
    for (int step = 0; step < 1000; ++step) { /* two mirrors would hold a path that does not count them for ever */
        if (k >= options->min_bounces && !(bugs & NOT_SEEN_IN_MIRROR && lobe == LC_MIRROR))
            sum = lc_rgb_add(sum, lc_rgb_mul(throughput, lc_emission(scene, &hit)));
        if (k == options->max_bounces || !hit.valid)
            break;
        lc_vec3 wi;
        lobe = 0;
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

#define MIRROR_MUTANT(id, bugs, summary, category, story, shows, hint) \
    RADIANCE(id, bugs) \
    LC_ESTIMATOR(id) = {LC_ABI,           #id,          summary,      "mirror, broken", LC_DIFFUSE | LC_MIRROR, \
                        LC_AREA | LC_SKY, LC_UNBOUNDED, radiance_##id};

#define GLASS_MUTANT(id, bugs, summary, category, story, shows, hint) \
    RADIANCE(id, GLASS | (bugs)) \
    LC_ESTIMATOR(id) = { \
        LC_ABI,           #id,          summary,      "dielectric, broken", LC_DIFFUSE | LC_MIRROR | LC_GLASS, \
        LC_AREA | LC_SKY, LC_UNBOUNDED, radiance_##id};

#define MIRRORS(X) \
    X(mirror_extra_cosine, EXTRA_COSINE, "a mirror's share is multiplied by the cosine", "mirror", \
      "The delta's 1 / cos is forgotten, the rendering equation's cosine is not.", "mirror at angle t: cos t", \
      "What does an oblique mirror return of what it reflects?") \
    X(mirror_wrong_sign, WRONG_SIGN, "the reflected direction has the wrong sign: it goes through", "mirror", \
      "The formula for the incoming direction, put to use on the outgoing one.", "what is behind the mirror", \
      "Which way do your directions point: to the surface or away?") \
    X(mirror_no_albedo, NO_ALBEDO, "every mirror is white", "mirror", \
      "Only the direction was implemented.", "mirror of albedo a: 1 / a a channel", \
      "What colour is a lamp in a red mirror?") \
    X(mirror_albedo_twice, ALBEDO_TWICE, "a mirror's albedo counts twice", "mirror", \
      "Once in the BRDF's value, once in the throughput.", "mirror of albedo a: a a channel", \
      "What colour is a lamp in a red mirror?") \
    X(mirror_not_divided, NOT_DIVIDED, "half a mirror is chosen with probability q, nothing is divided by it", \
      "mirror", \
      "A particle must choose, and its choice is not paid for.", "half a mirror: q", \
      "With which probability is this lobe chosen, and who pays for it?") \
    X(mirror_divided_swapped, DIVIDED_SWAPPED, "half a mirror: q and 1 - q are swapped in the division", "mirror", \
      "Two branches changed places.", "half a mirror: q / (1 - q)", \
      "With which probability is this lobe chosen, and who pays for it?") \
    X(mirror_not_counted, NOT_COUNTED, "a mirror counts no bounce", "bounces", \
      "Specular hits are thought to be free.", "corridor: more terms than asked for", \
      "Count the surfaces between camera and light.") \
    X(mirror_light_not_seen, NOT_SEEN_IN_MIRROR, "a lamp seen in a mirror is black", "emission", \
      "After a bounce emission counts only through light sampling, which a mirror cannot do.", \
      "mirror facing a lamp: 0", "Look at a lamp by way of a mirror.")

MIRRORS(MIRROR_MUTANT)

#define OF "mirror"
const lc_mutant lc_mirror_mutants[] = {MIRRORS(LC_MUTANT_ROW) LC_MUTANT_END};
#undef OF

#define GLASSES(X) \
    X(dielectric_schlick, SCHLICK, "Schlick's approximation instead of Fresnel's formula", "glass", \
      "Taken for exact.", "60 degrees, n = 1.33: R -14%", "How exact is your reflectance at 60 degrees?") \
    X(dielectric_one_polarisation, ONE_POLARISATION, "the reflectance of one polarisation instead of the mean of both", \
      "glass", \
      "Only one of Fresnel's two formulas.", "60 degrees: R twice as large", \
      "Light has two polarisations: where are they in your formula?") \
    X(dielectric_eta_inverted, ETA_INVERTED, "the index is upside down", "glass", \
      "Which side is beyond and which is here.", "total reflection on the wrong side", \
      "From which side can light be totally reflected?") \
    X(dielectric_always_enters, ALWAYS_ENTERS, "light that leaves the glass is treated as if it entered it", "glass", \
      "Written for the outside of a ball.", "slab and ball: directions inside", \
      "What changes between entering and leaving glass?") \
    X(dielectric_total_is_black, TOTAL_IS_BLACK, "total reflection returns black", "glass", \
      "refract() fails, and so does the path.", "beyond the critical angle: 0", \
      "Where does light go that cannot leave the glass?") \
    X(dielectric_no_ior_squared, NO_IOR_SQUARED, "1 / ior^2 is missing", "glass", \
      "Blind wherever light goes in and out again (knightcrawler25/GLSL-PathTracer issue 25 asks why it " \
      "worked without).", "emitter on the other side: ior^2", \
      "What is conserved at an interface: radiance, or something else?") \
    X(dielectric_ior_once, IOR_ONCE, "1 / ior instead of 1 / ior^2", "glass", \
      "The square is forgotten (pjessesco/caramel pull 38).", "emitter on the other side: ior", \
      "What is conserved at an interface: radiance, or something else?") \
    X(dielectric_ior_squared_inverted, IOR_SQUARED_INVERTED, "ior^2 instead of 1 / ior^2", "glass", \
      "The factor of particles that start at the light.", "emitter on the other side: ior^4", \
      "What is conserved at an interface: radiance, or something else?") \
    X(dielectric_weighted_again, WEIGHTED_AGAIN, "chosen with F, and weighted by F as well", "glass", \
      "Nothing is divided by the probability of the choice.", "furnace: F^2 + (1 - F)^2", \
      "With which probability is this lobe chosen, and who pays for it?") \
    X(dielectric_half_and_half, HALF_AND_HALF, "reflected with probability 1/2, F is not in the weights", "glass", \
      "F was meant to come with the weights.", "R is 1/2 at all angles", \
      "How much does a window reflect when you face it?") \
    X(dielectric_never_reflects, NEVER_REFLECTS, "F is ignored: light is refracted wherever it can be", "glass", \
      "Reflection left for later.", "reflected share: 0", "How much does a window reflect when you face it?") \
    X(dielectric_swapped, SWAPPED, "reflected with 1 - F, refracted with F", "glass", \
      "Two branches changed places.", "reflected share: (1 - F) / F", \
      "How much does a window reflect when you face it?") \
    X(dielectric_straight, STRAIGHT, "refraction does not bend", "glass", \
      "A thin pane is taken for thick glass.", "slab: no offset", "Draw the ray through a thick slab.")

GLASSES(GLASS_MUTANT)

#define OF "dielectric"
const lc_mutant lc_dielectric_mutants[] = {GLASSES(LC_MUTANT_ROW) LC_MUTANT_END};
#undef OF
