#!/usr/bin/env bash
# test_headless.sh FACTS SLUICE-VIEW LOSE-DEVICE SLUICE-REPLAY FLIP-OF-PICTURES SLUICE-TRADEOFF
# [SLUICE-BAKE]: the viewer without a window, in TAP.
set -u
here=$(cd "$(dirname "$0")" && pwd)
facts=$(realpath "$1") tool=$(realpath "$2") lose_device=$(realpath "$3") replay=$(realpath "$4") flip=$(realpath "$5") tradeoff=$(realpath "$6") bake=${7:+$(realpath "$7")}
"$tool" --list-devices >/dev/null 2>&1 || { echo "1..0 # SKIP no Vulkan device"; exit 0; }
# shellcheck source=/dev/null
. "$facts"

cat >script <<'END'
4 key 2
6 click 200 120 right
8 key t
10 key g
11 record run.trace
16 screenshot with-panels.png
18 key H
20 screenshot picture.png
21 key F1
22 set budget 16
23 key Ctrl+R
24 quit
END
# The stage of the sanitizers switches layers off.
validation=--validation
[ -z "${VK_LOADER_LAYERS_DISABLE:-}" ] || validation=
# shellcheck disable=SC2086 # nothing, or a word
view() { run 0 --room --headless --deterministic --size 480x270 --residency paged $validation "$@"; }

view --script script --csv first.csv --screenshot last.png && mkdir first && mv ./*.png first
fact a_script_of_keys_clicks_and_settings_runs_with_silent_validation
view --script script --csv second.csv --screenshot last.png &&
    cmp with-panels.png first/with-panels.png && cmp picture.png first/picture.png
fact two_runs_have_the_same_pictures
! cmp -s with-panels.png picture.png
fact panels_are_in_pictures_and_h_hides_them
[ "$(wc -l <second.csv)" -eq 26 ] && head -n 1 second.csv | grep -q '^frame,resident_mb,' &&
    cmp <(cut -d , -f 1-5,8-13 first.csv) <(cut -d , -f 1-5,8-13 second.csv)
fact figures_are_written_for_each_frame_and_are_the_same
awk -F , 'NR == 2 { exit !($1 == 0 && $2 == 0 && $12 == 0 && $22 == 100) }' first.csv && awk -F , 'END { exit !($12 > 0) }' first.csv
fact nothing_is_called_sharp_before_something_is_requested
sums() { awk -F , -v name="$1" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) column = i; next } { sum += $column }
    END { printf "%d", sum }' "$2"; }
printf '20 key g\n21 hover 380 120\n22 screenshot short.png\n23 set graph-span all\n24 screenshot long.png\n' >graphs
run 0 --room --headless --deterministic --fresh --size 400x225 --render-scale 0.2 --residency sparse --timeout 0.05 \
    --standby 0 --script graphs --frames 40 --csv graphs.csv --json && ! cmp -s short.png long.png &&
    grep -q "\"tiles loaded\", \"value\": $(sums mapped graphs.csv)," out &&
    [ "$(sums bind_runs graphs.csv)" -gt 0 ] && [ "$(sums feedback_words graphs.csv)" -gt 0 ] &&
    awk -F , 'NR > 1 && ($12 + $22 - 100) ^ 2 > 1e-6 { wrong = 1 } END { exit wrong }' graphs.csv
fact graphs_have_spans_and_the_table_of_figures_has_their_series
"$replay" run.trace >out && grep -q '^as_recorded *yes' out && echo '1 record none/run.trace' >unwritable &&
    run 1 --room --headless --size 160x160 --frames 2 --script unwritable && grep -q 'none/run.trace' err
fact decisions_are_recorded_from_any_frame_and_a_file_that_cannot_be_written_is_named
echo '1 kye 3' >wrong
run 1 --headless --script wrong && grep -q 'wrong:1: there is no event kye' err
fact a_wrong_script_is_named_with_its_line
run 2 --view 12 && run 2 one two && run 2 --budget 2 && grep -q 'wants 0, or from 4M to 1T' err &&
    echo '1 set budget 4095K' >tight && run 0 --room --headless --size 160x160 --frames 2 --script tight &&
    grep -q 'budget 4095K: wants 0' err
fact wrong_words_are_refused
printf '{"asset":{"version":"2.0"},"buffers":[{"byteLength":9999999999,"uri":"no.bin"}]}' >broken.gltf
head -c 100 /dev/urandom >noise.glb
run 1 --headless --frames 2 --cache . broken.gltf && run 1 --headless --frames 2 --cache . noise.glb &&
    run 1 --headless --frames 2 --cache . none.gltf &&
    grep -q 'none.gltf: cannot be opened: No such file' err
fact broken_scenes_are_refused
printf '2 drop noise.glb\n4 set compare-to budget\n4 key v\n' >drops
# shellcheck disable=SC2086
run 0 --room --headless $validation --size 160x160 --cache . --script drops --frames 6 && grep -q 'noise.glb' err
fact a_dropped_file_that_cannot_be_read_leaves_the_scene_which_can_be_compared

lose() { LOSE_AFTER=$1 LD_PRELOAD=$lose_device run 1 --headless --size 160x160 --frames 8 && grep -q DEVICE_LOST err; }
lose 0 && lose 1 && lose 6
fact a_lost_device_is_named_and_ends_it_with_status_1

mkdir -p pictures/below none && printf 'P6 2 2 255\n%012d' 0 >pictures/black.ppm &&
    printf 'P6 2 2 255\n%s' zzzzzzzzzzzz >pictures/below/light.ppm && cp noise.glb pictures/noise.png
hang() { run 0 --headless --deterministic --size 160x160 --panels off --cache . --frames 2 "$@"; }
printf '2 key Ctrl+O\n4 type pictures/\n6 key Enter\n8 type black\n10 key Enter\n' >opens
run 0 --room --headless --deterministic --fresh --size 320x240 --cache elsewhere --script opens --frames 14 &&
    grep -q '^black.ppm: 14 frames' out && [ ! -s err ]
fact a_file_is_opened_by_the_keyboard_alone
set=$(dirname "$facts")/../fuzz/corpus/neural/schema3.ntc
hang pictures "$set" "$set#gone" && grep -q 'pictures/noise.png' err && grep -q '^5 pictures: ' out &&
    grep -qE 'has no texture|#gone: .*UNSUPPORTED' err &&
    hang --screenshot black.png pictures/black.ppm gone.png && hang --screenshot missing.png gone.png \
    pictures/black.ppm && grep -q 'gone.png: cannot be shown' err && ! cmp -s black.png missing.png
fact pictures_and_folders_hang_in_the_room_and_one_that_is_missing_is_named
coproc python3 "$(dirname "$facts")/../http/faulty_server.py"
read -r port _ <&"${COPROC[0]}"
from_web() { printf 'http://127.0.0.1:%s/file/%s?path=%s&token=secret' "$port" "$1" "$PWD/$2"; }
store=$(find pictures -name '*.store' -size +0 | head -n 1)
if ! hang "$(from_web none.store none)" && grep -q 'without sluice-http' err; then
    echo "ok $((++number)) - URLs # SKIP made without sluice-http"
else
    hang --screenshot web.png "$(from_web black.ppm pictures/black.ppm)" gone.png && cmp black.png web.png &&
        ! grep -q secret out err && hang "$(from_web x.store "$store")" && ! grep -q 'cannot be shown' err &&
        run 1 --headless --frames 2 --cache . "$(from_web none.store none)" && grep -q 'none.store: cannot be' err
    fact pictures_and_stores_on_servers_hang_as_files_do_and_queries_are_not_said
fi
# A row with the hash of another store, and a damaged one.
{ printf 'sluice catalogue 1\nhash\tformat\twidth\theight\tlayers\tbytes\tpicture\tstore\n' &&
    printf '0123456789abcdef\tR8_UNORM\t2\t2\t1\t9\tin/black.ppm\t%s\n' "$store"; } >stores.tsv
printf 'sluice catalogue 1\nhash\n1\t2\n' >damaged.tsv
run 1 --headless --frames 2 --cache . stores.tsv && grep -q "$(basename "$store"): is not the store" err &&
    [ "$(grep -c 'cannot be shown' err)" = 1 ] && run 1 --headless --frames 2 --cache . damaged.tsv &&
    grep -q 'damaged.tsv: cannot be read as a catalogue' err
fact stores_of_a_catalogue_are_opened_and_must_be_those_it_names
if [ -n "$bake" ]; then
    mkdir two && printf 'P6 2 2 255\n%012d' 0 >two/black.ppm && printf 'P6 2 2 255\n%s' zzzzzzzzzzzz >two/light.ppm &&
        "$bake" two -o stores --plan the.plan >out && "$bake" two -o stores >out &&
        "$bake" --merge the.plan -o stores/list.tsv >out &&
        hang --screenshot files.png two && hang --screenshot stores.png stores/list.tsv && cmp files.png stores.png &&
        grep -q '^2 pictures: ' out
    fact both_stores_of_a_catalogue_hang_as_their_pictures_do
    url="http://127.0.0.1:$port/disk$PWD/stores/list.tsv?token=secret"
    hang --screenshot served.png "$url"
    if grep -q 'without sluice-http' err; then
        echo "ok $((++number)) - URLs # SKIP made without sluice-http"
    else
        cmp stores.png served.png && grep -q '^2 pictures: ' out && ! grep -q secret out err
        fact a_catalogue_on_a_server_names_stores_beside_it_and_its_query_is_not_said
    fi
fi
kill "${COPROC_PID:?}" && wait "$COPROC_PID" 2>/dev/null
printf '3 click 80 80 right\n7 set source-fails 0\n' >faults && { cat faults && echo '8 do retry'; } >mended
# shellcheck disable=SC2086
fails() { run 0 --headless --deterministic --fresh $validation --size 160x160 --panels off --cache . --still \
    --frames 12 --json --view 3 --source-fails 1 --script "$@" pictures/black.ppm; }
fails faults && grep -q '"tiles failed", "value": [1-9]' out && grep -q '"tiles loaded", "value": 0,' out &&
    fails mended && grep -q '"tiles loaded", "value": [1-9]' out
fact failing_reads_are_counted_and_a_retry_reads_them_again
printf '1 do retry\n2 do fly\n' >actions
run 0 --room --headless --size 160x160 --frames 3 --script actions && grep -q 'retry: no texture is selected' err
fact an_action_without_a_texture_is_refused
run 1 --headless --frames 2 --cache . none && grep -q 'there is no picture to show' err
fact a_folder_without_pictures_is_refused

# Quads of [-1, 1]: a wall, a small one in front that sets the bounds, and two between them that must not be seen.
quad='\0\0\x80\xbf\0\0\x80\xbf\0\0\0\0\0\0\x80\x3f\0\0\x80\xbf\0\0\0\0'
quad+='\0\0\x80\x3f\0\0\x80\x3f\0\0\0\0\0\0\x80\xbf\0\0\x80\x3f\0\0\0\0\0\0\1\0\2\0\0\0\2\0\3\0'
quad=$(printf %b "$quad" | base64 -w 0)
accessors='{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
  {"bufferView":0,"byteOffset":48,"componentType":5123,"count":6,"type":"SCALAR"}'
mesh() { printf '{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":%s}]}' "$1"; }
write_quads() { # NODES
    printf '{"asset":{"version":"2.0"},"scenes":[{"nodes":%s}],"nodes":[{"mesh":0,"translation":[0,0,-2],
  "scale":[2,2,1]},{"mesh":0,"scale":[0.1,0.1,1]},{"mesh":1,"translation":[0,0,-1]},
  {"mesh":2,"translation":[0,0,-0.5]}],"meshes":[%s,%s,%s],"materials":[{"doubleSided":true,
  "pbrMetallicRoughness":{"metallicFactor":0,"baseColorTexture":{"index":0}}},
  {"alphaMode":"MASK","doubleSided":true,"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,0.4]}},
  {"alphaMode":"BLEND","doubleSided":true,"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,0]}}],
  "textures":[{"source":0}],"images":[{"uri":"no such.png"}],"accessors":[%s],
  "bufferViews":[{"buffer":0,"byteLength":60}],
  "buffers":[{"byteLength":60,"uri":"data:application/octet-stream;base64,%s"}]}' \
        "$1" "$(mesh 0)" "$(mesh 1)" "$(mesh 2)" "$accessors" "$quad" >"$2"
}
write_quads '[0,1]' wall.gltf && write_quads '[0,1,2,3]' quads.gltf
for scene in wall quads; do
    # shellcheck disable=SC2086
    run 0 --headless --deterministic --fresh $validation --size 160x160 --panels off --cache . --frames 2 \
        --screenshot "$scene.png" "$scene.gltf" && grep -q 'no such.png' err || break
done && cmp wall.png quads.png
fact masked_and_transparent_quads_are_not_seen_and_a_missing_image_is_named
eyes='{"type":"perspective","perspective":{"yfov":0.6}},{"type":"orthographic","orthographic":{"xmag":2,"ymag":2,"znear":0,"zfar":9}}'
nodes='{"camera":0,"translation":[0,0,4]},{"camera":1,"name":"the plan","translation":[0.5,0,4]}'
sed "s/\"meshes\":/\"cameras\":[$eyes],&/; s/\"nodes\":\[{/\"nodes\":[$nodes,{/; s/\"nodes\":\[0,1\]/\"nodes\":[0,1,2,3]/" wall.gltf >eyes.gltf
sees() { run "$1" --headless --deterministic --fresh --size 160x160 --panels off --cache . --frames 2 --screenshot eye.png "${@:2}" eyes.gltf; }
sees 0 --camera 0 && mv eye.png first.png && sees 0 --camera 1 && mv eye.png plan.png && sees 0 --camera 'the plan' &&
    cmp eye.png plan.png && ! cmp -s first.png plan.png && sees 0 --camera 0.5,0,4,0,0,1,0,2,1 && cmp eye.png plan.png &&
    sees 1 --camera 'the map' && grep -q 'camera 1: the plan' err
fact cameras_of_a_file_are_chosen_by_number_and_name
printf '0 0 0 5 0 0 1\n0.2 2 0 5 0 0 1\n' >slide.path
slides() { sees 0 --play slide.path --feedback off --frames 14 "$@"; }
slides --path-loop off && mv eye.png ended.png && slides && mv eye.png again.png && ! cmp -s ended.png again.png &&
    slides --path-loop off --path-speed 4 && cmp eye.png ended.png && slides --path-speed 0.5 && mv eye.png slow.png &&
    slides --frames 7 && cmp eye.png slow.png
fact paths_are_played_once_or_again_and_faster_or_slower
mkdir beside && cp wall.gltf pictures/black.ppm beside && hang beside && grep -q '^black.ppm: ' out &&
    [ "$(cat err)" = 'sluice-view: wall.gltf is a scene: sluice-view beside/wall.gltf' ] &&
    cp wall.gltf beside/other.gltf && hang beside && [ ! -s err ]
fact the_only_scene_in_a_folder_of_pictures_is_named
write_quads '[0,1,3]' half.gltf && sed -i 's/"baseColorFactor":\[1,0,0,0\]/"baseColorFactor":[1,0,0,0.5]/' half.gltf &&
    sed 's/"alphaMode":"BLEND",//' half.gltf >front.gltf
for scene in wall front half; do
    run 0 --headless --deterministic --fresh --size 160x160 --render-scale 1 --panels off --cache . --frames 2 \
        --screenshot "full-$scene.png" "$scene.gltf" || break
done && python3 "$here/blended.py" full-wall.png full-front.png full-half.png >err
fact quads_blend_in_linear_light
printf '1 key 8\n3 set gain 1\n4 screenshot little.png\n5 set gain 16\n6 screenshot much.png\n7 key 5\n9 key 9\n' >truth
printf '11 hold w 2\n14 set lod-bias 2\n16 reset\n17 screenshot reset.png\n' >>truth
# shellcheck disable=SC2086
run 0 --headless --deterministic --fresh $validation --size 160x160 --panels off --cache . --script truth \
    --frames 19 --screenshot last.png wall.gltf && cmp little.png much.png && ! cmp -s much.png wall.png
fact view_8_is_black_where_nothing_is_missing_and_all_views_are_valid
cmp reset.png wall.png
fact after_a_reset_a_scene_looks_as_at_first
# Without feedback the picture has its mip tail alone; flicker shows the other one from frame 15 on.
{ printf 'P6 600 600 255\n' && seq 200000 | head -c 1080000 | tr 0-9 '\0\040\100\140\200\240\300\340\360\377'; } >fine.ppm
printf '8 screenshot a.png\n13 screenshot again.png\n18 screenshot b.png\n19 set compare-as difference\n22 quit\n' >flips
# shellcheck disable=SC2086
run 0 --headless --deterministic --fresh --still $validation --size 160x160 --render-scale 1 --panels off --cache . \
    --feedback off --compare-as flicker --difference-as flip --json --script flips --screenshot flip.png fine.ppm &&
    cmp a.png again.png && value=$("$flip" a.png b.png) && [[ $value == 0.0[1-9]* ]] &&
    grep -q "\"FLIP\", \"value\": $value," out
fact flip_of_a_comparison_is_that_of_its_two_pictures
printf '8 key Ctrl+F12\n' >larger && rm -f sluice-view-*.png
# shellcheck disable=SC2086
run 0 --headless --deterministic --fresh --still $validation --size 200x160 --render-scale 0.5 --cache . --feedback off \
    --script larger --frames 10 fine.ppm &&
    run 0 --headless --deterministic --fresh --still --size 400x320 --render-scale 1 --panels off --cache . --feedback off \
        --frames 10 --screenshot large.png fine.ppm && cmp sluice-view-01.png large.png
fact ctrl_f12_draws_the_picture_at_twice_the_resolution_of_the_window
shots() { run 0 --room --headless --deterministic --fresh --size 320x240 --residency paged --frames 24 --csv "$1" "${@:2}"; }
rm -f sluice-view-*.png && shots without.csv && shots with.csv --script larger && [ -s sluice-view-01.png ] &&
    cmp <(cut -d , -f 1-5,8-11,13 without.csv) <(cut -d , -f 1-5,8-11,13 with.csv)
fact a_picture_at_twice_the_resolution_changes_no_figure_of_streaming
printf '4 key N\n12 key Shift+N\n20 key Shift+N\n28 quit\n' >steps
run 0 --headless --deterministic --fresh --still --size 160x160 --render-scale 1 --panels off --cache . --pause on \
    --probability 1 --script steps --csv steps.csv fine.ppm
# Counted by eight frames: the mip tail, nothing, and a tile for each step.
column=$(head -n 1 steps.csv | tr , '\n' | grep -n '^mapped' | cut -d : -f 1) &&
    sums=$(awk -F , -v c="$column" 'NR > 1 { sum[int(($1 + 4) / 8)] += $c }
        END { print (sum[0] + sum[1] > 0), sum[2] + 0, sum[3] + 0 }' steps.csv) && [ "$sums" = '1 1 1' ]
fact a_step_loads_one_tile_while_streaming_is_paused
# The camera turns in frames 18 to 54. Prints how many tiles are loaded then, and their frame on average.
printf '0 0 1.6 4 0 0 1\n0.3 0 1.6 4 0 0 1\n0.9 0 1.6 0 2.5 0 1\n' >turn.path
turn() {
    run 0 --room --headless --deterministic --fresh --size 160x160 --render-scale 1 --panels off --probability 1/4 \
        --residency paged --textures-per-frame 100 --play turn.path --frames 54 --csv turn.csv --predict "$1" &&
        awk -F , -v c="$column" 'NR > 18 { frames += $1 * $c; tiles += $c } END { print tiles, int(frames / tiles) }' turn.csv
}
read -r tiles late < <(turn 0) && read -r ahead early < <(turn 0.25) && [ "$tiles" -gt 10 ] && [ "$ahead" -ge "$tiles" ] &&
    [ "$early" -lt $((late - 5)) ]
fact feedback_from_where_the_camera_will_be_loads_its_tiles_earlier
# A file of BC1 with 1024 x 1024 texels and one level has no mip tail; freed memory is overwritten.
word() { printf '%b' "$(printf '\\x%02x\\x%02x\\x%02x\\x00' $(($1 & 255)) $(($1 >> 8 & 255)) $(($1 >> 16)))"; }
{ printf 'DDS ' && for value in 124 528391 1024 1024 524288 0 1 0 0 0 0 0 0 0 0 0 0 0 32 4; do word "$value"; done &&
    printf DXT1 && for value in 0 0 0 0 0 4096 0 0 0 0; do word "$value"; done && head -c 524288 /dev/zero; } >one-level.dds
printf '3 key t\n8 screenshot table.png\n10 quit\n' >thumbs
MALLOC_PERTURB_=165 run 0 --headless --deterministic --fresh --size 320x240 --cache . --script thumbs one-level.dds &&
    grep -q 'one-level.dds: cannot be shown: SLUICE_ERROR_INVALID_ARGUMENT' err
fact the_table_has_a_picture_of_a_texture_that_cannot_be_shown
MALLOC_PERTURB_=165 run 0 --headless --deterministic --fresh --size 160x160 --cache . --frames 4 --source-latency 1 \
    one-level.dds && grep -q 'one-level.dds: cannot be shown: SLUICE_ERROR_INVALID_ARGUMENT' err
fact a_texture_that_cannot_be_shown_stays_replaced_behind_a_slow_source
# A copy of the viewer finds what is beside it: the tool with one value instead of its plan, and what does not end.
mkdir bin && cp "$tool" bin && printf '1 key Ctrl+T\n3 quit\n' >sweeps
export LD_LIBRARY_PATH="${tool%/*/*/*}/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
sweeps() { tool=bin/sluice-view run 0 --headless --fresh --still --size 160x160 --cache . --timeout 0.5 --script sweeps "$@" fine.ppm; }
printf '#!/bin/sh\nshift\nexec "%s" view --sweep budget=16 "$@"\n' "$tradeoff" >bin/sluice-tradeoff && chmod +x bin/sluice-tradeoff
sweeps --deterministic --device 0 --threads 3 && cut -d , -f 2,3 sluice-view-trade/points.csv >out && grep -q '^base,done$' out &&
    grep -q '^budget 16,done$' out && grep -q -- '--timeout 0.5' sluice-view-trade/page.html && [ ! -s err ] &&
    grep -q -- '--device 0 --threads 3' sluice-view-trade/page.html
fact a_sweep_of_the_scene_and_its_camera_starts_from_the_settings_of_now
printf '#!/bin/sh\necho $$ >pid\nexec sleep 300\n' >bin/sluice-tradeoff
for frames in 90 900 9000; do # a busy machine begins the sweep later
    printf '1 key Ctrl+T\n%d quit\n' "$frames" >sweeps
    sweeps
    ended=$?
    [ ! -s pid ] || break
done
[ "$ended" -eq 0 ] && [ -s pid ] && ! kill -0 "$(cat pid)" 2>err
fact a_sweep_ends_with_the_viewer
# xdg-open may end before the browser that it began, and may be the browser itself.
alive() { grep -q '^State:[[:space:]]*[^Z[:space:]]' "/proc/$1/status"; }
printf '#!/bin/sh\nexit 0\n' >bin/sluice-tradeoff && printf '1 key Ctrl+T\n4 click 470 305\n30 quit\n' >pages
opens() {
    rm -f browser
    printf '#!/bin/sh\nsleep 30 &\necho $! >begun && mv begun browser\n%s\n' "$1" >bin/xdg-open && chmod +x bin/xdg-open &&
        PATH="$PWD/bin:$PATH" tool=bin/sluice-view run 0 --room --headless --deterministic --fresh --still --size 800x600 \
            --render-scale 0.2 --cache . --script pages || return
    for _ in {1..50}; do [ ! -s browser ] || break; sleep 0.1; done
    sleep 0.2
    alive "$(cat browser)" && kill "$(cat browser)"
}
opens 'exit 0' && opens wait
fact the_browser_of_the_page_stays_when_xdg_open_and_the_viewer_end
printf '12 screenshot old.png\n13 key Ctrl+F5\n15 screenshot new.png\n16 quit\n' >reloads
reloads() {
    tool=bin/sluice-view run 0 --headless --deterministic --fresh --still --size 160x160 --panels off --cache . \
        --fade 0 --probability 1 --script reloads fine.ppm
}
reloads && cmp old.png new.png && [ ! -s err ]
fact without_sources_shaders_stay_as_they_are
if glslang=$(command -v glslangValidator); then
    cp -r "$here/../../tools/sluice-view/shaders" shaders &&
        printf '%s\n%s\n%s\n' "$glslang" "$PWD/shaders" "$(realpath "$here/../../shaders/include")" >bin/shaders.path &&
        reloads && cmp old.png new.png && sed -i 's/^    outColor = .*/    outColor = vec4(0.0, 1.0, 0.0, 1.0);/' shaders/scene.frag &&
        reloads && ! cmp -s old.png new.png && [ ! -s err ]
    fact shaders_are_compiled_again
    cp reloads built && printf '13 key Ctrl+F5\n14 key 8\n15 set gain 1\n18 screenshot little.png\n' >reloads &&
        printf '19 set gain 16\n20 screenshot much.png\n21 quit\n' >>reloads && reloads && cmp little.png much.png && mv built reloads
    fact the_second_streamer_has_the_shaders_that_were_compiled_before_it
    sed -i 's/^    outColor = /    outColour = /' shaders/scene.frag && reloads && cmp old.png new.png &&
        grep -q "scene.frag:[0-9]*: .*outColour" err
    fact a_shader_that_cannot_be_compiled_is_named_and_the_one_before_stays
fi
# The streamer's buffers leave less than 4 MiB for heaps.
run 0 --room --still --headless --deterministic --fresh --size 160x160 --residency sparse --budget 4 --frames 10 --csv tight.csv &&
    awk -F , 'END { exit !($2 > 2 && $2 <= 4.2) }' tight.csv && [ ! -s err ]
fact the_smallest_budget_has_room_for_tiles
printf '12 set freeze-wants on\n13 hold s 20\n' >frozen
run 0 --room --still --headless --deterministic --fresh --size 160x160 --residency paged --timeout 0.1 --standby 0 \
    --panels off --script frozen --frames 48 --csv frozen.csv &&
    [ "$(sed -n 14p frozen.csv | cut -d , -f 2,3)" = "$(tail -n 1 frozen.csv | cut -d , -f 2,3)" ] &&
    awk -F , 'NR == 2 { first = $2 } END { exit !($2 > first) }' frozen.csv
fact tiles_that_are_wanted_when_wants_are_frozen_stay
# shellcheck disable=SC2086
run 0 --headless $validation --size 160x160 --cache . --frames 1 && grep -q '^hall.gltf: 1 frames' out
fact the_hall_is_opened_without_arguments
end_facts
