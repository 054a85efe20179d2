#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: kit.sh PROGRAM
# What `make student-kit` gives to students: it works where there is no source tree, and holds no line of a solution.
# Exit status 0: both true, 1: something is not.
set -eu
cd "$(dirname "$0")/../.."
project=$PWD
program=$(cd "$(dirname "$1")" && pwd)/${1##*/}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
trap 'exit 1' HUP INT TERM
kit=$folder/kit
failed=0
wrong() {
    printf 'kit: %s\n' "$1" >&2
    failed=$((failed + 1))
}

# Statements of the solutions and the mutants that stand in no file which students get anyway.
cat src/core/lightcheck.h estimators/template.c docs/student.md | sed 's/^ *//' >"$folder/public"
ls estimators/*.c verify/mutants/*.c | grep -v -e template.c -e registry.c | xargs cat |
    sed -n 's/^ *\(.\{20,\};\)$/\1/p' | grep -vxF -f "$folder/public" | sort -u >"$folder/solutions"
[ "$(wc -l <"$folder/solutions")" -gt 200 ] || wrong 'found hardly a line of the solutions'

# Where a solution, or a folder of them, is in the kit.
leaks() {
    grep -rlaF -f "$folder/solutions" "$kit" || :
    find "$kit" -name 'estimators' -o -name 'mutants'
}

sh verify/grade/kit/make_kit.sh "$program" "$kit"
grep -q '"visibility": "\(hidden\|after_[a-z_]*\)"' verify/assignments/light_direct.json || wrong 'no hidden test to be left out'
! grep -rE '"visibility": "(hidden|after_[a-z_]*)"|"solutions"|"mutants_of"' "$kit/assignments" || wrong 'hidden tests in the kit'
[ -z "$(leaks)" ] || wrong "solutions in $(leaks)"

# A test that cannot fail is none.
sed -n '/^static/,$p' estimators/light_direct.c >"$kit/hint.txt"
[ "$(leaks)" = "$kit/hint.txt" ] || wrong 'a solution in the kit is not found'
rm "$kit/hint.txt"

# works STATUS COMMAND: with nothing of this project within reach but the kit.
works() {
    expected=$1 status=0
    shift
    (cd "$folder/course" && env -i PATH=/usr/local/bin:/usr/bin:/bin "$kit/build/lightcheck" "$@") >"$folder/out" 2>&1 || status=$?
    [ "$status" = "$expected" ] || wrong "lightcheck $*: exit status $status: $(tail -n 2 "$folder/out")"
}
mkdir "$folder/course"
cp verify/tests/handins/all_lights.c "$folder/course"
sed 's/weight \*= fmax/weight = fmax/' "$folder/course/all_lights.c" >"$folder/course/no_cosine.c"
works 0 new mine
works 0 render cornell -e mine.c -s 1 --size 8x8 -o mine.png
works 0 verify -e all_lights.c -c analytic --scene plane_disk
works 1 verify -e no_cosine.c -c analytic --scene plane_disk
works 0 grade all_lights.c -a light_direct
works 1 grade no_cosine.c -a light_direct
[ -x "$kit/setup.sh" ] && sh "$kit/setup.sh" --help >/dev/null || wrong 'setup.sh does not run'
grep -q '^RUN /lightcheck/setup.sh$' "$kit/Dockerfile" || wrong 'the Dockerfile does not call setup.sh'

echo "student kit: $(find "$kit" -type f | wc -l) files, $(du -sk "$kit" | cut -f 1) KiB, $failed wrong"
[ $failed = 0 ]
