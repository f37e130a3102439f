#!/usr/bin/env bash
# Measures how fast pictures are baked and prints a table: sluice-bake beside OpenImageIO's maketx on the
# same processors, and the memory that a picture far larger than memory takes.
#
#   bench/store/bake.sh [options] [PICTURE]
#
#   --json          one object per line (name, value, unit) instead of the table
#   --size TEXELS   edge of the picture that both bake (default: 16384, with --quick 2048)
#   --huge TEXELS   edge of the picture for the memory figure, 0: none (default: 65536, with --quick 8192)
#   --rounds N      of which the fastest counts, both programs in turns (default: 2)
#   --quick         small pictures, one round: to see that everything works
#   --bin DIR       run DIR/sluice-bake instead of building
#   --work DIR      keep what is built and made there (default: a scratch folder, removed); 2 GB
#   --help
#
# PICTURE is scaled to the edge and written as an uncompressed TIFF, so that reading costs both the same
# little; default: a photograph of the package plasma-workspace-wallpapers. Both bake 8 bits per
# channel with all levels, box filter, at their default compression (zstd level 10; zip). They do not
# write the same: the store has an alpha of 1 beside R, G and B, and its levels are averaged as light.
#
# The huge picture is 2048 x 2048 texels of the photograph, repeated, as a tiled TIFF of JPEG tiles (so
# that it fits on the disk), baked with zstd level 1 and --memory 1G; its figure is the peak of the
# resident memory that the kernel saw.
#
# The library is built static, -O3 and without asserts. Needs vips (libvips-tools), maketx
# (openimageio-tools), GNU time, awk; without --bin also meson, ninja and a C compiler. Exit status: 0;
# 1 if something failed; 77 if vips, maketx or a picture is not there.

set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
export LC_ALL=C

json=no quick=no size='' huge='' rounds='' bin='' work='' picture=''

say() { printf '%s\n' "$*" >&2; }
die() {
    say "error: $*"
    exit 1
}
skip() {
    say "skipped: $*"
    exit 77
}

while [ $# -gt 0 ]; do
    case $1 in
    --json) json=yes ;;
    --quick) quick=yes ;;
    --size | --huge | --rounds | --bin | --work)
        [ $# -ge 2 ] || die "$1 needs a value (see --help)"
        declare "${1#--}=$2"
        shift
        ;;
    --help) sed -n '2,/^$/s/^# \{0,1\}//p' "$0"; exit 0 ;;
    -*) die "unknown option $1 (see --help)" ;;
    *) picture=$1 ;;
    esac
    shift
done
if [ "$quick" = yes ]; then
    size=${size:-2048} huge=${huge:-8192} rounds=${rounds:-1}
fi
size=${size:-16384} huge=${huge:-65536} rounds=${rounds:-2}

for program in vips maketx /usr/bin/time; do
    command -v "$program" >/dev/null || skip "$program is not installed"
done
if [ -z "$picture" ]; then
    for picture in /usr/share/wallpapers/*/contents/images/5120x2880.jpg; do break; done
fi
[ -f "$picture" ] || skip "plasma-workspace-wallpapers is not installed; name a picture"

if [ -z "$work" ]; then
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
fi
mkdir -p "$work"
work=$(cd "$work" && pwd)
figures=$work/figures
: >"$figures"

build() {
    say "building"
    local again=()
    [ ! -d "$work/build" ] || again=(--reconfigure)
    { meson setup "${again[@]}" "$work/build" "$root" --buildtype=release -Db_ndebug=if-release \
        -Ddefault_library=static -Dtests=false -Dsamples=disabled -Dvulkan=disabled -Dbake=enabled &&
        ninja -C "$work/build" tools/sluice-bake/sluice-bake; } >"$work/log" 2>&1 </dev/null || {
        tail -n 40 "$work/log" >&2
        die "the build failed"
    }
    bin=$work/build/tools/sluice-bake
}

figure() { printf '%s %s %s\n' "$1" "$2" "$3" >>"$figures"; }

# timed NAME COMMAND...: adds "NAME seconds processor-seconds KiB" to the runs
timed() {
    local name=$1
    shift
    /usr/bin/time -o "$work/time" -f '%e %U %S %M' "$@" >"$work/log" 2>&1 || {
        tail -n 20 "$work/log" >&2
        die "$name failed"
    }
    awk -v name="$name" '{ print name, $1, $2 + $3, $4 }' "$work/time" >>"$work/runs"
}

# best NAME COLUMN
best() {
    awk -v name="$1" -v column="$2" '$1 == name && (!n++ || $column < least) { least = $column }
        END { print least }' "$work/runs"
}

# ratio NAME NAME: of two figures
ratio() {
    awk -v a="$1" -v b="$2" '{ value[$1] = $2 } END { printf "%.4g", value[a] / value[b] }' "$figures"
}

compare() {
    : >"$work/runs"
    say "making a picture of $size x $size texels"
    vips thumbnail "$picture" "$work/picture.tif" "$size" --height "$size" --size force >"$work/log" 2>&1 ||
        die "$(tail -n 1 "$work/log")"
    for ((round = 1; round <= rounds; round++)); do
        say "round $round of $rounds"
        timed sluice "$bin/sluice-bake" "$work/picture.tif" -o "$work/picture.store" --force
        timed maketx maketx --format tiff -o "$work/picture.tx" "$work/picture.tif"
    done
    for name in sluice maketx; do
        figure "bake.$name.time" "$(best $name 2)" s
        figure "bake.$name.processor_time" "$(best $name 3)" s
        figure "bake.$name.memory" "$(best $name 4)" KiB
    done
    figure bake.sluice.size "$(stat -c %s "$work/picture.store")" bytes
    figure bake.maketx.size "$(stat -c %s "$work/picture.tx")" bytes
    figure bake.times_as_fast "$(ratio bake.maketx.time bake.sluice.time)" ratio
    figure bake.size_of_maketx "$(ratio bake.sluice.size bake.maketx.size)" ratio
    rm -f "$work"/picture.*
}

measure_huge() {
    [ "$huge" -gt 0 ] || return 0
    : >"$work/runs"
    say "making a picture of $huge x $huge texels"
    { vips thumbnail "$picture" "$work/square.v" 2048 --height 2048 --crop centre &&
        vips replicate "$work/square.v" \
            "$work/huge.tif[tile,tile-width=256,tile-height=256,compression=jpeg,Q=90,bigtiff]" \
            $((huge / 2048)) $((huge / 2048)); } >"$work/log" 2>&1 || die "$(tail -n 1 "$work/log")"
    say "baking it"
    timed huge "$bin/sluice-bake" "$work/huge.tif" -o "$work/huge.store" --compression 1 --memory 1G
    figure huge.edge "$huge" texels
    figure huge.time "$(best huge 2)" s
    figure huge.memory "$(best huge 4)" KiB
    figure huge.memory_in_mib "$(($(best huge 4) / 1024))" MiB
    rm -f "$work/square.v" "$work"/huge.*
}

table() {
    awk '
        { value[$1] = $2 }
        END {
            printf "%-36s %12s %12s %8s  %s\n", "", "sluice-bake", "maketx", "ratio", "should be"
            split("time processor_time memory size", names)
            split("time (s)|processor time (s)|peak memory (MiB)|file (MiB)", what, "|")
            split("at most 0.5||at most 1|at most 1", goal, "|")
            split("1 1 1024 1048576", unit)
            for (i = 1; i <= 4; i++) {
                a = value["bake.sluice." names[i]] / unit[i]
                b = value["bake.maketx." names[i]] / unit[i]
                printf "%-36s %12.4g %12.4g %8.2f  %s\n", what[i], a, b, a / b, goal[i]
            }
            if (value["huge.edge"])
                printf "%-36s %12.4g %12s %8s  %s\n", value["huge.edge"] " texels square, peak (MiB)",
                    value["huge.memory"] / 1024, "", "", "at most 1024"
        }' "$figures"
}

[ -n "$bin" ] || build
[ -x "$bin/sluice-bake" ] || die "there is no program $bin/sluice-bake"
compare
measure_huge
if [ "$json" = yes ]; then
    awk '{ printf "{\"name\": \"%s\", \"value\": %s, \"unit\": \"%s\"}\n", $1, $2, $3 }' "$figures"
else
    table
fi
