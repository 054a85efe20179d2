/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * energy, the part without chance: integrals by quadrature, and every way on that sample() knows.
 */
#include "verify/analytic/effects.h"
#include "verify/checks/energy_c.h"

/* Of closed forms computed in doubles; a direction and its way back differ by more at grazing angles. */
#define ROUNDING 1e-10
#define ROUNDING_BACK 1e-7
/* Of quadrature over a rough lobe. */
#define ROUNDING_GLOSSY 1e-7

double lc_stage_rounding(const lc_stage *stage) { return stage->alpha > 0 ? ROUNDING_GLOSSY : ROUNDING; }

/* A way rarer than this may escape the numbers that cover [0, 1), and is then left out of the sums. */
#define RARE 1e-3
enum { MOST_TRIES = 4096, LEAST_TRIES = 16 };

/* ---- integrals -------------------------------------------------------------------------------------------------- */

static lc_vec3 direction(const lc_stage *stage, double mu, double azimuth)
{
    double sine = sqrt(fmax(0, (1 - mu) * (1 + mu)));
    return lc_add(lc_scale(mu, stage->n),
                  lc_add(lc_scale(sine * cos(azimuth), stage->s), lc_scale(sine * sin(azimuth), stage->t)));
}

/* Nodes and weights of Gauss and Legendre on [0, 1], exact to degree 7: Lambert's lobe is a polynomial in mu, constant
 * in azimuth. Rough ones are for energy_glossy.c. */
static const double nodes[4] = {0.069431844202973712, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629};
static const double weights[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693};

double lc_stage_pdf_integral(const lc_stage *stage, const lc_hit *hit, double mu0, double mu1, double phi0, double phi1)
{
    double sum = 0;
    for (int i = 0; i < 16; ++i) {
        lc_vec3 wi = direction(stage, mu0 + (mu1 - mu0) * nodes[i % 4], phi0 + (phi1 - phi0) * nodes[i / 4]);
        sum += weights[i % 4] * weights[i / 4] * stage->bsdf->pdf(stage->scene, hit, wi);
    }
    return sum * (mu1 - mu0) * (phi1 - phi0);
}

/* Integral of f |cos| over the sphere. */
static lc_rgb finite_albedo(const lc_stage *stage, const lc_hit *hit)
{
    lc_rgb sum = lc_black();
    for (int cell = 0; cell < 16; ++cell) { /* two hemispheres, eight sectors */
        for (int i = 0; i < 16; ++i) {
            double mu = (cell % 2 ? -1 : 1) * nodes[i % 4], phi = LC_PI / 4 * (cell / 2 + nodes[i / 4]);
            lc_rgb f = stage->bsdf->eval(stage->scene, hit, direction(stage, mu, phi));
            sum = lc_rgb_add(sum, lc_rgb_scale(weights[i % 4] * weights[i / 4] * LC_PI / 4 * fabs(mu), f));
        }
    }
    return sum;
}

static double finite_probability(const lc_stage *stage, const lc_hit *hit)
{
    double sum = 0;
    for (int i = 0; i < 8; ++i)
        sum += lc_stage_pdf_integral(stage, hit, 0, 1, LC_PI / 4 * i, LC_PI / 4 * (i + 1)) +
               lc_stage_pdf_integral(stage, hit, -1, 0, LC_PI / 4 * i, LC_PI / 4 * (i + 1));
    return sum;
}

/* Both at once, by the rule that suits the surface. */
static int integrate_finite(lc_ways *out, const lc_stage *stage, const lc_hit *hit)
{
    double all[4];
    if (!(stage->alpha > 0)) {
        out->finite = finite_probability(stage, hit);
        out->albedo = finite_albedo(stage, hit);
        return 1;
    }
    if (!lc_glossy_integrals(all, stage, hit))
        return 0;
    out->finite = all[0];
    out->albedo = lc_color(all[1], all[2], all[3]);
    return 1;
}

int lc_stage_glossy_albedo(double *albedo, const lc_stage *stage, const lc_hit *hit)
{
    lc_error err = {""};
    *albedo = 0;
    if (!(stage->alpha > 0))
        return 1;
    return lc_ggx_albedo(albedo, fmin(1, lc_dot(stage->n, hit->wo)), stage->alpha, &err) == LC_OK ||
           lc_stage_fail(stage, hit, "no closed form: %.200s", err.text);
}

/* ---- ways ------------------------------------------------------------------------------------------------------- */

int lc_way_of(const lc_scatter *sample, const lc_hit *hit)
{
    if (sample->is_delta != (sample->lobe != LC_DIFFUSE && sample->lobe != LC_GLOSSY))
        return -1;
    switch (sample->lobe) {
    case LC_DIFFUSE:
    case LC_GLOSSY:
        return LC_WAY_FINITE;
    case LC_MIRROR:
        return LC_WAY_MIRROR;
    case LC_GLASS:
        return lc_dot(hit->n, sample->wi) * lc_dot(hit->n, hit->wo) > 0 ? LC_WAY_REFLECTED : LC_WAY_TRANSMITTED;
    default:
        return -1;
    }
}

static double distance(lc_rgb a, lc_rgb b) { return fmax(fabs(a.r - b.r), fmax(fabs(a.g - b.g), fabs(a.b - b.b))); }

/* The digits of k in this base, mirrored at the point: van der Corput. */
static double mirrored(uint32_t k, uint32_t base)
{
    double value = 0, digit = 1;
    for (; k; k /= base)
        value += (digit /= base) * (k % base);
    return value;
}

/* A sampler whose next numbers are these: a block that claims to be loaded. */
static lc_sampler loaded_sampler(double choice, double u, double v)
{
    lc_sampler sampler;
    lc_sampler_start(&sampler, 0, 0, 0, 0);
    lc_sampler_seek(&sampler, LC_DIMENSION_ESTIMATOR);
    sampler.loaded = LC_DIMENSION_ESTIMATOR / 4;
    sampler.block[0] = (uint32_t)(choice * 0x1p32);
    sampler.block[1] = (uint32_t)(u * 0x1p32);
    sampler.block[2] = sampler.block[3] = (uint32_t)(v * 0x1p32);
    return sampler;
}

/* A finite sample says what pdf() and eval() say; a delta sample says what it said before. */
static int compare_sample(lc_ways *ways, const lc_stage *stage, const lc_hit *hit, const lc_scatter *sample)
{
    int way = lc_way_of(sample, hit);
    if (way < 0)
        return lc_stage_fail(stage, hit, "sample() returns lobe %d with is_delta %d", sample->lobe, sample->is_delta);
    if (!lc_stage_expect(stage, hit, "the length of sample()'s wi", lc_length(sample->wi), 1, ROUNDING))
        return 0;
    if (!(sample->pdf > 0))
        return lc_stage_fail(stage, hit, "sample() returns a pdf of %g for what it picked", sample->pdf);
    if (way == LC_WAY_FINITE) {
        double pdf = stage->bsdf->pdf(stage->scene, hit, sample->wi);
        if (fabs(sample->pdf - pdf) > ROUNDING * pdf)
            return lc_stage_fail(stage, hit, "sample()'s pdf is %.9g, pdf() says %.9g 1/sr", sample->pdf, pdf);
        lc_rgb value = stage->bsdf->eval(stage->scene, hit, sample->wi);
        if (!(distance(sample->value, value) <= ROUNDING * fmax(1, lc_rgb_max(value))))
            return lc_stage_fail(stage, hit, "sample()'s value is not that of eval()");
    } else if (ways->seen[way]) {
        const lc_scatter *first = &ways->way[way];
        if (!(distance(sample->value, first->value) <= ROUNDING && fabs(sample->pdf - first->pdf) <= ROUNDING &&
              lc_length(lc_sub(sample->wi, first->wi)) <= ROUNDING))
            return lc_stage_fail(stage, hit, "two samples of one delta lobe differ");
    }
    if (!ways->seen[way])
        ways->way[way] = *sample;
    ways->seen[way] = 1;
    return 1;
}

/* Probability of all ways that were seen. */
static double probability(const lc_ways *ways)
{
    double sum = ways->finite;
    for (int w = LC_WAY_MIRROR; w < LC_WAYS; ++w)
        sum += ways->seen[w] ? ways->way[w].pdf : 0;
    return sum;
}

int lc_stage_ways(lc_ways *out, const lc_stage *stage, const lc_hit *hit)
{
    static const lc_ways none;
    *out = none;
    if (!integrate_finite(out, stage, hit))
        return 0;
    for (uint32_t k = 0; k < MOST_TRIES; ++k) {
        if (k >= LEAST_TRIES && fabs(probability(out) - 1) <= lc_stage_rounding(stage))
            break;
        /* Both ends first: the rarest way may be the last. */
        double choice = k == 0 ? 1 - 0x1p-32 : mirrored(k - 1, 2);
        lc_sampler sampler = loaded_sampler(choice, mirrored(k, 3), mirrored(k, 5));
        lc_scatter sample;
        if (!stage->bsdf->sample(stage->scene, hit, &sampler, &sample))
            out->absorbed = 1;
        else if (!compare_sample(out, stage, hit, &sample))
            return 0;
    }
    return 1;
}

/* ---- closed forms ----------------------------------------------------------------------------------------------- */

/* Light sent back by each way, of the light that comes along wo: fluxes, so nothing of ior^2. */
static int closed_forms(lc_rgb flux[LC_WAYS], const lc_stage *stage, const lc_hit *hit)
{
    double glossy;
    if (!lc_stage_glossy_albedo(&glossy, stage, hit))
        return 0;
    double fresnel = lc_fresnel_dielectric(fmin(1, lc_dot(stage->n, hit->wo)), stage->ior);
    double reflected = stage->glass * fresnel, transmitted = stage->glass * (1 - fresnel);
    flux[LC_WAY_FINITE] = lc_rgb_add(stage->diffuse, lc_rgb_scale(glossy, stage->glossy));
    flux[LC_WAY_MIRROR] = stage->mirror;
    flux[LC_WAY_REFLECTED] = lc_color(reflected, reflected, reflected);
    flux[LC_WAY_TRANSMITTED] = lc_color(transmitted, transmitted, transmitted);
    return 1;
}

/* Radiance along wo over radiance from wi, made the share of light: L / n^2 is what stays. */
static double flux_factor(const lc_stage *stage, int way)
{
    return way == LC_WAY_TRANSMITTED ? stage->ior * stage->ior : 1;
}

/* Snell's law in the plane of incidence. */
static lc_vec3 closed_direction(const lc_stage *stage, const lc_hit *hit, int way)
{
    double cosine = lc_dot(stage->n, hit->wo);
    lc_vec3 across = lc_sub(hit->wo, lc_scale(cosine, stage->n));
    if (way != LC_WAY_TRANSMITTED)
        return lc_sub(lc_scale(cosine, stage->n), across);
    double sine = lc_length(across) / stage->ior;
    return lc_neg(lc_add(lc_scale(1 / stage->ior, across), lc_scale(sqrt((1 - sine) * (1 + sine)), stage->n)));
}

static int delta_ways(const lc_ways *ways, const lc_rgb flux[LC_WAYS], const lc_stage *stage, const lc_hit *hit)
{
    static const char *const names[LC_WAYS] = {"", "the reflectance of the mirror lobe",
                                               "what glass reflects (Fresnel, times the lobe's share)",
                                               "what glass transmits (1 - Fresnel, times the lobe's share)"};
    for (int w = LC_WAY_MIRROR; w < LC_WAYS; ++w) {
        if (!ways->seen[w])
            continue;
        for (int c = 0; c < 3; ++c)
            if (!lc_stage_expect(stage, hit, names[w], flux_factor(stage, w) * lc_channel(ways->way[w].value, c),
                                 lc_channel(flux[w], c), ROUNDING))
                return 0;
        lc_vec3 should = closed_direction(stage, hit, w), is = ways->way[w].wi;
        if (!(lc_length(lc_sub(is, should)) <= ROUNDING_BACK))
            return lc_stage_fail(stage, hit, "%s goes to the wrong direction: %.3g rad off",
                                 w == LC_WAY_TRANSMITTED ? "refraction (Snell)" : "reflection",
                                 lc_length(lc_sub(is, should)));
    }
    return 1;
}

/* All lobes together: the light that is sent back, then the probabilities. */
static int sums(const lc_ways *ways, const lc_rgb flux[LC_WAYS], const lc_stage *stage, const lc_hit *hit)
{
    static const char *const names[3] = {"the directional albedo (R)", "the directional albedo (G)",
                                         "the directional albedo (B)"};
    lc_rgb albedo = ways->albedo, should = lc_black();
    double all = 0, unseen = 0;
    for (int w = 0; w < LC_WAYS; ++w) {
        all += lc_rgb_max(flux[w]);
        unseen += w > 0 && !ways->seen[w] ? lc_rgb_max(flux[w]) : 0;
        should = lc_rgb_add(should, flux[w]);
        if (w > 0 && ways->seen[w])
            albedo = lc_rgb_add(albedo, lc_rgb_scale(flux_factor(stage, w), ways->way[w].value));
    }
    double rare = unseen < RARE * all && !ways->absorbed ? unseen : 0;
    for (int c = 0; c < 3; ++c)
        if (!lc_stage_expect(stage, hit, names[c], lc_channel(albedo, c), lc_channel(should, c),
                             lc_stage_rounding(stage) + rare))
            return 0;
    if (all == 0)
        return lc_stage_expect(stage, hit, LC_SAY_SUM, probability(ways), 0, 0);
    if (ways->absorbed)
        return lc_stage_fail(stage, hit, "sample() returns 0 (absorbed), though the surface reflects %.6g", all);
    return lc_stage_expect(stage, hit, LC_SAY_SUM, probability(ways), 1, lc_stage_rounding(stage) + rare / all);
}

/* ---- reciprocity ------------------------------------------------------------------------------------------------ */

static int finite_reciprocity(const lc_stage *stage, const lc_hit *hit)
{
    for (int k = 0; k < 32; ++k) {
        lc_vec3 wi = direction(stage, 1 - (2 * k + 1) / 32.0, 2.39996322972865332 * k + 0.1); /* a spiral */
        lc_hit back = *hit;
        back.wo = wi;
        lc_rgb f = stage->bsdf->eval(stage->scene, hit, wi), g = stage->bsdf->eval(stage->scene, &back, hit->wo);
        for (int c = 0; c < 3; ++c) {
            double there = lc_channel(f, c), here = lc_channel(g, c);
            if (!(there >= 0 && there < INFINITY))
                return lc_stage_fail(stage, hit, "f is %g 1/sr, expected finite and not negative", there);
            if (!(stage->bsdf->pdf(stage->scene, hit, wi) >= 0))
                return lc_stage_fail(stage, hit, "pdf() is negative");
            if (!(fabs(there - here) <= ROUNDING * fmax(there, here)))
                return lc_stage_fail(stage, hit, "f is not reciprocal: f(wo, wi) = %.9g, f(wi, wo) = %.9g 1/sr", there,
                                     here);
        }
    }
    return 1;
}

/* A delta lobe leads back to where it came from. Reflected: with the same value. Transmitted: what radiance is
 * multiplied with, times (index where it comes from / index where it goes)^2, is the same both ways. */
static int delta_reciprocity(const lc_ways *ways, const lc_stage *stage, const lc_hit *hit)
{
    for (int w = LC_WAY_MIRROR; w < LC_WAYS; ++w) {
        if (!ways->seen[w])
            continue;
        lc_ways partner;
        lc_hit back = *hit;
        back.wo = ways->way[w].wi;
        if (!lc_stage_ways(&partner, stage, &back))
            return 0;
        if (!partner.seen[w] && flux_factor(stage, w) * lc_rgb_max(ways->way[w].value) < RARE)
            continue;
        if (!partner.seen[w])
            return lc_stage_fail(stage, hit, "a delta lobe is not reciprocal: there is no way back");
        if (!(lc_length(lc_sub(partner.way[w].wi, hit->wo)) <= ROUNDING_BACK))
            return lc_stage_fail(stage, hit, "a delta lobe is not reciprocal: its way back leads elsewhere");
        double factor = flux_factor(stage, w);
        if (!(distance(lc_rgb_scale(factor, ways->way[w].value), lc_rgb_scale(1 / factor, partner.way[w].value)) <=
              ROUNDING_BACK))
            return lc_stage_fail(stage, hit, "a delta lobe is not reciprocal: %.9g there, %.9g back",
                                 factor * lc_rgb_max(ways->way[w].value), lc_rgb_max(partner.way[w].value) / factor);
    }
    return 1;
}

/* ---- all of it -------------------------------------------------------------------------------------------------- */

typedef int at_fn(const lc_stage *stage, double cosine, double azimuth);

static int closed_forms_at(const lc_stage *stage, double cosine, double azimuth)
{
    lc_hit hit = lc_stage_seen(stage, cosine, azimuth);
    lc_rgb flux[LC_WAYS];
    lc_ways ways;
    return closed_forms(flux, stage, &hit) && finite_reciprocity(stage, &hit) && lc_stage_ways(&ways, stage, &hit) &&
           delta_ways(&ways, flux, stage, &hit) && sums(&ways, flux, stage, &hit);
}

static int way_back_at(const lc_stage *stage, double cosine, double azimuth)
{
    lc_hit hit = lc_stage_seen(stage, cosine, azimuth);
    lc_ways ways;
    if (stage->glass == 0 && lc_rgb_max(stage->mirror) == 0)
        return 1; /* that there is none was shown: the finite lobes take the whole probability */
    return lc_stage_ways(&ways, stage, &hit) && delta_reciprocity(&ways, stage, &hit);
}

/* From every side: a grid of cosines, both ends, and just above and below the critical angle. */
static int at_all(at_fn *at, const lc_stage *stage)
{
    enum { ENDS = 6, EDGES = 4 };
    int steps = stage->alpha > 0 ? 16 : 48; /* adaptive quadrature is dear */
    static const double ends[ENDS] = {1, 0.9999, 0.01, 1e-3, 1e-4, 1e-6};
    static const double edges[EDGES] = {1e-6, -1e-6, 1e-2, -1e-2};
    double azimuth = 0.3;
    for (int k = 0; k < steps + ENDS; ++k, azimuth += 2.39996322972865332)
        if (!at(stage, k < steps ? (k + 0.5) / steps : ends[k - steps], azimuth))
            return 0;
    if (!(stage->glass > 0 && stage->ior < 1))
        return 1;
    double critical = sqrt((1 - stage->ior) * (1 + stage->ior)); /* reflection is total below */
    for (int k = 0; k < EDGES; ++k)
        if (!at(stage, critical * (1 + edges[k]), azimuth))
            return 0;
    return 1;
}

int lc_energy_forms(const lc_stage *stage) { return at_all(closed_forms_at, stage); }
int lc_energy_way_back(const lc_stage *stage) { return at_all(way_back_at, stage); }
