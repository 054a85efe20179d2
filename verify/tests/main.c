/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * tests [NAME ...]: runs all suites, or those named; `tests names` prints the names. Exit status 0: all passed, 1: not,
 * 2: no such suite.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "verify/tests/tests.h"

/* Every suite, the longest first: they are run side by side (run.sh). */
static const struct {
    const char *name;
    Suite *(*make)(void);
} suites[] = {
    {"mutants", lc_suite_mutants},
    {"pov_sample", lc_suite_pov_sample},
    {"diagnose", lc_suite_diagnose},
    {"adapter", lc_suite_adapter},
    {"class", lc_suite_class},
    {"jail", lc_suite_jail},
    {"replicates", lc_suite_replicates},
    {"stats_tiles", lc_suite_stats_tiles},
    {"verify", lc_suite_verify},
    {"grade_fair", lc_suite_grade_fair},
    {"course", lc_suite_course},
    {"grade", lc_suite_grade},
    {"povray", lc_suite_povray},
    {"cli", lc_suite_cli},
    {"lecture", lc_suite_lecture},
    {"sensitivity", lc_suite_sensitivity},
    {"analytic_direct", lc_suite_analytic_direct},
    {"warp", lc_suite_warp},
    {"handins", lc_suite_handins},
    {"grade_again", lc_suite_grade_again},
    {"estimators", lc_suite_estimators},
    {"energy", lc_suite_energy},
    {"judge_mutants", lc_suite_judge_mutants},
    {"convergence", lc_suite_convergence},
    {"nee", lc_suite_nee},
    {"accel", lc_suite_accel},
    {"metamorphic", lc_suite_metamorphic},
    {"pictures", lc_suite_pictures},
    {"plugin", lc_suite_plugin},
    {"effects", lc_suite_effects},
    {"rehearse", lc_suite_rehearse},
    {"family", lc_suite_family},
    {"bsdf", lc_suite_bsdf},
    {"pool", lc_suite_pool},
    {"sampler", lc_suite_sampler},
    {"render", lc_suite_render},
    {"exr", lc_suite_exr},
    {"stats_estimate", lc_suite_stats_estimate},
    {"film", lc_suite_film},
    {"motion", lc_suite_motion},
    {"stats_pyramid", lc_suite_stats_pyramid},
    {"analytic", lc_suite_analytic},
    {"assignment", lc_suite_assignment},
    {"scene_read", lc_suite_scene_read},
    {"stats", lc_suite_stats},
    {"camera", lc_suite_camera},
    {"surface", lc_suite_surface},
    {"png", lc_suite_png},
    {"scene_write", lc_suite_scene_write},
    {"formats", lc_suite_formats},
    {"outfile", lc_suite_outfile},
    {"affine", lc_suite_affine},
    {"report", lc_suite_report},
    {"similarity", lc_suite_similarity},
    {"roster", lc_suite_roster},
    {"plain", lc_suite_plain},
    {"status", lc_suite_status},
};

enum { SUITE_COUNT = sizeof suites / sizeof suites[0] };

static int run(SRunner *runner)
{
    srunner_run_all(runner, CK_ENV);
    int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "names") == 0) {
        for (int i = 0; i < SUITE_COUNT; ++i)
            puts(suites[i].name);
        return EXIT_SUCCESS;
    }
    SRunner *runner = srunner_create(NULL);
    int wanted = argc > 1 ? argc - 1 : SUITE_COUNT, added = 0;
    for (int i = 0; i < SUITE_COUNT; ++i) {
        int named = argc == 1;
        for (int k = 1; k < argc; ++k)
            named |= strcmp(argv[k], suites[i].name) == 0;
        if (named)
            srunner_add_suite(runner, suites[i].make());
        added += named;
    }
    if (added == wanted)
        return run(runner);
    srunner_free(runner);
    fputs("tests: a suite that there is not; see `tests names`\n", stderr);
    return 2;
}
