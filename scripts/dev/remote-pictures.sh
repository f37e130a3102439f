#!/usr/bin/env bash
# remote-pictures.sh BUILD FOLDER: draws docs/images/remote-threads.png: a picture in the gallery that comes from a
# server behind a line with a round trip of 50 ms, with 1 and with 32 threads. Prints what each walk loaded.
#
# BUILD is a build folder with everything. FOLDER keeps the picture's store and all frames. The line is that of
# bench/remote/run.sh, which says what it needs. The sheet has the frames that began 200, 450, 600, 800, 1200 and
# 2400 ms after the first one, or a little later, by the times of frames.csv.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=$(realpath "${1:?a build folder}") folder=${2:?a folder}
mkdir -p "$folder"
cd "$folder"
if [ ! -e picture.store ]; then
    "$build/samples/streaming/streaming" --cache cache --generate-only --generate-scale 2
    "$build/tools/sluice-bake/sluice-bake" cache/gallery-2-of-2/mandelbrot-*.exr -o picture.store
fi

# The numbers of the frames, and when they began.
choose() { # frames.csv
    awk -F, -v wanted="200 450 600 800 1200 2400" '
        BEGIN { count = split(wanted, at, " "); next_one = 1 }
        NR == 1 { next }
        NR > 2 { time += $3 }
        { while (next_one <= count && time >= at[next_one]) { printf "%d %.0f\n", $1, time; next_one++ } }' "$1"
}

pictures=()
for threads in 1 32; do
    "$root/bench/remote/run.sh" --bin "$build" --serve 50 picture.store -- \
        "$build/samples/streaming/streaming" --images %u --cache cache --frames 120 --rest-frames 120 --fps 30 \
        --size 352x198 --samples 1 --fade 0 --write-frames all --threads "$threads" --output "threads-$threads" |
        grep -E '^(tiles_mapped|bytes_read|frame_ms_median) '
    awk -F, -v threads="$threads" 'NR > 2 { time += $3 } $12 > 0 { last = time }
        END { printf "%d threads: the last tile came after %.0f ms\n", threads, last }' "threads-$threads/frames.csv"
    while read -r frame milliseconds; do
        picture="threads-$threads/$threads-threads-$milliseconds-ms.png"
        cp "$(printf 'threads-%d/frame-%04d.png' "$threads" "$frame")" "$picture"
        pictures+=("$picture")
    done < <(choose "threads-$threads/frames.csv")
done
"$build/samples/contact-sheet" -o sheet.png --columns 6 --cell 208x117 "${pictures[@]}"
"$root/scripts/dev/palette_png.py" sheet.png "$root/docs/images/remote-threads.png"
