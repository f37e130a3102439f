#!/usr/bin/env bash
# test_pbrt.sh FACTS SLUICE-VIEW DEMAND-PBRT SLUICE-REPLAY FLIP-OF-PICTURES: scenes of pbrt in the viewer without a window.
# Prints TAP.
set -u
here=$(cd "$(dirname "$0")" && pwd)
facts=$(realpath "$1") tool=$(realpath "$2") demand=$(realpath "$3") replay=$(realpath "$4") flip=$(realpath "$5")
"$tool" --list-devices >/dev/null 2>&1 || { echo "1..0 # SKIP no Vulkan device"; exit 0; }
# shellcheck source=/dev/null
. "$facts"

check() { python3 "$here/pbrt_scene.py" "$@" >>err; }
python3 "$here/pbrt_scene.py" make . && mkdir -p cache/pictures || exit 1
# The stage of the sanitizers switches layers off.
validation=--validation
[ -z "${VK_LOADER_LAYERS_DISABLE:-}" ] || validation=
# shellcheck disable=SC2086 # nothing, or a word
view() { run 0 --headless --deterministic --fresh $validation --cache cache --panels off --render-scale 1 --size 160x160 "$@"; }
# Pictures of demand-pbrt: all is loaded before the first ray, and nothing is missing.
truth() { "$demand" wall.pbrt --preload --dim 160x160 --cache cache/pictures "$@" >out 2>err; }

truth --file truth.png
if grep -q 'addresses of buffers' err; then
    echo "1..0 # SKIP the device cannot load on demand"
    exit 0
fi
cat >script <<'END'
0 screenshot 0.png
1 screenshot 1.png
2 screenshot 2.png
3 screenshot 3.png
20 screenshot sharp.png
21 hold w 30
60 screenshot forward.png
61 key Home
80 screenshot back.png
81 hold d 30
120 screenshot right.png
END
view wall.pbrt --most-samples 1 --script script --csv figures.csv && check holes 0.png 1.png 2.png 3.png && check gray 0.png &&
    ! check gray 3.png && ! check near 3.png sharp.png 4 && check near 3.png sharp.png 40 && ! check near 2.png sharp.png 40
fact pictures_are_gray_boxes_first_and_then_coarse_texels_without_holes
check near sharp.png truth.png 1 && ! check near 1.png truth.png 1
fact the_sharp_picture_is_that_of_everything_loaded
# 30 frames of 1/60 s at 2.5 units of the viewer per second, of which the scene's diagonal, 20.09, is 20. +x is left.
truth --look-from 0/1.255628/0/0/20/0/0/0/1 --file truth-forward.png && check near forward.png truth-forward.png 2 &&
    ! check near forward.png sharp.png 2
fact w_walks_ahead
truth --look-from -1.255628/0/0/-1.255628/20/0/0/0/1 --file truth-right.png && check near right.png truth-right.png 2 &&
    ! check near right.png sharp.png 2
fact d_walks_to_the_right_of_a_left_handed_picture
cmp back.png sharp.png
fact home_comes_back_to_the_scenes_camera
awk -F , 'NR == 2 { first = $12 } NR == 20 { last = $12 } END { exit !(first == 0 && last == 100) }' figures.csv
fact the_part_that_is_sharp_grows_from_nothing_to_everything

cat >budgets <<'END'
2 set motion fly
3 hold w 42
46 hold a 40
87 hold d 80
168 set budget 4
190 screenshot short.png
END
view wall.pbrt --size 320x320 --most-samples 1 --speed 10 --script budgets --frames 192 --csv budgets.csv &&
    awk -F , 'NR == 168 { before = $2 } NR == 193 { after = $2 } END { print before, after
    exit !(before > 6 && after <= 4.2 && after > 0) }' budgets.csv >>err && check holes short.png
fact a_smaller_budget_takes_memory_at_once_and_leaves_a_complete_picture

# Frozen wants leave coarse levels; the truth has all.
cat >frozen <<'END'
16 key l
17 set lod-bias 0
24 screenshot coarse.png
25 key 8
50 screenshot difference.png
51 key l
70 screenshot same.png
71 key 1
74 screenshot full.png
END
view wall.pbrt --most-samples 1 --lod-bias 3 --difference-as pixels --gain 16 --script frozen &&
    check differs coarse.png truth.png difference.png && ! check differs truth.png truth.png difference.png &&
    check differs truth.png truth.png same.png && check near full.png truth.png 1
fact view_8_is_the_difference_to_the_picture_of_everything_loaded
printf '18 screenshot a.png\n19 set compare-as flicker\n24 screenshot b.png\n25 set compare-as difference\n45 quit\n' >sets
view wall.pbrt --most-samples 1 --lod-bias 3 --compare-to b --b lod-bias=0 --difference-as flip --json --script sets &&
    check near b.png truth.png 1 && ! check near a.png truth.png 1 && value=$("$flip" a.png b.png) &&
    [[ $value == 0.[0-9]* ]] && grep -q "\"FLIP\", \"value\": $value," out
fact b_has_a_loader_and_settings_of_its_own_and_flip_is_that_of_both_pictures

truth --render-mode path --samples 4 --file truth-path.png && view wall.pbrt --render-mode path --most-samples 4 \
    --frames 30 --screenshot path.png && check near path.png truth-path.png 1 && ! check near path.png sharp.png 8
fact a_standing_camera_gathers_the_samples_of_paths

cat >panels <<'END'
12 click 40 130 right
15 do evict
16 key t
16 key u
17 screenshot a.png
18 key k
18 key m
19 screenshot b.png
20 key y
20 key j
21 key 3
21 key g
22 screenshot c.png
23 key 5
23 key l
24 record run.trace
24 set view 7
25 hold s 5
30 key l
40 key Ctrl+R
END
for n in 1 2; do
    mkdir -p "run$n" && view wall.pbrt --panels on --size 640x360 --render-scale 0.25 --script panels --frames 42 &&
        grep -q 'not for textures of pbrt scenes' err && mv ./?.png "run$n" || break
done && cmp run1/a.png run2/a.png && cmp run1/b.png run2/b.png && cmp run1/c.png run2/c.png && ! cmp -s run1/a.png run1/b.png
fact a_right_click_finds_the_texture_and_panels_are_the_same_in_two_runs
"$replay" run.trace >out && grep -q '^as_recorded *yes' out
fact what_the_loader_decides_is_recorded

sed 's/"matte" "rgb Kd" \[ 0.2/"matte" "rgb Kd" [ "/' wall.pbrt >broken.pbrt
sed 's/^WorldEnd/Shape "plymesh" "string filename" "gone.ply"/' wall.pbrt >gone.pbrt
run 1 --headless --frames 2 --cache cache broken.pbrt && grep -q 'broken.pbrt:14:' err && run 1 --headless none.pbrt &&
    grep -q 'none.pbrt' err && view gone.pbrt --frames 2 && grep -q 'gone.pbrt:18:.*' err
fact a_broken_scene_is_refused_by_file_and_line_and_a_missing_mesh_is_named
printf '2 drop broken.pbrt\n4 drop wall.pbrt\n20 screenshot dropped.png\n' >drops
view --room --still --most-samples 1 --script drops && grep -q 'broken.pbrt:14:' err && cmp dropped.png sharp.png
fact a_scene_that_is_dropped_is_shown_and_a_broken_one_leaves_the_scene
# Windows do not wait for what rays asked for.
printf '5 hold d 20\n60 key Shift+R\n' >moves
# shellcheck disable=SC2086
run 0 wall.pbrt --headless --fresh $validation --cache cache --size 160x160 --script moves --frames 90 --json &&
    grep -q '"tiles loaded", "value": [1-9]' out
fact frames_that_do_not_wait_are_valid_too
end_facts
