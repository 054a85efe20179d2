#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: docs.sh PROGRAM [FILE.md ...]
# Documents rot unless somebody runs them. Runs each line of the ```sh blocks of FILE (README.md, CONTRIBUTING.md and
# docs/*.md unless named) as a reader would, with PROGRAM as build/lightcheck, in a folder of its own: each must exit
# with 0, or with N where the line ends in `# exits N`. After the line `<!-- slow -->`, and for make and ./setup.sh, only
# the names are looked up: the command's options in its --help, the target in `make help`, the argument in setup.sh
# --help. The block after the line `<!-- needs NAME -->` tells another way to do what one before it does: it is counted as
# left out where the program NAME is not installed, and where CK_EXCLUDE_TAGS is `long`. A line of build/lightcheck that is
# indented in place of such a block would be run by nobody, and is wrong. Links to files of the project must lead
# somewhere. A ```c block after the line `<!-- NAME.c -->` is that file.
# Exit status 0: all true, 1: something is not.
set -eu
cd "$(dirname "$0")/../.."
project=$PWD
program=$(cd "$(dirname "$1")" && pwd)/${1##*/}
shift
[ $# -gt 0 ] || set -- README.md CONTRIBUTING.md docs/*.md

temporary=$(mktemp -d)
trap 'rm -rf "$temporary"' EXIT
trap 'exit 1' HUP INT TERM
reader=$temporary/reader
mkdir -p "$reader/build" "$reader/verify"
ln -s "$program" "$reader/build/lightcheck"
ln -s "$project/scenes" "$project/estimators" "$project/results" "$reader"
ln -s "$project/verify/assignments" "$reader/verify" # a program in build/asan does not find them beside itself

failed=0
wrong() {
    printf '%s: %s\n' "$where" "$1" >&2
    failed=$((failed + 1))
}

# The files that the documents have in them.
for file; do
    awk -v folder="$reader" '
        inside && /^```/ { close(name); inside = 0; name = "" }
        inside { print > name }
        /^```c$/ && name { inside = 1 }
        !inside && /[^ ]/ { name = match($0, /^<!-- [a-z0-9_]+\.c -->$/) ? folder "/" $2 : "" }
    ' "$file"
done

# FILE:LINE, tab, `slow`, `run` or the program that is needed, tab, exit status, tab, command.
commands() {
    awk '
        FNR == 1 { inside = 0; how = "run" }
        inside && /^```/ { inside = 0; how = "run"; next }
        inside && /^[^#]/ {
            status = 0
            if (match($0, /[ ]+# exits [0-9]+$/)) {
                status = $NF
                $0 = substr($0, 1, RSTART - 1)
            }
            sub(/[ ]+#[ ].*$/, "")
            printf "%s:%d\t%s\t%d\t%s\n", FILENAME, FNR, how, status, $0
        }
        !inside && /^```sh$/ { inside = 1; next }
        !inside && /[^ ]/ { how = /^<!-- slow -->$/ ? "slow" : /^<!-- needs [a-z]+ -->$/ ? $3 : "run" }
    ' "$@"
}

# look_up TEXT WORD ...: options and names, each of which must stand in TEXT as a word.
look_up() {
    help=$1
    shift
    for word; do
        word=${word%%=*}
        printf '%s\n' "$help" | grep -qE -e "(^|[^[:alnum:]-])$word([^[:alnum:]-]|\$)" || wrong "no $word in the help"
    done
}

options_of() {
    for word; do
        case $word in
        --* | -[a-zA-Z]) printf '%s ' "$word" ;;
        esac
    done
}

look_up_names() {
    name=$1 command=${2:-}
    case $name in
    build/lightcheck)
        if help=$("$program" "$command" --help 2>/dev/null); then
            look_up "$help" $(options_of "$@")
        else
            wrong "lightcheck has no command $command"
        fi
        ;;
    make) look_up "$(make -s -C "$project" help)" ${command:+"make $command"} ;;
    ./setup.sh) look_up "$(sh "$project/setup.sh" --help)" ${command:+"setup.sh $command"} ;;
    .ci/run) [ -x "$project/.ci/run" ] || wrong 'there is no .ci/run' ;;
    *) wrong "$name is neither run nor looked up" ;;
    esac
}

set -f # the words of a command are looked up, not expanded
tab=$(printf '\t')
commands "$@" >"$temporary/commands"
count=0 left_out=0
while IFS=$tab read -r where how expected line; do
    count=$((count + 1))
    case $how:$line in
    slow:* | *:make* | *:./setup.sh* | *:.ci/run*)
        look_up_names $line
        continue
        ;;
    run:*) ;;
    *)
        if [ "${CK_EXCLUDE_TAGS-}" = long ] || ! command -v "$how" >/dev/null; then
            left_out=$((left_out + 1))
            continue
        fi
        ;;
    esac
    status=0
    (cd "$reader" && sh -c "$line") </dev/null >"$temporary/out" 2>&1 || status=$?
    if [ "$status" != "$expected" ]; then
        wrong "exit status $status, the text says $expected: $line"
        tail -n 3 "$temporary/out" >&2
    fi
done <"$temporary/commands"

for file; do
    for line in $(awk '/^```/ { inside = !inside } !inside && /^    [^`]*build\/lightcheck [^`]*$/ { print FNR }' "$file"); do
        where=$file:$line
        wrong 'indented, and in no block: nobody runs it'
    done
    for link in $(grep -oE '\]\([^)#:]+[)#]' "$file" | sed 's/^..//; s/.$//'); do
        where=$file
        [ -e "$(dirname "$file")/$link" ] || wrong "the link to $link leads nowhere"
    done
done

[ $count -gt 0 ] || { where=$1 && wrong 'no command at all'; }
[ $left_out = 0 ] || echo "documents: $left_out commands left out, since what they need is not installed, or for the time"
echo "documents: $count commands, $failed wrong"
[ $failed = 0 ]
