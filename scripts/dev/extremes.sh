#!/usr/bin/env bash
# Runs the tests of extremes and prints what they found: the largest errors of functions over the
# whole range of their arguments, what became of values, sizes and times, each with its bound.
#
#   scripts/dev/extremes.sh [--long] [build folder]
#
#   --long    many more cases: minutes to an hour instead of seconds
#   --help
#
# The build folder (default: build/extremes) is made if it is not there. Needs what
# scripts/test.sh has installed. Exits with 0 if all tests passed.
#
# Environment: SLUICE_DEVICE    the Vulkan device; default: the first with sparse residency
#              VK_DRIVER_FILES  the Vulkan drivers to look at (default: lavapipe alone)

set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/../lib" && pwd)
for part in common packages mesa build; do
    # shellcheck source=/dev/null
    . "$here/$part.sh"
done

long=() folder=''
while [ $# -gt 0 ]; do
    case $1 in
    --long) long=(--test-args=--long --timeout-multiplier=0) ;;
    --help) usage_of "$0"; exit 0 ;;
    -*) die "unknown option $1 (see --help)" ;;
    *) folder=$1 ;;
    esac
    shift
done
folder=${folder:-$SLUICE_BUILD/extremes}
trap give_back_build EXIT

select_lavapipe
[ -d "$folder" ] || configure "$folder" -Dbuildtype=debugoptimized
rm -rf "$folder/meson-logs/"testlog*
status=0
# builds what these tests need
meson test -C "$folder" --suite extremes "${long[@]}" || status=$?
title "The worst that was found, and its bound"
python3 "$here/collect.py" extremes "$folder"
exit "$status"
