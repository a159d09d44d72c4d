#!/bin/sh
# Run test programs, as many at a time as there are processors, and sum up what they say.
#
#   scripts/run-tests.sh BUILD:PROGRAM...
#
# BUILD is the folder the programs under test were built in (FF_BUILD for the program). PROGRAM is a cmocka test, a
# script of tests/e2e, which speaks the same words, or a fuzzer (fuzz_*): it goes over its saved seeds in
# tests/fuzz/seeds and then FF_FUZZ_RUNS (20000) runs further. Prints one line per program with the seconds it took, everything a
# failed one said, and every line that begins with SKIPPED. The last line is the total: "N passed, N failed[, N skipped]".

log_of() { # BUILD:PROGRAM
    echo "${1%%:*}/logs/$(echo "${1#*:}" | tr '/' '-').log"
}

# A refused allocation is an answer the code must handle, not an end; leaks are findings.
export ASAN_OPTIONS="${ASAN_OPTIONS:-allocator_may_return_null=1:detect_leaks=1:detect_stack_use_after_return=1}"
export UBSAN_OPTIONS="${UBSAN_OPTIONS:-print_stacktrace=1}"

fuzz() {
    target=$(basename "$1")
    found=$FF_BUILD/found-$target
    seeds=tests/fuzz/seeds/${target#fuzz_}
    [ -d "$seeds" ] || seeds=
    mkdir -p "$found"
    grown=$(mktemp -d)
    # Finds are kept in $found; what merely grows the corpus is thrown away, so every run starts from the seeds.
    "$1" -seed="${FF_FUZZ_SEED:-1}" -runs="${FF_FUZZ_RUNS:-20000}" -timeout=20 -rss_limit_mb=3000 -print_final_stats=1 \
        -verbosity=0 -artifact_prefix="$found/" "$grown" $seeds
    status=$?
    rm -rf "$grown"
    [ "$status" -eq 0 ] && echo "[  PASSED  ] 1 test(s)."
    return "$status"
}

run_one() { # BUILD:PROGRAM; its counts go beside its log
    FF_BUILD=${1%%:*} program=${1#*:}
    export FF_BUILD program
    log=$(log_of "$1")
    mkdir -p "$(dirname "$log")"
    began=$(date +%s)
    case $(basename "$program") in
    fuzz_*) fuzz "$program" >"$log" 2>&1 ;;
    *.sh) timeout "${FF_TEST_SECONDS:-300}" sh "$program" >"$log" 2>&1 ;;
    *) timeout "${FF_TEST_SECONDS:-300}" "$program" >"$log" 2>&1 ;;
    esac
    status=$?
    took=$(($(date +%s) - began))
    awk -v status="$status" '
        /\[  PASSED  \] [0-9]+ test/ { match($0, /PASSED  \] [0-9]+/); passed += substr($0, RSTART + 10, RLENGTH - 10) }
        /\[  FAILED  \] [0-9]+ test/ { match($0, /FAILED  \] [0-9]+/); failed += substr($0, RSTART + 10, RLENGTH - 10) }
        /\[  SKIPPED \] [0-9]+ test/ { match($0, /SKIPPED \] [0-9]+/); skipped += substr($0, RSTART + 10, RLENGTH - 10) }
        END {
            if (status != 0 && failed == 0) failed = 1
            if (passed + failed + skipped == 0) failed = 1
            print passed + 0, failed + 0, skipped + 0
        }' "$log" >"$log.counts"
    read -r passed failed skipped <"$log.counts"
    if [ "$failed" -ne 0 ]; then
        echo "FAILED: $program in $FF_BUILD (exit status $status)"
        # What went well says nothing here.
        awk '/^\[       OK \]/ { run = ""; next } /^\[ RUN / { run = $0; next }
            { if (run) print run; run = ""; print } END { if (run) print run }' "$log" | tail -60
    else
        grep '^SKIPPED' "$log" | sed "s|^SKIPPED[: ]*|SKIPPED: $program: |"
        echo "ok: $program ($passed) $took s"
    fi
}

if [ "$1" = --one ]; then
    run_one "$2"
    exit 0
fi

for item in "$@"; do rm -f "$(log_of "$item").counts"; done
printf '%s\n' "$@" | xargs -P "$(nproc)" -n 1 "$0" --one
passed=0 failed=0 skipped=0
for item in "$@"; do
    if read -r p f s <"$(log_of "$item").counts"; then
        passed=$((passed + p)) failed=$((failed + f)) skipped=$((skipped + s))
    else
        failed=$((failed + 1))
    fi
done
[ "$skipped" -eq 0 ] && echo "$passed passed, $failed failed" || echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
