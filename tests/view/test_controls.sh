#!/usr/bin/env bash
# test_controls.sh FACTS SLUICE-VIEW: what controls change in pictures and in figures, in TAP.
set -u
facts=$(realpath "$1") tool=$(realpath "$2")
"$tool" --list-devices >/dev/null 2>&1 || { echo "1..0 # SKIP no Vulkan device"; exit 0; }
# shellcheck source=/dev/null
. "$facts"
# The stage of the sanitizers switches layers off.
validation=--validation
[ -z "${VK_LOADER_LAYERS_DISABLE:-}" ] || validation=
# shellcheck disable=SC2086 # nothing, or a word
view() {
    run 0 --headless --deterministic --fresh --still $validation --size 160x160 --render-scale 1 --panels off --cache . \
        --fade 0 --feedback-by every-pixel --textures-per-frame 0 "$@"
}
sum() { awk -F , -v name="$1" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) column = i; next } { sum += $column }
    END { printf "%d", sum }' "$2"; }
noise() { awk -v seed="$1" -v n="$2" 'BEGIN { srand(seed); for (i = 0; i < n; i++) printf "%c", 40 + int(80 * rand()) }'; }

# Pictures of 4 x 4 texels, and each texel as 64 x 64 of them.
{ printf 'P6 4 4 255\n' && noise 3 48; } >small.ppm
{
    printf 'P6 256 256 255\n'
    tail -c 48 small.ppm | od -An -v -tu1 | tr -s ' \n' ' ' | awk '{ for (y = 0; y < 256; y++) for (x = 0; x < 256; x++)
        for (k = 0; k < 3; k++) printf "%c", $(3 * (int(y / 64) * 4 + int(x / 64)) + k + 1) }'
} >large.ppm
nearest() { view --residency "$1" --texel-filter nearest --frames 12 --screenshot "$2-$1.png" "$2.ppm"; }
nearest sparse small && nearest sparse large && nearest paged small && nearest paged large &&
    cmp small-sparse.png large-sparse.png && cmp small-paged.png large-paged.png && cmp small-sparse.png small-paged.png &&
    view --frames 12 --screenshot linear.png small.ppm && ! cmp -s linear.png small-sparse.png
fact nearest_texels_of_a_small_picture_are_those_of_a_large_one

# What the finest level keeps out stays in memory as standby tiles here.
{ printf 'P6 1024 1024 255\n' && seq 600000 | head -c 3145728 | tr 0-9 '\0\040\100\140\200\240\300\340\360\377'; } >fine.ppm
printf '1 hold w 3\n' >walk && { cat walk && printf '15 set finest-level 3\n'; } >clamped &&
    { cat clamped && printf '25 set finest-level 0\n'; } >freed
clamp() { view --residency "$mode" --speed 42 --frames 35 --script "$@" fine.ppm; }
clamps() {
    local mode=$1
    clamp walk --screenshot fine.png && clamp walk --finest-level 3 --screenshot coarse.png &&
        clamp clamped --screenshot clamped.png && cmp coarse.png clamped.png && ! cmp -s fine.png coarse.png &&
        clamp freed --screenshot freed.png && cmp fine.png freed.png
}
clamps sparse && clamps paged
fact levels_finer_than_the_finest_one_are_not_sampled_though_they_are_in_memory

# Quads as in test_headless.sh: a wall, and a masked one before it that ends no pixel without its mask.
quad='\0\0\x80\xbf\0\0\x80\xbf\0\0\0\0\0\0\x80\x3f\0\0\x80\xbf\0\0\0\0'
quad+='\0\0\x80\x3f\0\0\x80\x3f\0\0\0\0\0\0\x80\xbf\0\0\x80\x3f\0\0\0\0\0\0\1\0\2\0\0\0\2\0\3\0'
quad=$(printf %b "$quad" | base64 -w 0)
write_quads() { # MODE-OF-ALPHA FILE
    printf '{"asset":{"version":"2.0"},"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0,"translation":[0,0,-2],
  "scale":[2,2,1]},{"mesh":1}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]},
  {"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":1}]}],"materials":[{"doubleSided":true},
  {"alphaMode":"%s","doubleSided":true,"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,0.4]}}],
  "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
  {"bufferView":0,"byteOffset":48,"componentType":5123,"count":6,"type":"SCALAR"}],
  "bufferViews":[{"buffer":0,"byteLength":60}],
  "buffers":[{"byteLength":60,"uri":"data:application/octet-stream;base64,%s"}]}' "$1" "$quad" >"$2"
}
write_quads MASK masked.gltf && write_quads OPAQUE opaque.gltf && printf '4 set alpha-test off\n' >unmasked &&
    view --frames 8 --screenshot masked.png masked.gltf && view --frames 8 --screenshot opaque.png opaque.gltf &&
    view --frames 8 --script unmasked --screenshot unmasked.png masked.gltf && cmp opaque.png unmasked.png &&
    ! cmp -s masked.png opaque.png
fact without_the_alpha_test_masked_quads_look_as_opaque_ones_do

# Color and normals of a quad with UVs.
write_set() {
    local uvs='\0\0\0\0\0\0\x80\x3f\0\0\x80\x3f\0\0\x80\x3f\0\0\x80\x3f\0\0\0\0\0\0\0\0\0\0\0\0'
    local both
    both=$({ printf %s "$quad" | base64 -d && printf %b "$uvs"; } | base64 -w 0)
    printf '{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
  "meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":2},"indices":1,"material":0}]}],
  "materials":[{"doubleSided":true,"normalTexture":{"index":1},"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],
  "textures":[{"source":0},{"source":1}],"images":[{"uri":"fine.ppm"},{"uri":"bumps.ppm"}],
  "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
  {"bufferView":0,"byteOffset":48,"componentType":5123,"count":6,"type":"SCALAR"},
  {"bufferView":0,"byteOffset":60,"componentType":5126,"count":4,"type":"VEC2"}],
  "bufferViews":[{"buffer":0,"byteLength":92}],
  "buffers":[{"byteLength":92,"uri":"data:application/octet-stream;base64,%s"}]}' "$both" >set.gltf
}
{ printf 'P6 1024 1024 255\n' && seq 700000 | tail -c 3145728 | tr 0-9 '\170\170\200\200\200\210\210\200\210\170'; } >bumps.ppm
printf '12 set texture-sets off\n' >apart && printf '12 set texture-sets on\n' >joined && write_set
sets() { view --residency paged --frames 30 --csv "$1.csv" --screenshot "$1.png" "${@:2}" set.gltf; }
sets on && sets off --texture-sets off && sets apart --script apart && sets joined --texture-sets off --script joined &&
    cmp on.png off.png && cmp on.png apart.png && cmp on.png joined.png &&
    [ "$(sum feedback_words off.csv)" -gt "$(sum feedback_words on.csv)" ]
fact without_texture_sets_more_is_read_back_and_the_picture_is_equal

# Prints the tiles that are loaded from frame 12 on, after a setting changed in frame 11.
later() {
    printf '1 hold w 3\n10 screenshot before.png\n11 set %s\n' "$1" >change &&
        view --residency sparse --speed 42 --frames 22 --script change --csv later.csv --screenshot after.png fine.ppm &&
        cmp before.png after.png && tail -n +14 later.csv | { head -n 1 later.csv && cat; } >tail.csv && sum mapped tail.csv
}
opens() { local tiles && tiles=$(later "$1") && [ "$tiles" -gt 4 ]; }
[ "$(later 'timeout 2')" = 0 ] && opens 'residency dense' && opens 'threads 3' && opens 'loads-in-flight 40' &&
    opens 'anisotropy 4'
fact the_scene_is_opened_again_for_settings_that_need_it_and_the_camera_stays
prefetches() { view --residency paged --feedback off --frames 20 --csv "$1.csv" --prefetch-levels "$1" fine.ppm && sum mapped "$1.csv"; }
none=$(prefetches 0) && coarse=$(prefetches 1) && more=$(prefetches 3) && [ "$coarse" -gt "$none" ] && [ "$more" -gt "$coarse" ]
fact coarse_levels_are_loaded_before_anything_requests_them
misses() {
    run 0 --room --still --headless --deterministic --fresh --size 160x160 --residency paged --timeout 0.02 --standby 0 \
        --probability 1/64 --textures-per-frame 0 --frames 60 --csv "$1.csv" --misses-to-forget "$1" && sum unmapped "$1.csv"
}
few=$(misses 1) && many=$(misses 4096) && [ "$few" -gt 4 ] && [ "$many" -eq 0 ]
fact tiles_that_few_maps_miss_stay_if_more_misses_are_wanted

# The panel of controls by keyboard: its first slider is the budget.
{ printf '2 key U\n4 key Ctrl+Tab\n6 key down\n8 key down\n10 key enter\n11 type 64\n13 key enter\n' &&
    printf '20 key delete\n22 quit\n'; } >typing
run 0 --room --still --headless --deterministic --fresh --size 640x400 --render-scale 0.2 --script typing --csv typed.csv &&
    awk -F , '$1 == 18 { typed = $5 } END { exit !(typed > 67 && typed < 67.2 && $5 == 0) }' typed.csv
fact a_budget_is_typed_and_reset_by_the_keyboard_alone
png_size() { od -An -tu1 -j16 -N8 "$1" | awk '{print $3 * 256 + $4 "x" $7 * 256 + $8}'; }
printf '2 set size 320x200\n4 screenshot smaller.png\n5 set size 480x270\n6 set theme light\n7 screenshot light.png\n' >sizes
printf '8 set theme dark\n9 screenshot dark.png\n10 quit\n' >>sizes
run 0 --room --still --headless --deterministic --fresh --size 480x270 --script sizes $validation &&
    [ "$(png_size smaller.png)" = 320x200 ] && [ "$(png_size dark.png)" = 480x270 ] && ! cmp -s light.png dark.png
fact size_and_theme_change_at_once

# Prints a column of figures in a frame.
figure() { awk -F , -v name="$1" -v frame="$2" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) c = i } $1 == frame { print $c }' relief.csv; }
# The camera steps back, so that fine tiles become standby tiles: of the wall that is clicked, and of others.
{ printf '1 hold w 3\n10 hold s 6\n20 click 20 80\n26 key Delete\n30 key Ctrl+M\n34 key Shift+M\n35 key Shift+M\n' &&
    printf '36 key Shift+M\n'; } >relief
view --residency sparse --speed 42 --timeout 0.1 --frames 44 --csv relief.csv --script relief fine.ppm &&
    awk -v before="$(figure standby_mb 25)" -v evicted="$(figure standby_mb 29)" -v trimmed="$(figure standby_mb 32)" \
        -v full="$(figure resident_mb 33)" -v moving="$(figure resident_mb 34)" -v moved="$(figure resident_mb 43)" \
        'BEGIN { exit !(before > evicted && evicted > 0 && trimmed == 0 && moving < full && moved == full) }'
fact keys_evict_the_selected_texture_trim_standby_tiles_and_move_tiles_together
end_facts
