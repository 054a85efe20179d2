#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# How fast the tracer is: paths a second of one core, by user time, the best of three runs. Reported, never asserted: it
# depends on the machine, and on what else that is doing. bench.sh PROGRAM
program=$1
scratch=$(mktemp -d) || exit 4
trap 'rm -rf "$scratch"' EXIT

# User time of all children so far [s].
children() {
    times > "$scratch/times" # a builtin: of a subshell's children it would know nothing
    awk 'NR == 2 { split($1, t, "[ms]"); print 60 * t[1] + t[2] }' "$scratch/times"
}

printf '%-16s %-18s %7s %12s %16s\n' scene estimator bounces 'user time' 'paths a second'
while read -r scene estimator bounces samples; do
    best=
    for run in 1 2 3; do
        before=$(cat "$scratch/last" 2> /dev/null || echo 0)
        "$program" render "$scene" -e "$estimator" --bounces "$bounces" -s "$samples" --size 64x64 --threads 1 \
            -o "$scratch/out.exr" > "$scratch/log" 2>&1 || { cat "$scratch/log" >&2; exit 1; }
        children > "$scratch/last"
        best=$(awk -v a="$before" -v b="$(cat "$scratch/last")" -v best="$best" \
            'BEGIN { t = b - a; print (best == "" || t < best) ? t : best }')
    done
    awk -v s="$scene" -v e="$estimator" -v k="$bounces" -v n="$samples" -v t="$best" \
        'BEGIN { printf "%-16s %-18s %7d %10.2f s %14.2f M\n", s, e, k, t, 4096 * n / t / 1e6 }'
done << 'END'
cornell light_direct 1 1024
cornell hemisphere_direct 1 1024
cornell path 5 384
furnace_sphere path 5 384
cornell_glass dielectric 8 256
END
