#!/usr/bin/env bash
# Installs what is missing, builds Sluice and streams the gallery: a room hung with large pictures,
# of which only the tiles that are seen are kept in memory.
#
#   scripts/demo.sh [options] [-- options of samples/streaming; -- --help lists them]
#
#   scripts/demo.sh -- --generate-scale 4      smaller pictures, sooner
#   scripts/demo.sh -- --images FOLDER --budget 64
#                                              a museum of your own pictures in 64 MiB: photographs,
#                                              OpenEXR, DDS, KTX2 files and tile stores
#   scripts/demo.sh -- --pbrt FILE             a scene of pbrt instead, with geometry, materials and textures
#                                              on demand; further options are those of samples/demand-pbrt
#   scripts/demo.sh -- --neural [FILE.ntc]     a neural set instead, streamed in five ways; without a file a
#                                              small material is made and compressed, minutes on a CPU
#
# Each frame is drawn a second time with everything resident, to compare, unless there is a --budget.
# Then the gallery, smaller, is walked through with other settings, one at a time, to show what each
# costs in memory, time and picture: some two minutes, and a page to read.
#
#   --output DIR   where pictures and report go      (default: build/demo-out)
#   --cache DIR    where generated images and baked pictures are kept (default: build/demo-cache)
#   --no-tradeoff  end with the gallery; measure no other settings
#   --no-install   install nothing; say what is missing
#   --help
#
# Runs on a fresh Debian 12, Debian 13 or Ubuntu 24.04, as root or with sudo (root is needed only if
# something is missing), and asks nothing. Without a GPU it runs on the CPU, on Mesa's lavapipe.
#
# Environment: SLUICE_BUILD      folder for everything that is built (default: build)
#              VK_DRIVER_FILES   the Vulkan drivers to look at, as the Vulkan loader takes it

set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
for part in common packages mesa build; do
    # shellcheck source=/dev/null
    . "$here/lib/$part.sh"
done

install=yes tradeoff=yes output=$SLUICE_BUILD/demo-out cache=$SLUICE_BUILD/demo-cache
while [ $# -gt 0 ]; do
    case $1 in
    --output) output=${2:?--output needs a folder}; shift ;;
    --cache) cache=${2:?--cache needs a folder}; shift ;;
    --no-tradeoff) tradeoff=no ;;
    --no-install) install=no ;;
    --help) usage_of "$0"; exit 0 ;;
    --) shift; break ;;
    *) die "unknown option $1 (see --help); options of the gallery stand after --" ;;
    esac
    shift
done
trap give_back_build EXIT

ensure_packages build "$install"

title "Building"
folder=$SLUICE_BUILD/demo
configure "$folder" --wrap-mode="$(wrap_mode build)" --buildtype=release -Dtests=false \
    -Dexr=enabled -Dvulkan=enabled -Dsamples=enabled || die "configuring failed"
compile "$folder" || die "the build failed"

forget_display
if has_gpu; then
    say "A GPU was found; add '-- --device cpu' to run on lavapipe all the same."
else
    select_lavapipe
    say "No GPU was found: running on the CPU (lavapipe)."
fi

# A scene of pbrt takes the place of the gallery.
if [ "${1-}" = --pbrt ]; then
    scene=${2:?--pbrt needs a scene}
    shift 2
    title "Rendering $scene"
    mkdir -p "$output" "$cache"
    "$folder/samples/demand-pbrt/demand-pbrt" "$scene" --file "$output/pbrt.png" --cache "$cache/pbrt" \
        --contact-sheet "$output/pbrt-launches.png" "$@" || die "the scene was not rendered completely"
    title "Done"
    say "The picture: $output/pbrt.png"
    say "What was there after each launch: $output/pbrt-launches.png"
    exit
fi

# A neural set hangs in the gallery, in all ways in which it can be streamed.
if [ "${1-}" = --neural ]; then
    shift
    set=$cache/neural/mosaic.ntc streaming=$folder/samples/streaming/streaming
    mkdir -p "$output" "$cache/neural"
    if [ $# -gt 0 ] && [ "${1#--}" = "$1" ]; then
        set=$1
        shift
    elif [ ! -e "$set" ]; then
        title "Compressing a material of three textures"
        training=(--steps 400 --batch 4096 --device cpu)
        ! has_gpu || training=()
        "$streaming" --neural-material "$cache/neural" || die "the material could not be written"
        "$folder/tools/sluice-bake/sluice-bake" --neural "$cache"/neural/{albedo,height,roughness}.png -o "$set" \
            --checkpoint "$set.checkpoint" --progress "${training[@]}" || die "the material was not compressed"
    fi
    title "Hanging $set in five ways"
    walk=()
    for option in generate-scale=4 frames=120 rest-frames=30; do
        [[ " $* " == *" --${option%=*} "* ]] || walk+=("--${option%=*}" "${option#*=}")
    done
    "$streaming" --neural-set "$set" --neural-as raw bc7 load feedback sample "${walk[@]}" --output "$output" \
        --cache "$cache" --json "$@" >"$output/summary.txt" || die "the demo did not end well"
    title "Comparing the five ways"
    mkdir -p "$output/neural"
    "$folder/tools/sluice-tradeoff/sluice-tradeoff" neural --quick --repeats 1 --results "$output/neural" -- \
        --neural-set "$set" --cache "$cache" "$@" | tee "$output/neural/table.txt" || die "the measurements did not end well"
    title "Done"
    say "All five in one room: $output/frame-*.png, $output/report.html"
    say "Their pictures side by side, and what each costs: $output/neural/page.html"
    exit
fi

# What shows no gallery needs no folders and leaves no report. Memory that is to be short cannot hold
# everything.
comparing=(--compare)
for option in "$@"; do
    case $option in
    --budget) comparing=() ;;
    --help | -h | --list-devices)
        "$folder/samples/streaming/streaming" "$option"
        exit
        ;;
    esac
done

title "Streaming the gallery"
mkdir -p "$output" "$cache"
# Pictures of an earlier run, which may have had other frames.
[ ! -e "$output/report.html" ] || rm -f "$output"/{frame,truth,flip}-[0-9][0-9][0-9][0-9].png
"$folder/samples/streaming/streaming" --output "$output" --cache "$cache" "${comparing[@]}" --json "$@" \
    >"$output/summary.txt" || die "the demo did not end well"

figure() { sed -n "s/.*\"name\": \"$1\", \"value\": \([0-9]*\).*/\1/p" "$output/summary.txt"; }
megabytes() { awk -v bytes="$(figure "$1")" 'BEGIN { printf "%.0f MB", bytes / 1e6 }'; }

# The same pictures on the same device; what else was asked of the gallery is no base to compare with.
pictures=()
while [ $# -gt 0 ]; do
    case $1 in
    --images | --device | --format)
        pictures+=("$1")
        while [ $# -gt 1 ] && [ "${2#--}" = "$2" ]; do
            pictures+=("$2")
            shift
        done
        ;;
    esac
    shift
done
if [ "$tradeoff" = yes ]; then
    title "Measuring what settings cost"
    mkdir -p "$output/tradeoff"
    "$folder/tools/sluice-tradeoff/sluice-tradeoff" gallery --quick --results "$output/tradeoff" -- \
        --cache "$cache" "${pictures[@]}" | tee "$output/tradeoff/table.txt" || die "the measurements did not end well"
fi

title "Done"
say "$(figure pictures) pictures hang; their textures are $(megabytes virtual_bytes). In memory were \
$(megabytes resident_bytes) at the end, $(megabytes resident_bytes_peak) at most, in heaps of \
$(megabytes device_memory_peak)."
say "The report, with pictures and figures: $output/report.html"
say "Pictures: $output/frame-*.png"
[ ${#comparing[@]} -eq 0 ] || say "The same with everything resident, and the visible difference: truth-*.png, flip-*.png there. \
To flip between both, open frame-N.png and truth-N.png in two tabs of a browser."
say "Figures: $output/frames.csv (by frame), $output/summary.txt"
[ "$tradeoff" = no ] || say "What settings cost, with plots and pictures: $output/tradeoff/page.html"
say "Next: your own pictures by '-- --images FOLDER --budget 64'; all that can be set by '-- --help'."
