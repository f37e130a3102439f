#!/usr/bin/env bash
# test_tool.sh SLUICE_BAKE MAKE_PICTURE: files, folders, failures and what is said of them. Prints TAP.
bake=$(realpath "$1") make=$(realpath "$2")
# shellcheck source=/dev/null
. "$(dirname "${BASH_SOURCE[0]}")/facts.sh"
# shellcheck disable=SC2034 # it is what run runs
tool=$bake

count() { grep -c -- "$1" "$2"; }

mkdir -p in/sub/deep
"$make" rgb 300 200 1 in/a.png && "$make" rgba 129 77 2 in/sub/b.png &&
    "$make" gray 64 512 3 in/sub/deep/c.tif && "$make" rgb 200 100 4 in/d.jpg &&
    "$make" rgb 333 111 5 in/sub/e.webp
fact pictures_can_be_made

run 0 in/a.png -o one.store && [ -s one.store ] && run 0 --verify one.store
fact one_picture_becomes_one_file

run 0 in/a.png -o made.d/ && [ -s made.d/a.store ]
fact an_output_that_ends_in_a_slash_is_a_folder

run 2 in/a.png in/d.jpg -o both.store && grep -q 'the name of one tile store, and there are 2 inputs' err && [ ! -e both.store ]
fact several_pictures_are_refused_for_one_store

run 2 in/a.png -o picture.PNG && grep -q 'a tile store is written, not a picture' err &&
    [ ! -e picture.PNG ] && mkdir folder.png && run 0 in/a.png -o folder.png && [ -s folder.png/a.store ]
fact an_output_named_as_a_picture_is_refused_unless_it_is_a_folder

mkdir sky.d && for face in px nx py ny pz nz; do "$make" rgb 64 64 "$((++seed))" sky.d/$face.png; done
run 0 --cube sky.d/{px,nx,py,ny,pz,nz}.png -o sky.store && grep -q '^baked .*64x64 .*sky.store$' out &&
    run 0 --verify sky.store && run 0 --cube sky.d/{px,nx,py,ny,pz,nz}.png -o sky.store --json &&
    grep -q '"status": "unchanged".*"layers": 6' out && run 0 --cube sky.d/{nx,px,py,ny,pz,nz}.png -o sky.store &&
    grep -q '^1 baked' out && run 0 --array sky.d/{px,nx}.png -o two.store --json && grep -q '"layers": 2' out
fact six_pictures_become_one_store

run 1 --cube sky.d/{px,nx,py,ny,pz}.png -o no.store && grep -q '^failed .*no.store: sky.d/px.png: 5 layers' out &&
    "$make" rgb 64 63 1 sky.d/low.png && run 1 --cube sky.d/{px,nx,py,ny,pz,low}.png -o no.store &&
    grep -q 'sky.d/low.png: is 64 x 63 texels, .*sky.d/px.png is 64 x 64 texels' out &&
    run 2 --cube sky.d -o no.store && run 2 --cube sky.d/px.png -o made.d/ && grep -q 'is a folder' err &&
    run 2 --cube --array sky.d/px.png -o no.store && run 2 --cube --verify sky.store -o no.store && [ ! -e no.store ]
fact pictures_that_make_no_cube_are_refused
rm -r sky.d

echo junk >junk.png
run 1 in/a.png junk.png -o junk.d && grep -q '^failed .*junk.store: junk.png: ' out
fact a_failed_row_says_why
rm -r junk.png junk.d folder.png

run 0 in -o out.d && [ "$(find out.d -type f | sort | tr '\n' ' ')" = \
    "out.d/a.store out.d/d.store out.d/sub/b.store out.d/sub/deep/c.store out.d/sub/e.store " ]
fact folders_keep_their_structure

grep -q '^5 baked, 0 unchanged, 0 failed; .* in, .* out; [0-9.]* s, [0-9.]* Mtexel/s$' out
fact the_summary_counts

[ ! -s err ]
fact nothing_is_said_on_stderr_without_a_terminal

find out.d -type f -exec sha256sum {} + >before
run 0 in -o out.d && grep -q '^0 baked, 5 unchanged.* out$' out && sha256sum --quiet -c before
fact what_is_up_to_date_is_left_alone

touch -d '2001-01-01' in/a.png
run 0 in -o out.d && grep -q '^1 baked, 4 unchanged' out
fact a_touched_picture_is_baked_again

run 0 in -o out.d --wrap repeat && grep -q '^5 baked' out
fact other_settings_bake_again

run 0 in -o out.d --wrap repeat --force && grep -q '^5 baked' out
fact force_bakes_again

truncate -s 100 out.d/a.store
run 1 --verify out.d/a.store out.d/d.store && grep -q '^whole .*d.store' out && grep -q '^damaged .*a.store' out
fact verify_finds_a_damaged_file

run 1 --verify out.d && [ "$(count '^whole' out)" -eq 4 ] && [ "$(count '^damaged .*out.d/a.store' out)" -eq 1 ] &&
    mkdir none && run 1 --verify none && grep -q 'no store' err
fact verify_looks_into_folders

run 0 in -o out.d --wrap repeat && grep -q '^1 baked, 4 unchanged' out && run 0 --verify out.d/a.store
fact a_damaged_store_is_baked_again

head -c 20000 in/a.png >in/cut.png
echo "this is no picture" >in/sub/text.png
: >in/empty.jpg
run 1 in in/absent.png -o out.d --wrap repeat && grep -q '^0 baked, 5 unchanged, 4 failed' out
fact broken_pictures_do_not_stop_the_others

[ "$(count . err)" -eq 4 ] && grep -q 'in/cut.png: ..' err && grep -q 'in/sub/text.png: ..' err &&
    grep -q 'in/empty.jpg: ..' err && grep -q 'in/absent.png: ..' err
fact every_failure_names_the_file_and_the_reason

[ ! -e out.d/cut.store ] && [ -z "$(find out.d -name '*.sluice-part')" ]
fact broken_pictures_leave_nothing

run 1 in -o out.d --wrap repeat --json && [ "$(count '^{.*}$' out)" -eq 8 ] &&
    [ "$(count '"status": "failed"' out)" -eq 3 ] && [ "$(count '"status": "unchanged"' out)" -eq 5 ] &&
    { ! command -v python3 >/dev/null || python3 -c 'import json, sys
for line in open("out"): json.loads(line)'; }
fact json_has_an_object_per_file

rm in/cut.png in/sub/text.png in/empty.jpg
"$make" rgb 10 10 1 in/a.tif
run 1 in -o other.d && grep -q 'in/a.*would both become other.d/a.store' err
fact two_pictures_for_one_file_are_refused
rm in/a.tif

mkdir hurt && cp in/d.jpg hurt/a.jpg && cp in/d.jpg hurt/b.jpg && printf 'U%.0s' {1..40} |
    dd of=hurt/b.jpg bs=1 seek=$(($(stat -c %s hurt/b.jpg) / 2)) conv=notrunc 2>/dev/null
run 0 hurt -o hurt.d && grep -q '^2 baked' out && grep -q '^sluice-bake: hurt/b.jpg: libvips: ' err && ! grep -q 'hurt/a.jpg' err
fact a_damaged_picture_that_is_baked_is_named

ln -s absent in/gone.png && mkfifo in/pipe.png && ln -s .. in/sub/circle
run 1 in -o out.d --wrap repeat && grep -q '^0 baked, 5 unchanged, 0 failed' out && [ "$(count . err)" -eq 1 ] &&
    grep -q 'in/gone.png: No such file' err
fact what_a_folder_holds_and_nobody_can_read_is_named_and_the_others_are_baked
rm in/gone.png in/pipe.png in/sub/circle

run 0 in -o one.d --threads 1 --force && run 0 in -o two.d --threads 7 --force &&
    [ "$(find one.d -type f | wc -l)" -eq 5 ] && run 0 --verify two.d/*.store two.d/*/*.store && diff -r one.d two.d
fact any_number_of_threads_writes_the_same_bytes

for format in r8 rg8 rgba8 r16f rg16f rgba16f r32f rg32f rgba32f rgb10a2 rg11b10f rgb9e5; do
    run 0 in/a.png -o "formats.d/$format.store" --format $format || break
done && run 0 --verify formats.d/*.store && [ "$(count '^whole' out)" -eq 12 ]
fact every_format_can_be_named

run 2 && run 2 in && run 2 in -o && run 2 in -o x --nonsense && run 2 in -o x --format rgb565 &&
    run 2 in -o x --cutout 2 && run 2 in -o x --memory 0 && run 2 in -o x --threads 257 &&
    run 2 in -o x --compression 23 && run 2 in -o x --normal --srgb && [ ! -e x ]
fact wrong_usage_is_refused_before_anything_is_done

run 0 --help && grep -q 'usage: sluice-bake' out && grep -qF '[box]' out && grep -qF '[1G]' out
fact help_gives_defaults

run 1 in/a.png -o small.store --memory 1M && grep -q 'in/a.png: .*maxMemory is 1024 KiB' err && grep -q -e '--memory raises' err && [ ! -e small.store ]
fact too_little_memory_is_an_error_that_says_so

# Four texels of one float: 1, NaN, infinity, 2^100. sluice-bake stores one channel as 32-bit floats, or as it is told.
printf 'Pf\n4 1\n-1.0\n\0\0\200\77\0\0\300\177\0\0\200\177\0\0\200\161' >odd.pfm
run 0 odd.pfm -o float.store && grep -q 'odd.pfm: 1 texels held NaN, stored as 0; 1 texels held an infinity, stored as a finite number$' err &&
    run 0 odd.pfm -o half.store --format r16f --json && grep -q 'odd.pfm: 1 texels held NaN.* infinity.*; 1 texels held a number beyond +-65504, stored as that$' err &&
    grep -q '"replaced_texels": 3, "nan_texels": 1, "infinite_texels": 1, "clamped_texels": 1}' out
fact it_says_which_numbers_were_replaced_and_by_what

"$make" plain 4000 4000 0 'bomb.png[interlace,compression=1]' && "$make" plain 4000 4000 0 'bomb.jpg[interlace]' &&
    "$make" plain 4000 4000 0 'plain.png[compression=1]' && run 0 plain.png -o plain.store --memory 64M --threads 1 --compression 1 &&
    for ending in png jpg; do
        run 1 bomb.$ending -o bomb.store --memory 64M --threads 1 && grep -q "bomb.$ending: .*unpacked as a whole; maxMemory is 65536 KiB" err || break
    done && [ ! -e bomb.store ]
fact what_is_unpacked_as_a_whole_counts_for_memory

end_facts
