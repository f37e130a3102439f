#!/usr/bin/env bash
# Measures tile stores and prints a table: each figure beside the floor or ceiling that was set for it.
#
#   bench/store/run.sh [options] [PICTURE...]
#
#   --all           the whole table: also baking (bake.sh: minutes, and 2 GB of disk), 10 000 flipped bits
#                   and 200 bakes that are killed; without it how fast tiles come out of a store
#   --json          one object per line (name, value, unit) instead of the table
#   --quick         one picture, few rounds, small bakes, 10 killed: to see that everything works
#   --work DIR      keep what is built and written there (default: a scratch folder, removed)
#   --help
#
# A PICTURE is anything that vips reads, or an OpenEXR file. Without any: photographs of the package
# plasma-workspace-wallpapers if that is installed and vips is there (libvips-tools), else OpenEXR
# pictures in openexr-images where SLUICE_TEST_DATA says (default: ../shared/data beside the checkout).
#
# The library is built with gcc -O3, static and without asserts, installed into the work folder and
# used from there through pkg-config. One thread; the files are in the page cache. README.md in this
# folder's parent says what each figure is. Needs gcc, meson, ninja, pkg-config, awk, OpenEXR, libzstd;
# with --all also libvips, cmocka, and for the rows about maketx what bake.sh needs.
#
# Environment: CC                 compiler instead of gcc
#              SLUICE_TEST_DATA   folder of sample files

set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
export CC=${CC:-gcc} LC_ALL=C

json=no all=no work='' quick=() pictures=()

say() { printf '%s\n' "$*" >&2; }
die() {
    say "error: $*"
    exit 1
}

while [ $# -gt 0 ]; do
    case $1 in
    --json) json=yes ;;
    --all) all=yes ;;
    --quick) quick=("$1") ;;
    --work)
        [ $# -ge 2 ] || die "$1 needs a value (see --help)"
        work=$2
        shift
        ;;
    --help) sed -n '2,/^$/s/^# \{0,1\}//p' "$0"; exit 0 ;;
    -*) die "unknown option $1 (see --help)" ;;
    *) pictures+=("$1") ;;
    esac
    shift
done

if [ -z "$work" ]; then
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
fi
mkdir -p "$work/pictures" "$work/stores"
work=$(cd "$work" && pwd)

# logged COMMAND...: quiet, but for the end of the log when it fails
logged() {
    "$@" >>"$work/log" 2>&1 </dev/null || {
        tail -n 40 "$work/log" >&2
        die "failed: $*"
    }
}

build() {
    say "building"
    local again=()
    [ ! -d "$work/build" ] || again=(--reconfigure)
    logged meson setup "${again[@]}" "$work/build" "$root" --prefix="$work/prefix" --libdir=lib \
        --buildtype=release -Db_ndebug=if-release -Ddefault_library=static \
        -Dtests=false -Dsamples=disabled -Dvulkan=disabled -Dstore=enabled -Dexr=enabled
    logged ninja -C "$work/build"
    logged meson install -C "$work/build" --no-rebuild
    export PKG_CONFIG_PATH=$work/prefix/lib/pkgconfig
    # shellcheck disable=SC2046 # a list of words
    logged "$CC" -std=c11 -O2 "$here"/*.c \
        "$root"/tools/common/{nearest,option_help,option_table,option_value,shared_options,text}.c \
        $(pkg-config --static --cflags --libs sluice-store sluice-exr sluice libzstd) \
        -pthread -lm -o "$work/store_figures"
}

# Photographs of many sizes and kinds; drawings compress too well to say much.
find_pictures() {
    local folder=/usr/share/wallpapers data=${SLUICE_TEST_DATA:-$root/../shared/data} name
    [ ${#pictures[@]} -eq 0 ] || return 0
    if command -v vips >/dev/null; then
        for name in Canopee FallenLeaf SafeLanding EveningGlow ColorfulCups Autumn; do
            pictures+=("$(find "$folder/$name/contents/images" -name '*x*.*' 2>/dev/null | sort -V | tail -n 1)")
        done
    fi
    [ ${#pictures[@]} -gt 0 ] && [ -f "${pictures[0]}" ] && return 0
    say "no photographs in $folder, or no vips: OpenEXR pictures in $data instead"
    pictures=("$data"/openexr-images/ScanLines/*.exr "$data"/openexr-images/MultiResolution/Bonita.exr)
}

prepare_pictures() {
    local picture number=0
    files=()
    for picture in "${pictures[@]}"; do
        [ -f "$picture" ] || continue
        number=$((number + 1))
        case $picture in
        *.exr | *.ppm) files+=("$picture") ;;
        *)
            logged vips colourspace "$picture" "$work/pictures/$number.ppm" srgb
            files+=("$work/pictures/$number.ppm")
            ;;
        esac
    done
    [ ${#files[@]} -gt 0 ] || die "there are no pictures (see --help)"
}

# append_json: figures that another program prints as JSON
append_json() {
    sed -n 's/^{"name": "\([^"]*\)", "value": \([^,]*\), "unit": "\([^"]*\)"}$/\1 \2 \3/p' >>"$work/figures"
}

measure_baking() {
    local status=0
    "$here/bake.sh" "${quick[@]}" --json --bin "$work/build/tools/sluice-bake" --work "$work/bake" \
        "${given[@]}" >"$work/baked" || status=$?
    [ $status -eq 0 ] || [ $status -eq 77 ] || die "bake.sh failed"
    append_json <"$work/baked"
}

# What the tests count: bits that are flipped, bakes that are killed.
measure_faults() {
    local kills=200
    [ ${#quick[@]} -eq 0 ] || kills=10
    say "flipping bits, killing bakes"
    local again=()
    [ ! -d "$work/tests" ] || again=(--reconfigure)
    logged meson setup "${again[@]}" "$work/tests" "$root" --buildtype=release -Dsamples=disabled \
        -Dvulkan=disabled -Dstore=enabled -Dbake=enabled -Dtests=true
    logged ninja -C "$work/tests" tests/store/test_store_damage tests/bake/make_picture
    CMOCKA_MESSAGE_OUTPUT=TAP "$work/tests/tests/store/test_store_damage" >"$work/flips" 2>&1 || true
    awk '/bits flipped:/ { flipped += $2; errors += $5; unread += $7 }
        /^not ok .*flipped/ { failed++ }
        END {
            print "faults.flipped_bits " flipped " bits"
            print "faults.flipped_bits.errors " errors " bits"
            print "faults.flipped_bits.unread " unread " bits"
            print "faults.flipped_bits.unnoticed " flipped - errors - unread + failed " bits"
        }' "$work/flips" >>"$work/figures"
    "$root/tests/bake/test_interrupted.sh" "$work/build/tools/sluice-bake/sluice-bake" \
        "$work/tests/tests/bake/make_picture" $kills >"$work/kills" || true
    awk '/ killed, / { killed = $2 }
        /^not ok/ { wrong += substr($6, 2) }
        END {
            print "faults.killed " killed " bakes"
            print "faults.killed.wrong " wrong + 0 " files"
        }' "$work/kills" >>"$work/figures"
}

# One line per figure: its name, what it is, and what it should be.
table() {
    cat <<'END'
rgba8.zstd3.tiles|RGBA8, zstd 3|
rgba8.zstd3.zstd_alone|... ZSTD_decompress of the same texels|
rgba8.zstd3.of_zstd_alone|... the store, of that|0.85 at least
rgba8.zstd3.written|... written, picture in memory|
rgba8.zstd3.size|... size of the file|
rgba8.raw.tiles|RGBA8, uncompressed, each tile checked once|
rgba8.raw.pread_alone|... pread of 64 KiB|
rgba8.raw.of_pread_alone|... the store, of that|0.9 at least
rgba8.raw.checked_always.tiles|RGBA8, uncompressed, checked at each read|
rgba8.raw.checked_always.of_pread_alone|... of pread of 64 KiB|
rgba16f.zstd3.tiles|RGBA16F, zstd 3|
rgba16f.zstd3.openexr_zip|... OpenEXR, ZIP, half, tiles of the same shape|
rgba16f.zstd3.of_openexr_zip|... the store, of that|4 at least
rgba16f.zstd3.size_of_openexr_zip|... size of the file, of OpenEXR's|
open_and_first_tile.median|opening and the first tile|100 at most
open_and_first_tile.least|... the least|
open_and_first_tile.shared_pool.median|... with a pool that others use, too|100 at most
open_and_first_tile.shared_pool.least|... the least|
open_and_first_tile.zstd_alone.median|... ZSTD_decompress alone, of the same tiles|
bake.sluice.time|baking a large picture, all levels|
bake.maketx.time|... maketx|
bake.times_as_fast|... how many times as fast|2 at least
bake.size_of_maketx|... size of the file, of maketx's|1 at most
huge.edge|baking a huge one, texels square|
huge.memory_in_mib|... peak of resident memory|1024 at most
faults.flipped_bits|bits flipped, the file opened anew each time|
faults.flipped_bits.errors|... reading is an error|
faults.flipped_bits.unread|... where nobody reads: harmless|
faults.flipped_bits.unnoticed|... wrong texels, crashes|0
faults.killed|bakes killed (SIGKILL) at any moment|
faults.killed.wrong|... wrong files, then or after the next run|0
END
}

print_table() {
    table | awk -F '|' -v figures="$work/figures" '
        BEGIN {
            while ((getline line < figures) > 0) {
                split(line, word, " ")
                value[word[1]] = word[2]
                sub(/^[^ ]+ [^ ]+ /, "", line)
                unit[word[1]] = line
            }
            printf "%-52s %12s %-14s %s\n", "", "figure", "unit", "should be"
        }
        $1 in value { printf "%-52s %12.4g %-14s %s\n", $2, value[$1], unit[$1], $3 }'
}

print_json() {
    awk '{
        name = $1
        value = $2
        sub(/^[^ ]+ [^ ]+ /, "")
        printf "{\"name\": \"%s\", \"value\": %s, \"unit\": \"%s\"}\n", name, value, $0
    }' "$work/figures"
}

given=("${pictures[@]:0:1}") # bake.sh takes one
build
find_pictures
prepare_pictures
say "reading ${#files[@]} pictures"
"$work/store_figures" "${quick[@]}" "$work/stores" "${files[@]}" >"$work/figures"
if [ "$all" = yes ]; then
    measure_baking
    measure_faults
fi
if [ "$json" = yes ]; then
    print_json
else
    print_table
fi
