#!/usr/bin/env bash
# Measures what demand loading costs on a Vulkan device and prints a table: the figure, what the OptiX
# Toolkit had on an H200, and what was set for an H200.
#
#   bench/demand/run.sh [options]
#
#   --device NAME     an index or a part of a name; --list-devices prints them (default: the best)
#   --only NAMES      some of create,fill,sampling,trips,budget,bytes,small (default: all)
#   --json            one object per line (name, value, unit) instead of the table, and more of them
#   --quick           few and small textures: to see that everything works
#   --threads N       that load tiles (default: all processors but one)
#   --bin DIR         run DIR/demand_figures instead of building
#   --work DIR        keep the build there (default: a scratch folder, removed)
#   --validation      with validation layers, which must be silent; times mean nothing then
#   --list-figures    print the names of the table's figures
#   --list-devices, --help
#
# 16 textures of 8192 x 8192 RGBA8 whose texels cost nothing, 4.2 million samples a launch; on software
# devices (lavapipe) 16 of 4096 x 4096 and 0.26 million, by wall time. The library is built static, -O3
# and without asserts. README.md in this folder's parent says what each figure is. Needs awk; without
# --bin also meson, ninja, a C compiler and glslangValidator.
#
# Exit status: 0; 1 if a measurement failed; 2 for a wrong option; 77 if no device can do it.

set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
export LC_ALL=C

json=no bin='' work='' arguments=() scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

say() { printf '%s\n' "$*" >&2; }
die() {
    say "error: $*"
    exit 1
}

# One line per figure: its name, what it is, the OptiX Toolkit's, and what it should be on an H200.
table() {
    cat <<'END'
create.seconds|creating 100 000 textures, s|30 for 2 500|at most 2
create.opened|... images opened|0|0
create.page_memory|device memory for 64 Mi virtual pages, MiB|64|at most 64
fill.rate|cold fill, source free, tiles/s|11 000 to 14 000|at least 120 000
fill.defaults.rate|... while memory grows, as by default, tiles/s||
fill.again.rate|... again, after all tiles were dropped, tiles/s||
fill.floor.copy|the driver's copies alone, tiles/s||
fill.of_copy|cold fill, share of the copies alone||0.9
sampling.plain.rate|resident sampling, textureGrad, Gsamples/s||
sampling.untracked.rate|... demand loaded, without tracking for eviction|16.3|at least 16
sampling.untracked.of_plain|... of textureGrad||
sampling.tracked.rate|... with tracking|14.1|at least 14
sampling.tracked.of_plain|... of textureGrad||
sampling.linear_of_cubic.of_plain|... linear filter, shader that knows bicubic filters||
sampling.smart.of_plain|... smart cubic, not magnified||
sampling.cubic.of_plain|... cubic, two levels||
sampling.linear_slopes.of_plain|... linear, with derivatives||
sampling.cubic_slopes.of_plain|... cubic, two levels, with derivatives||
trip.floor|empty submission and wait, us||
trip.64.median|launch that misses nothing, 64 requests at most, us|72|at most 50
trip.512.median|... 512|64|at most 50
trip.8192.median|... 8192|136 to 238|at most 50
trip.8192_tracked.median|... 8192, memory nearly full||at most 50
budget.launches|437 MB in 256 MB: launches until complete|never|at most 30
budget.missing|... samples that are missing then|43 to 57 %|0
budget.uploads_later|... MB uploaded by 100 more launches|13 GB/s|0
budget.lod_bias|... levels coarser||
bytes.rate|cold fill of byte pages of 64 KiB, pages/s||
bytes.tiles.rate|... of tiles, tiles/s||
bytes.of_tiles|... byte pages per tile||
small.of_texels|100 000 textures of 64x64, all resident: memory per texel||1.2
small.host_open|... host memory of an open texture, bytes||
small.once.launches|... sampled once each in 512 MiB: launches for 16||
small.once.refused|... pages that were refused||0
END
}

build() {
    work=${work:-$scratch}
    mkdir -p "$work"
    say "building"
    local again=()
    [ ! -d "$work/build" ] || again=(--reconfigure)
    { meson setup "${again[@]}" "$work/build" "$root" --buildtype=release -Db_ndebug=if-release \
        -Ddefault_library=static -Dtests=false &&
        ninja -C "$work/build" bench/demand/demand_figures; } >"$work/log" 2>&1 </dev/null || {
        tail -n 40 "$work/log" >&2
        die "the build failed"
    }
    bin=$work/build/bench/demand
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
    --device | --only | --threads)
        [ $# -ge 2 ] || die "$1 needs a value (see --help)"
        arguments+=("$1" "$2")
        shift
        ;;
    --list-figures)
        table | cut -d'|' -f1
        exit
        ;;
    --help)
        sed -n '2,/^$/s/^# \{0,1\}//p' "$0"
        exit 0
        ;;
    *)
        say "error: unknown option $1 (see --help)"
        exit 2
        ;;
    esac
    shift
done

[ -n "$bin" ] || build
[ -x "$bin/demand_figures" ] || die "there is no program $bin/demand_figures"
status=0
if [ "$json" = yes ]; then
    "$bin/demand_figures" "${arguments[@]}" --json || status=$?
    exit "$status"
fi
case " ${arguments[*]-} " in
*" --list-devices "*)
    "$bin/demand_figures" --list-devices || status=$?
    exit "$status"
    ;;
*" --quick "*) say "quick: few and small textures; not what the table says" ;;
esac
"$bin/demand_figures" "${arguments[@]}" >"$scratch/lines" || status=$?
[ -s "$scratch/lines" ] || exit "$status"
table | awk -F'|' -v figures="$scratch/lines" '
    BEGIN {
        while ((getline line < figures) > 0) {
            split(line, word, /[ ]+/)
            value[word[1]] = word[2]
        }
        printf "%-58s %12s  %-17s %s\n", "", "figure", "OptiX Toolkit", "should be, on an H200"
    }
    $1 in value {
        printf "%-58s " (value[$1] < 1e5 ? "%12.5g" : "%12.0f") "  %-17s %s\n", $2, value[$1], $3, $4
    }'
exit "$status"
