#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs what lightcheck needs and, when asked, builds and runs it. Asks nothing but a shell and apt.
set -eu

packages='make gcc g++ libc6-dev libembree-dev libopenexr-dev libpng-dev libexpat1-dev libjansson-dev libgsl-dev
librandom123-dev libseccomp-dev check povray'

usage='usage: ./setup.sh                       install what is missing
       ./setup.sh install [PACKAGE...]  the same, and these packages
       ./setup.sh check                 install, build, run the unit tests
       ./setup.sh verify [ARGUMENT...]  install, build, run "lightcheck verify ARGUMENT..."
Needs Debian 12 or Ubuntu 24.04, or newer. Runs in the folder it stands in; paths are relative to that.
Exit status: the program'\''s own (0 verified, 1 shown wrong, 2 bad input or system, 3 undecided, 4 fault).'

say() { printf 'setup.sh: %s\n' "$*" >&2; }

# The distribution's name and version, from os-release (freedesktop.org).
system() {
    ID='' VERSION_ID='' PRETTY_NAME='this system'
    [ ! -r /etc/os-release ] || . /etc/os-release
    case $ID in
    debian) oldest='Debian 12' number=${VERSION_ID:-99} least=12 ;; # testing and sid have no number
    ubuntu) oldest='Ubuntu 24.04' number=${VERSION_ID%%.*} least=24 ;;
    *) oldest='' ;;
    esac
}

# Those of the packages named that are not installed.
missing() {
    there=$(dpkg-query -W -f '${Package}=${db:Status-Status}\n' "$@" 2>/dev/null || :)
    for package; do
        case "
$there
" in
        *"
$package=installed
"*) ;;
        *) printf '%s ' "$package" ;;
        esac
    done
}

# Elsewhere than on Debian and Ubuntu nothing is installed; it is enough that all headers are there.
other_system() {
    if command -v make >/dev/null 2>&1 && make -s needs >&2; then
        return
    fi
    say "$PRETTY_NAME is neither Debian nor Ubuntu: install what these Debian packages contain, then run me again:" \
        $packages
    exit 2
}

install_missing() {
    system
    if [ -z "$oldest" ]; then
        other_system
        return
    fi
    if [ "$number" -lt "$least" ]; then
        say "$PRETTY_NAME is too old, its OpenEXR has no C API: use $oldest or newer"
        exit 2
    fi
    wanted=$(missing $packages "$@")
    wanted=${wanted% }
    [ -n "$wanted" ] || return 0
    sudo=
    if [ "$(id -u)" != 0 ]; then
        if ! command -v sudo >/dev/null 2>&1; then
            say 'some packages are missing, and I am neither root nor find sudo; as root, run:'
            say "apt-get update && apt-get install -y --no-install-recommends $wanted"
            exit 2
        fi
        sudo=sudo
    fi
    say "installing $wanted"
    # Standard output belongs to the program. The lock may be held on a machine that has just started.
    if ! { $sudo apt-get -q update &&
        $sudo env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=120 install -y \
            --no-install-recommends $wanted; } </dev/null >&2; then
        say "apt-get could not install $wanted"
        exit 4
    fi
}

build() {
    make -j"$(nproc 2>/dev/null || echo 2)" "$@" >&2 || {
        say "make $* failed"
        exit 4
    }
}

cd "$(dirname "$0")"
command=${1:-install}
[ $# = 0 ] || shift
case $command in
install)
    install_missing "$@"
    ;;
check)
    if [ $# != 0 ]; then
        say "check takes no arguments, got '$*'"
        exit 2
    fi
    install_missing
    build all build/tests
    make -s check || exit 1 # all is built: only a test can have failed, and make says 2
    ;;
verify)
    install_missing
    build all
    exec build/lightcheck verify "$@" # not by make, which turns each exit status into 2
    ;;
-h | --help | help)
    printf '%s\n' "$usage"
    ;;
*)
    say "unknown command '$command'"
    printf '%s\n' "$usage" >&2
    exit 2
    ;;
esac
