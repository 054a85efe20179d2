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

# ---- what an assignment names: sentences, scenes of its own; those of hidden tests are for the autograder only ----

mkdir "$folder/own" "$folder/own/mine"
cp scenes/plane_rectangle.xml "$folder/own/mine/seen.xml"
cp scenes/plane_disk.xml "$folder/own/mine/secret.xml"
echo '{"label_score": "{score} von {points} Punkten"}' >"$folder/own/de.json"
cat >"$folder/own/own.json" <<'END'
{"title": "Own", "reference": "light_direct", "bounces": 1, "margin": 0.05, "sentences": "de.json", "tests": [
 {"name": "seen", "title": "A", "kind": "mean", "points": 1, "scenes": ["mine/seen.xml"]},
 {"name": "secret", "title": "B", "kind": "mean", "points": 2, "scenes": ["mine/secret.xml", "mine/seen.xml"], "visibility": "hidden"}]}
END
rm -rf "$kit"
sh verify/grade/kit/make_kit.sh "$program" "$kit" "$folder/own/own.json"
[ ! -e "$kit/assignments/mine/secret.xml" ] && ! grep -rq secret "$kit/assignments" || wrong 'a scene of a hidden test in the kit'
works 0 list assignments
[ "$(grep -c Own "$folder/out")" = 1 ] || wrong "list assignments: $(cat "$folder/out")"
works 0 grade all_lights.c -a own
grep -q '^1 von 1 Punkten' "$folder/out" || wrong "not in the course's words: $(tail -n 1 "$folder/out")"
if command -v zip >/dev/null && command -v unzip >/dev/null; then
    sh verify/grade/gradescope/make_zip.sh "$program" "$folder/own/own.json" "$folder/own.zip"
    unzip -q "$folder/own.zip" -x 'lightcheck/*' -d "$folder/source"
    works 0 grade all_lights.c -a "$folder/source/assignment/own.json"
    grep -q '^3 von 3 Punkten' "$folder/out" || wrong "of the autograder: $(tail -n 1 "$folder/out")"
    rm -r "$folder/source"
else
    echo 'student kit: no zip, or no unzip: the autograder is left out'
fi
# refused WHAT: the assignment cannot be given away, which is said.
refused() {
    rm -rf "$kit"
    status=0
    sh verify/grade/kit/make_kit.sh "$program" "$kit" "$folder/own/own.json" ${2:+"$2"} >"$folder/out" 2>&1 || status=$?
    [ $status = 2 ] && grep -q "$1" "$folder/out" || wrong "exit status $status, no '$1': $(cat "$folder/out")"
}
mkdir "$folder/other"
sed 's/"mine/"..\/own\/mine/g' "$folder/own/own.json" >"$folder/other/other.json"
cp "$folder/own/de.json" "$folder/other"
refused 'names ../own/mine/seen.xml: put it beside' "$folder/other/other.json"
cp "$folder/own/own.json" "$folder/other/other.json"
cp -R "$folder/own/mine" "$folder/other"
echo '{}' >"$folder/other/de.json"
refused 'names de.json, and another de.json is there' "$folder/other/other.json"
rm "$folder/own/mine/secret.xml"
refused "own.json:3: number 1: cannot read 'mine/secret.xml'"
sh verify/grade/kit/make_kit.sh "$program" "$folder/again"
kit=$folder/again

[ -x "$kit/setup.sh" ] && sh "$kit/setup.sh" --help >/dev/null || wrong 'setup.sh does not run'
grep -q '^RUN /lightcheck/setup.sh$' "$kit/Dockerfile" || wrong 'the Dockerfile does not call setup.sh'

echo "student kit: $(find "$kit" -type f | wc -l) files, $(du -sk "$kit" | cut -f 1) KiB, $failed wrong"
[ $failed = 0 ]
