#!/bin/sh
# test_gallery.sh STREAMING REPLAY FOLDER [short]
#
# Walks through a small gallery and checks what the walk must show: it ends with the picture that
# everything resident gives, nothing that is not there is read, the validation layers are silent, and
# the recording replays to the same decisions. `short` leaves out walks that compare figures of walks.
# Exit status 77: no device has sparse residency.
set -eu
streaming=$1 replay=$2 folder=$3 length=${4:-whole}

rm -rf "$folder"
mkdir -p "$folder"

walk() { # name, options
    name=$1
    shift
    status=0
    "$streaming" --cache "$folder/cache" --generate-scale 8 --size 256x144 --json \
        --output "$folder/$name" --record "$folder/$name.trace" "$@" \
        >"$folder/$name.json" 2>"$folder/$name.log" || status=$?
}

# The value of a figure must satisfy an awk condition on v.
check() { # name, figure, condition
    awk -F'"value": ' -v figure="\"name\": \"$2\"" '
        index($0, figure) { found = 1; sub(/,.*/, "", $2); v = $2; good = v != "null" && ('"$3"') }
        END { exit !(found && good) }' "$folder/$1.json" || {
        echo "$1: $2 must satisfy: $3" >&2
        grep "$2" "$folder/$1.json" >&2 || true
        failed=1
    }
}

# Two figures, of a walk each, must satisfy an awk condition on a and b.
figure() { # name, figure
    sed -n "s/^{\"name\": \"$2\", \"value\": \([^,]*\),.*/\1/p" "$folder/$1.json"
}
compare() { # name, figure a, name, figure b, condition
    awk -v a="$(figure "$1" "$2")" -v b="$(figure "$3" "$4")" \
        'BEGIN { exit !(a != "" && b != "" && a != "null" && b != "null" && ('"$5"')) }' || {
        echo "$1: $2 and $3: $4 must satisfy: $5" >&2
        failed=1
    }
}

failed=0

# What cannot be meant is refused before anything is done.
refuse() {
    status=0
    "$streaming" --output "$folder/refused" "$@" >/dev/null 2>&1 || status=$?
    [ "$status" -eq 2 ] || { echo "not refused: $*" >&2; failed=1; }
}
refuse --images="$folder"
refuse --images "$folder" --images "$folder"
refuse --samples 3
refuse --tiles-per-frame 16385
refuse --needs off --needs-trace "$folder/refused"
refuse --reference "$folder/truth" --compare
refuse --reference-samples 3
refuse --reference-supersample 3
[ ! -e "$folder/refused" ] && [ ! -e "$folder/truth" ] || failed=1

walk compared --frames 60 --rest-frames 30 --compare --validation
if [ "$status" -ne 0 ] && grep -q VK_ERROR_LAYER_NOT_PRESENT "$folder/compared.log"; then
    echo "there are no validation layers: walking without them" >&2
    walk compared --frames 60 --rest-frames 30 --compare
fi
[ "$status" -ne 77 ] || { cat "$folder/compared.log" >&2; exit 77; }
[ "$status" -eq 0 ] || { cat "$folder/compared.log" >&2; exit 1; }
check compared psnr_final_db 'v >= 60'
check compared frames_to_60db 'v <= 30'
check compared tiles_mapped 'v > 0'
check compared tiles_failed 'v == 0'
if ! grep -q '"nonresident_reads", "value": null' "$folder/compared.json"; then
    check compared nonresident_reads 'v == 0'
    check compared checked_pixels 'v > 100000'
fi
grep -q '</svg>' "$folder/compared/report.html" || { echo "the report has no plots" >&2; failed=1; }
"$replay" "$folder/compared.trace" >/dev/null || failed=1

# Only what the walk required: what it needed is found out where the picture is compared.
check compared textures 'v == 16'
check compared textures_never_sampled 'v == 0'
check compared textures_never_read 'v == 0'
check compared loaded_per_needed 'v > 0.5 && v <= 1.15'
check compared frames_until_sharp_p50 'v >= 0'
compare compared needed_bytes compared virtual_bytes 'a > 0 && a <= b'
compare compared needed_bytes_peak compared needed_bytes 'a > 0 && a <= b'
compare compared resident_bytes_peak compared loaded_bytes 'a <= b'
compare compared details_unmet compared details_needed 'a <= b'
compare compared frames_until_sharp_p50 compared frames_until_sharp_p99 'a <= b'

# In paged residency and against another mode the same picture, but for the last bit of the filters.
walk paged --residency paged --frames 60 --rest-frames 30 --predict 0.1 --compare --validation
if [ "$status" -ne 0 ] && grep -q VK_ERROR_LAYER_NOT_PRESENT "$folder/paged.log"; then
    walk paged --residency paged --frames 60 --rest-frames 30 --predict 0.1 --compare
fi
if [ "$status" -ne 77 ]; then
    [ "$status" -eq 0 ] || { cat "$folder/paged.log" >&2; failed=1; }
    check paged psnr_final_db 'v >= 45'
    check paged tiles_failed 'v == 0'
    check paged bind_calls 'v == 0'
    check paged nonresident_reads 'v == 0'
    check paged checked_pixels 'v > 100000'
fi
# Where sparse mode bears only some pictures, these are shown and the others left out, with advice.
walk crowded --residency sparse --touched-tiles 120 --frames 2 --rest-frames 0
if [ "$status" -ne 77 ]; then
    [ "$status" -eq 0 ] || { cat "$folder/crowded.log" >&2; failed=1; }
    grep -q 'pictures are left out: .*--residency paged' "$folder/crowded.log" || {
        cat "$folder/crowded.log" >&2
        failed=1
    }
fi
walk dense --residency dense --frames 40 --rest-frames 30 --compare
[ "$status" -eq 0 ] || { cat "$folder/dense.log" >&2; failed=1; }
check dense psnr_final_db 'v >= 60'
walk sparse --residency sparse --frames 40 --rest-frames 30 --compare --compare-with dense
if [ "$status" -ne 77 ]; then
    [ "$status" -eq 0 ] || { cat "$folder/sparse.log" >&2; failed=1; }
    check sparse psnr_final_db 'v >= 45'
fi

# The lattice, followers that write their own feedback, few tiles in memory, standby not allowed.
walk pressed --frames 40 --rest-frames 5 --lattice --texture-sets off --heap-tiles 16 --max-heaps 9 \
    --standby 0 --timeout 0.2 --samples 1 --format rgba8 --highlight --check-residency on
[ "$status" -eq 0 ] || { cat "$folder/pressed.log" >&2; failed=1; }
check pressed resident_tiles_peak 'v <= 144'
check pressed tiles_unmapped 'v > 0'
if ! grep -q '"nonresident_reads", "value": null' "$folder/pressed.json"; then
    check pressed nonresident_reads 'v == 0'
fi
"$replay" "$folder/pressed.trace" >/dev/null || failed=1

# With a sanitizer: the other walks run the same code, and compare figures that it does not change.
[ "$length" != short ] || exit "$failed"

# The same walk twice is the same, decision by decision and pixel by pixel.
for name in first second; do
    walk $name --frames 24 --rest-frames 6 --deterministic --threads 1 --write-frames all
    [ "$status" -eq 0 ] || { cat "$folder/$name.log" >&2; failed=1; }
done
cmp "$folder/first.trace" "$folder/second.trace" >&2 || failed=1
for picture in "$folder"/first/*.png; do
    cmp "$picture" "$folder/second/${picture##*/}" >&2 || failed=1
done

# Who looks ahead misses less on the way, for few tiles more, and comes to rest before the same picture.
walk unforeseen --frames 110 --rest-frames 10 --fps 30 --deterministic --samples 1 --write-frames none \
    --warm-up 7 --needs on
[ "$status" -eq 0 ] || { cat "$folder/unforeseen.log" >&2; failed=1; }
walk foreseen --frames 110 --rest-frames 10 --fps 30 --deterministic --samples 1 --write-frames none \
    --warm-up 7 --predict 0.2 --compare
[ "$status" -eq 0 ] || { cat "$folder/foreseen.log" >&2; failed=1; }
awk -F, 'NR == 2 { exit !($7 > 0 && $12 < 0.5 * $7) }' "$folder/unforeseen/frames.csv" || {
    echo "unforeseen: the first frame loaded what the ones before the walk did" >&2
    failed=1
}
compare unforeseen needed_bytes foreseen needed_bytes 'a == b'
compare unforeseen missing_pixels_percent foreseen missing_pixels_percent 'b < 0.5 * a'
compare unforeseen details_unmet foreseen details_unmet 'b < 0.6 * a'
compare unforeseen frames_until_sharp_p99 foreseen frames_until_sharp_p99 'b <= a'
# What the frames before the walk have loaded is not the first frame's.
awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "tiles_mapped") column = i }
    NR == 2 { first = $column } NR > 1 { sum += $column }
    END { exit !(column && sum > 0 && first < 0.2 * sum) }' "$folder/foreseen/frames.csv" || failed=1
check foreseen loaded_per_needed 'v <= 1.3'
check foreseen psnr_final_db 'v >= 45'
"$replay" "$folder/foreseen.trace" >/dev/null || failed=1

# A camera that stands still is not ahead of itself: the same decisions as without a look ahead.
for name in here ahead; do
    seconds=0
    [ $name = here ] || seconds=0.3
    walk $name --frames 16 --rest-frames 16 --deterministic --threads 1 --samples 1 \
        --write-frames none --predict $seconds
    [ "$status" -eq 0 ] || { cat "$folder/$name.log" >&2; failed=1; }
done
cmp "$folder/here.trace" "$folder/ahead.trace" >&2 || failed=1

# Where every pixel writes feedback and each frame has all that was asked for before, a camera that
# stands still loads what a manager asks for that is given the exact maps: no tile more, none less.
replayed() { # name: tiles that a manager maps that plays the walk's needs
    "$replay" "$folder/$1.needs" --json | sed -n 's/.*"mapped_total", "value": \([0-9]*\),.*/\1/p'
}
walk still --frames 24 --rest-frames 24 --deterministic --probability 1 --texture-sets off \
    --residency dense --needs-trace "$folder/still.needs"
[ "$status" -eq 0 ] || { cat "$folder/still.log" >&2; failed=1; }
check still loaded_bytes "v == 65536 * $(replayed still)"
check still needed_unloaded_bytes 'v == 0'
check still loaded_again_bytes 'v == 0'
check still textures_never_sampled 'v > 0' # so their packed levels are more than is needed
compare still loaded_unneeded_bytes still needed_bytes 'a > 0 && a < b'
[ "$(tail -n 1 "$folder/still/frames.csv" | cut -d, -f22)" = 0 ] || {
    echo "still: regions are missing in the end" >&2
    failed=1
}

# The same with a camera that moves past all pictures: what the trace needs is what was counted.
walk past --frames 60 --rest-frames 20 --deterministic --probability 1 --residency dense \
    --check-residency off --needs-trace "$folder/past.needs"
[ "$status" -eq 0 ] || { cat "$folder/past.log" >&2; failed=1; }
check past textures_never_sampled 'v == 0'
check past needed_bytes "v == 65536 * $(replayed past)"
check past loaded_per_needed 'v >= 0.98 && v <= 1.02'

# The pass that finds out needs sees the same pixels, and the same lack of detail, as the one that
# counts, and changes neither decisions nor pictures.
for needs in on off; do
    walk needs-$needs --frames 30 --rest-frames 8 --deterministic --threads 1 --needs $needs \
        --residency paged --check-residency "$([ $needs = on ] && echo off || echo on)" \
        --write-frames all
    [ "$status" -eq 0 ] || { cat "$folder/needs-$needs.log" >&2; failed=1; }
    cut -d, -f1,18,19 "$folder/needs-$needs/frames.csv" >"$folder/needs-$needs.pixels"
done
cmp "$folder/needs-on.pixels" "$folder/needs-off.pixels" >&2 || failed=1
cmp "$folder/needs-on.trace" "$folder/needs-off.trace" >&2 || failed=1
for picture in "$folder"/needs-on/*.png; do
    cmp "$picture" "$folder/needs-off/${picture##*/}" >&2 || failed=1
done
compare needs-on missing_pixels_percent needs-off missing_pixels_percent 'a > 0 && a == b'
grep -q '"needed_bytes", "value": null' "$folder/needs-off.json" || failed=1
grep -q 'Only what the scene requires' "$folder/needs-on/report.html" || failed=1

# The truth is drawn once, and again where it is not what the run asks for or damaged.
refer() { # name, options
    name=$1
    shift
    walk "$name" --reference "$folder/truth" --frames 12 --rest-frames 6 --deterministic --samples 1 \
        --probability 1 --threads 1 --metrics-every 11 "$@"
    [ "$status" -eq 0 ] || { cat "$folder/$name.log" >&2; failed=1; }
}
said() { # name, words
    grep -q -e "$2" "$folder/$1.log" || { echo "$1: not said: $2" >&2; failed=1; }
}
drawing='drawing the frames to compare with'
refer drawn
said drawn "$drawing"
cp "$folder/truth/reference.frames" "$folder/frames"
refer reused
! grep "$drawing" "$folder/reused.log" >&2 || failed=1
cut -d, -f1,6,21- "$folder/drawn/frames.csv" >"$folder/drawn.csv"
cut -d, -f1,6,21- "$folder/reused/frames.csv" | cmp - "$folder/drawn.csv" >&2 || failed=1
# When everything wanted is there nothing differs, and black is what the error is drawn as.
grep -q '^11,999.000,.*1.000000,0.000000$' "$folder/drawn.csv" || { cat "$folder/drawn.csv" >&2; failed=1; }
check reused psnr_lowest_db 'v < 50'
check reused ssim_lowest 'v < 0.99'
check reused flip_worst 'v > 0.01'
for picture in frame truth flip; do
    [ -s "$folder/reused/$picture-0011.png" ] || { echo "no picture: $picture" >&2; failed=1; }
done
grep -q 'FLIP' "$folder/reused/report.html" || { echo "the report has no FLIP" >&2; failed=1; }
[ -z "$(find "$folder/reused" -name 'frames-*')" ] || { echo "frames were left behind" >&2; failed=1; }

printf 'x' | dd of="$folder/truth/reference.frames" bs=1 seek=100000 conv=notrunc 2>/dev/null
refer damaged --write-frames none --fade 0.05
said damaged 'reference.frames: damaged'
said damaged "$drawing"
cmp "$folder/truth/reference.frames" "$folder/frames" >&2 || failed=1
refer other --write-frames none --metrics-every 0 --reference-anisotropy 4 --reference-supersample 2
said other 'have "supersample: 1", not "supersample: 2"'
said other "$drawing"
check other psnr_final_db 'v > 15 && v < 60'
! grep -q '"ssim_mean", "value": [0-9]' "$folder/other.json" || failed=1

# Sources behind a slow line: later, but all of it.
walk slow --frames 40 --rest-frames 30 --deterministic --samples 1 --probability 1 --fade 0.05 \
    --source-latency 20 --source-bandwidth 100 --loads-in-flight 128 --metrics-every 0 --compare
[ "$status" -eq 0 ] || { cat "$folder/slow.log" >&2; failed=1; }
check slow tiles_failed 'v == 0'
check slow psnr_final_db 'v >= 60'
check slow frames_to_60db 'v >= 1'

# Heaps of 64 GiB: where the device has no memory for the truth, that is said, and not waited for.
walk poor --frames 2 --rest-frames 1 --residency dense --compare --compare-with paged --heap-tiles 1048576
[ "$status" -eq 0 ] || said poor 'the device has no memory for more than'

exit $failed
