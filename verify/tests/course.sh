#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: course.sh PROGRAM
# What a teacher meets beside the class of class.sh: mistakes of an assignment, hints, pictures, hand-ins of odd names and kinds, a folder of
# results in the wrong place. Exit status 0: each goes as the guides say, 1: one does not.
set -eu
program=$(cd "$(dirname "$1")" && pwd)/${1##*/}
cd "$(dirname "$0")/../.."
project=$PWD
handins=$PWD/verify/tests/handins
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
trap 'exit 1' HUP INT TERM
cd "$folder"
ln -s "$project/scenes" .
mkdir verify && ln -s "$project/verify/assignments" verify
failed=0
wrong() {
    printf 'course: %s\n' "$1" >&2
    failed=$((failed + 1))
}

# grade STATUS ARGUMENTS: output in out and err.
grade() {
    expected=$1 status=0
    shift
    "$program" grade "$@" >out 2>err || status=$?
    [ $status = "$expected" ] || wrong "grade $*: exit status $status, expected $expected: $(tail -n 3 err)"
}
# says TEXT FILE...: the text stands in one of them.
says() {
    text=$1
    shift
    grep -qF -e "$text" "$@" || wrong "no '$text' in $*: $(cat "$@")"
}

# Two tests that take no time.
cat >tiny.json <<'END'
{"title": "Tiny", "reference": "light_direct", "bounces": 1, "margin": 0.05, "cpu_seconds": 20, "hints": {"show": "none", "after_attempts": 2},
 "tests": [
  {"name": "compiles", "title": "C", "kind": "descriptor", "points": 1},
  {"name": "rectangle", "title": "R", "kind": "check", "check": "analytic", "points": 2, "requires": ["compiles"], "scenes": ["plane_rectangle"],
   "hint": "think"}]}
END
cp "$handins/all_lights.c" right.c
sed 's/weight \*= fmax/weight = fmax/' right.c >wrong.c

# ---- an assignment's mistakes: once, with their line, and nothing is graded ----

mkdir few
cp right.c few/ann.c
cp wrong.c few/bob.c
sed 's/"check": "analytic"/"check": "furnace"/' tiny.json >mistaken.json
grade 2 few -a mistaken.json -o mistaken
says 'mistaken.json:4: test rectangle: the check furnace says nothing about light_direct' err
sed 's/"bounces": 1/&, "sentences": "none.json"/' tiny.json >mistaken.json
grade 2 few -a mistaken.json -o mistaken
says "mistaken.json:1: sentences: cannot read 'none.json'" err
grade 2 few -a tiny.json --only rectangel -o mistaken
says "there is no test 'rectangel'; it has: compiles, rectangle" err
[ ! -e mistaken ] || wrong 'something was graded by an assignment with mistakes'

# ---- hints: of a class at once, unless it is due later, or --attempt says which it is ----

grade 0 few -a tiny.json -o hinted
says 'hint: think' hinted/feedback/bob.c.txt
! grep -q hint hinted/feedback/ann.c.txt || wrong 'a hint for what is right'
sed 's/"bounces": 1/&, "due": "2999-01-01T00:00:00Z"/' tiny.json >later.json
grade 0 few -a later.json -o later
! grep -q hint later/feedback/bob.c.txt || wrong 'a hint at the first attempt, long before it is due'
grade 0 few -a later.json -o later2 --attempt 2
says 'hint: think' later2/feedback/bob.c.txt
grade 1 few/bob.c -a tiny.json
! grep -q hint out || wrong 'a hint at the first attempt'
grade 1 few/bob.c -a tiny.json --attempt 2
says 'hint: think' out

[ $failed = 0 ]
