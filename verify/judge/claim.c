/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Deciding one claim: grow the film(s) to the next look, judge the differences at every scale, stop when something is shown.
 */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "verify/judge/judge_c.h"

static const char *const channel_names[] = {"R", "G", "B"};

/* ---- words ---------------------------------------------------------------------------------------------------- */

void lc_row_bad(lc_row *row, const lc_film *film, uint64_t seed)
{
    row->verdict = LC_ROW_FAIL;
    snprintf(row->reason, sizeof row->reason,
             "%s on %s: %llu samples are NaN, infinite, negative or above 1e60, the first (%g, %g, %g) at pixel %d,%d sample %llu "
             "seed %llu",
             film->estimator, film->scene, (unsigned long long)film->bad, film->bad_value[0], film->bad_value[1],
             film->bad_value[2], film->bad_x, film->bad_y, (unsigned long long)film->bad_sample,
             (unsigned long long)seed);
}

/* A missing reference is a failure. */
static lc_status describe_missing(lc_row *row, const lc_error *err)
{
    row->verdict = LC_ROW_FAIL;
    row->exact = 1; /* nothing was estimated */
    snprintf(row->reason, sizeof row->reason, "%.500s", err->text);
    return LC_OK;
}

/* There is no percentage of nothing. */
static void describe_light(lc_row *row, double mean)
{
    int length = snprintf(row->reason, sizeof row->reason, "%s on %s is wrong: there is light where none is expected, a mean of %.3g (%s)",
                          row->estimator, row->scene, mean, channel_names[row->channel]);
    if (row->tile_width)
        snprintf(row->reason + length, sizeof row->reason - (size_t)length, ", most clearly in %dx%d pixels at %d,%d", row->tile_width,
                 row->tile_height, row->tile_x, row->tile_y);
}

static void describe(lc_row *row, const lc_look *look)
{
    const lc_pyramid *p = &look->hardest;
    if (row->verdict == LC_ROW_FAIL && look->is_dark) {
        describe_light(row, look->scale);
    } else if (row->verdict == LC_ROW_FAIL) {
        double whole = 100 * (row->ratio - 1);
        if (p->worst.level >= 0 && p->worst.level < p->levels - 1)
            snprintf(row->reason, sizeof row->reason,
                     "%s on %s is wrong: %+.3g%% over the image, most clearly in %dx%d pixels at %d,%d (%s)",
                     row->estimator, row->scene, whole, row->tile_width, row->tile_height, row->tile_x, row->tile_y,
                     channel_names[row->channel]);
        else
            snprintf(row->reason, sizeof row->reason,
                     "%s on %s is wrong by %+.3g%% of the reflected light, [%+.3g%%, %+.3g%%] (%s)", row->estimator,
                     row->scene, whole, 100 * (row->low - 1), 100 * (row->high - 1), channel_names[row->channel]);
    } else if (row->verdict == LC_ROW_UNDECIDED) {
        const lc_level *image = &p->level[p->levels - 1];
        const char *why = image->few ? "too few samples a pixel"
                          : image->still && fabs(row->ratio) < 1e-9
                              ? "not one of its samples carries light, which may be too rare to be met"
                          : image->still  ? "its samples show no variance, which proves nothing"
                          : image->skewed || isinf(row->low) || isinf(row->high)
                              ? "rare bright samples: the tails are too heavy for this number of samples"
                                          : "the interval is still wider than the margin";
        snprintf(row->reason, sizeof row->reason, "%s on %s: undecided after %llu samples a pixel: %s", row->estimator,
                 row->scene, (unsigned long long)row->samples, why);
    }
}

/* ---- numbers -------------------------------------------------------------------------------------------------- */

/* Writes what the pyramid of one channel found into the row. */
static void fill_numbers(lc_row *row, const lc_look *look, double alpha_pass)
{
    const lc_pyramid *p = &look->hardest;
    const lc_student *s = &p->whole.student;
    lc_interval interval = lc_student_interval(s, 2 * alpha_pass);
    double scale = look->scale;
    row->channel = look->channel;
    row->expected = scale;
    row->ratio = 1 + s->difference / scale;
    row->low = 1 + fmax(interval.lower, s->difference - look->reach) / scale;
    row->high = 1 + fmin(interval.upper, s->difference + look->reach) / scale;
    row->tile_width = 0;
    if (p->worst.level >= 0) {
        row->tile_x = p->worst.x;
        row->tile_y = p->worst.y;
        row->tile_width = p->worst.width;
        row->tile_height = p->worst.height;
        row->tile_ratio = 1 + p->worst.student.difference / p->worst.student.expected;
        row->tile_log10_p = p->worst.log_p / log(10.0);
    }
    row->missed = lc_missed_value(row->margin, look->share * (double)row->paths, 1e-6);
}

/* How hard the channel was: FAIL before undecided before PASS, then by the deviation. */
double lc_row_hardness(const lc_pyramid *p, double scale)
{
    double step = p->verdict == LC_FAIL ? 2e9 : p->verdict == LC_GO_ON ? 1e9 : 0;
    double deviation = fabs(p->whole.student.difference) / scale;
    return step + (p->verdict == LC_FAIL && p->worst.level >= 0 ? fmin(-p->worst.log_p, 1e8) : fmin(deviation, 1e8));
}

void lc_row_conclude(lc_row *row, const lc_look *look, double alpha_pass)
{
    row->verdict = look->verdict == LC_PASS ? LC_ROW_PASS : look->verdict == LC_FAIL ? LC_ROW_FAIL : LC_ROW_UNDECIDED;
    fill_numbers(row, look, alpha_pass);
    describe(row, look);
}

void lc_row_show(const lc_session *session, lc_row *row, lc_exhibit evidence)
{
    static pthread_mutex_t alone = PTHREAD_MUTEX_INITIALIZER;
    if (row->verdict != LC_ROW_FAIL || !session->options->on_fail)
        return;
    pthread_mutex_lock(&alone);
    session->options->on_fail(session->options->user, row, session->number, &evidence);
    pthread_mutex_unlock(&alone);
}

/* Against another film, or where that is NULL, against the expected values. */
static void show(const lc_session *session, lc_row *row, const lc_film *film, const lc_film *other,
                 const lc_expected *expected)
{
    lc_row_show(session, row,
                (lc_exhibit){film, other, other ? NULL : expected->rgb, NULL, other ? NULL : expected->skip});
}

/* Mean over the pixels that are not skipped, of the film or of the expected values. */
double lc_claim_mean(const lc_film *film, const lc_expected *expected, const unsigned char *skip, int channel)
{
    size_t count =
               film ? (size_t)film->width * (size_t)film->height : (size_t)expected->width * (size_t)expected->height,
           used = 0;
    double sum = 0;
    for (size_t i = 0; i < count; ++i) {
        if (skip && skip[i])
            continue;
        sum += film ? film->pixels[i].c[channel].mean : expected->rgb[3 * i + (size_t)channel];
        ++used;
    }
    return used ? sum / (double)used : 0;
}

double lc_claim_share(const unsigned char *skip, int pixels)
{
    int used = 0;
    for (int i = 0; i < pixels; ++i)
        used += !(skip && skip[i]);
    return (double)used / pixels;
}

/* ---- exact claims ----------------------------------------------------------------------------------------------- */

void lc_row_settle(lc_row *row, const lc_session *session, double share, double light)
{
    row->exact = 1;
    row->verdict = LC_ROW_PASS;
    row->missed = light > 0 ? lc_missed_value(session->margin, share * (double)row->paths, 1e-6) : 0;
}

/* The largest of three channels' means. */
static double light_of(const lc_film *film, const lc_expected *expected, const unsigned char *skip)
{
    double most = 0;
    for (int c = 0; c < 3; ++c)
        most = fmax(most, lc_claim_mean(film, expected, skip, c));
    return most;
}

/* Pixel by pixel, against the other film's or the expected values. */
static void compare_exactly(lc_row *row, const lc_session *session, const lc_film *film, const lc_film *other,
                            const lc_expected *expected, double tolerance)
{
    size_t count = (size_t)film->width * (size_t)film->height;
    const unsigned char *skip = expected ? expected->skip : NULL;
    lc_row_settle(row, session, lc_claim_share(skip, film->width * film->height), light_of(other, expected, skip));
    for (size_t i = 0; i < count; ++i) {
        for (int c = 0; c < 3; ++c) {
            if (expected && expected->skip[i])
                continue;
            double is = film->pixels[i].c[c].mean,
                   should = other ? other->pixels[i].c[c].mean : expected->rgb[3 * i + (size_t)c];
            if (lc_decide_exact(is - should, tolerance * fabs(should)) == LC_PASS)
                continue;
            row->verdict = LC_ROW_FAIL;
            row->missed = 0;
            row->channel = c;
            row->expected = should;
            row->ratio = row->tile_ratio = is / should;
            row->tile_x = (int)(i % (size_t)film->width);
            row->tile_y = (int)(i / (size_t)film->width);
            row->tile_width = row->tile_height = 1;
            int length = snprintf(row->reason, sizeof row->reason, "%s on %s is wrong: pixel %d,%d has %s = %.9g, expected exactly %.9g",
                                  row->estimator, row->scene, (int)(i % (size_t)film->width), (int)(i / (size_t)film->width),
                                  channel_names[c], is, should);
            if (should != 0)
                snprintf(row->reason + length, sizeof row->reason - (size_t)length, " (%+.3g%%)", 100 * (is / should - 1));
            return;
        }
    }
}

static lc_status judge_exact(lc_row *row, lc_session *session, const lc_claim *claim, lc_error *err)
{
    const lc_film *film, *other = NULL;
    const lc_expected *expected = NULL;
    lc_error why = {""};
    uint32_t arm = lc_session_arm(claim->estimator);
    row->samples = LC_BLOCK;
    lc_status status = lc_session_film(&film, session, claim->scene, claim->estimator, claim->min_bounces,
                                       claim->max_bounces, arm, row->samples, err);
    if (status == LC_OK)
        status = claim->other ? lc_session_film(&other, session, claim->scene, claim->other, claim->min_bounces,
                                                claim->max_bounces, arm, row->samples, err)
                              : lc_session_values(&expected, session, claim, &why);
    if (status == LC_WRONG)
        return describe_missing(row, &why);
    if (status != LC_OK)
        return why.text[0] ? lc_fail(err, status, "%s", why.text) : status;
    row->paths = row->samples * (uint64_t)film->width * (uint64_t)film->height;
    if (film->bad)
        lc_row_bad(row, film, session->options->seed);
    else
        compare_exactly(row, session, film, other, expected, claim->tolerance);
    show(session, row, film, other, expected);
    return LC_OK;
}

/* 1 when no pixel that counts shows any variance beyond rounding. */
static int is_still(const lc_film *film, const lc_expected *expected)
{
    for (size_t i = 0; i < (size_t)film->width * (size_t)film->height; ++i)
        for (int c = 0; c < 3 && !expected->skip[i]; ++c) {
            const lc_moments *m = &film->pixels[i].c[c];
            if (m->m2 > 1e-24 * m->mean * m->mean * (double)film->pixels[i].n)
                return 0;
        }
    return 1;
}

/* ---- statistical claims -------------------------------------------------------------------------------------------- */

/* What stands on one side of a claim: an estimator over a scene, with numbers of its own. */
typedef struct side {
    const lc_scene *scene;
    const lc_estimator *estimator; /* NULL: nobody, but expected values */
    int min_bounces, max_bounces;
    uint32_t arm;
} side;

static side first_side(const lc_claim *claim)
{
    return (side){claim->scene, claim->estimator, claim->min_bounces, claim->max_bounces,
                  lc_session_arm(claim->estimator)};
}

static side second_side(const lc_claim *claim)
{
    side s = first_side(claim);
    s.estimator = claim->other;
    if (claim->other)
        s.arm = lc_session_arm(claim->other);
    if (claim->term_count) {
        s.scene = claim->term[0].scene;
        s.estimator = claim->estimator;
        s.min_bounces -= claim->term[0].shift;
        s.max_bounces -= claim->term[0].shift;
        s.arm ^= lc_arm("over another scene");
    }
    return s;
}

static lc_status film_of(const lc_film **out, lc_session *session, const side *s, uint32_t arm, uint64_t samples,
                         lc_error *err)
{
    return lc_session_film(out, session, s->scene, s->estimator, s->min_bounces, s->max_bounces, arm, samples, err);
}

/* c of an estimator on a scene: from the table, else from a pilot whose samples are never used again. */
static lc_status noise_of(double *c, lc_session *session, const side *s, lc_error *err)
{
    *c = s->min_bounces == 1 && lc_is_registered(s->estimator)
             ? lc_cell_noise(lc_scene_description(s->scene)->name, s->estimator->name, s->max_bounces)
             : NAN;
    if (!isnan(*c))
        return LC_OK;
    const lc_film *pilot;
    lc_status status = film_of(&pilot, session, s, ~s->arm, LC_BLOCK, err);
    if (status == LC_OK)
        *c = lc_film_noise(pilot);
    return status;
}

lc_status lc_claim_noise(double *c, lc_session *session, const lc_claim *claim, const lc_estimator *estimator,
                         lc_error *err)
{
    side s = first_side(claim);
    s.estimator = estimator;
    s.arm = lc_session_arm(estimator);
    return noise_of(c, session, &s, err);
}

/* Largest error of a pixel's mean that was rounded to float, subnormal ones included. */
static double rounding_of(const lc_film *film, size_t pixel, int channel)
{
    return (1 + film->more_count) * (ldexp(fabs(film->pixels[pixel].c[channel].mean), -24) + ldexp(1, -150));
}

/* The differences of one channel, those of pixels that are left out being none. */
static lc_status fill_field(lc_estimate *field, const lc_comparison *what, int channel, double scale, lc_error *err)
{
    const lc_film *film = what->film;
    double tolerance = what->tolerance * scale;
    lc_status status = what->other ? lc_field_two(field, film, what->other, channel, tolerance, err)
                                   : lc_field_one(field, film, what->expected->rgb, channel, tolerance, err);
    for (size_t i = 0; i < (size_t)film->width * (size_t)film->height; ++i) {
        if (what->is_from_files)
            field[i].tolerance += rounding_of(film, i, channel) + (what->other ? rounding_of(what->other, i, channel) : 0);
        if (what->skip && what->skip[i])
            field[i] = lc_estimate_zero();
    }
    return status;
}

lc_status lc_judge_look(lc_look *out, const lc_comparison *what, lc_estimate *field, lc_pyramid_plan *plan, lc_error *err)
{
    int width = what->film->width, height = what->film->height;
    double most = -1;
    out->verdict = LC_PASS;
    out->reach = INFINITY;
    out->share = lc_claim_share(what->skip, width * height);
    for (int c = 0; c < 3; ++c) {
        lc_pyramid pyramid;
        double scale = lc_claim_mean(what->other, what->expected, what->skip, c);
        /* Where nothing is expected, any light at all is wrong by infinitely many percent: the margin is then of what was seen. */
        double unit = scale > 0 ? scale : lc_claim_mean(what->film, NULL, what->skip, c);
        plan->margin[lc_pyramid_levels(width, height) - 1] = unit > 0 ? what->margin * unit : INFINITY;
        plan->relative = what->other ? what->margin : 0;
        lc_status status = fill_field(field, what, c, scale, err);
        if (status == LC_OK)
            status = what->tiles ? lc_pyramid_judge_tiles(&pyramid, field, width, height, what->tiles, c, plan, err)
                                 : lc_pyramid_judge(&pyramid, field, width, height, plan, err);
        if (status != LC_OK)
            return status;
        out->verdict = lc_verdict_both(out->verdict, pyramid.verdict);
        if (lc_row_hardness(&pyramid, unit) > most) {
            most = lc_row_hardness(&pyramid, unit);
            out->hardest = pyramid;
            out->channel = c;
            out->scale = unit;
            out->is_dark = !(scale > 0);
        }
    }
    return LC_OK;
}

double lc_claim_margin(const lc_session *session, const lc_claim *claim, double c)
{
    return session->margin * (claim->slack > 0 ? claim->slack : 1) * fmax(1.0, c);
}

void lc_plan_whole(lc_pyramid_plan *plan, int width, int height)
{
    for (int level = 0; level < lc_pyramid_levels(width, height) - 1; ++level)
        plan->least[level] = UINT64_MAX;
}

/* Share of a channel's and look's budget that the test of independence gets; the pyramid has the rest. */
static const double NOISE_SHARE = 1.0 / 16;

/* The channel in which samples are shown to depend on each other, else -1: every standard error rests on their
 * independence, so that nothing else about such a film can be believed. */
static int dependent_channel(lc_batches *out, const lc_film *film, double alpha)
{
    for (int c = 0; c < 3; ++c) {
        *out = lc_batches_of_film(film, c);
        if (lc_batches_depend(out, alpha))
            return c;
    }
    return -1;
}

static void describe_dependence(lc_row *row, const lc_batches *b, int channel)
{
    row->verdict = LC_ROW_FAIL;
    row->dependent = 1;
    snprintf(row->reason, sizeof row->reason,
             "%s on %s: its samples depend on each other: means of %d samples vary %.3g times as much as those of "
             "independent ones (%s, p = 1e%.0f): a generator is shared or seeded again",
             row->estimator, row->scene, (int)LC_BLOCK, b->ratio, channel_names[channel], b->log_p / log(10.0));
}

/* What a claim is decided with. */
typedef struct course {
    side one, two;
    const lc_expected *expected; /* where `two` is nobody */
    lc_looks looks;
    double alpha; /* of a channel at a look */
    double noise; /* as of the claim, where the suite asks for it */
    lc_pyramid_plan plan;
} course;

/* The films of one look, bad or good; both arms grow together. */
static lc_status films_of(const lc_film **film, const lc_film **other, lc_session *session, const course *way,
                          uint64_t samples, lc_error *err)
{
    *other = NULL;
    lc_status status = film_of(film, session, &way->one, way->one.arm, samples, err);
    return status == LC_OK && way->two.estimator ? film_of(other, session, &way->two, way->two.arm, samples, err)
                                                 : status;
}

/* Look by look, until something is shown. */
static lc_status walk(lc_row *row, lc_session *session, const lc_claim *claim, course *way, lc_estimate *field,
                      lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(claim->scene);
    const lc_expected *expected = way->expected;
    const lc_film *film = NULL, *other = NULL;
    lc_look result = {.verdict = LC_GO_ON, .reach = INFINITY};
    lc_batches batches;
    int dependent = -1;
    for (int k = 0; k < way->looks.count && result.verdict == LC_GO_ON && dependent < 0; ++k) {
        row->samples = way->looks.samples[k];
        lc_status status = films_of(&film, &other, session, way, row->samples, err);
        if (status != LC_OK)
            return status;
        row->paths = row->samples * (uint64_t)desc->width * (uint64_t)desc->height;
        int is_bad = film->bad || (other && other->bad);
        if (is_bad)
            lc_row_bad(row, film->bad ? film : other, session->options->seed);
        else if (claim->may_be_still && expected && is_still(film, expected))
            compare_exactly(row, session, film, NULL, expected, fmax(claim->tolerance, 1e-9));
        if (is_bad || row->exact) {
            show(session, row, film, other, expected);
            return LC_OK;
        }
        lc_comparison comparison = {film, other, expected, expected ? expected->skip : NULL, NULL, row->margin, claim->tolerance, 0};
        status = lc_judge_look(&result, &comparison, field, &way->plan, err);
        if (status != LC_OK)
            return status;
        int is_noisy = result.hardest.whole.student.error > way->noise * result.scale;
        if (result.verdict == LC_PASS && way->noise > 0 && is_noisy && k + 1 < way->looks.count)
            result.verdict = LC_GO_ON;
        dependent = dependent_channel(&batches, film, NOISE_SHARE * way->alpha);
    }
    lc_row_conclude(row, &result, way->plan.alpha_pass);
    if (dependent >= 0)
        describe_dependence(row, &batches, dependent);
    show(session, row, film, other, expected);
    return LC_OK;
}

static lc_status judge_statistically(lc_row *row, lc_session *session, const lc_claim *claim, lc_estimate *field,
                                     lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(claim->scene);
    int pixels = desc->width * desc->height;
    double c, c_other = 0;
    course way = {.one = first_side(claim), .two = second_side(claim)};
    lc_status status = noise_of(&c, session, &way.one, err);
    if (status == LC_OK && way.two.estimator)
        status = noise_of(&c_other, session, &way.two, err);
    if (status != LC_OK)
        return status;
    row->margin = fmax(lc_claim_margin(session, claim, c), claim->margin);
    /* A mean anywhere within the tolerance must be shown to be within the margin. */
    double room = claim->margin > 0 ? row->margin - claim->tolerance : row->margin;

    uint64_t most = (uint64_t)fmin(session->options->suite->most_samples / pixels, UINT32_MAX);
    uint64_t planned = lc_planned_samples(hypot(c, c_other), room, pixels);
    if (claim->noise > 0 && strcmp(session->options->suite->name, "quick") != 0) { /* the second look is at two fifths */
        way.noise = claim->noise;
        double needed = ceil(2.5 * lc_samples_needed(hypot(c, c_other), claim->noise, 1) / pixels);
        planned = (uint64_t)fmax((double)planned, fmin(needed, (double)most));
    }
    way.looks = lc_looks_plan(planned, most);
    lc_budget budget = {session->options->false_fail, session->options->false_pass, session->rows, 3, LC_MOST_LOOKS};
    way.alpha = lc_budget_row_fail(&budget);
    lc_pyramid_plan_init(&way.plan, (1 - NOISE_SHARE) * way.alpha, lc_budget_row_pass(&budget));
    if (claim->whole_only)
        lc_plan_whole(&way.plan, desc->width, desc->height);

    lc_error why = {""};
    if (!way.two.estimator)
        status = lc_session_values(&way.expected, session, claim, &why);
    if (status == LC_WRONG)
        return describe_missing(row, &why);
    return status == LC_OK ? walk(row, session, claim, &way, field, err) : lc_fail(err, status, "%s", why.text);
}

/* By the claim itself, with its share of the budget. */
static lc_status judge_by_itself(lc_row *row, lc_session *session, const lc_claim *claim, uint32_t arm, lc_error *err)
{
    const lc_verify_options *o = session->options;
    lc_share share = {o->false_fail / session->rows, o->false_pass / session->rows, session->margin, o->seed, arm,
                      o->threads};
    lc_status status = claim->decide(row, claim, &share, err);
    if (claim->scene)
        session->paths += row->paths;
    return status;
}

static lc_status judge_host(lc_row *row, lc_session *session, const lc_claim *claim, lc_error *err)
{
    snprintf(row->check, sizeof row->check, "%s", claim->check->name);
    snprintf(row->scene, sizeof row->scene, "%s", claim->subject);
    snprintf(row->estimator, sizeof row->estimator, "host");
    snprintf(row->source, sizeof row->source, "%s", claim->source);
    lc_row_reproduce(row, session->options, claim);
    return judge_by_itself(row, session, claim, 0, err);
}

lc_status lc_judge_claim(lc_row *row, lc_session *session, const lc_claim *claim, lc_error *err)
{
    if (!claim->scene)
        return judge_host(row, session, claim, err);
    const lc_scene_desc *desc = lc_scene_description(claim->scene);
    snprintf(row->check, sizeof row->check, "%s", claim->check->name);
    snprintf(row->scene, sizeof row->scene, "%.39s%s%.23s", desc->name, claim->relation ? "/" : "",
             claim->relation ? claim->relation : "");
    snprintf(row->estimator, sizeof row->estimator, "%s", claim->estimator->name);
    snprintf(row->source, sizeof row->source, "%s", claim->source);
    lc_row_reproduce(row, session->options, claim);
    row->exact = claim->exact;
    row->min_bounces = claim->min_bounces;
    row->max_bounces = claim->max_bounces;
    if (lc_is_foreign(session, claim->estimator))
        return lc_judge_foreign(row, session, claim, err);
    lc_estimate *field = malloc(sizeof *field * (size_t)desc->width * (size_t)desc->height);
    if (!field)
        return lc_fail(err, LC_FAULT, "out of memory for the differences of %s", desc->name);
    lc_error why = {""};
    lc_status status = claim->decide   ? judge_by_itself(row, session, claim, lc_session_arm(claim->estimator), &why)
                       : claim->exact  ? judge_exact(row, session, claim, &why)
                       : claim->paired ? lc_judge_paired(row, session, claim, field, &why)
                                       : judge_statistically(row, session, claim, field, &why);
    free(field);
    if (status == LC_WRONG) /* the estimator gave no film: it crashed, or took too long */
        return describe_missing(row, &why);
    return status == LC_OK ? LC_OK : lc_fail(err, status, "%s", why.text);
}
