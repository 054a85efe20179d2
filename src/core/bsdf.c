/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * What a surface does with light: its BSDF as value, density and choice, and the laws of mirrors and of glass.
 */
#include "core/scene_c.h"

/* cos^2 of the angle of refraction, by Snell; <= 0 at total reflection. Written so that ior = 1 gives back cos^2 of
 * the incident angle, to the bit: 1 - sin^2 / ior^2 would leave a faint reflection of nothing. One function for all,
 * so that they agree where it becomes total. */
static double cos2_refracted(double cos_i, double ior) { return ((ior - 1) * (ior + 1) + cos_i * cos_i) / (ior * ior); }

double lc_fresnel(double cos_i, double ior)
{
    double cos2_t = cos2_refracted(cos_i, ior);
    if (!(cos2_t > 0))
        return 1.0;
    double cos_t = sqrt(cos2_t);
    double s = (cos_i - ior * cos_t) / (cos_i + ior * cos_t);
    double p = (ior * cos_i - cos_t) / (ior * cos_i + cos_t);
    return 0.5 * (s * s + p * p);
}

lc_vec3 lc_reflect(lc_vec3 wo, lc_vec3 n) { return lc_sub(lc_scale(2.0 * lc_dot(n, wo), n), wo); }

int lc_refract(lc_vec3 wo, lc_vec3 n, double ior, lc_vec3 *wi)
{
    n = lc_facing(n, wo);
    double cos_i = lc_dot(n, wo), cos2_t = cos2_refracted(cos_i, ior);
    if (!(cos2_t > 0))
        return 0;
    *wi = lc_sub(lc_scale(cos_i / ior - sqrt(cos2_t), n), lc_scale(1.0 / ior, wo));
    return 1;
}

/* ---- lobes ---------------------------------------------------------------------------------------------------- */

/* Ways on from a hit, in the order in which a random number chooses among them. */
enum { DIFFUSE, GLOSSY, MIRROR, GLASS_REFLECTS, GLASS_TRANSMITS, WAYS };

/* What all lobes reflect, each in its largest channel: the quotient is at most this sum, and a blend keeps it at or
 * below 1. */
static double reflectance(const lc_material *m)
{
    double glossy = m->alpha > 0 ? lc_rgb_max(m->glossy) : 0; /* few have it, and a maximum is a call */
    return lc_rgb_max(m->diffuse) + glossy + lc_rgb_max(m->mirror) + m->glass;
}

/* The share of each way in that. */
static void weigh(double weight[WAYS], const lc_material *m, double cos_o)
{
    double fresnel = m->glass > 0 ? lc_fresnel(cos_o, m->ior) : 0;
    weight[DIFFUSE] = lc_rgb_max(m->diffuse);
    weight[GLOSSY] = m->alpha > 0 ? lc_rgb_max(m->glossy) : 0;
    weight[MIRROR] = lc_rgb_max(m->mirror);
    weight[GLASS_REFLECTS] = m->glass * fresnel;
    weight[GLASS_TRANSMITS] = m->glass * (1 - fresnel);
}

static lc_rgb finite_value(const lc_material *m, const lc_hit *hit, lc_vec3 wi)
{
    if (!(lc_dot(hit->n, wi) * lc_dot(hit->n, hit->wo) > 0))
        return lc_black();
    lc_rgb value = lc_rgb_scale(LC_INV_PI, m->diffuse);
    if (!(m->alpha > 0))
        return value;
    double glossy = lc_glossy_value(lc_facing(hit->n, hit->wo), hit->wo, wi, m->alpha);
    return lc_rgb_add(value, lc_rgb_scale(glossy, m->glossy));
}

static double finite_pdf(const lc_material *m, const lc_hit *hit, lc_vec3 wi)
{
    double cos_i = lc_dot(hit->n, wi), diffuse = lc_rgb_max(m->diffuse), pdf = 0;
    if (diffuse > 0 && cos_i * lc_dot(hit->n, hit->wo) > 0)
        pdf = diffuse / reflectance(m) * fabs(cos_i) * LC_INV_PI;
    if (m->alpha > 0 && lc_rgb_max(m->glossy) > 0)
        pdf += lc_rgb_max(m->glossy) / reflectance(m) * lc_glossy_pdf(lc_facing(hit->n, hit->wo), hit->wo, wi, m->alpha);
    return pdf;
}

/* The way that u in [0, 1) chooses; never one of weight 0. */
static int choose(const double weight[WAYS], double total, double u)
{
    int way = 0;
    double left = u * total;
    for (int i = 0; i < WAYS; ++i) {
        if (!(weight[i] > 0))
            continue;
        way = i;
        if (left < weight[i])
            break;
        left -= weight[i];
    }
    return way;
}

lc_rgb lc_bsdf_eval(const lc_scene *scene, const lc_hit *hit, lc_vec3 wi)
{
    lc_material m = lc_surface_material(scene, hit); /* black on a miss */
    lc_rgb f = finite_value(&m, hit, wi);
    if (scene->log)
        lc_log(scene->log, "bsdf: wi (%.9g, %.9g, %.9g), f (%.9g, %.9g, %.9g) 1/sr", wi.x, wi.y, wi.z, f.r, f.g, f.b);
    return f;
}

double lc_bsdf_pdf(const lc_scene *scene, const lc_hit *hit, lc_vec3 wi)
{
    lc_material m = lc_surface_material(scene, hit);
    double pdf = finite_pdf(&m, hit, wi);
    if (scene->log)
        lc_log(scene->log, "bsdf pdf: wi (%.9g, %.9g, %.9g), pdf %.9g 1/sr", wi.x, wi.y, wi.z, pdf);
    return pdf;
}

static lc_rgb grey(double value) { return lc_color(value, value, value); }

/* Everything but the probability of the way itself, which out->pdf holds. */
static void follow(lc_scatter *out, int way, const lc_material *m, const lc_hit *hit, double u, double v)
{
    lc_vec3 n = lc_facing(hit->n, hit->wo);
    out->is_delta = way > GLOSSY;
    out->lobe = way == DIFFUSE ? LC_DIFFUSE : way == GLOSSY ? LC_GLOSSY : way == MIRROR ? LC_MIRROR : LC_GLASS;
    switch (way) {
    case DIFFUSE:
    case GLOSSY:
        out->wi = way == DIFFUSE ? lc_cosine_hemisphere(n, u, v) : lc_glossy_sample(n, hit->wo, m->alpha, u, v);
        out->value = finite_value(m, hit, out->wi);
        out->pdf = finite_pdf(m, hit, out->wi);
        break;
    case MIRROR:
        out->wi = lc_reflect(hit->wo, n);
        out->value = m->mirror;
        break;
    case GLASS_REFLECTS:
        out->wi = lc_reflect(hit->wo, n);
        out->value = grey(m->glass * lc_fresnel(lc_dot(n, hit->wo), m->ior));
        break;
    default: /* never chosen at total reflection, where it weighs 0 */
        lc_refract(hit->wo, n, m->ior, &out->wi);
        out->value = grey(m->glass * (1 - lc_fresnel(lc_dot(n, hit->wo), m->ior)) / (m->ior * m->ior));
    }
}

int lc_bsdf_sample(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out)
{
    /* Always three, so that what is drawn next does not depend on the choice. */
    double choice = lc_next(sampler), u = lc_next(sampler), v = lc_next(sampler);
    lc_material m = lc_surface_material(scene, hit);
    double weight[WAYS], cos_o = fabs(lc_dot(hit->n, hit->wo)), total = reflectance(&m);
    if (!(total > 0 && cos_o > 0)) {
        if (scene->log)
            lc_log(scene->log, "bsdf sample: absorbed");
        return 0;
    }
    weigh(weight, &m, cos_o);
    int way = choose(weight, total, choice);
    lc_scatter scatter;
    scatter.pdf = weight[way] / total;
    follow(&scatter, way, &m, hit, u, v);
    if (!(scatter.pdf > 0)) /* a facet on edge, one in 10^15, where h is all rounding */
        return 0;
    *out = scatter;
    if (scene->log)
        lc_log(scene->log, "bsdf sample: %s, wi (%.9g, %.9g, %.9g), value (%.9g, %.9g, %.9g), pdf %.9g%s",
               out->lobe == LC_DIFFUSE  ? "diffuse"
               : out->lobe == LC_GLOSSY ? "glossy"
               : out->lobe == LC_MIRROR ? "mirror"
                                        : "glass",
               out->wi.x, out->wi.y, out->wi.z, out->value.r, out->value.g, out->value.b, out->pdf,
               out->is_delta ? "" : " 1/sr");
    return 1;
}
