/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The subcommands, and what several of them need.
 */
#ifndef LC_COMMANDS_H
#define LC_COMMANDS_H

#include "cli/args.h"

extern const lc_command lc_command_list, lc_command_render, lc_command_sample, lc_command_compare, lc_command_merge,
    lc_command_verify, lc_command_diagnose, lc_command_export, lc_command_reference, lc_command_new,
    lc_command_grade, lc_command_assignment;

/* Seed where none is given: fixed, so that two people see the same bits. */
enum { LC_DEFAULT_SEED = 1, LC_DEFAULT_BOUNCES = 5 };

/* The estimator or mutant of that name, or LC_BAD_INPUT with the valid names. FILE.c (.cc .cpp .cxx) is compiled, FILE.so loaded: what
 * the compiler says goes to stderr. It lives as long as the program. */
lc_status lc_cli_find_estimator(const lc_estimator **out, const char *name, lc_error *err);
/* Reads and builds a scene given by name (in scenes/) or by path. */
lc_status lc_cli_load_scene(lc_scene **out, const char *name_or_path, const lc_strings *definitions, lc_error *err);
/* "320x200" */
lc_status lc_cli_read_pair(int *a, int *b, const char *text, char separator, const char *option, lc_error *err);
/* The bounces to render: `asked` where >= 0 (beyond the estimator's own is LC_BAD_INPUT), else the scene's, else 5, cut to the estimator's own. */
lc_status lc_cli_bounces(int *out, int asked, const lc_scene *scene, const lc_estimator *estimator, lc_error *err);
/* A progress bar on stderr, when that is a terminal; pass as lc_render_options.progress. */
void lc_cli_progress(void *user, double done);
/* --seed: a whole number, or `random`. */
lc_status lc_cli_read_seed(uint64_t *seed, const char *text, lc_error *err);
int lc_cli_has_terminal(void);

#endif
