#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: diagnosis.sh PROGRAM FOLDER [NAME ...]
# Makes every wrong file of verify/tests/held_out in FOLDER and has it diagnosed. Prints a table in Markdown; exit status 1 when a name
# that is asserted is not the file's, when less than 95% get their name, or when what is said of an unknown bug is not true of it.
# What an earlier run of the same program found stays in FOLDER, so that a run can be taken up again.
set -u
here=$(dirname "$0")/held_out
program=$1 folder=$2
shift 2
wanted=" $* "
mkdir -p "$folder" || exit 4
build=$(cksum < "$program")
TIMEFORMAT='%R %U'
made=

# diagnose NAME KIND EXPECTED LINE: FOLDER/NAME.c is there; one line of FOLDER/rows: name, kind, expected, what was said, time
diagnose() {
    local key said=open line=no seconds
    key=$build$(cksum < "$folder/$1.c")
    if [ "$key" != "$(cat "$folder/$1.key" 2>/dev/null)" ]; then
        { time "$program" diagnose "$folder/$1.c" > "$folder/$1.out" 2> "$folder/$1.err"; } 2> "$folder/$1.time"
        echo "$key" > "$folder/$1.key"
    fi
    seconds=$(cat "$folder/$1.time")
    grep -q 'is wrong$' "$folder/$1.out" || said=none
    grep -q '^behaves as none' "$folder/$1.out" && said=none
    grep -q '^not all' "$folder/$1.out" && said=$(sed -n 's/^  \([a-z_0-9]*\): .*/?\1/p' "$folder/$1.out" | paste -sd, -)
    grep -q '^behaves exactly as any' "$folder/$1.out" && said=$(sed -n 's/^  \([a-z_0-9]*\): .*/\1/p' "$folder/$1.out" | paste -sd, -)
    grep -q '^behaves exactly as [a-z_0-9]* with' "$folder/$1.out" &&
        said=$(sed -n 's/^behaves exactly as .* (\([a-z_0-9]*\))$/\1/p' "$folder/$1.out")
    [ -s "$folder/$1.out" ] || said="ERROR"
    grep -q 'is not shown different' "$folder/$1.out" && said=right
    sed -n 's/^  measured: //p' "$folder/$1.out" | grep -Eq "$4" && line=yes
    [ "$4" ] || line=-
    paths=$(sed -n 's/^  against.* \([0-9.]*\) M paths$/\1/p' "$folder/$1.out")
    echo "$1 $2 $3 $said $line $seconds ${paths:--}" >> "$folder/rows"
}

make_file() { # NAME HAND SED
    case $wanted in
    '  ' | *" $1 "*) ;;
    *) return 1 ;;
    esac
    case $made in
    *" $1 "*) echo "diagnosis.sh: two bugs are called $1" >&2 && exit 4 ;;
    esac
    made="$made $1 "
    sed "$3" "$here/$2.c" > "$folder/$1.c" || exit 4
    if [ "$3" ] && cmp -s "$here/$2.c" "$folder/$1.c"; then
        echo "diagnosis.sh: $1: nothing of $2.c matches" >&2
        exit 4
    fi
}
bug() { make_file "$1" "$2" "$4" && diagnose "$1" bug "$3" ''; }
unknown() { make_file "$1" "$2" "$3" && diagnose "$1" unknown - "$4"; }

: > "$folder/rows"
. "$here/bugs.sh"
for hand in "$here"/*.c; do
    hand=$(basename "$hand" .c)
    make_file "$hand" "$hand" '' && diagnose "$hand" right - ''
done

awk '
    BEGIN { print "# Diagnosis of files that it has not seen\n\nMade by `make diagnosis-proof`." }
    {
        if ($2 == "bug") {
            known = 1; ++bugs
            many = split($4, names, ",")
            asserted = $4 ~ /^[a-z]/ && $4 != "none" && $4 != "open" && $4 != "right"
            has = 0
            for (i = 1; i <= many; ++i) if (names[i] == $3) has = 1
            if (asserted && has) { ++right; if (many == 1) ++alone }
            if (asserted && !has) ++wrong
            outcome = asserted ? (has ? (many == 1 ? "named" : "named with its equals") : "WRONG NAME") : "abstains"
            said = asserted && many > 1 ? $4 : asserted && !has ? $4 : asserted ? "" : $4
            table = table sprintf("| %s | %s | %s%s | %s | %s | %s |\n", $1, $3, outcome, said ? ": " said : "", $6, $7, $8)
        } else if ($2 == "unknown") {
            ++others
            asserted = $4 ~ /^[a-z]/ && $4 != "none" && $4 != "open"
            if (asserted) ++claimed
            if ($5 == "yes") ++told; else bad = bad "\n- " $1 ": the fingerprint does not tell"
            strange = strange sprintf("| %s | %s | %s | %s | %s | %s |\n", $1, asserted ? "ASSERTED " $4 : "no name", $5, $6, $7, $8)
        } else {
            ++rights
            if ($4 == "right") ++cleared; else bad = bad "\n- " $1 ": a right file is accused"
        }
        if ($6 > slowest) slowest = $6
        if ($7 > most) most = $7
        user += $7
    }
    END {
        printf "\n%d wrong files, each with a bug of the catalogue: %d get their name (%.1f%%), %d of them no other; %d a wrong name.\n", bugs, right, bugs ? 100 * right / bugs : 0, alone, wrong
        printf "%d with a bug that it does not know: %d are given a name; the fingerprint is true of %d.\n", others, claimed, told
        printf "%d right files: %d not shown wrong.\n\nSlowest: %.1f s by the clock, %.1f s of one core; all: %.0f s of one core.\n", rights, cleared, slowest, most, user
        if (table) printf "\n| file | bug | diagnosis | s | s of one core | M paths |\n|---|---|---|---|---|---|\n%s", table
        if (strange) printf "\n| file | name | fingerprint is true | s | s of one core | M paths |\n|---|---|---|---|---|---|\n%s", strange
        if (wrong || claimed || (bugs && right < 0.95 * bugs)) bad = bad "\n- names"
        if (bad) printf "\nNot as it should be:\n%s\n", bad
        exit bad != ""
    }' "$folder/rows"
