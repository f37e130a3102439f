#!/usr/bin/env bash
# Copies what `sluice-tradeoff page` needs of a sweep, without pictures and without the truth.
#
#   scripts/dev/keep-sweep.sh RESULTS docs/tradeoff/NAME
#
# Then `sluice-tradeoff page COPY` makes the CSV files and the page again.

set -euo pipefail
results=${1:?which results} copy=${2:?where to}
mkdir -p "$copy/runs"
cp "$results"/sweep.* "$results"/program-* "$results/machine.txt" "$results/points.csv" "$copy"
if [ -d "$results/clairvoyant" ]; then # of scenes whose tiles are traced
    mkdir -p "$copy/clairvoyant"
    cp "$results"/clairvoyant/*.jsonl "$copy/clairvoyant"
fi
for run in "$results"/runs/*/; do
    to=$copy/runs/$(basename "$run")
    mkdir -p "$to"
    cp "$run/figures.jsonl" "$to"
    if [ -f "$run/needs.trace" ]; then # first runs, whose frames are drawn
        cp "$run/frames.csv" "$run/needs.trace" "$to"
    fi
done
