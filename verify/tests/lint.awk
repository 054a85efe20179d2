# SPDX-License-Identifier: GPL-3.0-or-later
# The rules of lint.sh for C. Reads the names of all .c and .h files of the project, then each file.

BEGIN {
    c99 = " assert complex ctype errno fenv float inttypes iso646 limits locale math setjmp signal stdarg stdbool" \
          " stddef stdint stdio stdlib string tgmath time wchar wctype "
    posix = " dirent dlfcn fcntl fnmatch glob grp poll pthread pwd regex sched semaphore spawn strings termios" \
            " unistd wordexp "
    hiding = " src/core/accel src/core/sampler src/io/exr src/io/png "
    bad = 0
}

{
    files[++file_count] = $0
    exists[$0] = 1
}

END {
    for (i = 1; i <= file_count; ++i)
        check_file(files[i])
    exit bad > 0
}

function report(reason) {
    printf "%s:%d: %s\n", file, line_number, reason
    ++bad
}

function within(path, prefix) { return index(path, prefix) == 1 }

function check_file(name,    line, code) {
    file = name
    line_number = 0
    in_comment = 0
    while ((getline line < file) > 0) {
        ++line_number
        if (line_number == 1 && line !~ /SPDX-License-Identifier: (GPL-3\.0-or-later|MIT)/)
            report("no SPDX-License-Identifier (GPL-3.0-or-later, or MIT) on the first line")
        if (line ~ /^ *\t/)
            report("indented with a tab; four spaces are the habit")
        code = without_comments(line)
        if (within(file, "verify/tests/cheats/"))
            continue # what is forbidden is what they are for
        if (code ~ /^[ \t]*#[ \t]*include/)
            check_include(line)
        else
            check_words(code)
    }
    close(file)
    if (line_number == 0) {
        line_number = 1
        report("empty file, without SPDX-License-Identifier")
    }
}

# The line without comments and with its strings and characters emptied; follows comments over lines.
function without_comments(line,    out, c, end) {
    out = ""
    while (line != "") {
        if (in_comment) {
            end = index(line, "*/")
            if (!end)
                return out
            line = substr(line, end + 2)
            in_comment = 0
            out = out " "
        } else if (!match(line, /\/\*|\/\/|"|'/)) {
            return out line
        } else {
            out = out substr(line, 1, RSTART - 1)
            c = substr(line, RSTART, RLENGTH)
            line = substr(line, RSTART + RLENGTH)
            if (c == "//")
                return out
            if (c == "/*") {
                in_comment = 1
            } else {
                if (c == "\"")
                    match(line, /^([^"\\]|\\.)*"?/)
                else
                    match(line, /^([^'\\]|\\.)*'?/)
                line = substr(line, RLENGTH + 1)
                out = out c c
            }
        }
    }
    return out
}

# ---- includes ----

function check_include(line,    path, quoted, target) {
    sub(/^[ \t]*#[ \t]*include[ \t]*/, "", line)
    quoted = substr(line, 1, 1) == "\""
    if (!match(line, /^("[^"]+"|<[^>]+>)/)) {
        report("an include that is not spelt out cannot be checked")
        return
    }
    path = substr(line, 2, RLENGTH - 2)
    target = find_target(path, quoted)
    if (target != "")
        check_own(target)
    else if (quoted)
        report("there is no " path " in the project; <> is for others' headers")
    else
        check_foreign(path)
}

# The project's file that an include means, by the include path of the Makefile (-I. -Isrc -Isrc/core), or "".
function find_target(path, quoted,    folder) {
    folder = file
    sub(/[^\/]*$/, "", folder)
    if (quoted && normal(folder path) in exists)
        return normal(folder path)
    if (normal(path) in exists)
        return normal(path)
    if (normal("src/" path) in exists)
        return normal("src/" path)
    if (normal("src/core/" path) in exists)
        return normal("src/core/" path)
    return ""
}

function normal(path) {
    gsub(/\/\.\//, "/", path)
    sub(/^\.\//, "", path)
    while (match(path, /[^\/]+\/\.\.\//) && substr(path, RSTART, 3) != "../")
        path = substr(path, 1, RSTART - 1) substr(path, RSTART + RLENGTH)
    return path
}

# Dependencies run one way: src/core <- src/io <- verify <- src/cli.
function check_own(target,    stem) {
    stem = target
    if (sub(/_[^\/]*\.h$/, "", stem) && index(hiding, " " stem " ") && !of_module(stem))
        report(target " is private to " stem "*, which hides a library")
    if (within(file, "estimators/") || within(file, "verify/mutants/")) {
        if (target != "src/core/lightcheck.h" && !is_registry(target) &&
            !(within(file, "verify/mutants/") && target == "verify/mutants/registry.h"))
            report("an estimator includes lightcheck.h only, not " target)
    } else if (within(file, "src/core/")) {
        if (!within(target, "src/core/"))
            report("src/core includes nothing from other folders, not " target)
    } else if (within(file, "src/io/")) {
        if (target !~ /^src\/(core|io)\//)
            report("src/io includes src/core only, not " target)
    } else if (within(file, "verify/stats/") || within(file, "verify/analytic/")) {
        if (target !~ /^(src\/core|verify\/stats|verify\/analytic)\//)
            report("verify/stats and verify/analytic are pure functions over src/core, and do not include " target)
    } else if (within(file, "verify/grade/worker/")) {
        if (target !~ /^(src\/core|verify\/grade)\//)
            report("the worker knows no estimator, no check and no file, and does not include " target)
    } else if (within(file, "verify/") && within(target, "src/cli/")) {
        report("verify includes nothing from src/cli, not " target)
    }
}

# registry.c is a table, not an estimator; its header stands beside it.
function is_registry(target,    own) {
    own = file
    return sub(/registry\.[ch]$/, "registry.h", own) && target == own
}

# Each foreign library has its places; one without an entry here is not yet a dependency.
function check_foreign(path) {
    if (path ~ /^[a-z0-9]+\.h$/ && index(c99, " " substr(path, 1, length(path) - 2) " "))
        return
    if (within(file, "estimators/") || within(file, "verify/mutants/"))
        report("an estimator includes lightcheck.h and C99's headers only, not " path)
    else if (path ~ /^embree[0-9]*\//)
        only(of_module("src/core/accel"), "Embree", "src/core/accel*")
    else if (path ~ /^(OpenEXR|Imath)\// || path ~ /^(openexr|Imf|Imath)/)
        only(of_module("src/io/exr"), "OpenEXR", "src/io/exr*")
    else if (path ~ /(^|\/)png(conf)?\.h$/)
        only(of_module("src/io/png") || within(file, "verify/tests/"), "libpng", "src/io/png* and the tests")
    else if (path ~ /^expat/)
        only(of_module("src/io/scene_read"), "expat", "src/io/scene_read*")
    else if (path ~ /^jansson/)
        only(file ~ /^(verify\/(report|grade|renderers|tests)|src\/cli)\//, "jansson", "verify/report, verify/grade, verify/renderers, verify/tests and src/cli")
    else if (path ~ /^gsl\//)
        only(within(file, "verify/"), "GSL", "verify")
    else if (path ~ /^Random123\//)
        only(of_module("src/core/sampler") || of_module("verify/grade/seeds"), "Random123", "src/core/sampler* and verify/grade/seeds*")
    else if (path ~ /^(seccomp\.h|linux\/)/)
        only(file ~ /^verify\/(grade|tests)\//, path, "verify/grade and verify/tests")
    else if (path == "check.h")
        only(within(file, "verify/tests/"), "Check", "verify/tests")
    else if (path !~ /^sys\/[a-z]+\.h$/ && !(path ~ /\.h$/ && index(posix, " " substr(path, 1, length(path) - 2) " ")))
        report(path " is neither C99 nor POSIX nor a dependency that verify/tests/lint.awk knows")
}

# A module that hides a library: X.c, and where it is split X_more.c and the private header X_more.h, but never X.h.
function of_module(stem) { return file == stem ".c" || file ~ ("^" stem "_[^/]*\\.[ch]$") }

function only(allowed, what, where) {
    if (!allowed)
        report(what " is included in " where " only")
}

# ---- words ----

function has_word(code, word) { return (" " code " ") ~ ("[^A-Za-z0-9_](" word ")[^A-Za-z0-9_]") }
function has_call(code, word) { return (" " code) ~ ("[^A-Za-z0-9_.>](" word ")[ \t]*\\(") }

function check_words(code) {
    if (code !~ /[a-zA-Z]/)
        return
    if (!within(file, "src/cli/") && !within(file, "verify/tests/") && !within(file, "verify/proof/")) {
        if (has_call(code, "v?printf|puts|putchar|perror|psignal") || has_word(code, "stdout|stderr"))
            report("only src/cli, verify/tests and verify/proof print; write to a FILE that is handed over, or return an lc_error")
        if (has_call(code, "exit|_Exit|quick_exit|abort"))
            report("only src/cli, verify/tests and verify/proof exit; return an lc_status")
        # A child between fork and exec has no other way out.
        if (has_call(code, "_exit") && file !~ /^verify\/(grade|renderers)\//)
            report("only a child of verify/grade or verify/renderers may call _exit; return an lc_status")
    }
    if (has_word(code, "_GNU_SOURCE") && !within(file, "verify/grade/"))
        report("_GNU_SOURCE is for verify/grade only")
    if (has_word(code, "_DEFAULT_SOURCE|_BSD_SOURCE|_SVID_SOURCE|_XOPEN_SOURCE|_POSIX_C_SOURCE"))
        report("the Makefile says _POSIX_C_SOURCE 200809L for all files")
    if (has_word(code, "setlocale") && !within(file, "verify/tests/")) # tests change it to see that nothing follows
        report("no setlocale: numbers are read and written in the C locale")
    if (has_word(code, "M_(1_|2_)?(PI|SQRTPI)(_[24])?|M_PIl"))
        report("M_PI is not in C99; LC_PI is in lightcheck.h")
}
