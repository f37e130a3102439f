#!/usr/bin/env bash
# test_panels.sh FACTS SLUICE-VIEW LATE-SEMAPHORES: panels and figures of the viewer, without a window, in TAP.
set -u
facts=$(realpath "$1") tool=$(realpath "$2") late=$(realpath "$3")
"$tool" --list-devices >/dev/null 2>&1 || { echo "1..0 # SKIP no Vulkan device"; exit 0; }
# shellcheck source=/dev/null
. "$facts"
view() { run 0 --room --headless --deterministic --fresh --still --size 1000x562 --render-scale 0.1 --cache . "$@"; }

# The border behind Name. A click gives both the focus of the keyboard. The button is released below the titles, which
# would sort otherwise.
printf '1 key t\n20 drag 611 194 690 300 4\n50 click 600 167\n60 hover 300 500\n64 screenshot dragged.png\n' >dragged
printf '1 key t\n50 click 600 167\n60 hover 300 500\n64 screenshot as-before.png\n' >as-before
view --script as-before && view --script dragged && ! cmp -s as-before.png dragged.png
fact columns_are_dragged

# Buttons, figures and the line at the bottom say what they are; the sky, with nothing under the mouse, is silent.
hovers() { printf '20 hover %d %d\n24 screenshot hover.png\n' "$1" "$2" >hover && view --script hover; }
hovers -1 -1 && mv hover.png nothing.png
silent=
for at in '100 40' '300 40' '500 40' '800 30' '800 50' '850 69' '800 85' '500 510'; do
    # shellcheck disable=SC2086 # two numbers
    hovers $at && ! cmp -s hover.png nothing.png || silent="$silent $at;"
done
hovers 500 100 && cmp hover.png nothing.png && { [ -z "$silent" ] || { echo "nothing at$silent" >>err && false; }; }
fact what_is_hovered_says_what_it_is

# All figures but times, with a first run that bakes, a second, and semaphores that are signaled late.
{ printf 'P6 1000 1000 255\n' && yes 'some texels' | head -c 3000000; } >first.ppm
{ printf 'P6 1000 900 255\n' && yes 'other texels' | head -c 2700000; } >second.ppm
figures() { run 0 --headless --deterministic --fresh --size 240x160 --panels off --frames 6 --cache baked --csv run.csv \
    first.ppm second.ppm && cut -d , -f 1-5,8-13,17-22 run.csv >"$1"; }
figures baking && figures baked.csv && LD_PRELOAD=$late figures late && [ "$(wc -l <baking)" = 7 ] &&
    awk -F , 'NR == 3 { exit !($3 > 1) }' baking && cmp baking baked.csv && cmp baking late
fact a_first_run_that_bakes_has_the_figures_of_the_second_in_all_frames
end_facts
