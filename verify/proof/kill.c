/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * kill: which check kills which mutant, with how few paths; and that no right variant is accused. Writes results/mutants.md;
 * exit status 1 when a mutant lives or a variant is accused.
 *
 * usage: kill [-o TABLE] [-s STATE] [NAME ...]
 *
 * One process, so that the films of the right estimators and the closed forms are made once for all mutants. A check is done with a mutant
 * at its first FAIL. Each is tried at four times the margin first, which plans a sixteenth of the samples: FAIL has the same error there
 * as anywhere. What survives that meets the plan of the suite; what survives the quick suite meets the full one. A variant gets all rows of
 * the quick suite as they are. STATE takes up where a run was stopped.
 */
#include "verify/proof/kill.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "estimators/registry.h"
#include "io/hash_file.h"
#include "io/scene_path.h"
#include "io/scene_read.h"
#include "verify/judge/judge_c.h"
#include "verify/mutants/registry.h"

enum { MOST_SCENES = 128, MOST_ROWS = 512 };
static const double COARSE = 4;

typedef struct killing {
    lc_verify_options options;
    lc_session session;
    lc_scene *scenes[MOST_SCENES];
    int scene_count;
    lc_claims claims;            /* those of host and registry, then those of the one under test */
    int base, base_rows[2];      /* of the former, all and by suite */
    lc_meetings meetings;
    FILE *state; /* NULL: none is kept */
} killing;

/* ---- scenes and claims ------------------------------------------------------------------------------------------------------ */

/* Rows share the budget as in `lightcheck verify -e NAME`. */
static lc_status prepare(killing *k, lc_error *err)
{
    int ignored = 0;
    lc_verify_options_init(&k->options);
    k->session.options = &k->options;
    lc_status status = lc_plan_host(&k->claims, err);
    for (int i = 0; lc_suite_scenes[i] && status == LC_OK; ++i) {
        if (k->scene_count == MOST_SCENES)
            return lc_fail(err, LC_FAULT, "more than %d scenes", MOST_SCENES);
        status = lc_suite_scene(&k->scenes[k->scene_count], lc_suite_scenes[i], k->options.seed, lc_scene_open, err);
        if (status != LC_OK)
            return status;
        const lc_scene *scene = k->scenes[k->scene_count++];
        for (const lc_estimator *const *e = lc_estimators; *e && status == LC_OK; ++e)
            status = lc_plan_pair(&k->claims, &ignored, scene, *e, err);
    }
    k->base = k->claims.count;
    for (int i = 0; i < k->base; ++i)
        for (int s = 0; s < 2; ++s)
            k->base_rows[s] += lc_suite_has(&lc_suites[s], &k->claims.items[i]);
    return status;
}

/* Rows that the claim takes, roughly: paths of the first look at the coarse plan. */
static double cost_of(const lc_claim *claim)
{
    const lc_scene_desc *desc = lc_scene_description(claim->scene);
    double pixels = (double)desc->width * desc->height, films = claim->other || claim->term_count ? 2 : 1;
    if (claim->decide)
        return 4e6;
    return pixels * films * claim->max_bounces * (claim->exact || lc_relation_is_sharp(claim) ? LC_BLOCK : LC_LEAST_SAMPLES);
}

static int by_cost(const void *a, const void *b)
{
    const lc_claim *x = *(const lc_claim *const *)a, *y = *(const lc_claim *const *)b;
    double difference = cost_of(x) - cost_of(y);
    return difference < 0 ? -1 : difference > 0 ? 1 : (x > y) - (x < y);
}

/* The rows of that check for the estimator under test, cheapest first. */
static int select_rows(const lc_claim *rows[MOST_ROWS], const killing *k, const lc_suite *suite, const lc_check *check)
{
    int count = 0;
    for (int i = k->base; i < k->claims.count && count < MOST_ROWS; ++i)
        if (k->claims.items[i].check == check && lc_suite_has(suite, &k->claims.items[i]) &&
            (suite == &lc_suites[0] || !lc_suite_has(&lc_suites[0], &k->claims.items[i])))
            rows[count++] = &k->claims.items[i];
    qsort(rows, (size_t)count, sizeof *rows, by_cost);
    return count;
}

/* ---- meetings ----------------------------------------------------------------------------------------------------------------- */

/* Judges the rows at a multiple of the suite's margin, those of a mutant until one kills. `again`: the plan before did not. */
static lc_status judge_rows(lc_meeting *m, killing *k, const lc_claim *const *rows, int count, double multiple, int again,
                            lc_error *err)
{
    k->session.margin = multiple * lc_suite_find(m->suite)->margin;
    for (int i = 0; i < count; ++i) {
        lc_row row;
        if (again && (rows[i]->exact || rows[i]->decide)) /* no margin enters */
            continue;
        memset(&row, 0, sizeof row);
        lc_status status = lc_judge_claim(&row, &k->session, rows[i], err);
        if (status != LC_OK)
            return status;
        ++m->verdicts[row.verdict];
        if (row.verdict != LC_ROW_FAIL || m->scene[0])
            continue;
        m->coarse = multiple > 1;
        m->paths = (double)row.paths;
        snprintf(m->scene, sizeof m->scene, "%s", row.scene);
        if (!m->is_variant)
            return LC_OK;
    }
    return LC_OK;
}

static lc_meeting *add_meeting(lc_meetings *meetings, const lc_estimator *subject, const lc_check *check,
                               const lc_suite *suite, int is_variant)
{
    lc_meeting *items = realloc(meetings->items, ((size_t)meetings->count + 1) * sizeof *items);
    if (!items)
        return NULL;
    meetings->items = items;
    lc_meeting *m = &items[meetings->count++];
    memset(m, 0, sizeof *m);
    snprintf(m->subject, sizeof m->subject, "%s", subject->name);
    snprintf(m->check, sizeof m->check, "%s", check->name);
    snprintf(m->suite, sizeof m->suite, "%s", suite->name);
    m->is_variant = is_variant;
    return m;
}

/* One suite: every check that has rows for the estimator, at one plan. *alive is cleared where one kills. */
static lc_status meet_suite(killing *k, const lc_estimator *subject, const lc_suite *suite, int is_variant, double multiple,
                            int *alive, lc_error *err)
{
    k->options.suite = suite;
    k->session.rows = k->base_rows[suite - lc_suites];
    for (int i = k->base; i < k->claims.count; ++i)
        k->session.rows += lc_suite_has(suite, &k->claims.items[i]);
    for (const lc_check *const *c = lc_checks; *c; ++c) {
        const lc_claim *rows[MOST_ROWS];
        int count = select_rows(rows, k, suite, *c);
        lc_meeting *m = NULL;
        for (int i = 0; i < k->meetings.count && !m; ++i)
            if (strcmp(k->meetings.items[i].subject, subject->name) == 0 && strcmp(k->meetings.items[i].check, (*c)->name) == 0 &&
                strcmp(k->meetings.items[i].suite, suite->name) == 0)
                m = &k->meetings.items[i];
        int again = m != NULL;
        if (!count || (m && m->scene[0]))
            continue;
        m = m ? m : add_meeting(&k->meetings, subject, *c, suite, is_variant);
        if (!m)
            return lc_fail(err, LC_FAULT, "out of memory for the meetings");
        lc_status status = judge_rows(m, k, rows, count, multiple, again, err);
        if (status != LC_OK)
            return status;
        *alive &= !m->scene[0];
    }
    return LC_OK;
}

static lc_status meet_all(killing *k, const lc_estimator *subject, int is_variant, lc_error *err)
{
    int ignored = 0, alive = 1;
    lc_status status = LC_OK;
    k->claims.count = k->base;
    for (int i = 0; i < k->scene_count && status == LC_OK; ++i)
        status = lc_plan_pair(&k->claims, &ignored, k->scenes[i], subject, err);
    for (int s = 0; s < (is_variant ? 1 : 2); ++s) {
        if (!is_variant && alive && status == LC_OK)
            status = meet_suite(k, subject, &lc_suites[s], is_variant, COARSE, &alive, err);
        if (alive && status == LC_OK)
            status = meet_suite(k, subject, &lc_suites[s], is_variant, 1, &alive, err);
    }
    lc_session_forget(&k->session, subject);
    return status;
}

/* ---- state ---------------------------------------------------------------------------------------------------------------------- */

/* Another build, or other scenes, are another run. */
static unsigned long long hash_all(void)
{
    unsigned long long hash = lc_hash_file(LC_HASH, "/proc/self/exe");
    for (int i = 0; lc_suite_scenes[i]; ++i) {
        char path[LC_PATH_SIZE];
        if (lc_scene_locate(path, lc_suite_scenes[i], NULL) == LC_OK)
            hash = lc_hash_file(hash, path);
    }
    return hash;
}

static void write_subject(killing *k, int first, double seconds)
{
    const lc_meetings *all = &k->meetings;
    if (!k->state)
        return;
    for (int i = first; i < all->count; ++i) {
        const lc_meeting *m = &all->items[i];
        fprintf(k->state, "met %s %s %s %d %d %d %d %d %.0f %s\n", m->subject, m->check, m->suite, m->is_variant, m->verdicts[0],
                m->verdicts[1], m->verdicts[2], m->coarse, m->paths, m->scene[0] ? m->scene : "-");
    }
    fprintf(k->state, "done %.3f\n", seconds);
    fflush(k->state);
}

/* Takes over the subjects that an earlier run of this very program was done with. */
static lc_status open_state(killing *k, const char *path, lc_error *err)
{
    char line[512], head[64];
    lc_meetings old = {.count = 0}, part = {.count = 0};
    snprintf(head, sizeof head, "kill %016llx\n", hash_all());
    FILE *f = fopen(path, "r");
    if (f && fgets(line, sizeof line, f) && strcmp(line, head) == 0)
        while (fgets(line, sizeof line, f)) {
            lc_meeting m;
            double seconds;
            memset(&m, 0, sizeof m);
            if (sscanf(line, "met %63s %31s %15s %d %d %d %d %d %lf %63s", m.subject, m.check, m.suite, &m.is_variant,
                       &m.verdicts[0], &m.verdicts[1], &m.verdicts[2], &m.coarse, &m.paths, m.scene) == 10) {
                if (strcmp(m.scene, "-") == 0)
                    m.scene[0] = 0;
                lc_meeting *items = realloc(part.items, ((size_t)part.count + 1) * sizeof *items);
                if (!items)
                    break;
                part.items = items;
                items[part.count++] = m;
            } else if (sscanf(line, "done %lf", &seconds) == 1) {
                old.count = part.count;
                old.seconds += seconds;
            }
        }
    if (f)
        fclose(f);
    k->meetings = (lc_meetings){part.items, old.count, old.seconds};
    k->state = fopen(path, old.count ? "a" : "w");
    if (!k->state)
        return lc_fail(err, LC_FAULT, "%s: cannot be written", path);
    if (!old.count)
        fputs(head, k->state);
    return LC_OK;
}

static int is_known(const lc_meetings *meetings, const char *subject)
{
    for (int i = 0; i < meetings->count; ++i)
        if (strcmp(meetings->items[i].subject, subject) == 0)
            return 1;
    return 0;
}

/* ---- main ------------------------------------------------------------------------------------------------------------------------ */

static lc_status meet_one(killing *k, const lc_estimator *subject, int is_variant, char *const *names, lc_error *err)
{
    int first = k->meetings.count, is_wanted = !*names;
    for (; *names && !is_wanted; ++names)
        is_wanted = strcmp(*names, subject->name) == 0;
    if (!is_wanted || is_known(&k->meetings, subject->name))
        return LC_OK;
    clock_t start = clock();
    lc_status status = meet_all(k, subject, is_variant, err);
    double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
    if (status != LC_OK)
        return status;
    k->meetings.seconds += seconds;
    write_subject(k, first, seconds);
    fprintf(stderr, "%-32s %5.1f s", subject->name, seconds);
    for (int i = first; i < k->meetings.count; ++i)
        if (k->meetings.items[i].scene[0])
            fprintf(stderr, " %s%s", k->meetings.items[i].check, k->meetings.items[i].coarse ? "" : "*");
    fputc('\n', stderr);
    return LC_OK;
}

static lc_status run(killing *k, const char *state, char *const *names, lc_error *err)
{
    const lc_mutant *m;
    lc_status status = state ? open_state(k, state, err) : LC_OK;
    if (status == LC_OK)
        status = prepare(k, err);
    for (int i = 0; (m = lc_mutant_at(i)) != NULL && status == LC_OK; ++i)
        status = meet_one(k, m->estimator, 0, names, err);
    for (int i = 0; lc_variants[i] && status == LC_OK; ++i)
        status = meet_one(k, lc_variants[i], 1, names, err);
    return status;
}

int main(int argc, char **argv)
{
    static killing k;
    lc_error err = {""};
    const char *path = NULL, *state = NULL;
    int next = 1, wrong = 0;
    for (; next + 1 < argc && argv[next][0] == '-'; next += 2)
        *(argv[next][1] == 'o' ? &path : &state) = argv[next + 1];
    lc_status status = run(&k, state, argv + next, &err);
    if (status == LC_OK) {
        FILE *out = path ? fopen(path, "w") : stdout;
        if (out)
            wrong = lc_kill_tables(out, &k.meetings);
        if (!out || ferror(out) || (path && fclose(out) != 0))
            status = lc_fail(&err, LC_FAULT, "%s: cannot be written", path ? path : "the table");
    }
    lc_session_clear(&k.session);
    lc_claims_release(&k.claims);
    for (int i = 0; i < k.scene_count; ++i)
        lc_scene_free(k.scenes[i]);
    free(k.meetings.items);
    if (k.state)
        fclose(k.state);
    if (status != LC_OK)
        fprintf(stderr, "kill: %s\n", err.text);
    return status != LC_OK ? (int)status : wrong ? LC_WRONG : LC_OK;
}
