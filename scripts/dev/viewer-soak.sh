#!/usr/bin/env bash
# viewer-soak.sh SLUICE-VIEW FOLDER [MINUTES [SCENE...]]: the viewer without a window for so many minutes of
# its own time (default: 10), at 60 frames per second of its time, with another budget every 5 seconds. The camera
# walks its tour. Fails if a tile fails or if memory grows: the most that is resident on the host in the last
# quarter may be 5 % more than in the second one. FOLDER takes figures.csv, memory.txt and out.json.
set -euo pipefail
[ $# -ge 2 ] || { sed -n '2,5s/^# //p' "$0"; exit 2; }
viewer=$(realpath "$1") folder=$2 minutes=${3:-10}
shift $(($# < 3 ? $# : 3))
mkdir -p "$folder"
frames=$((minutes * 3600))
budgets=(16 256 32 0 64 8 128)
for ((frame = 0, i = 0; frame < frames; frame += 300, i++)); do
    echo "$frame set budget ${budgets[i % ${#budgets[@]}]}"
done >"$folder/script.txt"

"$viewer" --headless --size "${SIZE:-640x360}" --frames "$frames" --script "$folder/script.txt" --json \
    --csv "$folder/figures.csv" "$@" >"$folder/out.json" &
process=$!
while [ -r /proc/$process/status ] && kib=$(awk '/^VmRSS/ {print $2}' /proc/$process/status) && [ -n "$kib" ]; do
    echo "$kib"
    sleep "${PAUSE:-1}"
done >"$folder/memory.txt"
wait $process

failed=$(sed -n 's/.*"tiles failed", "value": \([0-9]*\).*/\1/p' "$folder/out.json")
awk -v failed="${failed:-none}" '
    { kib[NR] = $1 }
    END {
        for (i = 1; i <= NR; i++) {
            quarter = int(4 * (i - 1) / NR)
            if (kib[i] > most[quarter]) most[quarter] = kib[i]
        }
        printf "memory of the host by quarter: %d %d %d %d MiB; %s tiles failed\n",
            most[0] / 1024, most[1] / 1024, most[2] / 1024, most[3] / 1024, failed
        exit NR < 8 || failed != "0" || most[3] > 1.05 * most[1]
    }' "$folder/memory.txt"
