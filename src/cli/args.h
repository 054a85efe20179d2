/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Options of a subcommand as a table: parsed, checked and explained (--help) from the same lines.
 */
#ifndef LC_ARGS_H
#define LC_ARGS_H

#include "core/host.h"

typedef enum lc_option_kind {
    LC_OPT_FLAG,   /* int *: set to 1 */
    LC_OPT_INT,    /* int *, in [least, most] */
    LC_OPT_UINT64, /* uint64_t * */
    LC_OPT_NUMBER, /* double *, in (least, most]; a trailing % divides by 100 */
    LC_OPT_STRING, /* const char ** */
    LC_OPT_CHOICE, /* const char **, one of `choices` */
    LC_OPT_LIST    /* lc_strings *: may be given several times */
} lc_option_kind;

typedef struct lc_strings {
    const char **items;
    int count;
} lc_strings;

typedef struct lc_option {
    char letter;      /* 0: none */
    const char *name; /* without the dashes */
    lc_option_kind kind;
    void *target;
    const char *value; /* what stands for the value in --help */
    const char *help;
    double least, most;
    const char *choices; /* "text|json|junit" */
} lc_option;

typedef struct lc_command {
    const char *name, *synopsis, *summary;
    const char *details; /* more lines for --help; may be NULL */
    int (*run)(const struct lc_command *self, int argc,
               char **argv); /* argv[0] is the command's name; returns the exit code */
} lc_command;

/* Reads argv[1..]; what is no option goes to `rest` (the strings are argv's, the array goes back by lc_strings_release).
 * `options` ends with name = NULL. HELP: it was asked for and is printed; BAD: the message is printed. */
typedef enum lc_args_result { LC_ARGS_OK, LC_ARGS_HELP, LC_ARGS_BAD } lc_args_result;
lc_args_result lc_args_read(const lc_command *command, const lc_option *options, int argc, char **argv,
                            lc_strings *rest);
void lc_strings_release(lc_strings *strings);

/* What a command does once its arguments are read: `user` is its own, `rest` the words that are no options. */
typedef lc_status lc_command_fn(void *user, const lc_strings *rest, lc_error *err);
/* Reads the arguments, wants `least` to `most` words besides (else complains with `expected`), calls `body`, prints its error. The exit code. */
int lc_command_run(const lc_command *command, const lc_option *options, int argc, char **argv, int least, int most,
                   const char *expected, lc_command_fn *body, void *user);

/* Prints "lightcheck COMMAND: message" to stderr and returns `status`. */
int lc_complain(const lc_command *command, lc_status status, const char *format, ...)
#ifdef __GNUC__
    __attribute__((format(printf, 3, 4)))
#endif
    ;

#endif
