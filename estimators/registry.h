/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every estimator that the program ships. */
#ifndef LC_REGISTRY_H
#define LC_REGISTRY_H

#include "lightcheck.h"

extern const lc_estimator *const lc_estimators[]; /* ends with NULL */

#endif
