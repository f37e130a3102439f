#!/usr/bin/env bash
# Whether the benchmark runs and prints its figures; what those are is nobody's business here.
#
#   bench/neural/test_figures.sh PROGRAM [bc7]    bc7: the build has the baker

set -uo pipefail
lines=$("$1" --size 64x36 --texture-size 64 --screens 2 --json)
status=$?
[ "$status" = 0 ] || exit "$status"
for name in schema latents weights rgba8.time ${2:+bc7.time} int8.time int8.rate host.rate tiles.copied.rate tiles.uploaded.rate \
    tiles.{rgba8,rgba16f,bc1,bc4,bc5,bc7}.{rate,texels,ratio}; do
    if ! grep -q -E "^\{\"name\": \"neural\.$name\", \"value\": [0-9][0-9.e+-]*, \"unit\": \"[^\"]*\"\}$" <<<"$lines"; then
        echo "there is no figure neural.$name" >&2
        exit 1
    fi
done
