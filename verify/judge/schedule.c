/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Rows shared out among threads, scene by scene: the films of a scene are of use to its rows only. A film does not depend on the
 * threads that render it, so neither does a row; rows are told in their order, whoever was first.
 */
#include <pthread.h>
#include <stdlib.h>
#include <unistd.h>

#include "verify/judge/judge_c.h"

/* A claim that was selected, and what became of it. */
typedef struct slot {
    const lc_claim *claim;
    lc_row row;
    int is_done;
    lc_status status;
    lc_error why;
} slot;

typedef struct schedule {
    pthread_mutex_t lock;
    lc_report *report;
    const lc_session *model; /* what each thread's session begins as */
    slot *slots;
    int next, told;
    int stop;  /* no claim from this one on: an earlier one had an error */
    int rows;  /* how many there will be */
    int threads, working;
    lc_status status; /* of the first error, in the order of the rows */
    lc_error *err;
} schedule;

enum { HOPELESS = 3 }; /* faults before any row: the renderer under test does not work at all */

/* A renderer under test that refuses a scene, or fails over it, loses the row and not the run. */
static int is_lost(const schedule *s, const slot *at)
{
    return (at->status == LC_BAD_INPUT || at->status == LC_FAULT) && !at->claim->decide &&
           lc_is_foreign(s->model, at->claim->estimator);
}

/* Under the lock. */
static void tell(schedule *s)
{
    const lc_verify_options *o = s->model->options;
    for (; s->told < s->stop && s->slots[s->told].is_done; ++s->told) {
        slot *at = &s->slots[s->told];
        lc_status status = at->status;
        if (status == LC_OK) {
            lc_row *row = lc_report_add(s->report);
            if (row) {
                *row = at->row;
                if (o->on_row)
                    o->on_row(o->user, row, s->report->count, s->rows);
                continue;
            }
            status = lc_fail(&at->why, LC_FAULT, "out of memory for the report");
        }
        if (is_lost(s, at)) {
            status = lc_report_note(s->report, at->claim->check->name, lc_scene_description(at->claim->scene)->name,
                                    at->status == LC_FAULT, at->why.text, &at->why);
            --s->rows;
            if (status == LC_OK && (s->report->count > 0 || lc_report_faults(s->report) < HOPELESS))
                continue;
            status = LC_FAULT;
        }
        s->status = lc_fail(s->err, status, "%s", at->why.text);
        s->stop = s->told;
    }
}

/* The claims of one scene, or one claim about the host; 0 when none are left. */
static int take(schedule *s, int *first, int *end)
{
    pthread_mutex_lock(&s->lock);
    *first = *end = s->next;
    while (*end < s->stop && (*end == *first || (s->slots[*end].claim->scene && s->slots[*end].claim->scene ==
                                                                                    s->slots[*first].claim->scene)))
        ++*end;
    s->next = *end;
    int is_some = *end > *first;
    s->working -= !is_some;
    pthread_mutex_unlock(&s->lock);
    return is_some;
}

/* Cores that no row is waiting for help those that are still at work. */
static int threads_now(schedule *s, int index)
{
    pthread_mutex_lock(&s->lock);
    int threads = index >= s->stop ? 0 : s->threads / s->working > 1 ? s->threads / s->working : 1;
    pthread_mutex_unlock(&s->lock);
    return threads;
}

static void *work(void *user)
{
    schedule *s = user;
    lc_verify_options options = *s->model->options;
    lc_session session = *s->model;
    session.options = &options;
    for (int first, end; take(s, &first, &end); lc_session_clear(&session))
        for (int i = first; i < end && (options.threads = threads_now(s, i)) > 0; ++i) {
            slot *at = &s->slots[i];
            session.number = i + 1;
            at->status = lc_judge_claim(&at->row, &session, at->claim, &at->why);
            pthread_mutex_lock(&s->lock);
            at->is_done = 1;
            if (at->status != LC_OK && !is_lost(s, at) && s->stop > i + 1)
                s->stop = i + 1;
            tell(s);
            pthread_mutex_unlock(&s->lock);
        }
    pthread_mutex_lock(&s->lock);
    s->report->paths += session.paths;
    pthread_mutex_unlock(&s->lock);
    return NULL;
}

/* Three more than cores: they wait for POV-Ray. An estimator from a file may have its own process, and another renderer has the machine: one
 * row at a time. */
static int workers_of(const schedule *s)
{
    const lc_verify_options *o = s->model->options;
    int is_shipped = !o->renderer && (!o->estimator || lc_is_registered(o->estimator));
    return !is_shipped || s->threads == 1 ? 1 : s->threads < 61 ? s->threads + 3 : 64;
}

lc_status lc_judge_all(lc_report *report, const lc_session *model, const lc_claim *const *claims, int count, lc_error *err)
{
    long cores = model->options->threads > 0 ? model->options->threads : sysconf(_SC_NPROCESSORS_ONLN);
    schedule s = {.report = report, .model = model, .stop = count, .rows = count, .err = err,
                  .threads = cores < 1 ? 1 : cores > 256 ? 256 : (int)cores};
    pthread_t helpers[64];
    int workers = workers_of(&s), started = 0;
    s.working = workers;
    s.slots = calloc((size_t)count + 1, sizeof *s.slots);
    if (!s.slots)
        return lc_fail(err, LC_FAULT, "out of memory for the rows");
    for (int i = 0; i < count; ++i)
        s.slots[i].claim = claims[i];
    pthread_mutex_init(&s.lock, NULL);
    while (started < workers - 1 && pthread_create(&helpers[started], NULL, work, &s) == 0)
        ++started;
    pthread_mutex_lock(&s.lock);
    s.working -= workers - 1 - started; /* fewer threads than asked for change nothing but the time */
    pthread_mutex_unlock(&s.lock);
    work(&s);
    for (int i = 0; i < started; ++i)
        pthread_join(helpers[i], NULL);
    pthread_mutex_destroy(&s.lock);
    free(s.slots);
    return s.status;
}
