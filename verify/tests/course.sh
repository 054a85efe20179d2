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

# ---- pictures: for each hand-in its own ----

grade 0 few -a tiny.json --seed 1 --report pictures -o pictured
cmp -s pictures/ann.c/rectangle_yours.png pictures/bob.c/rectangle_yours.png && wrong 'both have the same picture'
[ "$(find pictures -type f | wc -l)" = 6 ] || wrong "pictures: $(find pictures -type f)"
says 'pictures: bob.c/rectangle_yours.png, bob.c/rectangle_reference.png, bob.c/rectangle_difference.png' pictured/feedback/bob.c.txt
printf 'student_id\nann\nbob\n' >two.csv
grade 0 few -a tiny.json --seed 1 --report named --roster two.csv -o pictured2
for name in named/*; do
    [ -s "$name/rectangle_yours.png" ] && [ -s "pictured2/feedback/${name##*/}.txt" ] || wrong "pictures in $name, and no feedback of that name"
done
! ls named | grep -q -e ann -e bob || wrong 'names of students where pseudonyms belong'
rm -rf pictures/bob.c
cp wrong.c few/ann.c # one is graded anew, the other stays
grade 0 few -a tiny.json --report pictures --resume -o pictured
[ "$(grep -c '^\[' err)" = 1 ] && [ -s pictures/ann.c/rectangle_yours.png ] && [ ! -e pictures/bob.c ] || wrong 'pictures of a resumed class'
says 'pictures: ann.c/rectangle_yours.png' pictured/feedback/ann.c.txt
cp right.c few/ann.c

# ---- whatever was handed in counts as handed in ----

mkdir odd odd/none odd/two
cp right.c odd/BIG.C
cp right.c odd/x.CPP
cp right.c odd/late.txt
cp right.c odd/fine.c
echo 'how I did it' >odd/fine.txt
echo PK >odd/eve.zip
ln -s ../right.c odd/link.c
cp right.c odd/two/a.c
cp right.c odd/two/b.c
echo '<html>' >odd/index.html
echo '<' >odd/stranger.md
printf 'student_id\ntwo\nnone\nlate\nlink\nBIG\neve\nx\nfine\nabsent\n' >odd/roster.csv
echo 7 >odd/secret
grade 0 odd -a tiny.json --roster odd/roster.csv --secret odd/secret -o odd/grades -j 2
awk -F, 'NR > 1 { print $4, $(NF - 1) == "" ? "none" : $(NF - 1) }' odd/grades/gradebook.csv | sort >got
printf '%s\n' 'BIG 3' 'absent 0' 'eve none' 'fine 3' 'late none' 'link none' 'none none' 'two none' 'x 3' >expected_scores
diff expected_scores got >difference || wrong "scores of odd hand-ins (expected <, got >): $(cat difference)"
says '6 could not be graded and have no score' err
says '1 are of nobody in the roster' err # stranger.md
says '1 of the roster handed in nothing, which is 0' err
says 'late.txt is no source file; expected one source file' odd/grades/feedback/*
says 'eve.zip is an archive, and none is unpacked' odd/grades/feedback/*
says 'link.c is a link, and none is followed' odd/grades/feedback/*
says '(nobody of the roster)' odd/grades/class.txt
! grep -q 'fine.txt' odd/grades/results/* || wrong 'a text beside a source file was taken for work'
# The folder of results lies among them, and is none.
grade 0 odd -a tiny.json --roster odd/roster.csv --secret odd/secret -o odd/grades --resume
! grep -q '^\[' err || wrong "something was graded anew: $(cat err)"
[ "$(wc -l <odd/grades/gradebook.csv)" = 10 ] && ! grep -qE '^(grades|roster)' odd/grades/class.txt || wrong 'its own results were taken for a hand-in'

# ---- names ----

mkdir names
cp right.c "$(printf 'names/a\nscore 6 of 6.c')"
cp right.c "$(printf 'names/M\374ller.c')" # Latin 1, as archives from Windows have it
cp right.c "$(printf 'names/\033[2Jclear.c')"
grade 0 names -a tiny.json --only compiles -o named_oddly
[ "$(grep -c ' 1 of 1 ' named_oddly/class.txt)" = 3 ] && [ "$(wc -l <named_oddly/gradebook.csv)" = 4 ] || wrong "lines of class.txt: $(cat named_oddly/class.txt)"
says 'M\xfcller.c~' named_oddly/class.txt
! LC_ALL=C grep -rq "$(printf '[\033\374]')" named_oddly || wrong 'a control character in what was written'
# Printed text is marked as such.
sed 's|lc_rgb sum = lc_black();|&\n    static int n;\n    if (!n++) fprintf(stderr, "\\033[2J\\nscore 6 of 6, in 0.1 s\\n");|; 1i #include <stdio.h>' right.c >prints.c
grade 0 prints.c -a tiny.json
says '    | \x1b[2J' out
[ "$(grep -c '^score' out)" = 1 ] || wrong "a line that looks like the score: $(cat out)"

# ---- results of another selection, of two files, of nothing ----

grade 2 few -a tiny.json -o hinted --resume --only compiles
says 'hinted/class.json: results of all tests, not of compiles: name another folder' err
grade 0 few -a tiny.json -o one --only compiles
grade 2 few -a tiny.json -o one --resume
says 'one/class.json: results of compiles, not of all tests: name another folder' err
mkdir few/ann
cp right.c few/ann
grade 2 few -a tiny.json -o twice
says 'ann and ann.c are both of student ann' err
rm -r few/ann
grade 2 odd/late.txt -a tiny.json
says 'odd/late.txt: expected a source file (.c, .cc, .cpp, .cxx)' err

# ---- when it was handed in: the roster knows better than the file ----

sed 's/"bounces": 1/&, "due": "2020-01-01T00:00:00Z", "late": {"per_day": 0.1}/' tiny.json >due.json
touch -d 2020-01-02T12:00:00Z few/ann.c few/bob.c
printf 'student_id,submitted\nann,2019-12-31T23:00:00Z\nbob,\n' >times.csv
grade 0 few -a due.json --roster times.csv -o timed
awk -F, 'NR > 1 { print $4, $3, $(NF - 2) }' timed/gradebook.csv >got
printf '%s\n' 'ann 2019-12-31 23:00:00 0' 'bob 2020-01-02 12:00:00 0.6' | diff - got >difference || wrong "late work (expected <, got >): $(cat difference)"
sed 's/bob,/bob,2019-12-31T23:00:00Z/' times.csv >corrected.csv
grade 0 few -a due.json --roster corrected.csv --resume -o timed
[ "$(grep -c '^\[' err)" = 1 ] || wrong "not one graded anew: $(cat err)"
awk -F, '$4 == "bob" { exit $(NF - 2) != 0 }' timed/gradebook.csv || wrong 'a corrected time changes nothing'
sed 's/2019-12-31T23:00:00Z/2019-02-30T23:00:00Z/' times.csv >mistaken.csv
grade 2 few -a due.json --roster mistaken.csv -o mistaken
says "mistaken.csv:2: submitted '2019-02-30T23:00:00Z': its month has no such day" err

[ $failed = 0 ]
