#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Adapter of `lightcheck verify --renderer`: lightcheck itself, which ought to pass. ESTIMATOR=dielectric chooses.
program=${LIGHTCHECK:-$(dirname "$0")/../../build/lightcheck}
if [ "$1" = --describe ]; then
    echo "name=lightcheck"
    echo "emitters=area,sky"
    exit 0
fi
exec "$program" render "$1" -e "${ESTIMATOR:-dielectric}" --size "$2x$3" -s "$4" --seed "$5" --bounces "$6" -o "$7"
