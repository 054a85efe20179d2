/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Bugs of direct light, one switch each: the family of light_direct, three_point and hemisphere_direct.
 */
#include "lightcheck.h"
#include "registry.h"

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
    LIGHT_DENSITY = 8192,
    NORMAL_NOT_TURNED = 1 << 14,
    DISTANCE_ONCE = 1 << 15,
    COSINE_OF_VIEWER = 1 << 16,
    LAST_NEVER = 1 << 17,
    FIRST_ONLY = 1 << 18,
    RED_ONLY = 1 << 19,
    COSINE_DENSITY = 1 << 20,
    ANGLE_UNIFORM = 1 << 21,
    CUBE = 1 << 22,
    WHOLE_SPHERE = 1 << 23,
    AREA_TWICE = 1 << 24,
    LIGHT_SQUARED = 1 << 25,
    SHADOWED_BY_LIGHT = 1 << 26,
    COMPARES_DISTANCES = 1 << 27
};

/* The normal on the viewer's side. */
static lc_vec3 normal_of(const lc_hit *hit, unsigned bugs)
{
    return bugs & NORMAL_NOT_TURNED ? hit->n : lc_facing(hit->n, hit->wo);
}

static double cosine_of(const lc_hit *hit, lc_vec3 wi, unsigned bugs)
{
    return lc_dot(normal_of(hit, bugs), bugs & COSINE_OF_VIEWER ? hit->wo : wi);
}

static double surface_factor(unsigned bugs, double cos_surface)
{
    return (bugs & NO_COSINE ? 1.0 : cos_surface) * (bugs & NO_PI ? LC_PI : 1.0) * (bugs & ONE_PERCENT ? 1.01 : 1.0);
}

/* A shadow ray, or what somebody took for one: a ray that may meet nothing at all, or nothing nearer than the light, to the last bit. */
static int is_visible(const lc_scene *scene, const lc_hit *hit, const lc_light_sample *light, unsigned bugs)
{
    lc_hit next;
    if (bugs & NO_VISIBILITY)
        return 1;
    if (!(bugs & (SHADOWED_BY_LIGHT | COMPARES_DISTANCES)))
        return lc_visible(scene, hit, light);
    return !lc_trace(scene, hit, light->wi, &next) || (bugs & COMPARES_DISTANCES && next.distance >= light->distance);
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
    lc_rgb f = lc_bsdf_eval(scene, hit, wi);
    return bugs & RED_ONLY ? lc_color(f.r, f.r, f.r) : f;
}

static lc_rgb by_light(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, unsigned bugs)
{
    int count = lc_light_count(scene);
    lc_light_sample light;
    if (count == 0)
        return lc_black();
    int chosen = (int)(lc_next(sampler) * (bugs & FIRST_ONLY ? 1 : bugs & LAST_NEVER && count > 1 ? count - 1 : count));
    lc_light_sample_one(scene, chosen, hit, sampler, &light);
    lc_light_sample seen = light; /* whose visibility is tested */
    if (bugs & LIGHT_CENTRE)
        move_to_centre(scene, chosen, hit, sampler, &light);
    double cos_surface = cosine_of(hit, light.wi, bugs);
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
        double d2 = bugs & NO_DISTANCE ? 1.0 : light.distance * (bugs & DISTANCE_ONCE ? 1.0 : light.distance);
        double area = (bugs & AREA_TWICE ? 2 : 1) / light.pdf_area;
        cos_light = bugs & NO_LIGHT_COSINE ? 1.0 : bugs & LIGHT_SQUARED ? cos_light * cos_light : cos_light;
        incoming = lc_rgb_scale(cos_light * area / d2, light.radiance);
    }
    if (!is_visible(scene, hit, &seen, bugs))
        return lc_black();
    double lights = bugs & (NO_LIGHT_COUNT | FIRST_ONLY) ? 1.0 : count;
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
    double cos_surface = cosine_of(hit, light.wi, bugs), cos_light = -lc_dot(light.n, light.wi);
    if (bugs & BACK_EMITS)
        cos_light = fabs(cos_light);
    if (!(cos_surface > 0 && cos_light > 0) || !is_visible(scene, hit, &light, bugs))
        return lc_black();
    double d2 = light.distance * light.distance;
    if (bugs & NO_COSINE)
        cos_surface = 1;
    if (bugs & NO_LIGHT_COSINE)
        cos_light = 1;
    double factor = (bugs & NO_LIGHT_COUNT ? lc_light_count(scene) : 1) * (bugs & NO_PI ? LC_PI : 1.0);
    double g = factor * cos_surface * cos_light * (bugs & JACOBIAN_INVERTED ? d2 : 1 / d2);
    return lc_rgb_scale(g / light.pdf_area, lc_rgb_mul(lc_bsdf_eval(scene, hit, light.wi), light.radiance));
}

/* Directions over the hemisphere, or what somebody took for them. */
static lc_vec3 choose_direction(lc_vec3 n, lc_sampler *sampler, unsigned bugs)
{
    double u = lc_next(sampler), v = lc_next(sampler);
    if (bugs & COSINE_DIRECTIONS)
        return lc_cosine_hemisphere(n, u, v);
    if (bugs & ANGLE_UNIFORM) /* cos theta = 1 - u is uniform; here theta is */
        return lc_uniform_hemisphere(n, fmin(1 - cos(0.5 * LC_PI * u), 1 - 0x1p-53), v);
    if (bugs & CUBE) {
        lc_vec3 w = lc_vec(2 * u - 1, 2 * v - 1, 2 * lc_next(sampler) - 1);
        return lc_facing(lc_normalize(w), n);
    }
    lc_vec3 wi = lc_uniform_hemisphere(n, u, v);
    return bugs & WHOLE_SPHERE && lc_next(sampler) < 0.5 ? lc_neg(wi) : wi;
}

static lc_rgb by_hemisphere(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, unsigned bugs)
{
    lc_vec3 n = normal_of(hit, bugs), wi = choose_direction(n, sampler, bugs);
    lc_hit next;
    lc_trace(scene, hit, wi, &next);
    double pdf_solid = bugs & COSINE_DENSITY ? lc_dot(n, wi) * LC_INV_PI : 0.5 * LC_INV_PI;
    return lc_rgb_scale(surface_factor(bugs, cosine_of(hit, wi, bugs)) / pdf_solid,
                        lc_rgb_mul(reflectance(scene, hit, wi, bugs), lc_emission(scene, &next)));
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

#define MUTANT(id, direct, bugs, summary, of, emitters) \
    static lc_rgb radiance_##id(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, \
                                const lc_options *options, lc_sampler *sampler) \
    { \
        (void)ray; \
        return sum(direct, bugs, scene, hit, options, sampler); \
    } \
    LC_ESTIMATOR(id) = {LC_ABI, #id, summary, of ", broken", LC_DIFFUSE, emitters, 1, radiance_##id};

#define LIGHT_MUTANT(id, bugs, summary, category, story, shows, hint) \
    MUTANT(id, by_light, bugs, summary, "light_direct", LC_AREA | LC_POINT | LC_DIRECTIONAL)
#define AREA_MUTANT(id, bugs, summary, category, story, shows, hint) \
    MUTANT(id, by_area, bugs, summary, "three_point", LC_AREA)
#define HEMISPHERE_MUTANT(id, bugs, summary, category, story, shows, hint) \
    MUTANT(id, by_hemisphere, bugs, summary, "hemisphere_direct", LC_AREA | LC_SKY)

#define LIGHT(X) \
    X(light_no_cosine, NO_COSINE, "the cosine at the surface is missing", "cosine", \
      "The BRDF is thought to contain it.", "tilt of the surface: 1 / cos", \
      "Tilt a surface away from its light: what should happen, and what does?") \
    X(light_no_pi, NO_PI, "the BRDF is albedo instead of albedo / pi", "brdf", \
      "Lambert's BRDF is taken for its albedo.", "anywhere: pi", \
      "How much light may a white surface return in all directions together?") \
    X(light_no_count, NO_LIGHT_COUNT, "the number of lights is missing", "lights", \
      "One light of N is sampled, and the probability 1 / N of that choice is forgotten.", \
      "N lights: 1 / N; one light is blind", "Add a second light: does the first one still give as much?") \
    X(light_first_only, FIRST_ONLY, "only the first light is sampled", "lights", \
      "Written for a scene with one lamp.", "light of all others is missing", \
      "Which lights of the scene can your estimator ever choose?") \
    X(light_last_never, LAST_NEVER, "the last of several lights is never chosen", "lights", \
      "u (N - 1) instead of u N as an index.", "light of the last one is missing, others too bright by N / (N - 1)", \
      "Which indices does your choice among lights produce, and how often each?") \
    X(light_no_light_cosine, NO_LIGHT_COSINE, "the cosine at the light is missing", "cosine", \
      "A lamp is taken for a point that shines evenly.", "tilt of the lamp: 1 / cos'", \
      "Lambert's law has two halves: the surface's and its light's. Which one is where?") \
    X(light_light_cosine_twice, LIGHT_SQUARED, "the cosine at the light comes twice", "cosine", \
      "Once in the density, once more by hand.", "tilt of the lamp: cos'", \
      "Lambert's law has two halves: the surface's and its light's. Which one is where?") \
    X(light_cosine_of_viewer, COSINE_OF_VIEWER, "the surface's cosine is the viewer's instead of the light's", \
      "cosine", \
      "wi and wo change places.", "oblique views are too dark", \
      "Move the camera only: may a matte surface's brightness change?") \
    X(light_no_visibility, NO_VISIBILITY, "no shadow ray", "visibility", \
      "Left for later.", "shadows: no darkness", "Put something between surface and light.") \
    X(light_shadow_hits_light, SHADOWED_BY_LIGHT, "the shadow ray hits its own lamp", "visibility", \
      "The ray is not ended before the lamp.", "lamps with area: black; point lights are blind", \
      "What is the first thing that your shadow ray may meet?") \
    X(light_no_distance, NO_DISTANCE, "1 / d^2 is missing", "distance", \
      "Area is not turned into solid angle.", "scene s times as large: s^2", \
      "Make the scene twice as large: what stays the same?") \
    X(light_distance_once, DISTANCE_ONCE, "1 / d instead of 1 / d^2", "distance", \
      "The distance is divided by once.", "scene s times as large: s", \
      "Make the scene twice as large: what stays the same?") \
    X(light_back_emits, BACK_EMITS, "lights shine from their backs, too", "sides", \
      "The absolute value of the light's cosine (appleseedhq/appleseed issue 130: all light emitting " \
      "meshes are double-sided).", "a lamp seen from behind: not black", "Which sides of a lamp shine?") \
    X(light_centre, LIGHT_CENTRE, "distance and cosines are those of the light's centre", "distance", \
      "The lecture's A cos / d^2 with the centre's d, while the point is drawn.", "near a large lamp: local", \
      "Is every quantity of one sample taken at the same point?") \
    X(light_below_horizon, BELOW_HORIZON, "the surface's cosine without its sign: light from behind", "sides", \
      "The absolute value where the maximum with 0 was meant.", "lamp below the horizon: not black", \
      "What does a lamp behind the surface give?") \
    X(light_normal_not_turned, NORMAL_NOT_TURNED, "the normal is not turned to the viewer", "sides", \
      "Scenes at hand had all their normals outward.", "seen from its back: black", \
      "Which way does a normal point, seen from either side?") \
    X(light_double_area, AREA_TWICE, "lamps count with twice their area", "density", \
      "|e1 x e2| without the 1/2 of a triangle (mitsuba-renderer/mitsuba3 issue 42: brighter with a mesh " \
      "as the emitter).", "area lights: 2, point lights: 1", \
      "Over what area are points chosen, and is that the area of your lamp?") \
    X(light_red_only, RED_ONLY, "the albedo of red is used for all channels", "brdf", \
      "A test scene in gray.", "per channel: a_r / a", "Do your three channels know of each other?") \
    X(light_one_percent, ONE_PERCENT, "everything is 1% too bright", "scale", \
      "A constant with too few digits.", "1.01", "How many digits of your constants are right?")

LIGHT(LIGHT_MUTANT)

#define OF "light_direct"
const lc_mutant lc_light_mutants[] = {LIGHT(LC_MUTANT_ROW) LC_MUTANT_END};
#undef OF

#define AREA(X) \
    X(three_point_jacobian_inverted, JACOBIAN_INVERTED, "d^2 instead of 1 / d^2", "distance", \
      "The Jacobian is put upside down.", "scene s times as large: s^4", \
      "Make the scene twice as large: what stays the same?") \
    X(three_point_no_cosine, NO_COSINE, "the cosine at the surface is missing", "cosine", \
      "G has three factors; one is forgotten.", "tilt of the surface: 1 / cos", \
      "Lambert's law has two halves: the surface's and its light's. Which one is where?") \
    X(three_point_no_light_cosine, NO_LIGHT_COSINE, "the cosine at the light is missing", "cosine", \
      "G has three factors; one is forgotten.", "tilt of the lamp: 1 / cos'", \
      "Lambert's law has two halves: the surface's and its light's. Which one is where?") \
    X(three_point_no_pi, NO_PI, "the BRDF is albedo instead of albedo / pi", "brdf", \
      "Lambert's BRDF is taken for its albedo.", "anywhere: pi", \
      "How much light may a white surface return in all directions together?") \
    X(three_point_count_again, NO_LIGHT_COUNT, "multiplied by the number of lights, though the union was sampled", \
      "lights", \
      "Taken over from sampling one light of N.", "N lights: N; one light is blind", \
      "Add a second light: does the first one still give as much?") \
    X(three_point_normal_not_turned, NORMAL_NOT_TURNED, "the normal is not turned to the viewer", "sides", \
      "Scenes at hand had all their normals outward.", "seen from its back: black", \
      "Which way does a normal point, seen from either side?") \
    X(three_point_back_emits, BACK_EMITS, "lights shine from their backs, too", "sides", \
      "The absolute value of the light's cosine.", "a lamp seen from behind: not black", \
      "Which sides of a lamp shine?") \
    X(three_point_no_visibility, NO_VISIBILITY, "no shadow ray", "visibility", \
      "V in the integral is overlooked.", "shadows: no darkness", "Put something between surface and light.") \
    X(three_point_shadow_compares, COMPARES_DISTANCES, "a shadow ray's distance is compared with the lamp's to the last bit", \
      "visibility", \
      "Rounding decides whether the lamp hides itself.", "speckle: some of the light is missing everywhere", \
      "What is the first thing that your shadow ray may meet?") \
    X(three_point_uniform_pick, UNIFORM_PICK, "lights chosen uniformly, density of the union of their areas", \
      "density", \
      "Choice and density come from two places.", "unequal areas: 2.28; equal ones are blind", \
      "With which probability is this very point drawn?") \
    X(three_point_light_density, LIGHT_DENSITY, "points of the union, density within the one light", "density", \
      "Choice and density come from two places.", "several lights: too dark", \
      "With which probability is this very point drawn?")

AREA(AREA_MUTANT)

#define OF "three_point"
const lc_mutant lc_three_point_mutants[] = {AREA(LC_MUTANT_ROW) LC_MUTANT_END};
#undef OF

#define HEMISPHERE(X) \
    X(hemisphere_no_cosine, NO_COSINE, "the cosine at the surface is missing", "cosine", \
      "The BRDF is thought to contain it.", "constant sky: 2", \
      "Tilt a surface away from its light: what should happen, and what does?") \
    X(hemisphere_no_pi, NO_PI, "the BRDF is albedo instead of albedo / pi", "brdf", \
      "Lambert's BRDF is taken for its albedo.", "anywhere: pi", \
      "How much light may a white surface return in all directions together?") \
    X(hemisphere_cosine_directions, COSINE_DIRECTIONS, "directions by the cosine, weight of uniform ones", "density", \
      "A better way to draw, without its density.", "light at angle t: 2 cos t; constant sky 4/3", \
      "With which probability is this very direction drawn?") \
    X(hemisphere_cosine_density, COSINE_DENSITY, "uniform directions, density of those by the cosine", "density", \
      "A better density, without its way to draw.", "light at angle t: 1 / (2 cos t); a constant sky is blind", \
      "With which probability is this very direction drawn?") \
    X(hemisphere_angle_uniform, ANGLE_UNIFORM, "the angle is uniform instead of its cosine", "directions", \
      "theta = u pi / 2: too many directions near the pole.", "light at angle t: 2 / (pi sin t)", \
      "Draw your directions as dots on a sphere: are they evenly spread?") \
    X(hemisphere_cube, CUBE, "directions are points of a cube, normalised", "directions", \
      "Three numbers in [-1, 1] without rejecting those outside the sphere.", \
      "towards the cube's corners: too bright", "Draw your directions as dots on a sphere: are they evenly spread?") \
    X(hemisphere_whole_sphere, WHOLE_SPHERE, "half of the directions go below the surface", "directions", \
      "Directions over the sphere, density of the hemisphere (jalberse/shimmer issue 55 ends with a wrong " \
      "density of uniform directions).", "anywhere: 1/2", "How many of your directions can carry light?") \
    X(hemisphere_normal_not_turned, NORMAL_NOT_TURNED, "the normal is not turned to the viewer", "sides", \
      "Scenes at hand had all their normals outward.", "seen from its back: black", \
      "Which way does a normal point, seen from either side?") \
    X(hemisphere_cosine_of_viewer, COSINE_OF_VIEWER, "the surface's cosine is the viewer's instead of the light's", \
      "cosine", \
      "wi and wo change places.", "oblique views are too dark", \
      "Move the camera only: may a matte surface's brightness change?")

HEMISPHERE(HEMISPHERE_MUTANT)

#define OF "hemisphere_direct"
const lc_mutant lc_hemisphere_mutants[] = {HEMISPHERE(LC_MUTANT_ROW) LC_MUTANT_END};
#undef OF
