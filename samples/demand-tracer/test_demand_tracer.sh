#!/bin/sh
# test_demand_tracer.sh DEMAND_TRACER FOLDER
#
# Traces small pictures and checks what demand loading must show: they become complete, are what
# everything loaded before gives, along both paths, and nothing is opened that no ray hits. Exit
# status 77: no device can page.
set -eu
tracer=$1 folder=$2

rm -rf "$folder"
mkdir -p "$folder"
failed=0

# What cannot be meant is refused before anything is done.
refuse() {
    status=0
    "$tracer" --output "$folder/refused" "$@" >/dev/null 2>&1 || status=$?
    [ "$status" -eq 2 ] || { echo "not refused: $*" >&2; failed=1; }
}
refuse --no-such-option
refuse --size 96
refuse --size 8x8
refuse --path fastest
refuse --texture-count 4
refuse --bounces 9
refuse --budget 3
refuse --camera 1,2,3
refuse --camera 0,5,0,0,1,0
refuse --camera nan,0,0,1,1,1
refuse --preview --preload
refuse --needs perhaps
refuse --devices 0
refuse --devices two
refuse --devices 0,x
refuse --devices 99
refuse --devices 0,0 --device 0
refuse --split alternate
refuse --split rows
refuse --read-pool perhaps
refuse --devices 0,0 --contact-sheet "$folder/refused/sheet.png"
refuse --animation 2 --reference "$folder/refused.png"
[ ! -e "$folder/refused" ] || { echo "something was written" >&2; failed=1; }
"$tracer" --help | grep -q -- '--contact-sheet FILE' || { echo "no help" >&2; failed=1; }

trace() { # name, options
    name=$1
    shift
    status=0
    "$tracer" --size 96x54 --samples 2 --texture-count 30 --texture-size 512 --json \
        --output "$folder/$name" "$@" >"$folder/$name.json" 2>"$folder/$name.log" || status=$?
}

succeeds() {
    [ "$status" -eq 0 ] || { echo "$name: status $status" >&2; cat "$folder/$name.log" >&2; failed=1; }
}

value() { # name, figure
    sed -n "s/.*\"$2\", \"value\": \([^,]*\),.*/\1/p" "$folder/$1.json"
}

# The value of a figure must satisfy an awk condition on v.
check() { # name, figure, condition
    awk -v v="$(value "$1" "$2")" 'BEGIN { exit !(v != "" && v != "null" && ('"$3"')) }' || {
        echo "$1: $2 is $(value "$1" "$2"), but must satisfy: $3" >&2
        failed=1
    }
}

is_complete() { # name
    check "$1" pixels_missing 'v + 0 == 0'
    check "$1" samples_complete 'v + 0 == 2'
}

# How near a picture comes to the first one. What is equal is infinitely near.
is_like_first() { # name, dB
    check "$1" psnr "v + 0 >= $2"
}

validation=--validation
trace first $validation --launch-pictures "$folder/frames" --contact-sheet "$folder/sheet.png"
if [ "$status" -ne 0 ] && grep -q VK_ERROR_LAYER_NOT_PRESENT "$folder/first.log"; then
    echo "there are no validation layers: tracing without them" >&2
    validation=
    trace first --launch-pictures "$folder/frames" --contact-sheet "$folder/sheet.png"
fi
[ "$status" -ne 77 ] || { cat "$folder/first.log" >&2; exit 77; }
succeeds
is_complete first
check first launches 'v + 0 > 3'
check first paths_traced 'v + 0 > 96 * 54 * 2'
check first pages_served 'v + 0 > 10'
check first reads_failed 'v + 0 == 0'
check first textures 'v + 0 == 30'
check first textures_opened 'v + 0 > 5 && v + 0 <= 30'
check first textures_failed 'v + 0 == 0'
check first virtual_bytes 'v + 0 == 30 * 1398100'
check first textures_never_opened "v + 0 == 30 - $(value first textures_opened)"
check first needed_bytes 'v + 0 > 10 * 65536 && v % 65536 == 0'
check first loaded_bytes "v + 0 == $(value first resident_bytes)" # nothing was evicted
check first resident_bytes_peak "v + 0 == $(value first resident_bytes)"
check first loaded_per_needed 'v + 0 >= 1 && v + 0 <= 1.15'
for file in "$folder/first/picture.png" "$folder/first/picture.exr" "$folder/first/frames.csv" "$folder/sheet.png" \
    "$folder/frames/launch-00001.png" "$folder/frames/launch-00003.exr"; do
    [ -s "$file" ] || { echo "$file was not written" >&2; failed=1; }
done

# Each launch has a row, and the last one misses nothing.
awk -F, -v launches="$(value first launches)" -v bytes="$(value first loaded_bytes)" '
    NR > 1 && $1 == NR - 1 { rows++; missing = $4; loaded = $7 }
    END { exit !(rows == launches && NR == rows + 1 && missing == 0 && loaded * 65536 == bytes) }
' "$folder/first/frames.csv" || { echo "frames.csv is not what was done" >&2; failed=1; }

# Nothing is missing where all was loaded before, and the picture is the same. It needs the same, as
# its paths never go astray.
trace preloaded $validation --preload --reference "$folder/first/picture.png"
succeeds
is_complete preloaded
check preloaded launches 'v + 0 == 2'
check preloaded textures_opened 'v + 0 == 30'
check preloaded textures_never_opened 'v + 0 == 0'
check preloaded needed_bytes "v + 0 == $(value first needed_bytes)"
check preloaded loaded_per_needed 'v + 0 > 2'
is_like_first preloaded 60
check preloaded ssim_mean 'v + 0 > 0.9999 && v + 0 <= 1'
check preloaded flip_mean 'v + 0 >= 0 && v + 0 < 0.0001'
for kind in frame truth flip; do # two launches
    [ -s "$folder/preloaded/$kind-0002.png" ] || { echo "$kind-0002.png was not written" >&2; failed=1; }
done

# The same scene without a ray-tracing pipeline; edges may fall to the other side of a pixel.
trace compute $validation --path compute --reference "$folder/first/picture.png"
succeeds
is_complete compute
check compute ray_tracing_pipeline 'v + 0 == 0'
check compute textures_opened "v + 0 == $(value first textures_opened)"
check compute needed_bytes "v >= 0.97 * $(value first needed_bytes) && v <= 1.03 * $(value first needed_bytes)"
check compute loaded_per_needed 'v + 0 >= 1 && v + 0 <= 1.15'
is_like_first compute 40
check compute ssim_mean 'v + 0 > 0.98 && v + 0 <= 1'
check compute flip_mean 'v + 0 >= 0 && v + 0 < 0.02'

# A preview shows coarse levels from the second launch on, and ends as sharp.
trace preview $validation --preview --launch-pictures "$folder/preview-frames" \
    --reference "$folder/first/picture.png"
succeeds
is_complete preview
check preview needed_bytes "v + 0 == $(value first needed_bytes)"
check preview loaded_per_needed 'v + 0 >= 1 && v + 0 <= 1.15'
is_like_first preview 60

# A few tiles at a time.
trace slow --requests 16 --threads 1 --reference "$folder/first/picture.png"
succeeds
is_complete slow
check slow launches "v + 0 > $(value first launches)"
check slow needed_bytes "v + 0 == $(value first needed_bytes)"
is_like_first slow 60

# The picture of several devices is that of one, byte for byte. One device may be listed several times.
same() { # name, picture, another picture
    if ! cmp "$folder/$1/$2.exr" "$folder/$3.exr" || ! cmp "$folder/$1/$2.png" "$folder/$3.png"; then
        echo "$1: $2 is not $3" >&2
        failed=1
    fi
}
trace two $validation --devices 0,0
succeeds
is_complete two
same two picture first/picture
trace three $validation --devices 0,0,0 --seed 1
succeeds
is_complete three
same three picture first/picture
check three devices 'v + 0 == 3'
check three textures "v + 0 == $(value first textures)"
check three needed_bytes "v + 0 >= $(value first needed_bytes)" # sums: each device needs its own
check three loaded_per_needed 'v + 0 >= 1 && v + 0 <= 1.15'
for i in 0 1 2; do
    check three "device_${i}_launches" 'v + 0 >= 3'
    check three "device_${i}_tiles_loaded" "v + 0 > 0 && v + 0 < $(value three loaded_bytes) / 65536"
    check three "device_${i}_device_memory" 'v + 0 > 0'
done

# Whoever asks for a tile first reads it for all. One device reads as much as three.
trace reader --devices 0, --read-pool on
succeeds
same reader picture first/picture
check three pool_reads "v + 0 == $(value reader pool_reads)"
check three pool_bytes_read "v + 0 == $(value reader pool_bytes_read) && v + 0 == $(value first bytes_read)"
trace all $validation --preload --devices 0,0,0
succeeds
check all pool_bytes_read "v + 0 == $(value all bytes_read) / 3 && v > 3 * $(value three pool_bytes_read)"
awk -v read="$(value all pool_reads)" -v joined="$(value all pool_joined)" -v kept="$(value all pool_from_cache)" \
    'BEGIN { exit !(joined + kept == 2 * read) }' || { echo "three devices read a tile twice" >&2; failed=1; }
trace each --devices 0,0,0 --read-pool off
succeeds
same each picture first/picture
check each bytes_read "v + 0 > 1.5 * $(value first bytes_read)"
[ -z "$(value each pool_reads)" ] || { echo "there is a pool although off" >&2; failed=1; }

trace counted --devices 1 # a count
succeeds
same counted picture first/picture
trace absent --devices 63
[ "$status" -eq 77 ] || { echo "63 devices are there: status $status" >&2; failed=1; }
trace missing --devices 0,4000
[ "$status" -eq 77 ] || { echo "device 4000 is there: status $status" >&2; failed=1; }
grep -q '^there is no device 4000; --list-devices lists ' "$folder/missing.log" || { echo "device 4000 is not named" >&2; failed=1; }

# So are the pictures of an animation, whether devices share each picture or take pictures in turn. The last
# one is the picture without an animation, and no other is.
trace turned --animation 4
succeeds
trace shared $validation --animation 4 --devices 0,0,0
succeeds
trace taken $validation --animation 4 --devices 0,0,0 --split alternate
succeeds
trace idle --animation 1 --devices 0,0 --split alternate # one of them has nothing to do
succeeds
same idle picture-0001 first/picture
for picture in picture-0001 picture-0002 picture-0003 picture-0004; do
    same shared "$picture" "turned/$picture"
    same taken "$picture" "turned/$picture"
done
same turned picture-0004 first/picture
cmp -s "$folder/turned/picture-0003.png" "$folder/first/picture.png" && { echo "the camera does not turn" >&2; failed=1; }
check taken pixels_missing 'v + 0 == 0'
[ "$(for i in 0 1 2; do value taken "device_${i}_pictures"; done | awk '{ sum += $1 } END { print sum }')" -eq 4 ] ||
    { echo "a picture was traced twice, or by none" >&2; failed=1; }

# Less memory than the picture needs: complete all the same.
trace pressed --budget 4 --texture-size 4096 --texture-count 60 --anisotropy 1
succeeds
is_complete pressed
check pressed tile_memory 'v + 0 <= 4 * 1024 * 1024'
check pressed resident_bytes_peak 'v + 0 <= 4 * 1024 * 1024'
check pressed loaded_per_needed 'v + 0 > 0'

# What no ray hits is not opened: what is behind the camera, and everything below the sky.
trace away --needs off --camera 0,1.5,-2,0,0.5,-9 --bounces 0
succeeds
is_complete away
check away textures_opened 'v + 0 > 0 && v + 0 < 20'
[ "$(value away needed_bytes)" = null ] || { echo "needs were counted although off" >&2; failed=1; }
trace sky --camera 0,3,0,1,9,0 --reference "$folder/first/picture.png"
succeeds
is_complete sky
check sky launches 'v + 0 == 2'
check sky requests 'v + 0 == 0'
check sky needed_bytes 'v + 0 == 0'
check sky loaded_bytes 'v + 0 == 0'
check sky textures_never_opened 'v + 0 == 30'
check sky ssim_mean 'v + 0 < 0.9' # another picture
check sky flip_mean 'v + 0 > 0.1 && v + 0 < 1'
check sky textures_opened 'v + 0 == 0'

# Pictures from files, among them one that is none.
mkdir "$folder/files"
cp "$folder/first/picture.exr" "$folder/files/a.exr"
echo "no picture" >"$folder/files/b.exr"
trace files --textures "$folder/files"
succeeds
is_complete files
check files textures 'v + 0 == 8' # two files, six of leaves
check files textures_failed 'v + 0 == 1'
grep -q 'b.exr' "$folder/files.log" || { echo "nobody said that b.exr is none" >&2; failed=1; }
trace nothing --textures "$folder/frames/launch-00001.png.store"
[ "$status" -eq 1 ] || { echo "no texture is no error" >&2; failed=1; }

# A header alone that promises 16384 x 16384 texels in scanlines: refused before anything is decoded, and once.
mkdir "$folder/bomb"
bomb=$folder/bomb/bomb.exr
cat "$(dirname "$0")/../../tests/exr/data/scan_zip.exr" >"$bomb"
at=$(LC_ALL=C grep -abo dataWindow "$bomb" | head -n 1 | cut -d: -f1)
printf '\0\0\0\0\0\0\0\0\377\77\0\0\377\77\0\0' | dd of="$bomb" bs=1 seek=$((at + 21)) conv=notrunc 2>"$folder/dd.log"
dd if=/dev/null of="$bomb" bs=1 seek=2097152 2>"$folder/dd.log"
trace bomb --textures "$folder/bomb"
succeeds
is_complete bomb
check bomb textures_failed 'v + 0 == 1'
if ! grep -q 'bomb.exr: .*2738 MiB.*sluice-bake FILE -o DIR' "$folder/bomb.log" ||
    ! grep -q 'bomb.exr: --memory raises' "$folder/bomb.log" || [ "$(grep -c '2738 MiB' "$folder/bomb.log")" -ne 1 ]; then
    echo "nobody said once what bomb.exr takes" >&2
    failed=1
fi

# Who stops too early says so.
trace short --launches 1
[ "$status" -eq 1 ] || { echo "an incomplete picture is no error" >&2; failed=1; }
check short pixels_missing 'v + 0 > 0'

exit $failed
