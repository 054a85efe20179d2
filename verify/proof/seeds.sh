#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The quick suite with one seed after another: does a right estimator ever FAIL or end UNDECIDED by chance? Appends what each seed
# gave to RECORD, where it goes on if it was stopped; seeds of another build of the program do not count. Then prints a
# table in Markdown. Fails when any row was not PASS. Seed 1 is left out: results/verify.md shows it.
#
# usage: seeds.sh PROGRAM RECORD SEEDS [SHARDS]
# SHARDS: each seed takes one scene in SHARDS only, the next seed the next ones.
set -u
program=$1 record=$2 seeds=$3 shards=${4:-1}
build=$(cksum < "$program" | cut -d ' ' -f 1)
report=$(mktemp)
trap 'rm -f "$report"' EXIT
trap 'exit 1' INT TERM

touch "$record" || exit 4
seed=1
while [ "$seed" -le "$seeds" ]; do
    seed=$((seed + 1))
    key="$build $shards $seed"
    grep -q "^seed $key " "$record" && continue
    "$program" verify --suite quick --seed "$seed" --shard "$((seed % shards))/$shards" > "$report"
    status=$?
    case $status in 0 | 1 | 3) ;; *) exit $status ;; esac
    # Rows first, the seed's line last: without it the seed is run again.
    {
        awk -v key="$key" '/^[a-z]/ && ($5 == "FAIL" || $5 == "UNDECIDED") { print "row", key, $5, $1, $2, $3, $4 }' "$report"
        sed -n "s/^\([0-9]*\) rows: \([0-9]*\) PASS, \([0-9]*\) FAIL, \([0-9]*\) UNDECIDED;.*; \([0-9]*\) M paths;.*/seed $key \1 \2 \3 \4 \5/p" "$report"
    } >> "$record"
    grep "^seed $key " "$record" >&2 || exit 4
done

awk -v build="$build" -v shards="$shards" -v seeds="$seeds" -v version="$("$program" --version)" '
    $2 != build || $3 != shards || $4 > seeds + 1 { next }
    # Of a seed that was stopped and run again the rows are there twice.
    $1 == "row" { line = sprintf("| %d | %s | %s | %s | %s | %s |\n", $4, $5, $6, $7, $8, $9)
                  if (!(line in met)) { met[line] = 1; bad = bad line } }
    $1 == "seed" { ++n; rows += $5; pass += $6; fail += $7; undecided += $8; paths += $9
                   each = each sprintf("| %d | %d | %d | %d | %d | %d |\n", $4, $5, $6, $7, $8, $9) }
    END {
        print "# The quick suite with other seeds\n"
        print "Made by `make seeds" (shards > 1 ? " SHARDS=" shards : "") (seeds != 50 ? " SEEDS=" seeds : "") "`, " version "."
        print "Every estimator here is right: each FAIL would be a false one, each UNDECIDED a row planned too tightly.\n"
        if (shards > 1) print "Each seed takes one scene in " shards ", the next seed the next ones.\n"
        print "| seed | rows | PASS | FAIL | UNDECIDED | M paths |\n|---|---|---|---|---|---|"
        printf "%s| all %d | %d | %d | %d | %d | %d |\n", each, n, rows, pass, fail, undecided, paths
        if (bad) printf "\n| seed | verdict | check | scene | estimator | k |\n|---|---|---|---|---|---|\n%s", bad
        exit n != seeds || pass != rows
    }' "$record"
