#!/usr/bin/env bash
# Whether demand-pbrt makes only what rays of the camera need, counted against pbrt_oracle, which
# casts the same rays through scenes that are loaded as a whole:
#
#   shapes     at most 1.10 of those whose boxes a ray enters before its hit, and all that are visible
#   materials  at most 1.05 of those that are visible
#   tiles      those of the scene whose tiles can be counted by hand
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
    "$demand" "$data/$scene.pbrt" --json --verbose-loading --cache "$folder/cache" --file "$folder/p.pfm" "$@" \
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
    render "$1" --dim 96x64 --preload
    mv "$folder/p.pfm" "$folder/all.pfm"
    render "$1" --dim 96x64
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
render made/textures/cells
echo "# cells: $(figure made tiles_loaded) tiles"
holds "made/textures/cells: tiles are those that rays sample" "$(figure made tiles_loaded) == 4 * 6 + 2 * 4 + 1"
echo "1..$number"
