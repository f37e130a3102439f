#!/bin/sh
# test_shared_tiles.sh PROGRAM FOLDER
#
# One context: the picture is that of two contexts, with tiles shared and less read. Exit status 77:
# no device has paged mode.
set -eu
program=$1 folder=$2

walk() { # name, options
    name=$1
    shift
    status=0
    "$program" --frames 24 --output "$folder/$name.png" "$@" >"$folder/$name.txt" || status=$?
    [ "$status" -eq 0 ] || exit "$status"
    cat "$folder/$name.txt"
}

number() { # file, the words before it, the words behind it
    sed -n "s/.*$2\\([0-9]*\\)$3.*/\\1/p" "$folder/$1.txt"
}

walk together
walk apart --apart
cmp "$folder/together.png" "$folder/apart.png"
for name in together apart; do
    [ "$(number $name ', ' ' missing')" -eq 0 ]
done
shared=$(($(number together ', ' ' of them from the demand loader') + $(number together ', ' ' of them from the streamer')))
[ "$shared" -ge 4 ]
[ "$(number together 'read: ' ' KiB')" -lt "$(number apart 'read: ' ' KiB')" ]
[ "$(number apart ', ' ' of them from the streamer')" -eq 0 ]
