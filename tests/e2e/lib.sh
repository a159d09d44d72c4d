# lib.sh - what the end-to-end tests share. Sourced by every script here, run from the top of the project with
# FF_BUILD = the folder the programs were built in. Speaks cmocka's words, so scripts/run-tests.sh counts both alike.
set -u
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
passed=0 failed=0 skipped=0
failed_names= skipped_names=

pack=$FF_BUILD/footfall-pack
crowd=$FF_BUILD/footfall-crowd

# test_that "sentence" COMMAND...: the command must succeed; what it prints is shown when it does not.
test_that() {
    sentence=$1
    shift
    echo "[ RUN      ] $sentence"
    if "$@" >"$work/test.log" 2>&1; then
        echo "[       OK ] $sentence"
        passed=$((passed + 1))
    else
        sed 's/^/    /' "$work/test.log"
        echo "[  FAILED  ] $sentence"
        failed=$((failed + 1)) failed_names="$failed_names
[  FAILED  ] $sentence"
    fi
}

# plain_test_that "sentence" COMMAND...: not under the sanitizers, which make programs four times slower: for tests that
# take long and run no other code than the rest does, only again (a second seed, more threads, one more kill).
plain_test_that() {
    case $FF_BUILD in */sanitize) ;; *) test_that "$@" ;; esac
}

# skip "sentence" "reason": count a test that cannot run here.
skip() {
    echo "SKIPPED: $1: $2"
    skipped=$((skipped + 1)) skipped_names="$skipped_names
[  SKIPPED ] $1"
}

# run STATUS COMMAND...: run a program and insist on its exit status. Leaves $work/out and $work/err.
run() {
    want=$1
    shift
    "$@" >"$work/out" 2>"$work/err"
    got=$?
    [ "$got" -eq "$want" ] && return 0
    echo "'$*' left with status $got, expected $want"
    head -20 "$work/out" "$work/err"
    return 1
}

# says out|err TEXT: the stream of the last run contains TEXT.
says() {
    grep -qF -- "$2" "$work/$1" && return 0
    echo "standard $1 does not say '$2' but:"
    head -20 "$work/$1"
    return 1
}

# silent out|err: the stream of the last run is empty.
silent() {
    [ ! -s "$work/$1" ] && return 0
    echo "standard $1 should be empty but says:"
    head -20 "$work/$1"
    return 1
}

# commands_of PROGRAM: its commands, one a line; a command of a group as GROUP/COMMAND (words: $(echo x/y | tr / ' '))
commands_of() {
    for command in $("$1" --help | sed -n '/^commands:/,/^$/s/^  \([a-z0-9-]*\) .*/\1/p'); do
        inner=$("$1" "$command" --help | sed -n '/^commands:/,/^$/s/^  \([a-z0-9-]*\) .*/\1/p')
        [ -n "$inner" ] || echo "$command"
        for name in $inner; do echo "$command/$name"; done
    done
}

# Every script ends with this.
finish() {
    echo "[==========] $((passed + failed + skipped)) test(s) run."
    echo "[  PASSED  ] $passed test(s)."
    [ "$skipped" -eq 0 ] || echo "[  SKIPPED ] $skipped test(s), listed below:$skipped_names"
    [ "$failed" -eq 0 ] || echo "[  FAILED  ] $failed test(s), listed below:$failed_names"
    [ "$failed" -eq 0 ]
    exit
}
