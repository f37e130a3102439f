#!/bin/bash
# test_descriptors.sh FACTS BAKE STREAMING TRACER: what is left when inputs use up all file descriptors, in TAP.
facts=$1
mapfile -t programs < <(realpath "${@:2}")
# shellcheck source=tests/bake/facts.sh
source "$facts"
bake=${programs[0]} streaming=${programs[1]} tracer=${programs[2]}
count=60

printf 'P6 8 8 255\n%192s' '' >one.ppm
"$bake" one.ppm -o one.store >out 2>err || exit 99
mkdir stores
for ((i = 0; i < count; i++)); do
    ln one.store "stores/$i.store"
done

gallery() { # options; status in walked
    walked=0
    "$streaming" --images stores --size 32x18 --frames 1 --rest-frames 1 --write-frames all --residency paged \
        --generate-scale 64 --cache cache --json "$@" >out 2>err || walked=$?
}

figure() { # name: its value in out
    sed -n "s/.*\"name\": \"$1\", \"value\": \([^,]*\),.*/\1/p" out
}

(
    ulimit -n 56 || exit 1
    gallery --output few --record few/trace --needs-trace few/needs
    [ "$walked" -eq 77 ] && exit 77
    [ "$walked" -eq 0 ] && [ "$(figure pictures_left_out)" -gt 0 ] && [ "$(figure pictures)" -gt 0 ] &&
        [ -s few/report.html ] && [ -s few/frames.csv ] && [ -s few/frame-0000.png ] && [ -s few/trace ] &&
        [ -s few/needs ] && grep -q 'left out: too few file descriptors' err
)
result=$?
if [ $result -eq 77 ]; then
    echo '1..0 # SKIP no device streams pages'
    exit 0
fi
[ $result -eq 0 ]
fact outputs_are_whole_when_inputs_take_all_descriptors

(ulimit -Sn 56 && gallery --output many && [ "$walked" -eq 0 ] && [ "$(figure pictures_left_out)" -eq 0 ])
fact the_soft_limit_is_raised_to_the_hard_one

(
    ulimit -n 56 || exit 1
    "$tracer" --textures stores --size 32x18 --samples 1 --launches 8 --needs off --output traced \
        --contact-sheet traced/sheet.png >out 2>err
    [ -s traced/picture.png ] && [ -s traced/picture.exr ] && [ -s traced/frames.csv ] && [ -s traced/sheet.png ]
)
fact a_traced_picture_is_written_when_textures_take_all_descriptors

mkdir taken.png
tool=$streaming
run 1 --images stores --output taken --needs-trace absent/needs && grep -q 'absent/needs: cannot be written: absent: no such folder' err &&
    ! grep -q walking err
fact what_cannot_be_written_is_said_before_the_walk

tool=$tracer
run 1 --output traced2 --contact-sheet taken.png && grep -q 'taken.png: is there already and is a folder' err &&
    [ ! -e traced2/picture.png ]
fact what_cannot_be_written_is_said_before_tracing

end_facts
