/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Bugs of the path tracing algorithm, one switch each: the family of path.
 */
#include "lightcheck.h"
#include "registry.h"

enum {
    NO_COSINE = 1,
    COSINE_TWICE = 2,
    NO_PI = 4,
    COSINE_DIRECTIONS = 8,
    COSINE_DENSITY = 16,
    NORMAL_NOT_TURNED = 32,
    ALBEDO_ONCE = 64,
    U_REACHES_ONE = 128,
    TOO_DEEP = 256,
    TOO_SHORT = 512,
    EMISSION_LAST = 1024,
    ENDS_AT_LIGHT = 2048,
    NO_CAMERA_EMISSION = 4096,
    NO_CAMERA_SKY = 8192,
    REUSES_NUMBERS = 1 << 14,
    SAME_NUMBER = 1 << 15,
    ROULETTE_INVERTED = 1 << 17,
    ROULETTE_CAPPED = 1 << 18,
    HALF_DENSITY = 1 << 19,
    GAMMA = 1 << 20,
    EMISSION_UNWEIGHTED = 1 << 21,
    ROULETTE_DIMMEST = 1 << 22
};

/* f cos_surface / pdf_solid, and the direction. `k` reflections came before. */
static lc_rgb scatter(const lc_scene *scene, const lc_hit *hit, const double *first, lc_sampler *sampler,
                      unsigned bugs, int k, lc_vec3 *wi)
{
    lc_vec3 n = bugs & NORMAL_NOT_TURNED ? hit->n : lc_facing(hit->n, hit->wo);
    double u = lc_next(sampler), v = lc_next(sampler);
    double cos_surface, pdf_solid = (bugs & HALF_DENSITY ? 1.0 : 0.5) * LC_INV_PI;
    if (bugs & REUSES_NUMBERS)
        u = first[0], v = first[1];
    if (bugs & SAME_NUMBER)
        v = u;
    if (bugs & U_REACHES_ONE) {
        u = floor(u * 32768) / 32767; /* rand() / RAND_MAX, closed at 1, where cosine and density are both 0 */
        *wi = lc_cosine_hemisphere(n, u, v);
        cos_surface = sqrt(1 - u);
        pdf_solid = cos_surface * LC_INV_PI;
    } else {
        *wi = bugs & COSINE_DIRECTIONS ? lc_cosine_hemisphere(n, u, v) : lc_uniform_hemisphere(n, u, v);
        cos_surface = lc_dot(n, *wi);
    }
    if (bugs & COSINE_DENSITY)
        pdf_solid = cos_surface * LC_INV_PI;
    lc_rgb f = lc_bsdf_eval(scene, hit, *wi);
    if (bugs & ALBEDO_ONCE && k > 0 && lc_rgb_max(f) > 0)
        f = lc_color(LC_INV_PI, LC_INV_PI, LC_INV_PI);
    if (bugs & GAMMA)
        f = lc_color(LC_INV_PI * pow(LC_PI * f.r, 2.2), LC_INV_PI * pow(LC_PI * f.g, 2.2),
                     LC_INV_PI * pow(LC_PI * f.b, 2.2));
    double cosine = bugs & NO_COSINE ? 1.0 : bugs & COSINE_TWICE ? cos_surface * cos_surface : cos_surface;
    return lc_rgb_scale(cosine / pdf_solid * (bugs & NO_PI ? LC_PI : 1.0), f);
}

/* Whether the light that the hit emits counts. */
static int counts(unsigned bugs, const lc_options *options, const lc_hit *hit, int k)
{
    if (k == 0 && (bugs & NO_CAMERA_EMISSION || (bugs & NO_CAMERA_SKY && !hit->valid)))
        return 0;
    if (bugs & EMISSION_LAST && k != options->max_bounces && hit->valid)
        return 0;
    return k >= options->min_bounces;
}

/* Survivors are divided by what is meant to be the probability of survival; 0 ends the path. */
static double roulette(unsigned bugs, lc_rgb throughput, lc_sampler *sampler)
{
    double q = fmin(lc_rgb_max(throughput), 1);
    if (bugs & ROULETTE_DIMMEST) {
        q = fmin(1, fmin(throughput.r, fmin(throughput.g, throughput.b)));
        return q > 0.05 && lc_next(sampler) < q ? 1 / q : 0;
    }
    if (bugs & ROULETTE_INVERTED)
        q = fmin(fmax(q, 0.05), 0.95);
    else if (!(bugs & ROULETTE_CAPPED))
        return 1;
    double u = lc_next(sampler);
    if (bugs & ROULETTE_INVERTED)
        return u < q ? 0 : 1 / q;
    return u < fmin(q, 0.5) ? 1 / q : 0;
}

static lc_rgb walk(unsigned bugs, const lc_scene *scene, const lc_hit *first, const lc_options *options,
                   lc_sampler *sampler)
{
    lc_rgb sum = lc_black(), throughput = lc_color(1, 1, 1);
    lc_hit hit = *first;
    double numbers[2] = {0, 0};
    if (bugs & REUSES_NUMBERS)
        numbers[0] = lc_next(sampler), numbers[1] = lc_next(sampler);
    int last = options->max_bounces + (bugs & TOO_DEEP ? 1 : 0) - (bugs & TOO_SHORT ? 1 : 0);
    for (int k = 0;; ++k) {
        lc_rgb emission = lc_emission(scene, &hit);
        if (counts(bugs, options, &hit, k))
            sum = lc_rgb_add(sum, bugs & EMISSION_UNWEIGHTED ? emission : lc_rgb_mul(throughput, emission));
        if (k >= last || !hit.valid || (bugs & ENDS_AT_LIGHT && lc_rgb_max(emission) > 0))
            return sum;
        lc_vec3 wi;
        throughput = lc_rgb_mul(throughput, scatter(scene, &hit, numbers, sampler, bugs, k, &wi));
        throughput = lc_rgb_scale(roulette(bugs, throughput, sampler), throughput);
        if (lc_rgb_max(throughput) == 0)
            return sum;
        lc_trace(scene, &hit, wi, &hit);
    }
}

#define PATH_MUTANT(id, bugs, summary, category, story, shows, hint) \
    static lc_rgb radiance_##id(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, \
                                const lc_options *options, lc_sampler *sampler) \
    { \
        (void)ray; \
        return walk(bugs, scene, hit, options, sampler); \
    } \
    LC_ESTIMATOR(id) = {LC_ABI, #id, summary, "path, broken", LC_DIFFUSE, LC_AREA | LC_SKY, LC_UNBOUNDED, radiance_##id};

#define PATH(X) \
    X(path_no_cosine, NO_COSINE, "the cosine at the surface is missing", "cosine", \
      "The BRDF is thought to contain it.", "constant sky, one bounce: 2", \
      "Tilt a surface away from its light: what should happen, and what does?") \
    X(path_cosine_twice, COSINE_TWICE, "the cosine at the surface comes twice", "cosine", \
      "Sampling by the cosine and the factor are mixed up (mitsuba-renderer/mitsuba2 issue 594 asks where it is).", \
      "light at angle t: cos t", "Tilt a surface away from its light: what should happen, and what does?") \
    X(path_no_pi, NO_PI, "the BRDF is albedo instead of albedo / pi", "brdf", \
      "Lambert's BRDF is taken for its albedo.", "bounce k: pi^k", \
      "How much light may a white surface return in all directions together?") \
    X(path_half_density, HALF_DENSITY, "the density of directions is 1 / pi instead of 1 / (2 pi)", "density", \
      "The constant of the cosine's density for uniform directions.", "bounce k: 1 / 2^k", \
      "Over which solid angle does your density integrate to 1?") \
    X(path_cosine_directions, COSINE_DIRECTIONS, "directions by the cosine, density of uniform ones", "density", \
      "A better way to draw, without its density.", "light at angle t: 2 cos t; constant sky 4/3", \
      "With which probability is this very direction drawn?") \
    X(path_cosine_density, COSINE_DENSITY, "uniform directions, density of those by the cosine", "density", \
      "A better density, without its way to draw.", "light at angle t: 1 / (2 cos t); a constant sky is blind", \
      "With which probability is this very direction drawn?") \
    X(path_normal_not_turned, NORMAL_NOT_TURNED, "the normal is not turned to the viewer", "sides", \
      "Scenes at hand had all their normals outward.", "seen from its back: black", \
      "Which way does a normal point, seen from either side?") \
    X(path_albedo_once, ALBEDO_ONCE, "only the first surface's albedo counts", "brdf", \
      "The throughput is set where it should be multiplied.", "bounce k: 1 / rho^(k - 1)", \
      "What is left of a particle after two gray surfaces?") \
    X(path_gamma, GAMMA, "the albedo is taken to the power 2.2", "brdf", \
      "Linear colours are decoded as sRGB once more.", "bounce k, a channel: rho^(1.2 k)", \
      "Are your colours linear, once and only once?") \
    X(path_u_reaches_one, U_REACHES_ONE, "a random number that can be 1 gives 0 / 0, once in 32768 draws", "numbers", \
      "rand() / RAND_MAX.", "anywhere: a NaN, rarely", "Which ends of their range can your random numbers take?") \
    X(path_reuses_numbers, REUSES_NUMBERS, "all bounces draw the same two numbers", "numbers", \
      "The seed is not moved on between bounces (straaljager/OpenCL-path-tracing-tutorial-3-Part-2 pull 2).", \
      "two bounces and more", "Are the random numbers of two bounces independent?") \
    X(path_same_number, SAME_NUMBER, "one number is used for both angles of a direction", "numbers", \
      "The generator returns the same value twice.", "directions on a spiral: local", \
      "Draw your directions as dots on a sphere: are they evenly spread?") \
    X(path_too_deep, TOO_DEEP, "one bounce more than asked for", "bounces", \
      "< against <=.", "furnace: the value of one bounce more", "Count the surfaces between camera and light.") \
    X(path_too_short, TOO_SHORT, "one bounce less than asked for", "bounces", \
      "< against <=.", "furnace: the value of one bounce less", "Count the surfaces between camera and light.") \
    X(path_emission_last, EMISSION_LAST, "emission counts at the end of the path only", "emission", \
      "The sum over bounces is taken for its last term.", "furnace: one term only", \
      "At which surfaces of a path may light join it?") \
    X(path_emission_unweighted, EMISSION_UNWEIGHTED, "emission is added without the throughput", "emission", \
      "sum += emission.", "after a bounce: 1 / throughput", \
      "What has happened to the light of a lamp by the time the camera sees it?") \
    X(path_ends_at_light, ENDS_AT_LIGHT, "the path ends at a light, though lights reflect, too", "emission", \
      "The lecture's paths do: its lights are black otherwise.", \
      "emitting and reflecting surfaces: only the first term", "Can a lamp reflect?") \
    X(path_no_camera_emission, NO_CAMERA_EMISSION, "a light that the camera sees is black", "emission", \
      "The first hit is shaded without its emission.", "camera on a lamp: 0", "Look straight into a lamp.") \
    X(path_no_camera_sky, NO_CAMERA_SKY, "a ray from the camera that hits nothing is black, whatever the sky", \
      "emission", \
      "A miss returns early.", "background: 0", "Look past everything.") \
    X(path_roulette_inverted, ROULETTE_INVERTED, "roulette ends the path with the probability by which survivors are divided", \
      "roulette", \
      "The comparison is the wrong way round (xelatihy/yocto-gl issue 603).", "q against 1 - q: (1 - q) / q", \
      "How often does a path survive, and what are survivors divided by?") \
    X(path_roulette_capped, ROULETTE_CAPPED, "survival is capped at 1/2, the division is not", "roulette", \
      "A cap added in one of two places (chunky-dev/chunky issue 1018: survivors of one half are not scaled).", \
      "bounce k: 1 / 2^k and less", "How often does a path survive, and what are survivors divided by?") \
    X(path_roulette_dimmest, ROULETTE_DIMMEST, "roulette by the dimmest channel: q -> 0 ends paths that carry light", \
      "roulette", \
      "A path of saturated colour has q near 0; it is ended before 1 / q blows up.", "after some coloured walls: too dark", \
      "May a path end for certain while one of its channels is alive?")

PATH(PATH_MUTANT)

#define OF "path"
const lc_mutant lc_path_mutants[] = {PATH(LC_MUTANT_ROW) LC_MUTANT_END};
#undef OF
