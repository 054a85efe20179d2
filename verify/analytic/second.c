/* SPDX-License-Identifier: GPL-3.0-or-later */
/* second.c: light that arrives by way of one other surface, by a product rule over it. */
#include "verify/analytic/analytic.h"

#include <gsl/gsl_integration.h>
#include <stdlib.h>

static lc_vec3 column(const lc_affine *a, int k) { return lc_vec(a->m[0][k], a->m[1][k], a->m[2][k]); }

static int is_black(lc_rgb c) { return !(c.r != 0 || c.g != 0 || c.b != 0); }

/* The nodes of one rectangle; its front reflects. */
static lc_status add_nodes(lc_second_node *nodes, int *count, const lc_scene_desc *desc, int index,
                           const gsl_integration_glfixed_table *rule, lc_error *err)
{
    const lc_shape_desc *shape = &desc->shapes[index];
    const lc_affine *map = &shape->to_world;
    lc_vec3 u = column(map, 0), v = column(map, 1), area = lc_cross(u, v), third = column(map, 2);
    double sign = (lc_dot(area, third) < 0) != (shape->flip_normals != 0) ? -1 : 1;
    lc_vec3 n = lc_scale(sign / lc_length(area), area);
    lc_rgb rho = desc->materials[shape->material].side[0].diffuse.color[0];
    for (size_t i = 0; i < LC_SECOND_NODES * LC_SECOND_NODES; ++i) {
        double s, t, ws, wt;
        gsl_integration_glfixed_point(-1, 1, i % LC_SECOND_NODES, &s, &ws, rule);
        gsl_integration_glfixed_point(-1, 1, i / LC_SECOND_NODES, &t, &wt, rule);
        lc_second_node *node = &nodes[(*count)++];
        lc_rgb irradiance;
        node->shape = index;
        node->n = n;
        node->p = lc_add(column(map, 3), lc_add(lc_scale(s, u), lc_scale(t, v)));
        lc_status status = lc_direct_irradiance(&irradiance, desc, node->p, n, err);
        if (status != LC_OK)
            return status;
        node->radiance = lc_rgb_scale(ws * wt * lc_length(area) * LC_INV_PI, lc_rgb_mul(rho, irradiance));
    }
    return LC_OK;
}

lc_status lc_second_prepare(lc_second *out, const lc_scene_desc *desc, lc_error *err)
{
    gsl_integration_glfixed_table *rule = gsl_integration_glfixed_table_alloc(LC_SECOND_NODES);
    out->count = 0;
    out->nodes = malloc((size_t)desc->shape_count * LC_SECOND_NODES * LC_SECOND_NODES * sizeof *out->nodes);
    lc_status status = rule && out->nodes ? LC_OK : lc_fail(err, LC_FAULT, "second bounce: out of memory");
    for (int i = 0; i < desc->shape_count && status == LC_OK; ++i) {
        const lc_shape_desc *shape = &desc->shapes[i];
        const lc_material_desc *m = &desc->materials[shape->material];
        if (is_black(m->side[0].diffuse.color[0]) && is_black(m->side[1].diffuse.color[0]))
            continue;
        if (shape->kind != LC_RECTANGLE || m->side[0].diffuse.is_checkerboard || !is_black(m->side[1].diffuse.color[0]))
            status = lc_fail(err, LC_BAD_INPUT, "%s:%d: expected a one-sided rectangle of one colour", desc->name,
                             shape->line);
        else
            status = add_nodes(out->nodes, &out->count, desc, i, rule, err);
    }
    if (rule)
        gsl_integration_glfixed_table_free(rule);
    if (status != LC_OK)
        lc_second_release(out);
    return status;
}

void lc_second_release(lc_second *second)
{
    free(second->nodes);
    second->nodes = NULL;
    second->count = 0;
}

lc_rgb lc_second_irradiance(const lc_second *second, int own_shape, lc_vec3 p, lc_vec3 n)
{
    lc_rgb sum = lc_black();
    for (int i = 0; i < second->count; ++i) {
        const lc_second_node *node = &second->nodes[i];
        lc_vec3 to = lc_sub(node->p, p);
        double d2 = lc_dot(to, to), cosines = lc_dot(n, to) * -lc_dot(node->n, to);
        if (node->shape != own_shape && lc_dot(n, to) > 0 && cosines > 0)
            sum = lc_rgb_add(sum, lc_rgb_scale(cosines / (d2 * d2), node->radiance));
    }
    return sum;
}
