#!/bin/sh
# Run cmocka test programs one after the other and sum up what they say. usage: run-tests.sh PROGRAM...
passed=0 failed=0
for program in "$@"; do
    log="$program.log"
    if "$program" >"$log" 2>&1; then status=0; else status=$?; fi
    ok=$(sed -n 's/.*\[  PASSED  \] \([0-9]*\) test.*/\1/p' "$log" | head -1)
    bad=$(grep -c '^\[  FAILED  \] [a-z_A-Z]' "$log")
    grep -h '^SKIPPED' "$log" | sed "s|^|$(basename "$program"): |"
    if [ "$status" -ne 0 ]; then
        [ "$bad" -gt 0 ] || bad=1
        echo "FAILED: $program (exit $status)"
        tail -40 "$log"
    else
        echo "ok: $program (${ok:-0} tests)"
    fi
    passed=$((passed + ${ok:-0})) failed=$((failed + bad))
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
