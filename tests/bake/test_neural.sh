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
