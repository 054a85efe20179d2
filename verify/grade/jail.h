/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * jail.h: an estimator from a file that nobody vouches for. It is compiled by a confined compiler and runs in worker processes
 * (build/lightcheck-worker) that can compute and send samples, nothing else; this process never loads it. The films
 * are built here, from a complete count of raw samples: neither what the file prints nor how its process ends can say
 * that it is right. Of an honest file they are, bit for bit, those of lc_render.
 *
 *     lc_jail *jail;
 *     lc_jail_verdict why;
 *     lc_status status = lc_jail_open(&jail, "mine.c", NULL, &why, err);   // compile, describe
 *     options.estimator = lc_jail_estimator(jail);                         // an lc_verify_options
 *     status = lc_verify(&report, &options, load, err);                    // a row whose film fails is a FAIL
 *     ... lc_jail_last(jail) ...                                           // the code of the last film
 *     lc_jail_close(jail);
 *
 * Who runs in a worker can forge that worker's samples, by writing into its memory: that gains nothing without
 * knowing the answer, which is not there. One thread uses a jail at a time.
 */
#ifndef LC_JAIL_H
#define LC_JAIL_H

#include "core/host.h"
#include "verify/grade/confine.h"

/* DMOJ's codes. AC here only says that all samples came; whether they are right the judge decides. */
typedef enum lc_jail_code {
    LC_JAIL_AC,
    LC_JAIL_WA,  /* for the judge: shown wrong */
    LC_JAIL_RTE, /* died: a bad pointer, a failed assertion, a forbidden system call */
    LC_JAIL_TLE, /* took too long */
    LC_JAIL_MLE, /* died with its memory full */
    LC_JAIL_OLE, /* printed too much */
    LC_JAIL_IR,  /* ended by itself before its work was done */
    LC_JAIL_IE,  /* our own fault: run again; never a 0 */
    LC_JAIL_CE   /* does not compile, or is no estimator: ungradable, not a 0 */
} lc_jail_code;

/* "AC", "WA", ... */
const char *lc_jail_code_name(lc_jail_code code);

typedef struct lc_jail_verdict {
    lc_jail_code code;
    char text[512];     /* why, in a sentence for its author; "" for AC */
    double cpu_seconds; /* that the file took, all workers together; not what it takes to start them */
} lc_jail_verdict;

typedef struct lc_jail_options {
    double cpu_seconds;    /* for all films and all workers together: how many run side by side decides nothing */
    double wall_seconds;   /* of the clock, for one film. What is still at work then is IE: the machine gave it no time */
    uint64_t memory;       /* of a worker, beyond what it needs itself [bytes] */
    uint64_t output;       /* that one film may print [bytes] */
    unsigned parts;        /* of the jail that are wanted; what is not had is left out, but limits and one of seccomp and Landlock */
    int any_symbol;        /* 1: the file may name functions beyond lightcheck.h, math.h and string.h; they will not get it far */
} lc_jail_options;

/* 240 s, an hour, 256 MiB, 64 KiB, all parts, no. */
void lc_jail_options_init(lc_jail_options *options);

typedef struct lc_jail lc_jail;

/* Compiles the file and asks it, in a worker, for its descriptor. LC_BAD_INPUT: CE, or there is no such file; LC_WRONG: it misbehaved before it
 * was asked anything; LC_FAULT: IE. `why` (may be NULL) has the code, `err` the text. `options` may be NULL. */
lc_status lc_jail_open(lc_jail **out, const char *path, const lc_jail_options *options, lc_jail_verdict *why,
                       lc_error *err);
void lc_jail_close(lc_jail *jail); /* NULL is fine */

/* An lc_outside: lc_render, and so the judge, renders it like any other, by options->threads workers. LC_WRONG is then the estimator's fault,
 * LC_FAULT ours, lc_jail_last() has the code, and the film is spoilt. It lives as long as the jail, and is not to be copied. */
const lc_estimator *lc_jail_estimator(const lc_jail *jail);

/* Of the last film. */
const lc_jail_verdict *lc_jail_last(const lc_jail *jail);
/* What the last film's workers wrote to stdout and stderr, cut at 4 KiB. To be shown, never to be believed. */
const char *lc_jail_said(const lc_jail *jail);
/* From now on nothing was said, until the next film. */
void lc_jail_forget_said(lc_jail *jail);
/* What the compiler said: warnings. */
const char *lc_jail_messages(const lc_jail *jail);
/* The CPU time that is left [s]; another test may get its own. */
void lc_jail_set_cpu(lc_jail *jail, double cpu_seconds);
double lc_jail_cpu_left(const lc_jail *jail);

/* The parts that held in all workers so far, and the same in words: "limits, seccomp, Landlock, another user". */
unsigned lc_jail_parts(const lc_jail *jail);
const char *lc_jail_level(const lc_jail *jail);

#endif
