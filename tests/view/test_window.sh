#!/usr/bin/env bash
# test_window.sh FACTS SLUICE-VIEW LOSE-DEVICE [DROP-FILES]: a real window with real input, in an X server of its own, in TAP.
set -u
here=$(cd "$(dirname "$0")" && pwd)
facts=$(realpath "$1") tool=$(realpath "$2") lose_device=$(realpath "$3") drop_files=${4:+$(realpath "$4")}
for program in Xvfb xdotool xclip; do
    command -v $program >/dev/null || { echo "1..0 # SKIP no $program"; exit 0; }
done
"$tool" --list-devices >/dev/null 2>&1 || { echo "1..0 # SKIP no Vulkan device"; exit 0; }
# shellcheck source=/dev/null
. "$facts"

mkfifo number
Xvfb -displayfd 3 -screen 0 1000x700x24 -nolisten tcp 3>number >xvfb.log 2>&1 &
server=$!
# shellcheck disable=SC2154 # facts.sh makes the folder
trap 'kill $viewer $server 2>/dev/null; wait 2>/dev/null; rm -rf "$folder"' EXIT
viewer=
read -r display <number
export DISPLAY=:$display XDG_CONFIG_HOME=$folder/config

# until SECONDS COMMAND...: whether the command succeeds within this time
until_true() {
    local tries=$(($1 * 10))
    shift
    while ! "$@" >/dev/null 2>&1; do
        tries=$((tries - 1))
        [ $tries -gt 0 ] || return 1
        sleep 0.1
    done
}
open_viewer() {
    "$tool" --room --size 480x270 --frame-cap 30 --still "$@" >out 2>err &
    viewer=$!
    until_true 20 xdotool search --name Sluice && window=$(xdotool search --name Sluice | tail -n 1) &&
        xdotool mousemove --window "$window" 240 200
}
size_is() { xdotool getwindowgeometry "$window" | grep -q "Geometry: $1"; }
mv_picture() { mv sluice-view-??.png "$1"; }
picture() { # picture FILE [KEY]: F12 writes the next number; with Shift, the panels are on it
    xdotool key "${2:-F12}"
    until_true 20 mv_picture "$1"
}
png_size() { od -An -tu1 -j16 -N8 "$1" | awk '{print $3 * 256 + $4 "x" $7 * 256 + $8}'; }
ended_well() {
    local tries=200 got=0
    while kill -0 "$viewer" 2>/dev/null && [ $tries -gt 0 ]; do
        tries=$((tries - 1))
        sleep 0.1
    done
    [ $tries -gt 0 ] && { wait "$viewer" || got=$?; [ $got -eq 0 ]; }
}

# The stage of the sanitizers switches layers off.
validation=--validation
[ -z "${VK_LOADER_LAYERS_DISABLE:-}" ] || validation=
# shellcheck disable=SC2086 # nothing, or a word
open_viewer $validation && sleep 1 && picture first.png && [ "$(png_size first.png)" = 480x270 ]
fact a_window_opens_and_f12_writes_its_picture
xdotool key ctrl+F12 && until_true 20 mv_picture large.png && [ "$(png_size large.png)" = 960x540 ]
fact ctrl_f12_writes_a_picture_of_twice_the_size
xdotool mousedown 1 && sleep 0.2 && xdotool mousemove_relative 60 10 && sleep 0.2 && xdotool mouseup 1 &&
    picture dragged.png && ! cmp -s first.png dragged.png
fact a_drag_turns_the_camera
xdotool key 2 && picture levels.png && ! cmp -s dragged.png levels.png
fact keys_choose_views
copies() { xdotool key c && clipboard_has "$1"; }
clipboard_has() { xclip -o -selection clipboard | grep -q "$1"; }
# View 4 shows what the camera wants, over what is loaded after a second.
words=()
xdotool key 4 period period && sleep 1 && picture wanted.png && until_true 10 copies ' --camera ' &&
    eval "words=($(xclip -o -selection clipboard))" &&
    "$tool" "${words[@]:1}" --headless --deterministic --fresh --panels off --frames 30 --screenshot again.png >out2 2>err2 &&
    cmp wanted.png again.png
fact the_copied_command_line_draws_the_picture_again
xdotool key comma comma 2
xdotool key bracketleft c && until_true 10 clipboard_has '^sluice-view.* --budget '
fact the_command_line_is_in_the_clipboard
sizes=()
for i in {1..100}; do
    sizes+=(windowsize "$window" $((300 + i % 40 * 10)) $((200 + i % 30 * 7)) sleep 0.02)
done
xdotool "${sizes[@]}" windowsize "$window" 700 400
until_true 10 size_is 700x400 && picture resized.png && [ "$(png_size resized.png)" = 700x400 ]
fact the_picture_has_the_size_of_the_window_after_100_resizes
xdotool key F11 && until_true 10 size_is 1000x700 && xdotool key F11 && until_true 10 size_is 700x400
fact f11_fills_the_screen_and_comes_back
printf 'P6 2 2 255\n%012d' 0 >black.ppm
if [ -n "$drop_files" ]; then
    "$drop_files" "$window" "$folder/none.glb" && until_true 10 grep -q none.glb err &&
        "$drop_files" "$window" "$folder/black.ppm" "$folder/none.png" && until_true 10 grep -q none.png err &&
        xdotool mousemove --window "$window" 240 200 && until_true 20 copies "^sluice-view $folder/black.ppm $folder/none.png"
    fact dropped_files_are_opened_and_one_that_cannot_be_read_leaves_the_scene
    budget_of() { sed -n 's/^budget //p' "$1"; }
    room=$(ls config/sluice/view-*.settings) && xdotool key bracketleft && until_true 20 copies '--budget'
fi
xdotool mousemove --window "$window" 240 200 key ctrl+q && ended_well
fact ctrl_q_ends_it_with_silent_validation
cat config/sluice/view-*.settings | grep -q '^budget '
fact settings_are_kept
if [ -n "$drop_files" ]; then
    [ "$(find config/sluice -name 'view-*.settings' | wc -l)" = 2 ] && budgets=() &&
        for file in "$room" config/sluice/view-*.settings; do budgets+=("$(budget_of "$file")"); done &&
        [ "$(printf '%s\n' "${budgets[@]}" | sort -u | wc -l)" = 2 ]
    fact a_dropped_scene_has_settings_of_its_own_and_those_of_the_one_before_stay
fi
cp black.ppm 'a b.ppm' && recent=config/sluice/view-recent.list
open_viewer && sleep 1 && xdotool key ctrl+o && xdotool type --delay 20 "$folder/a b.ppm" && xdotool key Return &&
    until_true 20 copies "^sluice-view '$folder/a b.ppm'" && xdotool key ctrl+q && ended_well &&
    [ "$(sed -n 2p "$recent")" = "$folder/a b.ppm" ]
fact a_typed_path_is_opened_and_is_recent_afterwards
echo damaged >"$recent" && open_viewer --fresh && xdotool key ctrl+q && ended_well && [ "$(cat "$recent")" = damaged ] && [ ! -s err ] &&
    open_viewer && xdotool key ctrl+q && ended_well && grep -q "view-recent.list is damaged: it is" err &&
    [ "$(cat "$recent.damaged")" = damaged ]
fact a_damaged_list_of_recent_files_is_set_aside_but_for_fresh
kept=$(cat config/sluice/view-*.settings) && open_viewer --fresh --budget 77 && sleep 1 && xdotool key ctrl+q && ended_well &&
    [ "$kept" = "$(cat config/sluice/view-*.settings)" ]
fact fresh_leaves_the_settings_that_were_kept
mkdir many
for i in {1..5000}; do printf 'P6 2 2 255\n%012d' 0 >"many/$i.ppm"; done
open_viewer many && xdotool key ctrl+q && ended_well
fact it_can_be_closed_while_the_scene_is_loading
has_moved() { picture later.png shift+F12 && ! cmp -s early.png later.png; }
open_viewer many && picture early.png shift+F12 && until_true 3 has_moved &&
    xdotool key Escape && until_true 10 copies '^sluice-view --room --size' &&
    xdotool key ctrl+q && ended_well
fact loading_says_how_far_it_is_and_escape_opens_the_room_instead
echo '2 drop none.glb' >drops
open_viewer --script drops many && until_true 20 copies '^sluice-view --room --size' && grep -q none.glb err &&
    xdotool key ctrl+q && ended_well
fact a_file_that_cannot_be_opened_while_the_first_scene_is_loading_opens_the_room
# A thread reads the scene again, and that of B: F12 writes meanwhile what was shown before. V draws a divider.
printf 'v -1 -1 0\nv 1 -1 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n' >slow.obj
{ sed 's/v 0 1 0/v 0.5 1 0/' slow.obj && yes '# a line that takes time to read, as the others do' | head -n 3000000; } >long.obj
is_another() { picture later.png && ! cmp -s first.png later.png; }
keeps_drawing() { xdotool key "$1" && picture early.png && cmp first.png early.png && until_true 60 is_another && mv later.png first.png; }
open_viewer slow.obj && until_true 20 copies '^sluice-view slow.obj' && picture first.png && mv long.obj slow.obj && keeps_drawing F5
fact f5_does_not_stop_the_window_while_the_scene_is_read
keeps_drawing v && [ ! -s err ] && xdotool key ctrl+q && ended_well
fact v_does_not_stop_the_window_while_the_scene_of_b_is_read
# 200 million lines take longer to read than the room takes to open.
yes 'Translate 0 0 0' | head -n 10000000 | gzip -1 >lines.pbrt.gz
{ printf 'Camera "perspective"\nWorldBegin\n' && yes 'Include "lines.pbrt.gz"' | head -n 20 && echo 'Shape "sphere"'; } >long.pbrt
open_viewer long.pbrt && picture early.png shift+F12 && xdotool key Escape &&
    until_true 10 copies '^sluice-view --room --size' && ! grep . err && xdotool key ctrl+q && ended_well
fact neither_escape_nor_the_end_waits_until_a_file_of_pbrt_is_read
# Programs are compiled on a thread: the window has no picture at first. Rays are traced then; the size of the window
# and of the film change meanwhile.
is_drawn() { picture traced.png && python3 "$here/pbrt_scene.py" colored traced.png; }
export GALLIVM_PERF=nopt
# shellcheck disable=SC2086
python3 "$here/pbrt_scene.py" make . && open_viewer $validation --cache cache --panels off wall.pbrt &&
    until_true 60 copies '^sluice-view wall.pbrt' && until_true 60 is_drawn && sleep 1 && picture traced.png && xdotool keydown w sleep 0.5 keyup w &&
    picture walked.png && ! cmp -s traced.png walked.png && xdotool windowsize "$window" 360 300 &&
    until_true 10 size_is 360x300 && picture small.png && [ "$(png_size small.png)" = 360x300 ] && xdotool key Home sleep 1 &&
    picture home.png && python3 "$here/pbrt_scene.py" holes walked.png small.png home.png &&
    xdotool key ctrl+q && ended_well
fact a_scene_of_pbrt_is_traced_in_a_window_with_silent_validation
# Xvfb offers all modes; the size of the settings follows the window, and the window the settings.
printf '5 set size 360x300\n40 set vsync off\n60 quit\n' >sizes
# shellcheck disable=SC2086
open_viewer $validation --vsync mailbox --json --script sizes && until_true 20 size_is 360x300 && ended_well && [ ! -s err ] &&
    grep -q '"present mode", "value": "IMMEDIATE"' out
fact the_window_follows_size_and_vsync_of_the_settings
open_viewer --vsync mailbox --json && xdotool windowsize "$window" 500 300 && until_true 60 copies ' --size 500x300' &&
    xdotool key ctrl+q && ended_well && grep -q '"present mode", "value": "MAILBOX"' out
fact the_settings_follow_the_size_that_somebody_gave_the_window
export LOSE_AFTER=20
LD_PRELOAD=$lose_device open_viewer
tries=600
while kill -0 "$viewer" 2>/dev/null && [ $tries -gt 0 ]; do tries=$((tries - 1)); sleep 0.1; done
! kill -0 "$viewer" 2>/dev/null && { wait "$viewer"; [ $? -eq 1 ]; } && grep -q DEVICE_LOST err
fact a_lost_device_is_named_and_ends_it
end_facts
