#!/usr/bin/env bash
# Whether the benchmark runs and prints its figures.
#
#   bench/neural/test_host_figures.sh PROGRAM

set -uo pipefail
lines=$("$1" --json) || exit
for name in schema1.int8 schema1.fp8 schema3.int8 schema3.fp8; do
    if ! grep -q -E "^\{\"name\": \"neural_host\.$name\", \"value\": [0-9][0-9.e+-]*, \"unit\": \"texels/s\"\}$" <<<"$lines"; then
        echo "there is no figure neural_host.$name" >&2
        exit 1
    fi
done
