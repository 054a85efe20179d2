/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/commands.h"
#include "estimators/registry.h"
#include "io/scene_path.h"
#include "io/scene_read.h"
#include "verify/grade/plugin.h"
#include "verify/mutants/registry.h"
#include "verify/report/plain.h"

static size_t list_names(char *text, size_t size, const lc_estimator *const *estimators)
{
    size_t used = 0;
    for (; *estimators && used + strlen((*estimators)->name) + 3 < size; ++estimators)
        used += (size_t)snprintf(text + used, size - used, "%s%s", used ? ", " : "", (*estimators)->name);
    return used;
}

/* What the compiler says is for whoever wrote the file: warnings, too. */
static lc_status load_file(const lc_estimator **out, const char *path, lc_error *err)
{
    char messages[8192];
    lc_status status = lc_plugin_load(out, path, messages, sizeof messages, err);
    lc_plain_lines(stderr, messages, "");
    return status;
}

lc_status lc_cli_find_estimator(const lc_estimator **out, const char *name, lc_error *err)
{
    if (lc_is_plugin(name))
        return load_file(out, name, err);
    for (const lc_estimator *const *e = lc_estimators; *e; ++e)
        if (strcmp((*e)->name, name) == 0) {
            *out = *e;
            return LC_OK;
        }
    const lc_mutant *mutant = lc_mutant_find(name);
    if (mutant) {
        *out = mutant->estimator;
        return LC_OK;
    }
    for (const lc_estimator *const *e = lc_variants; *e; ++e)
        if (strcmp((*e)->name, name) == 0) {
            *out = *e;
            return LC_OK;
        }
    if (strpbrk(name, "./")) /* no estimator is called so */
        return lc_fail(err, LC_BAD_INPUT, "%s: expected a source file (.c, .cc, .cpp, .cxx), a shared object (.so), or the name of an estimator",
                       name);
    char list[512] = "";
    list_names(list, sizeof list, lc_estimators);
    return lc_fail(err, LC_BAD_INPUT,
                   "unknown estimator '%s'; expected one of: %s (or a mutant: `lightcheck list mutants`, or FILE.c)", name, list);
}

/* "NAME=VALUE" -> an override; `names` owns the name. */
static lc_status read_definition(lc_parameter *out, char **name, const char *text, lc_error *err)
{
    const char *equals = strchr(text, '=');
    if (!equals || equals == text)
        return lc_fail(err, LC_BAD_INPUT, "-D %s: expected NAME=VALUE", text);
    size_t length = (size_t)(equals - text);
    *name = malloc(length + 1);
    if (!*name)
        return lc_fail(err, LC_FAULT, "out of memory");
    memcpy(*name, text, length);
    (*name)[length] = 0;
    out->name = *name;
    out->value = equals + 1;
    return LC_OK;
}

lc_status lc_cli_load_scene(lc_scene **out, const char *name_or_path, const lc_strings *definitions, lc_error *err)
{
    char path[LC_PATH_SIZE];
    lc_scene_desc desc;
    int count = definitions ? definitions->count : 0;
    lc_parameter *overrides = calloc((size_t)count + 1, sizeof *overrides);
    char **names = calloc((size_t)count + 1, sizeof *names);
    lc_status status = overrides && names ? LC_OK : lc_fail(err, LC_FAULT, "out of memory");
    for (int i = 0; status == LC_OK && i < count; ++i)
        status = read_definition(&overrides[i], &names[i], definitions->items[i], err);
    if (status == LC_OK)
        status = lc_scene_locate(path, name_or_path, err);
    if (status == LC_OK)
        status = lc_scene_read(&desc, path, overrides, count, err);
    if (status == LC_OK) {
        status = lc_scene_build(out, &desc, err);
        lc_scene_desc_release(&desc);
    }
    for (int i = 0; names && i < count; ++i)
        free(names[i]);
    free(names);
    free(overrides);
    return status;
}

lc_status lc_cli_read_pair(int *a, int *b, const char *text, char separator, const char *option, lc_error *err)
{
    char *end;
    long first = strtol(text, &end, 10);
    if (end != text && *end == separator && end[1] >= '0' && end[1] <= '9') {
        const char *start = end + 1;
        long second = strtol(start, &end, 10);
        if (end != start && *end == 0 && first >= 0 && first <= 1 << 30 && second >= 0 && second <= 1 << 30) {
            *a = (int)first;
            *b = (int)second;
            return LC_OK;
        }
    }
    return lc_fail(err, LC_BAD_INPUT, "%s: '%s' is not two whole numbers with '%c' between", option, text, separator);
}

lc_status lc_cli_bounces(int *out, int asked, const lc_scene *scene, const lc_estimator *estimator, lc_error *err)
{
    if (asked > estimator->max_bounces)
        return lc_fail(err, LC_BAD_INPUT, "--bounces %d: %s does at most %d", asked, estimator->name,
                       estimator->max_bounces);
    int given = lc_scene_description(scene)->max_bounces;
    int bounces = asked >= 0 ? asked : given >= 0 ? given : LC_DEFAULT_BOUNCES;
    *out = bounces < estimator->max_bounces ? bounces : estimator->max_bounces;
    return LC_OK;
}

lc_status lc_cli_read_seed(uint64_t *seed, const char *text, lc_error *err)
{
    char *end;
    if (strcmp(text, "random") == 0) {
        FILE *f = fopen("/dev/urandom", "rb");
        size_t read = f ? fread(seed, sizeof *seed, 1, f) : 0;
        if (f)
            fclose(f);
        return read == 1 ? LC_OK : lc_fail(err, LC_FAULT, "/dev/urandom: cannot draw a seed");
    }
    errno = 0;
    unsigned long long number = strtoull(text, &end, 10);
    if (end == text || *end || errno || text[0] == '-')
        return lc_fail(err, LC_BAD_INPUT, "--seed: '%s' is neither `random` nor a whole number from 0 to 2^64 - 1",
                       text);
    *seed = number;
    return LC_OK;
}

int lc_cli_has_terminal(void) { return isatty(STDERR_FILENO); }

void lc_cli_progress(void *user, double done)
{
    (void)user;
    if (!lc_cli_has_terminal())
        return;
    int filled = (int)(done * 40);
    fprintf(stderr, "\r[%-40.*s] %3.0f%%%s", filled, "########################################", 100 * done,
            done >= 1 ? "\r\033[K" : "");
    fflush(stderr);
}
