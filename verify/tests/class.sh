#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: class.sh PROGRAM COUNT ASSIGNMENT [RESULTS.md]
# Grades a class of COUNT hand-ins that this script makes: right and wrong ones, ones that hang, crash, flood, do not compile. The grader
# itself is killed when a third is done, and resumed. Then each hand-in must have the code and the kind of score that it earned, the
# gradebook must be complete, nothing must be left running, and grading some once more must give the same scores.
# Exit status 0: all of that holds, 1: something does not. RESULTS.md gets the figures.
set -eu
program=$(cd "$(dirname "$1")" && pwd)/${1##*/}
count=$2
assignment=$3
results=${4:-}
cd "$(dirname "$0")/../.."
case $assignment in
*/*) assignment=$PWD/$assignment ;;
esac
case $results in
'' | /*) ;;
*) results=$PWD/$results ;;
esac
project=$PWD
handins=$PWD/verify/tests/handins
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
trap 'exit 1' HUP INT TERM
cd "$folder"
mkdir class build verify
cp "$program" "$program-worker" build # so that its processes are told from those of other tests
ln -s "$project/scenes" .
ln -s "$project/verify/assignments" verify
program=$folder/build/${program##*/}
failed=0
wrong() {
    printf 'class: %s\n' "$1" >&2
    failed=$((failed + 1))
}

# ---- the class ----

# bad STATEMENT: an estimator that does this first; volatile, so that no compiler proves anything.
bad() {
    sed "s|lc_rgb sum = lc_black();|lc_rgb sum = lc_black();\n    $1|" "$handins/all_lights.c"
}

# make_one NUMBER FILE: writes it; prints the code and the score that it must get: full, less, none.
kinds=14
make_one() {
    case $(($1 % kinds)) in
    0) cat "$handins/all_lights.c" >"$2" && echo 'AC full' ;;
    1) bad 'for (volatile int i = 0; i < 1; i += 0) {}' >"$2" && echo 'TLE less' ;;
    2) sed 's/weight \*= fmax/weight = fmax/' "$handins/all_lights.c" >"$2" && echo 'WA less' ;;
    3) bad 'this is no C;' >"$2" && echo 'CE none' ;;
    4) bad '*(volatile int *)8 = 1;' >"$2" && echo 'RTE less' ;;
    5) cat "$handins/by_channel.c" >"$2" && echo 'AC full' ;;
    6) sed 's/squared(lamp->distance)/lamp->distance/' "$handins/by_channel.c" >"$2" && echo 'WA less' ;;
    7) bad 'sum.r = sqrt(-1 - lc_next(sampler));' >"$2" && echo 'WA less' ;;
    8) cat "$handins/renamed.c" >"$2" && echo 'AC full' ;;
    9) : >"$2" && echo 'CE none' ;;
    10) sed 's|^LC_EST|__attribute__((constructor)) static void begin(void) { for (volatile int i = 0; i < 1; i += 0) {} }\n&|' \
        "$handins/all_lights.c" >"$2" && echo 'TLE less' ;;
    11) bad 'volatile char room[1 << 26]; for (int i = 0; i < 1 << 26; i += 512) room[i] = 1; sum.r = room[512] - 1;' >"$2" &&
        echo 'RTE less' ;;
    12) sed 's/weight \/ l.pdf_area/0.5 * weight \/ l.pdf_area/' "$handins/all_lights.c" >"$2" && echo 'WA less' ;;
    13) cat "$handins/renamed.c" >"$2" && echo 'int more = ;' >>"$2" && echo 'CE none' ;;
    esac
}

echo 'student_id,last_name,first_name,email' >roster.csv
i=0
while [ $i -lt "$count" ]; do
    id=$(printf 'u%03d' $i)
    printf '%s,"O'\''Neil, ""%d""",Ann,%s@example.org\n' "$id" $i "$id" >>roster.csv
    if [ $((i % 7)) = 5 ]; then # some come in a folder
        mkdir -p "class/$id/src"
        file=class/$id/src/mine.c
    else
        file=class/$id.c
    fi
    echo "$id $(make_one $i "$file")" >>expected
    i=$((i + 1))
done
echo 'absent,A,Bo,' >>roster.csv

# ---- graded, killed, resumed ----

seconds() { date +%s; }
results_of() { ls grades/results 2>/dev/null | grep -c '\.json$' || :; }
ours() { # processes of this very copy of the program
    ls -l /proc/[0-9]*/exe 2>/dev/null | grep -c -e " $program\$" -e " $program-worker\$" || :
}
set -- class -a "$assignment" -j 2 --roster roster.csv -o grades

before=$(ours)
start=$(seconds)
"$program" grade "$@" --seed 7 >out 2>err & # not in a function: the shell in between would be killed in its place
grader=$!
while [ "$(results_of)" -lt $((count / 3 + 1)) ] && kill -0 $grader 2>/dev/null; do
    sleep 0.1
done
kill -9 $grader 2>/dev/null || wrong 'the grader was done before it could be killed'
wait $grader 2>/dev/null || :
killed_at=$(results_of)
sleep 1
[ "$(ours)" = "$before" ] || wrong 'what the killed grader had started still runs'
[ ! -e grades/gradebook.csv ] || wrong 'a gradebook before all is graded'
status=0
"$program" grade "$@" >out 2>err || status=$?
[ $status = 2 ] || wrong "exit status $status without --resume"
status=0
"$program" grade "$@" --resume >out 2>err || status=$?
[ $status = 0 ] || wrong "exit status $status: $(tail -n 3 err)"
took=$(($(seconds) - start))
[ "$(ours)" = "$before" ] || wrong 'something still runs'

# ---- what each has earned ----

# ID CODE KIND of each result; the kind from the numbers alone.
for file in grades/results/*.json; do
    awk -F'"' '
        /^  "student"/ { id = $4 }
        /^  "code"/ { code = $4 }
        /^  "points"/ { points = $3 + 0; sub(/[^0-9.]*/, "", $3); points = $3 + 0 }
        /^  "max_points"/ { sub(/[^0-9.]*/, "", $3); most = $3 + 0 }
        /^  "score"/ { score = $3 }
        END { print id, code, score ~ /null/ ? "none" : points == most ? "full" : "less" }' "$file"
done | sort >got
sort expected | diff - got >difference || wrong "codes and scores (expected <, got >):
$(cat difference)"

# The gradebook: everybody once, the kind of score as above, 0 for who handed in nothing.
[ "$(head -n 1 grades/gradebook.csv)" = \
    assignment,duedate,timestamp,student_id,last_name,first_name,email,raw_score,late_submission_penalty,score,max_score ] ||
    wrong 'the head of the gradebook'
awk -F, 'NR > 1 { print $4, $(NF - 1) == "" ? "none" : $(NF - 1) == $NF ? "full" : "less" }' grades/gradebook.csv | sort >got
{ cut -d ' ' -f 1,3 expected && echo 'absent less'; } | sort | diff - got >difference || wrong "the gradebook:
$(cat difference)"
grep -q '^[^,]*,,,absent,A,Bo,,0,0,0,' grades/gradebook.csv || wrong 'no 0 for missing work'
grep -q ',u000,"O'\''Neil, ""0""",Ann,u000@example.org,' grades/gradebook.csv || wrong 'a name in the gradebook'
[ "$(wc -l <grades/class.csv)" = $((count + 2)) ] || wrong 'lines of class.csv'
[ "$(ls grades/feedback | wc -l)" = "$count" ] || wrong 'a feedback for each'
! grep -rqE 'u0[0-9][0-9]' grades/class.csv grades/class.txt || wrong 'a student_id where pseudonyms belong'
! grep -lr 'u0[0-9][0-9]@' grades/feedback || wrong "an address in a student's feedback"

# ---- once more: in shards, and with the same scores ----

score() { # of a student, in the folder's results
    grep -l "\"student\": \"$2\"" "$1"/results/*.json | xargs sed -n 's/^  "points": \(.*\),/\1/p'
}
mkdir few
for id in u000 u002 u005; do
    ls -d class/$id* | xargs -I{} cp -pR {} few
done
for shard in 0 1; do
    "$program" grade few -a "$assignment" --seed 7 --shard $shard/2 --roster roster.csv -o again >out 2>err || wrong "shard $shard: $(cat err)"
done
"$program" grade few -a "$assignment" --resume --roster roster.csv -o again >out 2>err || wrong "merging: $(cat err)"
for id in u000 u002 u005; do
    [ "$(score grades $id)" = "$(score again $id)" ] || wrong "$id has $(score grades $id) points, and then $(score again $id)"
done
[ -s again/gradebook.csv ] || wrong 'no gradebook of the shards'

# Late work: the score is max(0, raw - penalty).
sed 's/"bounces": 1,/&\n  "due": "2020-01-01T00:00:00Z", "late": {"per_day": 0.1, "most": 0.5},/' "$project/verify/tests/class_small.json" >late.json
"$program" grade few -a late.json -j 2 --seed 7 --roster roster.csv -o late >out 2>err || wrong "late work: $(cat err)"
awk -F, '$4 == "u000" { print $(NF - 3), $(NF - 2), $(NF - 1), $NF } $4 == "u002" { print $(NF - 3) < 3.5, $(NF - 2), $(NF - 1) }' \
    late/gradebook.csv >got
printf '7 3.5 3.5 7\n1 3.5 0\n' | diff - got >difference || wrong "late work (expected <, got >): $(cat difference)"
grep -q '^late,2020-01-01 00:00:00,20[0-9-]* [0-9:]*,u000,' late/gradebook.csv || wrong 'due date and timestamp'

if [ -n "$results" ]; then
    cp grades/class.txt table
fi

# ---- a file that was handed in anew is graded anew, and only that one ----

cp "$handins/all_lights.c" class/u002.c
"$program" grade "$@" --resume >out 2>err || wrong "a file that has changed: $(cat err)"
[ "$(grep -c '^\[' err)" = 1 ] && grep -q '^\[1/1\] .* AC ' err || wrong "not one file graded anew: $(cat err)"
awk -F, '$4 == "u002" { exit $(NF - 1) != $NF }' grades/gradebook.csv || wrong 'the gradebook has the old score'
sed 's/"margin": 0.05/"margin": 0.04/' "$project/verify/tests/class_small.json" >other.json
status=0
"$program" grade class -a other.json -o grades --resume >out 2>err || status=$?
[ $status = 2 ] && grep -q 'results of another assignment' err || wrong 'results of another assignment were taken'

# ---- in any language: adapters, which are graded where that is asked for ----

make_adapter() { # NAME, and what follows --describe
    mkdir -p "adapters/$1"
    printf '#!/bin/sh\nif [ "$1" = --describe ]; then\n    printf "lobes=diffuse\\nemitters=area,point,directional\\n"\n    exit 0\nfi\n%s\n' "$2" \
        >"adapters/$1/adapter.sh"
    chmod +x "adapters/$1/adapter.sh"
}
render() { echo "exec $program render \"\$1\" -e $1 --size \"\$2x\$3\" -s \"\$4\" --seed \"\$5\" --bounces \"\$6\" -o \"\$7\""; }
make_adapter right "$(render light_direct)"
make_adapter wrong "$(render light_no_cosine)"
make_adapter dies 'exit 3'
small=$project/verify/tests/class_small.json
"$program" grade adapters -a "$small" -j 2 --seed 1 -o without >out 2>err || wrong "adapters: $(cat err)"
"$program" grade adapters -a "$small" -j 2 --seed 1 --adapters -o with >out 2>err || wrong "adapters: $(cat err)"
printf '%s\n' 'dies CE none' 'right CE none' 'wrong CE none' 'dies RTE less' 'right AC full' 'wrong WA less' >expected
awk '$4 == "of" { print $1, $2, $3 == "-" ? "none" : $3 == $5 ? "full" : "less" }' without/class.txt with/class.txt >got
diff expected got >difference || wrong "adapters (expected <, got >):
$(cat difference)"

# ---- and images that were rendered before ----

make_images() { # NAME ESTIMATOR COUNT
    mkdir -p "images/$1/plane_rectangle.1" "images/$1/plane_point.1"
    seq "$3" | xargs -P 2 -I{} "$program" render plane_rectangle -e "$2" -s 2 --seed {} -o "images/$1/plane_rectangle.1/{}.exr" >log 2>&1
    cp "images/$1/plane_rectangle.1/1.exr" "images/$1/plane_point.1" # of no account but that it can be read
}
make_images right light_direct 320
make_images wrong light_no_cosine 320
make_images few light_direct 5
cp -R images/right images/damaged
head -c 2000 images/right/plane_rectangle.1/9.exr >images/damaged/plane_rectangle.1/9.exr
cp -R images/right images/copies
cp images/right/plane_rectangle.1/9.exr images/copies/plane_rectangle.1/10.exr
mkdir images/linked
ln -s ../right/plane_rectangle.1 images/linked/plane_rectangle.1
sed 's/"plane_point"/"plane_rectangle"/' "$small" >images.json
"$program" grade images -a images.json -j 2 --seed 1 -o no_images >out 2>err || wrong "images: $(cat err)"
"$program" grade images -a images.json -j 2 --seed 1 --images -o by_images >out 2>err || wrong "images: $(cat err)"
printf '%s\n' 'copies CE none' 'damaged CE none' 'few CE none' 'linked CE none' 'right CE none' 'wrong CE none' \
    'copies RTE less' 'damaged RTE less' 'few WA less' 'linked CE none' 'right AC full' 'wrong WA less' >expected
awk '$4 == "of" { print $1, $2, $3 == "-" ? "none" : $3 == $5 ? "full" : "less" }' no_images/class.txt by_images/class.txt >got
diff expected got >difference || wrong "images (expected <, got >):
$(cat difference)"
grep -q 'plane_rectangle.1: 5 images, where 320 are needed' by_images/feedback/few.txt || wrong 'no word of how many images are needed'
grep -q '10.exr and 9.exr are the same image' by_images/feedback/copies.txt || wrong 'no word of two images that are one'
grep -q '126\..% of the light' by_images/feedback/wrong.txt || wrong 'no word of how wrong the images are'
rm images/right/plane_rectangle.1/320.exr
"$program" grade images -a images.json -j 2 --seed 1 --images -o by_images --resume >out 2>err || wrong "images: $(cat err)"
[ "$(grep -c '^\[' err)" = 1 ] && grep -q 'right .* WA ' err || wrong 'a folder with one image less was not graded anew'
status=0
"$program" grade images/wrong -a images.json --images >out 2>err || status=$?
[ $status = 1 ] && grep -q '126\..% of the light' out || wrong "one folder of images: $status, $(cat err)"

if [ -n "$results" ]; then
    {
        printf '# A class of %d hand-ins\n\nMade by `make class`. %s\n\n```text\n' "$count" \
            "The grader was killed (SIGKILL) when $killed_at results had been begun, and resumed; $took s in all, two processes at once."
        cat table
        printf '```\n'
    } >"$results"
fi
echo "class: $count hand-ins, killed after $killed_at, $took s, $failed wrong"
[ $failed = 0 ]
