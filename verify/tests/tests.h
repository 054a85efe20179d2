/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The suites that `make check` runs; each file test_NAME.c defines one, main.c lists them all. */
#ifndef LC_TESTS_H
#define LC_TESTS_H

#include <check.h>

Suite *lc_suite_status(void);
Suite *lc_suite_analytic(void);
Suite *lc_suite_analytic_direct(void);

#endif
