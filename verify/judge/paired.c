/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Relations between scenes, from the same random numbers: each sample less what the same numbers give over the terms. If
 * the relation holds, the differences have the mean 0, and hardly any variance where the paths are the same ones. This
 * is right whatever the numbers do with each other: each difference is one independent sample.
 */
#include <stdlib.h>

#include "verify/judge/judge_c.h"

/* What the terms add up to, of one channel [radiance]. */
typedef struct terms_mean {
    double mean, least; /* `least`: below it but for a chance of 1e-15 */
} terms_mean;

/* From the film over the scene itself and the differences, X - (X - T). */
static terms_mean mean_of_terms(const lc_film *film, const lc_film *difference, int channel)
{
    size_t count = (size_t)film->width * (size_t)film->height;
    double sum = 0, variance[2] = {0, 0};
    for (size_t i = 0; i < count; ++i) {
        sum += film->pixels[i].c[channel].mean - difference->pixels[i].c[channel].mean;
        variance[0] += lc_pixel_variance(&film->pixels[i], channel);
        variance[1] += lc_pixel_variance(&difference->pixels[i], channel);
    }
    /* Both films see the same samples: the errors add up. Missed bright samples lower the mean, which is the safe side. */
    double error = (sqrt(variance[0]) + sqrt(variance[1])) / (double)count, mean = sum / (double)count;
    return (terms_mean){mean, fmax(0, mean - 8 * error)};
}

/* c of the differences: their standard deviation over the mean of the terms, in the channel where it is largest. */
static double noise_of(const lc_film *film, const lc_film *difference)
{
    size_t count = (size_t)film->width * (size_t)film->height;
    double most = 0;
    for (int c = 0; c < 3; ++c) {
        double variance = 0, mean = mean_of_terms(film, difference, c).mean;
        for (size_t i = 0; i < count; ++i) {
            const lc_pixel *p = &difference->pixels[i];
            variance += p->n > 1 ? p->c[c].m2 / ((double)p->n - 1) / (double)count : 0.0;
        }
        if (mean > 0)
            most = fmax(most, sqrt(variance) / mean);
    }
    return most;
}

/* The light, if the root mean square of the differences is below the tolerance in each pixel; else 0. */
static double light_of_agreement(const lc_film *film, const lc_film *difference, double tolerance)
{
    size_t count = (size_t)film->width * (size_t)film->height;
    double light = 0;
    for (int c = 0; c < 3; ++c) {
        double mean = mean_of_terms(film, difference, c).mean, most = tolerance * mean;
        light = fmax(light, mean);
        for (size_t i = 0; i < count; ++i) {
            const lc_moments *m = &difference->pixels[i].c[c];
            double n = (double)difference->pixels[i].n;
            if (!(m->m2 + n * m->mean * m->mean <= n * most * most))
                return 0;
        }
    }
    return light;
}

/* Share of a look's false PASS that the bound of few differences gets; Student's t has the rest. */
static const double FEW_SHARE = 1.0 / 16;

/* How far the mean of the differences may be from the one seen [radiance], where there are so few of them that their third moment says
 * nothing: one ray in a million that meets the seam of two halves. `alpha`: both sides together. */
static double reach_of(const lc_film *difference, int channel, double alpha)
{
    size_t count = (size_t)difference->width * (size_t)difference->height;
    double all = 0, squares = 0, most = 0;
    for (size_t i = 0; i < count; ++i) {
        const lc_moments *m = &difference->pixels[i].c[channel];
        double n = (double)difference->pixels[i].n, own = m->m2 + n * m->mean * m->mean;
        all += n;
        squares += own;
        most = fmax(most, own); /* no difference is larger than the root of all their squares */
    }
    return most > 0 ? lc_met_bound(squares / all, all, sqrt(most), alpha) : 0;
}

static lc_status judge_look(lc_look *out, const lc_film *film, const lc_film *difference, const double *zero,
                            lc_estimate *field, lc_pyramid_plan *plan, double margin, double tolerance, lc_error *err)
{
    double most = -1, alpha_few = FEW_SHARE / (1 - FEW_SHARE) * plan->alpha_pass;
    out->verdict = LC_PASS;
    out->share = 1;
    for (int c = 0; c < 3; ++c) {
        lc_pyramid pyramid;
        terms_mean terms = mean_of_terms(film, difference, c);
        plan->margin[lc_pyramid_levels(film->width, film->height) - 1] =
            terms.least > 0 ? margin * terms.least : INFINITY;
        double tolerated = tolerance * fmax(terms.mean, 0);
        lc_status status = lc_field_one(field, difference, zero, c, tolerated, err);
        for (size_t i = 0; status == LC_OK && i < (size_t)film->width * (size_t)film->height; ++i)
            field[i].expected = film->pixels[i].c[c].mean - difference->pixels[i].c[c].mean;
        if (status == LC_OK)
            status = lc_pyramid_judge(&pyramid, field, film->width, film->height, plan, err);
        if (status != LC_OK)
            return status;
        double unit = terms.mean > 0 ? terms.mean : 1, reach = reach_of(difference, c, 2 * alpha_few);
        if (pyramid.verdict == LC_GO_ON && terms.least > 0 &&
            fabs(pyramid.whole.student.difference) + reach <= margin * terms.least)
            pyramid.verdict = LC_PASS;
        out->verdict = lc_verdict_both(out->verdict, pyramid.verdict);
        if (lc_row_hardness(&pyramid, unit) > most) {
            most = lc_row_hardness(&pyramid, unit);
            out->hardest = pyramid;
            out->channel = c;
            out->scale = unit;
            out->is_dark = 0;
            out->reach = reach;
        }
    }
    return LC_OK;
}

/* Both films at the same samples. */
static lc_status films_of(const lc_film **film, const lc_film **difference, lc_session *session, const lc_claim *claim,
                          uint32_t arm, uint64_t samples, lc_error *err)
{
    lc_status status = lc_session_film(film, session, claim->scene, claim->estimator, claim->min_bounces,
                                       claim->max_bounces, arm, samples, err);
    return status == LC_OK ? lc_session_difference(difference, session, claim, arm, samples, err) : status;
}

/* 1 when no statistics are needed: bad samples, or all agree. */
static int is_settled(lc_row *row, const lc_film *film, const lc_film *difference, const lc_session *session,
                      const lc_claim *claim)
{
    if (film->bad || difference->bad) {
        lc_row_bad(row, film->bad ? film : difference, session->options->seed);
        return 1;
    }
    double light = light_of_agreement(film, difference, claim->tolerance);
    if (light > 0)
        lc_row_settle(row, session, 1, light);
    return light > 0;
}

static lc_status judge(lc_row *row, lc_session *session, const lc_claim *claim, lc_estimate *field, const double *zero,
                       lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(claim->scene);
    int pixels = desc->width * desc->height;
    uint32_t arm = lc_session_arm(claim->estimator);
    const lc_film *film, *difference;
    /* Where all samples agree, few of them tell; else a pilot, whose samples are never used again, tells how many. */
    row->samples = LC_BLOCK;
    row->paths = row->samples * (uint64_t)pixels;
    lc_status status = films_of(&film, &difference, session, claim, arm, LC_BLOCK, err);
    if (status == LC_OK && is_settled(row, film, difference, session, claim))
        return LC_OK;
    if (status == LC_OK)
        status = films_of(&film, &difference, session, claim, ~arm, LC_BLOCK, err);
    if (status != LC_OK)
        return status;
    double c = noise_of(film, difference);
    row->margin = lc_claim_margin(session, claim, c);
    uint64_t most = (uint64_t)fmin(session->options->suite->most_samples / pixels, UINT32_MAX);
    lc_looks looks = lc_looks_plan(lc_planned_samples(c, row->margin, pixels), most);
    if (!lc_film_is_black(film)) /* few differences, none of which the pilot met, may need more to be bounded; of black nothing is ever shown */
        lc_looks_reserve(&looks, most);
    lc_budget budget = {session->options->false_fail, session->options->false_pass, session->rows, 3, LC_MOST_LOOKS};
    lc_pyramid_plan plan;
    lc_pyramid_plan_init(&plan, lc_budget_row_fail(&budget), (1 - FEW_SHARE) * lc_budget_row_pass(&budget));
    /* Where paths part, differences are rare and large, of both signs, so that third moments cancel: the guard against heavy tails does not
     * see, in a tile that none of them has met, that the little that is left is not all. */
    lc_plan_whole(&plan, desc->width, desc->height);
    lc_look result = {.verdict = LC_GO_ON, .reach = INFINITY};
    for (int k = 0; k < looks.count && result.verdict == LC_GO_ON; ++k) {
        row->samples = looks.samples[k];
        row->paths = row->samples * (uint64_t)pixels;
        status = films_of(&film, &difference, session, claim, arm, row->samples, err);
        if (status != LC_OK)
            return status;
        if (is_settled(row, film, difference, session, claim)) {
            lc_row_show(session, row, (lc_exhibit){film, NULL, NULL, difference, NULL});
            return LC_OK;
        }
        status = judge_look(&result, film, difference, zero, field, &plan, row->margin, claim->tolerance, err);
        if (status != LC_OK)
            return status;
    }
    lc_row_conclude(row, &result, plan.alpha_pass);
    lc_row_show(session, row, (lc_exhibit){film, NULL, NULL, difference, NULL});
    return LC_OK;
}

lc_status lc_judge_paired(lc_row *row, lc_session *session, const lc_claim *claim, lc_estimate *field, lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(claim->scene);
    double *zero = calloc(3 * (size_t)desc->width * (size_t)desc->height, sizeof *zero);
    if (!zero)
        return lc_fail(err, LC_FAULT, "out of memory for the differences of %s", desc->name);
    lc_status status = judge(row, session, claim, field, zero, err);
    free(zero);
    return status;
}
