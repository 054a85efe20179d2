/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whole runs of the harness, at 16x16 pixels: the wrong is found and named, the right is not called wrong, and a row is the same row
 * wherever it stands. */
#include "verify/tests/tests.h"

#include <stdio.h>
#include <stdlib.h>

#include "estimators/registry.h"
#include "verify/checks/family.h"
#include "verify/judge/judge_c.h"
#include "verify/stats/stats.h"
#include "verify/tests/load_help.h"
#include "verify/tests/scene_help.h"

enum { SIDE = 16 };

static lc_status load_small(lc_scene **out, const char *name, lc_error *err)
{
    return load_sized(out, name, SIDE, err);
}

/* The quick suite, but no row may take more than 4096 samples a pixel. */
static const lc_suite tiny = {"quick", 0.005, 4096.0 * SIDE *SIDE};

static lc_report verify_suite(const lc_suite *suite, const lc_estimator *estimator, const char *check,
                              const char *scene, double margin, uint64_t seed)
{
    lc_verify_options options;
    lc_report report;
    lc_error err = {""};
    lc_verify_options_init(&options);
    options.suite = suite;
    options.estimator = estimator;
    options.check = check;
    options.scene = scene;
    options.margin = margin;
    options.seed = seed;
    ck_assert_msg(lc_verify(&report, &options, load_small, &err) == LC_OK, "%s", err.text);
    return report;
}

static lc_report verify(const lc_estimator *estimator, const char *check, const char *scene, double margin,
                        uint64_t seed)
{
    return verify_suite(lc_suite_find("quick"), estimator, check, scene, margin, seed);
}

static const lc_estimator *find(const char *name)
{
    for (const lc_estimator *const *e = lc_estimators; *e; ++e)
        if (strcmp((*e)->name, name) == 0)
            return *e;
    ck_abort_msg("no estimator %s", name);
    return NULL;
}

/* ---- right and wrong --------------------------------------------------------------------------------------------- */

/* POV-Ray's images are of 64x64 pixels: here its rows fail for that alone, and show nothing. */
static int counts(const lc_row *row) { return strcmp(row->check, "povray") != 0; }

static int has_verdict(const lc_report *report, lc_row_verdict verdict)
{
    int count = 0;
    for (int i = 0; i < report->count; ++i)
        count += counts(&report->rows[i]) && report->rows[i].verdict == verdict;
    return count;
}

/* At a wide margin, and without the scenes whose expected values take long. */
START_TEST(right_estimators_are_not_called_wrong)
{
    static const char *const left_out[] = {"occluder",      "cornell",     "plane_disk",      "plane_rectangle",
                                           "textured_lamp", "five_lights", "furnace_checker", "plane_cube"};
    int passed = 0, rows = 0;
    for (const char *const *scene = lc_suite_scenes; *scene; ++scene) {
        int skip = 0;
        for (size_t i = 0; i < sizeof left_out / sizeof left_out[0]; ++i)
            skip |= strcmp(*scene, left_out[i]) == 0;
        if (skip)
            continue;
        lc_report report = verify(NULL, NULL, *scene, 0.25, 1);
        for (int i = 0; i < report.count; ++i)
            ck_assert_msg(!counts(&report.rows[i]) || report.rows[i].verdict != LC_ROW_FAIL, "%s: %s",
                          report.rows[i].check, report.rows[i].reason);
        passed += has_verdict(&report, LC_ROW_PASS);
        for (int i = 0; i < report.count; ++i)
            rows += counts(&report.rows[i]);
        lc_report_release(&report);
    }
    ck_assert_msg(passed > rows * 3 / 4, "only %d of %d rows passed", passed, rows);
    ck_assert_int_ge(rows, 60);
}
END_TEST

static lc_rgb two_percent_more(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                               lc_sampler *sampler)
{
    return lc_rgb_scale(1.02, find("light_direct")->radiance(scene, ray, hit, options, sampler));
}

/* All that bears on the verdict, and nothing that is as usual; no path is too long. */
START_TEST(a_row_names_its_command)
{
    char given[4000], line[8192];
    lc_verify_options o;
    lc_scene *scene;
    lc_adapter adapter = {.seconds = LC_ADAPTER_SECONDS, .path = "/opt/a b/x.sh"};
    lc_claim claim = {.check = lc_checks[0], .estimator = find("path")};
    static lc_row row;
    ck_assert_int_eq(load_small(&scene, "plane_disk", NULL), LC_OK);
    claim.scene = scene;
    memset(given, '\'', sizeof given - 1);
    given[sizeof given - 1] = 0;
    lc_verify_options_init(&o);
    lc_row_reproduce(&row, &o, &claim);
    snprintf(line, sizeof line, "build/lightcheck verify --suite quick -c %s -e path --scene plane_disk --seed 1", lc_checks[0]->name);
    ck_assert_str_eq(row.reproduce, line);

    o.estimator = claim.estimator;
    o.given = given;
    o.is_jailed = 1;
    o.margin = 0.1;
    o.false_fail = o.false_pass = 2.5e-4;
    lc_row_reproduce(&row, &o, &claim);
    const char *end = " --jail --scene plane_disk --seed 1 --margin 0.1 --budget 0.00025";
    ck_assert_uint_gt(strlen(row.reproduce), 4 * (sizeof given - 1));
    ck_assert_str_eq(row.reproduce + strlen(row.reproduce) - strlen(end), end);

    for (int slow = 0; slow < 2; ++slow) {
        lc_verify_options_init(&o);
        o.renderer = &adapter;
        o.estimator = claim.estimator = &adapter.estimator;
        adapter.seconds = slow ? 1200 : LC_ADAPTER_SECONDS;
            lc_row_reproduce(&row, &o, &claim);
        ck_assert_ptr_nonnull(strstr(row.reproduce, slow ? " --renderer '/opt/a b/x.sh' --seconds 1200 --scene plane_disk --seed 1"
                                                         : " --renderer '/opt/a b/x.sh' --scene plane_disk --seed 1"));
    }
    lc_scene_free(scene);
}
END_TEST

static lc_rgb black(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                    lc_sampler *sampler)
{
    (void)scene, (void)ray, (void)hit, (void)options, (void)sampler;
    return lc_black();
}

/* One bad sample in the whole run. */
static lc_rgb nan_once(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    if (sampler->pixel == 7 * SIDE + 3 && sampler->sample == 41 && options->max_bounces == 1)
        return lc_color(1, NAN, 1);
    return find("light_direct")->radiance(scene, ray, hit, options, sampler);
}

static lc_estimator disguise(const char *name, lc_radiance_fn *radiance)
{
    lc_estimator e = *find("light_direct");
    e.name = name;
    e.radiance = radiance;
    return e;
}

START_TEST(two_percent_more_is_found_and_named)
{
    lc_estimator e = disguise("mine", two_percent_more);
    lc_report report = verify(&e, "analytic", "plane_rectangle", 0, 1);
    ck_assert_int_eq(report.count, 1);
    const lc_row *row = &report.rows[0];
    ck_assert_int_eq(row->verdict, LC_ROW_FAIL);
    ck_assert_double_eq_tol(row->ratio, 1.02, 0.005);
    ck_assert(row->low > 1 && row->low < 1.02 && row->high > 1.015);
    ck_assert_msg(strstr(row->reason, "mine on plane_rectangle is wrong"), "%s", row->reason);
    ck_assert_msg(strstr(row->reason, "+2") || strstr(row->reason, "+1.9"), "%s", row->reason);
    ck_assert_msg(strstr(row->reproduce, "-c analytic -e mine --scene plane_rectangle --seed 1"), "%s", row->reproduce);
    ck_assert_int_eq(lc_report_status(&report), LC_WRONG);
    lc_report_release(&report);
}
END_TEST

START_TEST(one_nan_is_found_and_placed)
{
    lc_estimator e = disguise("mine", nan_once);
    lc_report report = verify(&e, "analytic", "plane_rectangle", 0, 5);
    ck_assert_int_eq(report.count, 1);
    ck_assert_int_eq(report.rows[0].verdict, LC_ROW_FAIL);
    ck_assert_msg(strstr(report.rows[0].reason, "1 samples are NaN") != NULL, "%s", report.rows[0].reason);
    ck_assert_msg(strstr(report.rows[0].reason, "at pixel 3,7 sample 41 seed 5") != NULL, "%s", report.rows[0].reason);
    lc_report_release(&report);
}
END_TEST

/* Without variance there is no test, and light may be too rare to be met: undecided, but never a pass; and wrong where the scene says
 * that nothing is left to chance. */
START_TEST(black_does_not_pass_where_there_is_light)
{
    static const char *const by_chance[] = {"plane_point", "plane_rectangle"}, *const surely[] = {"plane_directional",
                                                                                                  "furnace_sphere"};
    lc_estimator e = disguise("mine", black);
    for (int i = 0; i < 2; ++i) {
        lc_report report = verify(&e, "analytic", by_chance[i], 0, 1);
        ck_assert_int_eq(report.count, 1);
        ck_assert_int_eq(report.rows[0].verdict, LC_ROW_UNDECIDED);
        ck_assert_msg(strstr(report.rows[0].reason, "not one of its samples carries light") != NULL, "%s",
                      report.rows[0].reason);
        lc_report_release(&report);
        report = verify(&e, NULL, surely[i], 0, 1);
        ck_assert_msg(has_verdict(&report, LC_ROW_FAIL) > 0, "%s: not found", surely[i]);
        lc_report_release(&report);
    }
}
END_TEST

/* With too few samples for its margin a row is undecided, and the run ends with 3. */
START_TEST(what_cannot_be_shown_is_undecided)
{
    lc_report report = verify_suite(&tiny, find("light_direct"), "analytic", "plane_rectangle", 1e-5, 1);
    ck_assert_int_eq(report.count, 1);
    ck_assert_int_eq(report.rows[0].verdict, LC_ROW_UNDECIDED);
    ck_assert_msg(strstr(report.rows[0].reason, "undecided after") != NULL, "%s", report.rows[0].reason);
    ck_assert(report.rows[0].samples >= 1024 && report.rows[0].samples <= 4096);
    ck_assert_int_eq(lc_report_status(&report), LC_UNDECIDED);
    lc_report_release(&report);
}
END_TEST

/* ---- the same row everywhere --------------------------------------------------------------------------------------- */

static void ck_same_row(const lc_row *a, const lc_row *b)
{
    ck_assert_str_eq(a->check, b->check);
    ck_assert_str_eq(a->scene, b->scene);
    ck_assert_str_eq(a->estimator, b->estimator);
    ck_assert_str_eq(a->reason, b->reason);
    ck_assert_str_eq(a->reproduce, b->reproduce);
    ck_assert_msg(a->verdict == b->verdict && a->samples == b->samples && a->paths == b->paths &&
                      a->channel == b->channel && memcmp(&a->ratio, &b->ratio, sizeof a->ratio) == 0 &&
                      memcmp(&a->low, &b->low, sizeof a->low) == 0 && memcmp(&a->high, &b->high, sizeof a->high) == 0 &&
                      a->margin == b->margin && a->expected == b->expected && a->tile_x == b->tile_x &&
                      a->tile_y == b->tile_y && a->tile_width == b->tile_width,
                  "%s %s %s: ratio %.17g against %.17g, samples %llu against %llu", a->check, a->scene, a->estimator,
                  a->ratio, b->ratio, (unsigned long long)a->samples, (unsigned long long)b->samples);
}

START_TEST(a_row_is_the_same_alone_and_again)
{
    lc_report whole = verify(NULL, NULL, "lamp_100w", 0.2, 3);
    lc_report again = verify(NULL, NULL, "lamp_100w", 0.2, 3);
    lc_report other = verify(NULL, NULL, "lamp_100w", 0.2, 4);
    int differ = 0;
    ck_assert(whole.count >= 3 && whole.count == again.count && whole.count == other.count);
    for (int i = 0; i < whole.count; ++i) {
        const lc_row *row = &whole.rows[i];
        ck_same_row(row, &again.rows[i]);
        differ += !row->exact && row->ratio != other.rows[i].ratio;
        lc_report alone = verify(find(row->estimator), row->check, row->scene, 0.2, 3);
        int found = 0;
        for (int k = 0; k < alone.count; ++k) /* a check may make several claims about one pair */
            if (alone.rows[k].samples == row->samples && strcmp(alone.rows[k].source, row->source) == 0 &&
                alone.rows[k].ratio == row->ratio) {
                ck_same_row(row, &alone.rows[k]);
                found = 1;
            }
        ck_assert_msg(found || row->exact, "%s %s %s: another row when alone", row->check, row->scene, row->estimator);
        lc_report_release(&alone);
    }
    ck_assert_int_gt(differ, 0); /* another seed, other numbers */
    ck_assert_str_eq(whole.budget, again.budget);
    lc_report_release(&whole);
    lc_report_release(&again);
    lc_report_release(&other);
}
END_TEST

/* The shards of a run are its rows, each once and the same. */
START_TEST(shards_are_the_run)
{
    lc_report whole = verify(NULL, "emission", NULL, 0, 3);
    int found = 0, full = 0;
    for (int shard = 0; shard < 5; ++shard) {
        lc_verify_options options;
        lc_report part;
        lc_error err = {""};
        lc_verify_options_init(&options);
        options.check = "emission";
        options.seed = 3;
        options.shard = shard;
        options.shards = 5;
        ck_assert_msg(lc_verify(&part, &options, load_small, &err) == LC_OK, "%s", err.text);
        ck_assert_str_eq(part.budget, whole.budget);
        for (int i = 0; i < part.count; ++i)
            for (int k = 0; k < whole.count; ++k)
                if (strcmp(part.rows[i].scene, whole.rows[k].scene) == 0 &&
                    strcmp(part.rows[i].estimator, whole.rows[k].estimator) == 0) {
                    ck_same_row(&part.rows[i], &whole.rows[k]);
                    ++found;
                }
        full += part.count == whole.count;
        lc_report_release(&part);
    }
    ck_assert_int_gt(whole.count, 20);
    ck_assert_int_eq(found, whole.count);
    ck_assert_int_eq(full, 0);
    lc_report_release(&whole);
}
END_TEST

/* ---- tables --------------------------------------------------------------------------------------------------------- */

/* The statistical claims that a suite makes about a scene. */
static lc_claims claims_about(const lc_suite *suite, const lc_scene *scene)
{
    lc_claims claims = {.count = 0};
    lc_error err = {""};
    for (const lc_estimator *const *e = lc_estimators; *e; ++e)
        for (const lc_check *const *c = lc_checks; *c; ++c)
            if ((*c)->plan)
                ck_assert_msg((*c)->plan(*c, &claims, scene, *e, &err) == LC_OK, "%s", err.text);
    int kept = 0;
    for (int i = 0; i < claims.count; ++i)
        if (!claims.items[i].exact && lc_suite_has(suite, &claims.items[i]))
            claims.items[kept++] = claims.items[i];
    claims.count = kept;
    return claims;
}

/* 1 when the claim takes the film of `estimator` that `of` takes: as what it is about, or as its hub. */
static int takes_film(const lc_claim *claim, const lc_estimator *estimator, const lc_claim *of)
{
    return (claim->estimator == estimator || claim->other == estimator) && claim->scene == of->scene &&
           claim->min_bounces == of->min_bounces && claim->max_bounces == of->max_bounces && !claim->term_count &&
           !claim->decide;
}

static double margin_of(const lc_suite *suite, const lc_claim *claim, double c)
{
    return fmax(suite->margin * (claim->slack > 0 ? claim->slack : 1) * fmax(1, c), claim->margin);
}

/* Films of a relation: over the scene and each term; paired, the scene's once more. Of powers of two all samples agree, so that one
 * block is enough; else the first look is. */
static double planned_of_relation(const lc_suite *suite, const lc_claim *claim)
{
    const lc_scene_desc *desc = lc_scene_description(claim->scene);
    double pixels = (double)desc->width * desc->height, arms = 1 + claim->term_count + (claim->paired ? 1 : 0);
    if (claim->paired && lc_relation_is_sharp(claim))
        return arms * LC_BLOCK * pixels;
    return arms * fmax(LC_LEAST_SAMPLES * pixels,
                       (double)lc_planned_samples(1.5, 1.5 * margin_of(suite, claim, 1), 1));
}

/* c as the judge takes it: from the table, else from a pilot. */
static double noise_of(const lc_claim *claim, const lc_estimator *estimator)
{
    const lc_scene_desc *desc = lc_scene_description(claim->scene);
    double c = claim->min_bounces == 1 ? lc_cell_noise(desc->name, estimator->name, claim->max_bounces) : NAN;
    lc_film *film;
    lc_error err = {""};
    if (!isnan(c))
        return c;
    lc_render_options options = {
        .min_bounces = claim->min_bounces, .max_bounces = claim->max_bounces, .seed = 1, .count = LC_BLOCK};
    ck_assert_msg(lc_film_create(&film, SIDE, SIDE, &err) == LC_OK, "%s", err.text);
    ck_assert_msg(lc_render(film, claim->scene, estimator, &options, &err) == LC_OK, "%s", err.text);
    c = lc_film_noise(film);
    lc_film_free(film);
    return c;
}

static double planned_for(const lc_suite *suite, const lc_claim *claim)
{
    double c = noise_of(claim, claim->estimator), hub = claim->other ? noise_of(claim, claim->other) : 0;
    double margin = margin_of(suite, claim, c);
    double room = claim->margin > 0 ? margin - claim->tolerance : margin;
    return (double)lc_planned_samples(hypot(c, hub), room, 1);
}

/* What a suite plans to render of a scene: each film once, hubs as well, for the claim that wants most of it. */
static double planned_of(const lc_suite *suite, const char *name)
{
    lc_scene *scene;
    lc_error err = {""};
    double planned = 0;
    ck_assert_msg(lc_suite_scene(&scene, name, 1, load_small, &err) == LC_OK, "%s", err.text);
    lc_claims claims = claims_about(suite, scene);
    for (int i = 0; i < claims.count; ++i) {
        const lc_claim *claim = &claims.items[i];
        if (claim->decide || claim->term_count) {
            planned += claim->decide ? 2e6 /* at most, by checks/convergence.c */ : planned_of_relation(suite, claim);
            continue;
        }
        for (int arm = 0; arm < 2; ++arm) {
            const lc_estimator *estimator = arm ? claim->other : claim->estimator;
            double most = 0;
            int is_first = estimator != NULL;
            for (int k = 0; k < i; ++k)
                is_first &= !takes_film(&claims.items[k], estimator, claim);
            for (int k = i; k < claims.count && is_first; ++k)
                if (takes_film(&claims.items[k], estimator, claim))
                    most = fmax(most, planned_for(suite, &claims.items[k]));
            planned += most;
        }
    }
    lc_claims_release(&claims);
    lc_scene_free(scene);
    return planned;
}

/* How well the full suite holds an estimator without another one's help. */
typedef struct support {
    int closed_forms;          /* scenes with light whose expected values owe nothing to sampling */
    const char *relations[32]; /* different ones */
    int relation_count;
} support;

static void add_support(support *of, const lc_claim *claim)
{
    if (claim->expect && !claim->exact && !claim->decide) /* exact: black */
        ++of->closed_forms;
    if (!claim->term_count)
        return;
    for (int i = 0; i < of->relation_count; ++i)
        if (strcmp(of->relations[i], claim->relation) == 0)
            return;
    ck_assert_int_lt(of->relation_count, 32);
    of->relations[of->relation_count++] = claim->relation;
}

/* None rests on its likeness to another, which may err as it does. */
START_TEST(each_estimator_has_a_closed_form_and_two_relations)
{
    enum { MOST = 64 };
    static support of[MOST];
    int count = 0;
    for (const char *const *name = lc_suite_scenes; *name; ++name) {
        lc_scene *scene;
        lc_error err = {""};
        ck_assert_msg(lc_suite_scene(&scene, *name, 1, load_small, &err) == LC_OK, "%s", err.text);
        lc_claims claims = claims_about(lc_suite_find("full"), scene);
        for (int i = 0; i < claims.count; ++i)
            for (int e = 0; lc_estimators[e] && e < MOST; ++e)
                if (lc_estimators[e] == claims.items[i].estimator)
                    add_support(&of[e], &claims.items[i]);
        lc_claims_release(&claims);
        lc_scene_free(scene);
    }
    for (; lc_estimators[count]; ++count) {
        ck_assert_int_lt(count, MOST);
        ck_assert_msg(of[count].closed_forms >= 1, "%s has no closed form", lc_estimators[count]->name);
        ck_assert_msg(of[count].relation_count >= 2, "%s has %d relations, not 2", lc_estimators[count]->name,
                      of[count].relation_count);
    }
}
END_TEST

START_TEST(suites_keep_their_caps)
{
    for (const lc_suite *s = lc_suites; s->name; ++s) {
        double planned = 0;
        for (const char *const *scene = lc_suite_scenes; *scene; ++scene)
            planned += planned_of(s, *scene);
        ck_assert_msg(planned <= s->most_samples, "%s: %.3g planned, cap %.3g", s->name, planned, s->most_samples);
        ck_assert_msg(planned > 0.1 * s->most_samples, "%s: only %.3g planned", s->name, planned);
        ck_assert_ptr_eq(lc_suite_find(s->name), s);
    }
    ck_assert_ptr_null(lc_suite_find("nosuch"));
}
END_TEST

/* (11 c / margin)^2 over the pixels: c = 1, 1%: 1.21 million over 4096 is 295.4. */
START_TEST(planned_samples_by_hand)
{
    ck_assert_uint_eq(lc_planned_samples(1, 0.01, 4096), 296);
    ck_assert_uint_eq(lc_planned_samples(0, 0.01, 4096), 1);
    ck_assert_uint_eq(lc_planned_samples(2, 0.02, 1), 1210000);
    ck_assert_uint_eq(lc_planned_samples(1, 1e-300, 1), (uint64_t)1 << 62);
}
END_TEST

START_TEST(cells_name_what_there_is)
{
    for (const lc_cell *cell = lc_cells; cell->scene; ++cell) {
        int known = 0;
        for (const char *const *s = lc_suite_scenes; *s; ++s)
            known |= strcmp(*s, cell->scene) == 0;
        ck_assert_msg(known, "%s is not in the suites", cell->scene);
        find(cell->estimator);
        ck_assert_msg(cell->c >= 0 && cell->c < 1000, "%s %s: c = %g", cell->scene, cell->estimator, cell->c);
        ck_assert(lc_cell_noise(cell->scene, cell->estimator, cell->max_bounces) == cell->c);
    }
    ck_assert(isnan(lc_cell_noise("nosuch", "light_direct", 1)));
}
END_TEST

/* ---- words ------------------------------------------------------------------------------------------------------- */

/* 1000 samples a pixel of the given mean, standard deviation and skewness. */
static lc_film *flat_film(uint32_t arm, double mean, double deviation, double skewness)
{
    lc_film *film;
    ck_assert_int_eq(lc_film_create(&film, SIDE, SIDE, NULL), LC_OK);
    film->arm = arm;
    film->count = 1000;
    for (int i = 0; i < SIDE * SIDE; ++i) {
        film->pixels[i].n = 1000;
        for (int c = 0; c < 3; ++c)
            film->pixels[i].c[c] = (lc_moments){.mean = mean,
                                                .m2 = 1000 * deviation * deviation,
                                                .m3 = 1000 * skewness * pow(deviation, 3)};
    }
    return film;
}

/* Two floats next to each other may be one mean; one that was merged was rounded twice. Films that were rendered are not rounded. */
START_TEST(what_files_round_is_no_difference)
{
    static const struct {
        int steps, merges, is_from_files;
        lc_row_verdict verdict;
    } cases[] = {{0, 0, 0, LC_ROW_PASS}, {1, 0, 0, LC_ROW_FAIL}, {1, 0, 1, LC_ROW_PASS},
                 {2, 0, 1, LC_ROW_FAIL}, {2, 1, 1, LC_ROW_PASS}, {3, 1, 1, LC_ROW_FAIL}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        lc_range more[2] = {{1, 3, 0, 1}, {1, 4, 0, 1}};
        lc_film *film[2] = {flat_film(1, 1, 1e-10, 0), flat_film(2, 1 + cases[i].steps * ldexp(1, -23), 1e-10, 0)};
        lc_row row = {.check = ""};
        lc_error err;
        for (int k = 0; k < 2 && cases[i].merges; ++k) {
            film[k]->more = &more[k];
            film[k]->more_count = 1;
        }
        lc_status status = cases[i].is_from_files ? lc_compare_files(&row, film[0], film[1], 0.005, 1e-6, 1e-6, &err)
                                                  : lc_compare_films(&row, film[0], film[1], 0.005, 1e-6, 1e-6, &err);
        ck_assert_msg(status == LC_OK, "%s", err.text);
        ck_assert_msg(row.verdict == cases[i].verdict, "%zu: %s", i, row.reason);
        for (int k = 0; k < 2; ++k) {
            film[k]->more = NULL;
            film[k]->more_count = 0;
            lc_film_free(film[k]);
        }
    }
}
END_TEST

/* Why a row stays undecided. Where one end of the interval alone lies open, the guard is the reason and no width: rare bright samples
 * of the first film spoil the upper end whichever way the means lie, but the test against FAIL only when it lies below. */
START_TEST(the_reason_is_the_right_one)
{
    static const struct {
        double mean, deviation, skewness[2];
        lc_row_verdict verdict;
        int open[2]; /* lower end, upper end */
        const char *reason;
    } cases[] = {
        {1.0001, 0.1, {0, 0}, LC_ROW_PASS, {0, 0}, ""},
        {1.0001, 0.1, {30, 0}, LC_ROW_UNDECIDED, {0, 1}, "too heavy"},
        {0.9999, 0.1, {30, 0}, LC_ROW_UNDECIDED, {0, 1}, "too heavy"},
        {1.0001, 0.1, {0, 30}, LC_ROW_UNDECIDED, {1, 0}, "too heavy"},
        {0.9999, 0.1, {0, 30}, LC_ROW_UNDECIDED, {1, 0}, "too heavy"},
        {1.0001, 1.0, {0, 0}, LC_ROW_UNDECIDED, {0, 0}, "still wider than the margin"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        lc_film *a = flat_film(1, cases[i].mean, cases[i].deviation, cases[i].skewness[0]),
                *b = flat_film(2, 1, cases[i].deviation, cases[i].skewness[1]);
        lc_row row = {.check = ""};
        lc_error err;
        ck_assert_msg(lc_compare_films(&row, a, b, 0.005, 1e-6, 1e-6, &err) == LC_OK, "%s", err.text);
        ck_assert_msg(row.verdict == cases[i].verdict, "%zu: verdict %d: %s", i, (int)row.verdict, row.reason);
        ck_assert_int_eq(isinf(row.low) != 0, cases[i].open[0]);
        ck_assert_int_eq(isinf(row.high) != 0, cases[i].open[1]);
        ck_assert_msg(strstr(row.reason, cases[i].reason) != NULL, "%zu: %s", i, row.reason);
        lc_film_free(a), lc_film_free(b);
    }
}
END_TEST

Suite *lc_suite_verify(void)
{
    Suite *suite = suite_create("verify");
    TCase *tc = tcase_create("core");
    tcase_set_timeout(tc, 300);
    tcase_add_test(tc, right_estimators_are_not_called_wrong);
    tcase_add_test(tc, two_percent_more_is_found_and_named);
    tcase_add_test(tc, one_nan_is_found_and_placed);
    tcase_add_test(tc, black_does_not_pass_where_there_is_light);
    tcase_add_test(tc, what_cannot_be_shown_is_undecided);
    tcase_add_test(tc, a_row_is_the_same_alone_and_again);
    tcase_add_test(tc, each_estimator_has_a_closed_form_and_two_relations);
    tcase_add_test(tc, shards_are_the_run);
    tcase_add_test(tc, suites_keep_their_caps);
    tcase_add_test(tc, planned_samples_by_hand);
    tcase_add_test(tc, cells_name_what_there_is);
    suite_add_tcase(suite, tc);
    tc = tcase_create("words");
    tcase_add_test(tc, a_row_names_its_command);
    tcase_add_test(tc, what_files_round_is_no_difference);
    tcase_add_test(tc, the_reason_is_the_right_one);
    suite_add_tcase(suite, tc);
    return suite;
}
