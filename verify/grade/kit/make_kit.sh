#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: make_kit.sh PROGRAM FOLDER [FILE.json ...]
# Writes what a student gets into FOLDER, which must not be there yet: the program and its worker, the scenes, the
# public part of the assignments (all that lightcheck has, unless named) with the files that it names, header, template
# and the guide. Nothing of estimators/ and of verify/mutants/.
set -eu
program=$1
kit=$2
shift 2
cd "$(dirname "$0")/../../.."
[ $# -gt 0 ] || set -- verify/assignments/*.json
[ ! -e "$kit" ] || {
    echo "make_kit.sh: $kit is there already" >&2
    exit 2
}
mkdir -p "$kit/build"
for name in lightcheck lightcheck-worker; do
    strip -o "$kit/build/$name" "$(dirname "$program")/$name"
done
cp -R scenes "$kit/scenes"
cp src/core/lightcheck.h estimators/template.c setup.sh LICENSE LICENSE-MIT "$kit"
cp docs/student.md "$kit/README.md"
mkdir "$kit/assignments"
for assignment; do
    "$program" assignment public "$assignment" >"$kit/assignments/${assignment##*/}"
    sh verify/grade/kit/copy_files.sh "$program" "$assignment" "$kit/assignments" --public
done

# The image must be of the system that the program was made on: it links to that one's libraries.
ID=debian VERSION_ID=12
[ ! -r /etc/os-release ] || . /etc/os-release
sed "s/^FROM .*/FROM $ID:${VERSION_ID:-testing}/" verify/grade/kit/Dockerfile >"$kit/Dockerfile"
