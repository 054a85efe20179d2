/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Affine maps of space: x -> A x + t, as 3 rows of 4 numbers. */
#include "core/host.h"

lc_affine lc_affine_identity(void)
{
    lc_affine a = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    return a;
}

lc_affine lc_affine_multiply(const lc_affine *a, const lc_affine *b)
{
    lc_affine c;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 4; ++j)
            c.m[i][j] =
                a->m[i][0] * b->m[0][j] + a->m[i][1] * b->m[1][j] + a->m[i][2] * b->m[2][j] + (j == 3 ? a->m[i][3] : 0);
    return c;
}

static lc_vec3 column(const lc_affine *a, int j) { return lc_vec(a->m[0][j], a->m[1][j], a->m[2][j]); }

/* Of the linear part. */
double lc_affine_determinant(const lc_affine *a) { return lc_dot(column(a, 0), lc_cross(column(a, 1), column(a, 2))); }

/* Singular is what cannot be told from it in double precision: a volume below 1e-12 of what the columns' lengths allow.
 * The test is relative, so scenes of any size pass. */
int lc_affine_invert(lc_affine *out, const lc_affine *a)
{
    lc_vec3 x = column(a, 0), y = column(a, 1), z = column(a, 2), t = column(a, 3);
    double det = lc_affine_determinant(a);
    double box = lc_length(x) * lc_length(y) * lc_length(z);
    if (!(fabs(det) > 1e-12 * box) || !isfinite(box) || !isfinite(1 / det))
        return 0;
    lc_vec3 rows[3] = {lc_cross(y, z), lc_cross(z, x), lc_cross(x, y)};
    for (int i = 0; i < 3; ++i) {
        lc_vec3 r = lc_scale(1 / det, rows[i]);
        out->m[i][0] = r.x, out->m[i][1] = r.y, out->m[i][2] = r.z, out->m[i][3] = -lc_dot(r, t);
    }
    return 1;
}

lc_vec3 lc_affine_point(const lc_affine *a, lc_vec3 p) { return lc_add(lc_affine_vector(a, p), column(a, 3)); }

lc_vec3 lc_affine_vector(const lc_affine *a, lc_vec3 v)
{
    return lc_vec(a->m[0][0] * v.x + a->m[0][1] * v.y + a->m[0][2] * v.z,
                  a->m[1][0] * v.x + a->m[1][1] * v.y + a->m[1][2] * v.z,
                  a->m[2][0] * v.x + a->m[2][1] * v.y + a->m[2][2] * v.z);
}
