/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Private to verify/grade: the workers of one film, from their start to their end.
 */
#ifndef LC_CREW_H
#define LC_CREW_H

#include "verify/grade/jail.h"
#include "verify/grade/wire.h"

enum { LC_SAID_SIZE = 4096 };

/* What a crew is given. */
typedef struct lc_crew_task {
    int image;                       /* the plug-in */
    const lc_jail_options *limits;   /* cpu_seconds: of this crew */
    lc_wire_request request;
    const lc_scene *scene;           /* NULL to describe */
    int workers;
    lc_film *film;                   /* NULL to describe */
    lc_wire_description *description; /* NULL to render */
} lc_crew_task;

typedef struct lc_crew_result {
    lc_jail_verdict verdict;
    unsigned parts;          /* that held in every worker */
    char said[LC_SAID_SIZE]; /* what they printed, the first of it */
} lc_crew_result;

/* Starts the workers, takes what they send, and ends them all, whatever happens. LC_OK: all that was asked for has come;
 * LC_WRONG, LC_FAULT: result->verdict says why it has not. */
lc_status lc_crew_run(lc_crew_result *result, const lc_crew_task *task, lc_error *err);

#endif
