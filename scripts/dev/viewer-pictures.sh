#!/usr/bin/env bash
# viewer-pictures.sh SLUICE-VIEW FOLDER: draws the pictures of docs/viewer.md by the event scripts in docs/viewer,
# without a window, and the same in every run, but for times. Pictures that the page shows are copied to docs/images.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
viewer=$(realpath "${1:?sluice-view}") folder=${2:?a folder}
mkdir -p "$folder"
cd "$folder"
ln -sfn "$root/tools/sluice-view/hall" hall # a short path, which the copied command line shows
for script in "$root"/docs/viewer/*.txt; do
    basename "$script" .txt
    case $script in */pbrt.txt | */stutter.txt) continue ;; esac
    read -ra options < <(sed -n '1s/^# sluice-view \(.*\) --script .*/\1/p' "$script")
    "$viewer" hall/hall.gltf "${options[@]}" --script "$script"
done
ln -sfn "$(realpath "${SLUICE_TEST_DATA:-$root/../shared/data}")/pbrt/bitterli/staircase2" staircase
"$viewer" --headless --deterministic --size 1000x562 --render-scale 1 --most-samples 4 \
    --script "$root/docs/viewer/pbrt.txt" staircase/scene-v4.pbrt
"$viewer" hall/hall.gltf --headless --deterministic --size 500x281 --render-scale 1 --budget 32 --source-bandwidth 25 --frames 240 \
    --record stutter.trace
"$viewer" --headless --deterministic --size 1000x562 --render-scale 1 --script "$root/docs/viewer/stutter.txt" stutter.trace
for picture in hall blurry memory slider budget truth thrash unseen cut feedback feedback-cost file reproduce driver modes \
    keys pbrt pbrt-memory stutter stutter-panels; do
    "$root/scripts/dev/palette_png.py" "$picture.png" "$root/docs/images/viewer-$picture.png"
done
