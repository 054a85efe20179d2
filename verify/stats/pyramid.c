/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The dyadic pyramid; see pyramid.h. Tiles are visited from the image down, since each is guarded by those around it; a tile is summed when it
 * is visited, that is once a level, so that no memory is needed but the stack. */
#include "verify/stats/pyramid.h"

#include <math.h>
#include <string.h>

#include "verify/stats/tails.h"

/* What the visit knows of a level; quantities that a tile is compared with before anything costly is computed. */
typedef struct level_state {
    double log_tests;       /* ln(2 sides x tiles x levels) */
    double weight;          /* lc_skew_weight() of the one-sided FAIL test of a tile */
    double screen;          /* a tile with t <= screen cannot beat the worst one so far */
    int screen_age;         /* the number of worst tiles when `screen` was computed */
    double pass_df, pass_t; /* with df >= pass_df, t >= pass_t passes surely */
    int blocked;            /* a tile was not shown to be within the margin */
    lc_tile blocking;
    lc_student around;      /* the tile of this level in which the visit is */
    double pixels;          /* of it */
} level_state;

typedef struct visit_state {
    const lc_estimate *field;
    int width, height;
    const lc_pyramid_plan *plan;
    lc_pyramid *out;
    double pass_z, pass_weight;
    int worst_count;
    level_state level[LC_LEVELS];
    lc_student even;    /* the image as it would be with all pixels equally bright */
    double even_pixels; /* that have a brightness */
} visit_state;

void lc_pyramid_plan_init(lc_pyramid_plan *plan, double alpha_fail, double alpha_pass)
{
    plan->alpha_fail = alpha_fail;
    plan->alpha_pass = alpha_pass;
    plan->guard = LC_GUARD_POOLED;
    plan->relative = 0;
    for (int l = 0; l < LC_LEVELS; ++l) {
        plan->margin[l] = INFINITY;
        plan->least[l] = LC_LEAST_SAMPLES;
    }
}

int lc_pyramid_levels(int width, int height)
{
    if (width < 1 || height < 1 || width > LC_MAX_SIZE || height > LC_MAX_SIZE)
        return 0;
    int levels = 1;
    while (1 << (levels - 1) < width || 1 << (levels - 1) < height)
        ++levels;
    return levels;
}

static lc_tile no_tile(void)
{
    lc_tile tile;
    memset(&tile, 0, sizeof tile);
    tile.level = -1;
    tile.log_p = NAN;
    return tile;
}

static int is_sound(const lc_estimate *e)
{
    const lc_arm_sums *a = &e->arm[0], *b = &e->arm[1];
    double sum = fabs(e->difference) + fabs(e->expected) + e->tolerance + fabs(a->third) + fabs(b->third) + a->doubt +
                 b->doubt + a->variance + b->variance + a->variance2 + b->variance2;
    return sum < INFINITY && e->tolerance >= 0 && a->variance >= 0 && b->variance >= 0 && a->variance2 >= 0 &&
           b->variance2 >= 0;
}

static lc_status check_plan(const lc_pyramid_plan *plan, int levels, lc_error *err)
{
    if (levels == 0)
        return lc_fail(err, LC_BAD_INPUT, "size of a field, expected 1..%d", (int)LC_MAX_SIZE);
    if (!(plan->alpha_fail > 0 && plan->alpha_fail < 1 && plan->alpha_pass > 0 && plan->alpha_pass < 0.5))
        return lc_fail(err, LC_BAD_INPUT, "error budget %g, %g, expected probabilities above 0 and below 1, 0.5",
                       plan->alpha_fail, plan->alpha_pass);
    if (!(plan->relative >= 0 && plan->relative < INFINITY))
        return lc_fail(err, LC_BAD_INPUT, "relative margin %g, expected a number >= 0", plan->relative);
    for (int l = 0; l < levels; ++l)
        if (!(plan->margin[l] > 0))
            return lc_fail(err, LC_BAD_INPUT, "margin %g of level %d, expected a number above 0", plan->margin[l], l);
    return LC_OK;
}

/* A z such that P(Z >= z) >= exp(log_p): from ln P >= -z^2 / 2 - ln(sqrt(2 pi) (z + 1 / z)) where the quantile
 * underflows. */
static double z_below(double log_p)
{
    if (log_p >= log(0.5))
        return 0;
    if (log_p > -600)
        return lc_normal_quantile(exp(log_p)) * (1 - 1e-9);
    double top = sqrt(-2 * log_p);
    return sqrt(-2 * log_p - 2 * log(2.5066282746310002 * (top + 1 / top)));
}

/* Samples, expected to make up a tile's skewness, from which on its own estimate of it is to be trusted, also when the tile FAILs. Given that
 * its mean is z standard errors too low, K such samples, which make up a share s of the variance, have met K exp(-u), u = z
 * sqrt(s / K) (exponential tilting), and its skewness reads exp(-u) / (1 - s + s exp(-u))^1.5 of what it is: at K = 100 and z = 7
 * at least 0.79 whatever s, which makes p wrong by less than a fifth. */
static const double ENOUGH_EVENTS = 100;

/* To that of an average one of so many `parts`, where a part could have missed what makes it up, or `always`. */
static void raise_skew(lc_student *student, const lc_student *around, double parts, int always)
{
    for (int side = 0; side < 2 && around->testable; ++side)
        if (always || around->events[side] < ENOUGH_EVENTS * parts)
            student->skew[side] = fmax(student->skew[side], around->skew[side] * sqrt(parts));
}

/* Raises a tile's skewness to that of an average tile of its size in the tiles around it, and in the image. Its moments as they are forget
 * dim parts, those of the even image forget parts that vary little. */
static void guard(const visit_state *state, int l, double pixels, lc_student *student)
{
    int top = state->out->levels - 1;
    if (state->plan->guard != LC_GUARD_POOLED || l == top)
        return;
    for (int a = l + 1; a <= top; ++a)
        raise_skew(student, &state->level[a].around, state->level[a].pixels / pixels, a == top);
    raise_skew(student, &state->even, fmax(1, state->even_pixels / pixels), 0);
}

/* A pixel in units of what is expected there. */
static lc_estimate even_out(const lc_estimate *e)
{
    lc_estimate out = *e;
    double scale = e->pixels / e->expected, square = scale * scale, cube = square * scale;
    out.difference *= scale;
    out.expected *= scale;
    out.tolerance *= scale;
    for (int i = 0; i < 2; ++i) {
        lc_arm_sums *arm = &out.arm[i];
        arm->variance *= square;
        arm->variance2 *= square * square;
        arm->third *= cube;
        arm->doubt *= cube;
        for (int bright = 0; bright < 2; ++bright) {
            arm->cubes[bright] *= cube;
            arm->sixths[bright] *= cube * cube;
        }
    }
    return out;
}

static void even_image(visit_state *state)
{
    lc_estimate sum = lc_estimate_zero();
    for (size_t i = 0; i < (size_t)state->width * (size_t)state->height; ++i)
        if (state->field[i].pixels == 1 && state->field[i].expected > 0) {
            lc_estimate e = even_out(&state->field[i]);
            if (is_sound(&e)) /* nearly black pixels may be beyond all numbers */
                lc_estimate_add(&sum, &e);
        }
    state->even = lc_estimate_student(&sum);
    state->even_pixels = sum.pixels;
}

static int side_of(const lc_student *s) { return s->difference < 0 ? LC_LOW : LC_HIGH; }

static double tile_log_p(const visit_state *state, const lc_tile *tile)
{
    const lc_student *s = &tile->student;
    int side = side_of(s);
    double bound = side == LC_LOW ? -s->tolerance : s->tolerance, alpha = 0.5 * state->out->level[tile->level].alpha;
    double log_p = lc_student_log_p(s, side, bound, alpha) + state->level[tile->level].log_tests;
    return log_p > 0 ? 0 : log_p;
}

/* Keeps the tile if its corrected p is the smallest so far; most tiles are turned away before p is computed. */
static void challenge_worst(visit_state *state, const lc_tile *tile)
{
    level_state *level = &state->level[tile->level];
    lc_tile *worst = &state->out->worst;
    const lc_student *s = &tile->student;
    double t = (fabs(s->difference) - s->tolerance) / s->error;
    if (worst->level >= 0) {
        if (level->screen_age != state->worst_count) {
            level->screen = z_below(worst->log_p - level->log_tests);
            level->screen_age = state->worst_count;
        }
        if (t <= level->screen)
            return;
        const lc_student *w = &worst->student;
        double worst_t = (fabs(w->difference) - w->tolerance) / w->error;
        if (worst->level == tile->level && t <= worst_t && s->df <= w->df && s->skew[side_of(s)] >= w->skew[side_of(w)])
            return;
    }
    double log_p = tile_log_p(state, tile);
    if (worst->level < 0 || log_p < worst->log_p) {
        *worst = *tile;
        worst->log_p = log_p;
        ++state->worst_count;
    }
}

/* The same difference with the noise of a margin that was itself measured in arm b. */
static lc_student with_noisy_margin(const lc_student *s, const lc_estimate *sum, double relative)
{
    lc_student wide = *s;
    double a = sum->arm[0].variance, b = sum->arm[1].variance, factor = 1 + relative;
    double stretch = sqrt((a + factor * factor * b) / (a + b)), skew = pow(factor / stretch, 3);
    wide.error *= stretch;
    wide.skew[LC_LOW] *= skew;
    wide.skew[LC_HIGH] *= skew;
    return wide;
}

static int is_within(visit_state *state, int level, const lc_student *s)
{
    level_state *known = &state->level[level];
    double alpha = state->plan->alpha_pass, margin = state->plan->margin[level];
    double t = (margin - fabs(s->difference)) / s->error;
    if (!(t > state->pass_z) || !(fmax(s->skew[LC_LOW], s->skew[LC_HIGH]) * state->pass_weight <= LC_SKEW_LIMIT))
        return 0;
    if (s->df >= known->pass_df && t >= known->pass_t)
        return 1;
    if (s->df < known->pass_df) { /* few times a level: the smallest df of a random sequence changes ln(n) times */
        known->pass_df = s->df;
        known->pass_t = lc_t_quantile(alpha / (2.01 * LC_RESERVE), s->df);
    }
    return lc_student_log_p(s, LC_LOW, margin, alpha) <= log(alpha) &&
           lc_student_log_p(s, LC_HIGH, -margin, alpha) <= log(alpha);
}

static void judge_tile(visit_state *state, int l, int x, int y, const lc_estimate *sum)
{
    level_state *known = &state->level[l];
    lc_level *level = &state->out->level[l];
    int size = 1 << l, right = x + size < state->width ? x + size : state->width;
    int bottom = y + size < state->height ? y + size : state->height;
    lc_tile tile = {l, x, y, right - x, bottom - y, lc_estimate_student(sum), NAN};
    known->around = tile.student;
    known->pixels = sum->pixels;
    guard(state, l, sum->pixels, &tile.student);
    const lc_student *s = &tile.student;
    double least = (double)state->plan->least[l];
    int usable = 0;
    if (sum->arm[0].least < least || sum->arm[1].least < least || sum->arm[0].least < 2 || sum->arm[1].least < 2) {
        ++level->few;
    } else if (!s->testable) {
        ++level->still;
    } else {
        usable = 1;
        if (s->skew[side_of(s)] * known->weight <= LC_SKEW_LIMIT) {
            ++level->tested;
            challenge_worst(state, &tile);
        } else {
            ++level->skewed;
        }
    }
    lc_student margin_aware = state->plan->relative > 0 ? with_noisy_margin(s, sum, state->plan->relative) : *s;
    if (!known->blocked && state->plan->margin[l] < INFINITY && !(usable && is_within(state, l, &margin_aware))) {
        known->blocked = 1;
        known->blocking = tile;
    }
    if (l == state->out->levels - 1) {
        if (usable)
            tile.log_p = tile_log_p(state, &tile);
        state->out->whole = tile;
    }
}

/* Child i of 0..3 of a tile on level l >= 1; 0 where it lies beyond the image. */
static int child_of(const visit_state *state, int l, int x, int y, int i, int *cx, int *cy)
{
    int half = 1 << (l - 1);
    *cx = x + (i & 1) * half;
    *cy = y + (i >> 1) * half;
    return *cx < state->width && *cy < state->height;
}

static void sum_tile(const visit_state *state, int l, int x, int y, lc_estimate *sum)
{
    if (l == 0) {
        *sum = state->field[(size_t)y * (size_t)state->width + (size_t)x];
        return;
    }
    sum_tile(state, l - 1, x, y, sum);
    for (int i = 1, cx, cy; i < 4; ++i) {
        lc_estimate part;
        if (!child_of(state, l, x, y, i, &cx, &cy))
            continue;
        sum_tile(state, l - 1, cx, cy, &part);
        lc_estimate_add(sum, &part);
    }
}

static void visit(visit_state *state, int l, int x, int y)
{
    lc_estimate sum;
    sum_tile(state, l, x, y, &sum);
    judge_tile(state, l, x, y, &sum);
    for (int i = 0, cx, cy; l > 0 && i < 4; ++i)
        if (child_of(state, l, x, y, i, &cx, &cy))
            visit(state, l - 1, cx, cy);
}

/* Shares the budget out. */
static void prepare(visit_state *state)
{
    lc_pyramid *out = state->out;
    for (int l = 0; l < out->levels; ++l) {
        level_state *known = &state->level[l];
        int size = 1 << l;
        double tiles = (double)((state->width - 1) / size + 1) * ((state->height - 1) / size + 1);
        out->level[l].tiles = (uint32_t)tiles;
        out->level[l].alpha = state->plan->alpha_fail / out->levels / tiles;
        known->weight = lc_skew_weight(0.5 * out->level[l].alpha);
        known->log_tests = log(2 * tiles * out->levels);
        known->screen_age = -1;
        known->pass_df = known->pass_t = INFINITY;
    }
    state->pass_z = lc_normal_quantile(state->plan->alpha_pass);
    state->pass_weight = lc_skew_weight(state->plan->alpha_pass);
}

static void conclude(visit_state *state)
{
    lc_pyramid *out = state->out;
    int declared = 0, within = 0;
    for (int l = 0; l < out->levels; ++l) {
        if (!(state->plan->margin[l] < INFINITY))
            continue;
        ++declared;
        out->level[l].within = !state->level[l].blocked;
        within += out->level[l].within;
        if (state->level[l].blocked)
            out->blocking = state->level[l].blocking;
    }
    if (out->worst.level >= 0 && out->worst.log_p <= log(state->plan->alpha_fail))
        out->verdict = LC_FAIL;
    else if (declared > 0 && within == declared)
        out->verdict = LC_PASS;
}

lc_status lc_pyramid_judge(lc_pyramid *out, const lc_estimate *field, int width, int height,
                           const lc_pyramid_plan *plan, lc_error *err)
{
    memset(out, 0, sizeof *out);
    out->verdict = LC_GO_ON;
    out->whole = out->worst = out->blocking = no_tile();
    out->levels = lc_pyramid_levels(width, height);
    lc_status status = check_plan(plan, out->levels, err);
    if (status)
        return status;

    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const lc_estimate *e = &field[(size_t)y * (size_t)width + (size_t)x];
            if (!is_sound(e))
                return lc_fail(err, LC_BAD_INPUT,
                               "pixel (%d, %d): difference %g, variances %g and %g, expected finite numbers", x, y,
                               e->difference, e->arm[0].variance, e->arm[1].variance);
        }
    visit_state state;
    memset(&state, 0, sizeof state);
    state.field = field;
    state.width = width;
    state.height = height;
    state.plan = plan;
    state.out = out;
    prepare(&state);
    even_image(&state);
    visit(&state, out->levels - 1, 0, 0);
    conclude(&state);
    return LC_OK;
}
