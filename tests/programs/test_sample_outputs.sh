#!/bin/bash
# test_sample_outputs.sh FACTS STREAMING TRACER MINIMAL SHARED VIRTUAL: what the samples leave behind at the names of their
# outputs when something is in the way, in TAP.
facts=$1
mapfile -t programs < <(realpath "${@:2}")
# shellcheck source=tests/bake/facts.sh
source "$facts"
streaming=${programs[0]} tracer=${programs[1]} minimal=${programs[2]} shared=${programs[3]} virtual=${programs[4]}

mkdir folder pictures && echo older >locked && chmod 444 locked
printf 'P6 8 8 255\n%192s' '' >pictures/one.ppm

tool=$streaming
walk() { # exit status, options; a walk as short as can be
    local expected=$1
    shift
    run "$expected" --size 32x18 --frames 1 --rest-frames 1 --residency paged --generate-scale 64 --cache cache \
        --write-frames none --json "$@"
}

if walk 77 --output first; then
    echo "1..0 # SKIP no device"
    exit 0
fi
walk 0 --output first --record first/run.trace --needs-trace first/needs.trace && [ -s first/run.trace ] &&
    [ -s first/needs.trace ] && [ -s first/frames.csv ] && [ -z "$(find . -name '*.sluice-part*')" ]
fact a_walk_leaves_whole_files_and_no_part_files

walk 1 --output taken --record folder && grep -q 'folder: is there already and is a folder' err &&
    walk 1 --output taken --record absent/run.trace && grep -q 'absent/run.trace: .*absent: no such folder' err &&
    walk 1 --output taken --record locked && grep -q 'locked: is there already and is read-only' err && [ -d folder ] &&
    [ "$(cat locked)" = older ]
fact a_recording_that_cannot_be_written_names_its_file

picture=$(find cache -name '*.exr' | head -n 1) && cp "$picture" one.exr && cp one.exr before && ln one.exr hard &&
    ln -s one.exr soft && good=0
for output in '--record one.exr' '--record hard' '--needs-trace soft' '--needs-trace hard'; do
    # shellcheck disable=SC2086 # two words
    walk 1 --output taken --images one.exr $output && grep -q "${output#* }: " err && cmp one.exr before || good=1
done
[ "$good" = 0 ] && [ -L soft ]
fact a_walk_replaces_none_of_its_pictures

walk 1 --output same --record same/trace --needs-trace same/../same/trace &&
    grep -q 'same/trace: two outputs of this run have this name' err && [ -z "$(ls same)" ] &&
    walk 1 --output same --needs-trace same/report.html && grep -q 'report.html: two outputs' err && [ -z "$(ls same)" ] &&
    walk 0 --output same --record /dev/null --needs-trace /dev/null
fact two_outputs_of_a_walk_under_one_name_are_refused_at_once

mkdir -p kept && echo "shopping list" >kept/reference.txt &&
    walk 1 --output taken --reference kept && grep -q 'was not written by this program' err &&
    [ "$(cat kept/reference.txt)" = "shopping list" ]
fact a_reference_does_not_remove_a_text_of_somebody_else

tool=$tracer
trace() { # exit status, options
    local expected=$1
    shift
    run "$expected" --size 32x18 --samples 1 --texture-count 30 --texture-size 512 --json "$@"
}
trace 0 --output traced && cp traced/picture.png before.png &&
    trace 1 --output traced --reference traced/picture.png &&
    grep -q 'traced/picture.png: would replace a file that is read' err && cmp traced/picture.png before.png
fact a_tracer_does_not_replace_the_picture_that_it_compares_with

trace 1 --output sheets --contact-sheet sheets/picture.exr && grep -q 'picture.exr: two outputs' err && [ -z "$(ls sheets)" ]
fact two_outputs_of_a_tracer_under_one_name_are_refused_at_once

good=0
for tool in "$minimal" "$shared" "$virtual"; do
    { run 1 --output folder && grep -q 'folder: is there already and is a folder' err && [ -d folder ] &&
        run 1 --output locked && grep -q 'locked: is there already and is read-only' err && [ "$(cat locked)" = older ]; } ||
        good=1
done
[ $good -eq 0 ]
fact small_samples_remove_nothing_and_say_so_before_they_draw

end_facts
