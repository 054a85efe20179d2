#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: make_zip.sh PROGRAM ASSIGNMENT|FILE.json OUT.zip
# An autograder for Gradescope: setup.sh and run_autograder at its root, the assignment and the files that it names in assignment/, a secret
# of its own from which hidden scenes are drawn, and what lightcheck is
# built from.
set -eu
program=$(cd "$(dirname "$1")" && pwd)/${1##*/}
assignment=$2
cd "$(dirname "$0")/../../.."
case $assignment in
*.json) ;;
*) assignment=verify/assignments/$assignment.json ;;
esac
[ -r "$assignment" ] || {
    echo "make_zip.sh: no assignment $assignment" >&2
    exit 2
}
command -v zip >/dev/null || {
    echo 'make_zip.sh: zip is missing: apt-get install zip' >&2
    exit 2
}
mkdir -p "$(dirname "$3")"
out=$(cd "$(dirname "$3")" && pwd)/${3##*/}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
trap 'exit 1' HUP INT TERM

cp verify/grade/gradescope/setup.sh verify/grade/gradescope/run_autograder "$folder"
name=$(basename "$assignment")
mkdir "$folder/assignment"
cp "$assignment" "$folder/assignment"
echo "$name" >"$folder/name"
sh verify/grade/kit/copy_files.sh "$program" "$assignment" "$folder/assignment"
od -An -N8 -tu8 /dev/urandom >"$folder/secret" # what hidden scenes are drawn from; a hand-in cannot read it
chmod 600 "$folder/secret"
mkdir "$folder/lightcheck"
cp -R Makefile setup.sh LICENSE LICENSE-MIT src estimators scenes verify "$folder/lightcheck"
rm -rf "$folder/lightcheck/verify/tests" "$folder/lightcheck/verify/proof"
chmod +x "$folder/setup.sh" "$folder/run_autograder"
rm -f "$out"
cd "$folder"
zip -qr "$out" .
