#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The suite `proof`, a scene at a time: margins of 0.05% max(1, c), hours. Each scene's report goes to FOLDER when it is done, and a
# scene that is there is not run again; those of another build of the program do not count. Then prints all of them as
# one table in Markdown. Fails when any row was not PASS.
#
# usage: proof.sh PROGRAM FOLDER [SCENE]
set -u
program=$1 folder=$2 scene=${3:-}
shards=128 # more than there are scenes, so that each has one of its own
build=$(cksum < "$program" | cut -d ' ' -f 1)
mkdir -p "$folder" || exit 4
running=$folder/running.txt

run() { # NAME OPTIONS...
    done=$folder/$build.$1.txt
    shift
    [ -f "$done" ] && return
    "$program" verify --suite proof "$@" > "$running" 2> "$folder/error.txt"
    status=$?
    case $status in
    0 | 1 | 3) tail -n 1 "$running" >&2 ;;
    2) grep -q 'nothing to verify' "$folder/error.txt" || { cat "$folder/error.txt" >&2; exit 2; } ;;
    *) cat "$folder/error.txt" >&2; exit $status ;;
    esac
    mv "$running" "$done"
}

if [ -n "$scene" ]; then
    run "$scene" --scene "$scene"
    set -- "$folder/$build.$scene.txt"
else
    i=0
    set --
    while [ $i -lt $shards ]; do
        run $i --shard $i/$shards
        set -- "$@" "$folder/$build.$i.txt"
        i=$((i + 1))
    done
fi

printf '# The suite `proof`%s\n\n' "${scene:+: $scene}"
printf 'Made by `make proof%s`, seed 1, %s.\n\n```text\n' "${scene:+ SCENE=$scene}" "$("$program" --version)"
awk '
    FNR == 1 { table = 1; if (NR > 1) next }
    /^$/ { table = 0 }
    table { print }
    / rows: .* PASS, / { rows += $1; pass += $3; fail += $5; undecided += $7
                         for (i = 8; i < NF; ++i) if ($i == "M" && $(i + 1) == "paths;") paths += $(i - 1) }
    /^false |^ +[0-9]+ x / { if (!(FILENAME in seen)) { seen[FILENAME] = 1; split("", lines); n = 0 }; lines[++n] = $0 }
    END {
        print ""
        for (i = 1; i <= n; ++i) print lines[i]
        printf "%d rows: %d PASS, %d FAIL, %d UNDECIDED; %d M paths\n```\n", rows, pass, fail, undecided, paths
        exit pass != rows || !rows
    }' "$@"
