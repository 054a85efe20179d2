/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * lightcheck: one program, one file a subcommand.
 */
#include <signal.h>
#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "io/outfile.h"
#include "verify/renderers/program.h"

static const lc_command *const commands[] = {
    &lc_command_list,  &lc_command_render, &lc_command_sample, &lc_command_compare,
    &lc_command_merge, &lc_command_verify, &lc_command_export, &lc_command_reference, &lc_command_diagnose,
    &lc_command_new,   &lc_command_grade,  &lc_command_assignment,
};
enum { COUNT = sizeof commands / sizeof commands[0] };

static void print_usage(FILE *out)
{
    fprintf(out,
            "usage: lightcheck COMMAND ...\n\nProves, or disproves, that a light-transport estimator is right.\n\n");
    for (int i = 0; i < COUNT; ++i)
        fprintf(out, "  %-10s %s\n", commands[i]->name, commands[i]->summary);
    fprintf(out, "\n`lightcheck COMMAND --help` explains one. Exit status: 0 all verified, 1 something shown wrong,\n"
                 "2 bad usage or input, 3 undecided, 4 an I/O error or our own fault.\n");
}

/* Ended from outside: nothing half-written stays, and whoever waits sees the signal. */
static void end(int number)
{
    lc_program_end();
    lc_outfile_unlink_all();
    signal(number, SIG_DFL);
    raise(number);
}

static void set_signals(void)
{
    static const int ends[] = {SIGINT, SIGTERM, SIGHUP};
    struct sigaction action = {.sa_handler = SIG_IGN};
    /* A closed pipe and a limit on file sizes are errors of a write, not deaths. */
    sigaction(SIGPIPE, &action, NULL);
    sigaction(SIGXFSZ, &action, NULL);
    action.sa_handler = end;
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; ++i) {
        struct sigaction before;
        if (sigaction(ends[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN) /* nohup, a shell's background */
            sigaction(ends[i], &action, NULL);
    }
}

int main(int argc, char **argv)
{
    set_signals();
    if (argc < 2) {
        print_usage(stderr);
        return LC_BAD_INPUT;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 || strcmp(argv[1], "help") == 0) {
        print_usage(stdout);
        return LC_OK;
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("lightcheck %s\n", LC_VERSION);
        return LC_OK;
    }
    for (int i = 0; i < COUNT; ++i) {
        if (strcmp(argv[1], commands[i]->name) != 0)
            continue;
        int status = commands[i]->run(commands[i], argc - 1, argv + 1);
        if (fflush(stdout) != 0 || ferror(stdout))
            return lc_complain(commands[i], LC_FAULT, "cannot write to standard output");
        return status;
    }
    lc_complain(NULL, LC_BAD_INPUT, "unknown command '%s'; `lightcheck --help` lists them", argv[1]);
    return LC_BAD_INPUT;
}
