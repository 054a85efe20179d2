/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/commands.h"
#include "verify/grade/texts.h"

/* The template, with its name replaced. */
static void write_template(FILE *out, const char *name)
{
    static const char word[] = "template";
    const char *at = (const char *)lc_text_template_c;
    for (const char *next = strstr(at, word); next; next = strstr(at, word)) {
        fprintf(out, "%.*s%s", (int)(next - at), at, name);
        at = next + sizeof word - 1;
    }
    fputs(at, out);
}

static lc_status make(void *user, const lc_strings *rest, lc_error *err)
{
    (void)user;
    const char *name = rest->items[0];
    char path[80];
    size_t length = strlen(name);
    if (length > 63 || name[0] == 0 || strchr("0123456789", name[0]) ||
        strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_") != length)
        return lc_fail(err, LC_BAD_INPUT, "'%s' is no name of an estimator: 1 to 63 letters, digits and _, no digit first",
                       name);
    snprintf(path, sizeof path, "%s.c", name);
    int fd = open(path, O_WRONLY | O_CREAT | O_EXCL, 0666);
    if (fd < 0)
        return lc_fail(err, errno == EEXIST ? LC_BAD_INPUT : LC_FAULT, "%s: %s", path,
                       errno == EEXIST ? "is there already, and is not overwritten" : strerror(errno));
    FILE *out = fdopen(fd, "w");
    if (out)
        write_template(out, name);
    int failed = !out || ferror(out);
    if (out ? fclose(out) != 0 || failed : close(fd) != 0 || failed) {
        unlink(path);
        return lc_fail(err, LC_FAULT, "%s: cannot write", path);
    }
    printf("%s: an estimator of emitted light only; try `lightcheck render cornell -e %s`\n", path, path);
    return LC_OK;
}

static int run(const lc_command *self, int argc, char **argv)
{
    const lc_option options[] = {{0, NULL, LC_OPT_FLAG, NULL, NULL, NULL, 0, 0, NULL}};
    return lc_command_run(self, options, argc, argv, 1, 1, "expected one name, of letters, digits and _", make, NULL);
}

const lc_command lc_command_new = {
    "new", "NAME", "writes NAME.c, an estimator to start from", NULL, run,
};
