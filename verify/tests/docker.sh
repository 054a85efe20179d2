#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: docker.sh
# Tries the student's folder in Docker as it is, with its default profile: its Dockerfile builds, the first steps of docs/student.md work in
# it, the whole jail holds, and so it does for every cheat there is. Needs a running Docker; where no image debian:12 can be had, one is made by debootstrap
# (root). DOCKER_NETWORK: what builds use to fetch packages. Exit status 0: all true, 1: something is not.
set -eu
cd "$(dirname "$0")/../.."
. verify/tests/root.sh
command -v docker >/dev/null || fail 'docker is missing'
docker info >/dev/null 2>&1 || fail 'no Docker is running'
[ -x build/lightcheck ] || fail 'build/lightcheck is missing: make'

folder=$(mktemp -d)
log=$folder/log
student=lightcheck-check-student:$$ tests=lightcheck-check-tests:$$
clean_up() {
    docker image rm -f "$student" "$tests" >/dev/null 2>&1 || :
    rm -rf "$folder"
}
trap clean_up EXIT
trap 'exit 1' HUP INT TERM

if ! docker image inspect debian:12 >/dev/null 2>&1 && ! docker pull -q debian:12 >/dev/null 2>&1; then
    (
        make_root bookworm
        cp -R /etc/apt/sources.list* "$root/etc/apt/" 2>/dev/null || :
        umount "$root/proc"
        tar -C "$root" -c . | docker import - debian:12 >/dev/null
    )
fi

# build IMAGE FOLDER
build() {
    start=$(seconds)
    DOCKER_BUILDKIT=0 docker build ${DOCKER_NETWORK:+--network "$DOCKER_NETWORK"} -t "$1" "$2" >"$log" 2>&1 || {
        tail -n 30 "$log"
        fail "$1 could not be built"
    }
    echo "docker.sh: ${1%:*} built in $(($(seconds) - start)) s"
}

# inside_docker IMAGE COMMAND: nothing of the network, and the folder of a student as /work.
mkdir "$folder/student"
inside_docker() {
    docker run --rm --network none -v "$folder/student:/work" "$1" sh -c "$2" >"$log" 2>&1 || echo "exit status $?" >>"$log"
}

sh verify/grade/kit/make_kit.sh build/lightcheck "$folder/kit" >/dev/null
build "$student" "$folder/kit"
cp verify/tests/handins/all_lights.c "$folder/student/right.c"
sed 's/weight \*= fmax/weight = fmax/' verify/tests/handins/all_lights.c >"$folder/student/wrong.c"
inside_docker "$student" 'lightcheck new first && lightcheck render cornell -e first.c -s 16 -o first.png && lightcheck verify -e first.c -c emission'
expect 'first steps' '^[0-9]* rows: [0-9]* PASS, 0 FAIL, 0 UNDECIDED' "$log"
[ -s "$folder/student/first.png" ] || expect 'first steps' '^a picture that the student has outside$' "$log"
inside_docker "$student" 'lightcheck grade right.c -a light_direct'
expect 'right file' '^score \([0-9.]*\) of \1,' "$log"
expect 'right file' 'jail: limits, seccomp, Landlock, another user$' "$log"
inside_docker "$student" 'lightcheck grade wrong.c -a light_direct'
expect 'wrong file' '^exit status 1$' "$log"
inside_docker "$student" 'setpriv --reuid 65534 --regid 65534 --clear-groups lightcheck grade right.c -a light_direct'
expect 'as nobody' 'jail: limits, seccomp, Landlock; without: another user$' "$log"
expect 'as nobody' '^score \([0-9.]*\) of \1,' "$log"

git archive --prefix=lightcheck/ HEAD | tar -x -C "$folder"
cat >"$folder/lightcheck/Dockerfile" <<'DOCKERFILE'
FROM debian:12
COPY . /lightcheck
WORKDIR /lightcheck
RUN ./setup.sh install && make -j2 all build/tests
DOCKERFILE
build "$tests" "$folder/lightcheck"
for suite in jail plugin pool grade grade_fair class; do
    inside_docker "$tests" "CK_VERBOSITY=normal CK_TIMEOUT_MULTIPLIER=5 LIGHTCHECK=build/lightcheck build/tests $suite"
    expect "suite $suite" '100%: Checks: [0-9]*, Failures: 0, Errors: 0' "$log"
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
