#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: fresh.sh [SUITE]
# Runs the README's two commands on a clean clone of HEAD in a new minimal Debian (bookworm, unless named). Needs root,
# debootstrap, git and 1.5 GB in TMPDIR. Mirror and apt settings are this system's; on one that is not Debian, set MIRROR.
# Exit status: that of the first command that failed.
set -eu
cd "$(dirname "$0")/../.."
suite=${1:-bookworm}

fail() {
    echo "fresh: $*" >&2
    exit 2
}
[ "$(id -u)" = 0 ] || fail 'only root can make and enter another root'
for tool in debootstrap git chroot; do
    command -v $tool >/dev/null || fail "$tool is missing"
done

# The archive that apt itself uses here, whatever the format of its sources: the first that has this Debian's own suite.
mirror=${MIRROR:-$(. /etc/os-release && [ "$ID" = debian ] && apt-get update --print-uris |
    sed -n "s|^'\\(.*\\)/dists/${VERSION_CODENAME:-sid}/InRelease'.*|\\1|p" | head -n 1)}
[ -n "$mirror" ] || fail 'found no Debian archive among the sources of apt; name one: MIRROR=URL'

folder=$(mktemp -d)
root=$folder/root
log=$folder/log
finish() {
    if mountpoint -q "$root/proc"; then
        umount "$root/proc"
    fi
    rm -rf --one-file-system "$folder"
}
trap finish EXIT
trap 'exit 1' HUP INT TERM

seconds() { date +%s; }
start=$(seconds)
debootstrap --variant=minbase "$suite" "$root" "$mirror" >"$log" 2>&1 || {
    cat "$log" >&2
    fail "debootstrap of $suite failed"
}
echo "fresh: minimal $suite in $(($(seconds) - start)) s"

# What the network of this machine asks of apt, and nothing else of its configuration; no passwords.
apt-config dump | grep -E '^Acquire::(http|https|ftp|Check-Valid-Until|Check-Date|ForceIPv[46]|Retries)[: ]' \
    >"$root/etc/apt/apt.conf.d/99host" || :
cp -L /etc/resolv.conf "$root/etc/resolv.conf"
if [ -d /etc/ssl/certs ]; then
    mkdir -p "$root/etc/ssl"
    cp -RL /etc/ssl/certs "$root/etc/ssl/" 2>/dev/null || :
fi
mount -t proc proc "$root/proc"

[ -z "$(git status --porcelain)" ] || echo 'fresh: the working tree has changes that are not committed, so not tested'
git clone -q --no-hardlinks . "$root/lightcheck"

# A fresh shell: of this environment only the proxies go in.
inside() {
    env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/nonexistent \
        ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} \
        ${no_proxy:+no_proxy="$no_proxy"} chroot "$root" /bin/sh -c "cd /lightcheck && $1" </dev/null
}

passed=0 failed=0 first_failure=0
for command in './setup.sh check' './setup.sh verify'; do
    start=$(seconds)
    status=0
    inside "$command" >"$log" 2>&1 || status=$?
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
