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

# compare NUMBER SCENE LARGEST_FLIP: also whether the means differ by 2 % at most.
compare() {
    local flip mean other
    cp -r "$data/made" "$folder/$1" # pictures are baked beside the scene
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

echo 1..3
compare 1 instances/wood 0.15
compare 2 alpha/leaf-cards 0.15
compare 3 lights/lights-v3 0.15
