#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: fresh.sh [SUITE]
# Runs the README's two commands on a clean clone of HEAD in a new minimal Debian (bookworm, unless named), as root.sh
# makes it. Exit status: that of the first command that failed.
set -eu
cd "$(dirname "$0")/../.."
. verify/tests/root.sh
command -v git >/dev/null || fail 'git is missing'
make_root "${1:-bookworm}"

[ -z "$(git status --porcelain)" ] || echo 'fresh: the working tree has changes that are not committed, so not tested'
git clone -q --no-hardlinks . "$root/lightcheck"

passed=0 failed=0 first_failure=0
for command in './setup.sh check' './setup.sh verify'; do
    start=$(seconds)
    status=0
    inside "cd /lightcheck && $command" >"$log" 2>&1 || status=$?
    fetched=$(sed -n 's/^Need to get \([^/]* [kM]*B\).*/, \1 of packages fetched/p' "$log")
    echo "fresh: $command: exit status $status, $(($(seconds) - start)) s$fetched"
    if [ $status = 0 ]; then
        passed=$((passed + 1))
    else
        tail -n 40 "$log"
        failed=$((failed + 1))
        [ $first_failure != 0 ] || first_failure=$status
    fi
done
echo "$passed passed, $failed failed"
exit $first_failure
