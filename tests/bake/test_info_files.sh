#!/usr/bin/env bash
# test_info_files.sh SLUICE_INFO SLUICE_BAKE MAKE_PICTURE COMPARE_PICTURES DDS EXR: what sluice-info says of
# files, and the pictures it makes of them. Prints TAP. DDS: a file of 44 x 20 texels, EXR: one of
# 37 x 21 in scanlines, or "".
info=$(realpath "$1") bake=$(realpath "$2") make=$(realpath "$3") compare=$(realpath "$4") dds=$5 exr=$6
# shellcheck source=/dev/null
. "$(dirname "${BASH_SOURCE[0]}")/facts.sh"
# shellcheck disable=SC2034 # it is what run runs
tool=$info

"$make" rgba 300 200 1 a.png && "$make" gray 70 30 2 b.png &&
    "$bake" a.png b.png -o . --wrap repeat,mirror >out 2>err
fact stores_can_be_made

run 0 a.store && grep -q 'tile store' out && grep -q '300 x 200 texels, 9 levels' out &&
    grep -q 'R8G8B8A8_SRGB' out && grep -q 'source *a.png' out &&
    grep -q 'address modes *u repeat, v mirrored repeat' out && grep -q 'straight alpha' out
fact it_says_what_is_in_a_store

run 0 a.store b.store --json && [ "$(grep -c '^{.*}$' out)" -eq 2 ] &&
    grep -q "\"sourceSize\": $(stat -c %s a.png)," out && { ! command -v python3 >/dev/null ||
    python3 -c 'import json
for line in open("out"): json.loads(line)'; }
fact json_has_an_object_per_file

cp a.png $'\e]0;x\a\n\xff \xc3\xbc.png' && "$bake" $'\e]0;x\a\n\xff \xc3\xbc.png' -o odd.store >out 2>err &&
    run 0 odd.store && ! LC_ALL=C grep -q $'[\e\a\xff]' out && [ "$(grep -c '^  source ' out)" -eq 1 ] &&
    LC_ALL=C grep -qF '\x1b]0;x\x07\n\xff '$'\xc3\xbc.png, ' out && run 0 odd.store --json && [ "$(grep -c . out)" -eq 1 ] &&
    { ! command -v python3 >/dev/null || python3 -c 'import json
assert json.loads(open("out", "rb").read())["sourceName"] == "\x1b]0;x\x07\n\ufffd \xfc.png"'; }
fact names_of_sources_do_not_reach_the_terminal_raw

run 0 a.store --png whole.png && "$compare" a.png whole.png
fact level_0_is_the_picture

run 0 a.store --memory 4K --png low.png && "$compare" a.png low.png
fact a_picture_is_written_in_as_low_strips_as_the_memory_asks_for

run 0 a.store --tile 2,1 --png tile.png && "$compare" a.png tile.png 256 128
fact a_tile_is_a_part_of_it

run 0 b.store --png gray.png && "$compare" b.png gray.png
fact one_channel_is_gray

run 0 a.store --level 8 --png one.png && [ -s one.png ]
fact the_last_level_is_a_texel

run 1 a.store --level 9 --png no.png && grep -q 'a.store: .*level' err && [ ! -e no.png ] &&
    run 1 a.store --tile 3,0 --png no.png && grep -q 'a.store: .*tile' err && [ ! -e no.png ]
fact levels_and_tiles_that_are_not_there_are_errors

cp a.store broken.store && printf 'XXXX' | dd of=broken.store bs=1 seek=9000 conv=notrunc 2>dd.log
run 1 broken.store --png no.png && [ "$(grep -c . err)" -eq 1 ] && grep -q 'broken.store: at [0-9]*: ' err && [ ! -e no.png ]
fact a_tile_that_is_damaged_is_an_error

echo nothing >text
: >empty
run 1 a.store text empty absent && [ "$(grep -c . err)" -eq 3 ] && grep -q '300 x 200' out
fact files_that_are_none_are_errors_and_the_others_are_shown

run 1 a.png && [ "$(grep -c . err)" -eq 1 ] && grep -q 'a.png: is not a tile store, OpenEXR, DDS, KTX2 or .ntc file; sluice-bake' err
fact a_picture_of_another_kind_is_named_so

"$bake" a.png b.png -o listed --plan the.plan >out 2>err && "$bake" --shard 1/1 the.plan >out 2>err &&
    "$bake" --merge the.plan -o the.tsv >out 2>err && run 0 the.tsv && grep -q '^the.tsv: catalogue of tile stores$' out &&
    grep -q '^  stores  *2$' out && grep -q "^  their files  *$(cat listed/*.store | wc -c) bytes\$" out &&
    run 0 the.tsv --json && grep -q '"kind": "catalogue", "stores": 2, ' out
fact a_catalogue_is_counted
head -c -9 the.tsv >cut.tsv && run 1 cut.tsv && grep -q 'cut.tsv: is a catalogue whose line 4 is damaged' err &&
    sed '3s/\t/ /' the.tsv >joined.tsv && run 1 joined.tsv && grep -q 'line 3 is damaged' err
fact a_damaged_catalogue_is_told_with_its_line

if [ -n "$dds" ]; then
    run 0 "$dds" && grep -q '44 x 20 texels, 6 levels' out && grep -q 'BC1' out &&
        run 1 "$dds" --png no.png && [ ! -e no.png ]
    fact it_knows_dds
fi

if [ -n "$exr" ]; then
    run 0 "$exr" && grep -q '37 x 21 texels, 6 levels' out && grep -q 'storage *scanlines, 37 x 16 texels each, ZIP' out &&
        grep -q 'channels *A, B, G, R' out && grep -q 'levels *only level 0.* 1 MiB' out && grep -q 'sluice-bake FILE -o DIR' out
    fact it_says_how_an_exr_holds_its_texels

    "$bake" "$exr" -o exr.store >out 2>err && run 0 exr.store --png stored.png &&
        run 0 "$exr" --png direct.png && "$compare" stored.png direct.png
    fact an_exr_without_levels_is_read_in_strips

    # The same header for 16384 x 16384 texels: a hole has room for as many blocks of lines.
    cp "$exr" big.exr && chmod u+w big.exr && truncate -s 2M big.exr
    at=$(LC_ALL=C grep -abo -m1 dataWindow big.exr | head -n1 | cut -d: -f1)
    printf '\0\0\0\0\0\0\0\0\377\77\0\0\377\77\0\0' | dd of=big.exr bs=1 seek=$((at + 21)) conv=notrunc 2>dd.log
    run 0 big.exr && grep -q '16384 x 16384 texels, 15 levels' out && grep -q ' 2732 MiB' out &&
        run 0 big.exr --json && grep -q '"chainSize": 28[0-9]\{8\},' out
    fact it_says_what_is_in_a_large_exr_without_decoding_it

    run 1 big.exr --level 3 --png no.png && grep -q 'big.exr: .* 2738 MiB .*sluice-bake FILE -o DIR' err &&
        grep -q -e '--memory' err && [ ! -e no.png ] &&
        run 2 big.exr --memory x && grep -q 'size like 512M' err
    fact levels_that_take_too_much_memory_are_refused_with_a_way_out
fi

end_facts
