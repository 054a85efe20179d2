/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The suites that `make check` runs; each file test_NAME.c defines one, main.c lists them all. */
#ifndef LC_TESTS_H
#define LC_TESTS_H

#include <check.h>
#include <sys/types.h>

/* Where the code under test is wrong, root could replace a device by a file: tests that write to /dev/full do it as
 * nobody. Returns 0 when that cannot be had, and the test is to be left out; lc_test_restore_root() takes root back. */
int lc_test_drop_root(uid_t *before);
void lc_test_restore_root(uid_t before);

Suite *lc_suite_affine(void);
Suite *lc_suite_scene_read(void);
Suite *lc_suite_scene_write(void);
Suite *lc_suite_adapter(void);
Suite *lc_suite_replicates(void);
Suite *lc_suite_status(void);
Suite *lc_suite_film(void);
Suite *lc_suite_analytic(void);
Suite *lc_suite_outfile(void);
Suite *lc_suite_exr(void);
Suite *lc_suite_png(void);
Suite *lc_suite_stats(void);
Suite *lc_suite_stats_estimate(void);
Suite *lc_suite_stats_pyramid(void);
Suite *lc_suite_stats_tiles(void);
Suite *lc_suite_analytic_direct(void);
Suite *lc_suite_sampler(void);
Suite *lc_suite_warp(void);
Suite *lc_suite_camera(void);
Suite *lc_suite_accel(void);
Suite *lc_suite_surface(void);
Suite *lc_suite_render(void);
Suite *lc_suite_bsdf(void);
Suite *lc_suite_energy(void);
Suite *lc_suite_effects(void);
Suite *lc_suite_motion(void);
Suite *lc_suite_cli(void);
Suite *lc_suite_report(void);
Suite *lc_suite_estimators(void);
Suite *lc_suite_judge_mutants(void);
Suite *lc_suite_povray(void);
Suite *lc_suite_pov_sample(void);
Suite *lc_suite_verify(void);
Suite *lc_suite_mutants(void);
Suite *lc_suite_course(void);
Suite *lc_suite_plain(void);
Suite *lc_suite_plugin(void);
Suite *lc_suite_jail(void);
Suite *lc_suite_similarity(void);
Suite *lc_suite_roster(void);
Suite *lc_suite_pool(void);
Suite *lc_suite_handins(void);
Suite *lc_suite_formats(void);
Suite *lc_suite_assignment(void);
Suite *lc_suite_grade(void);
Suite *lc_suite_grade_again(void);
Suite *lc_suite_grade_fair(void);
Suite *lc_suite_class(void);
Suite *lc_suite_rehearse(void);
Suite *lc_suite_sensitivity(void);
Suite *lc_suite_nee(void);
Suite *lc_suite_metamorphic(void);
Suite *lc_suite_family(void);
Suite *lc_suite_lecture(void);
Suite *lc_suite_convergence(void);
Suite *lc_suite_diagnose(void);
Suite *lc_suite_pictures(void);

#endif
