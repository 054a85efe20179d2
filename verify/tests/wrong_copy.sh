# SPDX-License-Identifier: GPL-3.0-or-later
# Read by judge_mutants.sh and host_mutants.sh: programs that are wrong on purpose, each made by one substitution in a
# copy of the tree, and some test must fail. Before: $what is the name of what is wrong, $suites the suites that matter.
# Prints mutant and the tests that killed it. Option --fits: only says, in a second, which can no longer be made since the
# line that they change is another by now; nothing is built.
if [ "${1-}" = --fits ]; then
    unfit=0
    mutant() {
        if sed "$3" "$2" | cmp -s - "$2"; then
            unfit=$((unfit + 1))
            echo "$0: $1: no line of $2 matches any more"
        fi
    }
    sum_up() { [ "$unfit" = 0 ]; }
    return 0
fi

# Most of a mutant's time one core is busy: so as many processes as there are cores, each with a copy and its share of them.
part=0 parts=1
if [ "${1-}" = --part ]; then
    part=${2%/*} parts=${2#*/}
    shift 2
elif [ $# -ne 1 ] && [ "$(getconf _NPROCESSORS_ONLN)" -gt 1 ]; then
    parts=$(getconf _NPROCESSORS_ONLN)
    outputs=$(mktemp -d)
    trap 'rm -rf "$outputs"' EXIT
    trap 'kill $processes 2>/dev/null; exit 1' HUP INT TERM
    processes='' status=0
    while [ "$part" -lt "$parts" ]; do
        sh "$0" --part "$part/$parts" "$@" >"$outputs/$part" 2>&1 &
        processes="$processes $!"
        part=$((part + 1))
    done
    for process in $processes; do
        wait "$process" || status=1
    done
    cat "$outputs"/* | awk -v what="$what" '
        / wrong [a-z]*s, [0-9]* alive/ { made += $1; alive += $4; sub(/.* alive:?/, ""); names = names $0; next }
        /^$/ || (seen[$0]++ && /^\|/) { next }
        { print }
        END { printf "\n%d wrong %ss, %d alive%s\n", made, what, alive, names == "" ? "" : ":" names; exit !made }
    ' || status=1
    exit $status
fi

temporary=$(mktemp -d)
copy=$temporary/tree
mkdir "$copy"
trap 'rm -rf "$temporary"' EXIT
trap 'exit 1' HUP INT TERM
tar -cf - --exclude=./.git --exclude='./build*' --exclude=./results . | tar -xf - -C "$copy"
for made in obj flags texts.c tests lightcheck-worker lightcheck.syms; do # with their times: nothing is compiled twice
    [ ! -e "build/$made" ] || tar -cf - "build/$made" | tar -xf - -C "$copy"
done
make="make -s -C $copy BUILD=build WERROR=" # a mutant may leave something unused
$make -j2 build/tests

# failing SUITE[/CASE] ...: runs them as they are now; prints the names of those tests that failed or ran out of time.
failing() {
    for suite in "$@"; do
        case $suite in
        */*) only=CK_RUN_CASE=${suite#*/} ;;
        *) only='' ;;
        esac
        env $only CK_RUN_SUITE="${suite%/*}" CK_VERBOSITY=verbose CK_DEFAULT_TIMEOUT=60 "$copy/build/tests" 2>&1 || :
    done | sed -n 's/^[^:]*:[0-9]*:[FE]:[^:]*:\([a-z0-9_]*\):.*/\1/p' | sort -u | tr '\n' ' '
}
before=$(failing $suites)
if [ -n "$before" ]; then
    echo "$0: the right $what fails: $before" >&2
    exit 1
fi

# The first four words, and how many more there are.
shorten() {
    if [ $# -gt 4 ]; then
        echo "$1 $2 $3 $4 and $(($# - 4)) more"
    else
        echo "$*"
    fi
}

nth=0 made=0 alive=0 names=''
wanted=" $* "

# mutant NAME FILE SED-COMMAND [SUITE ...]: one that is wrong; only these of the suites are asked, or all.
mutant() {
    case $wanted in
    '  ' | *" $1 "*) ;;
    *) return 0 ;;
    esac
    nth=$((nth + 1))
    [ $((nth % parts)) = "$part" ] || return 0
    name=$1 file=$copy/$2 command=$3
    shift 3
    made=$((made + 1))
    cp -p "$file" "$temporary/kept"
    sed "$command" "$temporary/kept" >"$file"
    if cmp -s "$temporary/kept" "$file"; then
        killers='' verdict='NOT MADE: nothing matches'
    elif ! $make build/tests >"$temporary/log" 2>&1; then
        killers='' verdict='NOT MADE: it does not compile'
    else
        killers=$(failing ${*:-$suites})
        verdict='ALIVE'
    fi
    printf '| %-34s | %s |\n' "$name" "$(shorten ${killers:-"$verdict"})"
    if [ -z "$killers" ]; then
        alive=$((alive + 1)) names="$names $name"
        case $verdict in *compile*) grep -m 3 ' error: ' "$temporary/log" || tail -n 3 "$temporary/log" ;; esac
    fi
    cp "$temporary/kept" "$file" # not -p: newer than its object
}

# The last line names those alive: it is often all that is kept of a log. Exit status 0: all are dead.
sum_up() {
    printf '\n%d wrong %ss, %d alive%s\n' "$made" "$what" "$alive" "${names:+:$names}"
    [ "$alive" = 0 ] && { [ "$made" != 0 ] || [ "$parts" -gt 1 ]; } # a part may have nothing to do
}

printf '| %-34s | killed by |\n|---|---|\n' mutant
