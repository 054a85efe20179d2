/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * By which powers of cosines and distance an estimator is wrong under one rectangular lamp, unoccluded: its image over the true one is
 * fitted by
 *     K cos_v^e  sum cos_s^(1 + a) cos_l^(1 + b) d^(c - 2)  /  sum cos_s cos_l d^-2,
 * the sums over points of the lamp, by Gauss and Newton's method in the logarithm. cos_s, cos_l, cos_v: at the surface with the lamp and with the
 * viewer, and at the lamp. A missing cosine is a power of -1, one that comes twice is 1.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "verify/diagnose/diagnose.h"

enum { UNKNOWNS = 1 + LC_ANGLE_POWERS, SIDE = 12, ROUNDS = 20 };
static const double MODEL_ERROR = 0.01; /* relative, of a pixel: its centre stands for all of it */

typedef struct lamp {
    lc_vec3 p[SIDE * SIDE], n;
} lamp;

typedef struct normal_equations {
    double m[UNKNOWNS][UNKNOWNS], right[UNKNOWNS], chi2;
    int count;
} normal_equations;

/* Midpoints over the only lamp, which has to be a rectangle. */
static int find_lamp(lamp *out, const lc_scene_desc *desc)
{
    int found = -1;
    for (int i = 0; i < desc->shape_count; ++i)
        if (desc->shapes[i].emits) {
            if (found >= 0 || desc->shapes[i].kind != LC_RECTANGLE)
                return 0;
            found = i;
        }
    if (found < 0 || desc->has_sky || desc->point_count || desc->directional_count)
        return 0;
    const lc_shape_desc *shape = &desc->shapes[found];
    for (int k = 0; k < SIDE * SIDE; ++k)
        out->p[k] = lc_affine_point(&shape->to_world, lc_vec((2 * (k % SIDE) + 1.0) / SIDE - 1, (2 * (k / SIDE) + 1.0) / SIDE - 1, 0));
    lc_vec3 n = lc_cross(lc_affine_vector(&shape->to_world, lc_vec(1, 0, 0)), lc_affine_vector(&shape->to_world, lc_vec(0, 1, 0)));
    out->n = lc_normalize(shape->flip_normals ? lc_neg(n) : n);
    return 1;
}

/* 0 where the pixel does not show one surface all over. */
static int find_hit(lc_hit *hit, const lc_scene *scene, int width, int height, int x, int y)
{
    static const double corner[5][2] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {0.5, 0.5}};
    int shape = -1;
    for (int i = 0; i < 5; ++i) {
        lc_ray ray = lc_camera_ray(&lc_scene_description(scene)->camera, width, height, x + corner[i][0], y + corner[i][1]);
        lc_camera_see(scene, &ray, hit);
        if (!hit->valid || (i && hit->shape != shape))
            return 0;
        shape = hit->shape;
    }
    return 1;
}

/* The logarithm of the model, and its derivatives. */
static int model(double *value, double gradient[UNKNOWNS], const lamp *l, const lc_hit *hit, const double power[UNKNOWNS])
{
    lc_vec3 n = lc_facing(hit->n, hit->wo);
    double truth = 0, sum = 0, cos_v = lc_dot(n, hit->wo);
    memset(gradient, 0, UNKNOWNS * sizeof *gradient);
    for (int k = 0; k < SIDE * SIDE; ++k) {
        lc_vec3 to = lc_sub(l->p[k], hit->p);
        double d = lc_length(to), cos_s = lc_dot(n, to) / d, cos_l = -lc_dot(l->n, to) / d;
        if (!(cos_s > 0 && cos_l > 0))
            continue;
        double logs[3] = {log(cos_s), log(cos_l), log(d)}, weight = cos_s * cos_l / (d * d);
        truth += weight;
        weight *= exp(power[1] * logs[0] + power[2] * logs[1] + power[3] * logs[2]);
        sum += weight;
        for (int i = 0; i < 3; ++i)
            gradient[1 + i] += weight * logs[i];
    }
    if (!(sum > 0 && truth > 0 && cos_v > 0))
        return 0;
    gradient[0] = 1;
    for (int i = 1; i < 4; ++i)
        gradient[i] /= sum;
    gradient[4] = log(cos_v);
    *value = power[0] + log(sum / truth) + power[4] * gradient[4];
    return 1;
}

/* Solves m x = right by Gauss's elimination, and inverts m. Returns 0 where m is singular. */
static int solve(normal_equations *e, double x[UNKNOWNS], double inverse[UNKNOWNS][UNKNOWNS])
{
    for (int i = 0; i < UNKNOWNS; ++i)
        for (int j = 0; j < UNKNOWNS; ++j)
            inverse[i][j] = i == j;
    for (int i = 0; i < UNKNOWNS; ++i) { /* positive definite: no pivots are needed */
        double pivot = e->m[i][i];
        if (!(pivot > 1e-9))
            return 0;
        for (int j = 0; j < UNKNOWNS; ++j)
            e->m[i][j] /= pivot, inverse[i][j] /= pivot;
        for (int k = 0; k < UNKNOWNS; ++k) {
            double factor = e->m[k][i];
            for (int j = 0; j < UNKNOWNS && k != i; ++j)
                e->m[k][j] -= factor * e->m[i][j], inverse[k][j] -= factor * inverse[i][j];
        }
    }
    for (int i = 0; i < UNKNOWNS; ++i) {
        x[i] = 0;
        for (int j = 0; j < UNKNOWNS; ++j)
            x[i] += inverse[i][j] * e->right[j];
    }
    return 1;
}

/* film / truth, as far as it is known; 0 where it is not, or is another in each channel: then it is not the angles'. */
static int measured(double *value, double *variance, const lc_pixel *a, const lc_pixel *b)
{
    double sum[2] = {0, 0}, error[2] = {0, 0};
    for (int c = 0; c < 3; ++c) {
        if (!(b->c[c].mean > 0))
            return 0;
        double ratio = a->c[c].mean / b->c[c].mean;
        if (c > 0 && fabs(c * ratio - sum[0]) > 0.01 * sum[0])
            return 0;
        sum[0] += ratio, error[0] += sqrt(lc_pixel_variance(a, c)) / b->c[c].mean;
        sum[1] += 1, error[1] += sqrt(lc_pixel_variance(b, c)) / b->c[c].mean; /* channels see the same samples */
    }
    if (!(sum[0] > 5 * error[0] && sum[1] > 5 * error[1]))
        return 0;
    *value = log(sum[0] / sum[1]);
    double relative[2] = {error[0] / sum[0], error[1] / sum[1]};
    *variance = relative[0] * relative[0] + relative[1] * relative[1] + MODEL_ERROR * MODEL_ERROR;
    return 1;
}

static void add_pixels(normal_equations *e, const lc_scene *scene, const lamp *l, const lc_film *a, const lc_film *b,
                       const double power[UNKNOWNS])
{
    memset(e, 0, sizeof *e);
    for (int i = 0; i < a->width * a->height; ++i) {
        lc_hit hit;
        double is, variance, should, gradient[UNKNOWNS];
        if (!measured(&is, &variance, &a->pixels[i], &b->pixels[i]) ||
            !find_hit(&hit, scene, a->width, a->height, i % a->width, i / a->width) || !model(&should, gradient, l, &hit, power))
            continue;
        for (int j = 0; j < UNKNOWNS; ++j) {
            e->right[j] += gradient[j] * (is - should) / variance;
            for (int k = 0; k < UNKNOWNS; ++k)
                e->m[j][k] += gradient[j] * gradient[k] / variance;
        }
        e->chi2 += (is - should) * (is - should) / variance;
        ++e->count;
    }
}

void lc_fit_angles(lc_angle_fit *out, const lc_scene *scene, const lc_film *film, const lc_film *truth)
{
    lamp l;
    normal_equations e;
    double power[UNKNOWNS] = {0}, step[UNKNOWNS], covariance[UNKNOWNS][UNKNOWNS], most = 1;
    memset(out, 0, sizeof *out);
    if (!find_lamp(&l, lc_scene_description(scene)))
        return;
    for (int round = 0; round < ROUNDS && most > 1e-4; ++round) {
        add_pixels(&e, scene, &l, film, truth, power);
        if (e.count < 100 || !solve(&e, step, covariance))
            return;
        most = 0;
        for (int i = 0; i < UNKNOWNS; ++i) {
            power[i] += fmax(-1, fmin(1, step[i]));
            most = fmax(most, fabs(step[i]));
        }
    }
    out->is_good = most <= 1e-4 && e.chi2 < 1.5 * e.count;
    for (int i = 0; i < LC_ANGLE_POWERS; ++i) {
        out->power[i] = power[1 + i];
        out->error[i] = sqrt(covariance[1 + i][1 + i]);
    }
}
