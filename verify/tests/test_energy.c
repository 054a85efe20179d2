/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The energy check passes the host's materials, and fails each broken BSDF by name. */
#include <math.h>
#include <string.h>

#include "estimators/registry.h"
#include "verify/checks/energy.h"
#include "verify/judge/judge.h"
#include "verify/stats/stats.h"
#include "verify/tests/tests.h"

static const lc_share share = {1e-8, 1e-8, 0.01, 1, 0, 0};

static int material_of(const char *name)
{
    for (int i = 0; i < lc_energy_count(); ++i)
        if (strcmp(lc_energy_name(i), name) == 0)
            return i;
    ck_abort_msg("no material %s", name);
    return -1;
}

static lc_row judge(const char *material, const lc_bsdf_functions *bsdf)
{
    lc_row row;
    lc_error err = {""};
    memset(&row, 0, sizeof row);
    ck_assert_msg(lc_energy_judge(&row, material_of(material), bsdf, &share, &err) == LC_OK, "%s", err.text);
    return row;
}

/* ---- the host ------------------------------------------------------------------------------------------------- */

START_TEST(host_passes)
{
    lc_row row = judge(lc_energy_name(_i), &lc_bsdf_host);
    ck_assert_msg(row.verdict == LC_ROW_PASS, "%s", row.reason);
    ck_assert_str_eq(row.scene, lc_energy_name(_i));
    ck_assert_str_eq(row.estimator, "host");
    if (strcmp(row.scene, "diffuse_black") == 0) { /* nothing to draw */
        ck_assert(row.exact && row.paths == 0);
        return;
    }
    ck_assert(!row.exact && row.paths >= 12 * row.samples);
    ck_assert(row.low <= row.ratio && row.ratio <= row.high);
    ck_assert(row.low >= 1 - row.margin && row.high <= 1 + row.margin);
}
END_TEST

/* Colours of a half mirror make a quotient that varies; at this error probability so few samples show nothing. */
START_TEST(too_few_samples_are_undecided)
{
    lc_row row;
    lc_share strict = share;
    memset(&row, 0, sizeof row);
    strict.false_pass = 1e-300;
    ck_assert_int_eq(lc_energy_judge(&row, material_of("mirror_half"), &lc_bsdf_host, &strict, NULL), LC_OK);
    ck_assert_int_eq(row.verdict, LC_ROW_UNDECIDED);
    ck_assert_ptr_nonnull(strstr(row.reason, "the margin is 1%"));
}
END_TEST

/* ---- mutants of the host ---------------------------------------------------------------------------------------- */

static lc_rgb times(double s, lc_rgb c) { return lc_rgb_scale(s, c); }

static double pdf_half(const lc_scene *scene, const lc_hit *hit, lc_vec3 wi)
{
    return 0.5 * lc_bsdf_pdf(scene, hit, wi);
}
static int sample_pdf_half(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out)
{
    int some = lc_bsdf_sample(scene, hit, sampler, out);
    if (some && !out->is_delta)
        out->pdf *= 0.5;
    return some;
}

static lc_rgb eval_without_pi(const lc_scene *scene, const lc_hit *hit, lc_vec3 wi)
{
    return times(LC_PI, lc_bsdf_eval(scene, hit, wi));
}
static int sample_without_pi(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out)
{
    int some = lc_bsdf_sample(scene, hit, sampler, out);
    if (some && !out->is_delta)
        out->value = times(LC_PI, out->value);
    return some;
}

static lc_rgb eval_negative(const lc_scene *scene, const lc_hit *hit, lc_vec3 wi)
{
    return times(lc_dot(hit->wo, wi) < -0.9 ? -1 : 1, lc_bsdf_eval(scene, hit, wi));
}

static lc_rgb eval_asymmetric(const lc_scene *scene, const lc_hit *hit, lc_vec3 wi)
{
    double lean = fabs(lc_dot(hit->n, hit->wo)) - fabs(lc_dot(hit->n, wi));
    return times(1 + 0.01 * lean, lc_bsdf_eval(scene, hit, wi));
}
static int sample_asymmetric(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out)
{
    int some = lc_bsdf_sample(scene, hit, sampler, out);
    if (some && !out->is_delta)
        out->value = eval_asymmetric(scene, hit, out->wi);
    return some;
}

static int sample_glass_loses(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out)
{
    int some = lc_bsdf_sample(scene, hit, sampler, out);
    if (some && out->lobe == LC_GLASS)
        out->value = times(0.99, out->value);
    return some;
}

static int is_reflected(const lc_hit *hit, const lc_scatter *s)
{
    return lc_dot(hit->n, hit->wo) * lc_dot(hit->n, s->wi) > 0;
}

static int sample_schlick(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out)
{
    int some = lc_bsdf_sample(scene, hit, sampler, out);
    if (!some || out->lobe != LC_GLASS)
        return some;
    lc_material m = lc_material_at(scene, hit);
    double f0 = (m.ior - 1) / (m.ior + 1) * ((m.ior - 1) / (m.ior + 1));
    double r = f0 + (1 - f0) * pow(1 - fabs(lc_dot(hit->n, hit->wo)), 5);
    double value = m.glass * (is_reflected(hit, out) ? r : (1 - r) / (m.ior * m.ior));
    out->value = lc_color(value, value, value);
    return 1;
}

static int is_total(const lc_scene *scene, const lc_hit *hit)
{
    lc_material m = lc_material_at(scene, hit);
    return m.glass > 0 && lc_fresnel(fabs(lc_dot(hit->n, hit->wo)), m.ior) == 1;
}
static int sample_total_is_absorbed(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out)
{
    return !is_total(scene, hit) && lc_bsdf_sample(scene, hit, sampler, out);
}
static int sample_total_is_black(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out)
{
    int some = lc_bsdf_sample(scene, hit, sampler, out);
    if (some && is_total(scene, hit))
        out->value = lc_black();
    return some;
}

static int sample_without_eta2(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out)
{
    int some = lc_bsdf_sample(scene, hit, sampler, out);
    double ior = lc_material_at(scene, hit).ior;
    if (some && out->lobe == LC_GLASS && !is_reflected(hit, out))
        out->value = times(ior * ior, out->value);
    return some;
}

static int sample_eta_inverted(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out)
{
    int some = lc_bsdf_sample(scene, hit, sampler, out);
    if (some && out->lobe == LC_GLASS && !is_reflected(hit, out))
        lc_refract(hit->wo, hit->n, 1 / lc_material_at(scene, hit).ior, &out->wi);
    return some;
}

static int sample_mirror_gains(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out)
{
    int some = lc_bsdf_sample(scene, hit, sampler, out);
    if (some && out->lobe == LC_MIRROR)
        out->value = times(1.1, out->value);
    return some;
}

/* Uniform directions that claim to be cosine-weighted. */
static int sample_uniform(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out)
{
    int some = lc_bsdf_sample(scene, hit, sampler, out);
    if (!some || out->is_delta)
        return some;
    double u = lc_next(sampler), v = lc_next(sampler);
    out->wi = lc_uniform_hemisphere(lc_facing(hit->n, hit->wo), u, v);
    out->pdf = lc_bsdf_pdf(scene, hit, out->wi);
    return 1;
}

/* A cosine to the power 1.1: a shape that is off by a few per cent. */
static int sample_shape_is_off(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out)
{
    int some = lc_bsdf_sample(scene, hit, sampler, out);
    if (!some || out->is_delta)
        return some;
    double u = lc_next(sampler), v = lc_next(sampler);
    out->wi = lc_cosine_hemisphere(lc_facing(hit->n, hit->wo), 1 - pow(1 - u, 2 / 2.1), v);
    out->pdf = lc_bsdf_pdf(scene, hit, out->wi);
    return 1;
}

static int sample_below(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out)
{
    int some = lc_bsdf_sample(scene, hit, sampler, out);
    if (some && !out->is_delta && lc_next(sampler) < 1e-3)
        out->wi = lc_neg(out->wi);
    return some;
}

static int sample_other_pdf(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out)
{
    int some = lc_bsdf_sample(scene, hit, sampler, out);
    if (some && !out->is_delta)
        out->pdf *= 1.001;
    return some;
}

/* Reflects as often as it transmits, and says F. */
static int sample_coin(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out)
{
    int some = lc_bsdf_sample(scene, hit, sampler, out);
    if (!some || out->lobe != LC_GLASS || out->pdf > 0.999)
        return some;
    double reflects = lc_next(sampler);
    for (int k = 0; k < 4096 && is_reflected(hit, out) != (reflects < 0.5); ++k)
        lc_bsdf_sample(scene, hit, sampler, out);
    return 1;
}

static int sample_leaks(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out)
{
    int some = lc_bsdf_sample(scene, hit, sampler, out);
    return some && lc_next(sampler) >= 1e-3;
}

/* ---- rough mirrors ---- */

/* Smith's G1 of the direction, from the closed form's own tangents. */
static double unmasked(const lc_scene *scene, const lc_hit *hit, lc_vec3 w)
{
    double c = fabs(lc_dot(hit->n, w)), a = lc_material_at(scene, hit).alpha;
    return 2 / (1 + sqrt(1 + a * a * (1 - c * c) / (c * c)));
}

static lc_rgb eval_never_masked(const lc_scene *scene, const lc_hit *hit, lc_vec3 wi)
{
    return times(1 / (unmasked(scene, hit, wi) * unmasked(scene, hit, hit->wo)), lc_bsdf_eval(scene, hit, wi));
}
static int sample_never_masked(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out)
{
    int some = lc_bsdf_sample(scene, hit, sampler, out);
    if (some)
        out->value = eval_never_masked(scene, hit, out->wi);
    return some;
}

static lc_rgb eval_masked_once(const lc_scene *scene, const lc_hit *hit, lc_vec3 wi)
{
    return times(1 / unmasked(scene, hit, wi), lc_bsdf_eval(scene, hit, wi));
}
static int sample_masked_once(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out)
{
    int some = lc_bsdf_sample(scene, hit, sampler, out);
    if (some)
        out->value = eval_masked_once(scene, hit, out->wi);
    return some;
}

/* The density of the facet, not of the direction: no Jacobian 4 (wo . h). */
static double pdf_of_facets(const lc_scene *scene, const lc_hit *hit, lc_vec3 wi)
{
    return 4 * lc_dot(hit->wo, lc_normalize(lc_add(hit->wo, wi))) * lc_bsdf_pdf(scene, hit, wi);
}
static int sample_facets(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out)
{
    int some = lc_bsdf_sample(scene, hit, sampler, out);
    if (some)
        out->pdf = pdf_of_facets(scene, hit, out->wi);
    return some;
}

/* All facets, by D cos, where pdf() says those that wo sees (Walter et al. 2007, eq. 35, 36). */
static int sample_all_normals(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out)
{
    double a = lc_material_at(scene, hit).alpha;
    if (!lc_bsdf_sample(scene, hit, sampler, out))
        return 0;
    for (int k = 0; k < 4096; ++k) {
        double u = lc_next(sampler), v = lc_next(sampler), cosine = 1 / sqrt(1 + a * a * u / (1 - u));
        lc_vec3 m = lc_uniform_hemisphere(lc_facing(hit->n, hit->wo), 1 - cosine, v);
        out->wi = lc_reflect(hit->wo, m);
        out->pdf = lc_bsdf_pdf(scene, hit, out->wi);
        out->value = lc_bsdf_eval(scene, hit, out->wi);
        if (lc_dot(m, hit->wo) > 1e-6 && out->pdf > 0)
            break;
    }
    return 1;
}

/* Draws again below the horizon, and forgets that this makes all else likelier. */
static int sample_above_only(const lc_scene *scene, const lc_hit *hit, lc_sampler *sampler, lc_scatter *out)
{
    int some = lc_bsdf_sample(scene, hit, sampler, out);
    for (int k = 0; k < 4096 && some && lc_dot(hit->n, out->wi) * lc_dot(hit->n, hit->wo) <= 0; ++k)
        some = lc_bsdf_sample(scene, hit, sampler, out);
    return some;
}

static const struct {
    const char *name, *material;
    lc_bsdf_functions bsdf;
    const char *blames; /* what the reason must name */
} mutants[] = {
    {"pdf not normalised", "diffuse_half", {lc_bsdf_eval, pdf_half, sample_pdf_half}, "integral of pdf()"},
    {"pdf not normalised", "blend", {lc_bsdf_eval, pdf_half, sample_pdf_half}, "integral of pdf()"},
    {"f without 1/pi", "diffuse_red", {eval_without_pi, lc_bsdf_pdf, sample_without_pi}, "directional albedo"},
    {"f negative", "diffuse_white", {eval_negative, lc_bsdf_pdf, lc_bsdf_sample}, "not negative"},
    {"f asymmetric", "diffuse_two_sides", {eval_asymmetric, lc_bsdf_pdf, sample_asymmetric}, "not reciprocal"},
    {"sample's value is not f", "diffuse_half", {lc_bsdf_eval, lc_bsdf_pdf, sample_without_pi}, "eval()"},
    {"glass loses 1%", "glass_1.0", {lc_bsdf_eval, lc_bsdf_pdf, sample_glass_loses}, "what glass transmits"},
    {"glass loses 1%", "glass_1.5", {lc_bsdf_eval, lc_bsdf_pdf, sample_glass_loses}, "what glass"},
    {"Schlick", "glass_1.33", {lc_bsdf_eval, lc_bsdf_pdf, sample_schlick}, "Fresnel"},
    {"Schlick", "blend", {lc_bsdf_eval, lc_bsdf_pdf, sample_schlick}, "Fresnel"},
    {"total reflection absorbs", "glass_1.5", {lc_bsdf_eval, lc_bsdf_pdf, sample_total_is_absorbed}, "albedo"},
    {"total reflection is black", "glass_2.4", {lc_bsdf_eval, lc_bsdf_pdf, sample_total_is_black}, "glass reflects"},
    {"no eta^2", "glass_1.5", {lc_bsdf_eval, lc_bsdf_pdf, sample_without_eta2}, "what glass transmits"},
    {"eta inverted", "glass_in_water", {lc_bsdf_eval, lc_bsdf_pdf, sample_eta_inverted}, "Snell"},
    {"mirror gains", "mirror_tinted", {lc_bsdf_eval, lc_bsdf_pdf, sample_mirror_gains}, "mirror lobe"},
    {"mirror gains", "mirror", {lc_bsdf_eval, lc_bsdf_pdf, sample_mirror_gains}, "mirror lobe is 1.1"},
    {"uniform, says cosine", "diffuse_half", {lc_bsdf_eval, lc_bsdf_pdf, sample_uniform}, "do not follow pdf()"},
    {"cosine to the 1.1", "diffuse_half", {lc_bsdf_eval, lc_bsdf_pdf, sample_shape_is_off}, "do not follow pdf()"},
    {"one in 1000 below", "diffuse_half", {lc_bsdf_eval, lc_bsdf_pdf, sample_below}, "pdf()"},
    {"sample's pdf is not pdf()", "mirror_half", {lc_bsdf_eval, lc_bsdf_pdf, sample_other_pdf}, "sample()'s pdf"},
    {"a coin for Fresnel", "glass_1.5", {lc_bsdf_eval, lc_bsdf_pdf, sample_coin}, "do not follow pdf()"},
    {"no masking", "glossy_0.3", {eval_never_masked, lc_bsdf_pdf, sample_never_masked}, "directional albedo"},
    {"masked once", "glossy_0.3", {eval_masked_once, lc_bsdf_pdf, sample_masked_once}, "not reciprocal"},
    {"pdf of facets", "glossy_0.05", {lc_bsdf_eval, pdf_of_facets, sample_facets}, "integral of pdf()"},
    {"pdf of facets", "glossy_1.0", {lc_bsdf_eval, pdf_of_facets, sample_facets}, "integral of pdf()"},
    {"all normals", "glossy_0.3", {lc_bsdf_eval, lc_bsdf_pdf, sample_all_normals}, "do not follow pdf()"},
    {"all normals", "glossy_1.0", {lc_bsdf_eval, lc_bsdf_pdf, sample_all_normals}, "do not follow pdf()"},
    {"only above", "glossy_1.0", {lc_bsdf_eval, lc_bsdf_pdf, sample_above_only}, "do not follow pdf()"},
    {"sample's pdf is not pdf()", "glossy_blend", {lc_bsdf_eval, lc_bsdf_pdf, sample_other_pdf}, "sample()'s pdf"},
    {"f asymmetric", "glossy_0.01", {eval_asymmetric, lc_bsdf_pdf, sample_asymmetric}, "not reciprocal"},
    {"one in 1000 lost", "mirror", {lc_bsdf_eval, lc_bsdf_pdf, sample_leaks}, "absorbed"},
};
enum { MUTANTS = sizeof mutants / sizeof mutants[0] };

START_TEST(mutant_fails_by_name)
{
    lc_row row = judge(mutants[_i].material, &mutants[_i].bsdf);
    ck_assert_msg(row.verdict == LC_ROW_FAIL, "%s on %s: verdict %s", mutants[_i].name, mutants[_i].material,
                  lc_row_verdict_name(row.verdict));
    ck_assert_msg(strstr(row.reason, mutants[_i].blames), "%s on %s: blamed on something else: %s", mutants[_i].name,
                  mutants[_i].material, row.reason);
    ck_assert_msg(strncmp(row.reason, row.scene, strlen(row.scene)) == 0, "the reason does not name the material: %s",
                  row.reason);
}
END_TEST

/* ---- levels ------------------------------------------------------------------------------------------------------- */

/* Exact tail of (X - E)^2 / E of one Poisson cell, the worst case, where chi-square says 1e-13: the check divides
 * its level by 100. */
START_TEST(chi_square_reserve_is_enough)
{
    double mean = 256, low = 0, high = 200, tail = 0;
    for (int i = 0; i < 80; ++i) {
        double middle = (low + high) / 2;
        if (lc_chi_square_log_sf(middle, 1) > log(1e-13))
            low = middle;
        else
            high = middle;
    }
    for (int k = 0; k < 2048; ++k)
        if ((k - mean) * (k - mean) / mean >= low)
            tail += exp(k * log(mean) - mean - lgamma(k + 1.0));
    ck_assert_msg(tail < 50e-13 && tail > 1e-13, "%g", tail); /* and chi-square alone would not do */
}
END_TEST

/* ---- rows of a run ------------------------------------------------------------------------------------------------ */

/* An empty scene without a name, about which no check has anything to say: rows about the host need none. */
static lc_status load_nothing(lc_scene **out, const char *name, lc_error *err)
{
    lc_scene_desc desc;
    lc_scene_desc_init(&desc);
    (void)name;
    lc_status status = lc_scene_build(out, &desc, err);
    lc_scene_desc_release(&desc);
    return status;
}

START_TEST(rows_of_a_run)
{
    lc_verify_options options;
    lc_report report;
    lc_error err = {""};
    lc_verify_options_init(&options);
    options.check = "energy";
    options.margin = 0.02;
    ck_assert_msg(lc_verify(&report, &options, load_nothing, &err) == LC_OK, "%s", err.text);
    ck_assert_int_eq(report.count, lc_energy_count());
    ck_assert_int_eq(lc_report_status(&report), LC_OK);
    for (int i = 0; i < report.count; ++i) {
        ck_assert_str_eq(report.rows[i].check, "energy");
        ck_assert_str_eq(report.rows[i].scene, lc_energy_name(i));
        ck_assert_str_eq(report.rows[i].estimator, "host");
        ck_assert_str_eq(report.rows[i].reproduce, "build/lightcheck verify --suite quick -c energy --seed 1 --margin 0.02");
    }
    lc_report_release(&report);
    options.estimator = lc_estimators[0]; /* it is not what the rows are about */
    ck_assert_int_eq(lc_verify(&report, &options, load_nothing, &err), LC_OK);
    ck_assert_int_eq(report.count, 0);
    lc_report_release(&report);
}
END_TEST

Suite *lc_suite_energy(void)
{
    Suite *suite = suite_create("energy");
    TCase *tc = tcase_create("energy");
    tcase_set_timeout(tc, 60); /* sanitizers */
    tcase_add_loop_test(tc, host_passes, 0, lc_energy_count());
    tcase_add_test(tc, too_few_samples_are_undecided);
    tcase_add_loop_test(tc, mutant_fails_by_name, 0, MUTANTS);
    tcase_add_test(tc, chi_square_reserve_is_enough);
    tcase_add_test(tc, rows_of_a_run);
    suite_add_tcase(suite, tc);
    return suite;
}
