#!/bin/sh
# test_virtual_texture.sh PROGRAM FOLDER
#
# Every texel that is shown at the end of the zoom is the one that the function gives (the program
# fails otherwise), nothing is read, and memory holds what was looked at. Exit status 77: no device
# has paged mode.
set -eu
program=$1 folder=$2

zoom() { # name, options
    name=$1
    shift
    status=0
    "$program" --size 160x90 --output "$folder/$name.png" "$@" >"$folder/$name.txt" || status=$?
    cat "$folder/$name.txt"
    [ "$status" -eq 0 ] || exit "$status"
}

number() { # file, figure
    sed -n "s/^$2 *\\([0-9]*\\) .*/\\1/p" "$folder/$1.txt"
}

zoom small --texture-size-log2 14 --frames 20 --validation
zoom large --texture-size-log2 20 --frames 10
for name in small large; do
    [ "$(number $name bytes_read)" -eq 0 ]
    [ "$(number $name wrong_texels)" -eq 0 ]
    [ "$(number $name compared_texels)" -eq 14400 ]
    [ "$(number $name finest_level)" -eq 0 ]
    [ "$(number $name tiles_made)" -lt 200 ]
done
