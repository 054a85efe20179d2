/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The command line that gives a row again: all that bears on the verdict and is not as usual, each as one word of a shell. What selects
 * other rows (--shard) or changes only time and form (--threads, --format) is left out.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "verify/judge/judge_c.h"
#include "verify/report/safe.h"

static void add(lc_row *row, const char *before, const char *text)
{
    lc_shell_add(row->reproduce, sizeof row->reproduce, before, text);
}

/* In as many digits as give the same number. */
static void add_number(lc_row *row, const char *before, double number)
{
    char text[32];
    for (int digits = 6; digits <= 17; ++digits) {
        snprintf(text, sizeof text, "%.*g", digits, number);
        if (strtod(text, NULL) == number)
            break;
    }
    add(row, before, text);
}

static void add_subject(lc_row *row, const lc_verify_options *o, const lc_claim *claim)
{
    int is_given = claim->estimator == o->estimator;
    if (o->renderer && claim->estimator == &o->renderer->estimator) {
        add(row, " --renderer ", o->renderer->path);
        if (o->renderer->seconds != LC_ADAPTER_SECONDS)
            add_number(row, " --seconds ", o->renderer->seconds);
    } else {
        add(row, " -e ", is_given && o->given ? o->given : claim->estimator->name);
    }
    if (is_given && o->is_jailed)
        add(row, " ", "--jail");
    add(row, " --scene ", lc_scene_description(claim->scene)->name);
}

void lc_row_reproduce(lc_row *row, const lc_verify_options *o, const lc_claim *claim)
{
    char seed[32];
    lc_verify_options usual;
    lc_verify_options_init(&usual);
    row->reproduce[0] = 0;
    add(row, "", o->program);
    add(row, " verify --suite ", o->suite->name);
    add(row, " -c ", claim->check->name);
    if (claim->scene)
        add_subject(row, o, claim);
    snprintf(seed, sizeof seed, "%llu", (unsigned long long)o->seed);
    add(row, " --seed ", seed);
    if (o->margin > 0)
        add_number(row, " --margin ", o->margin);
    if (o->false_fail != usual.false_fail) /* one option for both */
        add_number(row, " --budget ", o->false_fail);
}
