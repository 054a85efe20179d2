/* SPDX-License-Identifier: GPL-3.0-or-later */
/* clip.c: the part of a flat lamp that flat shapes leave visible, exactly.
 *
 * A convex polygon H hides what lies behind its plane and inside the pyramid from the receiver over its edges: an
 * intersection of half-spaces. Cutting the lamp by them one after the other leaves convex visible pieces outside and
 * the hidden remainder inside. Source: Nishita and Nakamae, Half-tone representation of 3-D objects illuminated by
 * area sources or polyhedron sources, COMPSAC 1983. */
#include "verify/analytic/body.h"

#include <string.h>

struct hiders {
    const lc_body *const *list;
    int count;
};

/* A convex piece of the lamp, and the half-spaces x . plane >= offset of one hider's shadow. */
struct piece {
    int count;
    lc_vec3 v[LC_POLYGON_MAX];
};

struct shadow {
    int count;
    lc_vec3 plane[LC_BODY_CORNERS + 1];
    double offset[LC_BODY_CORNERS + 1];
};

static void shadow_of(struct shadow *shadow, const lc_body *hider)
{
    double sign = hider->offset > 0 ? 1 : -1;
    shadow->count = 0;
    for (int i = 0; i < hider->count; ++i) {
        lc_vec3 a = hider->v[i], b = hider->v[(i + 1) % hider->count];
        lc_vec3 normal = lc_scale(sign, lc_cross(a, lc_sub(b, a)));
        double length = lc_length(normal);
        if (!(length > 0))
            continue; /* two corners in one direction */
        shadow->plane[shadow->count] = lc_scale(1 / length, normal);
        shadow->offset[shadow->count++] = 0;
    }
    /* touching is not hiding */
    shadow->plane[shadow->count] = lc_scale(sign, hider->normal);
    shadow->offset[shadow->count++] = fabs(hider->offset) + 0.01 * LC_TOUCH * (lc_length(hider->middle) + hider->reach);
}

static lc_status visible(double *sum, const struct piece *piece, const struct hiders *hiders, int next, lc_error *err);

/* The piece minus the shadow of the next hider, minus those of the others. */
static lc_status visible_past(double *sum, const struct piece *piece, const struct hiders *hiders, int next,
                              lc_error *err)
{
    struct shadow shadow;
    shadow_of(&shadow, hiders->list[next]);
    /* does it hide anything? else the piece stays whole */
    struct piece inside = *piece, cut;
    for (int i = 0; i < shadow.count && inside.count >= 3; ++i) {
        cut.count = lc_polygon_clip(cut.v, inside.v, inside.count, shadow.plane[i], shadow.offset[i]);
        inside = cut;
    }
    if (inside.count < 3)
        return visible(sum, piece, hiders, next + 1, err);
    inside = *piece;
    for (int i = 0; i < shadow.count; ++i) {
        cut.count = lc_polygon_clip(cut.v, inside.v, inside.count, lc_neg(shadow.plane[i]), -shadow.offset[i]);
        if (cut.count >= 3) {
            lc_status status = visible(sum, &cut, hiders, next + 1, err);
            if (status)
                return status;
        }
        cut.count = lc_polygon_clip(cut.v, inside.v, inside.count, shadow.plane[i], shadow.offset[i]);
        inside = cut;
    }
    return LC_OK;
}

static lc_status visible(double *sum, const struct piece *piece, const struct hiders *hiders, int next, lc_error *err)
{
    if (next == hiders->count) {
        *sum += lc_polygon_factor_above(piece->v, piece->count, lc_vec(0, 0, 1));
        return LC_OK;
    }
    /* each cut of a convex polygon adds at most one corner */
    if (piece->count + LC_BODY_CORNERS + 1 > LC_POLYGON_MAX)
        return lc_fail(err, LC_FAULT, "visible part of a lamp: a piece of %d corners, expected at most %d",
                       piece->count, LC_POLYGON_MAX - LC_BODY_CORNERS - 1);
    return visible_past(sum, piece, hiders, next, err);
}

lc_status lc_clip_factor(double *factor, const lc_body *lamp, const lc_body *const *hiders, int count, lc_error *err)
{
    struct hiders all = {hiders, count};
    struct piece whole;
    *factor = 0;
    if (lamp->count < 3)
        return LC_OK;
    whole.count = lamp->count;
    memcpy(whole.v, lamp->v, sizeof lamp->v);
    return visible(factor, &whole, &all, 0, err);
}
