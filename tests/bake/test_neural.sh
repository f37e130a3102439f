#!/usr/bin/env bash
# sluice-bake --neural, in TAP: pictures become a set that the C decoder reads. Needs a Vulkan device.
# usage: test_neural.sh SLUICE_BAKE
set -u
bake=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
number=0
fact() { # name, status
    number=$((number + 1))
    [ "$2" -eq 0 ] && echo "ok $number - $1" || echo "not ok $number - $1"
}
# Text pictures: a color gradient with waves, and one channel.
awk 'BEGIN { print "P3 32 32 255"; for (y = 0; y < 32; y++) for (x = 0; x < 32; x++)
    print int(128 + 100 * sin(x / 5) * cos(y / 6)), int(x * 8), int(y * 8) }' >"$work/color.ppm"
awk 'BEGIN { print "P2 32 32 255"; for (y = 0; y < 32; y++) for (x = 0; x < 32; x++)
    print int(128 + 90 * cos((x + y) / 7)) }' >"$work/rough.pgm"
awk 'BEGIN { print "P2 16 16 255"; for (i = 0; i < 256; i++) print i }' >"$work/small.pgm"

"$bake" --neural "$work/color.ppm" "$work/rough.pgm" -o "$work/set.ntc" --bits-per-texel 2.5 --steps 60 \
    --batch 320 --json >"$work/out" 2>"$work/err" || cat "$work/err"
echo "# $(cat "$work/out")"
grep -q -E '"psnr": (19|[2-9][0-9])\.' "$work/out"
fact pictures_become_a_set_of_19_dB_in_60_steps $?
others=$(find "$work" -type f ! -name set.ntc ! -name '*.p[gp]m' ! -name out ! -name err)
[ "$(head -c 4 "$work/set.ntc")" = NTEX ] && [ -z "$others" ]
fact nothing_else_is_left_behind $?
psnr_of() { sed -n 's/.*"psnr": \([0-9.]*\).*/\1/p'; }
quick() { "$bake" --neural "$work/color.ppm" --steps 20 --batch 192 --json "$@" 2>"$work/err"; }

# All sizes are tried for 99 dB. Then the goal is what the first size misses and a later one
# reaches, less what printing may have rounded up.
values() { sed -n 's/.*"bits_per_texel": \([0-9.]*\), .*"psnr": \([0-9.]*\), "fp8.*/\1 \2/p'; }
quick -o "$work/all.ntc" --psnr 99 >"$work/lines"
status=$?
values <"$work/lines" >"$work/sizes"
[ $status -ne 0 ] && grep -q '99 dB are not reached' "$work/err" &&
    [ "$(cut -d' ' -f1 "$work/sizes" | tr '\n' ' ')" = "1.25 2.5 5 10 20 " ]
fact a_search_in_vain_tries_all_sizes_and_says_so $?
goal=$(awk 'NR == 1 { first = $2 } $2 > first { print $2 - 0.001; exit }' "$work/sizes")
[ -n "$goal" ] && quick -o "$work/found.ntc" --psnr "$goal" >"$work/lines" &&
    awk -v goal="$goal" '{ print } $2 >= goal { exit }' "$work/sizes" | cmp -s - <(values <"$work/lines") &&
    grep -q "\"size\": $(stat -c %s "$work/found.ntc")," <(tail -n 1 "$work/lines")
fact a_search_ends_at_the_first_size_that_is_good_enough $?
echo "# $(tr '\n' ';' <"$work/sizes") goal ${goal:-none}"

# A weight moves errors from one picture to the other; what is wrong is refused before training.
both() { quick "$work/rough.pgm" --steps 60 --batch 320 --bits-per-texel 2.5 -o "$work/weighed.ntc" "$@"; }
unweighed=$(psnr_of <"$work/out") weighed=$(both --loss-weights rough=0.001,color=1 | psnr_of)
echo "# $unweighed dB, $weighed dB with one picture left to itself"
awk -v a="$unweighed" -v b="$weighed" 'BEGIN { exit !(b > 0 && b < a - 1) }'
fact a_picture_without_weight_is_left_to_itself $?
is_refused=0
for wrong in rough=0 none=1; do
    both --loss-weights "$wrong" >"$work/out" && is_refused=1
    grep -q -e "--loss-weights" "$work/err" && [ ! -s "$work/out" ] || is_refused=1
done
fact wrong_weights_are_refused $is_refused

# The first checkpoint is of step 64 of 84.
resumed() { quick --bits-per-texel 2.5 --steps 80 --checkpoint "$work/state" -o "$work/$1" | sed 's/.*"steps": \([0-9]*\),.*/\1/'; }
first=$(resumed one.ntc) second=$(resumed two.ntc)
echo "# $first steps, $second after the checkpoint"
[ "$first" = 84 ] && [ "$second" = 20 ] && cmp -s "$work/one.ntc" "$work/two.ntc"
fact a_run_goes_on_from_a_checkpoint_to_the_same_bytes $?
rm -f "$work/two.ntc"
! quick --bits-per-texel 2.5 --steps 81 --checkpoint "$work/state" -o "$work/two.ntc" >"$work/out" &&
    grep -q "$work/state" "$work/err" && [ ! -e "$work/two.ntc" ]
fact a_checkpoint_of_another_run_is_refused $?

! "$bake" --neural "$work/color.ppm" "$work/small.pgm" -o "$work/other.ntc" 2>"$work/err" &&
    grep -q 'small: is 16 x 16, the pictures before are 32 x 32' "$work/err" && [ ! -e "$work/other.ntc" ]
fact pictures_of_other_sizes_are_refused $?
mkdir "$work/other" && cp "$work/rough.pgm" "$work/other/color.pgm"
! "$bake" --neural "$work/color.ppm" "$work/other/color.pgm" -o "$work/other.ntc" 2>"$work/err" &&
    grep -q 'color: two pictures of a set have this name' "$work/err" && [ ! -e "$work/other.ntc" ]
fact pictures_of_one_name_are_refused $?
"$bake" --neural --array "$work/color.ppm" -o "$work/other.ntc" 2>"$work/err"
[ $? -eq 2 ] && grep -q -e '--neural, one of them' "$work/err"
fact contradicting_options_are_refused $?
echo "1..$number"
