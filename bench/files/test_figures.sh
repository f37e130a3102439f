#!/usr/bin/env bash
# Whether the benchmark runs, keeps all stores in use with a pool, and prints its figures.
#
#   bench/files/test_figures.sh PROGRAM

set -uo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
lines=$("$1" --quick --json "$folder") || exit 1
for name in pool.{stores,opening,reads.all,reads.open,open_files} no_pool.stores \
    no_pool.unlimited.stores no_pool.reads.{all,open} catalogue.{rows,first,memory,name}; do
    grep -q -E "^\{\"name\": \"$name\", \"value\": [0-9][0-9.e+-]*, \"unit\": \"[^\"]+\"\}$" <<<"$lines" || {
        echo "there is no figure $name" >&2
        exit 1
    }
done
grep -q -F '{"name": "pool.stores", "value": 300,' <<<"$lines" || {
    echo "not all stores are in use" >&2
    exit 1
}
[ -z "$(ls -A "$folder")" ] || {
    echo "files are left" >&2
    exit 1
}
