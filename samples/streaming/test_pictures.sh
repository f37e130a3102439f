#!/usr/bin/env bash
# test_pictures.sh STREAMING MAKE_PICTURE SOURCE_ROOT: pictures of many kinds hang in the gallery, what
# is broken is named and left out, and what was baked once is not baked again. Prints TAP.
streaming=$(realpath "$1") make=$(realpath "$2") root=$(realpath "$3")
# shellcheck source=/dev/null
. "$root/tests/bake/facts.sh"
export XDG_CACHE_HOME=$PWD/home-cache

# walk STATUS OPTIONS...: whether a short walk ends with this status; its words are in out and err
walk() {
    local expected=$1 got=0
    shift
    "$streaming" --generate-scale 8 --size 128x72 --frames 24 --rest-frames 8 --write-frames none \
        --json --output report "$@" >out 2>err || got=$?
    [ $got -eq "$expected" ]
}

figure() { sed -n "s/.*\"name\": \"$1\", \"value\": \([^,]*\),.*/\1/p" out; }
hangs() { grep -q "<td>$1</td>" report/report.html; }
sums() { find "$1" -name '*.store' -exec sha256sum {} + | sort; }

"$streaming" --generate-scale 64 --size 16x16 --frames 1 --output probe >/dev/null 2>&1
[ $? -ne 77 ] || { echo "1..0 # SKIP there is no Vulkan device that streams"; exit 0; }

mkdir -p in/sub
"$make" rgb 700 500 1 in/a.png && "$make" rgb 640 800 2 in/sub/b.jpg && "$make" gray 300 200 3 in/c.tif &&
    cp "$root/tests/exr/data/mip_zip.exr" in/tiled.exr && cp "$root/tests/exr/data/scan_piz.exr" in/lines.exr &&
    head -c 2000 in/sub/b.jpg >in/broken.jpg && echo "no picture" >in/notes.txt && ln -s . in/circle &&
    mkfifo in/pipe.png
fact pictures_can_be_made

walk 0 --images in
fact a_walk_past_a_broken_file_succeeds

[ "$(figure pictures)" = 5 ] && [ "$(figure pictures_left_out)" = 1 ] && [ "$(figure tiles_failed)" = 0 ] &&
    hangs in/a.png && hangs in/sub/b.jpg && hangs in/c.tif && hangs in/tiled.exr && hangs in/lines.exr
fact all_good_pictures_of_a_folder_hang

grep -q '^in/broken.jpg: left out: SLUICE_ERROR_CORRUPT_DATA' err && ! hangs in/broken.jpg
fact the_broken_one_is_named

grep -q '^4 pictures baked, 0 were up to date' err &&
    [ "$(find "$XDG_CACHE_HOME/sluice/baked" -type f | sed 's|.*/||' | sort | tr '\n' ' ')" = \
        "a.png.store b.jpg.store c.tif.store lines.exr.store " ]
fact what_has_no_tiles_is_baked_into_the_users_cache

sums "$XDG_CACHE_HOME" >before
touch -d '2001-01-01' stamp
find "$XDG_CACHE_HOME" -name '*.store' -exec touch -r stamp {} +
walk 0 --images in && grep -q '^0 pictures baked, 4 were up to date' err && [ "$(figure pictures)" = 5 ] &&
    sums "$XDG_CACHE_HOME" | cmp -s - before &&
    [ -z "$(find "$XDG_CACHE_HOME" -name '*.store' -newer stamp)" ]
fact a_second_run_bakes_nothing

"$make" rgb 700 500 9 in/a.png && walk 0 --images in && grep -q '^1 pictures baked, 3 were up to date' err
fact a_changed_picture_is_baked_again

walk 0 --images in --format rgba16f && grep -q '^3 pictures baked, 1 were up to date' err &&
    [ "$(grep -c '<td>R16G16B16A16_SFLOAT' report/report.html)" = 5 ] && ! grep -q 'R8G8B8A8_SRGB' report/report.html
fact another_format_bakes_again

mkdir made && cp "$XDG_CACHE_HOME/sluice/baked$(realpath in/a.png).store" made/own.store &&
    cp "$root/tests/container/data/nvtt_bc1.dds" made/blocks.dds && walk 0 --images made in/a.png --cache elsewhere &&
    [ "$(figure pictures)" = 3 ] && hangs made/own.store && hangs made/blocks.dds &&
    [ "$(find elsewhere -type f)" = "elsewhere/baked$(realpath in/a.png).store" ]
fact stores_and_containers_are_streamed_in_place

walk 0 --images made --cache unused && [ ! -e unused ] && ! grep -q baked err
fact nothing_is_baked_that_needs_no_baking

head -c 5000 made/own.store >made/short.store
walk 0 --images made absent.png && grep -q '^made/short.store: left out' err && grep -q '^absent.png: ' err &&
    [ "$(figure pictures)" = 2 ] && [ "$(figure pictures_left_out)" = 2 ]
fact damaged_stores_and_missing_files_are_named

ln -s a.png in/twin.png
walk 0 --images in/a.png in/twin.png in/a.png --cache twins && grep -q '^1 pictures baked' err &&
    [ "$(figure pictures)" = 3 ] && [ "$(figure pictures_left_out)" = 0 ] && rm in/twin.png
fact a_picture_that_is_named_twice_is_baked_once

walk 1 --images in/broken.jpg && grep -q 'there is no picture to hang' err
fact without_a_good_picture_there_is_no_walk

looks_closely() { walk 0 --images large.png --generate-scale 2 --size 320x180 "$@"; }
"$make" rgb 3000 2000 5 large.png && looks_closely && [ "$(figure resident_bytes_peak)" -gt 6291456 ] &&
    [ "$(figure budget_bytes)" = null ] && looks_closely --budget 3 && [ "$(figure budget_bytes)" = 3145728 ] &&
    [ "$(figure resident_bytes_peak)" -le 3145728 ] && [ "$(figure resident_bytes)" -gt 1048576 ] &&
    [ "$(figure virtual_bytes)" -gt 20000000 ] && [ "$(figure tiles_failed)" = 0 ]
fact tiles_keep_to_the_budget

coproc python3 "$root/tests/http/faulty_server.py"
read -r port _ <&"${COPROC[0]}"
from_web() { printf 'http://127.0.0.1:%s/file/%s?path=%s' "$port" "$1" "$PWD/$2"; }
{ walk 0 --images "$(from_web own.store made/own.store)" "$(from_web a.png in/a.png)" "$(from_web b.dds made/blocks.dds)" \
    "$(from_web none.png none)" --cache web && [ "$(figure pictures)" = 3 ] && [ "$(figure tiles_failed)" = 0 ] &&
    [ "$(figure pictures_left_out)" = 1 ] && grep -q '^1 pictures baked' err && cmp web/fetched/*-a.png in/a.png; } ||
    grep -q 'without sluice-http' err
fact pictures_on_servers_are_copied_and_stores_read_in_place
kill "${COPROC_PID:?}" && wait "$COPROC_PID" 2>/dev/null

head -c 3000 in/a.png >cut.png && ! "$streaming" --images cut.png --generate-only --cache cut >out 2>err &&
    grep -q '^cut.png: left out: SLUICE_ERROR_CORRUPT_DATA' err && ! grep -q WARNING err
fact libvips_says_nothing_besides

end_facts
