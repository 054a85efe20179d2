/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/grade/jail.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "verify/grade/compile.h"
#include "verify/grade/crew.h"
#include "verify/grade/plugin.h"
#include "verify/grade/symbols.h"

struct lc_jail {
    lc_jail_options options;
    int image;
    lc_outside outside;
    lc_wire_description description; /* whose texts are the estimator's */
    lc_crew_result last;
    unsigned parts;
    double cpu_left;
    char level[128], messages[8192];
};

const char *lc_jail_code_name(lc_jail_code code)
{
    static const char *const names[] = {"AC", "WA", "RTE", "TLE", "MLE", "OLE", "IR", "IE", "CE"};
    return names[code];
}

void lc_jail_options_init(lc_jail_options *options)
{
    const lc_jail_options defaults = {240, 3600, 256 << 20, 64 << 10, LC_JAIL_ALL, 0};
    *options = defaults;
}

/* ---- the level --------------------------------------------------------------------------------------------------- */

static void hold(lc_jail *jail, unsigned parts)
{
    static const char *const names[] = {"limits", "seccomp", "Landlock", "another user"};
    size_t used = 0, size = sizeof jail->level;
    jail->parts &= parts;
    for (int have = 1; have >= 0; --have) {
        int first = 1;
        for (int i = 0; i < 4; ++i) {
            if (((jail->parts >> i) & 1) != (unsigned)have || used >= size)
                continue;
            used += (size_t)snprintf(jail->level + used, size - used, "%s%s",
                                     !first ? ", " : have ? "" : "; without: ", names[i]);
            first = 0;
        }
    }
}

unsigned lc_jail_parts(const lc_jail *jail) { return jail->parts; }
const char *lc_jail_level(const lc_jail *jail) { return jail->level; }

/* ---- films ------------------------------------------------------------------------------------------------------- */

/* The crew sums up and ends its workers; what the kernel does about one of them comes later, should nobody be there to look. */
static lc_confinement confinement_of(const lc_jail_options *limits)
{
    return (lc_confinement){limits->parts, limits->cpu_seconds + 2, limits->memory, 0};
}

static lc_status fill(void *user, lc_film *film, const lc_scene *scene, const lc_render_options *options, lc_error *err)
{
    lc_jail *jail = user;
    lc_jail_options limits = jail->options;
    long cores = options->threads > 0 ? options->threads : sysconf(_SC_NPROCESSORS_ONLN);
    int most = LC_MAX_SHARDS / options->shards, tiles = (film->width + LC_TILE - 1) / LC_TILE *
                                                        ((film->height + LC_TILE - 1) / LC_TILE);
    limits.cpu_seconds = fmax(jail->cpu_left, 0);
    lc_crew_task task = {.image = jail->image,
                         .limits = &limits,
                         .scene = scene,
                         .workers = (int)fmax(1, fmin((double)cores, fmin(most, tiles))),
                         .film = film};
    task.request.task = LC_WIRE_RENDER;
    task.request.confinement = confinement_of(&limits);
    task.request.options = *options;
    task.request.width = film->width;
    task.request.height = film->height;
    lc_status status = lc_crew_run(&jail->last, &task, err);
    jail->cpu_left -= jail->last.verdict.cpu_seconds;
    hold(jail, jail->last.parts);
    if (status == LC_OK && options->progress)
        options->progress(options->user, 1.0);
    return status;
}

const lc_estimator *lc_jail_estimator(const lc_jail *jail) { return &jail->outside.estimator; }
/* ---- open -------------------------------------------------------------------------------------------------------- */

static lc_status compile(lc_jail *jail, const char *path, lc_error *err)
{
    const lc_confinement c = {jail->options.parts, 20, 2ULL << 30, 16 << 20};
    const lc_compile_options options = {0, &c};
    lc_compiled *compiled = malloc(sizeof *compiled);
    if (!compiled)
        return lc_fail(err, LC_FAULT, "out of memory for a compiler's messages");
    lc_status status = lc_compile(compiled, path, &options, err);
    jail->image = compiled->image;
    snprintf(jail->messages, sizeof jail->messages, "%s", compiled->messages);
    if (status == LC_OK && !jail->options.any_symbol)
        status = lc_symbols_check(compiled->symbols, path, err);
    free(compiled);
    return status;
}

/* The texts come from a process that may have written anything: they end within their arrays, and hold no control characters. */
static void clean(char *text, size_t size)
{
    text[size - 1] = 0;
    for (; *text; ++text)
        if ((unsigned char)*text < 32 || *text == 127)
            *text = '?';
}

static lc_status make_estimator(lc_jail *jail, const char *path, lc_error *err)
{
    lc_wire_description *d = &jail->description;
    clean(d->name, sizeof d->name);
    clean(d->summary, sizeof d->summary);
    clean(d->source, sizeof d->source);
    if (!d->loaded)
        return lc_fail(err, LC_BAD_INPUT, "%s: cannot be loaded: %s", path, d->source);
    const lc_estimator e = {d->abi,
                            d->has_name ? d->name : NULL,
                            d->has_summary ? d->summary : NULL,
                            d->has_source ? d->source : NULL,
                            d->lobes,
                            d->emitters,
                            d->max_bounces,
                            d->has_radiance ? lc_radiance_outside : NULL};
    jail->outside = (lc_outside){e, fill, jail};
    return lc_descriptor_check(&e, path, err);
}

static lc_status describe(lc_jail *jail, const char *path, lc_error *err)
{
    lc_jail_options limits = jail->options;
    limits.cpu_seconds = fmin(limits.cpu_seconds, 5);
    lc_crew_task task = {.image = jail->image, .limits = &limits, .workers = 1, .description = &jail->description};
    task.request.task = LC_WIRE_DESCRIBE;
    task.request.confinement = confinement_of(&limits);
    lc_error why = {""};
    lc_status status = lc_crew_run(&jail->last, &task, &why);
    hold(jail, jail->last.parts);
    return status == LC_OK ? make_estimator(jail, path, err) : lc_fail(err, status, "%s: %s", path, why.text);
}

lc_status lc_jail_open(lc_jail **out, const char *path, const lc_jail_options *options, lc_jail_verdict *why,
                       lc_error *err)
{
    lc_error text = {""};
    lc_jail *jail = calloc(1, sizeof *jail);
    *out = NULL;
    if (why)
        memset(why, 0, sizeof *why);
    if (!jail)
        return lc_fail(err, LC_FAULT, "out of memory for a jail");
    jail->image = -1;
    jail->parts = LC_JAIL_ALL;
    lc_jail_options_init(&jail->options);
    if (options)
        jail->options = *options;
    jail->cpu_left = jail->options.cpu_seconds;
    lc_status status = compile(jail, path, &text);
    if (status == LC_OK)
        status = describe(jail, path, &text);
    if (status == LC_OK) {
        *out = jail;
        return LC_OK;
    }
    if (why) {
        why->code = status == LC_BAD_INPUT ? LC_JAIL_CE : status == LC_WRONG ? jail->last.verdict.code : LC_JAIL_IE;
        snprintf(why->text, sizeof why->text, "%.511s", text.text);
    }
    lc_jail_close(jail);
    return lc_fail(err, status, "%s", text.text);
}

void lc_jail_close(lc_jail *jail)
{
    if (jail && jail->image >= 0)
        close(jail->image);
    free(jail);
}

const lc_jail_verdict *lc_jail_last(const lc_jail *jail) { return &jail->last.verdict; }
const char *lc_jail_said(const lc_jail *jail) { return jail->last.said; }
void lc_jail_forget_said(lc_jail *jail) { jail->last.said[0] = 0; }
const char *lc_jail_messages(const lc_jail *jail) { return jail->messages; }
void lc_jail_set_cpu(lc_jail *jail, double cpu_seconds) { jail->cpu_left = cpu_seconds; }
double lc_jail_cpu_left(const lc_jail *jail) { return jail->cpu_left; }
