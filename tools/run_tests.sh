#!/usr/bin/env bash
# tools/run_tests.sh PRESET: runs the tests of a preset, then says why tests were skipped.
set -uo pipefail
cd "$(dirname "$0")/.."
preset=$1
ctest --preset "$preset"
status=$?
reasons=$(grep -A1 ': Skipped$' "build-$preset/Testing/Temporary/LastTest.log" 2>/dev/null |
    grep -v -e ': Skipped$' -e '^--$' | sort | uniq -c)
[ -z "$reasons" ] || printf '\nSkipped tests, by reason:\n%s\n' "$reasons"
exit $status
