#!/bin/sh
# test_flight.sh DEMAND_PBRT FILM_SET FOLDER
#
# Flies through a small scene of many instances. Whatever came when, the picture at the end is that
# of a fresh start, bit for bit; so it is with one reading thread and with several, with all
# shapes built first, and with structures that are not compacted. Exit status 77: no device traces rays.
set -eu
program=$1 maker=$2 folder=$3
failed=0

complain() {
    echo "$*" >&2
    failed=1
}

rm -rf "$folder"
mkdir -p "$folder"
"$maker" --instances 2000 --meshes 40 --triangles 100 --texture-size 512 "$folder/set" >/dev/null
"$maker" --instances 2000 --meshes 40 --triangles 100 --texture-size 512 "$folder/again" >/dev/null
diff -r "$folder/set" "$folder/again" >/dev/null || complain "the same options give other bytes"
rm -rf "$folder/again"

render() { # name, options
    name=$1
    shift
    status=0
    "$program" "$folder/set/scene.pbrt" --dim 96x54 --json --file "$folder/$name.pfm" "$@" \
        >"$folder/$name.json" 2>"$folder/$name.log" || status=$?
    [ "$status" -ne 77 ] || { cat "$folder/$name.log" >&2; exit 77; }
    [ "$status" -eq 0 ] || { complain "$name: status $status"; cat "$folder/$name.log" >&2; }
    cmp -s "$folder/$name.pfm" "$folder/fresh.pfm" || complain "$name: is not the picture of a fresh start"
}

value() { # figure
    sed -n "s/.*\"$1\", \"value\": \([^,]*\),.*/\1/p" "$folder/$name.json"
}

check() { # figure, condition on v
    awk -v v="$(value "$1")" 'BEGIN { v = v == "" ? "none" : v + 0; exit !(v != "none" && ('"$2"')) }' ||
        complain "$name: $1 is $(value "$1"), but must satisfy: $2"
}

# Tails of many pictures in blocks, copied by several commands.
validation=--validation
status=0
"$program" "$folder/set/scene.pbrt" --dim 96x54 --validation --file "$folder/silent.pfm" \
    >"$folder/silent.log" 2>&1 || status=$?
[ "$status" -eq 0 ] || {
    validation=
    grep -q VK_ERROR_LAYER_NOT_PRESENT "$folder/silent.log" || [ "$status" -eq 77 ] || {
        complain "validation is not silent"
        head -n 5 "$folder/silent.log" >&2
    }
}
render fresh --threads 1
check geometries_built 'v <= 41'
check bytes_per_box 'v > 0 && v <= 88'
check bytes_per_unresolved 'v > 0'
check boxes_added_most 'v > 256 && v <= 1024'
compacted=$(value geometry_bytes)
render uncompacted --uncompacted
check geometry_bytes "v >= $compacted"
render shapes --preload-shapes
check shapes_entered 'v == 2001'
render unbounded --fly 20 --threads 4 $validation
check frames 'v == 20'
check frame_boxes_resolved_most 'v > 20'
# Clusters of clusters: no item of a frame adds more than four times the size of a cluster.
render clusters --fly 20 --cluster-size 64
check boxes_added_most 'v > 8 && v <= 256'
render flat --cluster-size 4096
check boxes_added_most 'v == 2001'
# From another camera to that of the picture.
render path --fly 8 --fly-from 0/-300/60/0/0/0/0/0/1
check frames 'v == 8'
check frame_work_longest 'v > 0'
check frame_launch_mean 'v > 0'

# The picture of several devices is that of one. One device may be listed several times.
meshes_of_one=$(name=fresh && value meshes_read)
render two --devices 0,0 $validation
render three --devices 0,0,0 --cluster-size 64 $validation
check devices 'v == 3'
check meshes_read "v <= 41 && v >= $meshes_of_one" # each file once, however many devices build it
check meshes_shared 'v > 0'
for i in 0 1 2; do
    check "device_${i}_launches" 'v > 3'
    check "device_${i}_tiles_loaded" 'v > 0'
    check "device_${i}_peak_device_bytes" 'v > 0'
done
reads=$(value pool_reads)
others=$(($(value pool_joined) + $(value pool_from_cache)))
render reader --devices 0, --read-pool on
check pool_reads "v == $reads"
[ "$others" -gt 0 ] || complain "three: no device took a tile that another had read"
render each --devices 0,0,0 --read-pool off
render walls --devices 0,0,0 --budget 64K # evicted meshes are read again
check geometries_evicted 'v > 0'

# So are the pictures of an animation, whether devices share each picture or take pictures in turn. They are
# those of --fly-at.
animate() { # name, options
    name=$1
    shift
    "$program" "$folder/set/scene.pbrt" --dim 96x54 --json --animation 4 --file "$folder/$name.pfm" "$@" \
        >"$folder/$name.json" 2>"$folder/$name.log" || { complain "$name: status $?"; cat "$folder/$name.log" >&2; }
}
animate one
check pixels_missing 'v == 0'
animate shared --devices 0,0,0 $validation
animate taken --devices 0,0,0 --split alternate $validation
check pixels_missing 'v == 0'
pictures=0
for i in 0 1 2; do
    pictures=$((pictures + $(value "device_${i}_pictures")))
done
[ "$pictures" -eq 4 ] || complain "taken: $pictures pictures were traced"
for i in 1 2 3 4; do
    cmp "$folder/shared-000$i.pfm" "$folder/one-000$i.pfm" || complain "shared: picture $i"
    cmp "$folder/taken-000$i.pfm" "$folder/one-000$i.pfm" || complain "taken: picture $i"
done
animate part --pictures 2-3 --devices 0,0 --split alternate
for i in 2 3; do
    cmp "$folder/part-000$i.pfm" "$folder/one-000$i.pfm" || complain "part: picture $i"
done
[ "$(find "$folder" -name 'part-*.pfm' | wc -l)" -eq 2 ] || complain "part: other pictures were rendered"
cmp "$folder/one-0004.pfm" "$folder/fresh.pfm" || complain "the last picture is not that without an animation"
cmp -s "$folder/one-0002.pfm" "$folder/fresh.pfm" && complain "the camera does not move"
"$program" "$folder/set/scene.pbrt" --dim 96x54 --file "$folder/half.pfm" --fly-at 0.5 >/dev/null 2>&1 || complain "half"
cmp "$folder/half.pfm" "$folder/one-0002.pfm" || complain "half of the way is not picture 2 of 4"

# Less time than a launch takes: one box in a frame.
render bounded --fly 20 --frame-budget 0.01
check frames 'v == 20'
check frame_boxes_resolved_most 'v == 1'
for options in "--frame-budget 16" "--preload --preload-shapes" "--preload-shapes --budget 1M" "--fly-from 0/0/0/1/0/0" \
    "--devices 0,0 --fly 4" "--devices 0,0 --device 0" "--split alternate" "--animation 2 --fly-at 1/2" \
    "--pictures 1-1" "--animation 2 --pictures 0-1" "--animation 2 --pictures 2-3" "--animation 2 --pictures 2-1" \
    "--look-from 0/0/0" "--look-from 1/2/3/1/2/3" "--look-from 0/0/0/0/0/2/0/0/1" "--look-from 0/0/0/1/0/nan" "--cluster-size 1"; do
    status=0
    # shellcheck disable=SC2086
    "$program" "$folder/set/scene.pbrt" --file "$folder/no.png" $options >/dev/null 2>&1 || status=$?
    [ "$status" -eq 2 ] || complain "not refused: $options"
done
exit $failed
