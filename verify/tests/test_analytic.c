/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Closed forms against quadratures that share nothing with them, limits, and values known from elsewhere. */
#include "verify/tests/tests.h"

#include <string.h>

#include <gsl/gsl_integration.h>

#include "verify/analytic/analytic.h"
#include "verify/analytic/body.h"
#include "verify/tests/analytic_help.h"

/* F of the parallelogram o + s a + t b, s and t in [0, 1], emitting along a x b: product Gauss rule over its area. */
static double area_quadrature(lc_vec3 o, lc_vec3 a, lc_vec3 b, lc_vec3 p, lc_vec3 n)
{
    enum { ORDER = 64 }; /* one that GSL has tabulated; it computes others to 1e-11 only */
    gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(ORDER);
    lc_vec3 area = lc_cross(a, b);
    double sum = 0;
    for (size_t i = 0; i < ORDER; ++i)
        for (size_t j = 0; j < ORDER; ++j) {
            double s, t, ws, wt;
            gsl_integration_glfixed_point(0, 1, i, &s, &ws, table);
            gsl_integration_glfixed_point(0, 1, j, &t, &wt, table);
            lc_vec3 x = lc_sub(lc_add(o, lc_add(lc_scale(s, a), lc_scale(t, b))), p);
            double d2 = lc_dot(x, x);
            sum += ws * wt * fmax(0, lc_dot(x, n)) * fmax(0, -lc_dot(x, area)) / (LC_PI * d2 * d2);
        }
    gsl_integration_glfixed_table_free(table);
    return sum;
}

static double parallelogram(lc_vec3 o, lc_vec3 a, lc_vec3 b, lc_vec3 p, lc_vec3 n)
{
    const lc_vec3 corner[4] = {o, lc_add(o, a), lc_add(o, lc_add(a, b)), lc_add(o, b)};
    return lc_polygon_factor(corner, 4, p, n);
}

/* ---- single emitters ------------------------------------------------------------------------------------ */

START_TEST(polygon_matches_area_quadrature)
{
    unsigned state = 1;
    int seen = 0;
    for (int i = 0; i < 60; ++i) {
        lc_vec3 n = direction(&state), a = direction(&state), b = direction(&state), p = direction(&state);
        /* wholly above the horizon, where the quadrature is smooth */
        lc_vec3 o = lc_add(p, lc_add(lc_scale(3, n), direction(&state)));
        double expected = area_quadrature(o, a, b, p, n), found = parallelogram(o, a, b, p, n);
        if (lc_dot(lc_sub(o, p), lc_cross(a, b)) >= 0) {
            ck_assert(found == 0);
            ck_assert(expected == 0);
        } else {
            ASSERT_CLOSE(found, expected, 1e-10);
            ++seen;
        }
    }
    ck_assert_int_gt(seen, 15);
}
END_TEST

START_TEST(polygon_is_clipped_to_the_horizon)
{
    /* a vertical wall, half of it below: the same as its upper half, which the quadrature can do */
    lc_vec3 p = {0, 0, 0}, n = {0, 0, 1};
    double whole = parallelogram(lc_vec(1, -2, -3), lc_vec(0, 0, 5), lc_vec(0, 3, 0), p, n);
    double half = parallelogram(lc_vec(1, -2, 0), lc_vec(0, 0, 2), lc_vec(0, 3, 0), p, n);
    ASSERT_CLOSE(whole, half, 1e-13);
    ASSERT_CLOSE(half, area_quadrature(lc_vec(1, -2, 0), lc_vec(0, 0, 2), lc_vec(0, 3, 0), p, n), 1e-9);
    ck_assert(parallelogram(lc_vec(1, -2, -3), lc_vec(0, 0, 2.9), lc_vec(0, 3, 0), p, n) == 0);
    /* from behind; from its own plane; a count out of range */
    ck_assert(parallelogram(lc_vec(1, -2, 0), lc_vec(0, 3, 0), lc_vec(0, 0, 2), p, n) == 0);
    ck_assert(parallelogram(lc_vec(0, -1, 1e-17), lc_vec(0, 3, 0), lc_vec(4, 0, 0), p, n) == 0);
    ck_assert(isnan(lc_polygon_factor(&p, 2, p, n)));
}
END_TEST

START_TEST(polygon_far_away_is_a_point)
{
    /* E -> L A cos cos' / d^2, over fourteen decades and across the change of rule at size/d = 5e-3 */
    lc_vec3 n = {0, 0, 1}, a = {1, 0, 0}, b = {0, -1, 0}, p = {0, 0, 0};
    for (double d = 1e3; d < 1e8; d *= 7) {
        lc_vec3 o = lc_vec(0.6 * d - 0.5, 0.5, 0.8 * d);
        double point = 0.8 * 0.8 / (LC_PI * d * d);
        ASSERT_CLOSE(parallelogram(o, a, b, p, n), point, 2 / (d * d) + 1e-12);
    }
    for (double d = 100; d < 600; d *= 1.1) {
        lc_vec3 o = lc_vec(0.3 * d, 0.1 * d, 0.8 * d);
        ASSERT_CLOSE(parallelogram(o, a, b, p, n), area_quadrature(o, a, b, p, n), 1e-12);
    }
}
END_TEST

START_TEST(polygon_close_up_fills_the_hemisphere)
{
    lc_vec3 p = {0, 0, 0}, n = {0, 0, 1};
    ASSERT_CLOSE(parallelogram(lc_vec(-1e6, 1e6, 1), lc_vec(2e6, 0, 0), lc_vec(0, -2e6, 0), p, n), 1, 1e-11);
    ASSERT_CLOSE(parallelogram(lc_vec(-1, 1, 1e-7), lc_vec(2, 0, 0), lc_vec(0, -2, 0), p, n), 1, 1e-9);
}
END_TEST

START_TEST(rectangle_is_a_polygon)
{
    lc_vec3 p = {0, 0, 0}, n = {0, 0, 1};
    for (double a = 0.01; a < 200; a *= 3)
        for (double b = 0.01; b < 200; b *= 3) {
            double expected = parallelogram(lc_vec(0, 0, 0.7), lc_vec(0, b, 0), lc_vec(a, 0, 0), p, n);
            ASSERT_CLOSE(lc_rectangle_factor(a, b, 0.7), expected, 1e-11);
        }
    /* X = Y = 1: atan(1/sqrt 2) / (sqrt 2 pi) */
    ASSERT_CLOSE(lc_rectangle_factor(2, 2, 2), 0.61547970867038734 / (sqrt(2) * LC_PI), 1e-15);
    ASSERT_CLOSE(lc_rectangle_factor(INFINITY, INFINITY, 3), 0.25, 1e-15);
    ASSERT_CLOSE(lc_rectangle_factor(INFINITY, 3, 3), 0.25 / sqrt(2), 1e-15);
    ck_assert(lc_rectangle_factor(0, 1, 1) == 0);
    ck_assert(lc_rectangle_factor(1, 1, 0) == 0);
    ck_assert(lc_rectangle_factor(1, 1, -1) == 0);
}
END_TEST

struct disk {
    double radius, offset, h;
};

/* Rings about the foot of the receiver: the angle of a ring inside the disk times the kernel h^2 r / d^4 / pi. */
static double ring_of_disk(double r, void *user)
{
    const struct disk *d = user;
    double cos_half = r * d->offset > 0 ? (r * r + d->offset * d->offset - d->radius * d->radius) / (2 * r * d->offset)
                                        : (r < d->radius ? -1 : 1);
    double d2 = r * r + d->h * d->h;
    return 2 * acos(fmax(-1, fmin(1, cos_half))) * d->h * d->h * r / (LC_PI * d2 * d2);
}

START_TEST(disk_matches_ring_quadrature)
{
    const struct disk cases[] = {{1, 0, 1}, {1, 0.5, 1}, {1, 1, 0.3}, {1, 3, 2}, {0.01, 3, 2}, {5, 4, 0.2}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        struct disk d = cases[i];
        double inner = fabs(d.radius - d.offset), a, b;
        ck_assert_int_eq(lc_quadrature(&a, ring_of_disk, &d, 0, inner, 1e-14, 1e-11, NULL), LC_OK);
        ck_assert_int_eq(lc_quadrature(&b, ring_of_disk, &d, inner, d.radius + d.offset, 1e-14, 1e-11, NULL), LC_OK);
        ASSERT_CLOSE(lc_disk_factor(d.radius, d.offset, d.h), a + b, 1e-9);
    }
    ASSERT_CLOSE(lc_disk_factor(3, 0, 4), 9.0 / 25, 1e-15);
    ASSERT_CLOSE(lc_disk_factor(1, 0, 1e9), 1e-18, 1e-12); /* point source: the textbook form gives 0 here */
    ASSERT_CLOSE(lc_disk_factor(1e9, 5, 1), 1, 1e-12);
    ck_assert(lc_disk_factor(1, 0, -1) == 0);
}
END_TEST

START_TEST(ellipse_is_disk_or_many_triangles)
{
    double f;
    lc_vec3 p = {0.2, 0.1, -0.3}, n = {0, 0, 1}, x = {1, 0, 0}, y = {0, 1, 0};
    /* parallel: the closed form, with the foot of p inside and outside */
    for (double c = 0; c < 4; c += 0.37) {
        ck_assert_int_eq(lc_ellipse_factor(&f, lc_vec(0.2 + c, 0.1, 0.9), y, x, p, n, NULL), LC_OK);
        ASSERT_CLOSE(f, lc_disk_factor(1, c, 1.2), 1e-10);
    }
    ck_assert_int_eq(lc_ellipse_factor(&f, lc_vec(0, 0, 0.9), x, y, p, n, NULL), LC_OK); /* from behind */
    ck_assert(f == 0);
    /* any pose, the horizon cutting or not: Lambert's sum over triangles with one corner in the centre; Richardson
     * for the rim */
    unsigned state = 7;
    int cut = 0;
    for (int i = 0; i < 40; ++i) {
        lc_vec3 a = direction(&state), b = lc_scale(0.5, direction(&state)), c = direction(&state);
        c = lc_scale(i % 2 ? 1.8 : 0.4, c); /* near: from behind the zenith to below the horizon */
        n = direction(&state);
        if (lc_dot(c, lc_cross(a, b)) > 0)
            a = lc_neg(a);
        double part[2] = {0, 0};
        for (int k = 0; k < 2; ++k)
            for (int j = 0, m = 4000 << k; j < m; ++j) {
                double t0 = 2 * LC_PI * j / m, t1 = 2 * LC_PI * (j + 1) / m;
                const lc_vec3 triangle[3] = {c, lc_add(c, lc_add(lc_scale(cos(t0), a), lc_scale(sin(t0), b))),
                                             lc_add(c, lc_add(lc_scale(cos(t1), a), lc_scale(sin(t1), b)))};
                part[k] += lc_polygon_factor(triangle, 3, lc_vec(0, 0, 0), n);
            }
        ck_assert_int_eq(lc_ellipse_factor(&f, c, a, b, lc_vec(0, 0, 0), n, NULL), LC_OK);
        ck_assert_double_le(fabs(f - (4 * part[1] - part[0]) / 3), 1e-9);
        cut += fabs(lc_dot(c, n)) < hypot(lc_dot(a, n), lc_dot(b, n));
    }
    ck_assert_int_gt(cut, 5);
}
END_TEST

struct cone {
    double cos_t, sin_t;
};

/* Rings about the axis of a sphere: cos over the part of a ring that stands above the horizon. */
static double ring_of_sphere(double psi, void *user)
{
    const struct cone *c = user;
    double level = cos(psi) * c->cos_t, swing = sin(psi) * c->sin_t;
    double half = level >= swing ? LC_PI : level <= -swing ? 0 : acos(-level / swing);
    return sin(psi) * 2 * (half * level + sin(half) * swing) / LC_PI;
}

START_TEST(sphere_matches_ring_quadrature)
{
    for (double h = 1.001; h < 1e4; h *= 1.9)
        for (int i = 0; i <= 24; ++i) {
            double t = LC_PI * i / 24, d = 0.3 * h, a, b = 0;
            struct cone c = {cos(t), sin(t)};
            double edge = asin(1 / h), horizon = fabs(LC_PI / 2 - t), kink = fmin(edge, horizon);
            ck_assert_int_eq(lc_quadrature(&a, ring_of_sphere, &c, 0, kink, 1e-20, 1e-11, NULL), LC_OK);
            if (kink < edge)
                ck_assert_int_eq(lc_quadrature(&b, ring_of_sphere, &c, kink, edge, 1e-20, 1e-11, NULL), LC_OK);
            lc_vec3 p = {1, 2, 3}, n = {0.6, 0, 0.8}, across = {0, 1, 0};
            lc_vec3 centre = lc_add(p, lc_add(lc_scale(d * c.cos_t, n), lc_scale(d * c.sin_t, across)));
            ck_assert_double_le(fabs(lc_sphere_factor(centre, 0.3, p, n) - (a + b)), 2e-10 / (h * h));
        }
}
END_TEST

START_TEST(sphere_limits)
{
    lc_vec3 p = {0, 0, 0}, n = {0, 0, 1};
    ASSERT_CLOSE(lc_sphere_factor(lc_vec(0, 0, 5), 2, p, n), 4.0 / 25, 1e-15);
    ck_assert(lc_sphere_factor(lc_vec(1, 0, -2), 2, p, n) == 0);          /* touches the horizon from below */
    ck_assert(lc_sphere_factor(lc_vec(0, 0, 1), 2, p, n) == 0);           /* inside */
    ASSERT_CLOSE(lc_sphere_factor(lc_vec(2, 0, 0), 2, p, n), 0.5, 1e-15); /* on it, edge on */
    /* the three cases meet */
    double over = lc_sphere_factor(lc_vec(3, 0, 2 + 1e-9), 2, p, n);
    ASSERT_CLOSE(lc_sphere_factor(lc_vec(3, 0, 2 - 1e-9), 2, p, n), over, 1e-8);
    ck_assert_double_le(lc_sphere_factor(lc_vec(3, 0, -2 + 1e-6), 2, p, n), 1e-9);
    /* half below, far away: the half disk, F = 2/(3 pi) / H^3 */
    ASSERT_CLOSE(lc_sphere_factor(lc_vec(1e6, 0, 0), 1, p, n), 2 / (3 * LC_PI) * 1e-18, 1e-10);
    /* the sphere as the scan's ball, an integral that knows nothing of the formula */
    unsigned state = 3;
    for (int i = 0; i < 40; ++i) {
        lc_vec3 centre = lc_scale(1 + 3 * uniform(&state), direction(&state)), normal = direction(&state);
        lc_receiver receiver = lc_receiver_at(p, normal);
        lc_body ball = lc_body_ball(&receiver, centre, 0.95, 0);
        double f;
        ck_assert_int_eq(lc_scan_factor(&f, &ball, NULL, 0, NULL), LC_OK);
        ck_assert_double_le(fabs(f - lc_sphere_factor(centre, 0.95, p, normal)), 1e-11);
    }
}
END_TEST

START_TEST(points_walls_and_flux)
{
    lc_vec3 p = {0, 0, 0}, n = {0, 0, 1};
    ASSERT_CLOSE(lc_point_irradiance(50, lc_vec(3, 0, 4), p, n), 50 * 0.8 / 25, 1e-15);
    ck_assert(lc_point_irradiance(50, lc_vec(3, 0, -4), p, n) == 0);
    ASSERT_CLOSE(lc_directional_irradiance(2, lc_vec(0.6, 0, -0.8), n), 1.6, 1e-15);
    ck_assert(lc_directional_irradiance(2, lc_vec(0.6, 0, 0.8), n) == 0);
    /* the lecture: albedo 1 that faces the light sends back E0 / pi */
    ASSERT_CLOSE(lc_lambert_reflected(1, lc_directional_irradiance(1, lc_vec(0, 0, -1), n)), 1 / LC_PI, 1e-15);
    ASSERT_CLOSE(lc_lambert_radiance(100, 2), 100 / (2 * LC_PI), 1e-15);
    ASSERT_CLOSE(lc_sky_irradiance(3), 3 * LC_PI, 1e-15);
    /* a wall so long that the ends do not matter: strip at x = 1, 2 high */
    double wall = parallelogram(lc_vec(1, -1e7, 0), lc_vec(0, 0, 2), lc_vec(0, 2e7, 0), p, n);
    ASSERT_CLOSE(lc_wall_factor(atan2(2, 1)), wall, 1e-10);
    ASSERT_CLOSE(lc_wall_factor(LC_PI), 1, 1e-15);
    ASSERT_CLOSE(lc_wall_factor(1e-9), 0.25e-18, 1e-9);
}
END_TEST

struct plate {
    double side, h;
};

static double inner_plate(double y, void *user)
{
    const double *at = user; /* x, side, h */
    double x = at[0], s = at[1], h = at[2];
    return lc_rectangle_factor(x, y, h) + lc_rectangle_factor(s - x, y, h) + lc_rectangle_factor(x, s - y, h) +
           lc_rectangle_factor(s - x, s - y, h);
}

static double outer_plate(double x, void *user)
{
    const struct plate *plate = user;
    double at[3] = {x, plate->side, plate->h}, out = NAN;
    lc_quadrature(&out, inner_plate, at, 0, plate->side, 1e-12, 1e-11, NULL);
    return out;
}

START_TEST(reciprocity)
{
    /* opposite unit squares at distance 1: F12 = .199825, the textbook value (e.g. Incropera and DeWitt) */
    struct plate unit = {1, 1};
    double f;
    ck_assert_int_eq(lc_quadrature(&f, outer_plate, &unit, 0, 1, 1e-11, 1e-10, NULL), LC_OK);
    ASSERT_CLOSE(f, 0.199825, 3e-6);
    /* a small disk and a large sphere above it: the mean over the sphere of F to the disk is F / 4 per area */
    double disk_to_sphere = lc_sphere_factor(lc_vec(0, 0, 5), 2, lc_vec(0, 0, 0), lc_vec(0, 0, 1));
    double back = lc_reciprocal_factor(disk_to_sphere, 1e-6, 16 * LC_PI);
    ASSERT_CLOSE(back, 1e-6 * 0.16 / (16 * LC_PI), 1e-14);
}
END_TEST

/* ---- closed scenes --------------------------------------------------------------------------------------- */

START_TEST(inside_of_a_sphere)
{
    /* by brute force: E_{k+1} = pi <Le> + <rho> E_k */
    double e = 0;
    for (int k = 0; k < 8; ++k) {
        ASSERT_CLOSE(lc_inside_sphere_irradiance(0.7, 0.83, k) + (k == 0), e + (k == 0), 1e-14);
        e = LC_PI * 0.7 + 0.83 * e;
    }
    ASSERT_CLOSE(lc_inside_sphere_irradiance(0.7, 0.83, LC_ALL_REFLECTIONS), LC_PI * 0.7 / 0.17, 1e-14);
    ASSERT_CLOSE(lc_inside_sphere_irradiance(1, 1, 3), 3 * LC_PI, 1e-15);
    ASSERT_CLOSE(lc_inside_sphere_irradiance(1, 0.9, 2000), 10 * LC_PI, 1e-14);
}
END_TEST

/* The rule of lightcheck's textures, written a second time. */
static lc_rgb checker_at(const lc_texture *texture, double u, double v)
{
    double s = texture->scale[0] * u + texture->offset[0], t = texture->scale[1] * v + texture->offset[1];
    int high_s = s - floor(s) > 0.5, high_t = t - floor(t) > 0.5;
    return texture->color[high_s != high_t];
}

START_TEST(checkerboard_over_a_sphere)
{
    const double scales[][4] = {{1, 1, 0, 0},           {2, 4, 0, 0},   {3, 2, 0.1, 0.3},
                                {-1.7, 2.3, 5.2, -3.1}, {0, 1, 0.7, 0}, {8, 5, -0.25, 0.125}};
    for (size_t i = 0; i < sizeof scales / sizeof scales[0]; ++i) {
        const double *s = scales[i];
        lc_texture texture = {1, {{1, 0.5, 0}, {0.25, 2, 1}}, {s[0], s[1]}, {s[2], s[3]}};
        enum { M = 1500 };
        double sum[3] = {0, 0, 0}, weight = 0;
        for (int a = 0; a < M; ++a)
            for (int b = 0; b < M; ++b) {
                /* midpoints, equally spaced in v: dA ~ sin(pi v) */
                double v = (b + 0.5) / M, w = sin(LC_PI * v);
                lc_rgb c = checker_at(&texture, (a + 0.5) / M, v);
                sum[0] += w * c.r, sum[1] += w * c.g, sum[2] += w * c.b, weight += w;
            }
        lc_rgb mean = lc_texture_sphere_mean(&texture);
        ck_assert_double_le(fabs(mean.r - sum[0] / weight), 1e-3);
        ck_assert_double_le(fabs(mean.g - sum[1] / weight), 2e-3);
        ck_assert_double_le(fabs(mean.b - sum[2] / weight), 1e-3);
    }
    /* two cells in v, split at the equator; u constant in the upper half: all is the other colour above */
    lc_texture half = {1, {{1, 1, 1}, {0, 0, 0}}, {0, 1}, {0.25, 0}};
    ASSERT_CLOSE(lc_texture_sphere_mean(&half).r, 0.5, 1e-15);
    /* v in the lower half up to pi/3 only: the cap (1 - cos 60) / 2 */
    lc_texture cap = {1, {{1, 1, 1}, {0, 0, 0}}, {0, 1}, {0.25, 0.5 - 1.0 / 3}};
    /* v + 1/6 <= 1/2: v <= 1/3; and v + 1/6 > 1: v > 5/6, another cap of 30 degrees */
    ASSERT_CLOSE(lc_texture_sphere_mean(&cap).r, 0.25 + (1 - cos(LC_PI / 6)) / 2, 1e-14);
}
END_TEST

START_TEST(furnaces)
{
    ASSERT_CLOSE(lc_furnace_radiance(0.5, 0.5, LC_ALL_REFLECTIONS), 1, 1e-15);
    ASSERT_CLOSE(lc_furnace_radiance(1, 0.5, 6), 1.984375, 1e-15);
    ASSERT_CLOSE(lc_furnace_radiance(2, 0.3, 0), 2, 1e-15);
    ASSERT_CLOSE(lc_furnace_radiance(2, 1, 4), 10, 1e-15);
    ASSERT_CLOSE(lc_furnace_radiance(1, 1 - 1e-12, 9), 10, 1e-11); /* a plain difference loses 4 digits */
    double low, high;
    lc_thermal_bounds(&low, &high, 3, 0.8, 2);
    ASSERT_CLOSE(low, 3 * (1 - 0.512), 1e-15);
    ck_assert(high == 3);
    lc_thermal_bounds(&low, &high, 3, 0.8, LC_ALL_REFLECTIONS);
    ck_assert(low == 3 && high == 3);
}
END_TEST

START_TEST(plates_and_corridor)
{
    /* by brute force: B1' = Le1 + rho1 B2, B2' = Le2 + rho2 B1 */
    double b1 = 2, b2 = 0.5;
    for (int k = 0; k < 9; ++k) {
        ASSERT_CLOSE(lc_parallel_plates_radiance(2, 0.7, 0.5, 0.9, k), b1, 1e-14);
        ASSERT_CLOSE(lc_parallel_plates_radiance(0.5, 0.9, 2, 0.7, k), b2, 1e-14);
        double next = 2 + 0.7 * b2;
        b2 = 0.5 + 0.9 * b1;
        b1 = next;
    }
    ASSERT_CLOSE(lc_parallel_plates_radiance(2, 0.7, 0.5, 0.9, LC_ALL_REFLECTIONS), (2 + 0.35) / 0.37, 1e-14);
    double l = 5;
    for (int k = 0; k < 7; ++k) {
        ASSERT_CLOSE(lc_mirror_corridor_radiance(5, 0.9, 0.6, k), l, 1e-14);
        l *= k % 2 ? 0.6 : 0.9;
    }
}
END_TEST

START_TEST(flux_balance)
{
    /* CIE 171:2006, case 5.8: a 4 m cube and 10 000 lm; published 104.17, 208.33, 520.83 lx */
    ck_assert_double_le(fabs(lc_closed_mean_irradiance(10000, 96, 0, LC_ALL_REFLECTIONS) - 104.17), 0.005);
    ck_assert_double_le(fabs(lc_closed_mean_irradiance(10000, 96, 0.5, LC_ALL_REFLECTIONS) - 208.33), 0.005);
    ck_assert_double_le(fabs(lc_closed_mean_irradiance(10000, 96, 0.8, LC_ALL_REFLECTIONS) - 520.83), 0.005);
    ASSERT_CLOSE(lc_closed_mean_irradiance(96, 96, 0.5, 2), 1.5, 1e-15);
    /* a sphere is a closed scene */
    double sphere = lc_inside_sphere_irradiance(0.4, 0.6, 5);
    ASSERT_CLOSE(lc_closed_mean_irradiance(LC_PI * 0.4 * 12, 12, 0.6, 5), sphere, 1e-14);
}
END_TEST

/* ---- dielectrics ------------------------------------------------------------------------------------------ */

START_TEST(fresnel)
{
    ASSERT_CLOSE(lc_fresnel_dielectric(1, 1.5), 0.04, 1e-14);
    ASSERT_CLOSE(lc_fresnel_dielectric(1, 1 / 1.5), 0.04, 1e-14);
    ck_assert_double_le(lc_fresnel_dielectric(0.3, 1), 1e-30); /* glass of n = 1 */
    ASSERT_CLOSE(lc_fresnel_dielectric(0, 1.5), 1, 1e-15);
    /* total internal reflection beyond asin(1 / 1.5) = 41.81 degrees */
    ck_assert(lc_fresnel_dielectric(cos(41.9 * LC_PI / 180), 1 / 1.5) == 1);
    ck_assert_double_lt(lc_fresnel_dielectric(cos(41.7 * LC_PI / 180), 1 / 1.5), 1);
    /* Brewster: only s is reflected, (n^2 - 1)^2 / (n^2 + 1)^2 of it */
    ASSERT_CLOSE(lc_fresnel_dielectric(1 / hypot(1, 1.5), 1.5), 0.5 * (1.25 / 3.25) * (1.25 / 3.25), 1e-14);
    /* reversible; and by angles, -sin(i - t) / sin(i + t) and tan(i - t) / tan(i + t) */
    for (double i = 0.05; i < 1.55; i += 0.1) {
        double t = asin(sin(i) / 1.7), s = sin(i - t) / sin(i + t), p = tan(i - t) / tan(i + t);
        ASSERT_CLOSE(lc_fresnel_dielectric(cos(i), 1.7), (s * s + p * p) / 2, 1e-12);
        ASSERT_CLOSE(lc_fresnel_dielectric(cos(i), 1.7), lc_fresnel_dielectric(cos(t), 1 / 1.7), 1e-12);
    }
}
END_TEST

START_TEST(slab)
{
    double r = lc_fresnel_dielectric(1, 1.5);
    ASSERT_CLOSE(lc_slab_transmittance(r, LC_ALL_REFLECTIONS), 0.923077, 1e-6);
    ASSERT_CLOSE(lc_slab_reflectance(r, LC_ALL_REFLECTIONS), 0.076923, 1e-5);
    ASSERT_CLOSE(lc_slab_transmittance(lc_fresnel_dielectric(0.5, 1.5), LC_ALL_REFLECTIONS), 0.8362, 5e-5);
    /* follow one ray by hand: what leaves after each internal reflection */
    double face = 0.3, inside = 1 - face, through = 0, back = face;
    for (int m = 0; m < 9; ++m) {
        *(m % 2 ? &back : &through) += inside * (1 - face);
        inside *= face;
        ASSERT_CLOSE(lc_slab_transmittance(face, m), through, 1e-14);
        ASSERT_CLOSE(lc_slab_reflectance(face, m), back, 1e-14);
    }
    ASSERT_CLOSE(lc_slab_transmittance(face, 60), lc_slab_transmittance(face, LC_ALL_REFLECTIONS), 1e-14);
    ck_assert(lc_slab_transmittance(1, LC_ALL_REFLECTIONS) == 0);
    double reflected = lc_slab_reflectance(0.2, LC_ALL_REFLECTIONS);
    ASSERT_CLOSE(lc_slab_transmittance(0.2, LC_ALL_REFLECTIONS), 1 - reflected, 1e-15);
}
END_TEST

/* ---- quadrature --------------------------------------------------------------------------------------------- */

static double root_ends(double x, void *user)
{
    (void)user;
    return sqrt(x * (2 - x)) + (x > 0.3 ? x - 0.3 : 0);
}

static double never_settles(double x, void *user)
{
    unsigned *state = user;
    return x + uniform(state);
}

START_TEST(quadrature_converges_or_says_so)
{
    double out;
    lc_error err;
    ck_assert_int_eq(lc_quadrature(&out, root_ends, NULL, 0, 2, 0, 1e-12, &err), LC_OK);
    ASSERT_CLOSE(out, LC_PI / 2 + 1.7 * 1.7 / 2, 1e-11);
    unsigned state = 1;
    ck_assert_int_eq(lc_quadrature(&out, never_settles, &state, 0, 1, 0, 1e-12, &err), LC_FAULT);
    ck_assert_ptr_nonnull(strstr(err.text, "quadrature"));
}
END_TEST

Suite *lc_suite_analytic(void)
{
    Suite *suite = suite_create("analytic");
    TCase *emitters = tcase_create("emitters"), *closed = tcase_create("closed");
    tcase_add_test(emitters, polygon_matches_area_quadrature);
    tcase_add_test(emitters, polygon_is_clipped_to_the_horizon);
    tcase_add_test(emitters, polygon_far_away_is_a_point);
    tcase_add_test(emitters, polygon_close_up_fills_the_hemisphere);
    tcase_add_test(emitters, rectangle_is_a_polygon);
    tcase_add_test(emitters, disk_matches_ring_quadrature);
    tcase_add_test(emitters, ellipse_is_disk_or_many_triangles);
    tcase_add_test(emitters, sphere_matches_ring_quadrature);
    tcase_add_test(emitters, sphere_limits);
    tcase_add_test(emitters, points_walls_and_flux);
    tcase_add_test(emitters, reciprocity);
    tcase_add_test(closed, inside_of_a_sphere);
    tcase_add_test(closed, checkerboard_over_a_sphere);
    tcase_add_test(closed, furnaces);
    tcase_add_test(closed, plates_and_corridor);
    tcase_add_test(closed, flux_balance);
    tcase_add_test(closed, fresnel);
    tcase_add_test(closed, slab);
    tcase_add_test(closed, quadrature_converges_or_says_so);
    suite_add_tcase(suite, emitters);
    suite_add_tcase(suite, closed);
    return suite;
}
