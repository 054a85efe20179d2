/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "estimators/registry.h"
#include "verify/judge/judge_c.h"

int lc_is_registered(const lc_estimator *estimator)
{
    for (const lc_estimator *const *e = lc_estimators; *e; ++e)
        if (*e == estimator)
            return 1;
    return 0;
}

uint32_t lc_session_arm(const lc_estimator *estimator)
{
    if (lc_is_registered(estimator))
        return lc_arm(estimator->name);
    char name[160];
    snprintf(name, sizeof name, "under test: %s", estimator->name);
    return lc_arm(name);
}

static int same_stream(const lc_stock_film *a, const lc_stock_film *b)
{
    return a->scene == b->scene && a->estimator == b->estimator && a->min_bounces == b->min_bounces &&
           a->max_bounces == b->max_bounces && a->arm == b->arm && a->minus == b->minus;
}

/* The film of the stream with the most samples up to `samples`, or NULL. */
static const lc_film *longest_film(const lc_session *session, const lc_stock_film *key, uint64_t samples)
{
    const lc_film *best = NULL;
    for (int i = 0; i < session->film_count; ++i) {
        const lc_film *film = session->films[i].film;
        if (same_stream(&session->films[i], key) && film->count <= samples && (!best || film->count > best->count))
            best = film;
    }
    return best;
}

static lc_status copy_film(lc_film **out, const lc_film *from, lc_error *err)
{
    lc_status status = lc_film_create(out, from->width, from->height, err);
    if (status != LC_OK)
        return status;
    lc_pixel *pixels = (*out)->pixels;
    **out = *from; /* a rendered film has no further ranges that it owns */
    (*out)->pixels = pixels;
    memcpy(pixels, from->pixels, sizeof *pixels * (size_t)from->width * (size_t)from->height);
    return LC_OK;
}

/* Every look is kept, so that a claim sees exactly the samples of its own looks, whatever other claims have asked for before. */
static lc_status grow(const lc_film **out, lc_session *session, lc_stock_film key, uint64_t samples, lc_error *err)
{
    const lc_film *base = longest_film(session, &key, samples);
    if (base && base->count == samples) {
        *out = base;
        return LC_OK;
    }
    lc_stock_film *films = realloc(session->films, ((size_t)session->film_count + 1) * sizeof *films);
    if (!films)
        return lc_fail(err, LC_FAULT, "out of memory for a film");
    session->films = films;
    const lc_scene_desc *desc = lc_scene_description(key.scene);
    lc_status status =
        base ? copy_film(&key.film, base, err) : lc_film_create(&key.film, desc->width, desc->height, err);
    if (status != LC_OK)
        return status;
    films[session->film_count++] = key;
    lc_render_options options = {.min_bounces = key.min_bounces,
                                 .max_bounces = key.max_bounces,
                                 .seed = session->options->seed,
                                 .arm = key.arm,
                                 .first = key.film->count,
                                 .count = samples - key.film->count,
                                 .threads = session->options->threads};
    if (key.minus) {
        options.minus = key.minus->term;
        options.minus_count = key.minus->term_count;
    }
    session->paths += options.count * (uint64_t)desc->width * (uint64_t)desc->height * (1 + (uint64_t)options.minus_count);
    *out = key.film;
    status = lc_render(key.film, key.scene, key.estimator, &options, err);
    if (status != LC_OK) { /* a film that failed is nothing to grow from */
        lc_film_free(key.film);
        --session->film_count;
    }
    return status;
}

lc_status lc_session_film(const lc_film **out, lc_session *session, const lc_scene *scene,
                          const lc_estimator *estimator, int min_bounces, int max_bounces, uint32_t arm,
                          uint64_t samples, lc_error *err)
{
    return grow(out, session, (lc_stock_film){scene, estimator, min_bounces, max_bounces, arm, NULL, NULL}, samples,
                err);
}

lc_status lc_session_difference(const lc_film **out, lc_session *session, const lc_claim *claim, uint32_t arm,
                                uint64_t samples, lc_error *err)
{
    lc_stock_film key = {claim->scene, claim->estimator, claim->min_bounces, claim->max_bounces, arm, claim, NULL};
    return grow(out, session, key, samples, err);
}

static void release_expected(lc_expected *expected)
{
    free(expected->rgb);
    free(expected->skip);
}

static const lc_expected *known_values(const lc_session *session, const lc_claim *claim)
{
    for (int i = 0; i < session->value_count; ++i) {
        const lc_stock_values *known = &session->values[i];
        if (known->scene == claim->scene && known->expect == claim->expect && known->min_bounces == claim->min_bounces &&
            known->max_bounces == claim->max_bounces)
            return &known->expected;
    }
    return NULL;
}

lc_status lc_session_values(const lc_expected **out, lc_session *session, const lc_claim *claim, lc_error *err)
{
    *out = known_values(session, claim);
    if (*out)
        return LC_OK;
    const lc_scene_desc *desc = lc_scene_description(claim->scene);
    size_t pixels = (size_t)desc->width * (size_t)desc->height;
    lc_stock_values *values = realloc(session->values, ((size_t)session->value_count + 1) * sizeof *values);
    if (!values)
        return lc_fail(err, LC_FAULT, "out of memory for expected values");
    session->values = values;
    lc_expected expected = {desc->width, desc->height, calloc(3 * pixels, sizeof(double)), calloc(pixels, 1)};
    lc_status status = expected.rgb && expected.skip
                           ? claim->expect(&expected, claim, claim->scene, session->options->threads, err)
                           : lc_fail(err, LC_FAULT, "out of memory for expected values");
    if (status != LC_OK) {
        release_expected(&expected);
        return status;
    }
    values[session->value_count] =
        (lc_stock_values){claim->scene, claim->expect, claim->min_bounces, claim->max_bounces, expected};
    *out = &values[session->value_count++].expected;
    return LC_OK;
}

void lc_session_clear(lc_session *session)
{
    for (int i = 0; i < session->film_count; ++i)
        lc_film_free(session->films[i].film);
    for (int i = 0; i < session->value_count; ++i)
        release_expected(&session->values[i].expected);
    free(session->films);
    free(session->values);
    lc_foreign_free(session->foreign);
    session->foreign = NULL;
    session->films = NULL;
    session->values = NULL;
    session->film_count = session->value_count = 0;
}

/* ---- one claim at a time ------------------------------------------------------------------------------------------- */

lc_status lc_session_open(lc_session **out, const lc_verify_options *options, int rows, lc_error *err)
{
    *out = calloc(1, sizeof **out);
    if (!*out)
        return lc_fail(err, LC_FAULT, "out of memory for a session");
    (*out)->options = options;
    (*out)->rows = rows;
    (*out)->margin = options->margin > 0 ? options->margin : options->suite->margin;
    return LC_OK;
}

void lc_session_close(lc_session *session)
{
    if (session)
        lc_session_clear(session);
    free(session);
}

void lc_session_seen(lc_seen *out, const lc_session *session, const lc_claim *claim)
{
    uint32_t arm = lc_session_arm(claim->estimator);
    lc_stock_film key = {claim->scene, claim->estimator, claim->min_bounces, claim->max_bounces, arm, NULL, NULL};
    memset(out, 0, sizeof *out);
    out->film = longest_film(session, &key, UINT64_MAX);
    key.minus = claim;
    out->difference = longest_film(session, &key, UINT64_MAX);
    key = (lc_stock_film){claim->scene, claim->other, claim->min_bounces, claim->max_bounces, 0, NULL, NULL};
    key.arm = claim->other ? lc_session_arm(claim->other) : 0;
    out->other = claim->other ? longest_film(session, &key, UINT64_MAX) : NULL;
    out->expected = known_values(session, claim);
    for (int i = 0; i < session->film_count; ++i)
        if (session->films[i].estimator == claim->estimator && session->films[i].film->bad)
            out->bad = session->films[i].film;
}

void lc_session_forget(lc_session *session, const lc_estimator *estimator)
{
    int kept = 0;
    for (int i = 0; i < session->film_count; ++i)
        if (session->films[i].estimator == estimator)
            lc_film_free(session->films[i].film);
        else
            session->films[kept++] = session->films[i];
    session->film_count = kept;
}

int lc_film_is_black(const lc_film *film)
{
    for (size_t i = 0; i < (size_t)film->width * (size_t)film->height; ++i)
        for (int c = 0; c < 3; ++c)
            if (film->pixels[i].c[c].max > 0)
                return 0;
    return 1;
}

double lc_film_noise(const lc_film *film)
{
    double most = 0;
    size_t count = (size_t)film->width * (size_t)film->height;
    for (int c = 0; c < 3; ++c) {
        double mean = 0, variance = 0;
        for (size_t i = 0; i < count; ++i) {
            const lc_pixel *p = &film->pixels[i];
            mean += p->c[c].mean / (double)count;
            variance += p->n > 1 ? p->c[c].m2 / ((double)p->n - 1) / (double)count : 0.0;
        }
        if (mean > 0)
            most = fmax(most, sqrt(variance) / mean);
    }
    return most;
}
