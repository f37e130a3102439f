#!/usr/bin/env bash
# Measures how long a picture on a server stays coarse in the gallery, and prints a table.
#
#   bench/remote/sharp.sh BUILD STORE [MILLISECONDS...]
#
# BUILD is a build folder with everything, STORE a tile store, MILLISECONDS are round trips (default: 0 10 50 200). Each
# line is of run.sh, which says what it needs. The camera walks for 4 s and rests for 1 s, 30 frames per second, with 1
# and with 32 threads. A wait begins with the first frame that needs a finer level in a region and ends with the first
# that shows it. frame_ms tells whether the machine kept up: 33.3.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$(realpath "${1:?a build folder}") store=$(realpath "${2:?a tile store}")
shift 2
[ $# -gt 0 ] || set -- 0 10 50 200
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
names='frames_until_sharp_p50 frames_until_sharp_p99 frames_until_sharp_mean missing_pixels_percent bytes_read frame_ms_median'
printf '%-12s%-9s' 'round trip' threads
# shellcheck disable=SC2086 # the names are words
printf '%-25s' $names
echo
for round_trip; do
    for threads in 1 32; do
        "$here/run.sh" --bin "$build" --serve "$round_trip" "$store" -- \
            "$build/samples/streaming/streaming" --images %u --cache cache --frames 150 --rest-frames 30 --fps 30 \
            --size 176x99 --samples 1 --fade 0 --needs on --write-frames none --threads "$threads" --output out --json \
            >figures 2>log || { cat log >&2; exit 1; }
        printf '%-12s%-9s' "$round_trip ms" "$threads"
        for name in $names; do
            printf '%-25s' "$(sed -n "s/.*\"$name\", \"value\": \([^,]*\),.*/\1/p" figures)"
        done
        echo
    done
done
