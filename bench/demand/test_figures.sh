#!/usr/bin/env bash
# Whether the benchmark runs and prints its figures; what those are is nobody's business here.
#
#   bench/demand/test_figures.sh PROGRAM

set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
program=$1 failed=0

lines=$("$program" --quick --json)
status=$?
[ "$status" != 77 ] || exit 77
[ "$status" = 0 ] || failed=1

for name in $("$here/run.sh" --list-figures); do
    if ! grep -q -E "^\{\"name\": \"$name\", \"value\": -?[0-9][0-9.e+-]*, \"unit\": \"[^\"]+\"\}$" <<<"$lines"; then
        echo "there is no figure $name" >&2
        failed=1
    fi
done
exit "$failed"
