/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * What can be said of a bug without its name: only what intervals at six sigma show.
 */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "verify/diagnose/diagnose.h"

static void say(lc_diagnosis *d, const char *format, ...)
{
    va_list arguments;
    if (d->line_count == LC_MOST_LINES)
        return;
    va_start(arguments, format);
    vsnprintf(d->lines[d->line_count++], sizeof d->lines[0], format, arguments);
    va_end(arguments);
}

static const struct {
    double value;
    const char *name;
} constants[] = {{LC_PI, "pi"},      {LC_INV_PI, "1 / pi"},     {2, "2"},        {0.5, "1 / 2"},
                 {4, "4"},           {0.25, "1 / 4"},           {2 * LC_PI, "2 pi"}, {0.5 * LC_INV_PI, "1 / (2 pi)"},
                 {4.0 / 3, "4 / 3"}, {LC_PI / 2, "pi / 2"},     {3, "3"},        {1.0 / 3, "1 / 3"}};

/* The only constant in the interval, or NULL. */
static const char *constant_in(double low, double high)
{
    const char *found = NULL;
    for (size_t i = 0; i < sizeof constants / sizeof constants[0]; ++i)
        if (low <= constants[i].value && constants[i].value <= high) {
            if (found)
                return NULL;
            found = constants[i].name;
        }
    return found;
}

/* One factor everywhere, where light is scattered once: the intervals of all scenes and channels have a value in common. */
static void say_factor(lc_diagnosis *d)
{
    double low = 0, high = INFINITY;
    int different = 0, used = 0;
    for (int i = 0; i < d->view_count; ++i) {
        const lc_view_result *v = &d->views[i];
        if (v->min_bounces != 1 || v->max_bounces != 1 || v->truth_is_black)
            continue;
        ++used;
        different += v->sight == LC_SIGHT_DIFFERENT;
        for (int c = 0; c < 3; ++c) {
            low = fmax(low, v->low[c]);
            high = fmin(high, v->high[c]);
        }
    }
    if (used < 2 || different < used || low > high || !(high - low < 0.05 * low) || (low <= 1 && high >= 1))
        return;
    const char *name = constant_in(low, high);
    say(d, "after one bounce all scenes are wrong by one factor in the mean, in [%.4f, %.4f]%s%s", low, high,
        name ? ": " : "", name ? name : "");
}

static void say_channels(lc_diagnosis *d)
{
    for (int i = 0; i < d->view_count; ++i) {
        const lc_view_result *v = &d->views[i];
        if (v->sight != LC_SIGHT_DIFFERENT || v->truth_is_black)
            continue;
        double low = fmax(v->low[0], fmax(v->low[1], v->low[2])), high = fmin(v->high[0], fmin(v->high[1], v->high[2]));
        if (low <= high)
            continue;
        say(d, "the channels are wrong by different factors: R [%.3f, %.3f], G [%.3f, %.3f], B [%.3f, %.3f] on %s",
            v->low[0], v->high[0], v->low[1], v->high[1], v->low[2], v->high[2], v->scene);
        return;
    }
}

/* A term that is wrong on a scene where the one before it is right. */
static void say_first_bounce(lc_diagnosis *d)
{
    for (int i = 1; i < d->view_count; ++i) {
        const lc_view_result *a = &d->views[i - 1], *b = &d->views[i];
        if (a->sight != LC_SIGHT_EQUAL || b->sight != LC_SIGHT_DIFFERENT || b->min_bounces != b->max_bounces ||
            a->min_bounces != b->min_bounces - 1 || a->max_bounces != a->min_bounces)
            continue;
        int same = 1;
        for (int c = 0; a->scene[c] || b->scene[c]; ++c)
            if (a->scene[c] != b->scene[c]) {
                same = 0;
                break;
            }
        if (same) {
            say(d, "light of %d bounces is the first that is wrong, on %s", b->min_bounces, b->scene);
            return;
        }
    }
}

static void say_lights(lc_diagnosis *d)
{
    int one_equal = 0, one_other = 0, many_different = 0, many_other = 0;
    for (int i = 0; i < d->view_count; ++i) {
        const lc_view_result *v = &d->views[i];
        if (v->max_bounces != 1 || v->min_bounces != 1 || v->truth_is_black || v->lights == 0)
            continue;
        int *count = v->lights == 1 ? (v->sight == LC_SIGHT_EQUAL ? &one_equal : &one_other)
                                    : (v->sight == LC_SIGHT_DIFFERENT ? &many_different : &many_other);
        ++*count;
    }
    if (one_equal && !one_other && many_different > 1 && !many_other)
        say(d, "it is right with one light and wrong with several");
}

static void say_local(lc_diagnosis *d)
{
    for (int i = 0; i < d->view_count; ++i) {
        const lc_view_result *v = &d->views[i];
        int whole = 0;
        for (int c = 0; c < 3; ++c)
            whole |= !(v->low[c] <= 1 && 1 <= v->high[c]);
        if (v->sight != LC_SIGHT_DIFFERENT || whole || v->tile_width == 0)
            continue;
        say(d, "on %s the mean of the image is right, a part is not: %d pixels wide at %d,%d", v->scene, v->tile_width,
            v->tile_x, v->tile_y);
        return;
    }
}

static void say_black(lc_diagnosis *d)
{
    for (int i = 0; i < d->view_count; ++i) {
        const lc_view_result *v = &d->views[i];
        if (v->sight != LC_SIGHT_DIFFERENT || v->is_black == v->truth_is_black)
            continue;
        if (v->max_bounces == 0)
            say(d, "emission that the camera sees is missing on %s", v->scene);
        else
            say(d, v->is_black ? "%s is black, which it should not be" : "%s is not black, as it should be", v->scene);
    }
}

void lc_diagnose_fingerprint(lc_diagnosis *d)
{
    if (d->has_bad)
        say(d, "some samples are NaN, infinite or negative");
    if (d->repeats)
        say(d, "its samples depend on each other: the noise is wrong");
    if (!d->is_wrong || d->has_bad)
        return;
    say_factor(d);
    say_channels(d);
    say_first_bounce(d);
    say_lights(d);
    say_black(d);
    say_local(d);
    for (int i = 0; i < d->view_count && !d->line_count; ++i) {
        const lc_view_result *v = &d->views[i];
        if (v->sight == LC_SIGHT_DIFFERENT && !v->truth_is_black)
            say(d, "on %s green light is [%.4f, %.4f] of what it should be, and not the same elsewhere", v->scene, v->low[1],
                v->high[1]);
    }
}
