/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * What can be said of a bug without its name: only what intervals at six sigma show.
 */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

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

/* The views of the plain scenes, of one bounce, that have light. */
static int is_plain(const lc_view_result *v)
{
    return v->min_bounces == 1 && v->max_bounces == 1 && !v->truth_is_black && !v->size && !v->light;
}

/* One factor everywhere, where light is scattered once: the intervals of all scenes and channels have a value in common. */
static void say_factor(lc_diagnosis *d)
{
    double low = 0, high = INFINITY;
    int different = 0, used = 0;
    for (int i = 0; i < d->view_count; ++i) {
        const lc_view_result *v = &d->views[i];
        if (!is_plain(v))
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

/* The factor is the number of lights, or one over it, and the numbers differ. */
static void say_count(lc_diagnosis *d)
{
    int least = 1 << 20, most = 0;
    int fits[2] = {1, 1};
    for (int i = 0; i < d->view_count; ++i) {
        const lc_view_result *v = &d->views[i];
        if (!is_plain(v) || v->lights == 0)
            continue;
        double factor[2] = {v->lights, 1.0 / v->lights};
        for (int c = 0; c < 3; ++c)
            for (int k = 0; k < 2 && !isnan(v->low[c]); ++k)
                fits[k] &= v->low[c] <= factor[k] && factor[k] <= v->high[c];
        least = v->lights < least ? v->lights : least;
        most = v->lights > most ? v->lights : most;
    }
    if (most > least && (fits[0] || fits[1]))
        say(d, "estimate / truth is %s, N the number of lights (%d to %d)", fits[0] ? "N" : "1 / N", least, most);
}

/* The factor of each channel is a power of the albedo: one power for all, and albedos that differ. */
static void say_albedo(lc_diagnosis *d)
{
    double low = -INFINITY, high = INFINITY, least = 1, most = 0;
    for (int i = 0; i < d->view_count; ++i) {
        const lc_view_result *v = &d->views[i];
        for (int c = 0; c < 3 && is_plain(v); ++c) {
            double rho = v->albedo[c];
            if (!(rho > 0.01 && rho < 0.95 && v->low[c] > 0))
                continue;
            low = fmax(low, log(v->high[c]) / log(rho));
            high = fmin(high, log(v->low[c]) / log(rho));
            least = fmin(least, rho);
            most = fmax(most, rho);
        }
    }
    if (least < 0.7 * most && low <= high && (low > 0.1 || high < -0.1) && high - low < 0.3)
        say(d, "after one bounce estimate / truth is a power of the albedo: albedo^[%.2f, %.2f]", low, high);
}

/* Powers of cosines. */
static void say_angles(lc_diagnosis *d)
{
    static const char *const names[LC_ANGLE_POWERS] = {"cosine at the surface", "cosine at the lamp", "distance",
                                                       "cosine with the viewer"};
    for (int i = 0; i < d->view_count; ++i) {
        const lc_view_result *v = &d->views[i];
        char text[160] = "";
        size_t length = 0;
        for (int k = 0; k < LC_ANGLE_POWERS && v->angles.is_good; ++k) {
            double error = 6 * v->angles.error[k] + 0.02;
            if (fabs(v->angles.power[k]) > error + 0.1)
                length += (size_t)snprintf(text + length, sizeof text - length, "%s(%s)^[%.2f, %.2f]", length ? " " : "", names[k],
                                           v->angles.power[k] - error, v->angles.power[k] + error);
        }
        if (length)
            say(d, "on %s estimate / truth goes as %s", v->scene, text);
    }
}

/* The same scene in another size, or another brightness, is wrong in another way. */
static void say_scale(lc_diagnosis *d)
{
    for (int i = 0; i < d->view_count; ++i) {
        const lc_view_result *a = &d->views[i];
        for (int j = 0; j < d->view_count; ++j) {
            const lc_view_result *b = &d->views[j];
            if (a->size || a->light || (!b->size && !b->light) || strcmp(a->scene, b->scene) != 0 ||
                a->min_bounces != b->min_bounces || a->max_bounces != b->max_bounces)
                continue;
            for (int c = 0; c < 3; ++c)
                if (b->low[c] > a->high[c] || b->high[c] < a->low[c]) {
                    say(d, "%s 2^%d times as %s is wrong in another way: [%.4g, %.4g] instead of [%.4g, %.4g]", b->scene,
                        b->size ? b->size : b->light, b->size ? "large" : "bright", b->low[c], b->high[c], a->low[c], a->high[c]);
                    break;
                }
        }
    }
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
        if (strcmp(a->scene, b->scene) == 0 && !b->size && !b->light) {
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
        if (!is_plain(v) || v->lights == 0)
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
        say(d, "some samples are NaN, infinite, negative or above 1e60");
    if (d->repeats)
        say(d, "its samples depend on each other: the noise is wrong");
    if (!d->is_wrong || d->has_bad)
        return;
    say_factor(d);
    say_count(d);
    say_albedo(d);
    say_angles(d);
    say_scale(d);
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
