/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Three pictures of a test: yours, the reference, and the difference, red where yours is brighter.
 */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "verify/grade/grading.h"

lc_status lc_grade_pictures(lc_grading *g, const lc_seen *seen, lc_test_result *out, lc_error *err)
{
    static const char *const ends[] = {"yours", "reference", "difference"};
    char text[3][1400];
    if (!seen->film || (!seen->expected && !seen->other && !seen->difference) ||
        (seen->other && seen->other->count != seen->film->count))
        return LC_OK;
    if (mkdir(g->options->report, 0777) != 0 && errno != EEXIST)
        return lc_fail(err, LC_FAULT, "%s: cannot make the folder: %s", g->options->report, strerror(errno));
    for (int i = 0; i < 3; ++i)
        if (snprintf(text[i], sizeof text[i], "%s/%s_%s.png", g->options->report, out->name, ends[i]) >= (int)sizeof text[i])
            return lc_fail(err, LC_BAD_INPUT, "the path of the report's folder is too long");
    const char *const paths[LC_PICTURES] = {NULL, NULL, NULL, text[0], text[1], text[2]};
    lc_exhibit evidence = {seen->film, seen->other, NULL, seen->difference, NULL};
    if (seen->expected) {
        evidence.expected = seen->expected->rgb;
        evidence.skip = seen->expected->skip;
    }
    lc_status status = lc_pictures_write(paths, &evidence, out->measured.channel, err);
    for (int i = 0; i < 3 && status == LC_OK; ++i)
        snprintf(out->pictures[i], sizeof out->pictures[i], "%s_%s.png", out->name, ends[i]);
    return status;
}
