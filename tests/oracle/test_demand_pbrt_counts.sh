#!/usr/bin/env bash
# Whether demand-pbrt makes only what rays of the camera need, counted against pbrt_oracle, which
# casts the same rays through scenes that are loaded as a whole:
#
#   shapes     at most 1.10 of those whose boxes a ray enters before its hit, and all that are visible
#   materials  at most 1.05 of those that are visible
#   tiles      those of the scene whose tiles can be counted by hand, and those that cones of the oracle cover
#   pictures   never those named never-*.png
#
#   tests/oracle/test_demand_pbrt_counts.sh DEMAND_PBRT PBRT_ORACLE

set -uo pipefail
demand=$1 oracle=$2
data=${SLUICE_TEST_DATA:-$SLUICE_SOURCE_ROOT/../shared/data}/pbrt
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
if [ ! -d "$data" ]; then
    echo "1..0 # SKIP no scenes of pbrt in $data"
    exit 0
fi

figure() { # file, name
    sed -n "s/.*\"$2\", \"value\": \([0-9.e+]*\)[,}].*/\1/p" "$folder/$1"
}

holds() { # fact, awk condition
    awk "BEGIN { exit !($2) }" || printf 'not '
    echo "ok $((++number)) - $1"
}

render() { # scene, options
    local scene=$1 status=0
    shift
    "$demand" "$scene" --json --verbose-loading --cache "$folder/cache" --file "$folder/p.pfm" "$@" \
        >"$folder/made" 2>"$folder/log" || status=$?
    if [ $status = 77 ]; then
        echo "1..0 # SKIP no device traces rays"
        exit 0
    fi
    [ $status = 0 ] || sed 's/^/# /' "$folder/log"
}

# Also whether the picture is the one with everything loaded: what is visible is there.
count() { # scene
    local made entered visible materials most
    "$oracle" "$data/$1.pbrt" --dim 96x64 --quiet --json >"$folder/needed"
    render "$data/$1.pbrt" --dim 96x64 --preload
    mv "$folder/p.pfm" "$folder/all.pfm"
    render "$data/$1.pbrt" --dim 96x64
    made=$(figure made shapes_entered) materials=$(figure made materials_realized)
    entered=$(figure needed shapes_entered) visible=$(figure needed shapes_visible)
    most=$(figure needed materials_visible)
    echo "# $1: $made shapes, entered $entered, visible $visible; $materials materials, visible $most"
    holds "$1: shapes are at most 1.10 of those that rays enter" "${made:-0} >= ${visible:-9} && $made <= 1.10 * ${entered:-0}"
    holds "$1: materials are at most 1.05 of the visible ones" "${materials:-9e9} <= 1.05 * ${most:-0}"
    holds "$1: all that is visible is there" "$(cmp -s "$folder/p.pfm" "$folder/all.pfm" && echo 1 || echo 0)"
    holds "$1: no picture that nobody sees is opened" "$(grep -c never- "$folder/log") == 0"
}

number=0
for scene in instances/wood alpha/leaf-cards occlusion/wall materials/materials-v4; do
    count "made/$scene"
done
count bitterli/staircase2/scene-v4

# The view shows texels 1862 to 2234 and 1908 to 2188 of level 0 and half of these numbers in level 1. Tiles have 128 x 64
# texels: columns 14 to 17 and rows 29 to 34, columns 7 to 8 and rows 14 to 17; and the mip tail.
render "$data/made/textures/cells.pbrt"
echo "# cells: $(figure made tiles_loaded) tiles"
holds "made/textures/cells: tiles are those that rays sample" "$(figure made tiles_loaded) == 4 * 6 + 2 * 4 + 1"

# Tiles counted by the oracle's cones: a checkerboard of two textures of one picture on a plane seen at a flat angle, and a
# ball. Rounding decides over those between `least` and `most`.
cat >"$folder/flat.pbrt" <<SCENE
LookAt .3 -1.2 .25  0 0 0  0 0 1
Camera "perspective" "float fov" 50
WorldBegin
LightSource "distant" "point from" [ 0 0 1 ]
Texture "cells" "spectrum" "imagemap" "string filename" "$data/made/textures/cells4096.exr"
Texture "twice" "spectrum" "imagemap" "string filename" "$data/made/textures/cells4096.exr" "float uscale" 2
    "float vscale" .5 "float udelta" .3
Texture "fields" "spectrum" "checkerboard" "texture tex1" "cells" "texture tex2" "twice" "float uscale" 3 "float vscale" 3
Material "matte" "texture Kd" "fields"
Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ] "point P" [ -1 -1 0  1 -1 0  1 1 0  -1 1 0 ] "float uv" [ 0 0 1 0 1 1 0 1 ]
Translate 0 0 .1
Material "matte" "texture Kd" "cells"
Shape "sphere" "float radius" .2
WorldEnd
SCENE
tiles() { # scene, size
    local loaded least most
    "$oracle" "$1" --dim "$2" --tiles --quiet --json >"$folder/needed"
    render "$1" --dim "$2" --anisotropy 1
    loaded=$(figure made tiles_loaded) least=$(figure needed tiles_least) most=$(figure needed tiles_most)
    echo "# $(basename "$1"): $loaded tiles, sampled at least $least, at most $most"
    holds "$(basename "$1"): 1.0 tiles are loaded for each that rays sample" \
        "${loaded:-0} >= ${least:-9e9} && $loaded <= ${most:-0} && ${most:-0} <= 1.05 * $least"
}
tiles "$data/made/textures/cells.pbrt" 96x64
tiles "$folder/flat.pbrt" 256x192
echo "1..$number"
