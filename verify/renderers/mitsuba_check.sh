#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# mitsuba_check.sh [SCENE ...]: every scene (or these) in Mitsuba 3 and here, reflected light, compared within the joint error bars
# at every scale. Prints a table in Markdown; exit status 1 where two renders differ.
#
#   PYTHON=python3   an interpreter that can import mitsuba and numpy
#   REPLICATES=256   Mitsuba's independent renders, from which its variance comes
#   SPP=4            samples of each
set -u
cd "$(dirname "$0")/../.." || exit 4
python=${PYTHON:-python3}
replicates=${REPLICATES:-256}
spp=${SPP:-4}
program=build/lightcheck
work=$(mktemp -d) || exit 4
trap 'rm -rf "$work"' EXIT
"$python" -c 'import mitsuba, numpy' 2>/dev/null || {
    echo "mitsuba_check.sh: $python cannot import mitsuba and numpy; pip install mitsuba numpy, or set PYTHON" >&2
    exit 2
}
[ $# -gt 0 ] || set -- $("$program" list scenes)

# The estimator that sees all of the scene, and so the same as a path tracer of its depth.
estimator_of() {
    case $1 in
    glossy_sky) echo glossy_direct ;;
    sky | *mirror* | *glass* | critical_angle | bright_* | thermal_*) echo dielectric ;;
    *) echo light_direct ;;
    esac
}

worst=0
echo "| scene, estimator | ours / Mitsuba | z of the image | largest z of a tile | tiles | |"
echo "|---|---|---|---|---|---|"
for scene; do
    case $scene in motion_*) # the named exception: Mitsuba 3 has no moving shapes, and must say so
        if "$python" verify/renderers/mitsuba_render.py "scenes/$scene.xml" "$work/theirs.exr" --spp 1 --seed 1 >"$work/log" 2>&1 ||
            ! grep -q '"motion"' "$work/log"; then
            echo "| $scene | | | | | NOT REFUSED |"
            worst=1
        else
            echo "| $scene | | | | | refused: an unknown property \"motion\" |"
        fi
        continue
        ;;
    esac
    estimator=$(estimator_of "$scene")
    "$program" render "$scene" -e "$estimator" -s 4096 --min-bounces 1 --seed 7 -o "$work/ours.exr" >"$work/said" || exit 4
    bounces=$(sed 's/.*bounces 1 to \([0-9]*\).*/\1/' "$work/said")
    "$python" verify/renderers/mitsuba_render.py "scenes/$scene.xml" "$work/theirs.exr" --spp $((replicates * spp)) --replicates "$replicates" \
        --bounces "$bounces" --min-bounces 1 --seed 1000 >/dev/null 2>"$work/log" || { cat "$work/log" >&2; exit 4; }
    "$python" verify/renderers/joint_errors.py "$work/ours.exr" "$work/theirs.exr" "$scene, $estimator, bounces 1 to $bounces" || worst=1
done
exit $worst
