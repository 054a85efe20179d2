/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Three pictures of a test: yours, the reference, and the difference, red where yours is brighter.
 */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "io/scene_path.h"
#include "verify/grade/grading.h"

static lc_status make_folders(const char *report, const char *below, lc_error *err)
{
    char path[LC_PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", report, below);
    if ((mkdir(report, 0777) == 0 || errno == EEXIST) && (mkdir(path, 0777) == 0 || errno == EEXIST))
        return LC_OK;
    return lc_fail(err, LC_FAULT, "%s: cannot make the folder: %s", path, strerror(errno));
}

lc_status lc_grade_pictures(lc_grading *g, const lc_seen *seen, lc_test_result *out, lc_error *err)
{
    static const char *const ends[] = {"yours", "reference", "difference"};
    const char *below = g->options->report_below ? g->options->report_below : "";
    char names[3][sizeof out->pictures[0]], text[3][LC_PATH_SIZE];
    if (!seen->film || (!seen->expected && !seen->other && !seen->difference) ||
        (seen->other && seen->other->count != seen->film->count))
        return LC_OK;
    for (int i = 0; i < 3; ++i)
        if (snprintf(names[i], sizeof names[i], "%s%s%s_%s.png", below, below[0] ? "/" : "", out->name, ends[i]) >= (int)sizeof names[i] ||
            snprintf(text[i], sizeof text[i], "%s/%s", g->options->report, names[i]) >= (int)sizeof text[i])
            return lc_fail(err, LC_BAD_INPUT, "the path of the report's folder is too long");
    lc_status status = make_folders(g->options->report, below, err);
    if (status != LC_OK)
        return status;
    const char *const paths[LC_PICTURES] = {NULL, NULL, NULL, text[0], text[1], text[2]};
    lc_exhibit evidence = {seen->film, seen->other, NULL, seen->difference, NULL};
    if (seen->expected) {
        evidence.expected = seen->expected->rgb;
        evidence.skip = seen->expected->skip;
    }
    status = lc_pictures_write(paths, &evidence, out->measured.channel, err);
    for (int i = 0; i < 3 && status == LC_OK; ++i)
        strcpy(out->pictures[i], names[i]);
    return status;
}
