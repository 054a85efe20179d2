#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: lint.sh [FOLDER]
# Rules that no compiler knows: which folder may include what (lint.awk), and what stands in no file at all.
# Prints file:line: reason. Exit status 0: nothing found, 1: something.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
cd "${1:-$here/../..}"
LC_ALL=C
export LC_ALL
status=0

c_files() { find src estimators verify -type f -name '*.[ch]' | sort; }
all_files() {
    find . \( -path ./.git -o -path './build*' -o -path ./results/report \) -prune -o -type f -print | sed 's|^\./||' | sort
}

# forbid PATTERN REASON: no text file has a line that matches.
forbid() {
    if all_files | tr '\n' '\0' | xargs -0 grep -InE -e "$1" /dev/null | awk -v reason="$2" '
        { match($0, /^[^:]*:[0-9]+:/); print substr($0, 1, RLENGTH) " " reason; ++n } END { exit n == 0 }'; then
        status=1
    fi
}

c_files | awk -f "$here/lint.awk" || status=1

# Brackets keep the patterns from finding themselves.
forbid '(^|[^A-Za-z0-9_])(T[O]DO|F[I]XME)([^A-Za-z0-9_]|$)' 'finish it, or open an issue'
forbid "(^|[[:space:]\"'\`=(:,<@]|-[IL])/(h[o]me|r[o]ot|w[o]rk|U[s]ers)/" 'a path of one machine'
forbid '^[^#]*-D_GNU_[S]OURCE' 'feature macros are set file by file, in verify/grade'
exit $status
