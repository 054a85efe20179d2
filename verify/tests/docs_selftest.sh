#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: docs_selftest.sh PROGRAM
# Shows that docs.sh can fail: each line marked `wrong` in a document must be found, and nothing else.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
temporary=$(mktemp -d)
trap 'rm -rf "$temporary"' EXIT
trap 'exit 1' HUP INT TERM
document=$temporary/document.md
cat >"$document" <<'END'
```sh
build/lightcheck list checks
# a comment
build/lightcheck list nothing   # exits 2
build/lightcheck list nothing   # wrong
build/lightcheck list checks    # exits 1
build/lightcheck list checks | grep -q energy
cp "$document" x                # wrong
make verify
make nothing-of-that-name       # wrong
./setup.sh check
./setup.sh nothing              # wrong
```
```text
build/lightcheck list nothing
```
<!-- right.c -->
```c
int x;
```
```c
int y;
```
```sh
grep -q 'int x;' right.c
grep -q 'int y;' right.c        # wrong
```

<!-- slow -->
```sh
build/lightcheck verify --suite full -c analytic
build/lightcheck verify --no-such-option # wrong
build/lightcheck nothing                 # wrong
```
```sh
build/lightcheck nothing        # wrong
```
<!-- needs sed -->
```sh
build/lightcheck nothing        # wrong
build/lightcheck list checks
```
<!-- needs nowhere -->
```sh
build/lightcheck nothing
```
```sh
build/lightcheck nothing        # wrong
```
    build/lightcheck list checks # wrong
A [link](document.md), one [elsewhere](https://example.org/x.md), and a broken [one](missing.md).
END
CK_EXCLUDE_TAGS="" sh "$here/docs.sh" "$1" "$document" >"$temporary/out" 2>&1 && status=0 || status=$?
{ grep -nE '# wrong$|# exits 1$' "$document" | cut -d: -f1 && echo missing.md; } >"$temporary/expected"
sed -n -e "s|^$document:\([0-9]*\): .*|\1|p" -e 's/.*the link to \(.*\) leads nowhere$/\1/p' "$temporary/out" \
    >"$temporary/found"
if [ $status != 1 ] || ! cmp -s "$temporary/expected" "$temporary/found"; then
    echo 'docs_selftest: docs.sh did not find exactly what is wrong:' >&2
    cat "$temporary/out" >&2
    exit 1
fi
