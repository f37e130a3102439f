#!/usr/bin/env bash
# Measures what rendering a film set on demand costs, beside loading it first, and prints a table.
#
#   bench/pbrt/run.sh [options]
#
#   --device NAME       an index or a part of a name (default: the best)
#   --quick             2 000 instances of 20 meshes and small pictures, as on software devices
#   --instances N       of meshes (default: 1000000)
#   --meshes N          PLY files, each with a texture (default: 1000)
#   --triangles N       of a mesh (default: 1000)
#   --texture-size N    edge of a texture (default: 8192: 45 GB of textures)
#   --dim WxH           picture (default: 1920x1080; with --quick 160x90)
#   --frames N          of each flight (default: 600; with --quick 60)
#   --frame-budget MS   of each flight (default: 16)
#   --json              one object per line (name, value, unit) instead of the table
#   --bin DIR           build folder with both programs, instead of building
#   --work DIR          keep scene, pictures and build there (default: a scratch folder, removed)
#   --validation        with validation layers, which must be silent; times mean nothing then
#   --help
#
# Everything is loaded (--preload) if the textures have at most 1 GB. Otherwise the memory that
# takes is estimated: that of all shapes and the size of the texture files. Needs awk; without --bin
# also meson, ninja, a C compiler and glslangValidator.
#
# Exit status: 0; 1 if a measurement failed; 77 without a device that traces rays.

set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
export LC_ALL=C

instances=1000000 meshes=1000 triangles=1000 texture_size=8192 dim=1920x1080 frames=600
repeat=20 frame_budget=16 json=no bin='' work='' arguments=() scratch=''
trap '[ -z "$scratch" ] || rm -rf "$scratch"' EXIT

say() { printf '%s\n' "$*" >&2; }
die() {
    say "error: $*"
    exit 1
}

while [ $# -gt 0 ]; do
    case $1 in
    --quick) repeat=5 instances=2000 meshes=20 triangles=200 texture_size=512 dim=160x90 frames=60 ;;
    --json) json=yes ;;
    --validation) arguments+=("$1") ;;
    --device)
        arguments+=("$1" "${2:?--device needs a value}")
        shift
        ;;
    --instances | --meshes | --triangles | --texture-size | --dim | --frames | --frame-budget | --bin | --work)
        [ $# -ge 2 ] || die "$1 needs a value (see --help)"
        name=${1#--}
        declare "${name//-/_}=$2"
        shift
        ;;
    --help) sed -n '2,/^$/s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) die "unknown option $1 (see --help)" ;;
    esac
    shift
done

if [ -z "$work" ]; then
    scratch=$(mktemp -d)
    work=$scratch
fi
mkdir -p "$work"

if [ -z "$bin" ]; then
    say "building"
    bin=$work/build
    again=()
    [ ! -d "$bin" ] || again=(--reconfigure)
    { meson setup "${again[@]}" "$bin" "$root" --buildtype=release -Db_ndebug=if-release \
        -Ddefault_library=static -Dtests=false &&
        ninja -C "$bin" bench/pbrt/film_set samples/demand-pbrt/demand-pbrt; } >"$work/log" 2>&1 </dev/null || {
        tail -n 40 "$work/log" >&2
        die "the build failed"
    }
fi

figures=$work/figures
: >"$figures"

figure() { # name, value, unit
    printf '%s|%s|%s\n' "$1" "$2" "$3" >>"$figures"
}

value() { # run, figure
    sed -n "s/.*\"$2\", \"value\": \([^,]*\),.*/\1/p" "$work/$1.json" | head -n 1
}

compute() { # awk expression
    awk "BEGIN { printf \"%.6g\", $1 }"
}

render() { # run, options
    local run=$1 status=0
    shift
    say "$run"
    "$bin/samples/demand-pbrt/demand-pbrt" "$work/set/scene.pbrt" --dim "$dim" --json --file "$work/$run.pfm" \
        --cache "$work/cache" "${arguments[@]}" "$@" >"$work/$run.json" 2>"$work/$run.log" || status=$?
    [ "$status" -ne 77 ] || { cat "$work/$run.log" >&2; exit 77; }
    [ "$status" -eq 0 ] || { tail -n 20 "$work/$run.log" >&2; die "$run: exit status $status"; }
    cmp -s "$work/$run.pfm" "$work/demand.pfm" || die "$run: the picture differs from that on demand"
}

say "making the scene"
rm -rf "$work/set"
"$bin/bench/pbrt/film_set" --instances "$instances" --meshes "$meshes" --triangles "$triangles" \
    --texture-size "$texture_size" "$work/set" >"$work/set.json"
textures=$(value set set.texture_bytes)
figure set.instances "$instances" ""
figure set.triangles "$(value set set.triangles)" ""
figure set.texture_bytes "$textures" B

render demand --repeat "$repeat"
figure demand.seconds "$(value demand complete_seconds)" s
figure demand.launches "$(value demand launches)" ""
figure demand.parse "$(value demand parse_seconds)" s
figure demand.bounds "$(value demand bounds_seconds)" s
figure demand.host_memory "$(value demand peak_host_bytes)" B
figure demand.device_memory "$(value demand peak_device_bytes)" B
figure demand.shapes_entered "$(value demand shapes_entered)" ""
figure demand.resolve_per_1000 "$(value demand resolve_per_1000)" ms
figure demand.bytes_per_box "$(value demand bytes_per_box)" B
figure demand.bytes_per_unresolved "$(value demand bytes_per_unresolved)" B
figure demand.boxes_added "$(value demand boxes_added)" ""
figure demand.boxes_added_most "$(value demand boxes_added_most)" "by one"
figure demand.clusters "$(value demand cluster_seconds)" s
figure demand.build_queue "$(value demand build_queue)" ""
figure demand.rate "$(value demand repeat_rate)" Mrays/s

render shapes --preload-shapes --repeat "$repeat"
figure shapes.seconds "$(value shapes complete_seconds)" s
figure shapes.host_memory "$(value shapes peak_host_bytes)" B
figure shapes.device_memory "$(value shapes peak_device_bytes)" B
figure shapes.rate "$(value shapes repeat_rate)" Mrays/s
figure demand.of_shapes "$(compute "$(value demand repeat_rate) / $(value shapes repeat_rate)")" ""

if [ "$(compute "$textures <= 1e9")" = 1 ]; then
    render everything --preload
    figure everything.seconds "$(value everything complete_seconds)" s
    figure everything.device_memory "$(value everything peak_device_bytes)" B
else
    figure everything.device_memory_estimated "$(compute "$(value shapes peak_device_bytes) + $textures")" B
fi

fly() { # run, options
    local name run=$1
    shift
    render "$run" --fly "$frames" --frame-budget "$frame_budget" "$@"
    figure "$run.frames" "$frames" ""
    for name in mean median p99 longest {work,top_level,launch}_{mean,longest}; do
        figure "$run.$name" "$(value "$run" "frame_$name")" ms
    done
    figure "$run.pixels_missing" "$(value "$run" frame_pixels_missing)" "per frame"
    figure "$run.boxes_resolved" "$(value "$run" frame_boxes_resolved)" "per frame"
    figure "$run.boxes_resolved_most" "$(value "$run" frame_boxes_resolved_most)" "in a frame"
}
# Once around, and from a corner of the set to its middle.
fly flight
fly path --fly-from "$(awk "BEGIN { far = -sqrt($instances); print far \"/\" far \"/12/0/0/1/0/0/1\" }")"

goals() {
    case $1 in
    demand.bytes_per_unresolved) echo "at most 64" ;;
    demand.of_shapes) echo "0.95 at least" ;;
    flight.p99 | path.p99) echo "at most 20 on an H200" ;;
    esac
}

while IFS='|' read -r name number unit; do
    if [ "$json" = yes ]; then
        printf '{"name": "%s", "value": %s, "unit": "%s"}\n' "$name" "$number" "$unit"
    else
        printf '%-34s %14s %-10s %s\n' "$name" "$number" "$unit" "$(goals "$name")"
    fi
done <"$figures"
