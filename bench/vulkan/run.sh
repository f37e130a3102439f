#!/usr/bin/env bash
# Measures what streaming costs on a Vulkan device and prints a table per residency mode: the figure,
# and the ceiling or floor that was set for it on an H200.
#
#   bench/vulkan/run.sh [options]
#
#   --device NAME     an index or a part of a name; --list-devices prints them (default: the best)
#   --residency MODE  sparse, paged, dense or all (default: all that the device has)
#   --only NAMES      some of sampling,feedback,fill,produce,budget,resolve,host,sharp,unseen,small (default: all)
#   --json            one object per line (name, value, unit) instead of the table, and more of them
#   --quick           small pictures, few and small textures: to see that everything works
#   --size WxH        of pictures in pixels (default: 1920x1080, on software devices 640x360, with
#                     --quick 160x90)
#   --texture-size N  edge of the texture of scenes (default: 16384, on software devices 8192, with
#                     --quick 2048)
#   --threads N       that load tiles (default: all processors but one)
#   --clock CLOCK     device or host, that times draws (default: the host's on software devices)
#   --bin DIR         run DIR/vulkan_figures instead of building; if DIR holds libvulkan.so.1, with that
#   --work DIR        keep the build there (default: a scratch folder, removed)
#   --validation      with validation layers, which must be silent; times mean nothing then
#   --list-figures    print the names of the table's figures
#   --list-devices, --help
#
# The library is built static, -O3 and without asserts. All ratios are of times in the same run, taken
# in turns. A software device (lavapipe) is measured by wall time, with a submission for each part of
# a frame, because its time stamps are wrong; its figures say little about a GPU's. README.md in this
# folder's parent says what each figure is. Needs awk; without --bin also meson, ninja, a C compiler
# and glslangValidator.
#
# Exit status: 0; 1 if a measurement failed; 77 if no device has the mode.

set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
export LC_ALL=C

json=no list=no bin='' work='' arguments=() scratch=''
trap '[ -z "$scratch" ] || rm -rf "$scratch"' EXIT

say() { printf '%s\n' "$*" >&2; }
die() {
    say "error: $*"
    exit 1
}

while [ $# -gt 0 ]; do
    case $1 in
    --json) json=yes ;;
    --quick | --list-devices | --validation) arguments+=("$1") ;;
    --bin | --work)
        [ $# -ge 2 ] || die "$1 needs a value (see --help)"
        declare "${1#--}=$2"
        shift
        ;;
    --device | --residency | --only | --size | --texture-size | --threads | --clock)
        [ $# -ge 2 ] || die "$1 needs a value (see --help)"
        arguments+=("$1" "$2")
        shift
        ;;
    --list-figures) list=yes ;;
    --help) sed -n '2,/^$/s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) die "unknown option $1 (see --help)" ;;
    esac
    shift
done

build() {
    work=${work:-$scratch}
    mkdir -p "$work"
    say "building"
    local again=()
    [ ! -d "$work/build" ] || again=(--reconfigure)
    { meson setup "${again[@]}" "$work/build" "$root" --buildtype=release -Db_ndebug=if-release \
        -Ddefault_library=static -Dtests=false &&
        ninja -C "$work/build" bench/vulkan/vulkan_figures; } >"$work/log" 2>&1 </dev/null || {
        tail -n 40 "$work/log" >&2
        die "the build failed"
    }
    bin=$work/build/bench/vulkan
}

# One line per figure: its name without the mode, what it is, and what it should be on an H200.
table() {
    cat <<'END'
sampling.compute.floor.speed|sampling, compute, floor|sparse 0.97, paged 0.6 at least
sampling.compute.close_up.speed|sampling, compute, close-up|sparse 0.97, paged 0.6 at least
sampling.compute.noise.speed|sampling, compute, noise|sparse 0.97, paged 0.6 at least
sampling.compute.floor_aniso8.speed|sampling, compute, floor, anisotropy 8|
sampling.fragment.floor.speed|sampling, fragment, floor|sparse 0.92 at least
sampling.fragment.close_up.speed|sampling, fragment, close-up|sparse 0.92 at least
sampling.fragment.noise.speed|sampling, fragment, noise|sparse 0.92 at least
sampling.fragment.floor_aniso8.speed|sampling, fragment, floor, anisotropy 8|
feedback.compute.floor.all.added|feedback, p = 1, compute, floor|
feedback.compute.floor.quads_16.added|feedback, p = 1/16, compute, floor|at most 8
feedback.compute.floor.quads_64.added|feedback, p = 1/64, compute, floor|at most 1
feedback.compute.floor.blocks_16.added|feedback, blocks of 4x4 pixels, 1 in 16, compute, floor|
feedback.compute.floor.lattice_64.added|feedback, lattice, compute, floor|
feedback.fragment.floor.all.added|feedback, p = 1, fragment, floor|
feedback.fragment.floor.quads_16.added|feedback, p = 1/16, fragment, floor|at most 18
feedback.fragment.floor.quads_64.added|feedback, p = 1/64, fragment, floor|at most 4
feedback.fragment.floor.blocks_16.added|feedback, blocks of 4x4 pixels, 1 in 16, fragment, floor|at most 18
feedback.fragment.floor.lattice_64.added|feedback, lattice, fragment, floor|
fill.rate|cold fill, source free|paged 120 000, sparse 60 000 at least
fill.256_per_frame.rate|... with the default of 256 tiles per frame|
fill.growing.rate|... while memory grows, as by default|
fill.floor.copy|the driver's copies alone|
fill.floor.bind|the driver's binds alone, tile by tile|
fill.floor.bind_runs_of_16|the driver's binds alone, runs of 16|
fill.of_copy|cold fill, share of the copies alone|
produce.cheap.rate|tiles of a producer, cheap shader|
produce.cheap.floor|... one dispatch alone that writes the same texels|
produce.cheap.of_dispatch|... share of the dispatch alone|
produce.dear.rate|tiles of a producer, 255 steps per texel|
produce.dear.floor|... one dispatch alone that writes the same texels|
produce.dear.of_dispatch|... share of the dispatch alone|0.8 at least
budget.missing|too large a working set: samples without any level|0
budget.coarser|... samples coarser than wanted|
budget.uploads_per_frame|... uploads after 100 frames|at most 1
resolve.still.gpu|resolve, 1 000 textures, still|at most 30
resolve.moving.gpu|resolve, 1 000 textures, 1 region in 20 new|at most 30
resolve.all_changed.gpu|resolve, 1 000 textures, all regions new|at most 30
host.moving.library|host, 1 000 maps a frame, camera moving: library itself|at most 60
host.moving.driver|... driver calls|
host.moving.allocations|... allocations per frame|0
host.still.library|host, 1 000 maps a frame, camera still: library itself|at most 10
host.still.driver|... driver calls|
host.still.allocations|... allocations per frame|0
host_share_10.moving.library|host, 10 maps a frame, camera moving: library itself|
host_share_10.moving.driver|... driver calls|
host_share_10.moving.allocations|... allocations per frame|0
host_share_10.still.library|host, 10 maps a frame, camera still: library itself|
host_share_10.still.driver|... driver calls|
host_share_10.still.allocations|... allocations per frame|0
sharp.all.frames|first visible to sharp, p = 1|at most 4
sharp.quads_16.frames_99|first visible to sharp, p = 1/16, 99 % of regions|at most 8
sharp.blocks_16.frames_99|first visible to sharp, blocks of 4x4 pixels, 99 % of regions|at most 16
unseen.always.tile_memory|1 000 unseen textures of 4096 x 4096, packed levels always there: heaps, pages, images|
unseen.always.device_memory|all device memory that is not mapped|
unseen.always.host_visible|mapped memory|
unseen.always.read|texels read|
unseen.always.first_sight|frames of fallback color at first sight|
unseen.on_demand.tile_memory|1 000 unseen textures of 4096 x 4096, packed levels on demand: heaps, pages, images|
unseen.on_demand.device_memory|all device memory that is not mapped|
unseen.on_demand.host_visible|mapped memory|
unseen.on_demand.read|texels read|
unseen.on_demand.first_sight|frames of fallback color at first sight|
small.resident|100 000 textures of 64 x 64 RGBA8: all resident|
small.tile_memory|device memory for each|at most 26 213
small.of_texels|... times its texels|at most 1.2
small.heaps|heaps of tiles that they take|0
small.host_added|host memory for each when added|
small.host_loaded|... and when resident|
small.add|time to add one|
small.load|time to load one|
END
}

# Lines of "mode.name value unit" to a table per mode.
print_tables() {
    table | awk -v figures="$1" '
        BEGIN {
            FS = "|"
            while ((getline line < figures) > 0) {
                split(line, word, /[ ]+/)
                dot = index(word[1], ".")
                mode = substr(word[1], 1, dot - 1)
                name = substr(word[1], dot + 1)
                if (!(mode in seen)) {
                    seen[mode] = 1
                    modes[++count] = mode
                }
                value[mode, name] = word[2]
                sub(/^[^ ]+ +[^ ]+ /, "", line)
                unit[mode, name] = line
            }
        }
        { names[NR] = $1; what[NR] = $2; goal[NR] = $3 }
        END {
            for (m = 1; m <= count; m++) {
                printf "%s%-62s %12s %-18s %s\n", (m > 1 ? "\n" : ""), modes[m], "figure", "unit",
                    "should be, on an H200"
                for (i = 1; i <= NR; i++)
                    if ((modes[m], names[i]) in value) {
                        number = value[modes[m], names[i]]
                        printf "%-62s " (number < 1e5 ? "%12.5g" : "%12.0f") " %-18s %s\n", what[i],
                            number, unit[modes[m], names[i]], goal[i]
                    }
            }
        }'
}

run() {
    if [ -e "$bin/libvulkan.so.1" ]; then
        LD_LIBRARY_PATH=$bin${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH} "$bin/vulkan_figures" "$@"
    else
        "$bin/vulkan_figures" "$@"
    fi
}

if [ "$list" = yes ]; then
    table | cut -d'|' -f1
    exit
fi
scratch=$(mktemp -d)
[ -n "$bin" ] || build
[ -x "$bin/vulkan_figures" ] || die "there is no program $bin/vulkan_figures"
case " ${arguments[*]-} " in
*" --list-devices "*)
    run --list-devices
    exit
    ;;
esac
if [ "$json" = yes ]; then
    status=0
    run "${arguments[@]}" --json || status=$?
    exit "$status"
fi
case " ${arguments[*]-} " in
*" --quick "*) say "quick: a tenth of the textures and of the repetitions, small pictures; not what the table says" ;;
esac
status=0
run "${arguments[@]}" >"$scratch/lines" || status=$?
print_tables "$scratch/lines"
exit "$status"
