#!/bin/sh
# test_minimal.sh MINIMAL PSNR_PY FOLDER
#
# Every residency mode that a device has ends with the picture of a texture that is all there, and
# with fewer tiles than that. Exit status 77: no device has any mode.
set -eu
minimal=$1 psnr=$2 folder=$3
rm -rf "$folder"
mkdir -p "$folder"
ran=0 failed=0

walk() { # name, options
    name=$1
    shift
    status=0
    "$minimal" --size 320x180 --output "$folder/$name.png" "$@" >"$folder/$name.txt" || status=$?
    [ "$status" -eq 0 ] || [ "$status" -eq 77 ] || failed=1
}

walk whole --residency dense --everything
[ "$status" -eq 0 ] || exit "$status"
for mode in sparse paged dense auto; do
    walk "$mode" --residency "$mode" --frames 40
    if [ "$status" -ne 0 ]; then
        echo "$mode: status $status"
        continue
    fi
    ran=$((ran + 1))
    echo "$mode: $(tail -n 1 "$folder/$mode.txt")"
    case $mode in
    auto) used='sparse|paged' ;;
    *) used=$mode ;;
    esac
    grep -q -E "^($used), frame 120: " "$folder/$mode.txt" || failed=1
    python3 "$psnr" "$folder/whole.png" "$folder/$mode.png" 45 || failed=1
    awk 'END { exit !($4 > 0 && $4 < $6 / 2 && $9 >= $4) }' "$folder/$mode.txt" || failed=1
done
[ "$ran" -gt 0 ] || exit 77
exit "$failed"
