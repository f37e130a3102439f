#!/usr/bin/env bash
# Whether the benchmarks run and print their figures; what those are is nobody's business here.
#
#   bench/vulkan/test_figures.sh PROGRAM MODE

set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
program=$1 mode=$2 failed=0

lines=$("$program" --quick --json --residency "$mode")
status=$?
[ "$status" != 77 ] || exit 77
[ "$status" = 0 ] || failed=1

for name in $("$here/run.sh" --list-figures); do
    case $mode.$name in
    # not with --quick; not without bindings
    *.sampling.*.close_up.* | *.sampling.*.noise.* | *.sharp.blocks_16.*) continue ;;
    *.feedback.*.quads_64.* | *.feedback.*.blocks_16.* | *.feedback.*.lattice_64.*) continue ;;
    paged.fill.floor.bind* | dense.fill.floor.bind*) continue ;;
    esac
    if ! grep -q -E "^\{\"name\": \"$mode\.$name\", \"value\": -?[0-9][0-9.e+-]*, \"unit\": \"[^\"]+\"\}$" <<<"$lines"; then
        echo "there is no figure $mode.$name" >&2
        failed=1
    fi
done
exit "$failed"
