/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Claims about another program, of which there are images only. An image of `samples` paths a pixel is one sample of each
 * pixel; images of independent seeds make a film like any other, and the same judge decides.
 *
 * Reflected light is the image less L_0, which is known exactly: pixels where it is not one value (a lamp's edge) are left
 * out, for there the noise of the lamp is all that an image shows. Pixels of one image may move together; how much is
 * measured of each tile from the images themselves (verify/stats/tiles.h).
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "verify/judge/judge_c.h"
#include "verify/renderers/replicates.h"

/* Images before the first test, of a pilot, and the paths a pixel of its images. At a second look, four times as many. */
enum { IMAGES = LC_LEAST_SAMPLES, PILOT_IMAGES = LC_BLOCK, PILOT_SAMPLES = 4, LOOKS = 2, MOST_FILMS = 32 };

typedef char least_images_are_these[LC_LEAST_IMAGES == IMAGES + PILOT_IMAGES ? 1 : -1]; /* fails to compile where not */

typedef struct foreign_film {
    int min_bounces, max_bounces, samples, is_pilot;
    lc_film *film;
    lc_pixel *tiles[LC_LEVELS]; /* what they show of tiles, see tiles.h */
} foreign_film;

typedef struct lc_foreign {
    const lc_scene *scene;
    lc_expected glow; /* L_0 of each pixel, and where it is not one value */
    foreign_film films[MOST_FILMS];
    int film_count;
} lc_foreign;

int lc_is_foreign(const lc_session *session, const lc_estimator *estimator)
{
    return session->options->renderer && estimator == &session->options->renderer->estimator;
}

static void free_film(foreign_film *f)
{
    lc_film_free(f->film);
    lc_tiles_free(f->tiles);
}

void lc_foreign_free(lc_foreign *foreign)
{
    if (!foreign)
        return;
    for (int i = 0; i < foreign->film_count; ++i)
        free_film(&foreign->films[i]);
    free(foreign->glow.rgb);
    free(foreign->glow.skip);
    free(foreign);
}

/* ---- L_0 --------------------------------------------------------------------------------------------------------- */

static lc_status glow_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user, lc_error *err)
{
    lc_rgb c = lc_emission(scene, hit);
    unsigned bits[sizeof c / sizeof(unsigned)], hash = 17;
    (void)user;
    (void)err;
    memcpy(bits, &c, sizeof c);
    for (size_t i = 0; i < sizeof bits / sizeof bits[0]; ++i)
        hash = 31 * hash + bits[i];
    *kind = (int)(hash & 0x7fffffff);
    if (value)
        *value = c;
    return LC_OK;
}

static lc_status know_scene(lc_session *session, const lc_scene *scene, lc_error *err)
{
    const lc_scene_desc *d = lc_scene_description(scene);
    size_t pixels = (size_t)d->width * (size_t)d->height;
    if (session->foreign && session->foreign->scene == scene)
        return LC_OK;
    lc_foreign_free(session->foreign);
    lc_foreign *f = session->foreign = calloc(1, sizeof *f);
    if (f) {
        f->scene = scene;
        f->glow = (lc_expected){d->width, d->height, calloc(3 * pixels, sizeof(double)), calloc(pixels, 1)};
    }
    if (!f || !f->glow.rgb || !f->glow.skip)
        return lc_fail(err, LC_FAULT, "out of memory for what %s emits", d->name);
    return lc_expect_view(&f->glow, glow_view, NULL, scene, 1e-6, session->options->threads, err);
}

/* ---- films of images --------------------------------------------------------------------------------------------- */

static lc_status make_film(foreign_film *f, const lc_scene *scene, lc_error *err)
{
    const lc_scene_desc *d = lc_scene_description(scene);
    lc_status status = lc_film_create(&f->film, d->width, d->height, err);
    if (status != LC_OK)
        return status;
    f->film->has_third = 1;
    return lc_tiles_create(f->tiles, d->width, d->height, err);
}

/* Takes L_0 off, and what is left out. */
static void reflect(float *image, const lc_expected *glow)
{
    for (size_t i = 0; i < (size_t)glow->width * (size_t)glow->height; ++i)
        for (size_t c = 3 * i; c < 3 * i + 3; ++c)
            image[c] = glow->skip[i] ? 0 : (float)(image[c] - glow->rgb[c]);
}

/* One block of images. */
static void add_images(foreign_film *f, const float *images, int count)
{
    size_t pixels = (size_t)f->film->width * (size_t)f->film->height;
    for (size_t i = 0; i < pixels; ++i) {
        double block[LC_BLOCK][3];
        for (int k = 0; k < count; ++k)
            for (size_t c = 0; c < 3; ++c)
                block[k][c] = images[3 * ((size_t)k * pixels + i) + c];
        lc_pixel_add(&f->film->pixels[i], (const double(*)[3])block, count);
    }
    lc_tiles_add(f->tiles, f->film->width, f->film->height, images, count);
    f->film->count += (uint64_t)count;
}

/* Seeds of one film follow each other from a number of its own; images of a folder have their places for seeds. */
static uint32_t first_seed(const lc_session *session, const foreign_film *f)
{
    char text[256];
    if (session->options->renderer->is_folder)
        return f->is_pilot ? 0 : PILOT_IMAGES;
    snprintf(text, sizeof text, "%s %d %d %d %d %llu", lc_scene_description(session->foreign->scene)->name, f->min_bounces,
             f->max_bounces, f->samples, f->is_pilot, (unsigned long long)session->options->seed);
    return 1 + (lc_arm(text) & 0x3fffffff);
}

static lc_status grow(lc_session *session, foreign_film *f, uint64_t images, lc_error *err)
{
    const lc_foreign *known = session->foreign;
    const lc_scene_desc *d = lc_scene_description(known->scene);
    size_t floats = 3 * (size_t)d->width * (size_t)d->height;
    float *rgb = malloc(LC_BLOCK * floats * sizeof *rgb);
    lc_status status = rgb ? LC_OK : lc_fail(err, LC_FAULT, "out of memory for images of %s", d->name);
    while (status == LC_OK && f->film->count < images) {
        lc_adapter_job job = {d, f->max_bounces, f->samples, first_seed(session, f) + (uint32_t)f->film->count, LC_BLOCK};
        status = lc_adapter_render(rgb, session->options->renderer, &job, err);
        for (size_t k = 0; status == LC_OK && f->min_bounces > 0 && k < LC_BLOCK; ++k)
            reflect(rgb + k * floats, &known->glow);
        if (status == LC_OK)
            add_images(f, rgb, LC_BLOCK);
        session->paths += (uint64_t)LC_BLOCK * (uint64_t)f->samples * floats / 3;
    }
    free(rgb);
    return status;
}

static lc_status film_of(foreign_film **out, lc_session *session, const lc_claim *claim, int samples, int is_pilot,
                         uint64_t images, lc_error *err)
{
    lc_foreign *known = session->foreign;
    for (int i = 0; i < known->film_count; ++i) {
        foreign_film *f = &known->films[i];
        if (f->min_bounces == claim->min_bounces && f->max_bounces == claim->max_bounces && f->is_pilot == is_pilot &&
            (f->samples == samples && f->film->count <= images)) {
            *out = f;
            return grow(session, f, images, err);
        }
    }
    if (known->film_count == MOST_FILMS)
        return lc_fail(err, LC_FAULT, "more than %d films of one scene", MOST_FILMS);
    foreign_film *f = *out = &known->films[known->film_count++];
    *f = (foreign_film){claim->min_bounces, claim->max_bounces, samples, is_pilot, NULL, {NULL}};
    lc_status status = make_film(f, known->scene, err);
    if (status != LC_OK)
        return status;
    f->film->seed = session->options->seed;
    f->film->arm = lc_session_arm(claim->estimator);
    f->film->min_bounces = claim->min_bounces;
    f->film->max_bounces = claim->max_bounces;
    snprintf(f->film->scene, sizeof f->film->scene, "%s", lc_scene_description(known->scene)->name);
    snprintf(f->film->estimator, sizeof f->film->estimator, "%s", claim->estimator->name);
    return grow(session, f, images, err);
}

/* ---- decisions --------------------------------------------------------------------------------------------------- */

/* What the images are compared with. */
typedef struct reference {
    const lc_expected *expected; /* or */
    const lc_film *film;         /* of ours */
    const unsigned char *skip;   /* pixels that are left out */
} reference;

/* Where images do not differ by more than rounding, each pixel is held to the value. `slack` is absolute. */
static int is_still(const lc_film *film, const unsigned char *skip, double slack)
{
    for (size_t i = 0; i < (size_t)film->width * (size_t)film->height; ++i)
        for (int c = 0; c < 3 && !skip[i]; ++c)
            if (film->pixels[i].c[c].m2 > (double)film->pixels[i].n * slack * slack)
                return 0;
    return 1;
}

static void compare_still(lc_row *row, const lc_session *session, const lc_film *film, const reference *r, double tolerance, double slack)
{
    double light = 0;
    for (int c = 0; c < 3; ++c)
        light = fmax(light, lc_claim_mean(r->film, r->expected, r->skip, c));
    lc_row_settle(row, session, lc_claim_share(r->skip, film->width * film->height), light);
    for (size_t i = 0; i < (size_t)film->width * (size_t)film->height; ++i)
        for (size_t c = 0; c < 3 && !r->skip[i]; ++c) {
            double is = film->pixels[i].c[c].mean;
            double should = r->film ? r->film->pixels[i].c[c].mean : r->expected->rgb[3 * i + c];
            if (lc_decide_exact(is - should, tolerance * fabs(should) + slack) == LC_PASS)
                continue;
            row->verdict = LC_ROW_FAIL;
            row->missed = 0;
            row->channel = (int)c;
            snprintf(row->reason, sizeof row->reason, "%s on %s is wrong: pixel %d,%d has %c = %.9g, expected %.9g",
                     row->estimator, row->scene, (int)(i % (size_t)film->width), (int)(i / (size_t)film->width), "RGB"[c],
                     is, should);
            return;
        }
}

/* Largest emission that a pixel shows: what rounding is relative to. */
static double brightest(const lc_foreign *f)
{
    double most = 0;
    for (size_t i = 0; i < 3 * (size_t)f->glow.width * (size_t)f->glow.height; ++i)
        most = fmax(most, f->glow.rgb[i]);
    return most;
}

/* Pixels left out of either. */
static unsigned char *both_skips(const lc_foreign *f, const lc_claim *claim, const lc_expected *expected)
{
    size_t pixels = (size_t)f->glow.width * (size_t)f->glow.height;
    unsigned char *skip = calloc(pixels, 1);
    for (size_t i = 0; skip && i < pixels; ++i)
        skip[i] = (unsigned char)((claim->min_bounces > 0 && f->glow.skip[i]) || (expected && expected->skip[i]));
    return skip;
}

/* Samples of ours that are compared with the images at a look. */
static uint64_t our_samples(double c, double room, int pixels, int look)
{
    uint64_t planned = lc_planned_samples(c, room, pixels);
    planned = planned < LC_LEAST_SAMPLES ? LC_LEAST_SAMPLES : planned > 1 << 24 ? 1 << 24 : planned;
    return ((planned + LC_BLOCK - 1) / LC_BLOCK * LC_BLOCK) << (2 * look);
}

static lc_exhibit evidence_of(const lc_film *film, const reference *r)
{
    return (lc_exhibit){film, r->film, r->film ? NULL : r->expected->rgb, NULL, r->skip};
}

typedef struct plan {
    double c, c_other, room;
    int samples;          /* a pixel of each image; of a folder's images 1: how many they have is not known, and c is theirs */
    uint64_t most_images; /* that there are, besides the pilot's */
} plan;

/* Of a folder: the images of the claim, in whole blocks. */
static lc_status count_images(plan *p, const lc_session *session, const lc_claim *claim, lc_error *err)
{
    const lc_scene_desc *d = lc_scene_description(claim->scene);
    const lc_adapter *renderer = session->options->renderer;
    p->most_images = UINT64_MAX;
    if (!renderer->is_folder)
        return LC_OK;
    int count = lc_replicates_count(renderer, d, claim->max_bounces);
    if (count < LC_LEAST_IMAGES)
        return lc_fail(err, LC_BAD_INPUT, "%d images in %s.%d/, at least %d are needed", count, d->name, claim->max_bounces, (int)LC_LEAST_IMAGES);
    p->most_images = (uint64_t)(count - PILOT_IMAGES) / LC_BLOCK * LC_BLOCK;
    return lc_replicates_differ(renderer, d, claim->max_bounces, err);
}

/* Noise, margin and the samples of an image, from a pilot whose images are never used again. */
static lc_status make_plan(plan *p, lc_row *row, lc_session *session, const lc_claim *claim, lc_error *err)
{
    const lc_scene_desc *d = lc_scene_description(claim->scene);
    int pixels = d->width * d->height, is_folder = session->options->renderer->is_folder, of_pilot = is_folder ? 1 : PILOT_SAMPLES;
    foreign_film *pilot;
    lc_status status = count_images(p, session, claim, err);
    if (status == LC_OK)
        status = film_of(&pilot, session, claim, of_pilot, 1, PILOT_IMAGES, err);
    if (status == LC_OK && claim->other)
        status = lc_claim_noise(&p->c_other, session, claim, claim->other, err);
    if (status != LC_OK)
        return status;
    p->c = lc_film_noise(pilot->film) * sqrt(of_pilot);
    row->margin = fmax(lc_claim_margin(session, claim, p->c), claim->margin);
    p->room = claim->margin > 0 ? row->margin - claim->tolerance : row->margin;
    double planned = (double)lc_planned_samples(hypot(p->c, p->c_other), p->room, pixels);
    double most = session->options->suite->most_samples / pixels;
    p->samples = is_folder ? 1 : (int)fmax(1, ceil(fmin(planned, most) / IMAGES));
    return LC_OK;
}

/* What varies by no more than its arithmetic rounds has shown no noise, and is as still as if it did not vary: a pixel whose rare
 * samples were not met would else be tested by the noise of rounding. */
static void forget_rounding(lc_film *film, double rounding, double glow)
{
    for (size_t i = 0; i < (size_t)film->width * (size_t)film->height; ++i)
        for (int c = 0; c < 3; ++c) {
            double error = rounding * (film->pixels[i].c[c].mean + glow); /* what glows has been subtracted */
            if (film->pixels[i].c[c].m2 <= error * error * (double)film->pixels[i].n)
                film->pixels[i].c[c].m2 = film->pixels[i].c[c].m3 = 0;
        }
}

static lc_status judge(lc_row *row, lc_session *session, const lc_claim *claim, const plan *p, reference *r,
                       lc_estimate *field, lc_error *err)
{
    const lc_verify_options *o = session->options;
    const lc_scene_desc *d = lc_scene_description(claim->scene);
    double slack = o->renderer->rounding * brightest(session->foreign);
    double tolerance = fmax(claim->tolerance, o->renderer->rounding);
    lc_budget budget = {o->false_fail, o->false_pass, session->rows, 3, LC_MOST_LOOKS};
    lc_pyramid_plan pyramid;
    lc_look result = {.verdict = LC_GO_ON, .reach = INFINITY};
    foreign_film *f = NULL;
    for (int k = 0; k < LOOKS && result.verdict == LC_GO_ON; ++k) {
        uint64_t images = (uint64_t)IMAGES << (2 * k);
        images = images < p->most_images ? images : p->most_images;
        if (f && f->film->count >= images)
            break;
        lc_status status = film_of(&f, session, claim, p->samples, 0, images, err);
        if (status == LC_OK && claim->other)
            status = lc_session_film(&r->film, session, claim->scene, claim->other, claim->min_bounces, claim->max_bounces,
                                     lc_session_arm(claim->other),
                                     our_samples(hypot(p->c, p->c_other), p->room, d->width * d->height, k), err);
        if (status != LC_OK)
            return status;
        row->samples = images * (uint64_t)p->samples;
        row->paths = row->samples * (uint64_t)d->width * (uint64_t)d->height;
        if ((claim->may_be_still || claim->exact) && is_still(f->film, r->skip, slack) &&
            (!r->film || is_still(r->film, r->skip, slack))) {
            compare_still(row, session, f->film, r, tolerance, slack);
            lc_row_show(session, row, evidence_of(f->film, r));
            return LC_OK;
        }
        row->exact = 0;
        forget_rounding(f->film, o->renderer->rounding, brightest(session->foreign));
        lc_pyramid_plan_init(&pyramid, lc_budget_row_fail(&budget), lc_budget_row_pass(&budget));
        if (claim->whole_only)
            lc_plan_whole(&pyramid, d->width, d->height);
        lc_comparison comparison = {f->film, r->film, r->expected, r->skip, f->tiles, row->margin, tolerance, 0};
        status = lc_judge_look(&result, &comparison, field, &pyramid, err);
        if (status != LC_OK)
            return status;
    }
    lc_row_conclude(row, &result, pyramid.alpha_pass);
    lc_row_show(session, row, evidence_of(f->film, r));
    return LC_OK;
}

lc_status lc_judge_foreign(lc_row *row, lc_session *session, const lc_claim *claim, lc_error *err)
{
    const lc_scene_desc *d = lc_scene_description(claim->scene);
    plan p = {0, 0, 0, 0, 0};
    reference r = {NULL, NULL, NULL};
    lc_status status = know_scene(session, claim->scene, err);
    if (status == LC_OK && !claim->other)
        status = lc_session_values(&r.expected, session, claim, err);
    if (status == LC_WRONG) { /* a missing reference is a failure */
        row->verdict = LC_ROW_FAIL;
        row->exact = 1;
        snprintf(row->reason, sizeof row->reason, "%.500s", err->text);
        return LC_OK;
    }
    if (status == LC_OK)
        status = make_plan(&p, row, session, claim, err);
    if (status != LC_OK)
        return status;
    unsigned char *skip = both_skips(session->foreign, claim, r.expected);
    lc_estimate *field = malloc(sizeof *field * (size_t)d->width * (size_t)d->height);
    r.skip = skip;
    status = skip && field ? judge(row, session, claim, &p, &r, field, err)
                           : lc_fail(err, LC_FAULT, "out of memory for the differences of %s", d->name);
    free(skip);
    free(field);
    return status;
}
