/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/grade_class.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "io/scene_path.h"
#include "verify/grade/class.h"
#include "verify/grade/seeds.h"

int lc_cli_is_folder(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

/* The folder beside scenes/. */
static const char *find_solutions(const char *given, char path[LC_PATH_SIZE])
{
    lc_error none;
    if (given)
        return given;
    if (lc_scene_locate(path, "cornell", &none) != LC_OK || strlen(path) + 32 > LC_PATH_SIZE)
        return NULL;
    strcpy(strrchr(path, '/') ? strrchr(path, '/') : path, "/../estimators");
    return lc_cli_is_folder(path) ? path : NULL;
}

static void on_handin(void *user, const char *line, int done, int count)
{
    (void)user;
    fprintf(stderr, "[%d/%d] %s\n", done, count, line);
}

static lc_status read_options(lc_class_options *out, const lc_cli_class *self, lc_error *err)
{
    if (self->solutions && !lc_cli_is_folder(self->solutions))
        return lc_fail(err, LC_BAD_INPUT, "--solutions %s: no such folder", self->solutions);
    if (!self->shard)
        return LC_OK;
    lc_status status = lc_cli_read_pair(&out->shard, &out->shards, self->shard, '/', "--shard", err);
    if (status == LC_OK && out->shard >= out->shards)
        return lc_fail(err, LC_BAD_INPUT, "--shard %s: expected I/N with 0 <= I < N", self->shard);
    if (status == LC_OK && !self->has_seed)
        return lc_fail(err, LC_BAD_INPUT, "--shard: all shards need the same --seed or --secret");
    return status;
}

/* Hints wait for some attempts, so that nobody finds a bug by handing in anew. A class is graded once all have handed in: what follows is
 * reading the feedback. Only before the due date a further attempt may come. */
static int is_over(const lc_assignment *assignment) { return !assignment->due || time(NULL) > assignment->due; }

/* What a person has to look at: no score of these is to be taken for one that was earned. */
static void report_counts(const lc_class_counts *n)
{
    if (n->ungradable)
        fprintf(stderr, "%d could not be graded and have no score: a person decides\n", n->ungradable);
    if (n->nobodys)
        fprintf(stderr, "%d are of nobody in the roster, and not in the gradebook\n", n->nobodys);
    if (n->missing)
        fprintf(stderr, "%d of the roster handed in nothing, which is 0\n", n->missing);
}

static lc_status conclude(const lc_class_options *o, const lc_class_counts *n, lc_error *err)
{
    char path[LC_PATH_SIZE];
    snprintf(path, sizeof path, "%s/gradebook.csv", o->folder);
    struct stat info;
    if (n->faults)
        return lc_fail(err, LC_FAULT, "%d could not be graded by a fault of ours (%s/logs): run it again with --resume", n->faults, o->folder);
    if (n->left == 0)
        report_counts(n);
    if (n->left == 0 && stat(path, &info) == 0)
        printf("%s, %s/class.txt, %s/feedback\n", path, o->folder, o->folder);
    else
        printf("%s: other shards are not there yet\n", o->folder);
    return LC_OK;
}

lc_status lc_cli_grade_class(const lc_cli_class *self, const lc_strings *words, const lc_assignment *assignment,
                             const lc_grade_options *grade, lc_error *err)
{
    char solutions[LC_PATH_SIZE], folder[128];
    lc_handins handins = {NULL, 0};
    lc_roster roster = {NULL, 0};
    lc_class_counts counts;
    snprintf(folder, sizeof folder, "grades-%s", assignment->name);
    /* Our own files may lie among the hand-ins, as when the folder of these is the working directory. */
    const char *own[5] = {self->folder ? self->folder : folder};
    int count = 1;
    if (self->roster)
        own[count++] = self->roster;
    if (grade->report)
        own[count++] = grade->report;
    if (self->secret)
        own[count++] = self->secret;
    const lc_handins_options which = {self->adapters, self->images, own};
    lc_class_options o = {.assignment = assignment,
                          .handins = &handins,
                          .folder = self->folder ? self->folder : folder,
                          .solutions = find_solutions(self->solutions, solutions),
                          .grade = *grade,
                          .at_once = self->jobs,
                          .resume = self->resume,
                          .shards = 1,
                          .seconds = 120 + 10 * assignment->cpu_seconds,
                          .on_handin = on_handin};
    if (self->jobs > 1)
        o.grade.threads = 1;
    o.grade.is_final = !self->has_attempt && is_over(assignment);
    lc_status status = read_options(&o, self, err);
    if (status == LC_OK)
        status = lc_handins_find(&handins, words->items, words->count, &which, err);
    if (status == LC_OK && self->resume)
        lc_class_read_seed(&o.grade.seed, o.folder);
    if (status == LC_OK && self->roster)
        status = lc_roster_read(&roster, self->roster, lc_seed_for(o.grade.seed, "pseudonyms"), err);
    if (status == LC_OK && self->roster)
        o.roster = &roster;
    if (status == LC_OK)
        status = lc_class_grade(&o, &counts, err);
    if (status == LC_OK)
        status = conclude(&o, &counts, err);
    lc_roster_release(&roster);
    lc_handins_release(&handins);
    return status;
}
