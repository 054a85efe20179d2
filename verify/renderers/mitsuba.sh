#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Adapter of `lightcheck verify --renderer`: Mitsuba 3. PYTHON, VARIANT and INTEGRATOR choose; see mitsuba_adapter.py.
exec "${PYTHON:-python3}" "$(dirname "$0")/mitsuba_adapter.py" "$@"
