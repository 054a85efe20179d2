#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Shows that lint can fail: plants a violation of each rule, and lines that only look like one, in a copy of the tree.
# Exactly the violations must be found, each at its place.
set -eu
cd "$(dirname "$0")/../.."
temporary=$(mktemp -d)
copy=$temporary/tree
mkdir "$copy"
trap 'rm -rf "$temporary"' EXIT
trap 'exit 1' HUP INT TERM
tar -cf - --exclude=./.git --exclude='./build*' --exclude=./results . | tar -xf - -C "$copy"
first='/* SPDX-License-Identifier: GPL-3.0-or-later */'
lint() { sh "$copy/verify/tests/lint.sh" "$copy"; }
if ! lint >/dev/null; then
    echo 'lint_selftest: the tree itself does not pass, so nothing can be planted in it' >&2
    exit 1
fi

number=0

# put FILE TEXT: a new file (its name completed by a number) whose second line is TEXT. The text is the source's, but
# for each @, which is left out, so that lint does not find this file.
put() {
    number=$((number + 1))
    case $1 in
    *.c) planted=${1%.c}_planted$number.c ;;
    *) planted=${1%.h}_planted$number.h ;;
    esac
    mkdir -p "$copy/$(dirname "$planted")"
    printf '%s\n%s\n' "$first" "$2" | tr -d @ >"$copy/$planted"
}
wrong() {
    put "$1" "$2"
    echo "$planted:2: " >>"$temporary/expected"
}
right() { put "$1" "$2"; }

# The directions between folders.
wrong estimators/x.c '#include "core/host.h"'
wrong estimators/x.c '#include "registry.h"'
wrong estimators/x.c '#include <unistd.h>'
wrong verify/mutants/x.c '#include "../../src/core/host.h"'
wrong verify/mutants/x.c '#include <gsl/gsl_cdf.h>'
right estimators/x.c '#include <math.h>'
right estimators/x.c '#include "lightcheck.h" /* "core/host.h" */'
right verify/mutants/x.c '#include "core/lightcheck.h"'
mkdir -p "$copy/src/io" "$copy/src/cli" "$copy/verify/judge" "$copy/verify/stats"
for header in src/io/x.h src/cli/x.h verify/judge/x.h verify/stats/x.h estimators/registry.h; do
    [ -e "$copy/$header" ] || echo "$first" >"$copy/$header"
done
wrong src/core/x.c '#include "io/x.h"'
wrong src/core/x.c '  #  include "verify/judge/x.h"'
wrong src/core/x.c '#include "../cli/x.h"'
wrong src/core/x.c '#include "estimators/registry.h"'
right src/core/x.c '#include "host.h"'
wrong src/io/x.c '#include "verify/judge/x.h"'
wrong src/io/x.c '#include "src/cli/x.h"'
right src/io/x.c '#include "core/host.h"'
wrong verify/judge/x.c '#include "cli/x.h"'
wrong verify/tests/x.c '#include <cli/x.h>'
right verify/judge/x.c '#include "io/x.h"'
wrong verify/stats/x.c '#include "io/x.h"'
wrong verify/analytic/x.c '#include "verify/judge/x.h"'
right verify/analytic/x.c '#include "verify/stats/x.h"'
wrong verify/grade/worker/x.c '#include "estimators/registry.h"'
wrong verify/grade/worker/x.c '#include "io/x.h"'
wrong verify/grade/worker/x.c '#include "verify/judge/x.h"'
right verify/grade/worker/x.c '#include "core/host.h"'
right verify/tests/cheats/x.c '#include "/etc/passwd"'
right src/cli/x.c '#include "verify/judge/x.h"'
wrong src/core/x.c '#include HEADER'
wrong src/core/x.c '#include "nowhere.h"'

# Other people's libraries.
wrong src/core/scene.c '#include <embree3/rtcore.h>'
wrong verify/judge/x.c '#include <embree4/rtcore.h>'
right src/core/accel_x.c '#include <embree4/rtcore.h>'
wrong src/io/png_x.c '#include <OpenEXR/openexr.h>'
right src/io/exr_x.c '#include <OpenEXR/openexr.h>'
echo "$first" >"$copy/src/io/exr_private.h"
right src/io/exr_x.c '#include "io/exr_private.h"'
wrong src/io/x.c '#include "io/exr_private.h"'
wrong src/io/exr_x.c '#include <png.h>'
wrong src/io/exr_x.c '#include <expat.h>'
right src/io/scene_read_x.c '#include <expat.h>'
wrong verify/judge/x.c '#include <jansson.h>'
right verify/report/x.c '#include <jansson.h>'
right src/cli/x.c '#include <jansson.h>'
wrong src/core/x.c '#include <gsl/gsl_cdf.h>'
wrong src/cli/x.c '#include <gsl/gsl_cdf.h>'
right verify/stats/x.c '#include <gsl/gsl_cdf.h>'
wrong src/core/render.c '#include <Random123/philox.h>'
wrong verify/grade/grade.c '#include <Random123/threefry.h>'
right verify/grade/seeds.c '#include <Random123/threefry.h>'
wrong verify/judge/x.c '#include <seccomp.h>'
right verify/grade/x.c '#include <seccomp.h>'
right verify/tests/x.c '#include <linux/capability.h>'
wrong verify/judge/x.c '#include <linux/landlock.h>'
wrong src/io/x.c '#include <check.h>'
wrong src/io/x.c '#include <omp.h>'
right src/io/x.c '#include <sys/stat.h>'
right src/io/x.c '#include <unistd.h>'

# Words.
wrong src/core/x.c 'void f(void) { printf("x"); }'
wrong verify/judge/x.c 'void f(void) { fprintf(stderr, "x"); }'
wrong src/io/x.c 'void f(void) { puts ("x"); }'
wrong src/core/x.c 'void f(void) { exit(1); }'
wrong verify/judge/x.c 'void f(void) { if (x) abort(); }'
wrong verify/judge/x.c 'void f(void) { _exit(1); }'
right verify/renderers/x.c 'void f(void) { _exit(127); }'
right src/core/x.c 'void f(FILE *out) { fprintf(out, "x"); snprintf(a, 1, "printf(stdout)"); }'
right src/core/x.c '/* printf("x") and exit(1) */ void f(void); // abort()'
right src/core/x.c 'void f(void) __attribute__((format(printf, 3, 4)));'
right src/core/x.c 'void f(void) { lc_exit(1); sink->printf(1); g("\"exit(1)"); }'
right src/cli/x.c 'void f(void) { printf("x"); exit(1); }'
right verify/tests/x.c 'void f(void) { printf("x"); abort(); }'
right verify/proof/x.c 'void f(void) { printf("x"); abort(); }'
wrong src/core/x.c "char c = '\"'; void f(void) { abort(); }"
wrong verify/judge/x.c '#define _GNU_SOURCE'
right verify/grade/x.c '#define _GNU_SOURCE'
wrong src/core/x.c '#define _XOPEN_SOURCE 700'
wrong src/cli/x.c 'void f(void) { setlocale(LC_ALL, ""); }'
wrong verify/tests/x.c 'double x = M_PI;'
wrong src/core/x.c 'double x = 2 * M_1_PI;'
right src/core/x.c 'double x = LC_PI; /* M_PI */'
wrong src/core/x.c "	int x;"
right src/core/x.c "int x;	/* a tab further on */"

# Any file.
wrong src/core/x.c '/* TO@DO later */'
wrong scenes/x.h '<!-- FIX@ME -->'
wrong docs/x.h 'see /home@/someone/notes'
wrong verify/tests/x.c '#define DATA "/work@/data"'
wrong docs/x.h 'CFLAGS += -D_GNU@_SOURCE'
right docs/x.h 'homework/1, ./home/x, TODOS, $root/proc'

# The first line.
echo 'int x;' >"$copy/src/core/planted_bare.c"
: >"$copy/src/core/planted_empty.c"
printf 'src/core/planted_%s.c:1: \n' bare empty >>"$temporary/expected"

status=0
lint >"$temporary/found" || status=$?
if [ $status != 1 ]; then
    echo "lint_selftest: lint's exit status was $status, expected 1" >&2
    exit 1
fi
cd "$temporary"
sort expected >expected.sorted
sed 's/^\([^:]*:[0-9]*: \).*/\1/' found | sort >found.sorted
if ! diff expected.sorted found.sorted >difference; then
    echo 'lint_selftest: < planted but not found, > found but not planted:' >&2
    cat difference found >&2
    exit 1
fi
