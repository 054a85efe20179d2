#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Adapter of `lightcheck verify --renderer`: POV-Ray 3.7, by the exporter and the runner of the povray check. What a seed means to
# a program that draws no random numbers is told in pov_sample.h.
program=${LIGHTCHECK:-$(dirname "$0")/../../build/lightcheck}
if [ "$1" = --describe ]; then
    printf '%s\n' name=povray batch=64 rounding=1e-5
    exit 0
fi
command -v povray >/dev/null || { echo "there is no program povray"; exit 4; }
scene=$1 size=$2x$3 samples=$4 bounces=$6 first=$5 out=$7
shift 7
set -- "$first" "$out" "$@"
# POV-Ray spends most of its time asleep: eight at once.
while [ $# -gt 0 ]; do
    children=
    while [ $# -gt 0 ] && [ "$(echo $children | wc -w)" -lt 8 ]; do
        "$program" export "$scene" --to pov --bounces "$bounces" --size "$size" --samples "$samples" --seed "$1" --image "$2" &
        children="$children $!"
        shift 2
    done
    for child in $children; do
        wait "$child" || exit
    done
done
