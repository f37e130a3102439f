#!/usr/bin/env bash
# Whether demand-pbrt and pbrt_oracle, which share no code, find the same light in scenes of lights,
# alpha and instances. Paths are random, so pictures agree within noise: the bounds are two to three
# times what 16 paths per pixel give.
#
#   tests/oracle/test_demand_pbrt_oracle.sh DEMAND_PBRT PBRT_ORACLE

set -uo pipefail
demand=$1 oracle=$2
data=${SLUICE_TEST_DATA:-$SLUICE_SOURCE_ROOT/../shared/data}/pbrt
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
if [ ! -d "$data" ]; then
    echo "1..0 # SKIP no scenes of pbrt in $data"
    exit 0
fi

# Shapes that emit, none in sight: a mesh whose normals say the side, one that a mirroring transform
# and one that ReverseOrientation turns, one that emits on both sides, a ball, and one with alpha.
# Paths that meet the small ball by chance alone have a FLIP of 0.35.
write_lamps() {
    cat <<'END'
LookAt 0 -6 2  0 0 1  0 0 1
Camera "perspective" "float fov" 45
WorldBegin
Material "matte" "rgb Kd" [ .7 .6 .5 ]
Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ] "point P" [ -9 -9 0  9 -9 0  9 4 0  -9 4 0 ]
Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ] "point P" [ -9 4 0  9 4 0  9 4 9  -9 4 9 ]
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 8 6 4 ]
    Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ] "point P" [ -1 -1 5  1 -1 5  1 1 5  -1 1 5 ]
        "normal N" [ 0 0 -1  0 0 -1  0 0 -1  0 0 -1 ]
AttributeEnd
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 2 4 8 ]
    Scale -1 1 1
    Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ] "point P" [ 4 -1 4  4 1 4  5 1 3  5 -1 3 ]
AttributeEnd
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 4 8 2 ]
    ReverseOrientation
    Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ] "point P" [ 4 -1 4  4 1 4  5 1 3  5 -1 3 ]
AttributeEnd
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 3 3 3 ] "bool twosided" "true"
    Shape "trianglemesh" "integer indices" [ 0 2 1 ] "point P" [ -2 2 5  2 2 5  0 3 6 ]
AttributeEnd
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 400 400 400 ]
    Translate 0 -2 4.5
    Shape "sphere" "float radius" 0.1
AttributeEnd
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ .5 .5 .5 ] "bool twosided" "true"
    Texture "holes" "float" "checkerboard" "float tex1" 0 "float tex2" 1 "float uscale" 4 "float vscale" 4
    Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ] "float uv" [ 0 0  1 0  1 1  0 1 ]
        "point P" [ -4 -8 1  4 -8 1  4 -8 5  -4 -8 5 ] "texture alpha" "holes"
AttributeEnd
WorldEnd
END
}

# compare NUMBER SCENE LARGEST_FLIP: also whether the means differ by 2 % at most.
compare() {
    local flip mean other
    [ -d "$folder/$1" ] || cp -r "$data/made" "$folder/$1" # pictures are baked beside the scene
    "$demand" "$folder/$1/$2.pbrt" --dim 64x48 --render-mode path --samples 16 --depth 3 \
        --file "$folder/$1.pfm" >"$folder/log" 2>&1
    case $? in
    0) ;;
    77) echo "ok $1 - $2 # SKIP no device traces rays"; return ;;
    *) sed 's/^/# /' "$folder/log"; echo "not ok $1 - $2 is rendered"; return ;;
    esac
    "$oracle" "$folder/$1/$2.pbrt" --dim 64x48 --render-mode path --samples 16 --bounces 3 \
        --compare "$folder/$1.pfm" --quiet --json >"$folder/lines"
    number() { sed -n "s/.*\"$1\", \"value\": \([^}]*\)}.*/\1/p" "$folder/lines"; }
    flip=$(number flip) mean=$(number mean) other=$(number other_mean)
    echo "# $2: FLIP $flip, means $mean and $other"
    awk -v f="${flip:-9}" -v m="${mean:-0}" -v o="${other:-9}" -v most="$3" \
        'BEGIN { exit !(f < most && o > 0.98 * m && o < 1.02 * m) }' || printf 'not '
    echo "ok $1 - $2 shows the same light"
}

echo 1..4
compare 1 instances/wood 0.15
compare 2 alpha/leaf-cards 0.15
compare 3 lights/lights-v3 0.15
mkdir "$folder/4" && write_lamps >"$folder/4/lamps.pbrt"
compare 4 lamps 0.2
