/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "verify/grade/grading.h"

static const char *words_of(const char *category)
{
    for (const lc_mutant_category *c = lc_mutant_categories; c->name; ++c)
        if (strcmp(c->name, category) == 0)
            return c->words;
    return category;
}

/* All that the file could be have one category. */
static int is_one_category(const lc_diagnosis *d)
{
    for (int i = 1; i < d->name_count; ++i)
        if (strcmp(d->names[i]->category, d->names[0]->category) != 0)
            return 0;
    return d->name_count > 0;
}

static void write_hint(lc_test_result *out, const lc_grading *g, const lc_diagnosis *d)
{
    lc_words words = {.count = 0};
    char text[192];
    if (!d->is_wrong || !is_one_category(d))
        return;
    lc_words_set(&words, "category", "%s", words_of(d->names[0]->category));
    lc_words_set(&words, "hint", "%s", d->names[0]->hint);
    int is_named = g->assignment->hints == LC_HINT_NAME && d->name_count == 1 && d->is_certain;
    lc_say(text, sizeof text, g->sentences, is_named ? "hint_name" : "hint_category", &words);
    size_t used = strlen(out->hint);
    snprintf(out->hint + used, sizeof out->hint - used, "%s%s", used ? "; " : "", text);
}

lc_status lc_grade_hint(lc_grading *g, lc_test_result *out, lc_error *err)
{
    lc_diagnosis *d = calloc(1, sizeof *d);
    const lc_diagnose_options options = {g->options->seed, g->options->threads};
    lc_error why;
    if (!d)
        return lc_fail(err, LC_FAULT, "out of memory for a diagnosis");
    if (g->jail)
        lc_jail_set_cpu(g->jail, g->cpu_left);
    /* A file that cannot be diagnosed has its verdict all the same. */
    if (lc_diagnose(d, g->estimator, &options, g->options->load, &why) == LC_OK)
        write_hint(out, g, d);
    free(d);
    return LC_OK;
}
