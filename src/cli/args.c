/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/args.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "verify/report/plain.h"

int lc_complain(const lc_command *command, lc_status status, const char *format, ...)
{
    char message[4096]; /* names of files that others chose may stand in it */
    va_list args;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    fprintf(stderr, "lightcheck%s%s: ", command ? " " : "", command ? command->name : "");
    lc_plain(stderr, message);
    fputc('\n', stderr);
    return (int)status;
}

void lc_strings_release(lc_strings *strings)
{
    free(strings->items);
    strings->items = NULL;
    strings->count = 0;
}

static int append(lc_strings *strings, const char *item)
{
    const char **items = realloc(strings->items, ((size_t)strings->count + 1) * sizeof *items);
    if (!items)
        return 0;
    items[strings->count++] = item;
    strings->items = items;
    return 1;
}

static void print_help(const lc_command *command, const lc_option *options)
{
    printf("usage: lightcheck %s %s\n\n%s\n", command->name, command->synopsis, command->summary);
    if (command->details)
        printf("\n%s", command->details);
    printf("\n");
    for (const lc_option *o = options; o->name; ++o) {
        char left[64];
        int n = o->letter ? snprintf(left, sizeof left, "  -%c, --%s", o->letter, o->name)
                          : snprintf(left, sizeof left, "      --%s", o->name);
        if (o->value)
            snprintf(left + n, sizeof left - (size_t)n, " %s", o->value);
        printf("%-30s %s\n", left, o->help);
    }
    printf("%-30s %s\n", "  -h, --help", "this text");
}

static int is_one_of(const char *value, const char *choices)
{
    size_t length = strlen(value);
    for (const char *c = choices; c; c = strchr(c, '|') ? strchr(c, '|') + 1 : NULL)
        if (strncmp(c, value, length) == 0 && (c[length] == '|' || c[length] == 0))
            return 1;
    return 0;
}

static lc_args_result bad_value(const lc_command *command, const lc_option *o, const char *value, const char *expected)
{
    lc_complain(command, LC_BAD_INPUT, "--%s: '%s' is not %s", o->name, value, expected);
    return LC_ARGS_BAD;
}

static lc_args_result store(const lc_command *command, const lc_option *o, const char *value)
{
    char *end, expected[96];
    errno = 0;
    switch (o->kind) {
    case LC_OPT_FLAG:
        *(int *)o->target = 1;
        break;
    case LC_OPT_STRING:
        *(const char **)o->target = value;
        break;
    case LC_OPT_LIST:
        if (!append(o->target, value)) {
            lc_complain(command, LC_FAULT, "out of memory");
            return LC_ARGS_BAD;
        }
        break;
    case LC_OPT_CHOICE:
        if (!is_one_of(value, o->choices))
            return bad_value(command, o, value, o->choices);
        *(const char **)o->target = value;
        break;
    case LC_OPT_INT: {
        long number = strtol(value, &end, 10);
        snprintf(expected, sizeof expected, "a whole number from %.0f to %.0f", o->least, o->most);
        if (end == value || *end || errno || (double)number < o->least || (double)number > o->most)
            return bad_value(command, o, value, expected);
        *(int *)o->target = (int)number;
        break;
    }
    case LC_OPT_UINT64: {
        unsigned long long number = strtoull(value, &end, 10);
        if (end == value || *end || errno || value[0] == '-')
            return bad_value(command, o, value, "a whole number from 0 to 2^64 - 1");
        *(uint64_t *)o->target = number;
        break;
    }
    case LC_OPT_NUMBER: {
        double number = strtod(value, &end);
        if (end != value && *end == '%') {
            number /= 100;
            ++end;
        }
        snprintf(expected, sizeof expected, "a number above %g and at most %g", o->least, o->most);
        if (end == value || *end || errno || !(number > o->least && number <= o->most))
            return bad_value(command, o, value, expected);
        *(double *)o->target = number;
        break;
    }
    }
    return LC_ARGS_OK;
}

/* The option that argv element `arg` names, and its value where that stands behind '='. */
static const lc_option *find(const lc_option *options, const char *arg, const char **value)
{
    *value = NULL;
    for (const lc_option *o = options; o->name; ++o) {
        size_t length = strlen(o->name);
        if (arg[1] == '-' && strncmp(arg + 2, o->name, length) == 0 &&
            (arg[2 + length] == 0 || arg[2 + length] == '=')) {
            *value = arg[2 + length] ? arg + 3 + length : NULL;
            return o;
        }
        if (arg[1] != '-' && o->letter && arg[1] == o->letter) {
            *value = arg[2] ? arg + 2 : NULL;
            return o;
        }
    }
    return NULL;
}

/* `given`: a bit for each option that was there before. Of two values one would be dropped without a word, and a run over two
 * scenes would be one over the last. */
static lc_args_result read_option(uint64_t *given, const lc_command *command, const lc_option *options, int argc, char **argv, int *i)
{
    const char *value, *arg = argv[*i];
    const lc_option *o = find(options, arg, &value);
    if (!o) {
        lc_complain(command, LC_BAD_INPUT, "unknown option %s; `lightcheck %s --help` lists them", arg, command->name);
        return LC_ARGS_BAD;
    }
    if (o->kind == LC_OPT_FLAG) {
        if (value) {
            lc_complain(command, LC_BAD_INPUT, "--%s takes no value", o->name);
            return LC_ARGS_BAD;
        }
    } else if (!value) {
        if (*i + 1 >= argc) {
            lc_complain(command, LC_BAD_INPUT, "--%s needs a value: %s", o->name, o->value);
            return LC_ARGS_BAD;
        }
        value = argv[++*i];
    }
    uint64_t bit = (uint64_t)1 << (o - options);
    if ((*given & bit) && o->kind != LC_OPT_FLAG && o->kind != LC_OPT_LIST) {
        lc_complain(command, LC_BAD_INPUT, "--%s: given twice, the second time with %s; it takes one value", o->name, value);
        return LC_ARGS_BAD;
    }
    *given |= bit;
    return store(command, o, value);
}

lc_args_result lc_args_read(const lc_command *command, const lc_option *options, int argc, char **argv,
                            lc_strings *rest)
{
    rest->items = NULL;
    rest->count = 0;
    int only_rest = 0;
    uint64_t given = 0;
    for (int i = 1; i < argc; ++i) {
        if (!only_rest && (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0)) {
            print_help(command, options);
            return LC_ARGS_HELP;
        }
        if (!only_rest && strcmp(argv[i], "--") == 0) {
            only_rest = 1;
        } else if (!only_rest && argv[i][0] == '-' && argv[i][1]) {
            lc_args_result result = read_option(&given, command, options, argc, argv, &i);
            if (result != LC_ARGS_OK)
                return result;
        } else if (!append(rest, argv[i])) {
            lc_complain(command, LC_FAULT, "out of memory");
            return LC_ARGS_BAD;
        }
    }
    return LC_ARGS_OK;
}

int lc_command_run(const lc_command *command, const lc_option *options, int argc, char **argv, int least, int most,
                   const char *expected, lc_command_fn *body, void *user)
{
    lc_strings rest;
    lc_error err = {""};
    int status = LC_BAD_INPUT;
    lc_args_result read = lc_args_read(command, options, argc, argv, &rest);
    if (read == LC_ARGS_HELP)
        status = LC_OK;
    else if (read == LC_ARGS_OK && (rest.count < least || rest.count > most))
        status = lc_complain(command, LC_BAD_INPUT, "%s", expected);
    else if (read == LC_ARGS_OK) {
        status = (int)body(user, &rest, &err);
        if (err.text[0])
            lc_complain(command, (lc_status)status, "%s", err.text);
    }
    for (const lc_option *o = options; o->name; ++o)
        if (o->kind == LC_OPT_LIST)
            lc_strings_release(o->target);
    lc_strings_release(&rest);
    return status;
}
