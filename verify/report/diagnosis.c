/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A diagnosis in words: as much of it as the hint level allows.
 */
#include "verify/report/diagnosis.h"

#include <string.h>

static const char *category_words(const char *name)
{
    for (const lc_mutant_category *c = lc_mutant_categories; c->name; ++c)
        if (strcmp(c->name, name) == 0)
            return c->words;
    return name;
}

static void print_names(FILE *out, const lc_diagnosis *d)
{
    if (d->name_count == 1 && d->is_certain) {
        const lc_mutant *m = d->names[0];
        fprintf(out, "behaves exactly as %s with this bug: %s (%s)\n", m->of, m->estimator->summary, m->estimator->name);
        fprintf(out, "  shows: %s\n  story: %s\n", m->shows, m->story);
        return;
    }
    if (d->name_count) {
        fprintf(out, d->is_certain ? "behaves exactly as any of these, which no view tells apart:\n"
                                   : "not all was decided; what was shown equal to it, while the truth was not:\n");
        for (int i = 0; i < d->name_count; ++i)
            fprintf(out, "  %s: %s\n", d->names[i]->estimator->name, d->names[i]->estimator->summary);
        return;
    }
    fprintf(out, "behaves as none of %d known bugs\n", d->candidates);
}

/* The category that all names share, if they do. */
static void print_category(FILE *out, const lc_diagnosis *d)
{
    for (int i = 1; i < d->name_count; ++i)
        if (strcmp(d->names[i]->category, d->names[0]->category) != 0)
            return;
    if (!d->name_count || !d->is_certain)
        return;
    fprintf(out, "what is wrong has to do with %s\n", category_words(d->names[0]->category));
    if (d->name_count == 1)
        fprintf(out, "  %s\n", d->names[0]->hint);
}

void lc_report_diagnosis(FILE *out, const lc_diagnosis *d, const char *name, lc_hint hint)
{
    if (!d->is_wrong) {
        fprintf(out, "%s is not shown different from %s on %d views\n", name, d->truth->name, d->view_count);
        for (int i = 0; i < d->line_count; ++i)
            fprintf(out, "  %s\n", d->lines[i]);
        return;
    }
    fprintf(out, "%s is wrong\n", name);
    if (hint == LC_HINT_CATEGORY)
        print_category(out, d);
    if (hint != LC_HINT_NAME)
        return;
    print_names(out, d);
    for (int i = 0; i < d->line_count; ++i)
        fprintf(out, "  measured: %s\n", d->lines[i]);
    fprintf(out, "  against %d known bugs on %d views, %.1f M paths\n", d->candidates, d->view_count, (double)d->paths * 1e-6);
}
