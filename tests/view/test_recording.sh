#!/usr/bin/env bash
# test_recording.sh FACTS SLUICE-VIEW SLUICE-REPLAY: recordings that the viewer shows, in TAP.
set -u
root=$(cd "$(dirname "$0")/../.." && pwd)
facts=$(realpath "$1") tool=$(realpath "$2") replay=$(realpath "$3")
"$tool" --list-devices >/dev/null 2>&1 || { echo "1..0 # SKIP no Vulkan device"; exit 0; }
# shellcheck source=/dev/null
. "$facts"
validation=--validation
[ -z "${VK_LOADER_LAYERS_DISABLE:-}" ] || validation=

# show ARGUMENTS: a recording in a picture of 500 x 281
# shellcheck disable=SC2086 # nothing, or a word
show() { run 0 --headless --deterministic --fresh --size 500x281 --ui-scale 0.5 $validation "$@"; }
# value NAME: of the figures in out, as a word
value() { sed -n "s/^{\"name\": \"$1\", \"value\": \"\{0,1\}\([^,\"]*\).*/\1/p" "${2:-out}"; }
# play SCRIPT-LINES; at SCRIPT-LINES FRAME: whether the script ends at this frame of the recording
play() { printf '%b\n' "$1" >steps && show --script steps --json run.trace; }
at() { play "$1" && { [ "$(value frame)" = "$2" ] || { echo "$(value frame), not $2" >>err && false; }; }; }

run 0 --room --headless --deterministic --fresh --cache . --size 240x160 --residency sparse --budget 8 --standby 0 \
    --timeout 0.1 --source-fails 6 --frames 90 --record run.trace
fact a_stutter_is_recorded
show --cursor 4000 --frames 1 --json run.trace && "$replay" run.trace --json >replayed && [ "$(value frames)" -ge 90 ] &&
    [ "$(value frames)" -le 91 ] && # failures may be reported behind the last frame
    for name in tiles_requested tiles_allocated tiles_mapped tiles_standby tiles_canceled tiles_failed tiles_given_up \
        slots_free heaps mapped_total unmapped_total canceled_total failed_total restored_total hash textures; do
        [ "$(value $name)" = "$(value $name replayed)" ] || { echo "$name differs" >>err && false; break; }
    done && [ "$(value failed_total)" -gt 0 ] && [ "$(value unmapped_total)" -gt 0 ]
fact the_last_frame_is_what_sluice_replay_ends_with
last=$(value frame)
# Cut at whole blocks, sluice-replay tells the hash of the calls before.
agree=0
for size in $(seq 5000 6000 "$(stat -c %s run.trace)"); do
    head -c "$size" run.trace >cut.trace
    "$replay" cut.trace >/dev/null 2>words
    events=$(sed -n 's/.* after \([0-9]*\) events, hash .*/\1/p' words) hash=$(sed -n 's/.*, hash //p' words)
    show --cursor 4000 --frames 1 --json cut.trace && [ "$(value events)" = "$events" ] && [ "$(value hash)" = "$hash" ] &&
        grep -q 'cut.trace: trace is damaged at byte [0-9]*: .*; frames before that are shown' err && agree=$((agree + 1))
done
[ $agree -ge 3 ]
fact a_cut_file_is_shown_up_to_the_cut_and_named
printf '1 frame 40\n2 key m\n3 key k\n5 screenshot there.png\n' >there
printf '1 key m\n2 key k\n3 frame 80\n4 frame 5\n5 frame 77\n6 frame 40\n8 screenshot back.png\n' >back
show --script there --json run.trace && mv out first && show --script back --json run.trace && cmp out first &&
    cmp there.png back.png
fact there_and_back_is_the_same
at '1 key N\n2 key right\n3 key N' 3 && at '1 frame 50\n2 key shift+n\n4 key left' 48 && at '1 key End' "$last" &&
    at '1 key End\n2 key N\n4 key Home\n6 key left' 0 && at '1 key pagedown' "$last" && at '1 key space\n21 key P\n22 quit' 20
fact keys_step_play_and_jump
play '1 key F'
first=$(value frame)
[ "$first" -gt 0 ] && [ "$(value failed)" -gt 0 ] && at "1 frame $first\n2 key F\n4 key shift+F" "$first" &&
    at "1 frame $((first - 1))" "$((first - 1))" && [ "$(value failed)" = 0 ]
fact f_finds_frames_in_which_reads_failed
play '1 key E'
first=$(value frame)
[ "$first" -gt 0 ] && [ "$(value evicted_wanted)" -gt 0 ]
fact e_finds_frames_in_which_wanted_tiles_were_evicted
# The graphs of the picture go from x = 8 to 492.
at '1 click 250 100' $((242 * (last + 1) / 484)) && play '1 key G\n3 set graph-span all\n5 click 370 115' &&
    [ "$(value frame)" -gt 0 ] && at '1 drag 250 100 400 100' $((392 * (last + 1) / 484))
fact clicks_and_drags_go_to_the_frame_under_the_mouse
quiet=0 # a frame behind some loads, without one of its own
for frame in $(seq 20 "$last"); do
    play "1 frame $frame" && [ "$(value loaded)$(value failed)$(value canceled)" = 000 ] && quiet=$frame && break
done
play "1 frame $quiet\n2 set event-reason answered\n2 key K\n5 click 20 145" && [ "$(value frame)" -lt "$quiet" ] &&
    [ $(($(value loaded) + $(value failed))) -gt 0 ]
fact a_click_on_an_event_goes_to_its_frame
show --cursor 33 --frames 1 --json run.trace && [ "$(value frame)" = 33 ]
fact a_recording_opens_at_a_frame
{
    number=1
    for key in 1 2 3 4 5 6 7 8 9 V B L O R Q W A S D I J M T U G Y C X comma period [ ] shift+R shift+N ctrl+R ctrl+T tab ctrl+1 alt+1 F5 F10 F1 F1 H H; do
        echo "$number key $key"
        number=$((number + 2))
    done
    echo "$number click 30 60 right"
    echo "$((number + 3)) quit"
} | grep -v 'comma\|period' >everything
show --script everything run.trace
fact no_key_of_scenes_harms_a_recording
# The table of textures, the inspector of a row, its levels, slots of the map, the device and the controls.
look() {
    printf '1 key End\n2 key T\n7 click 275 132\n%b\n20 screenshot %s\n21 quit\n' "$1" "$2" >looks
    show --script looks full.trace
}
run 0 --room --headless --deterministic --fresh --cache . --size 240x160 --residency sparse --budget 4 --frames 20 \
    --record full.trace && look '14 hover 5 275' inspected.png && look '14 hover 40 160' hovered.png &&
    ! cmp -s inspected.png hovered.png && look '10 key M\n11 set memory-colors age\n14 hover 283 138' slot.png &&
    look '10 key M\n11 set memory-colors age\n14 hover 5 275' slots.png && ! cmp -s slot.png slots.png &&
    look '10 key J\n11 key U\n14 hover 5 275' words.png
fact tiles_and_slots_are_named_under_the_mouse
: >empty.trace
echo 'This is a text.' >text.trace
head -c 20 run.trace >short.trace
run 1 --headless empty.trace && grep -q 'empty.trace: is empty' err && run 1 --headless text.trace &&
    grep -q 'text.trace: is no recording' err && run 1 --headless short.trace &&
    grep -q 'short.trace: trace is damaged at byte' err && run 1 --headless "$root/tests/data/demand_random.trace" &&
    grep -q 'demand_random.trace: the trace is a recording of demand loading' err && run 1 --headless missing.trace &&
    grep -q 'missing.trace: No such file' err
fact files_that_are_no_recordings_are_named_with_the_cause
cp run.trace unnamed
printf '1 drop unnamed\n3 frame 7\n5 screenshot dropped.png\n' >drop
show --room --render-scale 0.2 --cache . --script drop --json && [ "$(value frame)" = 7 ] &&
    printf '1 drop %s\n5 quit\n' pictures.ppm >drop && { printf 'P6 64 64 255\n' && head -c 12288 /dev/zero; } >pictures.ppm &&
    show --render-scale 0.2 --cache . --script drop run.trace && grep -q 'pictures.ppm' out
fact recordings_are_dropped_onto_scenes_and_scenes_onto_recordings
echo '2 record again.trace' >record
show --script record run.trace && grep -q 'cannot be recorded; use' err && echo '2 frame 3' >record &&
    run 0 --room --headless --deterministic --fresh --cache . --size 160x160 --script record && grep -q 'no recording is shown' err
fact events_that_do_not_apply_are_refused_by_words
pin() {
    printf '2 key G\n%b\n40 hover 5 5\n44 screenshot %s\n45 quit\n' "$1" "$2" >pins
    run 0 --room --headless --deterministic --fresh --cache . --size 500x281 --ui-scale 0.5 --render-scale 0.2 --budget 8 --script pins
}
pin '30 click 420 72' plain.png && pin '30 click 477 108' pinned.png && pin '30 click 477 108\n33 click 477 108' again.png &&
    ! cmp -s plain.png pinned.png && cmp plain.png again.png
fact a_click_in_a_graph_of_a_scene_keeps_its_values_and_another_lets_go
shown=0
for trace in "$root"/tests/data/*.trace; do
    case $trace in *demand_*) continue ;; esac
    show --frames 2 --json "$trace" && [ "$(value hash)" ] && shown=$((shown + 1))
done
[ $shown -ge 6 ]
fact golden_recordings_are_shown
end_facts
