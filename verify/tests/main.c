/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>

#include "verify/tests/tests.h"

/* Every suite, one line each. */
static Suite *(*const suites[])(void) = {
    lc_suite_affine,   lc_suite_scene_read,     lc_suite_status,        lc_suite_film,
    lc_suite_analytic, lc_suite_outfile,        lc_suite_exr,           lc_suite_png,
    lc_suite_stats,    lc_suite_stats_estimate, lc_suite_stats_pyramid, lc_suite_analytic_direct,
    lc_suite_sampler,  lc_suite_warp,           lc_suite_camera,        lc_suite_accel,
    lc_suite_surface,  lc_suite_render,         lc_suite_bsdf,          lc_suite_energy,
    lc_suite_cli,      lc_suite_report,         lc_suite_estimators,    lc_suite_judge_mutants,
    lc_suite_pov_sample, lc_suite_povray,   lc_suite_verify,         lc_suite_mutants,       lc_suite_sensitivity,
    lc_suite_effects,  lc_suite_motion,         lc_suite_nee,           lc_suite_metamorphic,
    lc_suite_family,   lc_suite_convergence,    lc_suite_lecture,
    lc_suite_diagnose, lc_suite_scene_write,    lc_suite_adapter,
    lc_suite_plugin,   lc_suite_jail,
    lc_suite_similarity, lc_suite_roster, lc_suite_pool, lc_suite_handins,
    lc_suite_formats,  lc_suite_class,          lc_suite_assignment,    lc_suite_grade,
    lc_suite_rehearse, lc_suite_pictures,
};

int main(void)
{
    SRunner *runner = srunner_create(NULL);
    for (size_t i = 0; i < sizeof suites / sizeof suites[0]; ++i)
        srunner_add_suite(runner, suites[i]());
    srunner_run_all(runner, CK_ENV);
    int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
