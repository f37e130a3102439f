#!/usr/bin/env bash
# test_compare.sh FACTS SLUICE-VIEW: A and B of a comparison, in TAP.
set -u
facts=$(realpath "$1") tool=$(realpath "$2")
"$tool" --list-devices >/dev/null 2>&1 || { echo "1..0 # SKIP no Vulkan device"; exit 0; }
# shellcheck source=/dev/null
. "$facts"

# The stage of the sanitizers switches layers off.
validation=--validation
[ -z "${VK_LOADER_LAYERS_DISABLE:-}" ] || validation=
{ printf 'P6 600 600 255\n' && seq 200000 | head -c 1080000 | tr 0-9 '\0\040\100\140\200\240\300\340\360\377'; } >fine.ppm
# Flicker shows A in frames 0 to 14 and 30 to 44, B in those between. All that is wanted is there by then.
# shellcheck disable=SC2086 # nothing, or a word
compare() {
    run 0 --headless --deterministic --fresh --still $validation --size 160x160 --render-scale 1 --panels off --cache . \
        --probability 1 --fade 0 --compare-as flicker --json "$@" fine.ppm
}
value() { sed -n "s/.*\"$1\", \"value\": \([-0-9.]*\).*/\1/p" out; }

printf '38 screenshot a.png\n53 screenshot b.png\n54 set compare-as difference\n55 set difference-as flip\n58 quit\n' >looks
compare --compare-to b --script looks && cmp a.png b.png && [ "$(value FLIP)" = 0.000000 ]
fact b_with_the_settings_of_a_has_the_same_picture_at_rest
cp a.png same.png
compare --b lod-bias=2,anisotropy=1 --script looks && cmp a.png same.png && ! cmp -s a.png b.png && [[ $(value FLIP) == 0.[0-9]*[1-9]* ]]
fact settings_of_b_change_its_picture_alone
cp b.png blurry.png
# Paged mode has a filter of its own.
compare --residency sparse --b residency=dense --script looks && cmp a.png same.png && cmp b.png same.png &&
    compare --residency sparse --b residency=paged --script looks && cmp a.png same.png && [[ $(value FLIP) == 0.0[0-4]* ]]
fact b_in_each_mode_has_the_picture_of_a
compare --b feedback=off --script looks && cmp a.png same.png && ! cmp -s b.png same.png &&
    [ "$(value resident_b)" -lt "$(value resident)" ]
fact without_feedback_b_has_its_mip_tail_alone

printf '16 set b lod-bias 2\n17 set b anisotropy 1\n53 screenshot b.png\n54 set lod-bias 3\n54 set budget 8\n54 set residency dense\n' >changes
printf '54 set anisotropy 16\n68 screenshot a.png\n84 screenshot again.png\n85 quit\n' >>changes
compare --script changes && cmp b.png blurry.png && cmp again.png blurry.png && ! cmp -s a.png same.png
fact changes_of_a_never_change_b

# Frame 70 and what comes behind shows A, and loads nothing.
printf '38 screenshot 1.png\n53 screenshot b.png\n60 key X\n70 screenshot 2.png\n75 key X\n90 set compare-as off\n' >swaps
printf '95 screenshot 3.png\n96 key X\n105 screenshot 4.png\n106 quit\n' >>swaps
compare --b lod-bias=2,anisotropy=1 --script swaps --csv swaps.csv && cmp 1.png same.png && cmp b.png blurry.png &&
    cmp 2.png blurry.png && cmp 3.png same.png && cmp 4.png blurry.png
fact x_swaps_the_pictures_and_twice_brings_the_first_one_back
column=$(head -n 1 swaps.csv | tr , '\n' | grep -n '^mapped' | cut -d : -f 1) &&
    [ "$(awk -F , -v c="$column" 'NR > 1 && $1 > 59 && $1 < 90 { sum += $c } END { print sum + 0 }' swaps.csv)" = 0 ]
fact swapping_loads_nothing
compare --b lod-bias=2,anisotropy=1 --compare-as off --script swaps && cmp 3.png same.png && cmp 4.png blurry.png
fact x_swaps_pictures_that_are_not_beside_each_other

run 0 --room --still --headless --deterministic --fresh --size 160x160 --residency sparse --compare-as divider \
    --b budget=4 --frames 30 --json && [ "$(value resident_b)" -gt 2000000 ] && [ "$(value resident_b)" -le 4200000 ] &&
    [ "$(value resident)" -gt 4200000 ]
fact a_small_budget_of_b_is_kept_while_a_has_more
[[ $(value gpu_ms_median_a) == *[1-9]* && $(value gpu_ms_median_b) == *[1-9]* && $(value host_ms_median_a) == *[1-9]* ]] &&
    awk -v a="$(value gpu_ms_median_a)" -v b="$(value gpu_ms_median_b)" -v all="$(value gpu_ms_median)" \
        'BEGIN { exit !(a > 0 && b > 0 && a + b < 1.5 * all) }'
fact times_of_both_pictures_are_measured_within_those_of_the_frame
# Two frames are in flight: at the end those of frames 30 to 37 are known.
echo '30 set b lod-bias 2' >later
compare --b anisotropy=1 --frames 40 --script later && [ "$(value frames_compared)" = 8 ]
fact times_are_of_frames_with_the_present_settings_alone
# "B", "own, as A now", then the slider of its budget to 8 MiB; at the end A again, and the slider one row higher.
printf '3 key U\n5 click 174 125\n8 click 215 152\n11 drag 206 204 30 204 6\n' >panel
edits() {
    run 0 --room --still --headless --deterministic --fresh --size 1000x562 --render-scale 0.2 --residency sparse --probability 1 \
        --compare-as divider --script panel --json --frames 40
}
edits && [ "$(value sharp)" = 1.0000 ] && [[ $(value sharp_b) == 0.* ]] && [ "$(value frames_compared)" -gt 15 ] &&
    printf '22 click 123 125\n25 drag 206 178 30 178 6\n' >>panel && edits && [[ $(value sharp) == 0.* ]]
fact the_panel_of_controls_edits_a_or_b
printf '1 set b bugdet 16\n2 set b view 3\n3 set b budget 2\n' >wrong
run 0 --room --headless --size 160x160 --frames 4 --script wrong && grep -q 'there is no setting bugdet' err &&
    grep -q 'B: view is shared by A and B' err && grep -q 'B: budget 2: wants 0' err
fact wrong_settings_of_b_are_named
# The screenshot is one picture more of the folder, which is read again for B.
mkdir shown && cp fine.ppm shown && printf '2 screenshot shown/new.png\n5 key V\n8 key X\n12 quit\n' >grows
run 0 --still --headless --deterministic --fresh --size 160x160 --cache . --json --script grows shown &&
    grep -q 'the files of the scene have changed: A has 3 textures, B would have 4' err && ! grep -q frames_compared out
fact b_is_refused_once_files_have_changed_so_that_textures_differ
end_facts
