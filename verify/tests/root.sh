# SPDX-License-Identifier: GPL-3.0-or-later
# For scripts that try something in a new minimal Debian: `. verify/tests/root.sh`, then `make_root SUITE`. Gives $root, the
# folder of it, $log, and inside(); to any script expect(), which counts in $passed and $failed. Needs root, debootstrap, and
# 1.5 GB in TMPDIR. Mirror and apt settings are this system's; on one that is not Debian, set MIRROR. The root is gone when the
# script ends.

fail() {
    echo "${0##*/}: $*" >&2
    exit 2
}

seconds() { date +%s; }

failed=0 passed=0
# expect NAME WHAT FILE: the basic regular expression WHAT stands in FILE.
expect() {
    if grep -q "$2" "$3"; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "${0##*/}: $1: no $2 in:"
        tail -n 30 "$3"
    fi
}

finish_root() {
    if mountpoint -q "$root/proc"; then
        umount "$root/proc"
    fi
    rm -rf --one-file-system "$folder"
}

make_root() {
    [ "$(id -u)" = 0 ] || fail 'only root can make and enter another root'
    for tool in debootstrap chroot; do
        command -v $tool >/dev/null || fail "$tool is missing"
    done

    # The archive that apt itself uses here, whatever the format of its sources: the first that has this Debian's own suite.
    mirror=${MIRROR:-$(. /etc/os-release && [ "$ID" = debian ] && apt-get update --print-uris |
        sed -n "s|^'\\(.*\\)/dists/${VERSION_CODENAME:-sid}/InRelease'.*|\\1|p" | head -n 1)}
    [ -n "$mirror" ] || fail 'found no Debian archive among the sources of apt; name one: MIRROR=URL'

    folder=$(mktemp -d)
    root=$folder/root
    log=$folder/log
    trap finish_root EXIT
    trap 'exit 1' HUP INT TERM

    start=$(seconds)
    debootstrap --variant=minbase "$1" "$root" "$mirror" >"$log" 2>&1 || {
        cat "$log" >&2
        fail "debootstrap of $1 failed"
    }
    echo "${0##*/}: minimal $1 in $(($(seconds) - start)) s"

    # What the network of this machine asks of apt, and nothing else of its configuration; no passwords.
    apt-config dump | grep -E '^Acquire::(http|https|ftp|Check-Valid-Until|Check-Date|ForceIPv[46]|Retries)[: ]' \
        >"$root/etc/apt/apt.conf.d/99host" || :
    cp -L /etc/resolv.conf "$root/etc/resolv.conf"
    if [ -d /etc/ssl/certs ]; then
        mkdir -p "$root/etc/ssl"
        cp -RL /etc/ssl/certs "$root/etc/ssl/" 2>/dev/null || :
    fi
    mount -t proc proc "$root/proc"
}

# inside COMMAND: in the root, by a fresh shell; of this environment only the proxies go in.
inside() {
    env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/nonexistent \
        ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} \
        ${no_proxy:+no_proxy="$no_proxy"} chroot "$root" /bin/sh -c "$1" </dev/null
}
