#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Every mutant and every right variant through a suite: which checks kill, and with how many paths. Prints a table in Markdown;
# fails when a mutant survives or a variant is accused.
#
# usage: mutants.sh PROGRAM [SUITE [NAME ...]]
set -u
program=$1
suite=${2:-quick}
[ $# -gt 2 ] && shift 2 && names=$* || names=
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 1' INT TERM

run() { # KIND: one line a row of the report: kind, name, check, verdict, paths
    "$program" list "$1" | while read -r name rest; do
        [ -n "$names" ] && case " $names " in *" $name "*) ;; *) continue ;; esac
        "$program" verify --suite "$suite" -e "$name" --format json > "$work/one.json" 2> "$work/error"
        status=$?
        [ $status -eq 0 ] || [ $status -eq 1 ] || [ $status -eq 3 ] || {
            cat "$work/error" >&2
            echo "$1 $name - ERROR 0"
            continue
        }
        tr -d '",' < "$work/one.json" | awk -v kind="$1" -v name="$name" '
            $1 == "check:" { check = $2 }
            $1 == "verdict:" { verdict = $2 }
            $1 == "paths:" && check != "" { print kind, name, check, verdict, $2; check = "" }'
    done
}

run mutants > "$work/rows"
run variants >> "$work/rows"
awk -v suite="$suite" '
    function count(n) { return n >= 1e6 ? sprintf("%.1fM", n / 1e6) : sprintf("%.0fk", n / 1e3) }
    {
        if (!(($1, $2) in seen)) order[++total] = $1 SUBSEP $2
        seen[$1, $2] = 1
        verdicts[$1, $2, $4]++
        if ($1 == "mutants" && !(($2, $3) in met)) { met[$2, $3] = 1; checks[$3]++ }
        if ($4 == "FAIL") {
            if (!(($2, $3) in by)) { by[$2, $3] = 1; killers[$2] = killers[$2] (killers[$2] ? ", " : "") $3; kills[$3]++; number[$2]++; last[$2] = $3 }
            if (!($2 in paths) || $5 < paths[$2]) paths[$2] = $5
        }
        if ($4 == "ERROR") bad = bad "\n- " $2 ": the program failed"
    }
    END {
        printf "# Mutants: what the %s suite kills\n\nMade by `make mutants`.\n\n", suite
        print "| mutant | killed by | fewest paths | rows FAIL / PASS / UNDECIDED |\n|---|---|---|---|"
        for (i = 1; i <= total; ++i) {
            split(order[i], p, SUBSEP)
            f = verdicts[p[1], p[2], "FAIL"] + 0; ok = verdicts[p[1], p[2], "PASS"] + 0; u = verdicts[p[1], p[2], "UNDECIDED"] + 0
            if (p[1] == "variants") {
                if (f) bad = bad "\n- " p[2] ": a right variant is accused"
                right = right sprintf("| %s | %d / %d / %d |\n", p[2], f, ok, u)
                continue
            }
            printf "| %s | %s | %s | %d / %d / %d |\n", p[2], f ? killers[p[2]] : "-", f ? count(paths[p[2]]) : "-", f, ok, u
            ++mutants
            if (f) { ++killed; if (number[p[2]] == 1) alone[last[p[2]]]++ } else bad = bad "\n- " p[2] ": survives"
        }
        printf "\n%d of %d are killed (%.1f%%).\n\n| check | meets | kills | alone | survivors |\n|---|---|---|---|---|\n", killed, mutants, mutants ? 100 * killed / mutants : 0
        for (c in checks) printf "| %s | %d | %d | %d | %d |\n", c, checks[c], kills[c] + 0, alone[c] + 0, checks[c] - kills[c]
        if (right) printf "\n| right variant | rows FAIL / PASS / UNDECIDED |\n|---|---|\n%s", right
        if (bad) printf "\nNot as it should be:\n%s\n", bad
        exit bad != ""
    }' "$work/rows"
