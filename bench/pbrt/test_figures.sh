#!/usr/bin/env bash
# Whether the benchmark runs and prints its figures.
#
#   bench/pbrt/test_figures.sh PROGRAM

set -uo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
lines=$("$1" --quick --json "$folder") || exit 1
for name in text.{size,open,count_lines,open_per_count_lines,read_mesh} \
    instances.{count,open,text,memory,peak_memory} ply.{size,bounds,read}; do
    grep -q -E "^\{\"name\": \"$name\", \"value\": [0-9][0-9.e+-]*, \"unit\": \"[^\"]+\"\}$" <<<"$lines" || {
        echo "there is no figure $name" >&2
        exit 1
    }
done
[ -z "$(ls -A "$folder")" ] || {
    echo "files are left" >&2
    exit 1
}
