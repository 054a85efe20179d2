#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Right solutions graded again and again, each with a seed of its own: how often one loses a point, and how long it takes. Prints a
# table in Markdown; fails when one was missed. What is in the log is not done again, so that a run that was ended goes on.
#
# usage: gradings.sh PROGRAM LOG [COUNT]
set -u
program=$1
log=$2
count=${3:-200}
touch "$log"
trap 'exit 1' INT TERM

# Every solution of every assignment: a shipped estimator from its file, in the jail; a variant in this process.
solutions() {
    "$program" list assignments | while read -r assignment rest; do
        sed -n 's/.*"solutions": \[\(.*\)\].*/\1/p' "verify/assignments/$assignment.json" | tr -d '" ' | tr ',' '\n' |
            while read -r solution; do
                file=estimators/$solution.c
                [ -f "$file" ] || file=$solution
                echo "$assignment $file"
            done
    done
}
solutions > "$log.solutions"
pairs=$(wc -l < "$log.solutions")

# Grading number i is of pair i mod the number of pairs, so that any beginning of the run has all assignments.
i=0
while [ $i -lt "$count" ]; do
    i=$((i + 1))
    grep -q "^$i " "$log" && continue
    set -- $(sed -n "$(((i * 37) % pairs + 1))p" "$log.solutions")
    seed=$(od -An -N5 -tu8 /dev/urandom | tr -d ' ')
    (
        "$program" grade "$2" -a "$1" --seed "$seed" > "$log.one" 2>&1
        status=$?
        times > "$log.times" # of the children: the second line, "0m4.1s 0m0.2s"
        exit $status
    )
    status=$?
    seconds=$(sed -n 's/.*, in \([0-9.]*\) s$/\1/p' "$log.one")
    cpu=$(awk 'NR == 2 { for (i = 1; i <= 2; ++i) { split($i, t, /[ms]/); sum += 60 * t[1] + t[2] } printf "%.2f", sum }' "$log.times")
    echo "$i $1 $2 $seed $status ${seconds:-0} ${cpu:-0}" >> "$log"
    [ $status -eq 0 ] || cat "$log.one" >&2
done

# By the CPU: what the clock says depends on what else the machine does. Half of it is the time on two idle cores.
sort -n -k7 "$log" | awk '
    {
        ++n[$2]; ++all; miss[$2] += $5 != 0; missed += $5 != 0
        cpu[$2, n[$2]] = $7; total[all] = $7
        if (!(($2, $3) in who)) { who[$2, $3] = 1; ++kinds[$2] }
        if ($5 != 0) list = list sprintf("- %s by %s, seed %s: exit status %s\n", $3, $2, $4, $5)
    }
    END {
        printf "# Right solutions, graded\n\nMade by `make gradings`: %d gradings with seeds that were drawn, %d of which missed a point. ", all, missed
        printf "CPU seconds are of all processes of a grading; the median of all is %.1f.\n\n", total[int((all + 1) / 2)]
        print "| assignment | solutions | gradings | missed | median CPU s | longest CPU s |\n|---|---|---|---|---|---|"
        for (a in n)
            printf "| %s | %d | %d | %d | %.1f | %.1f |\n", a, kinds[a], n[a], miss[a], cpu[a, int((n[a] + 1) / 2)], cpu[a, n[a]] | "sort"
        close("sort")
        if (list != "") printf "\nMissed:\n\n%s", list
        exit missed > 0
    }'
