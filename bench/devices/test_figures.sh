#!/usr/bin/env bash
# Whether the benchmark runs and prints its figures, and whether a pool reads what one device does.
#
#   bench/devices/test_figures.sh PROGRAM

set -uo pipefail
program=$1 failed=0

lines=$("$program" --quick --json --devices 0,0,0 --textures 2)
status=$?
[ "$status" != 77 ] || exit 77
[ "$status" = 0 ] || failed=1

value() { sed -n "s/^{\"name\": \"$1\", \"value\": \([0-9][0-9.e+]*\), \"unit\": \"[^\"]*\"}\$/\1/p" <<<"$lines"; }

for name in devices tiles_per_device alone.seconds alone.rate alone.cpu own.seconds own.rate own.cpu own.read pool.seconds \
    pool.rate pool.cpu pool.read pool.joined pool.cached pool.kept_peak pool.gain; do
    if [ -z "$(value "$name")" ]; then
        echo "there is no figure $name" >&2
        failed=1
    fi
done
# Three devices read three times as much without a pool.
if ! awk -v own="$(value own.read)" -v pool="$(value pool.read)" 'BEGIN { exit !(own > 2.99 * pool && own < 3.01 * pool) }'; then
    echo "own.read is $(value own.read), pool.read is $(value pool.read): not three times as much" >&2
    failed=1
fi
exit "$failed"
