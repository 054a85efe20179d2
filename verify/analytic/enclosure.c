/* SPDX-License-Identifier: GPL-3.0-or-later */
/* enclosure.c: closed scenes, where a geometric series is the whole story; see analytic.h for formulas and sources. */
#include "verify/analytic/analytic.h"

#include "verify/analytic/body.h"

/* sum of r^j for 0 <= j < count; all: 1 / (1 - r). */
static double geometric(double r, int count)
{
    if (count < 0)
        return 1 / (1 - r);
    if (r == 1)
        return count;
    /* r^count through log1p: near r = 1 the plain difference would cancel */
    return r > 0.5 ? -expm1(count * log1p(r - 1)) / (1 - r) : (1 - pow(r, count)) / (1 - r);
}

double lc_inside_sphere_irradiance(double mean_le, double mean_rho, int reflections)
{
    return LC_PI * mean_le * geometric(mean_rho, reflections);
}

double lc_furnace_radiance(double le, double rho, int reflections)
{
    return le * geometric(rho, reflections < 0 ? reflections : reflections + 1);
}

void lc_thermal_bounds(double *low, double *high, double l0, double rho_max, int reflections)
{
    *high = l0;
    *low = reflections < 0 ? l0 : l0 * (1 - pow(rho_max, reflections + 1));
}

double lc_parallel_plates_radiance(double le1, double rho1, double le2, double rho2, int reflections)
{
    if (reflections < 0)
        return (le1 + rho1 * le2) / (1 - rho1 * rho2);
    /* even terms come from plate 1 itself, odd ones from the other */
    double both = rho1 * rho2;
    return le1 * geometric(both, reflections / 2 + 1) + rho1 * le2 * geometric(both, (reflections + 1) / 2);
}

double lc_mirror_corridor_radiance(double le, double r1, double r2, int reflections)
{
    return le * pow(r1, (reflections + 1) / 2) * pow(r2, reflections / 2);
}

double lc_closed_mean_irradiance(double flux, double area, double rho, int reflections)
{
    return flux / area * geometric(rho, reflections);
}

/* ---- checkerboards ------------------------------------------------------------------------------------------ */

/* With w = 2 (scale t + offset), cells end where w is an integer, and the upper half is where floor(w) is odd. */
static void checker_range(double scale, double offset, double *low, double *high)
{
    *low = 2 * (offset + fmin(scale, 0));
    *high = 2 * (offset + fmax(scale, 0));
}

double lc_checker_cells(double scale, double offset)
{
    double low, high;
    checker_range(scale, offset, &low, &high);
    return fmax(0, ceil(high) - floor(low) - 1) + 1;
}

int lc_checker_cell(double scale, double offset, double index, double *from, double *to)
{
    double low, high;
    checker_range(scale, offset, &low, &high);
    double a = fmax(low, floor(low) + index), b = fmin(high, floor(low) + index + 1);
    double t0 = 0, t1 = 1;
    if (scale != 0) {
        /* the ends themselves stay exact */
        double at_a = a > low ? (a / 2 - offset) / scale : scale > 0 ? 0 : 1;
        double at_b = b < high ? (b / 2 - offset) / scale : scale > 0 ? 1 : 0;
        t0 = fmin(at_a, at_b), t1 = fmax(at_a, at_b);
    }
    *from = t0, *to = t1;
    double middle = floor((a + b) / 2);
    /* a constant that sits on a boundary belongs to the lower half, as at w = 1: "at or below 1/2" */
    if (a == b && middle == a && fmod(middle, 2) != 0)
        return 0;
    return fmod(middle, 2) != 0;
}

/* Share of [0, 1] in the upper halves; on a sphere's v, weighted by sin(pi v). */
static double upper_share(double scale, double offset, int is_polar)
{
    double sum = 0, cells = fmin(lc_checker_cells(scale, offset), 2e6);
    for (double i = 0; i < cells; ++i) {
        double from, to;
        if (!lc_checker_cell(scale, offset, i, &from, &to))
            continue;
        /* (cos a - cos b) / 2 = sin((a + b) / 2) sin((b - a) / 2) */
        sum += is_polar ? sin(LC_PI * (from + to) / 2) * sin(LC_PI * (to - from) / 2) : to - from;
    }
    return sum;
}

lc_rgb lc_texture_sphere_mean(const lc_texture *texture)
{
    if (!texture->is_checkerboard)
        return texture->color[0];
    double u = upper_share(texture->scale[0], texture->offset[0], 0);
    double v = upper_share(texture->scale[1], texture->offset[1], 1);
    double first = u * v + (1 - u) * (1 - v);
    return lc_rgb_add(lc_rgb_scale(first, texture->color[0]), lc_rgb_scale(1 - first, texture->color[1]));
}
