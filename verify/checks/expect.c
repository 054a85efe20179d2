/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The mean of a function over each pixel: what a box filter makes of it.
 */
#include <string.h>

#include "verify/checks/checks.h"

typedef struct view {
    lc_view_fn *function;
    void *user;
    const lc_scene *scene;
    int width, height;
} view;

static lc_status look(const view *v, double x, double y, lc_rgb *value, int *kind, lc_error *err)
{
    lc_ray ray = lc_camera_ray(&lc_scene_description(v->scene)->camera, v->width, v->height, x, y);
    lc_hit hit;
    lc_camera_see(v->scene, &ray, &hit);
    return v->function(value, kind, v->scene, &hit, v->user, err);
}

/* Three-point Gauss-Legendre nodes on [0, 1] and their weights: exact to degree 5. */
static const double nodes[3] = {0.11270166537925831148, 0.5, 0.88729833462074168852};
static const double weights[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};

/* Mean over the square of this side; `depth` more cuts where it is not of one kind. */
static lc_status square_mean(const view *v, double x, double y, double side, int depth, lc_rgb *mean, lc_error *err)
{
    static const double corners[4][2] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
    lc_rgb value;
    int first = 0, kind, mixed = 0;
    *mean = lc_black();
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) {
            lc_status status = look(v, x + side * nodes[i], y + side * nodes[j], &value, &kind, err);
            if (status != LC_OK)
                return status;
            if (i == 0 && j == 0)
                first = kind;
            mixed |= kind != first;
            *mean = lc_rgb_add(*mean, lc_rgb_scale(weights[i] * weights[j], value));
        }
    }
    for (int i = 0; i < 4 && !mixed && depth > 0; ++i) {
        lc_status status = look(v, x + side * corners[i][0], y + side * corners[i][1], &value, &kind, err);
        if (status != LC_OK)
            return status;
        mixed |= kind != first;
    }
    if (!mixed || depth == 0)
        return LC_OK;
    *mean = lc_black();
    for (int i = 0; i < 4; ++i) {
        lc_rgb quarter;
        lc_status status =
            square_mean(v, x + 0.5 * side * corners[i][0], y + 0.5 * side * corners[i][1], 0.5 * side, depth - 1, &quarter, err);
        if (status != LC_OK)
            return status;
        *mean = lc_rgb_add(*mean, lc_rgb_scale(0.25, quarter));
    }
    return LC_OK;
}

lc_status lc_expect_view(double *rgb, lc_view_fn *function, void *user, const lc_scene *scene, int width, int height, lc_error *err)
{
    view v = {function, user, scene, width, height};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            lc_rgb mean;
            lc_status status = square_mean(&v, x, y, 1.0, 6, &mean, err);
            if (status != LC_OK)
                return status;
            double *pixel = rgb + 3 * ((size_t)y * (size_t)width + (size_t)x);
            pixel[0] = mean.r;
            pixel[1] = mean.g;
            pixel[2] = mean.b;
        }
    }
    return LC_OK;
}
