#!/usr/bin/env bash
# Measures how long decoding of neural textures takes on a Vulkan device.
#
#   bench/neural/run.sh [--bin DIR] [--work DIR] [options of neural_figures] [FILE.ntc]
#
#   --bin DIR   run DIR/neural_figures instead of building
#   --work DIR  keep the build there (default: a scratch folder, removed)
#   --help
#
# The library is built static, -O3 and without asserts. Without --bin needs meson, ninja, a C compiler and
# glslangValidator. README.md in this folder's parent says what each figure is.
#
# Exit status: 0; 1 if a measurement failed; 77 if there is no device.

set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
export LC_ALL=C

bin='' work='' scratch='' arguments=()
trap '[ -z "$scratch" ] || rm -rf "$scratch"' EXIT

while [ $# -gt 0 ]; do
    case $1 in
    --bin | --work)
        [ $# -ge 2 ] || { echo "error: $1 needs a value (see --help)" >&2; exit 1; }
        declare "${1#--}=$2"
        shift
        ;;
    --help)
        sed -n '2,/^$/s/^# \{0,1\}//p' "$0"
        exit 0
        ;;
    *) arguments+=("$1") ;;
    esac
    shift
done

if [ -z "$bin" ]; then
    [ -n "$work" ] || { scratch=$(mktemp -d) && work=$scratch; }
    mkdir -p "$work"
    again=()
    [ ! -d "$work/build" ] || again=(--reconfigure)
    { meson setup "${again[@]}" "$work/build" "$root" --buildtype=release -Db_ndebug=if-release \
        -Ddefault_library=static -Dtests=false &&
        ninja -C "$work/build" bench/neural/neural_figures; } >"$work/log" 2>&1 </dev/null || {
        tail -n 40 "$work/log" >&2
        exit 1
    }
    bin=$work/build/bench/neural
fi
"$bin/neural_figures" "${arguments[@]}"
