/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The mean of a function over each pixel: what a box filter makes of it. Rows of pixels are shared out among threads.
 */
#include <pthread.h>
#include <unistd.h>

#include "verify/checks/checks.h"

/* Finest cut of a pixel. */
#define LEAST_SIDE (1.0 / 32)

typedef struct view {
    lc_view_fn *function;
    void *user;
    const lc_scene *scene;
    lc_expected *out;
    double error;         /* that a pixel's mean may have */
    pthread_mutex_t lock; /* of what follows */
    int next_row;
    lc_status status;
    lc_error err;
} view;

static lc_status look(const view *v, double x, double y, lc_rgb *value, int *kind, lc_error *err)
{
    lc_ray ray = lc_camera_ray(&lc_scene_description(v->scene)->camera, v->out->width, v->out->height, x, y);
    lc_hit hit;
    lc_camera_see(v->scene, &ray, &hit);
    return v->function(value, kind, v->scene, &hit, v->user, err);
}

/* Whether the pixel's border, eight points a side, is of one kind. */
static lc_status border_is_mixed(const view *v, int x, int y, int kind, int *mixed, lc_error *err)
{
    *mixed = 0;
    for (int i = 0; i < 32 && !*mixed; ++i) {
        double t = (i % 8) / 8.0, dx = 0, dy = 0;
        int here;
        switch (i / 8) {
        case 0:
            dx = t;
            break;
        case 1:
            dx = 1, dy = t;
            break;
        case 2:
            dx = 1 - t, dy = 1;
            break;
        default:
            dy = 1 - t;
        }
        lc_status status = look(v, x + dx, y + dy, NULL, &here, err);
        if (status != LC_OK)
            return status;
        *mixed = here != kind;
    }
    return LC_OK;
}

/* Mean over a square by 3 x 3 Gauss-Legendre nodes, exact to degree 5. `mixed` is set where a node is of another kind. */
static lc_status gauss(const view *v, double x, double y, double side, int kind, lc_rgb *mean, int *mixed,
                       lc_error *err)
{
    static const double nodes[3] = {0.11270166537925831148, 0.5, 0.88729833462074168852};
    static const double weights[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    *mean = lc_black();
    for (int i = 0; i < 9; ++i) {
        lc_rgb value;
        int here;
        lc_status status = look(v, x + side * nodes[i % 3], y + side * nodes[i / 3], &value, &here, err);
        if (status != LC_OK)
            return status;
        *mixed |= here != kind;
        *mean = lc_rgb_add(*mean, lc_rgb_scale(weights[i % 3] * weights[i / 3], value));
    }
    return LC_OK;
}

/* The same, cut in four until halving the side changes the pixel's mean by no more than v->error: kinks (horizons, the edges of
 * penumbras) run through pixels, and a dark pixel has so little noise that a render would show the rule's error. */
static lc_status adapt(const view *v, double x, double y, double side, int kind, lc_rgb *mean, int *mixed,
                       lc_error *err)
{
    lc_rgb coarse = *mean, quarter[4];
    *mean = lc_black();
    for (int i = 0; i < 4; ++i) {
        lc_status status =
            gauss(v, x + side / 2 * (i % 2), y + side / 2 * (i / 2), side / 2, kind, &quarter[i], mixed, err);
        if (status != LC_OK)
            return status;
        *mean = lc_rgb_add(*mean, lc_rgb_scale(0.25, quarter[i]));
    }
    double change = fmax(fabs(mean->r - coarse.r), fmax(fabs(mean->g - coarse.g), fabs(mean->b - coarse.b)));
    if (*mixed || change * side * side <= v->error || side <= LEAST_SIDE)
        return LC_OK;
    *mean = lc_black();
    for (int i = 0; i < 4; ++i) {
        lc_status status =
            adapt(v, x + side / 2 * (i % 2), y + side / 2 * (i / 2), side / 2, kind, &quarter[i], mixed, err);
        if (status != LC_OK)
            return status;
        *mean = lc_rgb_add(*mean, lc_rgb_scale(0.25, quarter[i]));
    }
    return LC_OK;
}

static lc_status pixel_mean(const view *v, int x, int y, lc_error *err)
{
    size_t index = (size_t)y * (size_t)v->out->width + (size_t)x;
    int kind, mixed;
    lc_rgb mean = lc_black();
    lc_status status = look(v, x + 0.5, y + 0.5, NULL, &kind, err);
    if (status == LC_OK)
        status = border_is_mixed(v, x, y, kind, &mixed, err);
    if (status == LC_OK && !mixed)
        status = gauss(v, x, y, 1.0, kind, &mean, &mixed, err);
    if (status == LC_OK && !mixed)
        status = adapt(v, x, y, 1.0, kind, &mean, &mixed, err);
    if (status != LC_OK)
        return status;
    v->out->skip[index] = (unsigned char)mixed;
    v->out->rgb[3 * index] = mixed ? 0 : mean.r;
    v->out->rgb[3 * index + 1] = mixed ? 0 : mean.g;
    v->out->rgb[3 * index + 2] = mixed ? 0 : mean.b;
    return LC_OK;
}

/* Mean radiance of the image, roughly: the scale of the errors. */
static lc_status rough_mean(const view *v, double *mean, lc_error *err)
{
    double sum = 0;
    for (int i = 0; i < 64; ++i) {
        lc_rgb value;
        int kind;
        lc_status status =
            look(v, v->out->width * ((i % 8) + 0.5) / 8, v->out->height * ((i / 8) + 0.5) / 8, &value, &kind, err);
        if (status != LC_OK)
            return status;
        sum += (value.r + value.g + value.b) / 3;
    }
    *mean = sum / 64;
    return LC_OK;
}

static void *work(void *argument)
{
    view *v = argument;
    lc_error err = {""};
    for (;;) {
        pthread_mutex_lock(&v->lock);
        int y = v->status == LC_OK ? v->next_row++ : v->out->height;
        pthread_mutex_unlock(&v->lock);
        if (y >= v->out->height)
            return NULL;
        lc_status status = LC_OK;
        for (int x = 0; x < v->out->width && status == LC_OK; ++x)
            status = pixel_mean(v, x, y, &err);
        if (status == LC_OK)
            continue;
        pthread_mutex_lock(&v->lock);
        v->status = status;
        v->err = err;
        pthread_mutex_unlock(&v->lock);
    }
}

lc_status lc_expect_view(lc_expected *out, lc_view_fn *function, void *user, const lc_scene *scene, double tolerance,
                         int threads, lc_error *err)
{
    view v = {function, user, scene, out, 0, PTHREAD_MUTEX_INITIALIZER, 0, LC_OK, {""}};
    pthread_t thread[64];
    long wanted = threads > 0 ? threads : sysconf(_SC_NPROCESSORS_ONLN);
    int started = 0;
    double scale = 0;
    v.status = rough_mean(&v, &scale, &v.err);
    v.error = tolerance * scale;
    while (started < 63 && started < wanted - 1 && pthread_create(&thread[started], NULL, work, &v) == 0)
        ++started;
    work(&v);
    for (int i = 0; i < started; ++i)
        pthread_join(thread[i], NULL);
    if (v.status != LC_OK && err)
        *err = v.err;
    return v.status;
}
