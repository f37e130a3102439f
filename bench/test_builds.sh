#!/usr/bin/env bash
# Checks that a benchmark that builds the library itself still builds, runs and prints figures.
#
#   bench/test_builds.sh RUN.SH [OPTION]...

set -uo pipefail
run=$1
shift
lines=$("$run" --quick --json "$@") || exit 1
grep -q -E '^\{"name": "[^"]+", "value": -?[0-9][0-9.e+-]*, "unit": "[^"]+"\}$' <<<"$lines" || {
    echo "$run printed no figure" >&2
    exit 1
}
