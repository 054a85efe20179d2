/* SPDX-License-Identifier: GPL-3.0-or-later */
/* factor.c: form factors and irradiances of single emitters; see analytic.h for formulas and sources.
 *
 * Angles come from atan2 and differences are written out, because acos near 1 and 1 - x near 0 lose digits exactly
 * where renderers work: small and far lamps. */
#include "verify/analytic/analytic.h"

#include "verify/analytic/body.h"

double lc_lambert_radiance(double flux, double area) { return flux / (LC_PI * area); }

double lc_lambert_reflected(double rho, double irradiance) { return rho * irradiance / LC_PI; }

double lc_point_irradiance(double intensity, lc_vec3 light, lc_vec3 p, lc_vec3 n)
{
    lc_vec3 to = lc_sub(light, p);
    double d = lc_length(to);
    return intensity * fmax(0, lc_dot(to, n)) / (d * d * d);
}

double lc_directional_irradiance(double facing, lc_vec3 direction, lc_vec3 n)
{
    return facing * fmax(0, -lc_dot(direction, n));
}

double lc_sky_irradiance(double radiance) { return LC_PI * radiance; }

double lc_reciprocal_factor(double factor12, double area1, double area2) { return area1 * factor12 / area2; }

double lc_wall_factor(double elevation)
{
    double s = sin(elevation / 2);
    return s * s;
}

double lc_rectangle_factor(double a, double b, double h)
{
    if (!(h > 0))
        return 0;
    double sin_x = 1 / hypot(1, h / a), sin_y = 1 / hypot(1, h / b);
    return (sin_x * atan2(b, hypot(a, h)) + sin_y * atan2(a, hypot(b, h))) / (2 * LC_PI);
}

double lc_disk_factor(double radius, double offset, double h)
{
    if (!(h > 0))
        return 0;
    double diff = h * h + (offset - radius) * (offset + radius);
    double root = hypot(diff, 2 * h * radius); /* (h^2+a^2+R^2)^2 - 4 a^2 R^2 = diff^2 + 4 h^2 R^2 */
    if (diff > 0)
        return 2 * h * h * radius * radius / (root * (root + diff));
    return (1 - diff / root) / 2;
}

/* atan(z) - z without cancellation. */
static double atan_excess(double z)
{
    if (fabs(z) > 0.1)
        return atan(z) - z;
    double sum = 0, power = z, square = z * z;
    for (int k = 1; k <= 9; ++k) {
        power *= -square;
        sum += power / (2 * k + 1);
    }
    return sum;
}

double lc_sphere_factor(lc_vec3 centre, double radius, lc_vec3 p, lc_vec3 n)
{
    lc_vec3 to = lc_sub(centre, p);
    double d = lc_length(to);
    if (d < radius * (1 - LC_TOUCH) || !(radius > 0))
        return 0;
    double height = lc_dot(to, n), cos_t = height / d, sin_t = lc_length(lc_cross(to, n)) / d;
    if (d < radius * (1 + LC_TOUCH))
        return (1 + cos_t) / 2;
    double sin2 = radius / d * (radius / d); /* 1 / H^2 */
    if (height >= radius)
        return cos_t * sin2;
    if (height <= -radius)
        return 0;
    double x = sqrt((d - radius) * (d + radius)) / radius;
    double y = fmax(-1, fmin(1, -x * cos_t / sin_t));
    double s = sin_t * sqrt((1 - y) * (1 + y)), z = s / x;
    /* atan(z) - x s / H^2 = (atan(z) - z) + z / H^2, since x^2 = H^2 - 1 */
    return fmax(0, (cos_t * acos(y) * sin2 + atan_excess(z) + z * sin2) / LC_PI);
}

/* ---- polygons --------------------------------------------------------------------------------------------- */

int lc_polygon_clip(lc_vec3 *out, const lc_vec3 *in, int count, lc_vec3 plane, double offset)
{
    int kept = 0;
    for (int i = 0; i < count; ++i) {
        lc_vec3 a = in[i], b = in[(i + 1) % count];
        double da = lc_dot(a, plane) - offset, db = lc_dot(b, plane) - offset;
        if (da >= 0)
            out[kept++] = a;
        if ((da > 0 && db < 0) || (da < 0 && db > 0))
            out[kept++] = lc_add(a, lc_scale(da / (da - db), lc_sub(b, a)));
    }
    return kept;
}

lc_vec3 lc_polygon_area(const lc_vec3 *corners, int count)
{
    lc_vec3 sum = lc_vec(0, 0, 0);
    for (int i = 1; i + 1 < count; ++i)
        sum = lc_add(sum, lc_cross(lc_sub(corners[i], corners[0]), lc_sub(corners[i + 1], corners[0])));
    return lc_scale(0.5, sum);
}

/* cos cos' / (pi d^2) at x, times the area of the (signed) area vector. */
static double point_factor(lc_vec3 x, lc_vec3 area, lc_vec3 n)
{
    double d2 = lc_dot(x, x);
    return -lc_dot(x, n) * lc_dot(x, area) / (LC_PI * d2 * d2);
}

/* Small and far: Lambert's sum cancels, while Radon's rule of degree 5 (Radon 1948; Stroud T2:5-1) is exact to
 * (size/d)^6. */
static double small_factor(const lc_vec3 *c, int count, lc_vec3 n)
{
    const double root = sqrt(15.0);
    const double near_corner[2] = {(6 + root) / 21, (6 - root) / 21};
    const double weight[2] = {(155 + root) / 1200, (155 - root) / 1200};
    double sum = 0;
    for (int i = 1; i + 1 < count; ++i) {
        const lc_vec3 t[3] = {c[0], c[i], c[i + 1]};
        lc_vec3 area = lc_scale(0.5, lc_cross(lc_sub(t[1], t[0]), lc_sub(t[2], t[0])));
        lc_vec3 total = lc_add(t[0], lc_add(t[1], t[2]));
        sum += 9.0 / 40 * point_factor(lc_scale(1.0 / 3, total), area, n);
        for (int k = 0; k < 2; ++k)
            for (int j = 0; j < 3; ++j) {
                /* barycentric (a, a, 1 - 2 a) */
                double a = near_corner[k];
                lc_vec3 x = lc_add(lc_scale(a, total), lc_scale(1 - 3 * a, t[j]));
                sum += weight[k] * point_factor(x, area, n);
            }
    }
    return sum;
}

double lc_polygon_factor_above(const lc_vec3 *c, int count, lc_vec3 n)
{
    if (count < 3)
        return 0;
    double near = INFINITY, size = 0;
    for (int i = 0; i < count; ++i) {
        near = fmin(near, lc_length(c[i]));
        size = fmax(size, lc_length(lc_sub(c[i], c[0])));
    }
    if (size < 5e-3 * near)
        return fmax(0, small_factor(c, count, n));
    double sum = 0;
    for (int i = 0; i < count; ++i) {
        lc_vec3 a = c[i], b = c[(i + 1) % count];
        lc_vec3 normal = lc_cross(a, lc_sub(b, a)); /* = a x b, exact for close corners */
        double length = lc_length(normal);
        if (length > 0)
            sum -= atan2(length, lc_dot(a, b)) / length * lc_dot(normal, n);
    }
    return fmax(0, sum / (2 * LC_PI));
}

double lc_polygon_factor(const lc_vec3 *corners, int count, lc_vec3 p, lc_vec3 n)
{
    lc_vec3 relative[LC_POLYGON_MAX], above[2 * LC_POLYGON_MAX];
    if (count < 3 || count > LC_POLYGON_MAX)
        return NAN;
    double reach = 0;
    for (int i = 0; i < count; ++i) {
        relative[i] = lc_sub(corners[i], p);
        reach = fmax(reach, lc_length(relative[i]));
    }
    lc_vec3 area = lc_polygon_area(relative, count);
    if (!(lc_dot(relative[0], area) < -LC_TOUCH * reach * lc_length(area)))
        return 0;
    return lc_polygon_factor_above(above, lc_polygon_clip(above, relative, count, n, 0), n);
}
