#!/usr/bin/env bash
# test_outputs.sh SLUICE_INFO SLUICE_REPLAY TEXTURE TRACE: what programs leave behind at the names of
# their outputs when something is in the way. Prints TAP. TEXTURE: a file that sluice-info shows.
info=$(realpath "$1") replay=$(realpath "$2") texture=$(realpath "$3") trace=$(realpath "$4")
# shellcheck source=/dev/null
. "$(dirname "${BASH_SOURCE[0]}")/../bake/facts.sh"
cp "$texture" a.texture && cp "$trace" a.trace && chmod u+w a.texture a.trace
sha256sum a.texture a.trace >before

# Devices are named through links of our own only: a program with a defect, run by root, would take
# those of the machine away.
as_info() { tool=$info run "$1" a.texture --png "$2"; }
as_replay() { tool=$replay run "$1" a.trace --record "$2"; }
said() { grep -q -- "$1" err; }
unchanged() { sha256sum --quiet -c before; }

as_info 0 a.png && [ -s a.png ] && as_replay 0 b.trace && [ -s b.trace ] && [ -z "$(find . -name '*.sluice-part')" ]
fact outputs_appear_without_part_files

for name in taken.png taken.trace; do
    echo download >"$name.part"
done
as_info 0 taken.png && as_replay 0 taken.trace && [ "$(cat taken.png.part taken.trace.part)" = "$(printf 'download\ndownload')" ]
fact half_files_of_other_programs_stay

mkdir folder && good=0
for as in as_info as_replay; do
    $as 1 folder && said 'folder: is there already and is a folder' || good=1
done
[ "$good" = 0 ] && [ -d folder ] && [ ! -e folder.sluice-part ]
fact a_folder_stays

echo older >locked && chmod 444 locked && good=0
for as in as_info as_replay; do
    $as 1 locked && said 'locked: is there already and is read-only' || good=1
done
[ "$good" = 0 ] && [ "$(cat locked)" = older ] && [ ! -e locked.sluice-part ]
fact a_read_only_file_stays

echo older >elsewhere && ln -s elsewhere link && good=0
for as in as_info as_replay; do
    $as 1 link && said 'link: is a symbolic link' || good=1
done
[ "$good" = 0 ] && [ -L link ] && [ "$(cat elsewhere)" = older ]
fact a_link_is_neither_followed_nor_replaced

# A node of our own where we may make and open one.
if ! mknod null c 1 3 2>/dev/null || ! (: >null) 2>/dev/null; then
    rm -f null
    ln -s /dev/null null
fi
kind=$(stat -c %F null) good=0
for as in as_info as_replay; do
    $as 0 null || good=1
done
[ "$good" = 0 ] && [ "$(stat -c %F null)" = "$kind" ] && [ ! -e null.sluice-part ]
fact a_device_takes_the_bytes_and_stays

ln -s /dev/stdout stdout && "$info" a.texture --png stdout 2>err | cat >piped.png && cmp piped.png a.png && [ -L stdout ]
fact standard_output_that_is_a_pipe_takes_a_picture

if [ -w /dev/full ]; then
    ln -s /dev/full full && as_info 1 full && said 'full: .*No space left' && as_replay 1 full && said 'full: .*No space left' &&
        [ -L full ] && [ -c full ]
    fact a_full_disk_is_named_with_its_file
fi

echo older >short.png && echo older >short.trace && (
    ulimit -f 0
    trap '' XFSZ
    as_info 1 short.png && as_replay 1 short.trace
) && [ "$(cat short.png)" = older ] && [ "$(cat short.trace)" = older ] && [ -z "$(find . -name '*.sluice-part')" ]
fact a_write_that_fails_leaves_what_was_there

echo victim >victim && ln -s victim planted.sluice-part && good=0
for as in as_info as_replay; do
    $as 1 planted && said 'planted.sluice-part: is a symbolic link' || good=1
done
rm planted.sluice-part && ln victim planted.sluice-part
for as in as_info as_replay; do
    $as 1 planted && said 'planted.sluice-part: has hard links' || good=1
done
[ "$good" = 0 ] && [ "$(cat victim)" = victim ] && [ ! -e planted ]
fact what_is_planted_at_the_part_file_is_not_written_through

echo half >killed.sluice-part && as_info 0 killed && cmp killed a.png && [ ! -e killed.sluice-part ]
fact a_part_file_that_a_killed_program_left_is_taken_over

if command -v flock >/dev/null; then
    echo older >twice && good=0
    exec 9>twice.sluice-part && flock -n 9 || good=1
    for as in as_info as_replay; do
        $as 1 twice && said 'twice: another writer is at work' || good=1
    done
    exec 9>&-
    [ "$good" = 0 ] && [ "$(cat twice)" = older ] && [ -e twice.sluice-part ]
    fact a_second_writer_is_refused_and_the_first_keeps_its_file
fi

good=0
ln -s a.texture soft.texture && ln a.texture hard.texture && ln -s a.trace soft.trace && ln a.trace hard.trace || good=1
for name in a.texture ./a.texture soft.texture hard.texture; do
    as_info 1 $name && said "$name: would replace a file that is read" && unchanged || good=1
done
for name in a.trace ./a.trace soft.trace hard.trace; do
    as_replay 1 $name && said "$name: would replace a file that is read" && unchanged || good=1
done
rm soft.* hard.*
[ "$good" = 0 ]
fact an_input_is_not_replaced_by_any_of_its_names

cp a.texture x.png.sluice-part && cp a.trace x.trace.sluice-part
tool=$info run 1 x.png.sluice-part --png x.png && said 'would replace' && cmp a.texture x.png.sluice-part &&
    tool=$replay run 1 x.trace.sluice-part --record x.trace && said 'would replace' && cmp a.trace x.trace.sluice-part
fact an_input_at_the_part_file_is_not_emptied

# What is printed goes nowhere, not into what takes the place of the closed stream.
long=${trace%/*}/random_calls.trace # more than one buffer
"$replay" "$long" --dump --record c.trace <&- >&- 2>err
"$replay" "$long" --dump --record d.trace 2>err >/dev/null && cmp c.trace d.trace
fact what_is_printed_to_closed_streams_is_in_no_file

end_facts
