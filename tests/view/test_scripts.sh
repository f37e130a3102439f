#!/usr/bin/env bash
# test_scripts.sh FACTS SLUICE-VIEW: the scripts of docs/viewer, in TAP. One after the other in one run, at two fifths of
# the size that they are written for, in front of three small pictures.
set -u
root=$(cd "$(dirname "$0")/../.." && pwd)
facts=$(realpath "$1") tool=$(realpath "$2")
"$tool" --list-devices >/dev/null 2>&1 || { echo "1..0 # SKIP no Vulkan device"; exit 0; }
# shellcheck source=/dev/null
. "$facts"

offset=0
for script in "$root"/docs/viewer/*.txt; do
    [ "$(basename "$script")" != stutter.txt ] || continue # of a recording, below
    echo "$offset reset" >>events
    sed '/^#/d; s/ *#.*//' "$script" | awk -v offset="$offset" '{ $1 += offset }
        $2 == "click" || $2 == "drag" { $3 *= 0.4; $4 *= 0.4 } $2 == "drag" { $5 *= 0.4; $6 *= 0.4 } { print }' >>events
    offset=$(($(awk '$1 > last { last = $1 } END { print last }' events) + 3))
done
grep -E ' (screenshot|reset)' events >screenshots
mkdir plain pictures
for shade in '\377' '\144' '\036'; do
    { printf 'P6 300 300 255\n' && head -c 270000 /dev/zero | tr '\0' "$shade"; } >"pictures/${shade#?}.ppm"
done
show() { run 0 pictures --headless --deterministic --fresh --cache . --size 400x225 --ui-scale 0.4 --render-scale 0.2 "$@"; }

show --script screenshots && mv ./*.png plain && show --script events &&
    [ "$(cat err)" = 'sluice-view: missing.gltf: cannot be opened: No such file or directory' ]
fact scripts_run_and_name_nothing_but_the_file_that_is_missing
same=
while read -r _ _ picture; do
    [ -s "$picture" ] && ! cmp -s "$picture" "plain/$picture" || same="$same $picture"
done < <(grep screenshot screenshots)
[ -z "$same" ] || { echo "not changed:$same" >err && false; }
fact each_picture_is_changed_by_the_events_before_it
show --frames 30 --record stutter.trace && run 0 stutter.trace --headless --deterministic --size 400x225 --ui-scale 0.4 \
    --frames 3 --screenshot plain/stutter.png && run 0 stutter.trace --headless --deterministic --size 400x225 \
    --ui-scale 0.4 --script "$root/docs/viewer/stutter.txt" && [ -s stutter.png ] && ! cmp -s stutter.png plain/stutter.png
fact the_script_of_a_recording_changes_its_picture
unnamed=
for script in "$root"/docs/viewer/*.txt; do
    name=$(basename "$script")
    [ "$name" = hall.txt ] || grep -q "(viewer/$name)" "$root/docs/viewer.md" || unnamed="$unnamed $name"
done
[ -z "$unnamed" ] || { echo "not named:$unnamed" >err && false; }
fact the_page_names_each_script
wrong=
for script in "$root"/docs/viewer/*.txt; do
    head -n 1 "$script" | grep -q "^# sluice-view .*--size 1000x562 .*--script docs/viewer/$(basename "$script")" ||
        wrong="$wrong $script"
done
[ -z "$wrong" ] || { echo "no command:$wrong" >err && false; }
fact each_script_begins_with_its_command
end_facts
