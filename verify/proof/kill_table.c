/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kill matrix in words; see kill.h. */
#include <math.h>
#include <string.h>

#include "verify/checks/checks.h"
#include "verify/mutants/registry.h"
#include "verify/proof/kill.h"

/* Checks that may kill nothing that others do not, and why they stay. */
static const struct {
    const char *check, *why;
} reasons[] = {
    {"energy", "is about the host, whose mistakes all estimators would share: no estimator meets it"},
    {"furnace", "many bounces against numbers that need no other estimator: what it kills dies elsewhere only while equality's hubs are right"},
    {"effects", "the only values of rough mirrors, of lenses and of motion"},
    {"convergence", "asks how the error falls, not where to: samples that repeat may have the right mean"},
    {"povray", "shares no code with us: it holds the closed forms and the scenes' reader themselves"},
};

static const char *reason_of(const char *check)
{
    for (size_t i = 0; i < sizeof reasons / sizeof reasons[0]; ++i)
        if (strcmp(reasons[i].check, check) == 0)
            return reasons[i].why;
    return NULL;
}

static void print_count(FILE *out, double paths)
{
    if (paths >= 1e6)
        fprintf(out, "%.1fM", paths * 1e-6);
    else
        fprintf(out, "%.0fk", paths * 1e-3);
}

/* Whether anything met the subject in the suite. */
static int number_of_killers(const lc_meetings *all, const char *subject, const char *suite)
{
    int count = 0;
    for (int i = 0; i < all->count; ++i) {
        const lc_meeting *m = &all->items[i];
        count += strcmp(m->subject, subject) == 0 && m->scene[0] && (!suite || strcmp(m->suite, suite) == 0);
    }
    return count;
}

static void print_mutant(FILE *out, const lc_meetings *all, const lc_mutant *mutant)
{
    const lc_meeting *best = NULL;
    const char *between = "";
    fprintf(out, "| %s | ", mutant->estimator->name);
    for (int i = 0; i < all->count; ++i) {
        const lc_meeting *m = &all->items[i];
        if (strcmp(m->subject, mutant->estimator->name) != 0 || !m->scene[0])
            continue;
        fprintf(out, "%s%s%s%s", between, m->check, m->coarse ? "" : "*", strcmp(m->suite, "full") == 0 ? " (full)" : "");
        between = ", ";
        if (!best || m->paths < best->paths)
            best = m;
    }
    if (best) {
        fprintf(out, " | ");
        print_count(out, best->paths);
        fprintf(out, " on %s | ", best->scene);
    } else
        fprintf(out, "nothing | - | ");
    between = "";
    for (int i = 0; i < all->count; ++i) {
        const lc_meeting *m = &all->items[i];
        if (strcmp(m->subject, mutant->estimator->name) != 0 || m->scene[0])
            continue;
        fprintf(out, "%s%s", between, m->check);
        between = ", ";
    }
    fprintf(out, " |\n");
}

/* Returns the number of survivors. */
static int print_mutants(FILE *out, const lc_meetings *all)
{
    int met = 0, quick = 0, dead = 0;
    const lc_mutant *mutant;
    fprintf(out, "\n| mutant | killed by | fewest paths | lives through |\n|---|---|---|---|\n");
    for (int i = 0; (mutant = lc_mutant_at(i)) != NULL; ++i) {
        int is_met = 0;
        for (int j = 0; j < all->count && !is_met; ++j)
            is_met = strcmp(all->items[j].subject, mutant->estimator->name) == 0;
        if (!is_met)
            continue;
        print_mutant(out, all, mutant);
        ++met;
        quick += number_of_killers(all, mutant->estimator->name, "quick") > 0;
        dead += number_of_killers(all, mutant->estimator->name, NULL) > 0;
    }
    if (met)
        fprintf(out, "\n%d of %d are killed by the quick suite (%.1f%%), %d by the quick or the full one (%.1f%%).\n", quick, met,
                100.0 * quick / met, dead, 100.0 * dead / met);
    return met - dead;
}

/* A row of the table of checks; returns 1 when the check has no reason to stay. */
static int print_check(FILE *out, const lc_meetings *all, const char *check)
{
    int met = 0, kills = 0, alone = 0;
    for (int i = 0; i < all->count; ++i) {
        const lc_meeting *m = &all->items[i];
        if (m->is_variant || strcmp(m->check, check) != 0)
            continue;
        ++met;
        kills += m->scene[0] != 0;
        alone += m->scene[0] && number_of_killers(all, m->subject, NULL) == 1;
    }
    const char *why = alone ? "" : reason_of(check);
    fprintf(out, "| %s | %d | %d | %d | %d | %s |\n", check, met, kills, met - kills, alone,
            why ? why : "nothing says why it stays");
    return !why;
}

/* Returns the number of those that are accused. */
static int print_variants(FILE *out, const lc_meetings *all)
{
    int accused = 0;
    fprintf(out, "\n## Right variants\n\nAll rows of the quick suite that apply, at its own plan.\n\n"
                 "| right in another way | PASS | FAIL | UNDECIDED |\n|---|---|---|---|\n");
    for (int v = 0; lc_variants[v]; ++v) {
        int verdicts[3] = {0, 0, 0}, rows = 0;
        for (int i = 0; i < all->count; ++i)
            for (int c = 0; c < 3 && strcmp(all->items[i].subject, lc_variants[v]->name) == 0; ++c) {
                verdicts[c] += all->items[i].verdicts[c];
                rows += all->items[i].verdicts[c];
            }
        if (rows)
            fprintf(out, "| %s | %d | %d | %d |\n", lc_variants[v]->name, verdicts[LC_ROW_PASS], verdicts[LC_ROW_FAIL],
                    verdicts[LC_ROW_UNDECIDED]);
        accused += verdicts[LC_ROW_FAIL] > 0;
    }
    return accused;
}

int lc_kill_tables(FILE *out, const lc_meetings *all)
{
    int idle = 0;
    fprintf(out,
            "# Mutants: what the suites kill\n\nMade by `make mutants`, which fails when a mutant survives or a right variant is\n"
            "accused. `fewest paths`: of the mutant, in the row that needed fewest, until it was shown wrong. A check is done\n"
            "with a mutant at the first row that kills it, cheapest rows first, at four times the suite's margin (a sixteenth of the\n"
            "samples, the same probability of a false FAIL). Who survives all checks there meets the plan of the quick suite itself (*),\n"
            "and then that of the full one. `lives through`: checks that did not kill at the plan at which another one did.\n");
    int alive = print_mutants(out, all);
    fprintf(out, "\n## Checks\n\n| check | meets | kills | survivors | kills alone | why it stays if it kills none alone |\n"
                 "|---|---|---|---|---|---|\n");
    for (const lc_check *const *c = lc_checks; *c; ++c)
        idle += print_check(out, all, (*c)->name);
    int accused = print_variants(out, all);
    fprintf(out, "\n%d mutants alive, %d variants accused, %d checks without a reason to stay.\n", alive, accused, idle);
    return alive + accused + idle;
}
