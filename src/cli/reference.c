/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/commands.h"
#include "io/scene_path.h"
#include "verify/renderers/pov_reference.h"

typedef struct reference_arguments {
    const char *folder;
    int threads;
} reference_arguments;

/* mkdir -p of two levels: results/reference in a new checkout. */
static lc_status make_folder(const char *path, lc_error *err)
{
    char parent[LC_PATH_SIZE];
    snprintf(parent, sizeof parent, "%s", path);
    char *slash = strrchr(parent, '/');
    if (slash && slash != parent) {
        *slash = 0;
        mkdir(parent, 0777); /* what is wrong with it shows below */
    }
    if (mkdir(path, 0777) != 0 && errno != EEXIST)
        return lc_fail(err, LC_FAULT, "%s: cannot make the folder: %s", path, strerror(errno));
    return LC_OK;
}

static lc_status render_case(const lc_pov_case *c, const reference_arguments *a, lc_error *err)
{
    char path[LC_PATH_SIZE];
    lc_scene *scene = NULL;
    lc_pov_image image = {.rgb = NULL, .error = NULL};
    lc_status status = lc_scene_locate(path, c->scene, err);
    if (status == LC_OK)
        status = lc_cli_load_scene(&scene, c->scene, NULL, err);
    if (status == LC_OK)
        status = lc_pov_measure(&image, c, lc_scene_description(scene), a->threads, err);
    if (status == LC_OK)
        status = lc_pov_reference_write(a->folder, path, c, &image, err);
    if (status == LC_OK)
        printf("%-20s %dx%d, %.1f%% of the pixels beyond the band of %g%%, %.1f s of CPU\n", c->scene, image.width,
               image.height, 100 * lc_pov_share_left_out(&image, c->band), 100 * c->band, image.seconds);
    fflush(stdout);
    lc_pov_image_release(&image);
    lc_scene_free(scene);
    return status;
}

static int is_asked(const lc_pov_case *c, const lc_strings *names)
{
    for (int i = 0; i < names->count; ++i)
        if (strcmp(names->items[i], c->scene) == 0)
            return 1;
    return names->count == 0;
}

static lc_status render_references(void *user, const lc_strings *names, lc_error *err)
{
    const reference_arguments *a = user;
    int done = 0;
    lc_status status = make_folder(a->folder, err);
    for (const lc_pov_case *c = lc_pov_cases; status == LC_OK && c->scene; ++c) {
        if (!is_asked(c, names))
            continue;
        status = render_case(c, a, err);
        ++done;
    }
    if (status == LC_OK && done == 0)
        status = lc_fail(err, LC_BAD_INPUT, "the povray check has no such scene");
    return status;
}

static int run(const lc_command *self, int argc, char **argv)
{
    reference_arguments a = {.folder = "results/reference"};
    const lc_option options[] = {
        {'o', "out", LC_OPT_STRING, &a.folder, "DIR", "default results/reference", 0, 0, NULL},
        {0, "threads", LC_OPT_INT, &a.threads, "N", "of POV-Ray; default: one a core", 1, 64, NULL},
        {0, NULL, LC_OPT_FLAG, NULL, NULL, NULL, 0, 0, NULL},
    };
    return lc_command_run(self, options, argc, argv, 0, 1 << 20, NULL, render_references, &a);
}

const lc_command lc_command_reference = {
    "reference",
    "[SCENE ...] [-o DIR]",
    "renders the references of the povray check with POV-Ray",
    "Without SCENE: all of them, which takes minutes. Each is an image with the error of each pixel and a .json that "
    "says\n"
    "how it came to be; the check refuses one whose scene has changed since.\n",
    run,
};
