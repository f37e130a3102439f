#!/bin/bash
# test_kept_sweep.sh SLUICE_TRADEOFF FOLDER: results can be made again from the sweeps in docs/tradeoff, in TAP.
tool=$(realpath "$1") kept=$2
n=0
failed=0
folder=$(mktemp -d) || exit 99
trap 'rm -rf "$folder"' EXIT

for sweep in "$kept"/*/; do
    n=$((n + 1))
    name=$(basename "$sweep")
    cp -r "$sweep" "$folder/$name"
    if rm "$folder/$name/points.csv" && "$tool" page "$folder/$name" >"$folder/out" 2>&1 &&
        cmp "$folder/$name/points.csv" "$sweep/points.csv" >>"$folder/out" 2>&1 && [ -s "$folder/$name/page.html" ]; then
        echo "ok $n results_of_${name}_can_be_made_again"
    else
        echo "not ok $n results_of_${name}_can_be_made_again"
        sed 's/^/# /' "$folder/out"
        failed=1
    fi
done
[ "$n" -gt 0 ] || { echo "not ok 1 there_is_a_sweep"; n=1 failed=1; }
echo "1..$n"
exit $failed
