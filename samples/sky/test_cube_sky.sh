#!/bin/sh
# test_cube_sky.sh PROGRAM PSNR_PY FOLDER
#
# The sky that streams is the sky that is all there, with few of its tiles. The edges that --edges
# draws are in the picture. Exit status 77: no device has paged mode.
set -eu
program=$1 psnr=$2 folder=$3

look() { # name, options
    name=$1
    shift
    status=0
    "$program" --size 320x180 --face 1024 --frames 40 --output "$folder/$name.png" "$@" >"$folder/$name.txt" || status=$?
    [ "$status" -eq 0 ] || exit "$status"
    cat "$folder/$name.txt"
}

tiles() { sed -n 's/^\([0-9]*\) tiles loaded.*/\1/p' "$folder/$1.txt"; }

look whole --everything
look streamed
look edges --edges
python3 "$psnr" "$folder/whole.png" "$folder/streamed.png" 50
! python3 "$psnr" "$folder/streamed.png" "$folder/edges.png" 35 || exit 1
[ "$(tiles streamed)" -gt 10 ]
[ "$(tiles streamed)" -lt $(($(tiles whole) / 4)) ]
