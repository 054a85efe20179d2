#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: copy_files.sh PROGRAM ASSIGNMENT FOLDER [--public]
# Copies the files that an assignment names (a table of sentences, scenes of its own) into FOLDER, under the names that it has for
# them. With --public those that students may see. Exit status 2: there is one that cannot lie there, or another of its name does.
set -eu
program=$1
assignment=$2
folder=$3
shift 3
list=$(mktemp)
trap 'rm -f "$list"' EXIT
trap 'exit 1' HUP INT TERM
"$program" assignment files "$@" "$assignment" >"$list"
tab=$(printf '\t')
while IFS=$tab read -r name path; do
    case /$name/ in
    //* | */../*)
        echo "copy_files.sh: $assignment names $name: put it beside the assignment, or in a folder there" >&2
        exit 2
        ;;
    esac
    if [ -e "$folder/$name" ] && ! cmp -s "$path" "$folder/$name"; then
        echo "copy_files.sh: $assignment names $name, and another $name is there already: call it otherwise" >&2
        exit 2
    fi
    mkdir -p "$(dirname "$folder/$name")"
    cp "$path" "$folder/$name"
done <"$list"
