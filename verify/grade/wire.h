/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * wire.h: what passes between the program and a worker. Both are of one build on one machine, so structures go as they
 * are; `build` says when that is not so. The request is a file in memory; the answer a pipe: a greeting, sent before
 * anything of the plug-in runs, then a description, or the bare samples (three doubles each, tile by tile of the
 * worker's shard, row by row, in ascending order; of a film of differences, the scene's, then each term's).
 */
#ifndef LC_WIRE_H
#define LC_WIRE_H

#include "core/host.h"
#include "verify/grade/confine.h"

/* The descriptors of a worker. */
enum { LC_WIRE_REQUEST = 0, LC_WIRE_PLUGIN = 3, LC_WIRE_SAMPLES = 4, LC_WIRE_FIRST_UNUSED = 5 };

typedef enum lc_wire_task { LC_WIRE_DESCRIBE, LC_WIRE_RENDER } lc_wire_task;

typedef struct lc_wire_request {
    uint64_t build;
    lc_wire_task task;
    lc_confinement confinement;
    lc_render_options options; /* the shard is the worker's own: shard + shards * index of shards * count */
    int width, height;
    lc_term terms[LC_MAX_TERMS];               /* their scenes: */
    lc_scene_desc scenes[1 + LC_MAX_TERMS];    /* the scene and those of options.minus; their arrays follow, one scene after the other */
} lc_wire_request;

typedef struct lc_wire_greeting {
    uint64_t build;
    unsigned reached; /* the parts of the jail */
    int status;       /* an lc_status; else of what `error` says */
    double cpu_seconds; /* that it took to get here: none of the plug-in's */
    char error[256];
} lc_wire_greeting;

/* A descriptor by value. */
typedef struct lc_wire_description {
    int loaded; /* 0: it cannot be, `source` says why */
    int abi, max_bounces, has_name, has_summary, has_source, has_radiance;
    unsigned lobes, emitters;
    char name[64], summary[256], source[512];
} lc_wire_description;

/* Differs where two programs would not understand each other. */
uint64_t lc_wire_build(void);

/* Writes all of it; returns 0 when that cannot be. */
int lc_wire_send(int to, const void *data, size_t size);

/* Writes the request as a sealed file in memory, to *fd; `scene` is NULL where nothing is rendered, the terms' are the options'. Names
 * stay at home: an estimator has no need to know what it renders. */
lc_status lc_wire_write(int *fd, const lc_wire_request *request, const lc_scene *scene, lc_error *err);

/* Maps the request of descriptor `fd`, which stays; its scenes' arrays point into the map. NULL when it is not one. */
lc_wire_request *lc_wire_read(int fd);

#endif
