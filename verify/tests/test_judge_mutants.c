/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Small calibrations of the judge as a whole, each of which a wrong judge fails; judge_mutants.sh plants the wrong
 * ones. Films come from estimators of a known law, so that everything from the sample to the verdict is the real
 * thing. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "verify/judge/judge_c.h"
#include "verify/tests/tests.h"

/* ---- estimators of a known mean -------------------------------------------------------------------------------- */

/* Red is uniform in [0, 2 mean): symmetric, c = 0.58. Green and blue are calm. */
static lc_rgb uniform(double mean, lc_sampler *sampler)
{
    lc_rgb value;
    value.r = 2 * mean * lc_next(sampler);
    value.g = 0.99 + 0.02 * lc_next(sampler);
    value.b = 0.99 + 0.02 * lc_next(sampler);
    return value;
}

#define UNIFORM(name, mean) \
    static lc_rgb name(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options, \
                       lc_sampler *sampler) \
    { \
        (void)scene, (void)ray, (void)hit, (void)options; \
        return uniform(mean, sampler); \
    }

UNIFORM(uniform_right, 1)
UNIFORM(uniform_high, 1.12) /* off by twice MARGIN */
UNIFORM(uniform_edge, 1.06) /* by just MARGIN */
UNIFORM(uniform_edge_low, 0.94)
UNIFORM(uniform_off, 1.036) /* by 0.6 MARGIN */

static const double MARGIN = 0.06;

static lc_rgb poisoned(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    lc_rgb value = uniform_right(scene, ray, hit, options, sampler);
    if (lc_next(sampler) < 1e-3)
        value.r = -0.1;
    return value;
}

/* Right in the mean, but a sample's numbers come again: those of batch 0 in each batch; or each two samples share theirs. */
static lc_rgb seeded_again(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                           lc_sampler *sampler)
{
    lc_sampler own;
    lc_sampler_start(&own, sampler->seed, sampler->arm, sampler->pixel, sampler->sample % LC_BLOCK);
    lc_sampler_seek(&own, LC_DIMENSION_ESTIMATOR);
    return uniform_right(scene, ray, hit, options, &own);
}

static lc_rgb shared_by_two(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                            lc_sampler *sampler)
{
    lc_sampler own;
    lc_sampler_start(&own, sampler->seed, sampler->arm, sampler->pixel, sampler->sample / 2);
    lc_sampler_seek(&own, LC_DIMENSION_ESTIMATOR);
    return uniform_right(scene, ray, hit, options, &own);
}

/* Right in the mean, but in one sample of a thousand it gives back what it took from the others; how much, and how rarely, depends on
 * the sky, such that the third moments are the same, take^3 / share^2. The difference between two skies is a small constant where none of
 * these few was met, and they have both signs. */
static lc_rgb rarely(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                     lc_sampler *sampler)
{
    double u = lc_next(sampler), take = 0.01, share = 1.0 / 1024;
    if (lc_rgb_max(lc_emission(scene, hit)) > 0) {
        u = 1 - u; /* others than there */
        take /= 2;
        share /= sqrt(8);
    }
    return lc_rgb_scale(1 - take + (u < share ? take / share : 0), uniform_right(scene, ray, hit, options, sampler));
}

/* The same over both skies, but for one sample in many, 151 times as bright as others: that share over a bright sky, and that over a dark one. */
static double seldom_share[2];
static lc_rgb seldom(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options, lc_sampler *sampler)
{
    (void)ray, (void)options;
    int is_dark = !(lc_rgb_max(lc_emission(scene, hit)) > 0);
    double u = lc_next(sampler), value = (is_dark ? 1 - u : u) < seldom_share[is_dark] ? 151 : 1;
    return lc_color(value, value, value);
}

/* Without variance, unless one meets what it adds once in ten million samples: 1% of its mean. */
static lc_rgb still(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options, lc_sampler *sampler)
{
    (void)scene, (void)ray, (void)hit, (void)options;
    double value = lc_next(sampler) < 1e-7 ? 1 + 0.01 / 1e-7 : 1;
    return lc_color(value, value, value);
}

/* Red over a sky is noisy, of mean 1; over none it is MARGIN more, which is hardly noisy. Where the mean comes out too large, so does a margin
 * of it. The others keep their
 * means, but not their samples. */
static lc_rgb noisy_and_more(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options, lc_sampler *sampler)
{
    double u = lc_next(sampler), red = lc_next(sampler) < 0.05 ? 20 : 0;
    (void)ray, (void)options;
    if (lc_rgb_max(lc_emission(scene, hit)) > 0)
        return lc_color(red, 1, 1);
    return lc_color(red + MARGIN + 0.06 * (u - 0.5), u < 0.5 ? 0.5 : 1.5, 1.5 - u); /* each varies, or nothing could be shown */
}

static lc_estimator estimator_of(const char *name, lc_radiance_fn *radiance)
{
    lc_estimator e = {LC_ABI, name, "", "", LC_DIFFUSE, LC_AREA, 1, radiance};
    return e;
}

/* ---- one claim ------------------------------------------------------------------------------------------------- */

static lc_status expect(lc_expected *out, const lc_claim *claim, const lc_scene *scene, int threads, lc_error *err)
{
    (void)claim, (void)scene, (void)threads, (void)err;
    for (int i = 0; i < 3 * out->width * out->height; ++i)
        out->rgb[i] = 1;
    return LC_OK;
}

/* In the right half; the rest is left out. */
static lc_status expect_half(lc_expected *out, const lc_claim *claim, const lc_scene *scene, int threads, lc_error *err)
{
    for (int i = 0; i < out->width * out->height; ++i)
        out->skip[i] = i % out->width < out->width / 2;
    return expect(out, claim, scene, threads, err);
}

typedef struct setup {
    int width, height;
    double margin, tolerance, false_fail, false_pass;
} setup;

static lc_scene *build_sky(int width, int height, int sky)
{
    lc_scene_desc desc;
    lc_scene *scene = NULL;
    lc_error err;
    lc_scene_desc_init(&desc);
    desc.width = width;
    desc.height = height;
    snprintf(desc.name, sizeof desc.name, "void");
    desc.has_sky = sky;
    desc.sky = sky ? lc_color(1, 1, 1) : lc_black();
    ck_assert_msg(lc_scene_build(&scene, &desc, &err) == LC_OK, "%s", err.text);
    lc_scene_desc_release(&desc);
    return scene;
}

static lc_scene *build_scene(int width, int height) { return build_sky(width, height, 0); }

static lc_row judge_with(const setup *s, lc_claim claim, uint64_t seed)
{
    static const lc_check check = {.name = "mutants"};
    lc_verify_options options;
    lc_verify_options_init(&options);
    options.false_fail = s->false_fail;
    options.false_pass = s->false_pass;
    options.seed = seed;
    options.threads = 1;
    lc_session session;
    memset(&session, 0, sizeof session);
    session.options = &options;
    session.rows = 1;
    session.margin = s->margin;
    claim.check = &check;
    claim.min_bounces = claim.max_bounces = 1;
    claim.tolerance = s->tolerance;
    claim.source = "";
    lc_row row;
    lc_error err = {""};
    memset(&row, 0, sizeof row);
    ck_assert_msg(lc_judge_claim(&row, &session, &claim, &err) == LC_OK, "%s", err.text);
    lc_session_clear(&session);
    return row;
}

/* Judges a claim about the estimator, against `other` or against 1. */
static lc_row judge_claim(const setup *s, const lc_scene *scene, const lc_estimator *estimator,
                          const lc_estimator *other, uint64_t seed)
{
    lc_claim claim = {.scene = scene, .estimator = estimator, .other = other, .expect = other ? NULL : expect};
    return judge_with(s, claim, seed);
}

/* How many of `count` claims end with the verdict. */
static int count_verdicts(const setup *s, lc_row_verdict verdict, const lc_estimator *estimator,
                          const lc_estimator *other, int count)
{
    lc_scene *scene = build_scene(s->width, s->height);
    int seen = 0;
    for (int i = 0; i < count; ++i)
        seen += judge_claim(s, scene, estimator, other, (uint64_t)i + 1).verdict == verdict;
    lc_scene_free(scene);
    return seen;
}

/* The rate at which something that should hardly happen happens, against its level. */
static void check_rate(int seen, int count, double level)
{
    lc_interval rate = lc_clopper_pearson(seen, count, 1e-3);
    ck_assert_msg(rate.lower <= level, "%d of %d, at a level of %g", seen, count, level);
}

/* ---- right and wrong estimators -------------------------------------------------------------------------------- */

START_TEST(right_passes_and_wrong_fails)
{
    const setup s = {4, 4, MARGIN, 0, 1e-6, 1e-6};
    lc_estimator right = estimator_of("right", uniform_right), high = estimator_of("high", uniform_high);
    lc_estimator again = estimator_of("again", uniform_right);
    ck_assert_int_eq(count_verdicts(&s, LC_ROW_PASS, &right, NULL, 3), 3);
    ck_assert_int_eq(count_verdicts(&s, LC_ROW_FAIL, &high, NULL, 3), 3);
    ck_assert_int_eq(count_verdicts(&s, LC_ROW_PASS, &right, &again, 3), 3);
    ck_assert_int_eq(count_verdicts(&s, LC_ROW_FAIL, &high, &again, 3), 3);
    ck_assert_int_eq(count_verdicts(&s, LC_ROW_FAIL, &right, &high, 3), 3); /* also where the hub is wrong */
}
END_TEST

/* Whatever the mean, one negative sample is one too many, and says where. */
START_TEST(bad_samples_fail)
{
    const setup s = {4, 4, MARGIN, 0, 1e-6, 1e-6};
    lc_estimator right = estimator_of("right", uniform_right), bad = estimator_of("bad", poisoned);
    lc_scene *scene = build_scene(4, 4);
    for (int two = 0; two < 3; ++two) {
        lc_row row = judge_claim(&s, scene, two == 2 ? &right : &bad, two == 0 ? NULL : two == 1 ? &right : &bad, 1);
        ck_assert_int_eq(row.verdict, LC_ROW_FAIL);
        ck_assert_msg(strstr(row.reason, "negative") != NULL, "%s", row.reason);
    }
    lc_scene_free(scene);
}
END_TEST

/* The mean may be right and every standard error wrong. A declared error keeps the pyramid silent: it is the noise
 * that tells. */
START_TEST(dependent_samples_fail)
{
    const setup s = {16, 16, MARGIN, 0.9, 1e-6, 1e-6};
    lc_estimator again = estimator_of("again", seeded_again), two = estimator_of("two", shared_by_two);
    lc_estimator right = estimator_of("right", uniform_right);
    lc_scene *scene = build_scene(16, 16);
    for (int i = 0; i < 2; ++i) {
        lc_row row = judge_claim(&s, scene, i ? &two : &again, i ? &right : NULL, 1);
        ck_assert_msg(row.verdict == LC_ROW_FAIL && strstr(row.reason, "its samples depend on each other: means of 64"),
                      "%s", row.reason);
        ck_assert_msg(strstr(row.reason, i ? "vary 2" : "vary 0 times") || strstr(row.reason, "vary 1.9"), "%s",
                      row.reason);
        ck_assert_uint_le(row.samples, 1024);
    }
    lc_scene_free(scene);
}
END_TEST

/* Its own level, and no more: independent samples, of coins that come up once in 2000 as well. */
START_TEST(independent_samples_do_not_depend)
{
    const int count = 2000, side = 12;
    int shown = 0, near = 0;
    lc_film *film;
    for (int i = 0; i < count; ++i) {
        ck_assert(lc_film_create(&film, side, side, NULL) == LC_OK);
        for (int k = 0; k < side * side; ++k)
            for (int b = 0; b < 4; ++b) {
                double block[LC_BLOCK][3];
                lc_sampler sampler;
                lc_sampler_start(&sampler, 1, (uint32_t)i, (uint32_t)k, (uint32_t)b);
                for (int j = 0; j < LC_BLOCK; ++j)
                    block[j][0] = block[j][1] = block[j][2] = lc_next(&sampler) < (i % 2 ? 0.3 : 0.01);
                lc_pixel_add(&film->pixels[k], (const double(*)[3])block, LC_BLOCK);
            }
        lc_batches batches = lc_batches_of_film(film, 0);
        shown += lc_batches_depend(&batches, 0.2);
        near += batches.log_p <= log(0.04);
        lc_film_free(film);
    }
    check_rate(shown, count, 0.2);
    check_rate(near, count, 0.04 * 1.3);
    ck_assert_msg(near > count / 100, "%d of %d: no test at all", near, count);
}
END_TEST

/* Too near to the margin to be shown within it, and declared too inaccurate to be shown wrong. */
START_TEST(undecided_is_not_a_pass)
{
    const setup s = {4, 4, MARGIN, 2 * MARGIN, 1e-6, 1e-6};
    lc_estimator high = estimator_of("edge", uniform_edge), low = estimator_of("low", uniform_edge_low);
    ck_assert_int_eq(count_verdicts(&s, LC_ROW_UNDECIDED, &high, NULL, 3), 3);
    ck_assert_int_eq(count_verdicts(&s, LC_ROW_UNDECIDED, &low, NULL, 3), 3);
}
END_TEST

/* What lies so near to the margin that the planned samples do not show it within still passes: by those in reserve. */
START_TEST(the_last_look_is_taken)
{
    const setup s = {4, 4, MARGIN, 2 * MARGIN, 1e-6, 1e-6};
    lc_estimator off = estimator_of("off", uniform_off);
    ck_assert_int_eq(count_verdicts(&s, LC_ROW_PASS, &off, NULL, 3), 3);
}
END_TEST

/* An exact row meets no more of what is rare than any other, and says what it excludes: of all paths to pixels that count. */
START_TEST(an_exact_pass_says_what_it_excludes)
{
    const setup s = {16, 8, MARGIN, 0, 1e-6, 1e-6};
    lc_estimator e = estimator_of("still", still), other = estimator_of("other", still);
    lc_scene *scene = build_scene(16, 8);
    const struct {
        lc_claim claim;
        double paths;
    } cases[] = {
        {{.may_be_still = 1, .expect = expect}, 128 * LC_LEAST_SAMPLES},
        {{.may_be_still = 1, .expect = expect_half}, 64 * LC_LEAST_SAMPLES},
        {{.exact = 1, .expect = expect}, 128 * LC_BLOCK},
        {{.exact = 1, .other = &other}, 128 * LC_BLOCK},
        {{.paired = 1, .term = {{scene, 1, 0}}, .term_count = 1, .relation = "same"}, 128 * LC_BLOCK},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        lc_claim claim = cases[i].claim;
        claim.scene = scene;
        claim.estimator = &e;
        lc_row row = judge_with(&s, claim, 1);
        ck_assert_msg(row.verdict == LC_ROW_PASS && row.exact, "%zu: %s", i, row.reason);
        ck_assert_double_eq_tol(row.missed, MARGIN * cases[i].paths / log(1e6), 1e-9 * row.missed);
    }
    lc_scene_free(scene);
}
END_TEST

/* So does any other: of its own margin, and of all paths to pixels that count. */
START_TEST(a_pass_says_what_it_excludes)
{
    const setup s = {16, 8, MARGIN, 0, 1e-6, 1e-6};
    lc_estimator right = estimator_of("right", uniform_right), again = estimator_of("again", uniform_right);
    lc_scene *scene = build_scene(16, 8);
    for (int i = 0; i < 3; ++i) {
        lc_claim claim = {.scene = scene, .estimator = &right, .expect = i == 0 ? expect : expect_half, .other = i == 2 ? &again : NULL};
        lc_row row = judge_with(&s, claim, 1);
        double pixels = i == 1 ? 64 : 128;
        ck_assert_msg(row.verdict == LC_ROW_PASS && !row.exact, "%s", row.reason);
        ck_assert_double_eq_tol(row.missed, row.margin * pixels * (double)row.samples / log(1e6), 1e-9 * row.missed);
    }
    lc_scene_free(scene);
}
END_TEST

static lc_status expect_black(lc_expected *out, const lc_claim *claim, const lc_scene *scene, int threads, lc_error *err)
{
    (void)out, (void)claim, (void)scene, (void)threads, (void)err;
    return LC_OK;
}

/* No percentage of nothing: of light where none is expected the mean is told. */
START_TEST(light_where_none_is_expected_is_said)
{
    const setup s = {16, 8, MARGIN, 0, 1e-6, 1e-6};
    lc_estimator noisy = estimator_of("noisy", uniform_right), calm = estimator_of("calm", still);
    lc_scene *scene = build_scene(16, 8);
    for (int exact = 0; exact < 2; ++exact) {
        lc_claim claim = {.scene = scene, .estimator = exact ? &calm : &noisy, .expect = expect_black, .exact = exact};
        lc_row row = judge_with(&s, claim, 1);
        ck_assert_int_eq(row.verdict, LC_ROW_FAIL);
        ck_assert_ptr_nonnull(strstr(row.reason, exact ? "pixel 0,0 has R = 1, expected exactly 0"
                                                       : "is wrong: there is light where none is expected, a mean of 1 ("));
        ck_assert_msg(!strchr(row.reason, '%') && !strstr(row.reason, "inf"), "%s", row.reason);
    }
    lc_scene_free(scene);
}
END_TEST

/* ---- error rates ------------------------------------------------------------------------------------------------ */

/* All looks and channels together keep within a budget that a single one would fill, make use of it, and no row FAILs
 * by more than its share. */
START_TEST(every_look_is_paid_for)
{
    const setup s = {1, 1, MARGIN, 0, 0.3, 1e-9};
    const int count = 300;
    lc_estimator right = estimator_of("right", uniform_right);
    lc_scene *scene = build_scene(1, 1);
    int failed = 0;
    for (int i = 0; i < count; ++i) {
        lc_row row = judge_claim(&s, scene, &right, NULL, (uint64_t)i + 1);
        if (row.verdict != LC_ROW_FAIL)
            continue;
        ++failed;
        ck_assert_msg(row.tile_log10_p <= log10(0.3 / 3 / LC_MOST_LOOKS), "FAIL at p = 1e%g", row.tile_log10_p);
    }
    lc_scene_free(scene);
    check_rate(failed, count, 0.3);
    ck_assert_msg(failed > count / 20, "%d of %d: the budget is wasted", failed, count);
}
END_TEST

/* The true difference is the margin; FAIL is out of reach. */
START_TEST(every_pass_is_paid_for)
{
    const setup s = {1, 1, MARGIN, 2 * MARGIN, 1e-6, 0.4};
    const int count = 80;
    for (int end = 0; end < 2; ++end) {
        lc_estimator edge = estimator_of("edge", end ? uniform_edge : uniform_edge_low);
        int passed = count_verdicts(&s, LC_ROW_PASS, &edge, NULL, count);
        check_rate(passed, count, 0.4);
        ck_assert_msg(passed > count / 10, "%d of %d: the budget is wasted", passed, count);
    }
}
END_TEST

/* P(|T| >= t) of n Gaussian samples, from nothing but normal tails: the expectation over the chi-square of their
 * variance, by the midpoint rule. */
static double gaussian_tail(double t, double n)
{
    double df = n - 1, sum = 0, mass = 0, width = sqrt(2 * df), step = width / 200;
    for (double x = fmax(step / 2, df - 14 * width); x < df + 14 * width; x += step) {
        double density = exp((0.5 * df - 1) * log(x / df) - 0.5 * (x - df));
        mass += density;
        sum += density * erfc(t * sqrt(0.5 * x / df));
    }
    return sum / mass;
}

/* Where Gaussian samples begin to FAIL, they do so at their level, with few samples as well. */
START_TEST(gaussian_tails_are_students)
{
    static const double alphas[] = {1e-2, 1e-6, 1e-11}, sizes[] = {16, 256, 4096};
    for (int a = 0; a < 3; ++a)
        for (int k = 0; k < 3; ++k) {
            double n = sizes[k], low = 0, high = 200;
            for (int i = 0; i < 60; ++i) {
                double t = 0.5 * (low + high);
                lc_pixel p;
                memset(&p, 0, sizeof p);
                p.n = (uint64_t)n;
                p.c[0].m2 = n - 1;
                lc_estimate e = lc_estimate_one(&p, 1, 0, t / sqrt(n), 0);
                lc_pyramid_plan plan;
                lc_pyramid out;
                lc_pyramid_plan_init(&plan, alphas[a], 1e-6);
                plan.least[0] = 2;
                ck_assert(lc_pyramid_judge(&out, &e, 1, 1, &plan, NULL) == LC_OK);
                if (out.verdict == LC_FAIL)
                    high = t;
                else
                    low = t;
            }
            double rate = gaussian_tail(high, n) / alphas[a];
            ck_assert_msg(rate <= 1 && rate > 0.8, "alpha %g, n %g: %g of it", alphas[a], n, rate);
        }
}
END_TEST

/* Two equally noisy films, the first brighter by a margin that is measured in the second: the noise of the margin
 * counts as well. */
START_TEST(a_measured_margin_has_noise)
{
    const double margin = 0.5, level = 0.05, n = 4096;
    const int count = 1500;
    int passed = 0;
    for (int i = 0; i < count; ++i) {
        lc_estimate e;
        lc_pyramid_plan plan;
        lc_pyramid out;
        lc_sampler sampler;
        lc_sampler_start(&sampler, 1, 0, 0, (uint32_t)i);
        lc_pixel p[2];
        memset(p, 0, sizeof p);
        for (int arm = 0; arm < 2; ++arm) {
            double u = lc_next(&sampler), v = lc_next(&sampler); /* Box and Muller */
            p[arm].n = (uint64_t)n;
            p[arm].c[0].mean = (arm ? 1 : 1 + margin) + 2 * sqrt(-2 * log(1 - u) / n) * cos(2 * LC_PI * v);
            p[arm].c[0].m2 = 4 * (n - 1);
        }
        e = lc_estimate_two(&p[0], 1, &p[1], 1, 0, 2 * margin);
        lc_pyramid_plan_init(&plan, 1e-6, level);
        plan.margin[0] = margin * p[1].c[0].mean;
        plan.relative = margin;
        ck_assert(lc_pyramid_judge(&out, &e, 1, 1, &plan, NULL) == LC_OK);
        passed += out.verdict == LC_PASS;
    }
    check_rate(passed, count, level);
    ck_assert_msg(passed > 0.6 * level * count, "%d of %d: wasted", passed, count);
}
END_TEST

/* Third moments of differences cancel, so that in a tile no guard sees what is missing. */
START_TEST(rare_differences_do_not_fail)
{
    const setup s = {16, 16, MARGIN, 0, 1e-6, 1e-6};
    lc_estimator e = estimator_of("rarely", rarely);
    lc_scene *dark = build_scene(16, 16), *bright = build_sky(16, 16, 1);
    lc_claim claim = {.scene = dark, .estimator = &e, .term = {{bright, 1, 0}}, .term_count = 1, .paired = 1, .relation = "sky"};
    int passed = 0;
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        lc_row row = judge_with(&s, claim, seed);
        ck_assert_msg(row.verdict != LC_ROW_FAIL && !row.exact, "%s", row.reason);
        passed += row.verdict == LC_ROW_PASS;
    }
    ck_assert_int_gt(passed, 10);
    claim.term[0].factor = 1.2;
    ck_assert_int_eq(judge_with(&s, claim, 1).verdict, LC_ROW_FAIL);
    lc_scene_free(dark);
    lc_scene_free(bright);
}
END_TEST

/* So few that no third moment can be believed: they are bounded by their size, once there are samples enough; what they add when they are
 * as much as the margin is not taken for nothing. */
START_TEST(few_differences_are_bounded)
{
    const setup s = {16, 16, MARGIN, 0, 1e-6, 1e-6};
    lc_estimator e = estimator_of("seldom", seldom);
    lc_scene *dark = build_scene(16, 16), *bright = build_sky(16, 16, 1);
    lc_claim claim = {.scene = dark, .estimator = &e, .term = {{bright, 1, 0}}, .term_count = 1, .paired = 1, .relation = "sky"};
    int bounded = 0;
    seldom_share[0] = seldom_share[1] = 5e-6;
    for (uint64_t seed = 1; seed <= 40; ++seed) {
        lc_row row = judge_with(&s, claim, seed);
        ck_assert_msg(row.verdict == LC_ROW_PASS && row.samples <= 4096, "seed %d, %d samples: %s", (int)seed, (int)row.samples, row.reason);
        bounded += !row.exact;
        ck_assert(row.exact || (row.low > 1 - MARGIN && row.low < row.ratio && row.ratio < row.high && row.high < 1 + MARGIN));
    }
    ck_assert_int_ge(bounded, 3);
    seldom_share[0] += MARGIN / 150;
    for (uint64_t seed = 1; seed <= 6; ++seed)
        ck_assert(judge_with(&s, claim, seed).verdict == LC_ROW_FAIL);
    lc_scene_free(dark);
    lc_scene_free(bright);
}
END_TEST

/* The margin of a relation is of a mean that is measured, too: what is off by just the margin does not pass where that mean came out high. */
START_TEST(a_measured_margin_of_a_relation_has_noise)
{
    const double level = 0.05;
    const setup s = {1, 1, MARGIN, 2 * MARGIN, 1e-9, level};
    const int count = 100;
    lc_estimator e = estimator_of("noisy", noisy_and_more);
    lc_scene *dark = build_scene(1, 1), *bright = build_sky(1, 1, 1);
    lc_claim claim = {.scene = dark, .estimator = &e, .term = {{bright, 1, 0}}, .term_count = 1, .paired = 1, .relation = "sky"};
    int passed = 0;
    for (int i = 0; i < count; ++i) {
        lc_row row = judge_with(&s, claim, (uint64_t)i + 1);
        ck_assert_msg(row.verdict != LC_ROW_FAIL && !row.exact, "%s", row.reason);
        passed += row.verdict == LC_ROW_PASS;
    }
    check_rate(passed, count, level);
    lc_scene_free(dark);
    lc_scene_free(bright);
}
END_TEST

Suite *lc_suite_judge_mutants(void)
{
    Suite *suite = suite_create("judge_mutants");
    TCase *cases = tcase_create("judge");
    tcase_add_test(cases, right_passes_and_wrong_fails);
    tcase_add_test(cases, bad_samples_fail);
    tcase_add_test(cases, dependent_samples_fail);
    tcase_add_test(cases, independent_samples_do_not_depend);
    tcase_add_test(cases, undecided_is_not_a_pass);
    tcase_add_test(cases, the_last_look_is_taken);
    tcase_add_test(cases, an_exact_pass_says_what_it_excludes);
    tcase_add_test(cases, a_pass_says_what_it_excludes);
    tcase_add_test(cases, light_where_none_is_expected_is_said);
    tcase_add_test(cases, every_look_is_paid_for);
    tcase_add_test(cases, every_pass_is_paid_for);
    tcase_add_test(cases, gaussian_tails_are_students);
    tcase_add_test(cases, a_measured_margin_has_noise);
    tcase_add_test(cases, rare_differences_do_not_fail);
    tcase_add_test(cases, few_differences_are_bounded);
    tcase_add_test(cases, a_measured_margin_of_a_relation_has_noise);
    tcase_set_timeout(cases, 60);
    suite_add_tcase(suite, cases);
    return suite;
}
