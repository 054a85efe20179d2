/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Second part of the scene reader: numbers, colours, vectors and transforms, as Mitsuba 3 reads them. */
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "io/scene_read_c.h"

static const char *value_of(const struct node *node)
{
    const char *value = scene_attribute(node, "value");
    return value ? value : "";
}

/* Length of the decimal number that `text` begins with, 0 when there is none. strtod() alone would also take
 * hexadecimal, nan and infinity. */
static size_t number_length(const char *text)
{
    const char *t = text + (*text == '+' || *text == '-');
    size_t whole = strspn(t, "0123456789"), part = 0;
    t += whole;
    if (*t == '.') {
        part = strspn(t + 1, "0123456789");
        t += 1 + part;
    }
    if (whole + part == 0)
        return 0;
    if (*t == 'e' || *t == 'E') {
        const char *e = t + 1 + (t[1] == '+' || t[1] == '-');
        size_t digits = strspn(e, "0123456789");
        if (digits)
            t = e + digits;
    }
    return (size_t)(t - text);
}

/* Up to `max` numbers apart by spaces or commas; the count, or -1 after a failure. */
static int numbers(struct reader *r, const struct node *node, const char *text, double *out, int max)
{
    int count = 0;
    const char *t = text + strspn(text, " ,");
    while (*t) {
        size_t length = number_length(t);
        if (length == 0 || !strchr(" ,", t[length])) { /* strchr also finds the end */
            scene_fail(r, node, "'%.60s' is no number; expected finite decimal numbers apart by spaces or commas",
                       text);
            return -1;
        }
        if (count == max) {
            scene_fail(r, node, "more than %d numbers in '%.60s'", max, text);
            return -1;
        }
        out[count] = strtod(t, NULL);
        if (!isfinite(out[count++])) {
            scene_fail(r, node, "'%.60s' is too large for a number", text);
            return -1;
        }
        t += length;
        t += strspn(t, " ,");
    }
    return count;
}

int scene_number(struct reader *r, const struct node *node, const char *text, double *out)
{
    double value[1];
    int count = numbers(r, node, text, value, 1);
    if (count == 0)
        return scene_fail(r, node, "'%.60s' is no number", text);
    if (count == 1)
        *out = value[0];
    return count == 1;
}

int scene_float(struct reader *r, const struct node *node, double *out)
{
    int i = 0;
    if (strcmp(node->tag, "integer") != 0)
        return scene_number(r, node, value_of(node), out);
    if (!scene_integer(r, node, &i))
        return 0;
    *out = i;
    return 1;
}

int scene_integer(struct reader *r, const struct node *node, int *out)
{
    const char *text = value_of(node), *t = text + strspn(text, " ");
    size_t length = strspn(t + (*t == '-'), "0123456789") + (*t == '-');
    double value = strtod(t, NULL);
    if (length == (size_t)(*t == '-') || t[length + strspn(t + length, " ")] || !(fabs(value) <= 2147483647))
        return scene_fail(r, node, "'%.60s' is no integer (32 bits)", text);
    *out = (int)value;
    return 1;
}

int scene_boolean(struct reader *r, const struct node *node, int *out)
{
    const char *text = value_of(node);
    *out = strcasecmp(text, "true") == 0;
    return *out || strcasecmp(text, "false") == 0 ||
           scene_fail(r, node, "'%.60s' is no boolean; expected true or false", text);
}

/* value="1 2 3", value="1" (three times the same), or x, y, z, of which the missing ones are `otherwise`. */
static int components(struct reader *r, const struct node *node, double otherwise, lc_vec3 *out)
{
    static const char *const axes[3] = {"x", "y", "z"};
    const char *value = scene_attribute(node, "value");
    double v[3] = {otherwise, otherwise, otherwise};
    if (value) {
        for (int i = 0; i < 3; ++i)
            if (scene_attribute(node, axes[i]))
                return scene_fail(r, node, "both 'value' and '%s' in <%s>", axes[i], node->tag);
        int count = numbers(r, node, value, v, 3);
        if (count < 0)
            return 0;
        if (count == 1)
            v[1] = v[2] = v[0];
        else if (count != 3)
            return scene_fail(r, node, "'%.60s' has %d numbers; expected 1 or 3", value, count);
    }
    for (int i = 0; i < 3; ++i) {
        const char *text = scene_attribute(node, axes[i]);
        if (text && !scene_number(r, node, text, &v[i]))
            return 0;
    }
    *out = lc_vec(v[0], v[1], v[2]);
    return 1;
}

int scene_vector(struct reader *r, const struct node *node, lc_vec3 *out)
{
    if (!scene_attribute(node, "value") &&
        !(scene_attribute(node, "x") && scene_attribute(node, "y") && scene_attribute(node, "z")))
        return scene_fail(r, node, "<%s> without its numbers; expected value=\"x y z\", or all of x, y and z",
                          node->tag);
    return components(r, node, 0, out);
}

int scene_color(struct reader *r, const struct node *node, double limit, lc_rgb *out)
{
    double v[3] = {0, 0, 0};
    int count = 1;
    if (strcmp(node->tag, "rgb") == 0)
        count = numbers(r, node, value_of(node), v, 3);
    else if (!scene_float(r, node, v)) /* a uniform <spectrum> is one number, too */
        return 0;
    if (count < 0)
        return 0;
    if (count == 1)
        v[1] = v[2] = v[0];
    else if (count != 3)
        return scene_fail(r, node, "'%.60s' has %d numbers; expected 1 or 3", value_of(node), count);
    for (int i = 0; i < 3; ++i)
        if (!(v[i] >= 0 && v[i] <= limit)) {
            if (limit == 1)
                return scene_fail(r, node, "%s %g lies outside [0, 1]", scene_attribute(node, "name"), v[i]);
            return scene_fail(r, node, "%s %g is negative", scene_attribute(node, "name"), v[i]);
        }
    *out = lc_color(v[0], v[1], v[2]);
    return 1;
}

/* ---- transforms ---- */

static lc_affine from_columns(lc_vec3 x, lc_vec3 y, lc_vec3 z, lc_vec3 t)
{
    lc_affine a = {{{x.x, y.x, z.x, t.x}, {x.y, y.y, z.y, t.y}, {x.z, y.z, z.z, t.z}}};
    return a;
}

static int read_translate(struct reader *r, const struct node *node, lc_affine *out)
{
    lc_vec3 t;
    if (!components(r, node, 0, &t))
        return 0;
    *out = from_columns(lc_vec(1, 0, 0), lc_vec(0, 1, 0), lc_vec(0, 0, 1), t);
    return 1;
}

static int read_scale(struct reader *r, const struct node *node, lc_affine *out)
{
    lc_vec3 s;
    if (!components(r, node, 1, &s))
        return 0;
    if (s.x == 0 || s.y == 0 || s.z == 0)
        return scene_fail(r, node, "scale by zero");
    *out = from_columns(lc_vec(s.x, 0, 0), lc_vec(0, s.y, 0), lc_vec(0, 0, s.z), lc_vec(0, 0, 0));
    return 1;
}

/* Rodrigues' formula. Mitsuba 3 does not normalise the axis: its matrix is then no rotation, so we refuse. */
static int read_rotate(struct reader *r, const struct node *node, lc_affine *out)
{
    lc_vec3 k, columns[3];
    double degrees = 0;
    const char *angle = scene_attribute(node, "angle");
    if (!angle)
        return scene_fail(r, node, "<rotate> without an angle (degrees)");
    if (!components(r, node, 0, &k) || !scene_number(r, node, angle, &degrees))
        return 0;
    if (fabs(lc_length(k) - 1) > 1e-6)
        return scene_fail(r, node, "rotation axis of length %g; expected 1, since Mitsuba does not normalise it",
                          lc_length(k));
    k = lc_normalize(k);
    double a = degrees * LC_PI / 180;
    for (int i = 0; i < 3; ++i) {
        lc_vec3 e = lc_vec(i == 0, i == 1, i == 2);
        columns[i] = lc_add(lc_scale(cos(a), e),
                            lc_add(lc_scale(sin(a), lc_cross(k, e)), lc_scale((1 - cos(a)) * lc_dot(k, e), k)));
    }
    *out = from_columns(columns[0], columns[1], columns[2], lc_vec(0, 0, 0));
    return 1;
}

static int read_lookat(struct reader *r, const struct node *node, lc_affine *out)
{
    static const char *const names[3] = {"origin", "target", "up"};
    lc_vec3 v[3];
    for (int i = 0; i < 3; ++i) {
        const char *text = scene_attribute(node, names[i]);
        double c[3];
        if (!text)
            return scene_fail(r, node, "<lookat> without '%s'; expected origin, target and up", names[i]);
        int count = numbers(r, node, text, c, 3);
        if (count < 0)
            return 0;
        if (count != 3)
            return scene_fail(r, node, "'%.60s' has %d numbers; expected 3", text, count);
        v[i] = lc_vec(c[0], c[1], c[2]);
    }
    lc_vec3 forward = lc_sub(v[1], v[0]), left = lc_cross(v[2], forward);
    if (!(lc_length(left) > 1e-9 * lc_length(v[2]) * lc_length(forward)))
        return scene_fail(r, node, "<lookat> whose target is its origin, or whose up points along the view");
    forward = lc_normalize(forward), left = lc_normalize(left);
    *out = from_columns(left, lc_cross(forward, left), forward, v[0]);
    return 1;
}

static int read_matrix(struct reader *r, const struct node *node, lc_affine *out)
{
    double m[16];
    int count = numbers(r, node, value_of(node), m, 16);
    if (count < 0)
        return 0;
    if (count != 9 && count != 16)
        return scene_fail(r, node, "a matrix of %d numbers; expected 9 or 16, row by row", count);
    *out = lc_affine_identity();
    int n = count == 16 ? 4 : 3;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < n; ++j)
            out->m[i][j] = m[i * n + j];
    if (n == 4 && (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1))
        return scene_fail(r, node, "a projective matrix; expected the last row 0 0 0 1");
    return 1;
}

static const struct {
    const char *tag, *attributes;
    int (*read)(struct reader *r, const struct node *node, lc_affine *out);
} steps[] = {
    {"translate", "value x y z", read_translate},
    {"rotate", "value x y z angle", read_rotate},
    {"scale", "value x y z", read_scale},
    {"lookat", "origin target up", read_lookat},
    {"matrix", "value", read_matrix},
};

/* Each step acts after the ones above it. */
int scene_transform(struct reader *r, const struct node *node, lc_affine *out)
{
    lc_affine step, inverse;
    *out = lc_affine_identity();
    for (const struct node *n = node->first; n; n = n->next) {
        size_t i = 0;
        while (i < sizeof steps / sizeof steps[0] && strcmp(steps[i].tag, n->tag) != 0)
            ++i;
        if (i == sizeof steps / sizeof steps[0])
            return scene_fail(
                r, n, "unknown <%.40s> in a <transform>; supported: translate, rotate, scale, lookat, matrix", n->tag);
        if (n->first)
            return scene_fail(r, n->first, "<%.40s> inside <%s>", n->first->tag, n->tag);
        if (!scene_attributes_only(r, n, steps[i].attributes) || !steps[i].read(r, n, &step))
            return 0;
        *out = lc_affine_multiply(&step, out);
    }
    for (int i = 0; i < 12; ++i)
        if (!isfinite(out->m[i / 4][i % 4]))
            return scene_fail(r, node, "a transform whose numbers are too large");
    return lc_affine_invert(&inverse, out) || scene_fail(r, node, "a singular transform, which flattens space");
}

double scene_dissimilarity(const lc_affine *a)
{
    double worst = 0, scale = 0;
    for (int i = 0; i < 3; ++i)
        scale += a->m[i][0] * a->m[i][0];
    for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k) {
            double dot = a->m[0][j] * a->m[0][k] + a->m[1][j] * a->m[1][k] + a->m[2][j] * a->m[2][k];
            worst = fmax(worst, fabs(dot / scale - (j == k)));
        }
    return worst;
}
