#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: run.sh TESTS
# Runs every suite of the program TESTS in a process of its own, as many at a time as there are cores. Of each, its output
# as one piece; at the end, their sum. Exit status 0: all passed, 1: not.
set -eu
tests=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
trap 'exit 1' HUP INT TERM

"$tests" names >"$folder/names"
status=0
# Timeouts are for what hangs, and are meant for a test that has the machine for itself.
export CK_TIMEOUT_MULTIPLIER="${CK_TIMEOUT_MULTIPLIER:-5}"
# shellcheck disable=SC2016
TESTS=$tests FOLDER=$folder xargs -n 1 -P "$(getconf _NPROCESSORS_ONLN)" sh -c '
    start=$(date +%s) status=0
    "$TESTS" "$0" >"$FOLDER/$0" 2>&1 || status=$?
    text=$(grep -v "^Running suite" "$FOLDER/$0")
    printf "%s (%d s): %s\n" "$0" "$(($(date +%s) - start))" "$text"
    exit $((status != 0))
' <"$folder/names" || status=1
awk -v suites="$(wc -l <"$folder/names")" '
    match($0, /[0-9]+%: Checks: [0-9]+, Failures: [0-9]+, Errors: [0-9]+/) {
        split(substr($0, RSTART, RLENGTH), word, /[ ,]+/)
        ++seen
        checks += word[3]
        failures += word[5]
        errors += word[7]
    }
    END {
        printf "tests: %d of %d suites, %d checks, %d failures, %d errors\n", seen, suites, checks, failures, errors
        exit !(suites > 0 && seen == suites && failures + errors == 0)
    }
' "$folder"/* || status=1
exit $status
