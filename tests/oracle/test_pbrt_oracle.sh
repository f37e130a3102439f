#!/usr/bin/env bash
# Whether pbrt_oracle writes pictures and tables and compares pictures.
#
#   tests/oracle/test_pbrt_oracle.sh PROGRAM

set -uo pipefail
program=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() {
    echo "$1" >&2
    exit 1
}

cat >"$folder/scene.pbrt" <<'SCENE'
Camera "perspective" "float fov" 60
WorldBegin
LightSource "distant" "point from" [1 1 -1]
Translate 0 0 3
Shape "sphere"
SCENE
draw() { "$program" "$folder/scene.pbrt" --dim 32x16 --json "$@" || fail "$* failed"; }

for suffix in pfm png; do
    draw --render-mode direct --samples 4 --file "$folder/picture.$suffix" >/dev/null
    lines=$(draw --render-mode direct --samples 4 --compare "$folder/picture.$suffix")
    grep -q '"equal_pixels", "value": 1}' <<<"$lines" || fail "$suffix: a picture differs from itself"
    lines=$(draw --render-mode primary --compare "$folder/picture.$suffix")
    grep -q '"flip", "value": 0}' <<<"$lines" && fail "$suffix: other pictures are equal"
done
lines=$(draw --hits "$folder/hits" --places "$folder/places")
grep -q '{"name": "shapes_visible", "value": 1}' <<<"$lines" || fail "the sphere is not visible"
[ "$(wc -l <"$folder/hits")" = 513 ] || fail "the table of hits has not a line for each pixel"
[ "$(wc -l <"$folder/places")" = 2 ] || fail "the table of places has not one line"
"$program" "$folder/scene.pbrt" --compare "$folder/none.png" --render-mode primary >/dev/null 2>&1 &&
    fail "a missing picture is no error"
"$program" --help | grep -q -e '--compare' || fail "--help names no --compare"
