/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * energy, the part by chance: do samples follow pdf(), and is the mean of the quotient the albedo?
 */
#include <string.h>

#include "verify/checks/energy_c.h"
#include "verify/stats/stats.h"

/* Cells of equal probability under a cosine: rings of mu^2, sectors of azimuth, on either side of the surface. Where there is a rough
 * lobe, its own cells take their place. */
enum { RINGS = 8, SECTORS = 8, SIDE = RINGS * SECTORS, CELLS = 2 * SIDE + LC_WAYS };

/* Where the viewer stands, from grazing to upright. */
static const double cosines[] = {0.01, 0.03, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.97, 0.999, 1};
enum { VIEWS = sizeof cosines / sizeof cosines[0] };

/* Pearson's statistic has a heavier tail than chi-square's. Where cells expect LEAST, the exact tail of 1 to 64
 * Poisson cells (convolution) is at most 4 times the nominal one at 1e-9, 14 times at 1e-13; a single rare cell is
 * the worst. So the level is divided by RESERVE. */
enum { LEAST = 256 };
#define RESERVE 100.0

typedef struct counts {
    double observed[CELLS], expected[CELLS];
} counts;

typedef struct means {
    double n, mean[3], m2[3];
} means;

static int ring_of(double mu) { return (int)fmin(RINGS - 1, mu * mu * RINGS); }

static int cell_of(const lc_stage *stage, const lc_hit *hit, const lc_scatter *sample)
{
    int way = lc_way_of(sample, hit);
    if (way != LC_WAY_FINITE)
        return way < 0 ? 2 * SIDE : 2 * SIDE + way;
    if (stage->alpha > 0)
        return lc_glossy_cell_of(stage, hit, sample->wi);
    double mu = lc_dot(stage->n, sample->wi);
    double azimuth = atan2(lc_dot(stage->t, sample->wi), lc_dot(stage->s, sample->wi));
    int sector = (int)fmin(SECTORS - 1, (azimuth + LC_PI) / (2 * LC_PI) * SECTORS);
    return (mu > 0 ? 0 : SIDE) + ring_of(mu) * SECTORS + sector;
}

/* From pdf() by quadrature, and from the probabilities of the delta lobes; way 0 holds what contradicts itself, and
 * expects nothing. */
static int expect_cells(double expected[CELLS], const lc_stage *stage, const lc_hit *hit, const lc_ways *ways,
                         double n)
{
    double probability[LC_GLOSSY_CELLS];
    if (stage->alpha > 0 && !lc_glossy_cells(probability, stage, hit))
        return 0;
    for (int i = 0; i < LC_GLOSSY_CELLS && stage->alpha > 0; ++i)
        expected[i] = n * probability[i];
    for (int i = 0; i < 2 * SIDE && !(stage->alpha > 0); ++i) {
        int ring = i % SIDE / SECTORS, sector = i % SECTORS;
        double low = sqrt(ring / (double)RINGS), high = sqrt((ring + 1) / (double)RINGS);
        double phi = 2 * LC_PI / SECTORS * sector - LC_PI;
        expected[i] = n * (i < SIDE ? lc_stage_pdf_integral(stage, hit, low, high, phi, phi + 2 * LC_PI / SECTORS)
                                    : lc_stage_pdf_integral(stage, hit, -high, -low, phi, phi + 2 * LC_PI / SECTORS));
    }
    expected[2 * SIDE] = 0;
    for (int w = LC_WAY_MIRROR; w < LC_WAYS; ++w)
        expected[2 * SIDE + w] = ways->seen[w] ? n * ways->way[w].pdf : 0;
    return 1;
}

/* What a sample contributes to the light sent back. */
static lc_rgb quotient(const lc_stage *stage, const lc_hit *hit, const lc_scatter *sample)
{
    double cosine = fabs(lc_dot(hit->n, sample->wi));
    double factor = lc_way_of(sample, hit) == LC_WAY_TRANSMITTED ? stage->ior * stage->ior : 1;
    return lc_rgb_scale((sample->is_delta ? factor : cosine) / sample->pdf, sample->value);
}

static void add(means *m, lc_rgb value)
{
    m->n += 1;
    for (int c = 0; c < 3; ++c) {
        double d = lc_channel(value, c) - m->mean[c];
        m->mean[c] += d / m->n;
        m->m2[c] += d * (lc_channel(value, c) - m->mean[c]);
    }
}

/* Draws from one view. A quotient above `most` breaks a promise of lc_bsdf_sample(), and the bound of the mean with
 * it. */
static int draw(counts *out, means *m, const lc_stage *stage, const lc_hit *hit, uint64_t n, double most, uint64_t seed,
                uint32_t pixel)
{
    for (uint64_t k = 0; k < n; ++k) {
        lc_sampler sampler;
        lc_scatter sample;
        lc_sampler_start(&sampler, seed, lc_arm(stage->row->scene), pixel, (uint32_t)k);
        lc_sampler_seek(&sampler, LC_DIMENSION_ESTIMATOR);
        if (!stage->bsdf->sample(stage->scene, hit, &sampler, &sample))
            return lc_stage_fail(stage, hit, "sample() returns 0 (absorbed), though the surface reflects");
        lc_rgb q = quotient(stage, hit, &sample);
        if (!(lc_rgb_max(q) <= most * (1 + 1e-9)))
            return lc_stage_fail(stage, hit, "value cos / pdf of a sample is %.9g, more than all lobes reflect (%.9g)",
                                 lc_rgb_max(q), most);
        add(m, q);
        int cell = cell_of(stage, hit, &sample);
        if (out->expected[cell] == 0)
            return lc_stage_fail(stage, hit, "sample() picks a direction whose probability is 0 by pdf()");
        out->observed[cell] += 1;
    }
    return 1;
}

static int follows_pdf(const lc_stage *stage, const lc_hit *hit, const counts *c, double alpha, const char *views)
{
    double observed[CELLS], expected[CELLS], sum = 0, n = 0;
    size_t cells = 0;
    for (int i = 0; i < CELLS; ++i) {
        if (c->expected[i] == 0)
            continue;
        observed[cells] = c->observed[i];
        expected[cells++] = c->expected[i];
        sum += c->expected[i], n += c->observed[i];
    }
    for (size_t i = 0; i < cells; ++i)
        expected[i] *= n / sum; /* rounding only: the integral was shown to be 1 */
    lc_chi_square test;
    lc_status status = lc_chi_square_test(&test, observed, expected, cells, LEAST, 0, NULL);
    if (status == LC_FAULT) {
        stage->row->verdict = LC_ROW_UNDECIDED;
        snprintf(stage->row->reason, sizeof stage->row->reason, "%s: out of memory", stage->row->scene);
        return 0;
    }
    /* Fewer than two cells: only one way on that is not too rare, and nothing to compare. */
    if (status != LC_OK || !(test.log_p < log(alpha / RESERVE)))
        return 1;
    return lc_stage_fail(stage, hit, "samples do not follow pdf()%s: chi-square %.6g with %g degrees, p = 1e%.0f",
                         views, test.statistic, test.df, test.log_p / log(10.0));
}

/* The mean over all views against the closed form; `glossy`: that of the rough lobe, mean over the views. Bernstein's
 * bound after Maurer and Pontil knows no variance beforehand and no shape, and wants independent samples, not identically distributed ones. */
static int mean_is_albedo(const lc_stage *stage, const lc_hit *hit, const means *m, double glossy, double most,
                          double alpha_fail, double alpha_pass, double margin)
{
    lc_rgb albedo = lc_color(stage->glass, stage->glass, stage->glass);
    albedo = lc_rgb_add(albedo, lc_rgb_add(stage->diffuse, stage->mirror));
    albedo = lc_rgb_add(albedo, lc_rgb_scale(glossy, stage->glossy));
    double scale = lc_rgb_max(albedo);
    lc_row *row = stage->row;
    for (int c = 0; c < 3; ++c) {
        double difference = m->mean[c] - lc_channel(albedo, c), variance = m->m2[c] / (m->n - 1);
        double fail = lc_bernstein_bound(variance, m->n, most, alpha_fail) + 1e-9 * scale;
        double pass = lc_bernstein_bound(variance, m->n, most, alpha_pass) + 1e-9 * scale;
        if (fabs(difference) > fail)
            return lc_stage_fail(stage, hit,
                                 "the mean of value cos / pdf over all views is %.6g, expected %.6g +- %.2g",
                                 m->mean[c], lc_channel(albedo, c), fail);
        if (fabs(difference) + pass > margin * scale) {
            row->verdict = LC_ROW_UNDECIDED;
            snprintf(row->reason, sizeof row->reason,
                     "%s: the mean of value cos / pdf is known to %.2g%% only, the margin is %.2g%%", row->scene,
                     100 * (fabs(difference) + pass) / scale, 100 * margin);
        }
        /* The row shows the hardest channel of the hardest stage. */
        if (row->exact || fabs(difference) / scale + pass / scale > fmax(row->high - 1, 1 - row->low)) {
            row->exact = 0;
            row->channel = c;
            row->expected = scale;
            row->ratio = 1 + difference / scale;
            row->low = row->ratio - pass / scale;
            row->high = row->ratio + pass / scale;
        }
    }
    return 1;
}

/* 2^15 a view where the margin is 0.5%, more for a narrower one, and for the light that very rough facets lose. */
static uint64_t samples_of(const lc_stage *stage, double margin)
{
    double n = (stage->alpha > 0.5 ? 8 : 1) * 32768 * (0.005 / margin) * (0.005 / margin);
    return (uint64_t)fmin(fmax(n, 4096), 4194304);
}

int lc_energy_sample(const lc_stage *stage, int index, int stages, const lc_share *share)
{
    double most = lc_rgb_max(stage->diffuse) + lc_rgb_max(stage->glossy) + lc_rgb_max(stage->mirror) + stage->glass;
    double glossy = 0;
    if (most == 0)
        return 1; /* black, as was shown exactly */
    uint64_t n = samples_of(stage, share->margin);
    /* Half for the chi-squares (one a view, one of all), half for the means. */
    double alpha_follow = 0.5 * share->false_fail / (stages * (VIEWS + 1));
    double alpha_mean = 0.5 * share->false_fail / (stages * 3);
    counts all;
    means m;
    memset(&all, 0, sizeof all);
    memset(&m, 0, sizeof m);
    lc_hit hit = stage->hit;
    for (int v = 0; v < VIEWS; ++v) {
        counts one;
        lc_ways ways;
        double albedo;
        hit = lc_stage_seen(stage, cosines[v], 0.7 + 2.39996322972865332 * v);
        if (!lc_stage_ways(&ways, stage, &hit) || !lc_stage_glossy_albedo(&albedo, stage, &hit))
            return 0;
        glossy += albedo / VIEWS;
        memset(&one, 0, sizeof one);
        if (!expect_cells(one.expected, stage, &hit, &ways, (double)n) ||
            !draw(&one, &m, stage, &hit, n, most, share->seed, (uint32_t)(index * VIEWS + v)) ||
            !follows_pdf(stage, &hit, &one, alpha_follow, ""))
            return 0;
        for (int i = 0; i < CELLS; ++i)
            all.observed[i] += one.observed[i], all.expected[i] += one.expected[i];
    }
    stage->row->samples = n;
    stage->row->paths += VIEWS * n;
    return follows_pdf(stage, &hit, &all, alpha_follow, " over all views") &&
           mean_is_albedo(stage, &hit, &m, glossy, most, alpha_mean, share->false_pass, share->margin);
}
