#!/usr/bin/env bash
# test_hostile.sh SLUICE_BAKE MAKE_PICTURE: names, places and limits that nobody expects. Prints TAP.
bake=$(realpath "$1") make=$(realpath "$2")
# shellcheck source=/dev/null
. "$(dirname "${BASH_SOURCE[0]}")/facts.sh"
# shellcheck disable=SC2034 # it is what run runs
tool=$bake

lines() { grep -c . "$1"; }

"$make" rgb 300 200 1 a.png && "$make" rgb 2000 1500 2 large.png
fact pictures_can_be_made

mkdir odd && for name in $'new\nline' 'sp ace' $'\xc3\xbcml\xe6\x9c\xa8' 'opt[page=2]' '-dash' '%s%n' $'bad\xff' 'a:b' $'\e[31m'; do
    cp a.png "odd/$name.png"
done
run 0 odd -o odd.d && [ ! -s err ] && [ "$(lines out)" -eq 11 ] && ! LC_ALL=C grep -q $'[\e\xff]' out &&
    grep -q '^9 baked, 0 unchanged, 0 failed' out && [ -s $'odd.d/new\nline.store' ] && [ -s 'odd.d/opt[page=2].store' ] &&
    run 0 --verify odd.d/* && [ "$(lines out)" -eq 9 ]
fact any_name_will_do_and_is_one_line

sha256sum a.png >before && ln a.png hard.png && ln -s a.png soft.png
for output in a.png ./a.png hard.png soft.png; do
    run 1 a.png -o $output && grep -q 'a.png: the store would take its place' err || break
done && sha256sum --quiet -c before && [ ! -e a.png.sluice-part ]
fact a_picture_is_not_replaced_by_its_store

cp a.png x.store.sluice-part && run 1 x.store.sluice-part -o x.store && grep -q 'x.store.sluice-part: the store would take its place' err &&
    cmp a.png x.store.sluice-part && rm x.store.sluice-part
fact a_picture_at_the_part_file_is_not_emptied

echo older >locked.store && chmod 444 locked.store && ln -s a.png link.store && ln a.png planted.store.sluice-part
run 1 large.png -o locked.store && grep -q 'locked.store: is there already and is read-only' err &&
    [ "$(cat locked.store)" = older ] && run 1 large.png -o link.store && grep -q 'link.store: is a symbolic link' err &&
    [ -L link.store ] && run 1 large.png -o planted.store && grep -q 'planted.store.sluice-part: has hard links' err &&
    sha256sum --quiet -c before && [ -e planted.store.sluice-part ] && rm link.store planted.store.sluice-part
fact what_was_there_stays_when_a_store_is_refused

mkfifo pipe && mkdir -p folder/a.store
run 1 a.png -o pipe && grep -q 'pipe: is there already and is no regular file' err && [ -p pipe ] && [ ! -e pipe.sluice-part ] &&
    run 1 a.png -o folder && grep -q 'a.store: is there already' err && [ -d folder/a.store ]
fact what_is_no_file_is_not_replaced

run 1 a.png -o a.png/deep/a.store && grep -q 'cannot be made: Not a directory' err && [ "$(lines err)" -eq 1 ]
fact a_folder_that_cannot_be_made_is_named

(ulimit -f 64 && run 1 large.png -o limited.store --threads 4) && [ "$(lines err)" -eq 1 ] &&
    grep -q 'limited.store.sluice-part: at [0-9]*: File too large' err && [ ! -e limited.store ] && [ ! -e limited.store.sluice-part ]
fact a_disk_that_takes_no_more_is_an_error_that_leaves_nothing

"$bake" large.png -o twice.store --force >out 2>err &
first=$!
"$bake" large.png -o twice.store --force >out2 2>err2
second=$?
wait $first
first=$?
[ $((first + second)) -le 1 ] && run 0 --verify twice.store && [ ! -e twice.store.sluice-part ]
fact two_bakes_of_one_file_do_not_mix

"$make" rgb 1 1 1 one.png && "$make" gray 1 65536 1 tall.png && "$make" rgba 65536 1 1 wide.png &&
    run 0 one.png tall.png wide.png -o sizes.d --filter kaiser --wrap repeat && run 0 --verify sizes.d/*.store
fact pictures_of_one_texel_in_a_direction_are_baked

end_facts
