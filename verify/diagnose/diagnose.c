/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The subject against the truth and against each mutant, scene by scene; a mutant that was shown different is not rendered again. So
 * the first scene costs most, and nearly all of them are gone at its first look.
 */
#include "verify/diagnose/diagnose.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "estimators/registry.h"
#include "verify/checks/transform.h"
#include "verify/stats/stats.h"

enum { POWER = 10, LOOKS = 3, FIRST = 256 }; /* 256, 1024, 4096 samples a pixel of an image of half the scene's size */

/* Relative, where c <= 1; each of the tests may be wrong with this probability. */
static const double MARGIN = 0.02, ERROR = 1e-10;

/* Which scenes tell most; `for_` what the subject follows. Every term of light alone, so that the first wrong one shows. */
static const struct view {
    const char *scene;
    int min, max;
    /* PLAIN: walkers without mirrors and glass, whose own scenes are dear enough. REFUTES: its image is too small to
     * show equality of what is noisy; a difference counts, and what is not decided there leaves nothing open. */
    enum { DIRECT = 1, WALK = 2, PLAIN = 4, BOTH = 3, FEW = 5, REFUTES = 8 } depth;
    unsigned lobes, emitters; /* the subject has to know all of them */
    int size, light;          /* lengths and emission are 2^this times the scene's: for thresholds */
} views[] = {
    {"two_lights", 1, 1, DIRECT, LC_DIFFUSE, LC_AREA, 0, 0},
    {"plane_rectangle", 1, 1, FEW, LC_DIFFUSE, LC_AREA, 0, 0},
    {"plane_tilted", 1, 1, FEW, LC_DIFFUSE, LC_AREA, 0, 0},
    {"flipped_twosided", 1, 1, FEW, LC_DIFFUSE, LC_AREA, 0, 0},
    {"light_behind", 1, 1, DIRECT, LC_DIFFUSE, LC_AREA, 0, 0},
    {"light_below", 1, 1, DIRECT, LC_DIFFUSE, LC_AREA, 0, 0},
    {"occluder", 1, 1, DIRECT, LC_DIFFUSE, LC_AREA, 0, 0},
    {"mixed_lights", 1, 1, BOTH, LC_DIFFUSE, LC_AREA | LC_POINT | LC_DIRECTIONAL, 0, 0},
    {"five_lights", 1, 1, DIRECT, LC_DIFFUSE, LC_AREA, 0, 0},
    {"sky", 1, 1, BOTH, LC_DIFFUSE, LC_SKY, 0, 0},
    {"bright_room", 1, 1, WALK, LC_DIFFUSE, LC_AREA, 0, 0},
    {"bright_room", 2, 2, WALK, LC_DIFFUSE, LC_AREA, 0, 0},
    {"furnace_sphere", 3, 3, PLAIN | REFUTES, LC_DIFFUSE, LC_AREA, 0, 0},
    {"furnace_sphere", 8, 8, PLAIN | REFUTES, LC_DIFFUSE, LC_AREA, 0, 0},
    {"furnace_checker", 2, 2, PLAIN, LC_DIFFUSE, LC_AREA, 0, 0},
    {"furnace_checker", 1, 3, PLAIN, LC_DIFFUSE, LC_AREA, 0, 0},
    {"mirror_sky", 1, 1, WALK, LC_DIFFUSE | LC_MIRROR, LC_SKY, 0, 0},
    {"mirror_corridor", 1, 12, WALK, LC_MIRROR, LC_AREA, 0, 0},
    {"bright_mirrors", 1, 2, WALK, LC_DIFFUSE | LC_MIRROR, LC_AREA, 0, 0},
    {"glass_blend", 1, 1, WALK, LC_MIRROR | LC_GLASS, LC_AREA | LC_SKY, 0, 0},
    {"critical_angle", 1, 1, WALK, LC_GLASS, LC_SKY, 0, 0},
    {"glass_slab", 1, 8, WALK, LC_GLASS, LC_AREA, 0, 0},
    {"glass_sphere", 1, 6, WALK, LC_GLASS, LC_SKY, 0, 0},
    {"cornell", 0, 0, BOTH, LC_DIFFUSE, LC_AREA, 0, 0},
    {"glass_sphere", 0, 0, BOTH, LC_DIFFUSE, LC_SKY, 0, 0},
    {"glossy_lamp", 1, 1, DIRECT, LC_GLOSSY, LC_AREA, 0, 0},
    {"glossy_sky", 1, 1, DIRECT, LC_GLOSSY, LC_SKY, 0, 0},
    {"motion_lamp", 1, 1, DIRECT, LC_DIFFUSE, LC_AREA, 0, 0},
    {"motion_shadow", 1, 1, DIRECT, LC_DIFFUSE, LC_DIRECTIONAL, 0, 0},
    {"five_lights", 1, 1, DIRECT, LC_DIFFUSE, LC_AREA, -POWER, 0},
    {"five_lights", 1, 1, DIRECT, LC_DIFFUSE, LC_AREA, POWER, 0},
    {"five_lights", 1, 1, DIRECT, LC_DIFFUSE, LC_AREA, 0, POWER},
    {"five_lights", 1, 1, DIRECT, LC_DIFFUSE, LC_AREA, 0, -POWER},
    {"bright_room", 1, 1, WALK, LC_DIFFUSE, LC_AREA, -POWER, 0},
    {"bright_room", 1, 1, WALK, LC_DIFFUSE, LC_AREA, 0, POWER},
};
enum { VIEWS = sizeof views / sizeof views[0] };

typedef struct arm {
    const lc_estimator *estimator;
    const lc_mutant *mutant; /* NULL: the truth */
    int is_alive;            /* not yet shown different */
    int is_open;             /* somewhere neither was shown */
    int confirmed;           /* equal where the truth is different from both */
    lc_sight sight;          /* at this view */
    lc_film *film;
} arm;

typedef struct diagnosing {
    lc_diagnosis *out;
    const lc_diagnose_options *options;
    const struct view *view;
    const lc_scene *scene;
    const lc_estimator *subject;
    lc_film *film;
    arm arms[LC_MOST_CANDIDATES + 1]; /* the truth first */
    int count;
} diagnosing;

static int same_language(const lc_estimator *a, const lc_estimator *b)
{
    /* Rough mirrors beside other lobes stand in no view. */
    unsigned rough = a->lobes == LC_GLOSSY || b->lobes == LC_GLOSSY ? 0 : LC_GLOSSY;
    return ((a->lobes ^ b->lobes) & ~rough) == 0 && a->emitters == b->emitters && (a->max_bounces == 1) == (b->max_bounces == 1);
}

/* 1 when a film shows no variance at all. */
static int is_still(const lc_film *film)
{
    for (size_t i = 0; i < (size_t)film->width * (size_t)film->height; ++i)
        for (int c = 0; c < 3; ++c)
            if (film->pixels[i].c[c].m2 > 1e-24 * film->pixels[i].c[c].mean * film->pixels[i].c[c].mean * (double)film->pixels[i].n)
                return 0;
    return 1;
}

static int is_black(const lc_film *film)
{
    for (size_t i = 0; i < (size_t)film->width * (size_t)film->height; ++i)
        for (int c = 0; c < 3; ++c)
            if (film->pixels[i].c[c].mean != 0)
                return 0;
    return 1;
}

static lc_sight compare_exactly(const lc_film *a, const lc_film *b)
{
    for (size_t i = 0; i < (size_t)a->width * (size_t)a->height; ++i)
        for (int c = 0; c < 3; ++c)
            if (lc_decide_exact(a->pixels[i].c[c].mean - b->pixels[i].c[c].mean, 1e-9 * fabs(b->pixels[i].c[c].mean)) != LC_PASS)
                return LC_SIGHT_DIFFERENT;
    return LC_SIGHT_EQUAL;
}

/* A film without variance is a constant to the other one, which is tested against it. Never shown equal: rare light may be missing. */
static lc_status compare_with_still(lc_sight *sight, const lc_film *film, const lc_film *still, lc_error *err)
{
    size_t count = (size_t)film->width * (size_t)film->height;
    double *values = malloc(3 * count * sizeof *values);
    lc_estimate *field = malloc(count * sizeof *field);
    lc_status status = values && field ? LC_OK : lc_fail(err, LC_FAULT, "out of memory for the differences");
    *sight = LC_SIGHT_OPEN;
    for (size_t i = 0; status == LC_OK && i < 3 * count; ++i)
        values[i] = still->pixels[i / 3].c[i % 3].mean;
    for (int c = 0; status == LC_OK && c < 3; ++c) {
        lc_pyramid_plan plan;
        lc_pyramid pyramid;
        lc_pyramid_plan_init(&plan, ERROR / 3, ERROR);
        status = lc_field_one(field, film, values, c, 0, err);
        if (status == LC_OK)
            status = lc_pyramid_judge(&pyramid, field, film->width, film->height, &plan, err);
        if (status == LC_OK && pyramid.verdict == LC_FAIL)
            *sight = LC_SIGHT_DIFFERENT;
    }
    free(values);
    free(field);
    return status;
}

/* The margin is a's against b; `row` tells where they differ. */
static lc_status compare(lc_sight *sight, lc_row *row, const lc_film *a, const lc_film *b, lc_error *err)
{
    memset(row, 0, sizeof *row);
    if (a->bad || b->bad) {
        *sight = LC_SIGHT_DIFFERENT;
        return LC_OK;
    }
    int a_still = is_still(a), b_still = is_still(b);
    if (a_still && b_still) {
        *sight = compare_exactly(a, b);
        return LC_OK;
    }
    if (a_still || b_still)
        return compare_with_still(sight, a_still ? b : a, a_still ? a : b, err);
    double margin = MARGIN * fmax(1, fmax(lc_film_noise(a), lc_film_noise(b)));
    lc_status status = lc_compare_films(row, a, b, margin, ERROR, ERROR, err);
    *sight = row->verdict == LC_ROW_PASS   ? LC_SIGHT_EQUAL
             : row->verdict == LC_ROW_FAIL ? LC_SIGHT_DIFFERENT
                                           : LC_SIGHT_OPEN;
    return status;
}

/* Grows the film to this look; streams are independent, but the same in every run. */
static lc_status grow(diagnosing *d, lc_film **film, const lc_estimator *estimator, int look, lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(d->scene);
    char name[160];
    int is_emission = d->view->max == 0; /* without variance but for silhouettes: as small as it can be judged */
    lc_status status = LC_OK;
    if (!*film)
        status = lc_film_create(film, desc->width / 2, desc->height / 2, err);
    if (status != LC_OK || (is_emission && look > 1))
        return status;
    snprintf(name, sizeof name, "%s: %s", estimator == d->subject ? "diagnosed" : "candidate", estimator->name);
    lc_render_options o = {.min_bounces = d->view->min,
                           .max_bounces = d->view->max,
                           .seed = d->options->seed,
                           .arm = lc_arm(name),
                           .first = (*film)->count,
                           .threads = d->options->threads};
    o.count = ((uint64_t)FIRST << 2 * look) - o.first;
    d->out->paths += o.count * (uint64_t)(*film)->width * (uint64_t)(*film)->height;
    return lc_render(*film, d->scene, estimator, &o, err);
}

/* estimate / truth of each channel, over the image, at six sigma. */
static void measure_ratio(lc_view_result *v, const lc_film *a, const lc_film *b)
{
    for (int c = 0; c < 3; ++c) {
        double sum[2] = {0, 0}, variance[2] = {0, 0};
        for (size_t i = 0; i < (size_t)a->width * (size_t)a->height; ++i) {
            sum[0] += a->pixels[i].c[c].mean, variance[0] += lc_pixel_variance(&a->pixels[i], c);
            sum[1] += b->pixels[i].c[c].mean, variance[1] += lc_pixel_variance(&b->pixels[i], c);
        }
        double ratio = sum[0] / sum[1];
        double error = 6 * sqrt(variance[0] + ratio * ratio * variance[1]) / sum[1] + 1e-9;
        v->low[c] = sum[1] > 0 ? ratio - error : NAN;
        v->high[c] = sum[1] > 0 ? ratio + error : NAN;
    }
    v->is_black = is_black(a);
    v->truth_is_black = is_black(b);
}

/* All living arms against the subject at this look; returns through `open` how many are not decided. */
static lc_status look_at(diagnosing *d, lc_view_result *v, int look, int *open, lc_error *err)
{
    lc_status status = grow(d, &d->film, d->subject, look, err);
    *open = 0;
    for (int i = 0; i < d->count && status == LC_OK; ++i) {
        arm *a = &d->arms[i];
        lc_row row;
        if (!(a->is_alive || i == 0) || (look > 0 && a->sight != LC_SIGHT_OPEN))
            continue;
        status = grow(d, &a->film, a->estimator, look, err);
        if (status == LC_OK)
            status = compare(&a->sight, &row, d->film, a->film, err);
        if (status == LC_OK && i == 0) {
            measure_ratio(v, d->film, a->film);
            v->tile_x = 2 * row.tile_x, v->tile_y = 2 * row.tile_y, v->tile_width = 2 * row.tile_width;
        }
        *open += a->sight == LC_SIGHT_OPEN;
    }
    return status;
}

/* A mutant is confirmed where it equals the subject, and the truth is shown different from both. */
static lc_status confirm(diagnosing *d, lc_error *err)
{
    arm *truth = &d->arms[0];
    for (int i = 1; i < d->count; ++i) {
        arm *a = &d->arms[i];
        if (!a->is_alive)
            continue;
        a->is_alive = a->sight != LC_SIGHT_DIFFERENT;
        a->is_open |= a->sight == LC_SIGHT_OPEN && !(d->view->depth & REFUTES);
        if (a->sight != LC_SIGHT_EQUAL || truth->sight != LC_SIGHT_DIFFERENT)
            continue;
        lc_sight sight = LC_SIGHT_DIFFERENT;
        lc_row row;
        lc_status status = LC_OK;
        if (a->film->count == truth->film->count)
            status = compare(&sight, &row, a->film, truth->film, err);
        else /* the truth was told at an earlier look: bring it up to here */
            for (int look = 1; look < LOOKS && status == LC_OK && truth->film->count < a->film->count; ++look)
                if (((uint64_t)FIRST << 2 * look) > truth->film->count)
                    status = grow(d, &truth->film, truth->estimator, look, err);
        if (status == LC_OK)
            status = compare(&sight, &row, a->film, truth->film, err);
        if (status != LC_OK)
            return status;
        a->confirmed |= sight == LC_SIGHT_DIFFERENT;
    }
    return LC_OK;
}

/* The albedo that all surfaces in view have in common. */
static void find_albedo(double out[3], const lc_scene *scene, const lc_film *film)
{
    for (int i = 0; i < film->width * film->height; ++i) {
        lc_ray ray = lc_camera_ray(&lc_scene_description(scene)->camera, film->width, film->height, i % film->width + 0.5,
                                   i / film->width + 0.5);
        lc_hit hit;
        lc_camera_see(scene, &ray, &hit);
        lc_rgb a = hit.valid ? lc_material_at(scene, &hit).diffuse : lc_black();
        double albedo[3] = {a.r, a.g, a.b};
        for (int c = 0; c < 3; ++c)
            out[c] = i == 0 || out[c] == albedo[c] ? albedo[c] : NAN;
    }
}

/* What is known of a wrong view beside its means. */
static lc_status measure_view(diagnosing *d, lc_view_result *v, lc_error *err)
{
    arm *truth = &d->arms[0];
    lc_status status = LC_OK;
    find_albedo(v->albedo, d->scene, d->film);
    if (strcmp(d->view->scene, "plane_tilted") != 0 || v->sight != LC_SIGHT_DIFFERENT)
        return LC_OK;
    for (int look = 1; look < LOOKS && status == LC_OK; ++look) { /* pixel by pixel more is wanted than for means */
        uint64_t count = (uint64_t)FIRST << 2 * look;
        if (d->film->count < count)
            status = grow(d, &d->film, d->subject, look, err);
        if (status == LC_OK && truth->film->count < count)
            status = grow(d, &truth->film, truth->estimator, look, err);
    }
    if (status == LC_OK && !d->film->bad)
        lc_fit_angles(&v->angles, d->scene, d->film, truth->film);
    return status;
}

/* The scene of the view, which may be another size or brightness than its file's. */
static lc_status load_view(lc_scene **out, const struct view *view, lc_load_scene_fn *load, lc_error *err)
{
    lc_scene *scene;
    lc_scene_desc desc;
    lc_status status = load(&scene, view->scene, err);
    *out = scene;
    if (status != LC_OK || (!view->size && !view->light))
        return status;
    status = lc_scene_desc_copy(&desc, lc_scene_description(scene), err);
    lc_scene_free(scene);
    *out = NULL;
    if (status != LC_OK)
        return status;
    lc_transform_scale(&desc, ldexp(1, view->size));
    lc_transform_emission(&desc, ldexp(1, view->light));
    status = lc_scene_build(out, &desc, err);
    lc_scene_desc_release(&desc);
    return status;
}

static lc_status see(diagnosing *d, const struct view *view, lc_load_scene_fn *load, lc_error *err)
{
    lc_view_result *v = &d->out->views[d->out->view_count++];
    lc_scene *scene = NULL;
    lc_status status = load_view(&scene, view, load, err);
    snprintf(v->scene, sizeof v->scene, "%s", view->scene);
    v->min_bounces = view->min, v->max_bounces = view->max;
    v->size = view->size, v->light = view->light;
    d->view = view, d->scene = scene;
    for (int i = 0; i < d->count; ++i)
        d->arms[i].sight = LC_SIGHT_NONE;
    for (int look = 0, open = 1; look < LOOKS && open && status == LC_OK; ++look) {
        status = look_at(d, v, look, &open, err);
        if (status == LC_OK && d->film->bad) {
            d->out->has_bad = 1;
            break;
        }
    }
    if (status == LC_OK) {
        v->lights = lc_light_count(scene);
        v->sight = d->arms[0].sight;
        d->out->is_wrong |= v->sight == LC_SIGHT_DIFFERENT || d->film->bad > 0;
        for (int c = 0; c < 3 && view->max > 0 && !is_still(d->film); ++c) { /* roundings do depend on each other */
            lc_batches batches = lc_batches_of_film(d->film, c);
            d->out->repeats |= batches.log_p < log(ERROR);
        }
        d->out->is_wrong |= d->out->repeats;
        status = d->film->bad ? LC_OK : confirm(d, err);
        if (status == LC_OK && !d->film->bad)
            status = measure_view(d, v, err);
    }
    lc_film_free(d->film);
    d->film = NULL;
    for (int i = 0; i < d->count; ++i) {
        lc_film_free(d->arms[i].film);
        d->arms[i].film = NULL;
    }
    lc_scene_free(scene);
    return status;
}

static int applies(const struct view *view, const lc_estimator *subject)
{
    int follows = subject->max_bounces == 1 ? DIRECT : subject->lobes & (LC_MIRROR | LC_GLASS) ? WALK : WALK | PLAIN;
    if (view->lobes == LC_GLOSSY && subject->lobes != LC_GLOSSY)
        return 0;
    return ((int)view->depth & follows) && view->max <= subject->max_bounces &&
           (view->lobes & ~subject->lobes) == 0 && (view->emitters & ~subject->emitters) == 0;
}

static lc_status choose_arms(diagnosing *d, const lc_estimator *subject, lc_error *err)
{
    const lc_mutant *m;
    for (const lc_estimator *const *e = lc_estimators; *e && !d->count; ++e)
        if (same_language(*e, subject))
            d->arms[d->count++] = (arm){.estimator = *e, .is_alive = 1};
    if (!d->count)
        return lc_fail(err, LC_BAD_INPUT, "%s: no estimator of lightcheck has its lobes, emitters and depth",
                       subject->name);
    d->out->truth = d->arms[0].estimator;
    for (int i = 0; (m = lc_mutant_at(i)) != NULL && d->count <= LC_MOST_CANDIDATES; ++i)
        /* A factor near 1 is better told by its interval. */
        if (same_language(m->estimator, subject) && strcmp(m->category, "scale") != 0)
            d->arms[d->count++] = (arm){.estimator = m->estimator, .mutant = m, .is_alive = 1};
    d->out->candidates = d->count - 1;
    return LC_OK;
}

lc_status lc_diagnose(lc_diagnosis *out, const lc_estimator *subject, const lc_diagnose_options *options,
                      lc_load_scene_fn *load, lc_error *err)
{
    diagnosing d = {.out = out, .options = options};
    lc_estimator copy = *subject; /* a mutant may be diagnosed as itself, from another stream */
    d.subject = subject->radiance == lc_radiance_outside ? subject : &copy; /* one that runs elsewhere is known by its address */
    memset(out, 0, sizeof *out);
    lc_status status = choose_arms(&d, subject, err);
    for (int i = 0; i < VIEWS && status == LC_OK && !out->has_bad; ++i)
        if (applies(&views[i], subject))
            status = see(&d, &views[i], load, err);
    if (status != LC_OK)
        return status;
    out->is_certain = 1;
    for (int i = 1; i < d.count && !out->has_bad; ++i) {
        if (!d.arms[i].is_alive)
            continue;
        if (d.arms[i].confirmed)
            out->names[out->name_count++] = d.arms[i].mutant;
        out->is_certain &= d.arms[i].confirmed && !d.arms[i].is_open;
    }
    lc_diagnose_fingerprint(out);
    return LC_OK;
}
