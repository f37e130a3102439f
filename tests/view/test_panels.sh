#!/usr/bin/env bash
# test_panels.sh FACTS SLUICE-VIEW: panels of the viewer, without a window, in TAP.
set -u
facts=$(realpath "$1") tool=$(realpath "$2")
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
end_facts
