#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: gradescope.sh [ZIP] [ASSIGNMENT]
# Tries an autograder (made of light_direct, unless named) in a new minimal Debian laid out as Gradescope's image: the zip in
# /autograder/source, hand-ins in /autograder/submission, the result in /autograder/results. Exit status 0: each hand-in has the result
# that it earned, 1: one has not.
set -eu
cd "$(dirname "$0")/../.."
. verify/tests/root.sh
command -v unzip >/dev/null || fail 'unzip is missing'
make_root bookworm
zip=${1:-$folder/autograder.zip}
[ $# -gt 0 ] || sh verify/grade/gradescope/make_zip.sh build/lightcheck light_direct "$zip"
base=$root/autograder
mkdir -p "$base/source" "$base/submission" "$base/results"
unzip -q "$zip" -d "$base/source"
cp "$base/source/run_autograder" "$base/run_autograder"

# On a system that is too old it says so in one sentence.
cp "$root/usr/lib/os-release" "$folder/os-release"
printf 'ID=ubuntu\nVERSION_ID="22.04"\nPRETTY_NAME="Ubuntu 22.04.4 LTS"\n' >"$root/usr/lib/os-release"
status=0
inside 'sh /autograder/source/setup.sh' >"$log" 2>&1 || status=$?
expect 'old system' '^setup.sh: Ubuntu 22.04.4 LTS is too old, .*: use Ubuntu 24.04 or newer$' "$log"
[ "$status" = 2 ] && [ "$(wc -l <"$log")" = 1 ] || expect 'old system' '^one line and status 2$' "$log"
cp "$folder/os-release" "$root/usr/lib/os-release"

start=$(seconds)
inside 'sh /autograder/source/setup.sh' >"$log" 2>&1 || {
    tail -n 30 "$log"
    fail 'setup.sh failed'
}
echo "gradescope.sh: setup.sh in $(($(seconds) - start)) s"
[ ! -e "$base/source/lightcheck/estimators" ] || expect 'solutions' '^no solutions in the image$' "$log"

# grade ATTEMPT FILE...: the result of a hand-in of these files.
grade() {
    attempt=$1
    shift
    rm -rf "$base/submission" "$base/results"
    mkdir "$base/submission" "$base/results"
    [ $# = 0 ] || cp "$@" "$base/submission"
    previous=
    while [ "$attempt" -gt 1 ]; do
        previous="$previous${previous:+,}{\"submission_time\": \"2024-05-01T10:0$attempt:00.000000-07:00\", \"score\": 0.0, \"results\": {}}"
        attempt=$((attempt - 1))
    done
    cat >"$base/submission_metadata.json" <<METADATA
{"id": 1, "created_at": "2024-05-02T10:00:00.000000-07:00", "submission_method": "upload", "users": [{"email": "a@b", "id": 1, "name": "A"}],
 "assignment": {"due_date": "2024-05-03T10:00:00.000000-07:00", "id": 1, "title": "light", "total_points": "100.0"},
 "previous_submissions": [$previous]}
METADATA
    start=$(seconds)
    status=0
    inside 'cd / && /autograder/run_autograder' >"$log" 2>&1 || status=$?
    [ -e "$base/results/results.json" ] || cp "$log" "$base/results/results.json"
    echo "gradescope.sh: $* graded in $(($(seconds) - start)) s, exit status $status"
}

handins=$PWD/verify/tests/handins
results=$base/results/results.json
cp "$handins/all_lights.c" "$folder/right.c"
sed 's/weight \*= fmax/weight = fmax/' "$handins/all_lights.c" >"$folder/wrong.c"
sed 's/lc_black();/lc_black() this is no C;/' "$handins/all_lights.c" >"$folder/no_c.c"
sed 's/lc_rgb sum = lc_black();/for (volatile int i = 0; i < 1; i += 0) {}\n    &/' "$handins/all_lights.c" >"$folder/hangs.c"

most=$(sed -n 's/.*"points": *\([0-9.]*\).*/\1/p' "$base/source/assignment/light_direct.json" | awk '{ sum += $1 } END { print sum }')
grade 1 "$folder/right.c"
expect right "^  \"score\": $most\\(\\.0\\)\\?,\$" "$results"
expect right '"status": "passed"' "$results"
expect right '"attempt": 1,\?$' "$results"
seed=$(sed -n 's/^    "seed": "\([0-9]*\)",*$/\1/p' "$results")
grade 1 "$folder/right.c" # the same hand-in again: the same scenes, by a seed that is nobody's guess
expect right "^    \"seed\": \"$seed\",\?$" "$results"
case $seed in '' | 1) expect 'seed of its own' '^a seed that was drawn$' "$results" ;; esac
grade 4 "$folder/wrong.c"
expect wrong "Again: lightcheck grade wrong.c -a light_direct --seed $seed --only\|again: lightcheck grade wrong.c -a light_direct --seed $seed --only" "$results"
expect wrong '"code": "WA"' "$results"
expect wrong '"status": "failed"' "$results"
expect wrong '"attempt": 4,\?$' "$results"
grade 1 "$folder/no_c.c"
expect 'no C' '"code": "CE"' "$results"
expect 'no C' 'costs no attempt.*error' "$results"
grade 1 "$folder/hangs.c"
expect hangs '"code": "TLE"' "$results"
grade 1 "$folder/right.c" "$folder/wrong.c"
expect 'two files' 'expected one source file, and found 2' "$results"
grade 1
expect 'no file' 'there is no source file' "$results"

# Ended before Gradescope would do it: what is known until then stands. Of a right file, which has all tests to go through: one that hangs
# may be done with sooner.
start=$(seconds)
cp "$folder/right.c" "$base/submission"
rm -f "$results"
inside 'LIGHTCHECK_SECONDS=1 /autograder/run_autograder' >"$log" 2>&1 || cat "$log"
expect 'ended early' '"output": "not judged yet"' "$results"
echo "$passed passed, $failed failed"
[ $failed = 0 ]
